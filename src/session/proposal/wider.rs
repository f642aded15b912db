//! Joint limits that let a task be planned: the tightest around the motion that is then found.

use toml::Value;

use super::Proposal;
use crate::refusal::Refusal;
use crate::run::Run;
use crate::scenario::Scenario;
use stillbase_planning::following::SheetEnd;
use stillbase_planning::pose_constant::Unreachable;
use stillbase_planning::reactionless::NoReach;

/// Angles by which all limits are widened, in the order of the trials, rad.
const WIDER_RAD: [f64; 4] = [0.1, 0.3, 1.0, 3.0];
/// Number of intervals in which a motion is searched for its extreme angles.
const INTERVALS: usize = 512;
/// Decimals of a limit, rad: 10 to this power is the scale.
const SCALE: f64 = 1e3;

/// Returns whether a refusal names joint limits as what is in the way.
pub(super) fn names_limits(refusal: &Refusal) -> bool {
    match refusal {
        Refusal::Blocked(blocked) => matches!(blocked.stop, SheetEnd::Limit { .. }),
        Refusal::Unreachable { unreachable: Unreachable::Anywhere { reason, .. }, .. } => *reason == NoReach::Limits,
        // Of a point whose b were all tried, the reason is that of the last one.
        Refusal::Unreachable { unreachable: Unreachable::OnThisPlane { displayed_b, .. }, .. } => displayed_b.is_none(),
        Refusal::NoWay(_) | Refusal::LeastReaction(_) => true,
        _ => false,
    }
}

/// Returns the limits that have to be wider so that a task can be planned, as little as possible. The motion is planned
/// once more within them.
pub(super) fn wider_limits(scenario: &Scenario) -> Option<Proposal> {
    WIDER_RAD.into_iter().find_map(|by| within(scenario, by).filter(|wider| wider.tried(scenario).is_some()))
}

/// Returns the limits that contain both the present ones and the motion planned with all limits wider by an angle, rad.
fn within(scenario: &Scenario, by: f64) -> Option<Proposal> {
    let angles = scenario.machine.angles();
    let bounds: Vec<[f64; 2]> = angles.iter().map(|angle| [*angle.limits.start(), *angle.limits.end()]).collect();
    let key = |i: usize| format!("limits.{}", angles[i].name);
    let is_bounded = |i: &usize| bounds[*i].iter().all(|end| end.is_finite());
    let pair = |[low, high]: [f64; 2]| Value::Array(vec![low.into(), high.into()]);
    let all = (0..angles.len()).filter(is_bounded);
    let wider: Vec<(String, Value)> =
        all.clone().map(|i| (key(i), pair([bounds[i][0] - by, bounds[i][1] + by]))).collect();
    let run = Proposal::of_values("take", &wider).tried(scenario)?;
    let exceeded = all.filter_map(|i| {
        let [low, high] = extremes(&run, i);
        // Rounded outwards by a whole unit, as an extreme between two samples lies beyond them.
        let needed = [
            if low < bounds[i][0] { ((low * SCALE).floor() - 1.0) / SCALE } else { bounds[i][0] },
            if high > bounds[i][1] { ((high * SCALE).ceil() + 1.0) / SCALE } else { bounds[i][1] },
        ];
        (needed != bounds[i]).then(|| (key(i), pair(needed)))
    });
    let exceeded: Vec<(String, Value)> = exceeded.collect();
    (!exceeded.is_empty()).then(|| Proposal::of_values("take", &exceeded))
}

/// Returns the least and the greatest relative angle of a planned motion, rad.
fn extremes(run: &Run, angle: usize) -> [f64; 2] {
    let angle = &run.scenario().machine.angles()[angle];
    let at = |i: usize| {
        let q = run.plan().motion.path.at(i as f64 / INTERVALS as f64).q;
        q[angle.to] - q[angle.from] + angle.offset
    };
    let all = (0..=INTERVALS).map(at);
    all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}
