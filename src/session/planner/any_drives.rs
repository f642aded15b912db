//! Tasks of machines that have no plane of three drives: with one, two, four and more.

use super::along::{Parts, along_parts, curves, proved, refusal, timed};
use super::off_plane::smooth;
use super::plan::{Effort, Plan, dynamics_of, keeps_rules};
use super::pose::{faced, posed, reached, start};
use super::{given, off_space, posture};
use crate::mechanics::planar::{DriveAngles, Vector};
use crate::planning::Forecast;
use crate::planning::common::unreached;
use crate::planning::curves::Path;
use crate::planning::curves::path::{least_rate_curve, minimum_norm_curve};
use crate::planning::off_plane::b_course::Reaction;
use crate::planning::off_plane::least_reaction::{FixedB, MinimumNorm, Verdicts};
use crate::planning::pose_constant::{Planes, Unreachable};
use crate::planning::pose_space::{NoPoseSpace, PoseSpace};
use crate::planning::reactionless::BSet;
use crate::planning::timing::{Limits, TimeLaw};
use crate::session::refusal::Refusal;
use crate::session::scenario::{Corners, Scenario, Shape, Task, TaskKind};
use crate::settings::number::nine_digits;

/// Plans the task of such a machine.
///
/// # Errors
/// Which point, part of the path or setting is in the way, and what would do.
pub(super) fn plan(scenario: &Scenario) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    if task.samples.is_some() {
        return given::given(scenario, None);
    }
    match task.kind {
        TaskKind::Reactionless => held(scenario),
        TaskKind::MinimumNorm => along_parts(scenario, &|scenario| minimum_norm(scenario)),
        TaskKind::SameTip => along_parts(scenario, &|scenario| off_space::same_tip(scenario)),
        TaskKind::ChangeB => off_space::change_b(scenario),
        TaskKind::ZeroMomentum => off_space::zero_momentum(scenario),
        TaskKind::LeastReaction => least_reaction(scenario),
        TaskKind::Given => given::given(scenario, None),
    }
}

/// With b held; a refusal proposes only what has been tried.
fn held(scenario: &Scenario) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    along_parts(scenario, &|scenario| reactionless(scenario, Effort::Whole)).map_err(|refusal| {
        let Ok(space) = PoseSpace::of(&scenario.machine) else { return refusal };
        // Where a path goes does not depend on the time law.
        let own = |task: &Task| Scenario { task: Task { law: TimeLaw::Quintic, ..task.clone() }, ..scenario.clone() };
        let goes =
            |task: &Task, effort| along_parts(&own(task), &|scenario| reactionless(scenario, effort)).map(|_| ());
        proved(task, &space, &goes, refusal)
    })
}

/// Along the end effector's curves with b held, where it can be: then nothing reaches the base. Between which b a path
/// could choose is known for three drives only.
fn least_reaction(scenario: &Scenario) -> Result<Plan, Refusal> {
    let (task, drives) = (&scenario.task, scenario.machine.drives());
    if drives < 3 {
        let why = "along a path of the end effector one or two drives have no b to choose: want minimum-norm, which is the \
                   only motion along it, or reactionless in the shape joint-line";
        return Err(Refusal::Task(why.into()));
    }
    smooth(task)?;
    let space = PoseSpace::of(&scenario.machine)?;
    if let Some(b_to) = task.b_to.filter(|b_to| *b_to != task.b) {
        return Err(Refusal::Task(format!(
            "with {drives} drives the least reaction holds b, here to end at {b_to} rad: want change-b, or b_to = default"
        )));
    }
    let holding = |b: f64, effort| {
        let own = Task { kind: TaskKind::Reactionless, shape: Some(task.shape()), b, b_to: None, ..task.clone() };
        along_parts(&Scenario { task: own, ..scenario.clone() }, &|scenario| reactionless(scenario, effort))
    };
    let why = match holding(task.b, Effort::Whole) {
        Ok(plan) => return Ok(Plan { verdicts: Some(nothing(scenario)?), ..plan }),
        Err(why @ Refusal::Unreachable { unreachable: Unreachable::Anywhere { .. }, .. }) => return Err(why),
        Err(Refusal::Unreachable { point, unreachable }) if point == task.name_of(0) => {
            return Err(Refusal::Unreachable { point, unreachable });
        }
        Err(why) => why,
    };
    let sets: Option<Vec<BSet>> = task.points().iter().map(|p| space.reach(*p).ok()).collect();
    let common = BSet::overlap(&sets.unwrap_or_default());
    let tries =
        common.nearest(task.b).into_iter().flat_map(|b| [0.1, 0.4, 0.7, 1.0, 1.3, 1.6].map(|to| common.inwards(b, to)));
    let does = tries.filter_map(|b| common.decimal(b, 4)).find(|b| holding(b.value(), Effort::Trial).is_ok());
    let would_do = match does {
        Some(b) => format!("at b = {b} rad it can: want that"),
        None => "want minimum-norm, or change-b from point to point".into(),
    };
    let only = match Planes::of(&scenario.machine) {
        Err(lacking) if drives == 3 => format!("it can change on the way only on planes: {lacking}"),
        _ => "with other than three drives it does not change on the way".into(),
    };
    let why = why.to_string();
    Err(Refusal::NoWay(format!(
        "b = {} rad cannot be held along this path ({}), and {only}; {would_do}",
        nine_digits(task.b),
        why.split(": want").next().unwrap_or(&why)
    )))
}

