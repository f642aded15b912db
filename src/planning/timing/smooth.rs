//! Limits on jerk along a curve: a motion near the optimum, checked against its limits, and its gap to a bound.
//!
//! With limits on jerk, the fastest motion on a curve is not a convex problem. [`crate::timing::jerk`] finds a local
//! optimum on nodes. They are dense where the motion without these limits is slow and where the path bends. If the
//! motion exceeds a limit between nodes, the whole motion is slowed down until it keeps the limit.

use crate::Motion;
use crate::curves::path::Path;
use crate::timing::jerk::{JerkProgram, eased, uneased};
use crate::timing::keep::greatest;
use crate::timing::law::PathProgress;
use crate::timing::limits::Constraints;
use crate::timing::outcome::{FastestMotion, TimeError};
use crate::timing::profile::{JerkPhase, Profile};
use crate::timing::s_curve::s_curve;
use crate::timing::topp::PathConstraints;
use crate::timing::usage::{Demand, Usage};
use stillbase_mechanics::arm_on_base::ArmOnBase;

/// Number of samples from which the active limits are determined.
const USAGE_SAMPLES: usize = 2000;
/// Number of intervals distributed in proportion to the time of the motion without limits on jerk.
const INTERVALS_BY_TIME: f64 = 200.0;
/// Number of intervals distributed evenly over θ.
const INTERVALS_BY_THETA: f64 = 80.0;
/// Number of intervals added for each interval of the grid of the motion without limits on jerk.
const INTERVALS_BY_GRID: f64 = 0.1;
/// Number of intervals over which the distance of θ from an end grows by the factor e.
const INTERVALS_BY_ENDS: f64 = 4.0;
/// Distance of θ to an end below which the density of [`INTERVALS_BY_ENDS`] no longer grows.
const END_DISTANCE: f64 = 0.003;
/// Minimum number of intervals between two joints of a path that has at most 40 joints.
const MIN_INTERVALS_PER_PIECE: usize = 12;
/// Maximum number of refinements where a limit is exceeded between the points at which it is imposed.
const MAX_REFINEMENTS: usize = 3;
/// An interval is refined if the factor by which it must be slowed down exceeds 1 by more than this.
const REFINED_ABOVE: f64 = 2e-3;
/// Relative excess from which an interval is divided more finely.
const REFINED_MORE_ABOVE: f64 = 0.03;
/// Maximum number of nodes at which the grid is still refined.
const MAX_NODES: usize = 4000;
/// Number of parts into which each phase of a law is divided to check its limits.
const CHECKED_PARTS: usize = 500;
/// Relative margin against rounding.
const ROUNDING: f64 = 1e-9;
/// Maximum θ̇, in units of 1/T of the motion without limits on jerk.
const MAX_RATE: f64 = 60.0;

/// Finds a motion within all limits; `bound` is the fastest motion on the grid without limits on jerk.
pub(super) fn smooth(
    path: &Path,
    arm: &ArmOnBase,
    constraints: &Constraints,
    grid: &PathConstraints,
    bound: Result<FastestMotion, TimeError>,
) -> Result<FastestMotion, TimeError> {
    let limits = constraints.limits();
    let bound = match bound {
        // Jerk alone may be limited, or jerk and speed.
        Err(TimeError::Unlimited { .. } | TimeError::SpeedOnly) => None,
        Ok(bound) if bound.profile.duration() == 0.0 => return Ok(bound),
        other => Some(other?),
    };
    let stuck = || TimeError::Stuck { s: 0.0 };
    let max_square = bound.as_ref().map_or(f64::INFINITY, |b| (MAX_RATE / b.profile.duration()).powi(2));
    let nodes = nodes(path, grid, bound.as_ref().map(|b| &b.profile));
    let rates: Vec<f64> = bound.iter().flat_map(|b| b.profile.phases().map(|(at, _)| at.rate)).chain([0.0]).collect();
    // Upper bound of θ̇² from the motion without limits on jerk, interpolated between stations.
    let fastest = |theta: f64| {
        let [s, slope, ..] = eased(theta);
        let i = grid.s.partition_point(|station| *station <= s).clamp(1, grid.s.len() - 1) - 1;
        let Some(&[from, to]) = rates.get(i..i + 2) else { return f64::INFINITY };
        let share = (s - grid.s[i]) / (grid.s[i + 1] - grid.s[i]);
        (from * from + share * (to * to - from * from)) / (slope * slope)
    };
    let stretches = |at: &PathProgress| Demand::of(path, arm, limits, at).stretches(limits);
    let (mut nodes, mut timing, mut best) = (nodes, None, None::<Profile>);
    for _ in 0..=MAX_REFINEMENTS {
        let solved = JerkProgram::new(path, constraints, nodes, max_square).solve(fastest, timing.as_ref());
        let Some(found) = solved else { break };
        let profile = found.profile();
        let mut phases = profile.phases();
        let past: Vec<f64> = (1..found.nodes.len()).map(|_| greatest(phases.by_ref().take(3), stretches)).collect();
        drop(phases);
        let largest = past.iter().copied().fold(0.0, f64::max);
        if largest.is_finite() && largest > 0.0 {
            let slowed = profile.stretched(largest * (1.0 + ROUNDING));
            if best.as_ref().is_none_or(|best| slowed.duration() < best.duration()) {
                best = Some(slowed);
            }
        }
        if largest <= 1.0 + REFINED_ABOVE || found.nodes.len() > MAX_NODES {
            break;
        }
        nodes = refined(&found.nodes, &past);
        timing = Some(found);
    }
    // If no solution was found, use the law that is optimal for jerk alone.
    let profile = best.or_else(|| by_law(stretches)).ok_or_else(stuck)?;
    let gap = bound.map(|b| profile.duration() / b.profile.duration() - 1.0);
    let motion = Motion { path: path.clone(), profile };
    let active_limits = Usage::of(&motion, arm, limits, USAGE_SAMPLES).active_limits;
    Ok(FastestMotion { profile: motion.profile, gap, active_limits })
}

