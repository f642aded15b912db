//! Following curves from a pose, and tests whether they can be followed.

use super::rule::{Rule, TraceEnd};
use super::track::PlaneTrack;
use crate::curves::{Curve, PathTable};
use crate::reactionless::{BSet, PlaneMap};
use stillbase_mechanics::planar::{Vector, unit};

/// Number of stations in the searches for another b, or for the longest part of a curve.
pub(super) const TRIAL_STATIONS: usize = 96;

/// Follows a curve on the plane b, rad, from a pose at its start in `stations` steps and returns the last pose, rad.
///
/// # Errors
/// The s at which the curve can no longer be followed, the last pose, and the reason.
pub fn walk(
    map: &PlaneMap,
    curve: &Curve,
    b: f64,
    start: [f64; 2],
    rule: Rule,
    stations: usize,
) -> Result<[f64; 2], TraceEnd> {
    let track = PlaneTrack { map, b, turn: unit(-map.turn(b)), curve, rule };
    let mut a = start;
    for i in 0..stations {
        let s = |i: usize| i as f64 / stations as f64;
        a = track.advance(a, s(i), s(i + 1))?;
    }
    Ok(a)
}

/// Returns the poses of a point on a plane, those nearest to `prefer` first.
pub(super) fn starting_poses(map: &PlaneMap, p: Vector, b: f64, prefer: Option<[f64; 2]>) -> Vec<[f64; 2]> {
    let mut starts: Vec<[f64; 2]> = map.poses(p, b).iter().map(|x| x.a).collect();
    if let Some(wanted) = prefer {
        let far = |a: &[f64; 2]| (a[0] - wanted[0]).hypot(a[1] - wanted[1]);
        starts.sort_by(|x, y| far(x).total_cmp(&far(y)));
    }
    starts
}

pub(super) fn tables(
    map: &PlaneMap,
    curves: &[Curve],
    b: f64,
    start: [f64; 2],
    rule: Rule,
) -> Result<Vec<PathTable>, TraceEnd> {
    let turn = unit(-map.turn(b));
    let mut a = start;
    let mut tables = Vec::with_capacity(curves.len());
    for (i, curve) in curves.iter().enumerate() {
        let track = PlaneTrack { map, b, turn, curve, rule };
        let table = track.table(a).map_err(|(s, a, stop)| (whole_s(curves, i, s), a, stop))?;
        a = table.nodes().last().map_or(a, |last| map.project(&last.q).a);
        tables.push(table);
    }
    Ok(tables)
}

/// Converts s on curve i to s over all curves, by length.
pub(super) fn whole_s(curves: &[Curve], i: usize, s: f64) -> f64 {
    let length = |c: &Curve| c.length();
    let before: f64 = curves[..i].iter().map(length).sum();
    (before + s * curves[i].length()) / curves.iter().map(length).sum::<f64>()
}

/// Converts s over all curves to the index of a curve and its s.
pub fn part(curves: &[Curve], s: f64) -> (usize, f64) {
    let total: f64 = curves.iter().map(Curve::length).sum();
    let mut rest = s * total;
    for (i, curve) in curves.iter().enumerate() {
        if rest <= curve.length() || i + 1 == curves.len() {
            return (i, (rest / curve.length()).clamp(0.0, 1.0));
        }
        rest -= curve.length();
    }
    (0, 0.0)
}

pub(super) fn at(curves: &[Curve], s: f64) -> Vector {
    let (i, s) = part(curves, s);
    curves[i].at(s).p
}

/// Returns whether curves can be followed on a plane from any pose at their start.
pub fn is_feasible(map: &PlaneMap, curves: &[Curve], b: f64, rule: Rule) -> bool {
    let Some(first) = curves.first() else { return true };
    let stations = (TRIAL_STATIONS / curves.len()).max(8);
    starting_poses(map, first.at(0.0).p, b, None)
        .into_iter()
        .any(|start| curves.iter().try_fold(start, |a, curve| walk(map, curve, b, a, rule, stations).ok()).is_some())
}

/// Returns the b that reach every one of `points` evenly spaced points of the curves.
pub fn common_b(map: &PlaneMap, curves: &[Curve], points: usize) -> BSet {
    let n = points.max(2) - 1;
    let sets: Option<Vec<BSet>> = (0..=n).map(|i| map.reach(at(curves, i as f64 / n as f64)).ok()).collect();
    sets.map_or(BSet { intervals: Vec::new(), period: map.period() }, |sets| BSet::overlap(&sets))
}
