//! A box with three labelled axes: a grid on the rear walls, and ticks on the front edges.

use super::palette::{Palette, faded};
use super::{Anchor, ItemChanges, Label, Polyline, Rgba, Scene};
use crate::notation::Notation;
use crate::numbers::{round_up, signed};

/// One axis of the box: its quantity and interval.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Symbol of the quantity.
    pub symbol: &'static str,
    /// Unit of the values.
    pub unit: &'static str,
    /// Colour of the title.
    pub colour: Rgba,
    /// Coordinates of both ends of the box, in the units of the scene.
    pub ends: [f64; 2],
    /// Values at these ends.
    pub values: [f64; 2],
    /// Spacing of the ticks; ticks are at multiples of this.
    pub step: f64,
    /// Decimals of the tick labels.
    pub decimals: usize,
    /// Current value, which is highlighted, and its colour.
    pub now: Option<(f64, Rgba)>,
    /// Decimals of the current value.
    pub now_decimals: usize,
}

/// Names of the marks of the current values on the axes.
const NOW: [&str; 3] = ["axes/now/1", "axes/now/2", "axes/now/3"];

/// Maximum number of ticks on an axis.
const MAX_TICKS: usize = 40;

impl Axis {
    /// Returns this axis with its values in the user's units, at round ticks.
    #[must_use]
    pub fn shown_in(self, notation: Notation) -> Self {
        let Some(unit) = notation.shown_unit(self.unit) else { return self };
        let step = round_up(unit.factor * self.step);
        Self {
            unit: unit.name,
            values: self.values.map(|value| unit.factor * value),
            step,
            decimals: if step < 1.0 { self.decimals.max(1) } else { 0 },
            now: self.now.map(|(value, colour)| (unit.factor * value, colour)),
            now_decimals: unit.decimals(self.now_decimals),
            ..self
        }
    }

    /// Returns quantity and unit: `b, rad`.
    fn title(&self) -> String {
        format!("{}, {}", self.symbol, self.unit)
    }

    /// Returns the coordinate of a value in the scene.
    pub fn place(&self, value: f64) -> f64 {
        let share = (value - self.values[0]) / (self.values[1] - self.values[0]);
        self.ends[0] + share * (self.ends[1] - self.ends[0])
    }

    /// Returns the values of the ticks.
    pub fn marks(&self) -> impl Iterator<Item = f64> + use<> {
        let ([low, high], step) = (self.values, self.step);
        let slack = 1e-9 * step;
        let first = ((low - slack) / step).ceil();
        (0..MAX_TICKS).map(move |i| (first + i as f64) * step).take_while(move |v| *v <= high + slack)
    }

    fn length(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }
}

/// A box seen from a direction.
struct Sight<'a> {
    axes: &'a [Axis; 3],
    /// Coordinates of the three rear walls, which carry the grids; the third is floor or ceiling.
    back: [f64; 3],
    /// Coordinates of the opposite walls.
    front: [f64; 3],
    right: [f64; 3],
    up: [f64; 3],
}

impl<'a> Sight<'a> {
    fn new(axes: &'a [Axis; 3], eye: [f64; 3]) -> Self {
        let [x, y, z] = eye;
        let level = x.hypot(y);
        let right = if level > 1e-9 { [-y / level, x / level, 0.0] } else { [1.0, 0.0, 0.0] };
        // eye × right
        let up = [y * right[2] - z * right[1], z * right[0] - x * right[2], x * right[1] - y * right[0]];
        let side = |i: usize, behind: bool| axes[i].ends[usize::from((eye[i] >= 0.0) != behind)];
        Self { axes, back: [0, 1, 2].map(|i| side(i, true)), front: [0, 1, 2].map(|i| side(i, false)), right, up }
    }

    /// Component of a point to the right on the screen.
    fn rightwards(&self, p: [f64; 3]) -> f64 {
        super::pointer::dot(self.right, p)
    }

    /// Returns the edge that carries the ticks of axis k, and the direction from it out of the box. Coordinate k of the
    /// edge is 0.
    fn edge(&self, k: usize) -> ([f64; 3], [f64; 3]) {
        let middle = [0, 1, 2].map(|i| 0.5 * (self.axes[i].ends[0] + self.axes[i].ends[1]));
        let mut at = match k {
            0 => [0.0, self.front[1], self.back[2]],
            1 => [self.front[0], 0.0, self.back[2]],
            _ => {
                let (one, other) = ([self.front[0], self.back[1], 0.0], [self.back[0], self.front[1], 0.0]);
                if self.rightwards(one) >= self.rightwards(other) { one } else { other }
            }
        };
        at[k] = 0.0;
        let mut out = [0, 1, 2].map(|i| if i == k { 0.0 } else { (at[i] - middle[i]) / self.axes[i].length() });
        // Labels are placed beside the floor, not below it.
        out[2] *= if k == 2 { 0.0 } else { 0.6 };
        (at, out)
    }

    /// Projects a direction to a unit vector of the screen, y down.
    fn on_screen(&self, out: [f64; 3]) -> [f64; 2] {
        let (x, y) = (super::pointer::dot(self.right, out), -super::pointer::dot(self.up, out));
        let length = x.hypot(y).max(1e-9);
        [x / length, y / length]
    }
}

