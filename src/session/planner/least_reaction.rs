//! Motions along curves of the end effector with the least reaction on the base.

use super::along::{along_parts, curves, timed};
use super::choose::START_TOLERANCE_RAD;
use super::held::{reactionless, sheet_of};
use super::plan::{Plan, PlannerSpace, PlanningEffort, arm_on_base, keeps_rules};
use super::poses::poses_at_b;
use super::rates::minimum_norm;
use crate::refusal::Refusal;
use crate::scenario::{ReactionObjective, Scenario, Task, TaskKind};
use stillbase_planning::curves::{Curve, CurvePoint, Path};
use stillbase_planning::following::trace;
use stillbase_planning::off_plane::LeastReaction;
use stillbase_planning::off_plane::b_course::BaseReaction;
use stillbase_planning::off_plane::least_reaction::{FixedB, MinimumNorm, ReactionNorm, Verdicts};
use stillbase_planning::pose_constant::Unreachable;
use stillbase_planning::pose_space::{PlaneError, Planes, PoseSpace};
use stillbase_planning::reactionless::{BSet, PlanePoint};
use stillbase_planning::timing::{DriveLimits, Profile, TimeLaw};
use stillbase_planning::{Forecast, Motion};
use stillbase_settings::number::nine_digits;
use stillbase_settings::word::Choice;

/// Plans the motion with the least reaction. On machines with planes, b moves in its feasible corridor with the least
/// moment on the base; on others b is held, if feasible.
pub(super) fn least_reaction(scenario: &Scenario, space: PlannerSpace<'_>) -> Result<Plan, Refusal> {
    if !scenario.machine.is_redundant() {
        let why = "along a path of the end effector one or two drives have no b to choose: want minimum-norm, which is the \
                   only motion along it, or reactionless in the shape joint-line";
        return Err(Refusal::Task(why.into()));
    }
    let law = smooth(&scenario.task)?;
    let space = space.map_err(Clone::clone)?;
    match space.planes() {
        Ok(planes) => in_corridor(scenario, space, planes, law),
        Err(lacking) => holding_b(scenario, space, lacking),
    }
}

/// Returns the time law of the task. Fails unless it is smooth and takes a given time.
fn smooth(task: &Task) -> Result<TimeLaw, Refusal> {
    let serves = |law: &TimeLaw| !law.is_fastest() && law.is_smooth();
    if serves(&task.law) {
        return Ok(task.law);
    }
    let serving: Vec<&str> = TimeLaw::ALL.iter().filter(|law| serves(law)).map(|law| law.words().file).collect();
    let kind = if task.law.is_fastest() { "law over a given time" } else { "smooth law" };
    Err(Refusal::Task(format!("least-reaction wants a {kind}: {}", serving.join(" or "))))
}

/// Joins all curves to one function of u = t/T, with derivatives by u. The law times each curve, which takes a share of
/// T in proportion to its length.
fn whole(curves: &[Curve], law: TimeLaw) -> impl Fn(f64) -> CurvePoint {
    let total: f64 = curves.iter().map(Curve::length).sum();
    let profile =
        Profile::sequence(curves.iter().map(|c| (Profile::of(law, c.length() / total), c.length())).collect());
    move |u: f64| {
        let at = profile.at(u);
        let (i, s) = trace::part(curves, at.s);
        let scale = total / curves[i].length();
        let local = curves[i].at(s);
        let (rate, acceleration) = (at.rate * scale, at.acceleration * scale);
        CurvePoint {
            p: local.p,
            first: local.first * rate,
            second: local.second * rate * rate + local.first * acceleration,
        }
    }
}

