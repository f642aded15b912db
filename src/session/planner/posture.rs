//! Paths of machines with four or more drives at constant b; the task's posture resolves the remaining redundancy.

use super::plan::PlanningEffort;
use super::poses::{hand_of, posed, poses_facing, stated};
use super::proposals::inner_values;
use crate::refusal::Refusal;
use crate::scenario::{Scenario, Task};
use stillbase_mechanics::planar::Vector;
use stillbase_planning::common::common_b_set;
use stillbase_planning::curves::path::least_rate_curve;
use stillbase_planning::curves::{Curve, PathPoint, PathTable};
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::posture::{Posture, PostureRequest};
use stillbase_planning::timing::TimeLaw;
use stillbase_settings::number::nine_digits;
use stillbase_settings::word::Choice as _;

/// Number of intervals of each curve. At a proposed b, the end effector has to reach the end points of all intervals.
const INTERVALS_PER_CURVE: usize = 16;
/// An angle may exceed its limit by this much, rad, because of rounding.
const LIMIT_TOLERANCE_RAD: f64 = 1e-9;
/// Amounts by which both limits of an angle are widened, rad, in the order of the trials.
const WIDENINGS_RAD: [f64; 3] = [0.1, 0.4, 1.0];

/// Returns a path along each curve; `law` is that of [`PostureRequest::law`].
///
/// # Errors
/// If no path covers all curves. The error states how far they can be followed and, with [`PlanningEffort::Whole`], a
/// proposal.
pub(super) fn tables(
    scenario: &Scenario,
    space: &PoseSpace,
    curves: &[Curve],
    law: Option<TimeLaw>,
    effort: PlanningEffort,
) -> Result<Vec<PathTable>, Refusal> {
    let task = &scenario.task;
    if stated(task, space.drives(), 0).is_some() {
        return from_start(scenario, space, curves);
    }
    let link = hand_of(scenario);
    let angle = task.orientation.filter(|_| scenario.condition_for_effect("task.orientation").is_none());
    if angle.is_some() {
        poses_facing(scenario, space, &task.points(), 0, &space.middle(), None)?;
    }
    let hand = (link.0, angle.map(|angle| angle - link.1));
    let request =
        PostureRequest { machine: &scenario.machine, space, b: task.b, curves, law, closed: task.closed, hand };
    // Minimum-norm rates from the pose nearest to the middle mostly keep the limits. If they do not, a search is
    // needed.
    let local = || locally(scenario, space, curves).ok().filter(|tables| keep_limits(space, tables));
    let is_local = task.posture == Posture::LeastRates && !task.closed;
    if let Some(tables) = is_local.then(local).flatten() {
        return Ok(tables);
    }
    let search = match effort {
        PlanningEffort::Trial => request.quick_path(task.posture),
        PlanningEffort::Whole => request.path(task.posture),
    };
    let why = match search {
        Ok(found) => return Ok(found.tables),
        Err(why) => why,
    };
    if let Some(tables) = (task.posture != Posture::Orientation && !is_local).then(local).flatten() {
        return Ok(tables);
    }
    let tried = (effort == PlanningEffort::Whole).then(|| proposal(&request, task)).flatten();
    let proposed = tried.unwrap_or_else(|| "another path, or wider limits".into());
    Err(Refusal::NoWay(format!("at b = {} rad {why}: want {proposed}", nine_digits(task.b))))
}

/// Follows each curve from the start that the task states, with minimum-norm rates.
///
/// # Errors
/// If the posture of the task chooses the pose of A, or the curves cannot be followed.
fn from_start(scenario: &Scenario, space: &PoseSpace, curves: &[Curve]) -> Result<Vec<PathTable>, Refusal> {
    match scenario.task.posture {
        Posture::LeastRates => locally(scenario, space, curves),
        posture => Err(Refusal::Task(format!(
            "the posture {} chooses the pose of A: want no start, or the posture least-rates",
            posture.words().file
        ))),
    }
}

/// Follows each curve with minimum-norm rates, from the start of the task or the pose nearest to the middle of all ranges.
fn locally(scenario: &Scenario, space: &PoseSpace, curves: &[Curve]) -> Result<Vec<PathTable>, Refusal> {
    let mut q = posed(&scenario.task, space, &scenario.task.points()[..1], 0, &space.middle())?;
    let mut tables = Vec::with_capacity(curves.len());
    for curve in curves {
        let table = least_rate_curve(scenario.machine.end_effector(), Some(space.lambda()), q, curve)?;
        q = table.nodes().last().map_or(q, |last| last.q);
        tables.push(table);
    }
    Ok(tables)
}

/// Returns whether all nodes of paths are within the joint limits.
fn keep_limits(space: &PoseSpace, tables: &[PathTable]) -> bool {
    let keeps = |node: &PathPoint| {
        space.joints().iter().all(|joint| {
            let ([low, high], a) = (joint.bounds(), joint.of(&node.q));
            a >= low - LIMIT_TOLERANCE_RAD && a <= high + LIMIT_TOLERANCE_RAD
        })
    };
    tables.iter().flat_map(|table| table.nodes()).all(keeps)
}

/// Returns whether a quick search finds the whole path.
fn is_feasible(request: &PostureRequest<'_>, posture: Posture) -> bool {
    request.quick_path(posture).is_ok()
}

/// Finds a posture, a b or a limit with which the whole path is feasible.
fn proposal(request: &PostureRequest<'_>, task: &Task) -> Option<String> {
    if task.posture == Posture::Orientation {
        let free = PostureRequest { hand: (request.hand.0, None), ..*request };
        if request.hand.1.is_some() && is_feasible(&free, Posture::Orientation) {
            return Some("no task.orientation: the hand then keeps a feasible one".into());
        }
        if is_feasible(request, Posture::LeastRates) {
            return Some("posture = least-rates".into());
        }
    }
    let at = |curve: &Curve| {
        (0..=INTERVALS_PER_CURVE).map(|i| curve.at(i as f64 / INTERVALS_PER_CURVE as f64).p).collect::<Vec<_>>()
    };
    let points: Vec<Vector> = request.curves.iter().flat_map(at).collect();
    let another = common_b_set(request.space, &points).and_then(|serving| {
        let near = serving.nearest(request.b)?;
        let serves = |b: f64| b != request.b && is_feasible(&PostureRequest { b, ..*request }, task.posture);
        inner_values(&serving, near).find(|b| serves(b.value()))
    });
    another.map(|b| format!("b = {b} rad")).or_else(|| wider(request, task.posture))
}

/// Proposes the smallest trial widening of one angle's limits that makes the path feasible at the same b.
fn wider(request: &PostureRequest<'_>, posture: Posture) -> Option<String> {
    WIDENINGS_RAD.into_iter().find_map(|by| {
        request.machine.angles().iter().find_map(|angle| {
            let key = format!("limits.{}", angle.name);
            let value = format!("{:.2},{:.2}", angle.limits.start() - by, angle.limits.end() + by);
            let machine = request.machine.set(&key, &value).ok()?;
            let space = PoseSpace::of(&machine).ok()?;
            let wide = PostureRequest { machine: &machine, space: &space, ..*request };
            is_feasible(&wide, posture).then(|| format!("{key} = {value} rad at this b"))
        })
    })
}
