//! Paths of four drives and more that hold b, with their freedoms used as the task wants.

use super::pose::{faced, hand_of, posed};
use crate::mechanics::planar::Vector;
use crate::planning::common::common;
use crate::planning::curves::path::least_rate_curve;
use crate::planning::curves::{Curve, PathPoint, PathTable};
use crate::planning::pose_space::PoseSpace;
use crate::planning::posture::{Asked, Posture};
use crate::planning::reactionless::Decimal;
use crate::planning::timing::TimeLaw;
use crate::session::refusal::Refusal;
use crate::session::scenario::{Scenario, Task};
use crate::settings::number::Short;

/// Places along each curve that a b has to reach to be proposed.
const ASKED: usize = 16;
/// How far inside its range a b is tried.
const INWARDS: [f64; 6] = [1e-3, 0.1, 0.4, 0.7, 1.0, 1.5];
/// An angle passes its limit by no more than this, rad: rounding.
const AT_LIMIT: f64 = 1e-9;
/// Decimals of a b that is proposed.
const DECIMALS: usize = 4;

/// A path along each curve; `law` as [`Asked::law`].
///
/// # Errors
/// How far a way goes, and what would do.
pub(super) fn tables(
    scenario: &Scenario,
    space: &PoseSpace,
    curves: &[Curve],
    law: Option<TimeLaw>,
) -> Result<Vec<PathTable>, Refusal> {
    let task = &scenario.task;
    let link = hand_of(scenario);
    let angle = task.orientation.filter(|_| scenario.idle("task.orientation").is_none());
    if angle.is_some() {
        faced(scenario, space, (&task.points(), 0), (&space.middle(), None))?;
    }
    let hand = (link.0, angle.map(|angle| angle - link.1));
    let asked = Asked { machine: &scenario.machine, space, b: task.b, curves, law, closed: task.closed, hand };
    // Least rates mostly go on within the limits from the pose nearest to the middle; a search is for where they do not.
    let local = locally(scenario, space, curves);
    if let Ok(tables) = &local
        && task.posture == Posture::LeastRates
        && !task.closed
        && keep_limits(space, tables)
    {
        return local;
    }
    let why = match asked.path(task.posture) {
        Ok(found) => return Ok(found.tables),
        Err(_) if task.posture != Posture::Orientation => return local,
        Err(why) => why,
    };
    let would_do = proposal(&asked, task).unwrap_or_else(|| "another path, or wider limits".into());
    Err(Refusal::NoWay(format!("at b = {} rad {why}: want {would_do}", Short(task.b))))
}

/// Least rates along each curve, from the pose nearest to the middle of all ranges.
fn locally(scenario: &Scenario, space: &PoseSpace, curves: &[Curve]) -> Result<Vec<PathTable>, Refusal> {
    let mut q = posed(&scenario.task, space, (&scenario.task.points()[..1], 0), &space.middle())?;
    let mut tables = Vec::with_capacity(curves.len());
    for curve in curves {
        let table = least_rate_curve(scenario.machine.end_effector(), Some(space.lambda()), q, curve)?;
        q = table.nodes().last().map_or(q, |last| last.q);
        tables.push(table);
    }
    Ok(tables)
}

/// Whether all nodes of paths are within the limits.
fn keep_limits(space: &PoseSpace, tables: &[PathTable]) -> bool {
    let keeps = |node: &PathPoint| {
        space.joints().iter().all(|joint| {
            let ([low, high], a) = (joint.bounds(), joint.of(&node.q));
            a >= low - AT_LIMIT && a <= high + AT_LIMIT
        })
    };
    tables.iter().flat_map(|table| table.nodes()).all(keeps)
}

/// A posture or a b with which the whole path goes.
fn proposal(asked: &Asked<'_>, task: &Task) -> Option<String> {
    let goes = |asked: &Asked<'_>, posture: Posture| asked.path(posture).is_ok();
    if task.posture == Posture::Orientation {
        if asked.hand.1.is_some() && goes(&Asked { hand: (asked.hand.0, None), ..*asked }, Posture::Orientation) {
            return Some("no orientation, so that it keeps the one that serves".into());
        }
        if goes(asked, Posture::LeastRates) {
            return Some("posture = least-rates".into());
        }
    }
    let points: Vec<Vector> =
        asked.curves.iter().flat_map(|curve| (0..=ASKED).map(|i| curve.at(i as f64 / ASKED as f64).p)).collect();
    let serving = common(asked.space, &points)?;
    let near = serving.nearest(asked.b)?;
    let tries = INWARDS.into_iter().filter_map(|share| serving.decimal(serving.inwards(near, share), DECIMALS));
    let mut tries: Vec<Decimal> = tries.filter(|b| b.value() != asked.b).collect();
    tries.dedup_by(|x, y| x.value() == y.value());
    let does = tries.into_iter().find(|b| goes(&Asked { b: b.value(), ..*asked }, task.posture))?;
    Some(format!("b = {does} rad"))
}
