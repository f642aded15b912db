//! The motion of b that is closest to a given one with the same end effector, where points leave freedoms: what
//! [`on_plane`](super::on_plane) is on planes.
//!
//! A point and a b leave n − 3 freedoms, so that of all poses there the one is taken that is closest to the given one in
//! the metric of kinetic energy: least ½ Σ H_kk Δq_k² with p and b kept, by Newton's iteration, sample by sample. It
//! depends on the sample alone, and so smoothly while none is at a limit.

use nalgebra::{DMatrix, DVector};
use thiserror::Error;

use super::deviation::{apart, least};
use crate::mechanics::machine::Inertia;
use crate::mechanics::planar::{DriveAngles, PerDrive, Vector, unit};
use crate::planning::curves::given::Samples;
use crate::planning::pose_space::PoseSpace;
use crate::planning::reactionless::BSet;
use crate::query::Watch;

/// Samples that judge a b, and those of which it is asked which b reach them.
const JUDGED: usize = 61;
const ASKED: usize = 25;
/// b that are tried in each interval, and golden sections after that.
const TRIES: usize = 12;
const SECTIONS: usize = 16;
/// Steps of Newton's iteration, the longest, and when it has arrived, rad and a share of the reach.
const STEPS: usize = 40;
const LONGEST: f64 = 0.3;
const ARRIVED: f64 = 1e-12;
/// What rounding passes a limit by is none, rad.
const SLACK: f64 = 1e-9;

/// Why samples cannot be moved.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoneClose {
    /// No pose was found.
    #[error("at {time:.3} s no pose at b = {b:.4} rad beside the given one has the end effector at ({:.3}, {:.3}) m", at.re, at.im)]
    Pose {
        /// s.
        time: f64,
        /// rad.
        b: f64,
        /// m.
        at: Vector,
    },
    /// The closest pose is beyond a limit.
    #[error("at {time:.3} s the pose at b = {b:.4} rad that is closest to the given one has a{} past its {} limit", angle + 1, if *upper { "upper" } else { "lower" })]
    Limit {
        /// s.
        time: f64,
        /// rad.
        b: f64,
        /// Counted from 0.
        angle: usize,
        /// The greatest value, else the least.
        upper: bool,
    },
}

/// The samples moved onto b, rad, with the end effector where it was at every one of them.
///
/// # Errors
/// Where that cannot be done.
pub(super) fn same_tip(space: &PoseSpace, model: &Inertia, samples: &Samples, b: f64) -> Result<Samples, NoneClose> {
    let mut rows = Vec::with_capacity(samples.count());
    // Beside the pose of the sample before, moved as the given one has.
    let mut off = PerDrive::zeros(space.drives());
    let mut pull = [0.0; 3];
    for i in 0..samples.count() {
        let given = PerDrive::from_fn(space.drives(), |k| samples.values(i)[k]);
        let (time, at) = (samples.time(i), space.place(&given));
        let q = closest(space, model, &given, b, given.plus(1.0, &off), &mut pull);
        let q = q.ok_or(NoneClose::Pose { time, b, at })?;
        for (joint, a) in space.joints().iter().zip(space.angles(&q).iter()) {
            let [low, high] = joint.bounds();
            if let (Some(angle), true) = (joint.angle(), *a < low - SLACK || *a > high + SLACK) {
                return Err(NoneClose::Limit { time, b, angle, upper: *a > high });
            }
        }
        off = q.0.minus(&given);
        rows.push(q.to_vec());
    }
    samples.with_values(rows).ok_or(NoneClose::Pose { time: samples.time(0), b, at: Vector::default() })
}

/// The constant b whose motion with the same end effector is closest to the given one, rad, and its ‖Δq‖, rad; `None` if
/// none was found, or the rest is not wanted. Judged by some sixty of the samples.
pub(super) fn nearest_b(
    space: &PoseSpace,
    model: &Inertia,
    samples: &Samples,
    goes_on: Watch<'_>,
) -> Option<(f64, f64)> {
    let thin = samples.thinned(JUDGED);
    let far = |b: f64| same_tip(space, model, &thin, b).map_or(f64::INFINITY, |moved| apart(model, &thin, &moved));
    let mean = (0..thin.count()).map(|i| space.b(thin.values(i))).sum::<f64>() / thin.count() as f64;
    let asked = samples.thinned(ASKED);
    let sets: Option<Vec<BSet>> = (0..asked.count()).map(|i| space.reach(space.place(asked.values(i))).ok()).collect();
    least(&BSet::overlap(&sets?), mean, [TRIES, SECTIONS], far, goes_on)
}

/// The pose at b with the end effector of a given one that is closest to it, from a first guess; `pull` holds what
/// multiplies the end effector and b, which the next sample begins with.
fn closest(
    space: &PoseSpace,
    model: &Inertia,
    given: &PerDrive,
    b: f64,
    from: PerDrive,
    pull: &mut [f64; 3],
) -> Option<DriveAngles> {
    let (n, reach, p) = (space.drives(), space.farthest(), space.place(given));
    let whole: f64 = (0..n).map(|k| model.diagonal(k)).sum();
    let weight = |k: usize| (model.diagonal(k) / whole).max(1e-6);
    let row = reach / space.lambda().max_abs();
    let mut q = from;
    for _ in 0..STEPS {
        let mut square = DMatrix::<f64>::zeros(n + 3, n + 3);
        let mut side = DVector::<f64>::zeros(n + 3);
        let off = (p - space.place(&q)) / reach;
        for k in 0..n {
            let arm = unit(q[k]) * (space.tip()[k] / reach);
            let rows = [-arm.im, arm.re, row * space.lambda()[k] / reach];
            for (i, x) in rows.into_iter().enumerate() {
                (square[(n + i, k)], square[(k, n + i)]) = (x, x);
            }
            // How the arms curve counts as far as it leaves a least.
            let bend = -(pull[0] * arm.re + pull[1] * arm.im);
            square[(k, k)] = weight(k) + bend.max(-0.9 * weight(k));
            side[k] = -weight(k) * (q[k] - given[k]);
        }
        (side[n], side[n + 1], side[n + 2]) = (off.re, off.im, row * (b - space.b(&q)) / reach);
        let step = square.lu().solve(&side)?;
        let size = (0..n).fold(0.0, |m: f64, k| m.max(step[k].abs()));
        if !size.is_finite() {
            return None;
        }
        let short = if size > LONGEST { LONGEST / size } else { 1.0 };
        q = PerDrive::from_fn(n, |k| q[k] + short * step[k]);
        *pull = [step[n], step[n + 1], step[n + 2]];
        if size < ARRIVED {
            let off = (p - space.place(&q)).norm() / reach;
            return (off < 1e-10 && (b - space.b(&q)).abs() < 1e-10).then_some(DriveAngles(q));
        }
    }
    let (off, left) = ((p - space.place(&q)).norm() / reach, (b - space.b(&q)).abs());
    (off < 1e-10 && left < 1e-10).then_some(DriveAngles(q))
}
