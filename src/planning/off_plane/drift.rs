//! Joint drift on a closed path of the end effector that is followed repeatedly at zero angular momentum.
//!
//! D(q) q̇ = 0 is nonholonomic if D depends on the pose: the end effector returns, the joints do not. On an invariant
//! machine of three drives the joints return too, up to rounding. For this reason the paper requires invariance, (8).

use thiserror::Error;

use crate::curves::PathPoint;
use crate::curves::curve::{Curve, CurvePoint};
use crate::curves::path::by_pieces;
use crate::curves::table::PathTable;
use crate::off_plane::momentum::MomentumModel;
use crate::off_plane::null_space::{motion_of, rates, runge_kutta_step};
use stillbase_mechanics::kinematics::column;
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector, unit};
use stillbase_settings::number::counted;

/// Why no motion of zero momentum follows a curve.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum DriftError {
    /// The machine has fewer than three drives, or the start pose has a different number of angles.
    #[error("{}: zero momentum needs three or more, and one start angle for each", counted(drives, "drive"))]
    Drives {
        /// Drives of the machine.
        drives: usize,
    },
    /// The start pose is not on the curve's first point.
    #[error("the start pose has the end effector {miss:.2e} m off the curve's first point: want it there")]
    Start {
        /// Distance of its end effector from that point, m.
        miss: f64,
    },
    /// The curve is not closed.
    #[error("the curve ends {gap:.2e} m from where it begins: want a closed one")]
    Open {
        /// Distance between its ends, m.
        gap: f64,
    },
    /// [J; D] is singular.
    #[error(
        "{:.1} % along its curve, at ({:.3}, {:.3}) m{}, {why}; want another path or another pose of A",
        100.0 * s, at[0], at[1], in_cycle(*cycle)
    )]
    Singular {
        /// s of the curve, 0 to 1.
        s: f64,
        /// Where the curve is there, m.
        at: [f64; 2],
        /// Number of the cycle, counted from 1.
        cycle: usize,
        /// What is singular.
        why: Singularity,
    },
}

/// Returns the words for a cycle; none for the first.
fn in_cycle(cycle: usize) -> String {
    if cycle > 1 { format!(" in cycle {cycle}") } else { String::new() }
}

/// What keeps the end effector from moving on at zero momentum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Singularity {
    /// The Jacobian of the end effector in its frame: the arm is outstretched or folded.
    Kinematic,
    /// The Jacobian with the momentum: the end effector moves that way only with momentum.
    Dynamic,
    /// The Jacobian of the arm beside its free base: no motion of the arm moves the end effector that way in space.
    Joint,
}

impl std::fmt::Display for Singularity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Kinematic => "no rates of zero momentum follow it: the arm is outstretched or folded there",
            Self::Dynamic => {
                "no rates of zero momentum follow it: a dynamic singularity, where the end effector moves that way only \
                 with momentum"
            }
            Self::Joint => "no rates follow it: the base gives way as the arm moves the end effector there",
        })
    }
}

/// A pose is kinematically singular if the ratio of the singular values of J is below this.
const STRETCHED: f64 = 0.05;

impl Singularity {
    /// Returns the singularity that stops motions with momentum, too.
    pub(super) fn with_base(self) -> Self {
        if self == Self::Dynamic { Self::Joint } else { self }
    }

    /// Tells which matrix is singular near a pose.
    pub(crate) fn near(model: &MomentumModel, q: &DriveAngles) -> Self {
        let tip = model.tip_units(&q.units());
        let [xx, xy, yy] = (0..model.drives()).fold([0.0; 3], |[xx, xy, yy], k| {
            let j = column(model.tip(), &tip, k);
            [xx + j.re * j.re, xy + j.re * j.im, yy + j.im * j.im]
        });
        let (middle, spread) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
        if ((middle - spread).max(0.0) / (middle + spread)).sqrt() < STRETCHED {
            Self::Kinematic
        } else {
            Self::Dynamic
        }
    }
}

