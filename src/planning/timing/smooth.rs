//! Limits on jerk along a curve: a motion near the best, proved by checking it, and how far it is from a bound.
//!
//! With jerk limited the fastest motion on a curve is no convex problem: [`crate::planning::timing::jerk`] finds a
//! local optimum on nodes, which are dense where the motion without those limits is slow and where the path bends.
//! Where the motion passes a limit between the nodes, all of it is slowed down until it keeps that limit.

use crate::mechanics::dynamics::Surroundings;
use crate::mechanics::machine::Inertia;
use crate::planning::Motion;
use crate::planning::curves::path::Path;
use crate::planning::timing::jerk::{JerkProgram, eased, uneased};
use crate::planning::timing::keep::greatest;
use crate::planning::timing::law::Progress;
use crate::planning::timing::limits::Constraints;
use crate::planning::timing::outcome::{Fastest, TimeError};
use crate::planning::timing::profile::{Profile, Span};
use crate::planning::timing::s_curve::s_curve;
use crate::planning::timing::topp::Grid;
use crate::planning::timing::usage::{Demand, Usage};

/// Instants for the account of what limits.
const INSTANTS: usize = 2000;
/// Spaces between nodes over the time of the motion without limits on jerk.
const SPACES_BY_TIME: f64 = 200.0;
/// Those over θ.
const SPACES_BY_PLACE: f64 = 80.0;
/// Those for each space of the grid of that motion.
const SPACES_BY_GRID: f64 = 0.1;
/// Those for each e-fold nearer to an end, until very near.
const SPACES_BY_ENDS: f64 = 4.0;
/// Nearer to an end than this is very near, of θ.
const VERY_NEAR_END: f64 = 0.003;
/// At least so many between two joints of the path.
const MIN_SPACES_PER_PIECE: usize = 12;
/// How often nodes are added where a limit is passed between the places where it is kept.
const MAX_MENDINGS: usize = 3;
/// From how much on, as a share of time.
const MENDED_FROM: f64 = 2e-3;
/// A limit passed by more wants more of them.
const MENDED_MORE_FROM: f64 = 0.03;
/// How many nodes there may be.
const MOST_NODES: usize = 4000;
/// Parts of a phase of a law that are checked.
const CHECKED_PARTS: usize = 500;
/// What rounding may need.
const ROUNDING: f64 = 1e-9;
/// The greatest θ̇, times 1/T of the motion without limits on jerk.
const MOST_RATE: f64 = 60.0;

/// A motion within all limits; `bound` is the fastest one without those on jerk, on the grid.
pub(super) fn smooth(
    path: &Path,
    model: &Inertia,
    around: &Surroundings,
    constraints: &Constraints,
    grid: &Grid,
    bound: Result<Fastest, TimeError>,
) -> Result<Fastest, TimeError> {
    let limits = constraints.limits();
    let bound = match bound {
        // Jerk alone may be limited, or jerk and speed.
        Err(TimeError::Unlimited { .. } | TimeError::SpeedOnly) => None,
        Ok(bound) if bound.profile.duration() == 0.0 => return Ok(bound),
        other => Some(other?),
    };
    let stuck = || TimeError::Stuck { s: 0.0 };
    let most = bound.as_ref().map_or(f64::INFINITY, |b| (MOST_RATE / b.profile.duration()).powi(2));
    let nodes = nodes(path, grid, bound.as_ref().map(|b| &b.profile));
    let rates: Vec<f64> = bound.iter().flat_map(|b| b.profile.phases().map(|(at, _)| at.rate)).chain([0.0]).collect();
    // What no motion surpasses, from station to station.
    let fastest = |theta: f64| {
        let [s, slope, ..] = eased(theta);
        let i = grid.s.partition_point(|station| *station <= s).clamp(1, grid.s.len() - 1) - 1;
        let Some(&[from, to]) = rates.get(i..i + 2) else { return f64::INFINITY };
        let share = (s - grid.s[i]) / (grid.s[i + 1] - grid.s[i]);
        (from * from + share * (to * to - from * from)) / (slope * slope)
    };
    let stretches = |at: &Progress| Demand::of(path, model, around, limits, at).stretches(limits);
    let (mut nodes, mut timing, mut best) = (nodes, None, None::<Profile>);
    for _ in 0..=MAX_MENDINGS {
        let solved = JerkProgram::new(path, constraints, nodes, most).solve(fastest, timing.as_ref());
        let Some(found) = solved else { break };
        let profile = found.profile();
        let mut phases = profile.phases();
        let past: Vec<f64> = (1..found.nodes.len()).map(|_| greatest(phases.by_ref().take(3), stretches)).collect();
        drop(phases);
        let most = past.iter().copied().fold(0.0, f64::max);
        if most.is_finite() && most > 0.0 {
            let slowed = profile.stretched(most * (1.0 + ROUNDING));
            if best.as_ref().is_none_or(|best| slowed.duration() < best.duration()) {
                best = Some(slowed);
            }
        }
        if most <= 1.0 + MENDED_FROM || found.nodes.len() > MOST_NODES {
            break;
        }
        nodes = mended(&found.nodes, &past);
        timing = Some(found);
    }
    // The law that is best where jerk alone counts serves where all else fails.
    let profile = best.or_else(|| by_law(stretches)).ok_or_else(stuck)?;
    let gap = bound.map(|b| profile.duration() / b.profile.duration() - 1.0);
    let motion = Motion { path: path.clone(), profile };
    let limiting = Usage::of(&motion, model, around, limits, INSTANTS).leading;
    Ok(Fastest { profile: motion.profile, gap, limiting })
}

