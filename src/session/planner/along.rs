//! Motions along curves and joint lines: the parts of a path, and their timing.

use super::plan::{Plan, TimingBottleneck, arm_on_base, keeps_rules};
use crate::refusal::Refusal;
use crate::scenario::{Corners, PathShape, Scenario, Task, TaskKind};
use stillbase_mechanics::arm_on_base::ArmOnBase;
use stillbase_mechanics::planar::{DriveAngles, Vector};
use stillbase_planning::Motion;
use stillbase_planning::curves::path::{PathChain, least_rate_curve, minimum_norm_curve};
use stillbase_planning::curves::{Curve, Path};
use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::timing::{DriveLimits, Profile, TimeLaw, Usage, fastest};

/// Paths from rest to rest, each with its length.
pub(super) type PathSegments = Vec<(Path, f64)>;

/// Plans a motion through the points of a task; `parts` finds the parts of its path.
pub(super) fn along_parts(
    scenario: &Scenario,
    parts: &dyn Fn(&Scenario) -> Result<PathSegments, Refusal>,
) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    let motion = |scenario: &Scenario| -> Result<(Motion, Option<TimingBottleneck>), Refusal> {
        let (motion, pace) = timed(scenario, parts(scenario)?)?;
        keeps_rules(scenario, &motion)?;
        Ok((motion, pace))
    };
    let (own, pace) = motion(scenario)?;
    let has_corners = !task.via.is_empty() || task.closed;
    if task.law.is_fastest() && task.corners == Corners::Blend && has_corners {
        // A tightly blended corner may take more time than a stop at the corner.
        let resting = Scenario { task: Task { corners: Corners::Stop, ..task.clone() }, ..scenario.clone() };
        if let Ok((rests, pace)) = motion(&resting)
            && rests.duration() < own.duration()
        {
            let blended = Some(own.duration());
            return Ok(Plan { pace, blended, ..Plan::of(scenario, rests) });
        }
    }
    Ok(Plan { pace, ..Plan::of(scenario, own) })
}

/// Times the parts of a path, each from rest to rest. The fastest laws find the minimum time of each part. Other laws
/// divide the time of the task in proportion to the lengths of the parts.
pub(super) fn timed(
    scenario: &Scenario,
    parts: Vec<(Path, f64)>,
) -> Result<(Motion, Option<TimingBottleneck>), Refusal> {
    let task = &scenario.task;
    let total: f64 = parts.iter().map(|(_, length)| length).sum();
    let arm = arm_on_base(scenario);
    let limits = DriveLimits::of(&scenario.machine);
    let mut timings = Vec::with_capacity(parts.len());
    let mut pace: Option<TimingBottleneck> = None;
    for (path, length) in &parts {
        let profile = if task.law.is_fastest() {
            let fastest = fastest(path, &arm, &limits, task.law == TimeLaw::FastestSmooth)?;
            let profile = fastest.profile;
            let time = profile.duration();
            // A part without motion has no optimality gap: its minimum time is 0.
            let least = fastest.gap.map(|gap| time / (1.0 + gap)).or((time == 0.0).then_some(0.0));
            let pace = pace.get_or_insert(TimingBottleneck { unlimited: Some(0.0), ..TimingBottleneck::default() });
            pace.unlimited = pace.unlimited.zip(least).map(|(sum, least)| sum + least);
            pace.time += time;
            if pace.leading.is_none() {
                pace.leading = fastest.active_limits.first().map(|(limit, _)| *limit);
            }
            profile
        } else {
            Profile::of(task.law, task.time * length / total)
        };
        timings.push((profile, length / total));
    }
    let mut parts = parts;
    let motion = match parts.len() {
        1 => Motion { path: parts.remove(0).0, profile: timings.remove(0).0 },
        _ => {
            let nowhere = || Refusal::Task("want at least two points that are apart".into());
            let path = Path::Chain(PathChain::new(parts).ok_or_else(nowhere)?);
            Motion { path, profile: Profile::sequence(timings) }
        }
    };
    Ok((motion, pace))
}

