//! The scene of a drawing: bars in the colours of their drives, pins, motors, the end effector, and the bar under way.

mod limits;
mod lumps;
mod pick;
mod weights;

use std::sync::Arc;

use super::framing::ViewContent;
use super::palette::{Palette, Theme, faded, mix, palette};
use super::{Anchor, Body, Label, Marker, MeshSet, Polyline, Rgba, Scene, point};
use stillbase_mechanics::planar::Vector;
use stillbase_mechanics::sketch::{Bar, BarId, PinId, Resolved, Sketch};
use stillbase_settings::number::ShortNumber;

pub use limits::DrawnArc;
pub use lumps::lump_marker;
pub use pick::{bar_near, metres_per_px, pick};

/// Width of a square of the grid, m.
pub const GRID_M: f64 = 0.05;
/// Maximum number of grid lines on each side of the base.
const MAX_LINES: i32 = 120;
/// Least distance from the base that the view of a drawing shows, m.
const ROOM_M: f64 = 0.3;
/// Width of a bar, px.
const BAR_PX: f32 = 10.0;
/// Radius of a pin, px.
const PIN_PX: f32 = 5.0;
/// Radius of the ring of the first motor at a pin, and the difference to the next, px.
const MOTOR_PX: f32 = 15.0;
const NEXT_MOTOR_PX: f32 = 6.0;

/// A thing of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SketchItem {
    /// A pin.
    Pin(PinId),
    /// A bar.
    Bar(BarId),
    /// A lump: its bar, and which of the lumps of the bar, counted from 1.
    Lump(BarId, usize),
    /// A joint limit: the number of its arc, from 0, and 0 for the lower or 1 for the upper limit.
    Limit(usize, usize),
}

/// A bar under way, from its start to the pointer.
#[derive(Clone, Debug, PartialEq)]
pub struct Rubber {
    /// Its ends, m.
    pub ends: [[f64; 2]; 2],
    /// Whether its end lies on a pin or a bar.
    pub is_caught: bool,
}

/// What the scene of a drawing shows beside it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SketchOptions {
    /// Light or dark colours.
    pub theme: Theme,
    /// The thing under the pointer.
    pub hot: Option<SketchItem>,
    /// The chosen thing.
    pub chosen: Option<SketchItem>,
    /// The bar under way.
    pub rubber: Option<Rubber>,
    /// The place of the pin with which a dragged pin becomes one, m.
    pub ring: Option<[f64; 2]>,
}

/// Returns how a pin is called.
pub fn pin_title(sketch: &Sketch, pin: PinId) -> String {
    if pin == sketch.base { "pin B".to_owned() } else { format!("pin {}", pin.0) }
}

/// Returns the points that the camera has to show, m.
pub fn content(sketch: &Sketch) -> ViewContent {
    let base = sketch.at(sketch.base);
    let room = [[-ROOM_M, -0.5 * ROOM_M], [ROOM_M, 2.0 * ROOM_M]];
    let room = room.map(|[x, y]| [base.re + x, base.im + y, 0.0]);
    let pins = sketch.pins.iter().map(|pin| [pin.at[0], pin.at[1], 0.0]);
    ViewContent { first: pins.chain(weights::corners(sketch)).chain(room).collect(), then: vec![] }
}

/// Returns the scene of a drawing.
pub fn scene(model: Arc<MeshSet>, sketch: &Sketch, resolved: &Resolved, options: &SketchOptions) -> Scene {
    let palette = palette(options.theme);
    let mut scene = Scene::new(palette.background, model);
    grid(&mut scene, sketch, &palette);
    let drawing = Drawing { sketch, resolved, options, palette: &palette };
    weights::draw(&mut scene, &drawing);
    drawing.bars(&mut scene);
    lumps::draw(&mut scene, sketch, options, &palette);
    drawing.motors(&mut scene);
    limits::draw(&mut scene, sketch, options.hot, &palette);
    drawing.pins(&mut scene);
    drawing.end_effector(&mut scene);
    drawing.rubber(&mut scene);
    drawing.ring(&mut scene);
    scene
}

