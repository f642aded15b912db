//! The motion on a plane that is nearest to a given one with the same end effector: its curve is followed on one sheet.

use super::deviation::{apart, least};
use super::trace::{self, Blocked, Rule};
use crate::mechanics::kinematics::{acceleration, end_effector, velocity};
use crate::mechanics::machine::{Chain, Inertia};
use crate::mechanics::planar::DriveAngles;
use crate::planning::curves::curve::{Curve, CurvePoint};
use crate::planning::curves::given::Samples;
use crate::planning::curves::table::PathTable;
use crate::planning::reactionless::PlaneMap;
use crate::query::Watch;

/// b that are tried in each interval, and golden sections after that.
const TRIES: usize = 32;
const SECTIONS: usize = 24;

/// Samples that judge a plane.
const JUDGED: usize = 201;

/// The curve of the end effector over s = t/T that a path of the drives through samples makes.
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

/// The constant b whose motion with the same end effector is nearest to the given one, rad, and its ‖Δq‖, rad; `None`
/// if none can be followed, or the rest is not wanted. Judged by some two hundred of the samples.
pub(super) fn nearest_b(
    map: &PlaneMap,
    model: &Inertia,
    samples: &Samples,
    rule: Rule,
    goes_on: Watch<'_>,
) -> Option<(f64, f64)> {
    let (thin, tip) = (samples.thinned(JUDGED), &model.end_effector);
    let curve = tip_curve(tip, &thin.path(0.0)?)?;
    let far = |b: f64| {
        let moved = same_tip(map, tip, &thin, b, rule).ok().flatten();
        moved.map_or(f64::INFINITY, |moved| apart(model, &thin, &moved))
    };
    let mean = (0..thin.count()).map(|i| map.project(thin.values(i)).b).sum::<f64>() / thin.count() as f64;
    // A little inside: at the very ends a relative angle grazes its limit, or two poses meet.
    least(&trace::common_b(map, std::slice::from_ref(&curve), JUDGED), mean, [TRIES, SECTIONS], far, goes_on)
}

/// The samples moved onto the plane b, rad, with the end effector where it was at every one of them, on the sheet
/// nearest to the first pose.
///
/// # Errors
/// Where the plane does not reach, and which b would do; `None` if there is nothing to move.
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
