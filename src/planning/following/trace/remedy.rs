//! Remedies for a curve that cannot be followed: another b, or a part of the curve.

use super::rule::{Blocked, Rule, SheetEnd};
use super::track::PlaneTrack;
use super::walk::{TRIAL_STATIONS, at, common_b, is_feasible, part, starting_poses, tables, whole_s};
use crate::curves::curve::Curve;
use crate::reactionless::{BSet, Decimal, PlaneMap};
use stillbase_mechanics::planar::unit;

/// Number of intervals of [`Blocked::curve`], which is drawn.
const DRAWN_INTERVALS: i32 = 160;

pub(super) fn blocked(map: &PlaneMap, curves: &[Curve], b: f64, rule: Rule, s: f64, stop: SheetEnd) -> Blocked {
    let common = common_b(map, curves, 2 * TRIAL_STATIONS + 1);
    let beyond = at(curves, if stop == SheetEnd::Start { 0.0 } else { (s + 1e-6).min(1.0) });
    let (nearest_b, shown_b) = nearest_b(map, curves, b, rule, &common).unzip();
    Blocked {
        b,
        s,
        at: at(curves, s),
        stop,
        leaves_workspace: map.poses(beyond, b).is_empty(),
        nearest_b,
        displayed_b: shown_b.flatten(),
        some_b_reaches_all: !common.is_empty(),
        longest: longest(map, curves, b, rule).map(|[from, to]| match from < s && s < to {
            // The curve touches a boundary between stations, which the coarse walk missed.
            true if s - from >= to - s => [from, s],
            true => [s, to],
            false => [from, to],
        }),
        curve: (0..=DRAWN_INTERVALS).map(|i| at(curves, f64::from(i) / f64::from(DRAWN_INTERVALS))).collect(),
    }
}

/// Finds the b, rad, nearest to a given one at which curves can be followed. It is in the set `common`, at which each
/// point can be reached. The second value is this b rounded so that the curves can still be followed.
fn nearest_b(map: &PlaneMap, curves: &[Curve], b: f64, rule: Rule, common: &BSet) -> Option<(f64, Option<Decimal>)> {
    const TRIES: usize = 24;
    let can = |b: f64| is_feasible(map, curves, b, rule);
    let mut tries: Vec<f64> = Vec::new();
    for [low, high] in common.shifted_near(b).intervals {
        // Slightly inside the interval, where rounding does not matter.
        let inset = (1e-7_f64).min(0.25 * (high - low));
        let (low, high) = (low + inset, high - inset);
        tries.extend((0..=TRIES).map(|i| low + (high - low) * i as f64 / TRIES as f64));
        tries.push(b.clamp(low, high));
    }
    tries.sort_by(|x, y| (x - b).abs().total_cmp(&(y - b).abs()));
    let found = tries.iter().position(|x| can(*x))?;
    let first = tries[found];
    let mut good = first;
    // Bisect between this b and the nearest infeasible one on the same side of the given b.
    let beside = tries[..found].iter().rev().copied().find(|x| (x - b) * (good - b) >= 0.0);
    if let Some(mut bad) = beside {
        for _ in 0..16 {
            let middle = 0.5 * (good + bad);
            if can(middle) { good = middle } else { bad = middle }
        }
    }
    // Between stations the curve may still leave the workspace slightly: then take a b further inside.
    let start = curves.first().map(|curve| curve.at(0.0).p)?;
    let follows =
        |b: f64| starting_poses(map, start, b, None).into_iter().any(|a| tables(map, curves, b, a, rule).is_ok());
    let mut further = [good, first, common.moved_inside(first, 0.5)].into_iter().chain(tries[found..].iter().copied());
    let mut inner = further.find(|b| follows(*b))?;
    if inner != good {
        for _ in 0..10 {
            let middle = 0.5 * (good + inner);
            if follows(middle) { inner = middle } else { good = middle }
        }
    }
    Some((inner, Decimal::shortest_passing(inner, 4, follows)))
}

/// Finds the longest part of curves that can be followed on a plane, as an interval of s over all of them.
fn longest(map: &PlaneMap, curves: &[Curve], b: f64, rule: Rule) -> Option<[f64; 2]> {
    let turn = unit(-map.turn(b));
    let mut best: Option<[f64; 2]> = None;
    let mut better = |from: f64, to: f64| {
        if best.is_none_or(|[low, high]| to - from > high - low) {
            best = Some([from, to]);
        }
    };
    // Parts that can be followed up to the present station: the s where they began, and the pose at this station.
    let mut runs: Vec<(f64, [f64; 2])> = Vec::new();
    let n = 2 * TRIAL_STATIONS;
    for i in 0..n {
        let (s, t) = (i as f64 / n as f64, (i + 1) as f64 / n as f64);
        let (which, from) = part(curves, s);
        for pose in map.poses(at(curves, s), b).iter() {
            let known = |r: &(f64, [f64; 2])| (r.1[0] - pose.a[0]).hypot(r.1[1] - pose.a[1]) < 1e-6;
            if !runs.iter().any(known) {
                // This part began between the last station and this one.
                runs.push((begin(map, curves, b, rule, s, pose.a, n), pose.a));
            }
        }
        runs.retain_mut(|(began, a)| {
            let track = |curve| PlaneTrack { map, b, turn, curve, rule };
            let (next, to) = part(curves, t);
            let end = if next == which { to } else { 1.0 };
            let stepped = track(&curves[which]).advance(*a, from, end);
            let stepped = match stepped {
                Ok(x) if next != which => {
                    track(&curves[next]).advance(x, 0.0, to).map_err(|(s, ..)| whole_s(curves, next, s))
                }
                Ok(x) => Ok(x),
                Err((s, ..)) => Err(whole_s(curves, which, s)),
            };
            match stepped {
                Ok(x) => {
                    *a = x;
                    true
                }
                Err(s) => {
                    better(*began, s);
                    false
                }
            }
        });
    }
    runs.iter().for_each(|(began, _)| better(*began, 1.0));
    best
}

/// Returns the least s, at most one station before the given s, back to which a curve can be followed from a pose.
fn begin(map: &PlaneMap, curves: &[Curve], b: f64, rule: Rule, s: f64, a: [f64; 2], n: usize) -> f64 {
    let back = (s - 1.0 / n as f64).max(0.0);
    let (mut good, mut bad) = (s, back);
    if s == 0.0 {
        return 0.0;
    }
    for _ in 0..24 {
        let middle = 0.5 * (good + bad);
        let on_sheet = map.follow(at(curves, middle), b, a).is_some_and(|x| rule.keeps_side(map, a, x));
        if on_sheet { good = middle } else { bad = middle }
    }
    good
}
