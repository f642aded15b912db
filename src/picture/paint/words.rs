//! The words of a scene: beside their points, in view, and clear of each other.

use std::sync::Arc;

use egui::{Align2, CentralPanel, Frame, Galley, Painter, Pos2, Rect, Ui, Vec2, vec2};

use super::{Spot, colour, paint, plain};
use crate::picture::scene::camera::Camera;
use crate::picture::scene::palette::faded;
use crate::picture::scene::{Anchor, Label, Scene};

/// How far words give way to others, up or down, points.
const MOST: f32 = 36.0;
/// Words that would go this little past the edge move back without going below, points.
const SLIGHT: f32 = 4.0;
/// How near words come to an edge of the view to the left or right.
const EDGE: f32 = 8.0;

/// Where words go that have no room up or down: sideways too, points.
const SIDEWAYS: [f32; 7] = [0.0, -30.0, 30.0, -60.0, 60.0, -100.0, 100.0];
const STEP: f32 = 7.0;
const STEPS: i32 = 12;
/// How far words keep off the middle of a bar, points.
const BAR: f32 = 7.0;
/// How far words keep off a target's ring, points.
const RING: f32 = 15.0;
/// What it costs to lie on other words, out of view, and on a bar, in points that words would rather move.
const ON_WORDS: f32 = 1e4;
const OUT_OF_VIEW: f32 = 1e3;
const ON_BAR: f32 = 60.0;

/// Words about one point; they stay together.
struct Group<'a> {
    /// Who gives way to whom: the higher to the lower.
    rank: u8,
    words: Vec<(&'a Label, Arc<Galley>, Rect)>,
}

/// The higher ones give way to the lower ones, and those of the highest rank are left out where there is no room.
fn rank(name: &str) -> u8 {
    match name {
        // The pointer takes hold of points by their names.
        "plan/names" | "b_ring/name" | "payload/mass" => 0,
        "target/words" => 1,
        "reaction/words" => 2,
        "axes/titles" | "axes/now/words" => 4,
        "axes/words" => LEFT_OUT,
        _ => 3,
    }
}

const LEFT_OUT: u8 = 5;

/// A scene with its words over the whole surface, without input.
pub fn still(ui: &mut Ui, scene: &Arc<Scene>, camera: &Camera) {
    CentralPanel::default().frame(Frame::NONE).show(ui, |ui| {
        let rect = ui.max_rect();
        paint(ui, 0, rect, scene, camera);
        words(ui, &Spot { rect, camera: *camera }, scene, &[]);
    });
}

/// Paints the scene's labels, clear of what is taken already.
pub fn words(ui: &Ui, spot: &Spot, scene: &Scene, taken: &[Rect]) {
    let painter = ui.painter().with_clip_rect(spot.rect);
    for (label, galley, place) in placed(&painter, spot, scene, taken) {
        write(&painter, scene, label, galley, place);
    }
}

/// Where the scene's labels stand: those that have room.
pub fn placed<'a>(
    painter: &Painter,
    spot: &Spot,
    scene: &'a Scene,
    taken: &[Rect],
) -> Vec<(&'a Label, Arc<Galley>, Rect)> {
    let mut groups: Vec<(Pos2, Group<'_>)> = Vec::new();
    for label in &scene.labels {
        let Some(at) = spot.screen(label.at.map(f64::from)) else { continue };
        let galley = painter.layout_no_wrap(label.text.clone(), plain(label.size), colour(label.colour));
        let word = (label, galley, Rect::NOTHING);
        let of = |(l, ..): &(&Label, Arc<Galley>, Rect)| l.at == label.at && l.name == label.name;
        let same = groups.iter_mut().find(|(_, group)| group.words.first().is_some_and(of));
        match same {
            Some((_, group)) => group.words.push(word),
            None => groups.push((at, Group { rank: rank(&label.name), words: vec![word] })),
        }
    }
    groups.sort_by_key(|(_, group)| group.rank);
    let covered = taken;
    let mut taken = taken.to_vec();
    let mut ring = scene.markers.iter().find(|marker| marker.name == "target").and_then(|ring| {
        let at = spot.screen(ring.at.map(f64::from))?;
        Some(Rect::from_center_size(at, Vec2::splat(2.0 * RING)))
    });
    let end = |at: [f32; 3]| spot.screen(at.map(f64::from));
    let bars: Vec<[Pos2; 2]> = scene.bars.iter().filter_map(|[a, b]| Some([end(*a)?, end(*b)?])).collect();
    let mut all = Vec::with_capacity(scene.labels.len());
    for (at, mut group) in groups {
        group.place(at, spot.rect);
        let boxes: Vec<Rect> = group.words.iter().map(|(.., place)| *place).collect();
        // Of what is out of view nothing is said, rather than half of it.
        if !spot.rect.contains(at) && !boxes.iter().all(|place| spot.rect.contains_rect(*place)) {
            continue;
        }
        // Names stand where the pointer finds them; all else keeps off the ring.
        if group.rank > 0 {
            taken.extend(ring.take());
        }
        let is_good = |shift: f32| {
            let mut moved = boxes.iter().map(|place| place.translate(vec2(0.0, shift)));
            moved.all(|place| spot.rect.contains_rect(place) && !on_bars(place, &bars))
        };
        let shift = match clear(&boxes, &taken, spot.rect) {
            Some(shift) if group.rank == 0 || is_good(shift) => vec2(0.0, shift),
            None if group.rank == 0 => Vec2::ZERO,
            None if group.rank == LEFT_OUT => continue,
            Some(shift) if group.rank == LEFT_OUT => vec2(0.0, shift),
            _ => best(&boxes, &taken, &bars, spot.rect),
        };
        // What would be seen in part only beside what covers it is left out.
        let hidden = |place: &Rect| covered.iter().any(|cover| cover.intersects(place.translate(shift)));
        if group.rank > 1 && boxes.iter().any(hidden) {
            continue;
        }
        for (label, galley, place) in group.words {
            let place = place.translate(shift);
            taken.push(place);
            all.push((label, galley, place));
        }
    }
    all
}

fn write(painter: &Painter, scene: &Scene, label: &Label, galley: Arc<Galley>, place: Rect) {
    // A faint plate keeps words legible over bars and curves.
    painter.rect_filled(place.expand2(vec2(3.0, 0.0)), 3.0, colour(faded(scene.background, 0.55)));
    painter.galley(place.min, galley, colour(label.colour));
}

impl Group<'_> {
    /// Beside their point, moved back into view where they would be cut off.
    fn place(&mut self, at: Pos2, view: Rect) {
        let widest = self.words.iter().map(|(_, galley, _)| galley.size().x).fold(0.0, f32::max);
        for (label, galley, place) in &mut self.words {
            let [x, y] = label.offset;
            let over = at.x + x + widest - (view.right() - 10.0);
            let (align, shift) = match label.anchor {
                // Below what they would cover.
                Anchor::Left if over > 0.0 && view.contains(at) => {
                    (Align2::LEFT_CENTER, vec2(x - over, if over > SLIGHT { y + 30.0 } else { y }))
                }
                Anchor::Left => (Align2::LEFT_CENTER, vec2(x, y)),
                Anchor::Centre => (Align2::CENTER_CENTER, vec2(x, y)),
                Anchor::Right => (Align2::RIGHT_CENTER, vec2(x, y)),
            };
            *place = align.anchor_size(at + shift, galley.size());
            if label.anchor == Anchor::Centre && view.contains(at) {
                let over =
                    (place.right() - view.right() + EDGE).max(0.0) - (view.left() + EDGE - place.left()).max(0.0);
                *place = place.translate(vec2(-over, 0.0));
            }
        }
    }
}

