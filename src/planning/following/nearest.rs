//! The reactionless motion nearest to a given one: the same timing on a plane b = const.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | q(t) | the given motion, b(t) = Σ λ_k q_k(t) | rad |
//! | D_k | constant inertia of drive k, (11) | kg m² |
//! | ‖Δq‖² | ∫ Σ D_k Δq_k² dt / T ΣD: mean square deviation of the joints in the metric of kinetic energy | rad² |
//! | b̄ | mean of b(t) over time | rad |
//!
//! # Source
//! In the metric of kinetic energy the normal of the planes is D⁻¹λ ∝ (1, …, 1): the nearest pose on a plane is the
//! pose turned as a whole by (b − b(t))/Σλ. Its distance is |b − b(t)|/Σλ, so that of all constant b the nearest is b̄.
//! This turns the end effector with the arm. To keep the end effector instead, the pose moves along the null space of
//! its Jacobian onto the plane, (16) inverted, where b reaches every point of its path; of these b the nearest, in the
//! same metric, is found by search.

use crate::mechanics::kinematics::{acceleration, end_effector, velocity};
use crate::mechanics::machine::{Chain, Inertia};
use crate::mechanics::planar::{DriveAngles, PerDrive};
use crate::planning::Motion;
use crate::planning::curves::curve::{Curve, CurvePoint};
use crate::planning::curves::given::Samples;
use crate::planning::curves::table::PathTable;
use crate::planning::following::trace;
use crate::planning::following::trace::{Blocked, Rule};
use crate::planning::golden::golden;
use crate::planning::reactionless::{BSet, PlaneMap};

/// How far two motions of one timing are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// Greatest distance of the end effectors, m.
    pub tip: f64,
    /// Greatest |Δq_k|, rad.
    pub joints: PerDrive,
    /// ‖Δq‖, rad.
    pub rms: f64,
}

impl Deviation {
    /// Between motions that take equally long, by as many instants.
    pub fn between(tip: &Chain, model: &Inertia, one: &Motion, other: &Motion, instants: usize) -> Self {
        let n = model.drives();
        let mut worst = Self { tip: 0.0, joints: PerDrive::zeros(n), rms: 0.0 };
        let whole: f64 = (0..n).map(|k| model.diagonal(k)).sum();
        for i in 0..=instants {
            let share = i as f64 / instants as f64;
            let [a, b] = [one, other].map(|motion| motion.path.at(motion.profile.at(share * motion.duration()).s).q);
            let gap = end_effector(tip, &a.units()) - end_effector(tip, &b.units());
            worst.tip = worst.tip.max(gap.norm());
            let off = a.0.minus(&b.0);
            worst.joints.iter_mut().zip(off.iter()).for_each(|(worst, off)| *worst = worst.max(off.abs()));
            let square: f64 = off.iter().enumerate().map(|(k, off)| model.diagonal(k) * off * off).sum();
            // The trapezoidal rule.
            let weight = if i == 0 || i == instants { 0.5 } else { 1.0 };
            worst.rms += weight * square / (whole * instants as f64);
        }
        worst.rms = worst.rms.sqrt();
        worst
    }
}

/// Every sample turned as a whole onto the plane b, rad: relative angles stay, the end effector turns along.
pub fn turned(lambda: &PerDrive, samples: &Samples, b: f64) -> Option<Samples> {
    let sum: f64 = lambda.iter().sum();
    let row = |i: usize| {
        let q = samples.values(i);
        let turn = (b - lambda.dot(q)) / sum;
        q.iter().map(|q| q + turn).collect()
    };
    samples.with_values((0..samples.count()).map(row))
}

/// The curve of the end effector over s = t/T that a path of the drives through samples makes.
pub fn tip_curve(tip: &Chain, path: &PathTable) -> Option<Curve> {
    let nodes: Vec<CurvePoint> = path
        .nodes()
        .iter()
        .map(|node| {
            let e = node.q.units();
            let (first, second) = (velocity(tip, &e, &node.first), acceleration(tip, &e, &node.first, &node.second));
            CurvePoint { p: end_effector(tip, &e), first, second }
        })
        .collect();
    Curve::through(path.stations(), &nodes)
}