/// The law of least jerk in the time that keeps all limits.
fn by_law<const N: usize>(stretches: impl Fn(&Progress) -> [f64; N]) -> Option<Profile> {
    let spans = s_curve(f64::INFINITY, f64::INFINITY, 32.0)?;
    let cut = |span: &Span| {
        let (time, from) = (span.time / CHECKED_PARTS as f64, *span);
        (0..CHECKED_PARTS).map(move |i| Span {
            time,
            acceleration: from.acceleration + i as f64 * time * from.jerk,
            ..from
        })
    };
    let law = Profile::of_spans(&spans.iter().flat_map(cut).collect::<Vec<_>>());
    let factor = greatest(law.phases(), stretches);
    (factor > 0.0 && factor.is_finite()).then(|| law.stretched(factor * (1.0 + ROUNDING)))
}

/// Nodes with more of them in and beside spaces in which a limit is passed.
fn mended(nodes: &[f64], past: &[f64]) -> Vec<f64> {
    let mut fine = Vec::with_capacity(2 * nodes.len());
    for i in 0..past.len() {
        let worst = past[i.saturating_sub(1)..(i + 2).min(past.len())].iter().copied().fold(0.0, f64::max);
        let parts = match past[i] - 1.0 {
            by if by > MENDED_MORE_FROM => 5,
            by if by > MENDED_FROM => 3,
            _ if worst > 1.0 + MENDED_FROM => 2,
            _ => 1,
        };
        fine.extend((0..parts).map(|k| nodes[i] + (nodes[i + 1] - nodes[i]) * k as f64 / parts as f64));
    }
    fine.push(1.0);
    fine
}

/// Nodes θ: from joint to joint of the path as many as its part is worth.
fn nodes(path: &Path, grid: &Grid, bound: Option<&Profile>) -> Vec<f64> {
    // What the spaces of the grid are worth, added up.
    let thetas: Vec<f64> = grid.s.iter().map(|s| uneased(*s)).collect();
    let times: Vec<f64> = bound.map_or(Vec::new(), |b| b.phases().map(|(_, time)| time / b.duration()).collect());
    let mut worth = Vec::with_capacity(thetas.len());
    let mut sum = 0.0;
    worth.push(0.0);
    for i in 1..thetas.len() {
        let time = times.get(i - 1).copied().unwrap_or(0.0);
        let (from, to) = (thetas[i - 1], thetas[i]);
        let ends = ((to + VERY_NEAR_END) * (1.0 - from + VERY_NEAR_END)
            / ((from + VERY_NEAR_END) * (1.0 - to + VERY_NEAR_END)))
            .ln();
        sum += SPACES_BY_TIME * time + SPACES_BY_PLACE * (to - from) + SPACES_BY_GRID + SPACES_BY_ENDS * ends;
        worth.push(sum);
    }
    let mut nodes = vec![0.0];
    let mut at = 0;
    let place = |want: f64, mut at: usize| {
        while at + 2 < worth.len() && worth[at + 1] < want {
            at += 1;
        }
        let share = ((want - worth[at]) / (worth[at + 1] - worth[at])).clamp(0.0, 1.0);
        (thetas[at] + share * (thetas[at + 1] - thetas[at]), at)
    };
    let joints = path.joints();
    let least = if joints.len() > 40 { 4 } else { MIN_SPACES_PER_PIECE };
    for ends in joints.windows(2) {
        let worth_at = |s: f64| {
            let i = grid.s.partition_point(|station| *station <= s).clamp(1, worth.len() - 1) - 1;
            let share = (s - grid.s[i]) / (grid.s[i + 1] - grid.s[i]);
            worth[i] + share * (worth[i + 1] - worth[i])
        };
        let [from, to] = [worth_at(ends[0]), worth_at(ends[1])];
        let count = ((to - from).ceil() as usize).max(least);
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
