//! Rates of least angular momentum that move the end effector of two or three drives as wanted, and how a free base
//! turns.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | v | velocity of the end effector | m/s |
//! | J | its Jacobian; of a free base with coordinates in space that of base and arm at zero momentum | m |
//! | n | unit vector of the self-motion, J n = 0 | |
//! | D | coefficients of the angular momentum D q̇ of [`MomentumModel`] | kg m² |
//! | φ | D n/\|D\|: sine of the angle between n and the plane of silent rates | |
//! | h | momentum of the rates of minimum norm | kg m²/s |
//! | I, θ | inertia of base and arm that turn together; turn of a free base | kg m², rad |
//!
//! # Source
//! All rates that move the end effector as wanted are J⁺v + α n, with momentum h + α φ |D|. With α = −h/(φ |D|) it is
//! zero: the rates of [`rates`](super::null_space::rates). They grow without bound as φ → 0, a dynamic singularity. So
//! for |φ| < ε the momentum is minimised together with α: α = −h φ/(|D| (φ² + λ²)), λ = ε (1 − φ²/ε²). The momentum
//! that remains turns a free base by θ̇ = −(D q̇)/I. With coordinates in space the end effector moves with the base: J
//! has the columns i c_k e_k − i P D_k/I, P being its place seen from the common centre of mass: the generalised Jacobian.
//! Two drives have no self-motion, so that J⁻¹v are the only rates.

use std::cell::Cell;

use nalgebra::Vector3;

use super::drift::{DriftError, stop};
use super::flow::Flow;
use super::momentum::MomentumModel;
use crate::curves::PathPoint;
use crate::curves::curve::{Curve, CurvePoint};
use crate::curves::path::by_pieces;
use crate::curves::table::PathTable;
use stillbase_mechanics::kinematics::column;
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector, cross, unit};

/// ε: momentum is let in where the self-motion lies within this sine of the silent plane. Rates then stay below some
/// 1/ε times those of minimum norm.
pub const SINGULAR_SINE: f64 = 0.05;

/// Rates of a pose of two or three drives and its base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LeastRates {
    /// q̇, rad/s.
    pub rates: PerDrive,
    /// θ̇, rad/s.
    pub turn: f64,
    /// √det(J Jᵀ), m²: 0 where the arm is outstretched or folded.
    pub dexterity: f64,
}

/// Returns the rates of least momentum that move the end effector of two or three drives with velocity v, m/s, from a pose
/// with its free base turned by `turn`, rad. Returns `None` if it cannot move that way.
pub(super) fn least_rates(model: &MomentumModel, q: &DriveAngles, turn: f64, v: Vector) -> Option<LeastRates> {
    let e = q.units();
    let tip = model.tip_units(&e);
    let d = model.coefficients(&e);
    let base = model.turning(&e);
    let lever = base.and_then(|base| Some((base.lever?, base.inertia)));
    let n = model.drives();
    let mut j = [Vector::default(); 3];
    (0..n.min(3)).for_each(|k| j[k] = column(model.tip(), &tip, k));
    let mut v = v;
    if let Some((lever, inertia)) = lever {
        (0..n.min(3)).for_each(|k| j[k] -= Vector::new(0.0, d[k] / inertia) * lever);
        v *= unit(-turn);
    }
    if n == 2 {
        let area = cross(j[0], j[1]);
        let rates = PerDrive::from_fn(2, |k| if k == 0 { cross(v, j[1]) } else { cross(j[0], v) } / area);
        let turn = base.map_or(0.0, |base| -d.dot(&rates) / base.inertia);
        let is_finite = rates.max_abs().is_finite() && turn.is_finite();
        return is_finite.then_some(LeastRates { rates, turn, dexterity: area.abs() });
    }
    let row = |part: &dyn Fn(&Vector) -> f64| Vector3::new(part(&j[0]), part(&j[1]), part(&j[2]));
    let (x, y) = (row(&|j| j.re), row(&|j| j.im));
    let d = Vector3::new(d[0], d[1], d[2]);
    let normal = x.cross(&y);
    let (square, size) = (normal.norm_squared(), d.norm());
    let least = (v.re * y.cross(&normal) + v.im * normal.cross(&x)) / square;
    let own = normal / square.sqrt();
    let (momentum, sine) = (d.dot(&least), d.dot(&own) / size);
    let damping = SINGULAR_SINE * (1.0 - (sine / SINGULAR_SINE).powi(2)).max(0.0);
    let share = sine * sine / (sine * sine + damping * damping);
    let rates = if sine == 0.0 { least } else { least - own * (momentum * share / (sine * size)) };
    let turn = base.map_or(0.0, |base| -momentum * (1.0 - share) / base.inertia);
    let rates = PerDrive::from([rates[0], rates[1], rates[2]]);
    (rates.max_abs().is_finite() && turn.is_finite()).then_some(LeastRates { rates, turn, dexterity: square.sqrt() })
}