/// Whether a place lies on a bar.
fn on_bars(place: Rect, bars: &[[Pos2; 2]]) -> bool {
    let place = place.expand(BAR);
    bars.iter().any(|[a, b]| {
        // What of the line from one end to the other is within both pairs of sides.
        let along = *b - *a;
        let mut within = [0.0_f32, 1.0];
        for (from, by, low, high) in
            [(a.x, along.x, place.left(), place.right()), (a.y, along.y, place.top(), place.bottom())]
        {
            let ends = [(low - from) / by, (high - from) / by];
            if by.abs() < 1e-6 {
                if from < low || from > high {
                    return false;
                }
                continue;
            }
            within = [within[0].max(ends[0].min(ends[1])), within[1].min(ends[0].max(ends[1]))];
        }
        within[0] <= within[1]
    })
}

/// By how much boxes go up, down or aside so that they lie on nothing, or on as little as can be.
fn best(boxes: &[Rect], taken: &[Rect], bars: &[[Pos2; 2]], view: Rect) -> Vec2 {
    let cost = |shift: Vec2| {
        let each = boxes.iter().map(|place| {
            let place = place.translate(shift);
            let words = taken.iter().filter(|other| place.intersects(**other)).count() as f32;
            let out = if view.contains_rect(place) { 0.0 } else { OUT_OF_VIEW };
            words * ON_WORDS + out + if on_bars(place, bars) { ON_BAR } else { 0.0 }
        });
        each.sum::<f32>() + shift.y.abs() + 0.6 * shift.x.abs()
    };
    let ways = SIDEWAYS.iter().flat_map(|x| (-STEPS..=STEPS).map(move |i| vec2(*x, i as f32 * STEP)));
    let cheapest = ways.map(|shift| (cost(shift), shift)).min_by(|a, b| a.0.total_cmp(&b.0));
    cheapest.map_or(Vec2::ZERO, |(_, shift)| shift)
}

/// By how much boxes have to go up or down, at least, to be clear of what is taken and in view; none if there is no way.
fn clear(boxes: &[Rect], taken: &[Rect], view: Rect) -> Option<f32> {
    let moved = |shift: f32| boxes.iter().map(move |place| place.translate(vec2(0.0, shift)));
    let is_free = |shift: f32| {
        let in_view = |place: Rect| place.top() >= view.top() && place.bottom() <= view.bottom();
        moved(shift).all(|place| taken.iter().all(|other| !place.intersects(*other)))
            && (shift == 0.0 || moved(shift).all(in_view))
    };
    if is_free(0.0) {
        return Some(0.0);
    }
    let pairs = boxes.iter().flat_map(|place| taken.iter().map(move |other| (place, other)));
    let beside = pairs.filter(|(place, other)| place.x_range().intersects(other.x_range()));
    let shifts =
        beside.flat_map(|(place, other)| [other.bottom() - place.top() + 1.0, other.top() - place.bottom() - 1.0]);
    let mut shifts: Vec<f32> = shifts.filter(|shift| shift.abs() <= MOST).collect();
    shifts.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    shifts.into_iter().find(|shift| is_free(*shift))
}