/// Returns the law of least jerk over the least duration that keeps all limits.
fn by_law<const N: usize>(stretches: impl Fn(&PathProgress) -> [f64; N]) -> Option<Profile> {
    let spans = s_curve(f64::INFINITY, f64::INFINITY, 32.0)?;
    let cut = |span: &JerkPhase| {
        let (time, from) = (span.time / CHECKED_PARTS as f64, *span);
        (0..CHECKED_PARTS).map(move |i| JerkPhase {
            time,
            acceleration: from.acceleration + i as f64 * time * from.jerk,
            ..from
        })
    };
    let law = Profile::of_spans(&spans.iter().flat_map(cut).collect::<Vec<_>>());
    let factor = greatest(law.phases(), stretches);
    (factor > 0.0 && factor.is_finite()).then(|| law.stretched(factor * (1.0 + ROUNDING)))
}

/// Returns nodes refined in and beside intervals in which a limit is exceeded.
fn refined(nodes: &[f64], past: &[f64]) -> Vec<f64> {
    let mut fine = Vec::with_capacity(2 * nodes.len());
    for i in 0..past.len() {
        let worst = past[i.saturating_sub(1)..(i + 2).min(past.len())].iter().copied().fold(0.0, f64::max);
        let parts = match past[i] - 1.0 {
            by if by > REFINED_MORE_ABOVE => 5,
            by if by > REFINED_ABOVE => 3,
            _ if worst > 1.0 + REFINED_ABOVE => 2,
            _ => 1,
        };
        fine.extend((0..parts).map(|k| nodes[i] + (nodes[i + 1] - nodes[i]) * k as f64 / parts as f64));
    }
    fine.push(1.0);
    fine
}

/// Places the nodes θ with the density that the constants above define, and at all joints of the path.
fn nodes(path: &Path, grid: &PathConstraints, bound: Option<&Profile>) -> Vec<f64> {
    // Cumulative number of intervals over the grid.
    let thetas: Vec<f64> = grid.s.iter().map(|s| uneased(*s)).collect();
    let times: Vec<f64> = bound.map_or(Vec::new(), |b| b.phases().map(|(_, time)| time / b.duration()).collect());
    let mut cumulative = Vec::with_capacity(thetas.len());
    let mut sum = 0.0;
    cumulative.push(0.0);
    for i in 1..thetas.len() {
        let time = times.get(i - 1).copied().unwrap_or(0.0);
        let (from, to) = (thetas[i - 1], thetas[i]);
        let ends = ((to + END_DISTANCE) * (1.0 - from + END_DISTANCE)
            / ((from + END_DISTANCE) * (1.0 - to + END_DISTANCE)))
            .ln();
        sum +=
            INTERVALS_BY_TIME * time + INTERVALS_BY_THETA * (to - from) + INTERVALS_BY_GRID + INTERVALS_BY_ENDS * ends;
        cumulative.push(sum);
    }
    let mut nodes = vec![0.0];
    let mut at = 0;
    let place = |want: f64, mut at: usize| {
        while at + 2 < cumulative.len() && cumulative[at + 1] < want {
            at += 1;
        }
        let share = ((want - cumulative[at]) / (cumulative[at + 1] - cumulative[at])).clamp(0.0, 1.0);
        (thetas[at] + share * (thetas[at + 1] - thetas[at]), at)
    };
    let joints = path.joints();
    let min_count = if joints.len() > 40 { 4 } else { MIN_INTERVALS_PER_PIECE };
    for ends in joints.windows(2) {
        let cumulative_at = |s: f64| {
            let i = grid.s.partition_point(|station| *station <= s).clamp(1, cumulative.len() - 1) - 1;
            let share = (s - grid.s[i]) / (grid.s[i + 1] - grid.s[i]);
            cumulative[i] + share * (cumulative[i + 1] - cumulative[i])
        };
        let [from, to] = [cumulative_at(ends[0]), cumulative_at(ends[1])];
        let count = ((to - from).ceil() as usize).max(min_count);
        for k in 1..count {
            let (theta, near) = place(from + (to - from) * k as f64 / count as f64, at);
            at = near;
            nodes.push(theta);
        }
        nodes.push(if ends[1] == 1.0 { 1.0 } else { uneased(ends[1]) });
    }
    nodes.dedup_by(|b, a| *b - *a < 1e-12);
    if let Some(last) = nodes.last_mut() {
        *last = 1.0;
    }
    debug_assert!(nodes.windows(2).all(|w| w[0] < w[1] && eased(w[1])[0] > 0.0));
    nodes
}
