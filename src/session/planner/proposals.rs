//! Refusals that propose only alternatives that have been tried.

use super::plan::PlanningEffort;
use crate::refusal::Refusal;
use crate::scenario::{PathShape, Task};
use stillbase_mechanics::planar::Vector;
use stillbase_planning::common::common_b_set;
use stillbase_planning::pose_constant::{PointCorrection, Unreachable};
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::reactionless::{BSet, Decimal};

/// Depths inside an interval of b at which values are tried, as fractions of half its width.
const TRIAL_DEPTHS: [f64; 8] = [1e-3, 0.1, 0.3, 0.6, 1.0, 1.4, 1.7, 1.9];
/// Number of decimals of the values tried.
const DECIMALS: usize = 4;

/// Returns the refusal, its proposals tried with `try_path`: infeasible ones are replaced, marked or removed. Points
/// that share a b may still have no path between them on its plane.
pub(super) fn proved_refusal(
    task: &Task,
    space: &PoseSpace,
    try_path: &dyn Fn(&Task, PlanningEffort) -> Result<(), Refusal>,
    refusal: Refusal,
) -> Refusal {
    // A start has a b of its own.
    let at = |task: &Task, b: f64| Task { b, start: None, ..task.clone() };
    // A refusal of a path on one plane may name another plane.
    let another = |why: &Refusal| match why {
        Refusal::Blocked(blocked) => blocked.nearest_b.zip(blocked.displayed_b),
        _ => None,
    };
    match refusal {
        Refusal::NoCommonPlane { mut why, .. } => {
            if let Some((mend, mut shown)) = why.correction.and_then(|mend| Some((mend, mend.shown?))) {
                let moved = task.moved(mend.point, shown.point());
                let result = moved.as_ref().map(|moved| try_path(&at(moved, shown.b.value()), PlanningEffort::Trial));
                shown.path_feasible = match result {
                    Some(Ok(_)) => true,
                    Some(Err(stopped)) => {
                        let other = another(&stopped).map(|(_, other)| other).or_else(|| {
                            let moved = moved.as_ref()?;
                            let serving = common_b_set(space, &moved.points())?;
                            inner_values(&serving, shown.b.value())
                                .find(|b| try_path(&at(moved, b.value()), PlanningEffort::Trial).is_ok())
                        });
                        shown.b = other.unwrap_or(shown.b);
                        other.is_some()
                    }
                    None => false,
                };
                why.correction = Some(PointCorrection { shown: Some(shown), ..mend });
            }
            Refusal::NoCommonPlane { message: why.in_words(&|i| task.name_of(i)), why }
        }
        Refusal::Unreachable { .. } if task.shape() != PathShape::JointLine || task.keep_off_change_points => {
            tried_refusal(space, refusal, |b, effort| try_path(&at(task, b), effort))
        }
        other => other,
    }
}

/// Completes the refusal of a b that does not reach a point. Proposes the nearest b at which the whole path is
/// feasible, or states what stops the path.
pub(super) fn tried_refusal(
    space: &PoseSpace,
    refusal: Refusal,
    try_path: impl Fn(f64, PlanningEffort) -> Result<(), Refusal>,
) -> Refusal {
    let Refusal::Unreachable {
        point,
        unreachable: Unreachable::OnThisPlane { x, y, b, nearest_b: Some(nearest), displayed_b: Some(shown), .. },
    } = &refusal
    else {
        return refusal;
    };
    let made = |feasible: String, nearest_b: Option<f64>, displayed_b: Option<Decimal>| {
        let unreachable = Unreachable::OnThisPlane { x: *x, y: *y, b: *b, feasible, nearest_b, displayed_b };
        Refusal::Unreachable { point: point.clone(), unreachable }
    };
    let stopped = match try_path(shown.value(), PlanningEffort::Whole) {
        Ok(()) => {
            let exact = if try_path(*nearest, PlanningEffort::Trial).is_ok() { *nearest } else { shown.value() };
            return made(format!("b = {shown} rad"), Some(exact), Some(*shown));
        }
        Err(stopped) => stopped,
    };
    // A refusal of the path on one plane may name another plane.
    if let Refusal::Blocked(blocked) = &stopped
        && let Some((nearest, shown)) = blocked.nearest_b.zip(blocked.displayed_b)
    {
        return made(format!("b = {shown} rad"), Some(nearest), Some(shown));
    }
    let own = space.reach(Vector::new(*x, *y)).ok();
    if let Some(shown) =
        own.and_then(|set| inner_values(&set, *nearest).find(|b| try_path(b.value(), PlanningEffort::Trial).is_ok()))
    {
        return made(format!("b = {shown} rad"), Some(shown.value()), Some(shown));
    }
    // The refusal of a path of four drives and more names its b itself.
    let (said, at) = (stopped.to_string(), format!("at b = {shown} rad "));
    made(format!("another path: {at}{}", said.strip_prefix(&at).unwrap_or(&said)), None, None)
}

/// Yields values of b, rad, ever farther inside a set, from the bound nearest to `near` towards the opposite bound.
pub(super) fn inner_values(set: &BSet, near: f64) -> impl Iterator<Item = Decimal> + use<'_> {
    TRIAL_DEPTHS.into_iter().filter_map(move |share| set.decimal(set.moved_inside(near, share), DECIMALS))
}