/// The verdicts on a motion that holds b.
fn nothing(scenario: &Scenario) -> Result<Verdicts, Refusal> {
    let usual = minimum_norm(scenario).and_then(|parts| Ok(timed(scenario, parts)?.0));
    let minimum_norm = match usual {
        Ok(motion) => {
            let (model, around) = dynamics_of(scenario);
            let forecast = Forecast::of(&motion, &model, &around, &Limits::of(&scenario.machine));
            let reaction = Reaction { peak: forecast.moment, rms: forecast.moment_rms };
            Ok(MinimumNorm { reaction, end_b: forecast.b_end, keeps_limits: keeps_rules(scenario, &motion).is_ok() })
        }
        Err(Refusal::Path(why)) => Err(why),
        Err(why) => return Err(why),
    };
    Ok(Verdicts { fixed: FixedB::Serves, minimum_norm, least: Reaction { peak: 0.0, rms: 0.0 } })
}

/// A path that holds b.
fn reactionless(scenario: &Scenario, effort: Effort) -> Result<Parts, Refusal> {
    let task = &scenario.task;
    let (space, free) = match PoseSpace::of(&scenario.machine) {
        Err(NoPoseSpace::Free) => (PoseSpace::nominal(&scenario.machine)?, true),
        space => (space?, false),
    };
    let points = task.points();
    if !free && let Some((i, why)) = unreached(&space, &points, task.b) {
        return Err(refusal(task, i, why));
    }
    match task.shape() {
        Shape::JointLine => joint_lines(scenario, &space, &points, free),
        _ if free => by_least_rates(scenario, reached(task, &space, 0, points[0])?, None),
        _ if space.drives() < 3 => Err(Refusal::Task(format!(
            "while b is held the end effector of a machine with {} drives has its own way: want the shape joint-line",
            space.drives()
        ))),
        _ => {
            let curves = curves(task, &points)?;
            // Three drives have one motion of each b.
            if space.drives() == 3 {
                let start = posed(task, &space, (&points, 0), &space.middle())?;
                return by_least_rates(scenario, start, Some(&space));
            }
            let tables = posture::tables(scenario, &space, &curves, Some(task.law), effort)?;
            Ok(tables.into_iter().zip(&curves).map(|(table, curve)| (Path::Table(table), curve.length())).collect())
        }
    }
}

/// Straight lines of joint space from pose to pose.
fn joint_lines(scenario: &Scenario, space: &PoseSpace, points: &[Vector], free: bool) -> Result<Parts, Refusal> {
    let (task, machine) = (&scenario.task, &scenario.machine);
    let hand = machine.resolved_links()[machine.end_link()].drive;
    if task.corners == Corners::Blend && (points.len() > 2 || task.closed) {
        let why = match Planes::of(machine) {
            Err(lacking) if machine.drives() == 3 => {
                format!("corners of joint lines are rounded off on planes only: {lacking}, or corners = stop")
            }
            _ => "corners of joint lines are rounded off for three drives only: want corners = stop".into(),
        };
        return Err(Refusal::Task(why));
    }
    let mut near = space.middle();
    let mut q: Vec<DriveAngles> = Vec::with_capacity(points.len() + 1);
    for (i, p) in points.iter().enumerate() {
        let kept = q.first().map(|q| q[hand]);
        let pose =
            if free { reached(task, space, i, *p)? } else { faced(scenario, space, (points, i), (&near, kept))? };
        near = space.angles(&pose);
        q.push(pose);
    }
    q.extend(task.closed.then(|| q[0]));
    let way = |i: usize| q[i + 1].0.minus(&q[i].0).max_abs();
    let line = |i: usize| (Path::JointLine { from: q[i], to: q[i + 1] }, way(i).max(1e-12));
    let moving = (0..q.len() - 1).filter(|i| q.len() == 2 || way(*i) > 1e-12);
    Ok(moving.map(line).collect())
}

/// Least rates along the end effector's curves, from a pose of A.
fn minimum_norm(scenario: &Scenario) -> Result<Parts, Refusal> {
    by_least_rates(scenario, start(scenario)?, None)
}

/// Least rates along the curves of a task from a start, with b held on a space of poses, if there is one.
fn by_least_rates(scenario: &Scenario, start: DriveAngles, held: Option<&PoseSpace>) -> Result<Parts, Refusal> {
    let (task, tip) = (&scenario.task, scenario.machine.end_effector());
    let mut q = start;
    let mut parts = Vec::new();
    for curve in curves(task, &task.points())? {
        let table = match held {
            Some(space) => least_rate_curve(tip, Some(space.lambda()), q, &curve)?,
            None => minimum_norm_curve(tip, q, &curve)?,
        };
        q = table.nodes().last().map_or(q, |last| last.q);
        parts.push((Path::Table(table), curve.length()));
    }
    Ok(parts)
}