/// Draws lines at every 50 mm, so many that they fill the view of the drawing.
fn grid(scene: &mut Scene, sketch: &Sketch, palette: &Palette) {
    let far = sketch.pins.iter().flat_map(|pin| pin.at).fold(2.0 * ROOM_M, |far, x| far.max(x.abs()));
    let n = ((4.0 * far / GRID_M).ceil() as i32).min(MAX_LINES);
    let end = f64::from(n) * GRID_M;
    let lines = |every: i32| -> Vec<Vec<[f32; 3]>> {
        let both = |i: i32| {
            let at = f64::from(i) * GRID_M;
            [[[at, -end], [at, end]], [[-end, at], [end, at]]]
                .map(|ends| ends.map(|[x, y]| point(Vector::new(x, y), 0.0)).to_vec())
        };
        (-n..=n).filter(|i| (i % 10 == 0) == (every == 10)).flat_map(both).collect()
    };
    scene.lines.push(Polyline::new("sketch/grid", lines(1), 1.0, faded(palette.line, 0.5)));
    scene.lines.push(Polyline::new("sketch/grid/half-metres", lines(10), 1.0, palette.line));
}

/// A drawing on its way into a scene.
#[derive(Clone, Copy)]
struct Drawing<'a> {
    sketch: &'a Sketch,
    resolved: &'a Resolved,
    options: &'a SketchOptions,
    palette: &'a Palette,
}

