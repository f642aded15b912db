//! The motion at one b that is closest to a given motion and has the same end effector path. This module serves more
//! than three drives, [`on_plane`](super::on_plane) three.
//!
//! A point and a b leave n − 3 degrees of freedom. Among these poses this module chooses the one closest to the given
//! pose in the metric of kinetic energy. Sample by sample, Newton's method minimises ½ Σ H_kk Δq_k² with p and b
//! fixed. The result depends smoothly on the sample alone; joint limits are checked, not imposed.

use nalgebra::{DMatrix, DVector};
use thiserror::Error;

use super::deviation::{angle_distance, least};
use crate::curves::given::Samples;
use crate::pose_space::PoseSpace;
use crate::reactionless::BSet;
use stillbase_mechanics::machine::Inertia;
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector, unit};
use stillbase_query::ProgressCallback;

/// Number of samples from which the deviation at a b is computed.
const DEVIATION_SAMPLES: usize = 61;
/// Number of samples whose feasible sets of b are intersected to find the candidate intervals.
const REACH_SAMPLES: usize = 25;
/// Number of b tried in each interval.
const TRIES: usize = 12;
/// Number of golden section steps that refine the best b.
const SECTIONS: usize = 16;
/// Maximum number of Newton iterations.
const MAX_ITERATIONS: usize = 40;
/// Maximum Newton step of a drive angle, rad.
const MAX_STEP_RAD: f64 = 0.3;
/// Newton's method has converged when no drive angle moves by this or more, rad.
const STEP_TOLERANCE_RAD: f64 = 1e-12;
/// Tolerance of the limits of relative angles, rad.
const LIMIT_TOLERANCE_RAD: f64 = 1e-9;

/// Why samples cannot be moved to another b.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoClosestMotion {
    /// Newton's method found no pose.
    #[error("at {time:.3} s no pose at b = {b:.4} rad near the given pose has the end effector at ({:.3}, {:.3}) m", at.re, at.im)]
    Pose {
        /// Time of the sample, s.
        time: f64,
        /// Pose constant, rad.
        b: f64,
        /// Position of the end effector, m.
        at: Vector,
    },
    /// The closest pose is beyond a limit.
    #[error("at {time:.3} s the pose at b = {b:.4} rad that is closest to the given one has a{} past its {} limit", angle + 1, if *upper { "upper" } else { "lower" })]
    Limit {
        /// Time of the sample, s.
        time: f64,
        /// Pose constant, rad.
        b: f64,
        /// Index of the relative angle, counted from 0.
        angle: usize,
        /// Whether it is past the upper limit, else the lower.
        upper: bool,
    },
}

/// Moves every sample to b, rad, with its end effector position unchanged.
///
/// # Errors
/// At the first sample for which no pose is found, or the pose is beyond a limit.
pub(super) fn same_tip(
    space: &PoseSpace,
    model: &Inertia,
    samples: &Samples,
    b: f64,
) -> Result<Samples, NoClosestMotion> {
    let mut rows = Vec::with_capacity(samples.count());
    // The first guess is the given pose plus the offset of the sample before.
    let mut off = PerDrive::zeros(space.drives());
    let mut pull = [0.0; 3];
    for i in 0..samples.count() {
        let given = PerDrive::from_fn(space.drives(), |k| samples.values(i)[k]);
        let (time, at) = (samples.time(i), space.end_effector(&given));
        let q = closest(space, model, &given, b, given.plus(1.0, &off), &mut pull);
        let q = q.ok_or(NoClosestMotion::Pose { time, b, at })?;
        for (joint, a) in space.joints().iter().zip(space.angles(&q).iter()) {
            let [low, high] = joint.bounds();
            if let (Some(angle), true) =
                (joint.angle(), *a < low - LIMIT_TOLERANCE_RAD || *a > high + LIMIT_TOLERANCE_RAD)
            {
                return Err(NoClosestMotion::Limit { time, b, angle, upper: *a > high });
            }
        }
        off = q.0.minus(&given);
        rows.push(q.to_vec());
    }
    samples.with_values(rows).ok_or(NoClosestMotion::Pose { time: samples.time(0), b, at: Vector::default() })
}

/// Finds the constant b, rad, whose motion with the same end effector path is closest to the given one. Also returns
/// the ‖Δq‖, rad, of that motion. Both come from at most 61 of the samples. Returns `None` if no b was found, or if
/// `goes_on` cancels the search.
pub(super) fn nearest_b(
    space: &PoseSpace,
    model: &Inertia,
    samples: &Samples,
    goes_on: ProgressCallback<'_>,
) -> Option<(f64, f64)> {
    let thin = samples.thinned(DEVIATION_SAMPLES);
    let far =
        |b: f64| same_tip(space, model, &thin, b).map_or(f64::INFINITY, |moved| angle_distance(model, &thin, &moved));
    let mean = (0..thin.count()).map(|i| space.b(thin.values(i))).sum::<f64>() / thin.count() as f64;
    let reached = samples.thinned(REACH_SAMPLES);
    let sets: Option<Vec<BSet>> =
        (0..reached.count()).map(|i| space.reach(space.end_effector(reached.values(i))).ok()).collect();
    least(&BSet::overlap(&sets?), mean, [TRIES, SECTIONS], far, goes_on)
}

/// Finds the pose at b that is closest to a given one and has the same end effector position, from a first guess.
/// `pull` holds the Lagrange multipliers of the end effector and of b; the next sample starts from them.
fn closest(
    space: &PoseSpace,
    model: &Inertia,
    given: &PerDrive,
    b: f64,
    from: PerDrive,
    pull: &mut [f64; 3],
) -> Option<DriveAngles> {
    let (n, reach, p) = (space.drives(), space.farthest(), space.end_effector(given));
    let whole: f64 = (0..n).map(|k| model.diagonal(k)).sum();
    let weight = |k: usize| (model.diagonal(k) / whole).max(1e-6);
    let row = reach / space.lambda().max_abs();
    let mut q = from;
    for _ in 0..MAX_ITERATIONS {
        let mut square = DMatrix::<f64>::zeros(n + 3, n + 3);
        let mut side = DVector::<f64>::zeros(n + 3);
        let off = (p - space.end_effector(&q)) / reach;
        for k in 0..n {
            let arm = unit(q[k]) * (space.arms()[k] / reach);
            let rows = [-arm.im, arm.re, row * space.lambda()[k] / reach];
            for (i, x) in rows.into_iter().enumerate() {
                (square[(n + i, k)], square[(k, n + i)]) = (x, x);
            }
            // Curvature of the constraint, bounded so that the Hessian stays positive definite.
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
        let short = if size > MAX_STEP_RAD { MAX_STEP_RAD / size } else { 1.0 };
        q = PerDrive::from_fn(n, |k| q[k] + short * step[k]);
        *pull = [step[n], step[n + 1], step[n + 2]];
        if size < STEP_TOLERANCE_RAD {
            let off = (p - space.end_effector(&q)).norm() / reach;
            return (off < 1e-10 && (b - space.b(&q)).abs() < 1e-10).then_some(DriveAngles(q));
        }
    }
    let (off, b_error) = ((p - space.end_effector(&q)).norm() / reach, (b - space.b(&q)).abs());
    (off < 1e-10 && b_error < 1e-10).then_some(DriveAngles(q))
}