/// Plans the motion along the curves of the end effector; b moves in its corridor with the least base moment.
fn in_corridor(scenario: &Scenario, space: &PoseSpace, planes: &Planes, law: TimeLaw) -> Result<Plan, Refusal> {
    let (task, map) = (&scenario.task, planes.map());
    let curves = curves(task, &task.points())?;
    let curve = whole(&curves, law);
    let goal = match task.least {
        ReactionObjective::MeanSquare => ReactionNorm::Rms,
        ReactionObjective::Peak => ReactionNorm::Peak,
    };
    let arm = arm_on_base(scenario);
    let mut refused = None;
    let start = sheet_of(task, space);
    // Of the poses of a stated start, the one on its sheet.
    let is_wanted = |pose: &&PlanePoint| {
        start.is_none_or(|a| (pose.a[0] - a[0]).abs().max((pose.a[1] - a[1]).abs()) < START_TOLERANCE_RAD)
    };
    for start in map.poses(task.points()[0], task.b).iter().filter(is_wanted) {
        match LeastReaction::plan(map, arm.arm(), &curve, *start, task.b_to, goal) {
            Ok(plan) => {
                let motion = Motion { path: Path::Table(plan.path().clone()), profile: Profile::even(task.time) };
                keeps_rules(scenario, &motion)?;
                let verdicts = plan.compare(scenario.machine.end_effector(), &curve, task.time);
                return Ok(Plan { verdicts: Some(verdicts), ..Plan::of(scenario, motion) });
            }
            Err(why) => refused = Some(refused.unwrap_or(why)),
        }
    }
    match refused {
        Some(why) => Err(Refusal::LeastReaction(why)),
        None => {
            let refusal = poses_at_b(task, space, &task.points()[..1]).err();
            Err(refusal.unwrap_or_else(|| Refusal::NoWay("A has no pose".into())))
        }
    }
}

/// Plans the motion with b held, if that is feasible; no reaction then reaches the base. The corridor of b is known
/// only for machines with planes.
fn holding_b(scenario: &Scenario, space: &PoseSpace, lacking: &PlaneError) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    if let Some(b_to) = task.b_to.filter(|b_to| *b_to != task.b) {
        return Err(Refusal::Task(format!(
            "with {} drives the least reaction holds b, here to end at {b_to} rad: want change-b, or b_to = default",
            space.drives()
        )));
    }
    let holding = |b: f64, effort| {
        let start = task.start.filter(|_| b == task.b);
        let own =
            Task { kind: TaskKind::Reactionless, shape: Some(task.shape()), start, b, b_to: None, ..task.clone() };
        along_parts(&Scenario { task: own, ..scenario.clone() }, &|scenario| reactionless(scenario, Ok(space), effort))
    };
    let why = match holding(task.b, PlanningEffort::Whole) {
        Ok(plan) => return Ok(Plan { verdicts: Some(verdicts_of_held_b(scenario, space)?), ..plan }),
        Err(why @ Refusal::Unreachable { unreachable: Unreachable::Anywhere { .. }, .. }) => return Err(why),
        Err(Refusal::Unreachable { point, unreachable }) if point == task.name_of(0) => {
            return Err(Refusal::Unreachable { point, unreachable });
        }
        Err(why) => why,
    };
    let sets: Option<Vec<BSet>> = task.points().iter().map(|p| space.reach(*p).ok()).collect();
    let common = BSet::overlap(&sets.unwrap_or_default());
    let candidates = common
        .nearest(task.b)
        .into_iter()
        .flat_map(|b| [0.1, 0.4, 0.7, 1.0, 1.3, 1.6].map(|to| common.moved_inside(b, to)));
    let feasible =
        candidates.filter_map(|b| common.decimal(b, 4)).find(|b| holding(b.value(), PlanningEffort::Trial).is_ok());
    let proposal = match feasible {
        Some(b) => format!("at b = {b} rad it can: want that"),
        None => "want minimum-norm, or change-b from point to point".into(),
    };
    let only = match lacking.could_have_planes() {
        true => format!("it can change on the way only on planes: {lacking}"),
        false => "with other than three drives it does not change on the way".into(),
    };
    let why = why.to_string();
    Err(Refusal::NoWay(format!(
        "b = {} rad cannot be held along this path ({}), and {only}; {proposal}",
        nine_digits(task.b),
        why.split(": want").next().unwrap_or(&why)
    )))
}

/// Compares a motion with b held, which has no reaction, with the minimum-norm motion.
fn verdicts_of_held_b(scenario: &Scenario, space: &PoseSpace) -> Result<Verdicts, Refusal> {
    let usual = minimum_norm(scenario, Ok(space)).and_then(|parts| Ok(timed(scenario, parts)?.0));
    let minimum_norm = match usual {
        Ok(motion) => {
            let forecast = Forecast::of(&motion, &arm_on_base(scenario), &DriveLimits::of(&scenario.machine));
            let reaction = BaseReaction { peak: forecast.moment, rms: forecast.moment_rms };
            Ok(MinimumNorm { reaction, end_b: forecast.b_end, keeps_limits: keeps_rules(scenario, &motion).is_ok() })
        }
        Err(Refusal::Path(why)) => Err(why),
        Err(why) => return Err(why),
    };
    Ok(Verdicts { fixed: FixedB::Serves, minimum_norm, least: BaseReaction { peak: 0.0, rms: 0.0 } })
}