impl Drawing<'_> {
    /// Returns the colour of a drive, by its name.
    fn drive(&self, name: &str) -> Rgba {
        let k = self.sketch.motors.iter().position(|motor| motor.drive.name == name);
        k.map_or(self.palette.dim, |k| self.palette.drive(k))
    }

    /// Returns the colour of a bar: that of its drive, or grey without one.
    fn tone(&self, bar: &Bar) -> Rgba {
        let follow = self.resolved.drives.get(&bar.id);
        follow.map_or(mix(self.palette.dim, self.palette.line, 0.4), |follow| self.drive(&follow.drive))
    }

    fn at(&self, pin: PinId) -> [f32; 3] {
        point(self.sketch.at(pin), 0.0)
    }

    fn bars(&self, scene: &mut Scene) {
        for bar in &self.sketch.bars {
            let places = || bar.all_pins().map(|pin| (self.sketch.along(bar, pin), pin));
            let ends = places().min_by(|a, b| a.0.total_cmp(&b.0)).zip(places().max_by(|a, b| a.0.total_cmp(&b.0)));
            let Some(((_, low), (_, high))) = ends else { continue };
            let ends = [self.at(low), self.at(high)];
            let item = Some(SketchItem::Bar(bar.id));
            let line = |width, tone| Polyline::new("sketch/bars", [ends.to_vec()], width, tone);
            let edge = match (self.options.chosen == item, self.options.hot == item) {
                (true, _) => Some(self.palette.amber),
                (_, true) => Some(self.palette.ink),
                _ => None,
            };
            // A margin in the colour of the background separates bars that cross.
            let (margin, wide) = edge.map_or((self.palette.background, 3.0), |edge| (edge, 4.0));
            let tone = self.tone(bar);
            // Labels leave its axis free.
            scene.bodies.push(Body { ends, radius: 0.0, height: 0.0 });
            scene.lines.push(line(BAR_PX + wide, margin));
            scene.lines.push(line(BAR_PX, tone));
            scene.lines.push(line(1.0, faded(self.palette.background, 0.55)));
            for end in ends {
                scene.markers.push(Marker::disc("sketch/bars/ends", end, 0.5 * BAR_PX, tone));
            }
            let [from, to] = ends;
            let middle = [0, 1, 2].map(|i| 0.5 * (from[i] + to[i]));
            let way = Vector::new(f64::from(to[1] - from[1]), f64::from(to[0] - from[0]));
            let aside = way.scale(14.0 / way.norm().max(1e-9));
            let offset = [aside.re as f32, aside.im as f32];
            let anchor = if offset[0] >= 0.0 { Anchor::Left } else { Anchor::Right };
            let words = Label::new("sketch/names", middle, offset, bar.name.clone(), self.palette.dim, 12.0, anchor);
            scene.labels.push(words);
        }
    }

    /// Draws motors as rings about their pins in the colours of their drives.
    fn motors(&self, scene: &mut Scene) {
        let nothing = faded(self.palette.background, 0.0);
        for (i, motor) in self.sketch.motors.iter().enumerate() {
            let before = self.sketch.motors[..i].iter().filter(|other| other.pin == motor.pin).count();
            let radius = MOTOR_PX + NEXT_MOTOR_PX * before as f32;
            let ring = Marker::disc("sketch/motors", self.at(motor.pin), radius, nothing);
            scene.markers.push(ring.edged(self.drive(&motor.drive.name), 2.4));
        }
    }

    fn pins(&self, scene: &mut Scene) {
        for pin in &self.sketch.pins {
            let item = Some(SketchItem::Pin(pin.id));
            let at = self.at(pin.id);
            let edge = match (self.options.chosen == item, self.options.hot == item) {
                (true, _) => self.palette.amber,
                (_, true) => self.palette.ink,
                _ => mix(self.palette.ink, self.palette.background, 0.15),
            };
            if pin.id == self.sketch.base {
                let grey = mix(self.palette.dim, self.palette.background, 0.35);
                scene.markers.push(Marker::disc("sketch/base", at, 11.0, grey).edged(edge, 1.6));
                let b = Label::new("sketch/base/name", at, [0.0, 34.0], "B", self.palette.dim, 12.0, Anchor::Centre);
                scene.labels.push(b);
            } else {
                let words = pin_title(self.sketch, pin.id);
                let away = [8.0, 15.0];
                let label = Label::new("sketch/pins/names", at, away, words, self.palette.dim, 10.5, Anchor::Left);
                scene.labels.push(label);
            }
            let is_lit = self.options.hot == item || self.options.chosen == item;
            if is_lit {
                let glow = Marker::disc("sketch/pins/lit", at, 2.0 * PIN_PX, faded(edge, 0.25));
                scene.markers.push(glow.edged(edge, 1.4));
            }
            scene.markers.push(Marker::disc("sketch/pins", at, PIN_PX, self.palette.background).edged(edge, 2.0));
        }
    }

    fn end_effector(&self, scene: &mut Scene) {
        let Some(end) = self.sketch.end_effector else { return };
        let at = self.at(end.pin);
        let ring = Marker::disc("sketch/end-effector", at, 9.5, faded(self.palette.background, 0.0));
        scene.markers.push(ring.edged(self.palette.ink, 1.8));
        let words = "end effector";
        let label =
            Label::new("sketch/end-effector/name", at, [16.0, 0.0], words, self.palette.dim, 11.5, Anchor::Left);
        scene.labels.push(label);
    }

    /// Draws a ring about the pin with which another becomes one.
    fn ring(&self, scene: &mut Scene) {
        let Some([x, y]) = self.options.ring else { return };
        let at = point(Vector::new(x, y), 0.0);
        for (radius, width) in [(11.0, 2.4), (17.0, 1.2)] {
            let ring = Marker::disc("sketch/ring", at, radius, faded(self.palette.background, 0.0));
            scene.markers.push(ring.edged(self.palette.amber, width));
        }
    }

    /// Draws the bar under way, dashed.
    fn rubber(&self, scene: &mut Scene) {
        let Some(Rubber { ends, is_caught }) = &self.options.rubber else { return };
        let [from, to] = ends.map(|[x, y]| point(Vector::new(x, y), 0.0));
        let tone = self.palette.amber;
        scene.lines.push(Polyline::new("sketch/rubber", [vec![from, to]], BAR_PX, faded(tone, 0.35)).on_top());
        scene.lines.push(Polyline::new("sketch/rubber/axis", [vec![from, to]], 1.2, tone).dashed(4.0, 4.0).on_top());
        let radius = if *is_caught { 9.0 } else { PIN_PX };
        scene.markers.push(Marker::disc("sketch/rubber/end", to, radius, self.palette.background).edged(tone, 2.0));
    }
}
