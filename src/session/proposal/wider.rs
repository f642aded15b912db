//! Joint limits that let a task be planned: the tightest around the motion that is then found.

use toml::Value;

use super::Proposal;
use crate::refusal::Refusal;
use crate::run::Run;
use crate::scenario::Scenario;
use stillbase_planning::following::SheetEnd;
use stillbase_planning::pose_constant::Unreachable;
use stillbase_planning::reactionless::NoReach;

/// Angles by which limits are widened, in the order of the trials, rad.
const WIDER_RAD: [f64; 5] = [0.1, 0.4, 1.0, 1.6, 3.0];
/// Shares by which the lower and the upper limit of one angle are widened, in the order of the trials.
const SIDES: [[f64; 2]; 3] = [[0.0, 1.0], [1.0, 0.0], [1.0, 1.0]];
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

/// Returns the limits that have to be wider so that a task can be planned, as little as possible: of one angle alone or,
/// if that does not help, of all. Another motion may be chosen within the tightest limits; then they stay wider.
pub(super) fn wider_limits(scenario: &Scenario) -> Option<Proposal> {
    let all: Vec<usize> = (0..scenario.machine.angles().len()).collect();
    let alone = all.iter().flat_map(|i| SIDES.map(|sides| (vec![*i], sides)));
    alone.chain([(all.clone(), [1.0, 1.0])]).find_map(|(angles, sides)| {
        let wider = |by: f64| within(scenario, &angles, sides.map(|side| by * side));
        WIDER_RAD.into_iter().find_map(wider)
    })
}

/// Returns limits that contain both the present ones and the motion planned with the limits of some angles lower and
/// higher by `down` and `up`, rad; `None` if there is no motion with these, or it needs none of them.
fn within(scenario: &Scenario, angles: &[usize], [down, up]: [f64; 2]) -> Option<Proposal> {
    let of = |i: usize| &scenario.machine.angles()[i];
    let bounds = |i: usize| [*of(i).limits.start(), *of(i).limits.end()];
    let key = |i: usize| format!("limits.{}", of(i).name);
    let pair = |[low, high]: [f64; 2]| Value::Array(vec![low.into(), high.into()]);
    let all = angles.iter().copied().filter(|i| bounds(*i).iter().all(|end| end.is_finite()));
    let widened = |i: usize| pair([bounds(i)[0] - down, bounds(i)[1] + up]);
    let wider: Vec<(String, Value)> = all.clone().map(|i| (key(i), widened(i))).collect();
    let whole = Proposal::of_values("take", &wider);
    let run = whole.tried(scenario)?;
    let exceeded = all.filter_map(|i| {
        let ([low, high], [least, greatest]) = (extremes(&run, i), bounds(i));
        // Rounded outwards by a whole unit, as an extreme between two samples lies beyond them.
        let needed = [
            if low < least { ((low * SCALE).floor() - 1.0) / SCALE } else { least },
            if high > greatest { ((high * SCALE).ceil() + 1.0) / SCALE } else { greatest },
        ];
        (needed != bounds(i)).then(|| (key(i), pair(needed)))
    });
    let exceeded: Vec<(String, Value)> = exceeded.collect();
    let tightest = (!exceeded.is_empty()).then(|| Proposal::of_values("take", &exceeded))?;
    Some(if tightest.tried(scenario).is_some() { tightest } else { whole })
}

/// Returns the least and the greatest relative angle of a planned motion, rad.
fn extremes(run: &Run, angle: usize) -> [f64; 2] {
    let angle = &run.scenario().machine.angles()[angle];
    let at = |i: usize| angle.value(&run.plan().motion.path.at(i as f64 / INTERVALS as f64).q);
    let all = (0..=INTERVALS).map(at);
    all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}
