//! [`Portrait`]: a small picture of a machine as plain data, seen from above in a pose that separates its links, or at
//! the start of its path. It needs kinematics only, so it is cheap.

mod svg;

use std::f64::consts::PI;

use super::linkage::{FlatLink, LinkageModel};
use stillbase_mechanics::machine::{Machine, place_of};
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase_planning::Motion;

pub use svg::portrait_svg;

/// Position of each relative angle between its limits, from 0 to 1. At 0.5, arms with symmetric limits would be
/// straight.
const BEND_FRACTION: f64 = 0.62;
/// Relative angle without limits, and angle between drives that no relative angle connects, rad.
const FREE_ANGLE_RAD: f64 = 1.0;
/// Number of orientations tried, over half a turn; the one that fills the picture best is chosen.
const ORIENTATIONS: usize = 24;
/// Number of parts of a path.
const PATH_POINTS: usize = 48;
/// Ratio of width to height of the picture for which the orientation is chosen.
const ASPECT_RATIO: f64 = 2.2;

/// A machine to be painted; lengths in m.
pub struct Portrait {
    /// The links, the lowest first.
    pub links: Vec<FlatLink>,
    /// Position of each pin.
    pub pins: Vec<Vector>,
    /// Position of the end effector.
    pub tip: Vector,
    /// Radius of the plate under the drives.
    pub foot: f64,
    /// Path of the end effector; empty if there is none.
    pub path: Vec<Vector>,
    /// Lower left and upper right corner of the bounding box.
    pub bounds: [Vector; 2],
}

impl Portrait {
    /// Computes the picture of a machine.
    pub fn of(machine: &Machine) -> Self {
        let linkage = LinkageModel::of(machine);
        let bent = bent(machine);
        let turned = |i: usize| {
            let turn = PI * i as f64 / ORIENTATIONS as f64;
            let q: Vec<f64> = bent.iter().map(|q| q + turn).collect();
            Self::posed(machine, &linkage, &q)
        };
        let first = turned(0);
        (1..ORIENTATIONS).map(turned).fold(first, |best, other| if other.size() < best.size() { other } else { best })
    }

    fn posed(machine: &Machine, linkage: &LinkageModel, q: &[f64]) -> Self {
        let e = DriveAngles(PerDrive::from_fn(q.len(), |k| q[k])).units();
        let (links, foot) = (linkage.flat(&e), linkage.foot());
        let tip = place_of(machine.end_effector(), &e);
        let mut bounds = [Vector::new(-foot, -foot), Vector::new(foot, foot)];
        let discs = links.iter().flat_map(|link| {
            let ends = link.ends.map(|at| (at, link.radius));
            let weights = link.covers.iter().flat_map(|cover| cover.ends.map(|end| (end, cover.radius)));
            ends.into_iter().chain(weights)
        });
        for (at, radius) in discs.chain([(tip, 0.03 * linkage.reach())]) {
            bounds[0] = Vector::new(bounds[0].re.min(at.re - radius), bounds[0].im.min(at.im - radius));
            bounds[1] = Vector::new(bounds[1].re.max(at.re + radius), bounds[1].im.max(at.im + radius));
        }
        let pins = linkage.joints(&e).map(|([x, y, _], _)| Vector::new(x, y)).collect();
        Self { links, pins, tip, foot, path: Vec::new(), bounds }
    }

    /// Computes the picture of a machine at the start of a motion, with the path of its end effector.
    pub fn of_path(machine: &Machine, motion: &Motion) -> Self {
        let pose = |i: usize| motion.path.at(i as f64 / PATH_POINTS as f64).q;
        let drives = machine.drives();
        let mut portrait = Self::posed(machine, &LinkageModel::of(machine), &pose(0).0[..drives]);
        let tip = |i: usize| place_of(machine.end_effector(), &pose(i).units());
        portrait.path = (0..=PATH_POINTS).map(tip).collect();
        for at in &portrait.path {
            let [low, high] = &mut portrait.bounds;
            *low = Vector::new(low.re.min(at.re), low.im.min(at.im));
            *high = Vector::new(high.re.max(at.re), high.im.max(at.im));
        }
        portrait
    }

    /// Height of the smallest picture with [`ASPECT_RATIO`] that contains the machine, m.
    fn size(&self) -> f64 {
        let size = self.bounds[1] - self.bounds[0];
        size.im.max(size.re / ASPECT_RATIO)
    }
}

/// Returns drive angles, rad, for which every relative angle is well within its limits.
fn bent(machine: &Machine) -> Vec<f64> {
    let mut q = vec![None; machine.drives()];
    for start in 0..q.len() {
        if q[start].is_none() {
            q[start] = Some(if start == 0 { 0.0 } else { q[start - 1].unwrap_or_default() + FREE_ANGLE_RAD });
        }
        // Each pass sets the drives that are connected to known drives.
        for _ in 0..q.len() {
            for angle in machine.angles() {
                let (low, high) = (*angle.limits.start(), *angle.limits.end());
                let bounded = low.is_finite() && high.is_finite();
                let by = if bounded { low + BEND_FRACTION * (high - low) } else { FREE_ANGLE_RAD } - angle.offset;
                match (q[angle.from], q[angle.to]) {
                    (Some(from), None) => q[angle.to] = Some(from + by),
                    (None, Some(to)) => q[angle.from] = Some(to - by),
                    _ => {}
                }
            }
        }
    }
    q.into_iter().map(Option::unwrap_or_default).collect()
}