/// Returns a full circle over s from 0 to 1, counter-clockwise from a point of it, m.
pub fn circle(centre: Vector, start: Vector) -> impl Fn(f64) -> CurvePoint + Clone {
    let radius = start - centre;
    move |s| {
        let turn = std::f64::consts::TAU;
        let at = radius * unit(turn * s);
        let i = Vector::new(0.0, 1.0);
        CurvePoint { p: centre + at, first: i * turn * at, second: -turn * turn * at }
    }
}

/// Number of intervals between the nodes of a followed curve.
const NODE_INTERVALS: usize = 256;
/// Number of integration steps from node to node.
const STEPS_PER_INTERVAL: usize = 4;
/// Maximum number of Newton steps that project the end effector back onto the curve after each integration step.
const MAX_CORRECTIONS: usize = 4;
/// Tolerance of this projection, as a fraction of the arm length.
const CURVE_TOLERANCE: f64 = 1e-14;
/// Maximum error of one integration step, as a fraction of the arm length; a larger one means a singular pose.
const MAX_STEP_ERROR: f64 = 1e-4;

/// Follows a curve of the end effector at zero angular momentum, [J; D] q′ = [p′; 0], by the classical fourth-order
/// Runge–Kutta method. After each step, Newton steps of zero momentum project the end effector back onto the curve.
/// The moment is zero for any time law from rest to rest. With four drives or more the rates are those of minimum
/// norm.
///
/// # Errors
/// If the start has a wrong number of angles or is off the curve, if a machine with angular momentum has fewer than
/// three drives, or if [J; D] loses rank.
pub fn zero_momentum_path(
    model: &MomentumModel,
    start: DriveAngles,
    curve: impl Fn(f64) -> CurvePoint,
) -> Result<PathTable, DriftError> {
    let whole = |nodes| PathTable::even(nodes).ok_or_else(|| stop(model, &start, &curve, 0.0, 1));
    whole(follow_once(model, start, &curve, NODE_INTERVALS, 1)?)
}

/// Follows a curve at zero angular momentum piece by piece, each piece with its own intervals. Errors report `cycle`.
///
/// # Errors
/// As [`zero_momentum_path`].
pub fn zero_momentum_curve(
    model: &MomentumModel,
    start: DriveAngles,
    curve: &Curve,
    cycle: usize,
) -> Result<PathTable, DriftError> {
    let piece = |q: DriveAngles, [from, to]: [f64; 2], at: &dyn Fn(f64) -> CurvePoint, spaces: usize| {
        follow_once(model, q, &at, spaces, cycle).map_err(|error| match error {
            DriftError::Singular { s, at, cycle, why } => {
                DriftError::Singular { s: from + s * (to - from), at, cycle, why }
            }
            // The pieces before did not lead there within the tolerance.
            DriftError::Start { .. } if from > 0.0 => stop(model, &q, &|s| curve.at(s), from, cycle),
            other => other,
        })
    };
    by_pieces(curve, start, NODE_INTERVALS, piece)?.ok_or_else(|| stop(model, &start, &|s| curve.at(s), 0.0, cycle))
}

/// Returns the error of a curve that cannot be followed on from `s`, near a pose.
pub(super) fn stop(
    model: &MomentumModel,
    near: &DriveAngles,
    curve: &impl Fn(f64) -> CurvePoint,
    s: f64,
    cycle: usize,
) -> DriftError {
    let p = curve(s).p;
    DriftError::Singular { s, at: [p.re, p.im], cycle, why: Singularity::near(model, near) }
}