/// Draws a box seen from `eye`, a unit vector from the scene towards the eye; `changes` says whether the box may
/// change.
pub fn draw(scene: &mut Scene, palette: &Palette, axes: &[Axis; 3], eye: [f64; 3], changes: ItemChanges) {
    let sight = Sight::new(axes, eye);
    let (mut grid, mut edges, mut ticks) = (Vec::new(), Vec::new(), Vec::new());
    // Each wall is numbered by its normal axis; grid lines run along one of its axes at the ticks of the other.
    for wall in 0..3 {
        for (across, along) in [((wall + 1) % 3, (wall + 2) % 3), ((wall + 2) % 3, (wall + 1) % 3)] {
            let ends_at = |place: f64| {
                let mut ends = [sight.back; 2];
                for (end, x) in ends.iter_mut().zip(axes[along].ends) {
                    (end[across], end[along]) = (place, x);
                }
                ends.map(|p| p.map(|x| x as f32)).to_vec()
            };
            grid.extend(axes[across].marks().map(|v| ends_at(axes[across].place(v))));
            edges.extend(axes[across].ends.map(ends_at));
        }
    }
    let first = scene.lines.len();
    for (k, axis) in axes.iter().enumerate() {
        mark(scene, &mut ticks, palette, &sight, k, axis);
    }
    let box_lines = [
        Polyline::new("axes/grid", grid, 1.0, faded(palette.line, 0.7)),
        Polyline::new("axes/edges", edges, 1.0, palette.line),
        Polyline::new("axes/ticks", ticks, 1.0, palette.dim),
    ];
    let box_lines = box_lines.map(|line| Polyline { changes, ..line });
    scene.lines.splice(first..first, box_lines);
}

/// Draws the ticks of axis k with their labels, the title and the current value.
fn mark(scene: &mut Scene, ticks: &mut Vec<Vec<[f32; 3]>>, palette: &Palette, sight: &Sight, k: usize, axis: &Axis) {
    let (edge, out) = sight.edge(k);
    let [dx, dy] = sight.on_screen(out);
    let longest = sight.axes.iter().map(Axis::length).fold(0.0, f64::max);
    let size = super::pointer::dot(out, out).sqrt().max(1e-9);
    let place = |value: f64, off: f64| {
        let mut p = edge;
        p[k] = axis.place(value);
        [0, 1, 2].map(|i| (p[i] + off * longest * out[i] / size) as f32)
    };
    let tick = |value: f64, length: f64| vec![place(value, 0.0), place(value, length)];
    let beside = |distance: f64| [(distance * dx) as f32, (0.8 * distance * dy) as f32];
    let anchor = if k == 2 { Anchor::Left } else { Anchor::Centre };
    let label = |name: &'static str, at, offset, text: String, colour, size| {
        Label::new(name, at, offset, text, colour, size, anchor)
    };
    let upright = k == 2;
    for value in axis.marks() {
        ticks.push(tick(value, 0.012));
        // The label of the current value replaces a nearby tick label.
        let room = if upright { 0.07 } else { 0.062 };
        if axis.now.is_some_and(|(now, _)| (now - value).abs() < room * (axis.values[1] - axis.values[0])) {
            continue;
        }
        let offset = if upright { [9.0, 0.0] } else { beside(19.0) };
        let text = signed(value, axis.decimals);
        scene.labels.push(label("axes/words", place(value, 0.012), offset, text, palette.dim, 11.5));
    }
    if let Some((now, colour)) = axis.now {
        scene.lines.push(Polyline::new(NOW[k], [tick(now, 0.022)], 2.0, colour));
        let offset = if upright { [9.0, 0.0] } else { beside(19.0) };
        scene.labels.push(label(
            "axes/now/words",
            place(now, 0.022),
            offset,
            signed(now, axis.now_decimals),
            colour,
            12.5,
        ));
    }
    // The title is above the vertical axis, and beyond the rear ends of the others.
    let (at, offset) = match upright {
        true => (place(axis.values[1], 0.0), [0.0, -18.0]),
        false => {
            let far = usize::from(sight.back[k] == axis.ends[1]);
            let beyond = axis.values[far] + 0.1 * (axis.values[far] - axis.values[1 - far]);
            // At the foot of the vertical axis, the title leaves space for the tick labels of that axis.
            let shared = sight.edge(2).0[k] == sight.back[k];
            (place(beyond, 0.012), beside(if shared { 48.0 } else { 19.0 }))
        }
    };
    scene.labels.push(Label::new("axes/titles", at, offset, axis.title(), axis.colour, 12.5, Anchor::Centre));
}

/// Returns an interval of length `width` that contains the given interval with a `margin` on both sides. Its centre is
/// as near to `home` as possible. If the given interval is too long, the result contains its lower part.
pub fn covering_range([low, high]: [f64; 2], home: f64, width: f64, margin: f64) -> [f64; 2] {
    let middle = home.max(high + margin - 0.5 * width).min(low - margin + 0.5 * width);
    [middle - 0.5 * width, middle + 0.5 * width]
}

/// Returns an interval of length `width` that contains a value. It is centred on `home` while the value is at least
/// `margin` inside, otherwise it is shifted with the value; so it moves continuously.
pub fn sliding_range(value: f64, home: f64, width: f64, margin: f64) -> [f64; 2] {
    let free = (0.5 * width - margin).max(0.0);
    let off = value - home;
    let middle = home + (off - off.clamp(-free, free));
    [middle - 0.5 * width, middle + 0.5 * width]
}