/// Number of intervals between the nodes of a followed curve.
const NODE_INTERVALS: usize = 2048;
/// Step of the difference that gives second derivatives, as a fraction of a piece of a curve.
const DIFFERENCE_STEP: f64 = 1e-5;

/// Follows a curve of the end effector of two or three drives with least momentum, from a pose with its free base turned by
/// `turn`, rad. Returns the path and the turn at its end.
///
/// # Errors
/// If no rates lead on; the error reports `cycle`.
pub fn least_momentum_curve(
    model: &MomentumModel,
    start: DriveAngles,
    turn: f64,
    curve: &Curve,
    cycle: usize,
) -> Result<(PathTable, f64), DriftError> {
    let now = Cell::new(turn);
    let piece = |q: DriveAngles, [from, to]: [f64; 2], at: &dyn Fn(f64) -> CurvePoint, spaces: usize| {
        let blocked = |q: &DriveAngles, u: f64| match stop(model, q, &|s| curve.at(s), from + u * (to - from), cycle) {
            DriftError::Singular { s, at, cycle, why } => DriftError::Singular { s, at, cycle, why: why.with_base() },
            other => other,
        };
        let pose = |x: &[f64; 5]| pose(x, model.drives());
        let slope = |x: &[f64; 5]| {
            let rates = least_rates(model, &pose(x), x[3], at(x[4]).first)?;
            let [first, second, third] = three(&rates.rates);
            Some([first, second, third, rates.turn, 1.0])
        };
        let flow = Flow { field: slope, scale: [1.0; 5] };
        let [first, second, third] = three(&q.0);
        let mut x = [first, second, third, now.get(), 0.0];
        let mut nodes = Vec::with_capacity(spaces + 1);
        for i in 0..=spaces {
            x[4] = i as f64 / spaces as f64;
            nodes.push(node(&slope, &x, model.drives()).ok_or_else(|| blocked(&pose(&x), x[4]))?);
            if i < spaces {
                x = flow.go(&x, 1.0 / spaces as f64).ok_or_else(|| blocked(&pose(&x), x[4]))?;
            }
        }
        now.set(x[3]);
        Ok(nodes)
    };
    let table = by_pieces(curve, start, NODE_INTERVALS, piece)?;
    let table = table.ok_or_else(|| stop(model, &start, &|s| curve.at(s), 0.0, cycle))?;
    Ok((table, now.get()))
}

/// Returns the pose in a state of three drive angles, turn of the base and parameter of the curve; of two drives the third
/// angle is 0.
fn pose(x: &[f64; 5], drives: usize) -> DriveAngles {
    DriveAngles(PerDrive::from_fn(drives, |k| x[k]))
}

/// Returns three values, of which two drives leave the third 0.
fn three(values: &PerDrive) -> [f64; 3] {
    let all = values.padded();
    [all[0], all[1], all[2]]
}

/// Returns q, q′ and q″ at a state; q″ is a difference of q′ along the path, to one side at the ends of a piece.
fn node(slope: &impl Fn(&[f64; 5]) -> Option<[f64; 5]>, x: &[f64; 5], drives: usize) -> Option<PathPoint> {
    let rates = |x: &[f64; 5]| slope(x).map(|f| PerDrive::from_fn(drives, |k| f[k]));
    let along = slope(x)?;
    let ahead = |h: f64| rates(&std::array::from_fn(|k| x[k] + h * along[k]));
    let (h, first) = (DIFFERENCE_STEP, rates(x)?);
    let second = if x[4] >= h && x[4] <= 1.0 - h {
        ahead(h)?.minus(&ahead(-h)?).scaled(0.5 / h)
    } else {
        let h = if x[4] < h { h } else { -h };
        ahead(h)?.scaled(4.0).minus(&ahead(2.0 * h)?).minus(&first.scaled(3.0)).scaled(0.5 / h)
    };
    Some(PathPoint { q: pose(x, drives), first, second })
}