/// The constant b whose motion with the same end effector is nearest to the given one, rad, and its ‖Δq‖, rad; `None`
/// if none can be followed. Judged by some two hundred of the samples.
pub fn nearest_b(map: &PlaneMap, tip: &Chain, model: &Inertia, samples: &Samples, rule: Rule) -> Option<(f64, f64)> {
    let thin = samples.thinned(JUDGED);
    let curve = tip_curve(tip, &thin.path(0.0)?)?;
    let far = |b: f64| {
        let moved = same_tip(map, tip, &thin, b, rule).ok().flatten();
        moved.map_or(f64::INFINITY, |moved| apart(model, &thin, &moved))
    };
    let mean = (0..thin.count()).map(|i| map.project(thin.values(i)).b).sum::<f64>() / thin.count() as f64;
    // A little inside: at the very ends a relative angle grazes its limit, or two poses meet.
    least(&trace::common_b(map, std::slice::from_ref(&curve), JUDGED), mean, [TRIES, SECTIONS], far)
}

/// The b of a set at which a distance is least, rad, and that: tried at equal steps inside each interval and at a mean, then
/// searched about the best by golden section, each so many times; `None` if it is finite nowhere.
pub(super) fn least(
    set: &BSet,
    mean: f64,
    [tries, sections]: [usize; 2],
    far: impl Fn(f64) -> f64,
) -> Option<(f64, f64)> {
    let mut best: Option<(f64, f64, [f64; 2])> = None;
    for [low, high] in set.near(mean).intervals {
        let step = (high - low) / tries as f64;
        let inside = (0..tries).map(|i| low + (i as f64 + 0.5) * step);
        for b in inside.chain((low..=high).contains(&mean).then_some(mean)) {
            let distance = far(b);
            if distance.is_finite() && best.is_none_or(|(_, least, _)| distance < least) {
                best = Some((b, distance, [(b - step).max(low), (b + step).min(high)]));
            }
        }
    }
    let (b, distance, around) = best?;
    let refined = golden(around, sections, far);
    Some(if refined.1 < distance { refined } else { (b, distance) })
}

/// b that are tried in each interval, and golden sections after that.
const TRIES: usize = 32;
const SECTIONS: usize = 24;

/// Samples that judge a plane.
const JUDGED: usize = 201;

/// ‖Δq‖ of samples at the same times, by the trapezoidal rule, rad.
pub(super) fn apart(model: &Inertia, one: &Samples, other: &Samples) -> f64 {
    let n = model.drives();
    let whole: f64 = (0..n).map(|k| model.diagonal(k)).sum();
    let square = |i: usize| -> f64 {
        let pairs = one.values(i).iter().zip(other.values(i)).enumerate();
        pairs.map(|(k, (a, b))| model.diagonal(k) * (a - b) * (a - b)).sum()
    };
    let spaces = (1..one.count()).map(|i| 0.5 * (one.time(i) - one.time(i - 1)) * (square(i) + square(i - 1)));
    (spaces.sum::<f64>() / (whole * one.duration())).sqrt()
}

/// The samples moved onto the plane b, rad, with the end effector where it was at every one of them, on the sheet
/// nearest to the first pose.
///
/// # Errors
/// Where the plane does not reach, and which b would do; `None` if there is nothing to move.
pub fn same_tip(
    map: &PlaneMap,
    tip: &Chain,
    samples: &Samples,
    b: f64,
    rule: Rule,
) -> Result<Option<Samples>, Box<Blocked>> {
    let Some(path) = samples.path(0.0) else { return Ok(None) };
    let Some(curve) = tip_curve(tip, &path) else { return Ok(None) };
    let start = map.project(&path.nodes()[0].q).a;
    let tables = trace::follow(map, &[curve], b, Some(start), rule)?;
    let Some(on_plane) = tables.first() else { return Ok(None) };
    let row = |s: &f64| {
        let q: DriveAngles = on_plane.at(*s).q;
        q.to_vec()
    };
    Ok(samples.with_values(path.stations().iter().map(row)))
}
