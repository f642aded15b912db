//! A link that the pointer turns: its drive follows the pointer about the link's root, and the others follow so that b
//! stays.

use std::f64::consts::PI;

use crate::mechanics::planar::{DriveAngles, PerDrive, Vector, dot};
use crate::picture::scene::exaggeration::Shown;
use crate::picture::scene::linkage::Bar;
use crate::picture::scene::options::Handle;
use crate::picture::scene::pick::{Aim, Grip, Hold, Hook, Pick, ROUND_ANGLE};
use crate::picture::scene::pointer::Pointer;
use crate::planning::reactionless::{PlaneMap, PlanePoint};
use crate::simulation::frame::Frame;

/// Steps in which the angle of a drive is sought, rad.
const LOOK: f64 = 0.02;

/// Where the pointer is in the plane of a link, as seen from the base, m.
fn place(bar: &Bar, shown: &Shown<'_>, pointer: &Pointer) -> Option<Vector> {
    let (.., z) = bar.pose(&shown.frame.q_reference.units());
    let [x, y] = pointer.ray()?.at_height(z)?;
    Some(shown.in_base(Vector::new(x, y)))
}

/// Angles of the drives relative to the base, rad.
fn relative(frame: &Frame) -> DriveAngles {
    DriveAngles(PerDrive::from_fn(frame.q.len(), |k| frame.relative(k)))
}

/// From the direction of the link to the pointer about its root, rad, from −π to π.
fn off(bar: &Bar, q: &DriveAngles, at: Vector) -> f64 {
    let (root, along, _) = bar.pose(&q.units());
    ((at - root) * along.conj()).arg()
}

/// A link, taken hold of.
pub fn grip(link: usize, bar: &Bar, map: &PlaneMap, shown: &Shown<'_>, pointer: &Pointer) -> Option<Pick> {
    let at = place(bar, shown, pointer)?;
    // As the machine is, not as it should be: that is what is taken hold of.
    let angle = off(bar, &relative(shown.frame), at);
    let from = map.project(&shown.frame.q_reference).a;
    let (.., z) = bar.pose(&shown.q.units());
    let grip = Some(Grip::Link(Hold { angle, from, snaps: false }));
    Some(Pick { handle: Handle::Link(link), at: [at.re, at.im, z], grip })
}

/// A link, taken hold of to be pulled while the end effector stays.
pub fn hook(link: usize, bar: &Bar, shown: &Shown<'_>, pointer: &Pointer) -> Option<Pick> {
    let at = place(bar, shown, pointer)?;
    let q = relative(shown.frame);
    let (root, direction, z) = bar.pose(&q.units());
    let along = dot(at - root, direction).clamp(0.0, bar.length());
    let off = root + direction * along - at;
    let grip = Some(Grip::Pull(Hook { along, off: [off.re, off.im] }));
    Some(Pick { handle: Handle::Link(link), at: [at.re, at.im, z], grip })
}

/// Where the pointer pulls it.
pub fn pulled(link: usize, bar: &Bar, hook: &Hook, shown: &Shown<'_>, pointer: &Pointer) -> Option<Aim> {
    let at = place(bar, shown, pointer)?;
    Some(Aim::Pull { link, along: hook.along, at: [at.re + hook.off[0], at.im + hook.off[1]] })
}

/// The angles (a_1, a_2), rad, at which the link points to the pointer, on the plane b: sought from the present angle of
/// its drive the way that the pointer pulls, as far as the joint limits let it.
pub fn turned(
    bar: &Bar,
    grip: &Hold,
    map: &PlaneMap,
    shown: &Shown<'_>,
    pointer: &Pointer,
    b: f64,
) -> Option<[f64; 2]> {
    let at = place(bar, shown, pointer)?;
    let pose = |angle: f64| map.turned(bar.drive, angle, b, grip.from);
    let stops = |angle: f64| match grip.snaps {
        true => pose((angle / ROUND_ANGLE).round() * ROUND_ANGLE),
        false => pose(angle),
    };
    let misses = |angle: f64| {
        let q = DriveAngles::from(map.lift(PlanePoint { a: pose(angle), b }));
        let miss = off(bar, &q, at) - grip.angle;
        (miss + PI).rem_euclid(2.0 * PI) - PI
    };
    let [low, high] = map.range_of(bar.drive, b);
    let mut now = shown.frame.q_reference[bar.drive].clamp(low, high);
    let first = misses(now);
    let step = LOOK.copysign(first);
    for _ in 0..(2.0 * PI / LOOK) as usize {
        let next = (now + step).clamp(low, high);
        let miss = misses(next);
        if miss * first <= 0.0 && miss.abs() < 1.0 {
            return Some(stops(bisected(&misses, now, next)));
        }
        if next == now {
            break;
        }
        now = next;
    }
    Some(stops(now))
}

/// Where a function changes its sign between two places.
fn bisected(f: &impl Fn(f64) -> f64, mut from: f64, mut to: f64) -> f64 {
    let sign = f(from);
    for _ in 0..50 {
        let middle = 0.5 * (from + to);
        if f(middle) * sign > 0.0 { from = middle } else { to = middle }
    }
    0.5 * (from + to)
}
