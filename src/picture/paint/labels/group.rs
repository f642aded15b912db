//! [`Group`]: labels that stand in rows beside one point, and the places that they may take.

use std::sync::Arc;

use egui::{Align2, Pos2, Rect, Vec2, vec2};

use super::room::{Room, nearest};
use crate::scene::{Anchor, Label, NOTES, Name};

/// Horizontal and vertical shifts of a place, points.
const SHIFTS_X_PT: [f32; 13] = [0.0, -10.0, 10.0, -20.0, 20.0, -40.0, 40.0, -70.0, 70.0, -110.0, 110.0, -170.0, 170.0];
const SHIFT_Y_PT: f32 = 8.0;
const SHIFTS_Y: i32 = 12;
/// Costs, in points of shift, of a row that is left out, of covering an arrow, and of each way to stand.
const ROW_COST: f32 = 150.0;
const ARROW_COST: f32 = 40.0;
const WAYS: [(Way, f32); 4] = [
    (Way { left: false, up: false }, 0.0),
    (Way { left: true, up: false }, 10.0),
    (Way { left: false, up: true }, 12.0),
    (Way { left: true, up: true }, 20.0),
];
/// A group moves only to a place that is better by this much, points, and clear of everything by the margin.
const MIN_GAIN_PT: f32 = 22.0;
const MARGIN_PT: f32 = 5.0;
/// A group stays for this many pictures of a moving scene, if its place is free, even if another one is better.
const MIN_HELD: u16 = 40;
/// A line leads to labels whose distance from their point exceeds that of their best place by this, points.
const LEADS_BEYOND_PT: f32 = 18.0;

/// On which sides of its point a group stands, compared with where it would stand at best.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Way {
    /// Mirrored to the other side.
    left: bool,
    /// Mirrored upwards or downwards.
    up: bool,
}

/// A place of a group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// Number of rows; further ones are left out.
    rows: usize,
    way: Way,
    shift: Vec2,
    cost: f32,
    /// Number of pictures in which it has been held.
    held: u16,
}

/// Returns all ways and shifts, the cheapest first.
pub fn choices() -> Arc<[Choice]> {
    let shifts = SHIFTS_X_PT.iter().flat_map(|x| (-SHIFTS_Y..=SHIFTS_Y).map(|i| vec2(*x, i as f32 * SHIFT_Y_PT)));
    let choice = |shift: Vec2, way: Way| Choice { rows: 0, way, shift, cost: way.cost(shift), held: 0 };
    let mut all: Vec<Choice> = shifts.flat_map(|shift| WAYS.map(|(way, _)| choice(shift, way))).collect();
    all.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    all.into()
}

/// How important a group is, and how far it may move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kind {
    /// Groups of lower rank are placed first.
    pub rank: u8,
    /// Maximum cost of its place, points.
    pub reach: f32,
    /// Whether it describes a wide thing, so that no line needs to lead to it.
    pub is_legend: bool,
}

impl Kind {
    /// Returns the kind of a label by its name.
    pub fn of(name: &str) -> Self {
        let (rank, reach, is_legend) = match name {
            // The user drags these points by their labels.
            "plan/names" | "b_ring/name" | "payload/mass" => (0, 60.0, false),
            "target/words" => (1, f32::INFINITY, false),
            "reaction/words" | "base_motion" | "pin_forces/scale" => (2, f32::INFINITY, true),
            "axes/titles" | "axes/now/words" => (4, 90.0, true),
            "axes/words" => (5, 36.0, true),
            // Only where there is room.
            "sketch/weights/masses" => (6, 30.0, true),
            "sketch/pins/names" => (7, 44.0, true),
            "workspace/label" | "workspace/compared/label" | "plane/label" => (3, f32::INFINITY, true),
            // The line of a note leads to it.
            name if name.starts_with(NOTES) => (3, f32::INFINITY, true),
            _ => (3, f32::INFINITY, false),
        };
        Self { rank, reach, is_legend }
    }

    /// Returns the name that labels of one group share.
    fn shared(name: &str) -> &str {
        match name {
            "base_motion" | "pin_forces/scale" => "reaction/words",
            name => name,
        }
    }
}

/// Labels with the same point and the same name; they move together.
pub struct Group<'a> {
    /// Name, and number among the groups of this name.
    pub key: (Name, usize),
    pub kind: Kind,
    /// The point on the screen.
    pub at: Pos2,
    /// Text and best place of each label, the most important first.
    pub rows: Vec<(&'a Label, String, Rect)>,
}

impl<'a> Group<'a> {
    /// Whether a label belongs to it.
    pub fn takes(&self, label: &Label) -> bool {
        self.rows
            .first()
            .is_some_and(|(first, ..)| first.at == label.at && Kind::shared(&first.name) == Kind::shared(&label.name))
    }

    /// Adds a label at its best place.
    pub fn push(&mut self, label: &'a Label, text: String, size: Vec2) {
        let align = match label.anchor {
            Anchor::Left => Align2::LEFT_CENTER,
            Anchor::Centre => Align2::CENTER_CENTER,
            Anchor::Right => Align2::RIGHT_CENTER,
        };
        let place = align.anchor_size(self.at + Vec2::from(label.offset), size);
        self.rows.push((label, text, place));
    }