/// Stretches a motion in time until it keeps the limits of the drives. Fails if it exceeds them however slow it is.
pub(super) fn slow_to_limits(motion: Motion, arm: &ArmOnBase, limits: &DriveLimits) -> Result<Motion, Refusal> {
    const SAMPLES: usize = 2000;
    motion.slowed(arm, limits).ok_or_else(|| {
        let usage = Usage::of(&motion, arm, limits, SAMPLES);
        let limit = usage.limit.map_or("a limit".into(), |limit| format!("the {limit}"));
        Refusal::NoWay(format!("{limit} is passed however slow the motion is: want a higher one"))
    })
}

/// Returns the curves of the end effector through the points; the motion rests at the ends of each curve.
///
/// # Errors
/// If the points give no curve.
pub fn curves(task: &Task, points: &[Vector]) -> Result<Vec<Curve>, Refusal> {
    let blend = if task.corners == Corners::Blend { task.blend } else { 0.0 };
    Ok(match task.shape() {
        PathShape::JointLine | PathShape::Line => Curve::polyline(points, task.closed, blend)?,
        PathShape::Arc => match points {
            [a, b, c] => vec![Curve::arc([*a, *b, *c], task.closed)?],
            _ => {
                let have = points.len();
                return Err(Refusal::Task(format!(
                    "an arc goes through 3 points, here are {have}: want one via point"
                )));
            }
        },
        PathShape::Spline => vec![Curve::spline(points, task.closed)?],
        PathShape::Freehand => vec![Curve::freehand(points, task.closed)?],
    })
}

/// Follows curves from a start pose with least joint rates. With a pose space `held`, b stays constant.
pub(super) fn by_least_rates(
    scenario: &Scenario,
    start: DriveAngles,
    curves: &[Curve],
    held: Option<&PoseSpace>,
) -> Result<PathSegments, Refusal> {
    let tip = scenario.machine.end_effector();
    let mut q = start;
    let mut parts = Vec::with_capacity(curves.len());
    for curve in curves {
        let table = match held {
            Some(space) => least_rate_curve(tip, Some(space.lambda()), q, curve)?,
            None => minimum_norm_curve(tip, q, curve)?,
        };
        q = table.nodes().last().map_or(q, |last| last.q);
        parts.push((Path::Table(table), curve.length()));
    }
    Ok(parts)
}

/// Plans all cycles of a closed path, or an open path once. `round` returns the parts and the end pose of one cycle,
/// given its start pose and its number, counted from 1.
pub(super) fn in_rounds(
    scenario: &Scenario,
    start: DriveAngles,
    round: &dyn Fn(DriveAngles, usize) -> Result<(PathSegments, DriveAngles), Refusal>,
) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    if task.cycles > 1 && !(task.closed || task.kind == TaskKind::TurnBase) {
        return Err(Refusal::Task("an open path is run through once: want closed = true, or cycles = 1".into()));
    }
    let mut q = start;
    let mut cycles = vec![q];
    let mut legs = Vec::with_capacity(task.cycles as usize);
    for cycle in 1..=task.cycles as usize {
        let (parts, end) = round(q, cycle)?;
        // Each cycle takes the whole time of the task.
        legs.push(timed(scenario, parts)?.0);
        q = end;
        cycles.push(q);
    }
    let motion = match legs.len() {
        1 => legs.remove(0),
        _ => {
            let profile = Profile::sequence(legs.iter().map(|m| (m.profile.clone(), 1.0)).collect());
            let path = PathChain::new(legs.into_iter().map(|m| (m.path, 1.0)).collect());
            Motion { path: Path::Chain(path.ok_or_else(|| Refusal::Task("want a path".into()))?), profile }
        }
    };
    keeps_rules(scenario, &motion)?;
    Ok(Plan { cycles, ..Plan::of(scenario, motion) })
}
