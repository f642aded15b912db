//! Changes of a task that may lead out of a refusal. Whether one does, a trial shows.

use std::f64::consts::TAU;

use super::points::{ReachablePoints, in_first_period};
use super::value::taking;
use super::{Proposal, round_up};
use crate::design::balancing_change;
use crate::gentle_motion::made_for;
use crate::refusal::Refusal;
use crate::scenario::{MAX_STEPS, PathShape, Scenario, Task, TaskKind};
use stillbase_mechanics::machine::Inertia;
use stillbase_mechanics::planar::{Vector, unit};
use stillbase_planning::curves::CurveError;
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::reactionless::Decimal;
use stillbase_planning::timing::TimeLaw;
use stillbase_settings::change::{DEFAULT_WORD, join, single_change};
use stillbase_settings::number::significant;
use stillbase_settings::range::Requirement;
use stillbase_settings::word::Choice;
use stillbase_simulation::plant::BaseKind;

/// Distance of B from A, if both are the same, as a share of the reach, and the number of directions that are tried.
const APART_SHARE: f64 = 0.1;
const DIRECTIONS: u32 = 8;
/// Factors by which a step is made finer, in the order of the trials.
const FINER_STEPS: [f64; 2] = [4.0, 20.0];
/// Numbers of decimals of turned points, m, in the order of the trials.
const TURNED_DECIMALS: [usize; 3] = [3, 5, 9];

/// Returns changes that may lead out of a refusal, the least first.
pub(super) fn candidates(scenario: &Scenario, refusal: &Refusal) -> Vec<Proposal> {
    let (task, machine) = (&scenario.task, &scenario.machine);
    let kind = |kind: TaskKind, text: &str| Proposal::new(text, single_change("task.kind", kind.words().file));
    let mut found = Vec::new();
    if let Some(b) = refusal.displayed_b() {
        let take = |b: Decimal| Proposal::new(format!("take b = {b} rad"), single_change("task.b", b.value()));
        // Every period, the machine reaches the same: a b far away is proposed as `reach` counts it, too.
        let points = task.points();
        found.extend(PoseSpace::of(machine).ok().and_then(|space| in_first_period(&space, &points, b)).map(take));
        found.push(take(b));
        found.extend(turned_task(scenario, b.value()));
    }
    match refusal {
        Refusal::Edit { refusal, .. } => return candidates(scenario, refusal),
        Refusal::NoCommonPlane { why, .. } => {
            found.extend(ReachablePoints::mended(why).and_then(|mended| moved(task, &mended)));
        }
        Refusal::OutOfRange { what, value, want: Requirement::Within(range) } => {
            found.push(taking(what, value.clamp(range.low(), range.high())));
        }
        Refusal::Unreachable { point, .. } => found.extend(moved_point(scenario, point)),
        Refusal::Curve(CurveError::Coincident(..)) => found.extend(apart(scenario)),
        Refusal::Turns { turn_limit, .. } => {
            let text = format!("let the base turn by {turn_limit}°");
            found.push(Proposal::new(text, single_change("task.turn_limit", *turn_limit)));
        }
        Refusal::Loop { cycles, .. } => {
            let take = |cycles: &u32| {
                Proposal::new(format!("take {cycles} loops"), single_change("task.cycles", i64::from(*cycles)))
            };
            found.extend(cycles.iter().map(take));
        }
        Refusal::Diverged { .. } | Refusal::Untrusted { .. } => {
            found.extend(FINER_STEPS.map(|factor| taking("step", round_up(scenario.step / factor))));
            found.push(Proposal::new("take the usual gains", single_change("control", DEFAULT_WORD)));
        }
        Refusal::TooManySteps { time, .. } => {
            let step = round_up(time / MAX_STEPS as f64);
            found.push(Proposal::new(format!("take a step of {step} s"), single_change("step", step)));
        }
        _ => {}
    }
    if task.kind == TaskKind::TurnBase && !scenario.base.floats() {
        let free = single_change("base.kind", BaseKind::Free.words().file);
        let bare = single_change("base.wheel", DEFAULT_WORD);
        found.push(match (scenario.base.kind == BaseKind::Free, scenario.base.wheel.is_some()) {
            (true, _) => Proposal::new("take the wheel off", bare),
            (false, false) => Proposal::new("let the base float", free),
            (false, true) => Proposal::new("let the base float, and take the wheel off", join(free, &bare)),
        });
    }
    if task.kind == TaskKind::TurnBase || !would_plan(refusal) {
        return found;
    }
    let is_of_path = matches!(
        refusal,
        Refusal::Blocked(_) | Refusal::Path(_) | Refusal::Curve(_) | Refusal::NoWay(_) | Refusal::Unreachable { .. }
    );
    if is_of_path && task.uses("shape") && task.shape() != PathShape::JointLine {
        let change = single_change("task.shape", PathShape::JointLine.words().file);
        found.push(Proposal::new("take joint lines from point to point", change));
    }
    if matches!(refusal, Refusal::Time(_) | Refusal::TooLong { .. }) && task.law != TimeLaw::Quintic {
        found
            .push(Proposal::new("take the quintic time law", single_change("task.law", TimeLaw::Quintic.words().file)));
    }
    if !Inertia::of(machine).is_balanced() {
        found.extend(balancing_change(scenario).map(|change| Proposal::new("balance the machine", change)));
    }
    if task.kind != TaskKind::LeastReaction {
        found.push(kind(TaskKind::LeastReaction, "take the path of least reaction"));
    }
    if task.kind != TaskKind::MinimumNorm {
        found.push(kind(TaskKind::MinimumNorm, "follow the path, whatever the base feels"));
    }
    found
}