    /// Returns the places of the rows of a choice.
    pub fn places(&self, choice: &Choice, view: Rect) -> impl Iterator<Item = Rect> + '_ {
        let Choice { rows, way, shift, .. } = *choice;
        let rows = &self.rows[..rows];
        let block = rows.iter().fold(Rect::NOTHING, |block, (.., place)| block.union(*place));
        let x_of_point = self.at.x;
        let flip = move |place: Rect| match way.left {
            true => place.translate(vec2(2.0 * x_of_point - place.left() - place.right(), 0.0)),
            false => place,
        };
        let up = if way.up { 2.0 * self.at.y - block.top() - block.bottom() } else { 0.0 };
        let moved = flip(block).translate(shift + vec2(0.0, up));
        // At the edges of the view, it slides along them.
        let inner = view.shrink2(vec2(8.0, 2.0));
        let x = (inner.left() - moved.left()).max(0.0) - (moved.right() - inner.right()).max(0.0);
        let y = (inner.top() - moved.top()).max(0.0) - (moved.bottom() - inner.bottom()).max(0.0);
        let by = shift + vec2(x, up + y);
        rows.iter().map(move |(.., place)| flip(*place).translate(by))
    }

    /// Returns the cheapest free place, or the previous one if it is nearly as good; `None` if there is none. The
    /// previous place is held for a while if it is still free, unless `released`; rows left out come back there.
    pub fn choose(&self, room: &Room, all: &[Choice], before: Option<Choice>, released: bool) -> Option<Choice> {
        let before = before.filter(|choice| choice.rows <= self.rows.len()).and_then(|choice| {
            let missing = (self.rows.len() - choice.rows) as f32 * ROW_COST;
            let own = Choice { cost: choice.way.cost(choice.shift), ..choice };
            self.priced(room, own, 0.0).map(|cost| Choice { cost: cost + missing, ..choice })
        });
        if let Some(mut before) = before {
            before.held = before.held.saturating_add(1);
            if before.held < MIN_HELD && !released {
                // A row that was left out comes back where the others stand.
                let whole = Choice { rows: self.rows.len(), ..before };
                let cost = (before.rows < whole.rows).then(|| self.priced(room, whole, 0.0)).flatten();
                return Some(cost.map_or(before, |cost| Choice { cost, ..whole }));
            }
            let better = self.cheapest(room, all, MARGIN_PT, before.cost - MIN_GAIN_PT);
            return Some(better.unwrap_or(before));
        }
        let cheapest = |margin: f32| self.cheapest(room, all, margin, f32::INFINITY);
        cheapest(MARGIN_PT).or_else(|| cheapest(0.0))
    }

    /// Returns the cheapest free place that costs less than `limit`, clear of everything by `margin`, points.
    fn cheapest(&self, room: &Room, all: &[Choice], margin: f32, limit: f32) -> Option<Choice> {
        let mut best: Option<Choice> = None;
        for rows in (1..=self.rows.len()).rev() {
            let missing = (self.rows.len() - rows) as f32 * ROW_COST;
            for choice in all.iter().take_while(|choice| choice.cost <= self.kind.reach) {
                let least = best.map_or(limit, |best| best.cost);
                if choice.cost + missing >= least {
                    break;
                }
                let choice = Choice { rows, ..*choice };
                let cost = self.priced(room, choice, margin).map(|cost| cost + missing);
                if let Some(cost) = cost.filter(|cost| *cost < least) {
                    best = Some(Choice { cost, ..choice });
                }
            }
            if best.is_some() {
                break;
            }
        }
        best
    }

    /// Returns the cost of a place, without that of missing rows; `None` if it is not free.
    fn priced(&self, room: &Room, choice: Choice, margin: f32) -> Option<f32> {
        let mut cost = choice.cost;
        let mut block = Rect::NOTHING;
        for place in self.places(&choice, room.view) {
            let place = boxed(place);
            if !room.is_free(place, margin, self.at) {
                return None;
            }
            cost += if room.covers_arrow(place) { ARROW_COST } else { 0.0 };
            block = block.union(place);
        }
        (!self.lead(block).is_some_and(|line| room.crosses_taken(line))).then_some(cost)
    }

    /// Returns the line from the point to a block that stands far from it.
    pub fn lead(&self, block: Rect) -> Option<[Pos2; 2]> {
        let best = self.rows.iter().map(|(.., place)| place.distance_to_pos(self.at)).fold(f32::INFINITY, f32::min);
        let far = block.distance_to_pos(self.at) > best.max(0.0) + LEADS_BEYOND_PT;
        let end = nearest(block, self.at);
        let from = self.at + (end - self.at).normalized() * best.clamp(0.0, 16.0);
        (far && !self.kind.is_legend).then_some([from, end])
    }
}

impl Way {
    /// Returns the cost of standing so at a shift, points.
    fn cost(self, shift: Vec2) -> f32 {
        let own = WAYS.iter().find(|(way, _)| *way == self).map_or(0.0, |(_, cost)| *cost);
        own + shift.y.abs() + 0.6 * shift.x.abs()
    }
}

/// Returns the rectangle that a label takes with its background.
pub fn boxed(place: Rect) -> Rect {
    place.expand2(vec2(3.0, 0.0))
}