/// Follows a curve once and returns the nodes.
fn follow_once(
    model: &MomentumModel,
    start: DriveAngles,
    curve: &impl Fn(f64) -> CurvePoint,
    spaces: usize,
    cycle: usize,
) -> Result<Vec<PathPoint>, DriftError> {
    let drives = model.drives();
    if start.len() != drives || (drives < 3 && !model.is_zero()) {
        return Err(DriftError::Drives { drives });
    }
    let reach = model.reach();
    let miss = (curve(0.0).p - model.place(&start)).norm();
    if miss.is_nan() || miss > 1e-8 * reach {
        return Err(DriftError::Start { miss });
    }
    let singular = |q: &DriveAngles, s: f64| stop(model, q, curve, s, cycle);
    let steps = spaces * STEPS_PER_INTERVAL;
    let h = 1.0 / steps as f64;
    let (mut q, mut last) = (start, start);
    let mut nodes = Vec::with_capacity(spaces + 1);
    for i in 0..=steps {
        let s = i as f64 * h;
        if i % STEPS_PER_INTERVAL == 0 {
            nodes.push(node(model, &q, &curve(s)).ok_or_else(|| singular(&q, s))?);
            last = q;
        }
        if i == steps {
            break;
        }
        q = DriveAngles(runge_kutta_step(&q.0, h, |q, share| {
            let (q, s) = (DriveAngles(*q), s + share * h);
            rates(model, &q, curve(s).first, 0.0).ok_or_else(|| singular(&q, s))
        })?);
        let goal = curve((i + 1) as f64 * h).p;
        for j in 0..MAX_CORRECTIONS {
            let gap = goal - model.place(&q);
            if j == 0 && (gap.is_nan() || gap.norm() > MAX_STEP_ERROR * reach) {
                return Err(singular(&last, s));
            }
            if gap.norm() <= CURVE_TOLERANCE * reach {
                break;
            }
            q.0 = q.0.plus(1.0, &rates(model, &q, gap, 0.0).ok_or_else(|| singular(&last, s))?);
        }
    }
    Ok(nodes)
}

/// Returns q, q′ and q″ with D q′ = 0 and D q″ + D′ q′ = 0.
fn node(model: &MomentumModel, q: &DriveAngles, point: &CurvePoint) -> Option<PathPoint> {
    let (first, second) = motion_of(model, q, [point.first, point.second], [0.0; 2])?;
    Some(PathPoint { q: *q, first, second })
}

/// Joint angles after each cycle of the end effector.
#[derive(Clone, Debug, PartialEq)]
pub struct Drift {
    /// q at the start and after each cycle, rad.
    pub ends: Vec<DriveAngles>,
    /// Path of the first cycle.
    pub first: PathTable,
}

impl Drift {
    /// Returns q after the last cycle minus q at the start, rad.
    pub fn total(&self) -> PerDrive {
        let last = self.ends.len() - 1;
        self.ends[last].0.minus(&self.ends[0].0)
    }
}

/// Follows a closed curve of the end effector `cycles` times, at least once, at zero angular momentum.
///
/// # Errors
/// As [`zero_momentum_path`], or if the curve is not closed.
pub fn drift(
    model: &MomentumModel,
    start: DriveAngles,
    curve: impl Fn(f64) -> CurvePoint,
    cycles: usize,
) -> Result<Drift, DriftError> {
    drift_in(model, start, curve, cycles, NODE_INTERVALS)
}

/// Follows a closed curve as [`drift`], with a given number of intervals per cycle, 2 to 4096, each of four steps. The
/// error falls with the fourth power of this number.
///
/// # Errors
/// As [`drift`].
pub fn drift_in(
    model: &MomentumModel,
    start: DriveAngles,
    curve: impl Fn(f64) -> CurvePoint,
    cycles: usize,
    spaces: usize,
) -> Result<Drift, DriftError> {
    let reach = model.reach();
    let gap = (curve(1.0).p - curve(0.0).p).norm();
    if gap.is_nan() || gap > 1e-10 * reach {
        return Err(DriftError::Open { gap });
    }
    let spaces = spaces.clamp(2, 4096);
    let end = |nodes: &[PathPoint]| nodes.last().map_or(start, |node| node.q);
    let first = follow_once(model, start, &curve, spaces, 1)?;
    let mut ends = vec![start, end(&first)];
    let first = PathTable::even(first).ok_or_else(|| stop(model, &start, &curve, 0.0, 1))?;
    for cycle in 2..=cycles {
        ends.push(end(&follow_once(model, ends[cycle - 1], &curve, spaces, cycle)?));
    }
    Ok(Drift { ends, first })
}