/// Returns changes that move B away from A, in several directions; they have one text, so the first that works is proposed.
fn apart(scenario: &Scenario) -> impl Iterator<Item = Proposal> {
    let from = scenario.task.points()[0];
    let far = round_up(APART_SHARE * scenario.machine.reach());
    (0..DIRECTIONS).map(move |i| {
        let to = from + far * unit(TAU * f64::from(i) / f64::from(DIRECTIONS));
        let [x, y] = [to.re, to.im].map(|x| (x * 1e3).round() / 1e3);
        Proposal::new(format!("take B {far} m from A"), single_change("task.to", vec![x, y]))
    })
}

/// Returns whether a change must be simulated to see if it leads out of a refusal: the task itself could be planned.
pub(super) fn shows_only_in_motion(refusal: &Refusal) -> bool {
    matches!(refusal, Refusal::Edit { .. } | Refusal::Diverged { .. } | Refusal::Untrusted { .. })
}

/// Returns whether another plan may lead out of a refusal. It cannot if the task could be planned already.
pub(super) fn would_plan(refusal: &Refusal) -> bool {
    match refusal {
        Refusal::Edit { refusal, .. } => would_plan(refusal),
        Refusal::TooManySteps { .. }
        | Refusal::TooLarge { .. }
        | Refusal::Full { .. }
        | Refusal::Stopped
        | Refusal::Diverged { .. }
        | Refusal::Untrusted { .. }
        | Refusal::LeavesLimits { .. } => false,
        _ => true,
    }
}

/// Proposes to move a point that cannot be reached to the nearest place that can: with b held, and at a b that all
/// other points share.
fn moved_point(scenario: &Scenario, name: &str) -> Vec<Proposal> {
    let task = &scenario.task;
    let points = task.points();
    let Some(i) = (0..points.len()).find(|i| task.name_of(*i) == name) else { return Vec::new() };
    let Ok(space) = PoseSpace::of(&scenario.machine) else { return Vec::new() };
    let held = ReachablePoints::at_b(&space, &points, i, task.b);
    let shared = ReachablePoints::shared_by(&space, &points, i);
    // Another b alone is proposed elsewhere.
    let ways = [held, shared].into_iter().flatten().filter(|way| way.applied(&points) != points);
    let proposal = |way: ReachablePoints| {
        let found = moved(task, &way)?;
        let at = way.b.map_or_else(String::new, |b| format!(", at b = {b} rad"));
        Some(Proposal { text: found.text + &at, ..found })
    };
    ways.filter_map(proposal).collect()
}

/// Proposes points of a task that can be reached, with the b that they need.
fn moved(task: &Task, way: &ReachablePoints) -> Option<Proposal> {
    let [(point, [x, y])] = way.moved[..] else { return None };
    let mut change = task.moving(point, Vector::new(x.value(), y.value()))?;
    change.extend(way.b.map(|b| ("b".to_owned(), b.value().into())));
    Some(Proposal::of_task(way.moves_in_words(&|i| task.name_of(i)), change))
}

/// Proposes a task made for the machine.
pub(super) fn made_task(scenario: &Scenario) -> Option<Proposal> {
    let own = made_for(scenario).ok()?;
    Some(Proposal::of_task("take a task made for this machine", own.task.whole()))
}

/// Proposes to keep b and turn all points of the task about the base pin. The workspace turns by the same angle when
/// b changes from `feasible_b`, rad, to the b of the task.
fn turned_task(scenario: &Scenario, feasible_b: f64) -> Vec<Proposal> {
    let task = &scenario.task;
    let Ok(space) = PoseSpace::of(&scenario.machine) else { return Vec::new() };
    if task.samples.is_some() {
        return Vec::new();
    }
    let turn = unit(space.turn(task.b - feasible_b));
    // Rounding may move a point out of the workspace; the first of the roundings that is feasible is proposed.
    let rounded = TURNED_DECIMALS.into_iter().filter_map(|decimals| {
        let round = |x: f64| Decimal::nearest(x, decimals).value();
        let points: Vec<Vector> =
            task.points().into_iter().map(|p| turn * p).map(|p| Vector::new(round(p.re), round(p.im))).collect();
        let text = format!("keep b = {} rad, and turn the task with it", significant(task.b));
        Some(Proposal::of_task(text, Task::visiting(&points)?))
    });
    rounded.collect()
}
