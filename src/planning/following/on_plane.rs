//! For a given motion: the nearest motion with the same end effector path on a plane b = const and on one sheet.

use super::deviation::{angle_distance, least};
use super::trace::{self, Blocked, Rule};
use crate::curves::curve::{Curve, CurvePoint};
use crate::curves::given::Samples;
use crate::curves::table::PathTable;
use crate::reactionless::PlaneMap;
use stillbase_mechanics::kinematics::{acceleration, end_effector, velocity};
use stillbase_mechanics::machine::{Chain, Inertia};
use stillbase_mechanics::planar::DriveAngles;
use stillbase_query::ProgressCallback;

/// Number of b tried in each interval.
const TRIES: usize = 32;
/// Number of golden section steps that refine the best b.
const SECTIONS: usize = 24;

/// Number of samples from which the deviation at a b is computed.
const DEVIATION_SAMPLES: usize = 201;

/// Returns the end effector curve over s = t/T of a path of the drives.
fn tip_curve(tip: &Chain, path: &PathTable) -> Option<Curve> {
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

/// Finds the constant b, rad, whose motion with the same end effector path is nearest to the given one. Also returns
/// the ‖Δq‖, rad, of that motion. Both come from at most 201 of the samples. Returns `None` if the curve can be
/// followed at no b, or if `goes_on` cancels the search.
pub(super) fn nearest_b(
    map: &PlaneMap,
    model: &Inertia,
    samples: &Samples,
    rule: Rule,
    goes_on: ProgressCallback<'_>,
) -> Option<(f64, f64)> {
    let (thin, tip) = (samples.thinned(DEVIATION_SAMPLES), &model.end_effector);
    let curve = tip_curve(tip, &thin.path(0.0)?)?;
    let far = |b: f64| {
        let moved = same_tip(map, tip, &thin, b, rule).ok().flatten();
        moved.map_or(f64::INFINITY, |moved| angle_distance(model, &thin, &moved))
    };
    let mean = (0..thin.count()).map(|i| map.project(thin.values(i)).b).sum::<f64>() / thin.count() as f64;
    // `least` tries inside the intervals: at their bounds a relative angle touches its limit, or two poses meet.
    least(&trace::common_b(map, std::slice::from_ref(&curve), DEVIATION_SAMPLES), mean, [TRIES, SECTIONS], far, goes_on)
}

/// Moves every sample to the plane b, rad, with its end effector position unchanged, on the sheet nearest to the first
/// pose. Returns `None` if the samples define no path.
///
/// # Errors
/// If the curve cannot be followed: where and why, and a b at which it can, if known.
pub(super) fn same_tip(
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
