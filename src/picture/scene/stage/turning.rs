//! Rotation of a link by the pointer. Its drive follows the pointer about the root of the link, while the other drives
//! keep b constant.

use std::f64::consts::PI;

use crate::scene::exaggeration::DrawnFrame;
use crate::scene::linkage::Bar;
use crate::scene::options::Handle;
use crate::scene::pick::{ANGLE_SNAP, DragAction, GrabPoint, Grip, LinkHold, Pick};
use crate::scene::pointer::Pointer;
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector, dot};
use stillbase_planning::reactionless::{PlaneMap, PlanePoint};
use stillbase_simulation::frame::Frame;

/// Step of the search for the angle of a drive, rad.
const SEARCH_STEP_RAD: f64 = 0.02;

/// Returns the position of the pointer in the plane of a link, in the frame of the base, m.
fn place(bar: &Bar, shown: &DrawnFrame<'_>, pointer: &Pointer) -> Option<Vector> {
    let (.., z) = bar.pose(&shown.frame.q_reference.units());
    let [x, y] = pointer.ray()?.at_height(z)?;
    Some(shown.in_base(Vector::new(x, y)))
}

/// Drive angles relative to the base, rad.
fn relative(frame: &Frame) -> DriveAngles {
    DriveAngles(PerDrive::from_fn(frame.q.len(), |k| frame.relative(k)))
}

/// Angle from the direction of the link to the pointer, about the root of the link, rad, from −π to π.
fn off(bar: &Bar, q: &DriveAngles, at: Vector) -> f64 {
    let (root, along, _) = bar.pose(&q.units());
    ((at - root) * along.conj()).arg()
}

/// Picks a link for rotation.
pub fn grip(link: usize, bar: &Bar, map: &PlaneMap, shown: &DrawnFrame<'_>, pointer: &Pointer) -> Option<Pick> {
    // No drive turns a link that keeps its orientation.
    shown.frame.q_reference.get(bar.drive)?;
    let at = place(bar, shown, pointer)?;
    // Actual, not reference angles: the user picks the link at its drawn position.
    let angle = off(bar, &relative(shown.frame), at);
    let from = map.project(&shown.frame.q_reference).a;
    let (.., z) = bar.pose(&shown.q.units());
    let grip = Some(Grip::Link(LinkHold { angle, from, snaps: false }));
    Some(Pick { handle: Handle::Link(link), at: [at.re, at.im, z], grip })
}

/// Picks a link for a drag while the end effector stays.
pub fn hook(link: usize, bar: &Bar, shown: &DrawnFrame<'_>, pointer: &Pointer) -> Option<Pick> {
    let at = place(bar, shown, pointer)?;
    let q = relative(shown.frame);
    let (root, direction, z) = bar.pose(&q.units());
    let along = dot(at - root, direction).clamp(0.0, bar.length());
    let off = root + direction * along - at;
    let grip = Some(Grip::Pull(GrabPoint { along, offset: [off.re, off.im] }));
    Some(Pick { handle: Handle::Link(link), at: [at.re, at.im, z], grip })
}

/// Returns the change requested by dragging a link while the end effector stays.
pub fn pulled(
    link: usize,
    bar: &Bar,
    hook: &GrabPoint,
    shown: &DrawnFrame<'_>,
    pointer: &Pointer,
) -> Option<DragAction> {
    let at = place(bar, shown, pointer)?;
    Some(DragAction::Pull { link, along: hook.along, at: [at.re + hook.offset[0], at.im + hook.offset[1]] })
}

/// Returns the angles (a_1, a_2), rad, on the plane b for which the link follows the pointer. The search starts at the
/// present angle of the drive, goes in the direction of the pointer, and ends at the joint limits.
pub fn turned(
    bar: &Bar,
    grip: &LinkHold,
    map: &PlaneMap,
    shown: &DrawnFrame<'_>,
    pointer: &Pointer,
    b: f64,
) -> Option<[f64; 2]> {
    let at = place(bar, shown, pointer)?;
    let pose = |angle: f64| map.with_drive_at(bar.drive, angle, b, grip.from);
    let snapped = |angle: f64| match grip.snaps {
        true => pose((angle / ANGLE_SNAP).round() * ANGLE_SNAP),
        false => pose(angle),
    };
    let residual = |angle: f64| {
        let q = DriveAngles::from(map.lift(PlanePoint { a: pose(angle), b }));
        let miss = off(bar, &q, at) - grip.angle;
        (miss + PI).rem_euclid(2.0 * PI) - PI
    };
    let [low, high] = map.range_of(bar.drive, b);
    let mut now = shown.frame.q_reference[bar.drive].clamp(low, high);
    let first = residual(now);
    let step = SEARCH_STEP_RAD.copysign(first);
    for _ in 0..(2.0 * PI / SEARCH_STEP_RAD) as usize {
        let next = (now + step).clamp(low, high);
        let miss = residual(next);
        if miss * first <= 0.0 && miss.abs() < 1.0 {
            return Some(snapped(bisected(&residual, now, next)));
        }
        if next == now {
            break;
        }
        now = next;
    }
    Some(snapped(now))
}

/// Finds a change of sign of a function between two points by bisection.
fn bisected(f: &impl Fn(f64) -> f64, mut from: f64, mut to: f64) -> f64 {
    let sign = f(from);
    for _ in 0..50 {
        let middle = 0.5 * (from + to);
        if f(middle) * sign > 0.0 { from = middle } else { to = middle }
    }
    0.5 * (from + to)
}
