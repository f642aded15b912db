//! [`snap`]: where a pointer puts the end of a bar.

use super::drawing::{Bar, BarId, MIN_DISTANCE, PinId, Sketch};
use super::step::BarEnd;
use crate::planar::{Vector, cross, dot, unit};

/// Length to which a bar is rounded that snaps to nothing else, m.
const FREE_STEP: f64 = 1e-4;

/// What the end of a bar snaps to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnapOptions {
    /// Distance of grid lines, m; 0 for no grid.
    pub grid: f64,
    /// Step of angles from the x axis, rad; 0 for none but those of the bars.
    pub angle: f64,
    /// Largest distance from the pointer, m; 0 for nothing.
    pub radius: f64,
}

/// What a point lies on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Onto {
    /// A pin.
    Pin(PinId),
    /// The axis of a bar.
    Bar {
        /// The bar.
        bar: BarId,
        /// Distance from its root, m.
        along: f64,
    },
    /// A corner of the grid.
    Grid,
    /// A ray at a step of angles, or parallel to a bar.
    Angle,
    /// Nothing.
    Free,
}

/// Where a pointer puts the end of a bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snap {
    /// The point, m.
    pub point: [f64; 2],
    /// What it lies on.
    pub onto: Onto,
    /// Distance from the start of the bar, m; 0 without one.
    pub length: f64,
    /// Direction from the start of the bar, rad; 0 without one.
    pub angle: f64,
}

impl Snap {
    /// Returns the end of a bar here.
    pub fn end(&self) -> BarEnd {
        match self.onto {
            Onto::Pin(pin) => BarEnd::pin(pin),
            Onto::Bar { bar, along } => BarEnd::on(bar, along),
            Onto::Grid | Onto::Angle | Onto::Free => BarEnd::At(self.point),
        }
    }
}

/// Returns where a pointer puts the end of a bar that starts at `from`, m. In this order it snaps to the nearest pin,
/// to a bar, to an angle, and to the grid.
pub fn snap(sketch: &Sketch, from: Option<[f64; 2]>, pointer: [f64; 2], options: &SnapOptions) -> Snap {
    let pointer = Vector::new(pointer[0], pointer[1]);
    let start = from.map(|[x, y]| Vector::new(x, y));
    let (point, onto) = placed(sketch, start, pointer, options);
    let way = start.map_or_else(Vector::default, |start| point - start);
    Snap { point: [point.re, point.im], onto, length: way.norm(), angle: way.arg() }
}

fn placed(sketch: &Sketch, start: Option<Vector>, pointer: Vector, options: &SnapOptions) -> (Vector, Onto) {
    let far = |point: Vector| (point - pointer).norm();
    let is_near = |point: Vector| far(point) <= options.radius;
    let is_start = |point: Vector| start.is_some_and(|start| (point - start).norm() < MIN_DISTANCE);
    let pins = sketch.pins.iter().map(|pin| (pin.id, Vector::new(pin.at[0], pin.at[1])));
    let near = pins.filter(|(_, at)| is_near(*at) && !is_start(*at)).min_by(|a, b| far(a.1).total_cmp(&far(b.1)));
    if let Some((pin, at)) = near {
        return (at, Onto::Pin(pin));
    }
    let rays = start.map(|start| (start, ray(sketch, start, pointer, options)));
    let ray = rays.and_then(|(start, ray)| Some((start, ray?)));
    let axes = sketch.bars.iter().filter_map(|bar| Some((bar, on_axis(sketch, bar, ray, pointer, options.radius)?)));
    let near = axes.filter(|(_, at)| is_near(*at) && !is_start(*at)).min_by(|a, b| far(a.1).total_cmp(&far(b.1)));
    if let Some((bar, at)) = near {
        let along = dot(at - sketch.at(bar.root), sketch.direction(bar));
        return (at, Onto::Bar { bar: bar.id, along });
    }
    if let Some((start, along)) = ray {
        let length = length_on(sketch, start, along, pointer, options);
        if length >= MIN_DISTANCE {
            return (start + along.scale(length), Onto::Angle);
        }
    }
    if options.grid > 0.0 {
        let to = Vector::new(stepped(pointer.re, options.grid), stepped(pointer.im, options.grid));
        if is_near(to) && !is_start(to) {
            return (to, Onto::Grid);
        }
    }
    let free = start.filter(|start| *start != pointer).map(|start| {
        let way = pointer - start;
        start + way.scale(stepped(way.norm(), FREE_STEP) / way.norm())
    });
    (free.unwrap_or(pointer), Onto::Free)
}

fn stepped(x: f64, step: f64) -> f64 {
    (x / step).round() * step
}

/// Returns the direction of the ray from the start of a bar that is nearest to the pointer, if one is near enough.
fn ray(sketch: &Sketch, start: Vector, pointer: Vector, options: &SnapOptions) -> Option<Vector> {
    let way = pointer - start;
    let parallels = sketch.bars.iter().map(|bar| sketch.direction(bar));
    let step = (options.angle > 0.0).then(|| unit(stepped(way.arg(), options.angle)));
    let ahead = |along: Vector| if dot(along, way) < 0.0 { -along } else { along };
    let off = |along: &Vector| cross(*along, way).abs();
    let all = parallels.map(ahead).chain(step);
    all.filter(|along| off(along) <= options.radius && dot(*along, way) > 0.0).min_by(|a, b| off(a).total_cmp(&off(b)))
}

/// Returns the point of a bar's axis at the pointer: where the ray meets it if that is near, or the nearest point
/// between its outermost pins, at a whole step of the grid or of a millimetre from its root.
fn on_axis(sketch: &Sketch, bar: &Bar, ray: Option<(Vector, Vector)>, pointer: Vector, radius: f64) -> Option<Vector> {
    let (root, along) = (sketch.at(bar.root), sketch.direction(bar));
    let places = || bar.all_pins().map(|pin| sketch.along(bar, pin));
    let (low, high) = (places().fold(0.0, f64::min), places().fold(0.0, f64::max));
    if let Some((start, way)) = ray {
        let sine = cross(way, along);
        let at = start + way.scale(cross(root - start, along) / sine);
        let s = dot(at - root, along);
        if sine.abs() > 1e-6 && (at - pointer).norm() <= radius && (low..=high).contains(&s) {
            return Some(at);
        }
    }
    let s = stepped(dot(pointer - root, along), 10.0 * FREE_STEP);
    (low..=high).contains(&s).then(|| root + along.scale(s))
}

/// Returns the length of a bar along a ray, m: that of a parallel bar if the pointer is near it, else in whole steps.
fn length_on(sketch: &Sketch, start: Vector, along: Vector, pointer: Vector, options: &SnapOptions) -> f64 {
    let length = dot(pointer - start, along);
    let is_parallel = |bar: &&Bar| cross(sketch.direction(bar), along).abs() < 1e-9;
    let lengths = sketch.bars.iter().filter(is_parallel).map(|bar| sketch.length(bar));
    let off = |other: &f64| (other - length).abs();
    let same = lengths.filter(|other| off(other) <= options.radius).min_by(|a, b| off(a).total_cmp(&off(b)));
    let step = if options.grid > 0.0 { options.grid } else { FREE_STEP };
    same.unwrap_or_else(|| stepped(length, step))
}
