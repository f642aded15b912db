//! Motions given by samples. Samples of drive angles are used as they are, turned as a whole by the task's `turn`.
//! For samples of the end effector the redundancy
//! is resolved.

use super::held::{along_curves, sheet_of};
use super::momentum::sampled_at_zero_momentum;
use super::plan::{Plan, PlannerSpace, PlanningEffort, arm_on_base, keeps_rules};
use super::poses::start;
use crate::refusal::Refusal;
use crate::scenario::{Scenario, TaskKind, samples_of_others};
use stillbase_planning::Motion;
use stillbase_planning::curves::path::minimum_norm_curve;
use stillbase_planning::curves::{Curve, Path, PathTable};
use stillbase_planning::following::{Rule, trace};
use stillbase_planning::forecast::Forecast;
use stillbase_planning::pose_space::NoPoseSpace;
use stillbase_planning::timing::{DriveLimits, Profile};

/// Number of instants of the forecast for each sample.
const INSTANTS_PER_SAMPLE: usize = 8;
/// Minimum number of instants of the forecast.
const MIN_INSTANTS: usize = 2000;
/// Maximum number of instants of the forecast.
const MAX_INSTANTS: usize = 100_000;

/// Plans the motion given by the samples of the task, stretched to its time.
///
/// # Errors
/// If there are no samples, or they do not fit the machine or the kind of the task, or cannot be followed.
pub(super) fn given(scenario: &Scenario, space: PlannerSpace<'_>) -> Result<Plan, Refusal> {
    let (task, drives) = (&scenario.task, scenario.machine.drives());
    let refuse = |why: String| Err(Refusal::Task(why));
    let Some(samples) = &task.samples else {
        let rows = format!("samples, rows of t, q1 … q{drives} or of t, x, y");
        return refuse(format!("a given motion wants {rows}: want them, or another kind"));
    };
    if !task.via.is_empty() || task.closed {
        return refuse("samples say where to go: want no points between and an open path, or no samples".into());
    }
    if task.law.is_fastest() {
        return refuse("samples say when to be where: want the law quintic, which they ignore, or no samples".into());
    }
    let columns = samples.columns();
    let unsound = || Refusal::Task("the samples give no spline: want times further apart".into());
    let mut beside_base = None;
    let table = match (task.kind, columns) {
        (TaskKind::Given, n) if n == drives => samples.path(task.turn).ok_or_else(unsound)?,
        (TaskKind::Given | TaskKind::Reactionless, 2) => {
            let curve = samples.curve().ok_or_else(unsound)?;
            let rule = Rule { keep_off_change_points: task.keep_off_change_points };
            match space.ok().and_then(|space| Some((space, space.planes().ok()?))) {
                Some((space, planes)) => {
                    let mut tables = trace::follow(planes.map(), &[curve], task.b, sheet_of(task, space), rule)?;
                    tables.pop().ok_or_else(unsound)?
                }
                None => sampled(scenario, space, &curve)?,
            }
        }
        (TaskKind::MinimumNorm, 2) => {
            let curve = samples.curve().ok_or_else(unsound)?;
            let ends = [samples.point(0), samples.point(samples.count() - 1)];
            minimum_norm_curve(scenario.machine.end_effector(), start(scenario, space, &ends)?, &curve)?
        }
        (TaskKind::ZeroMomentum, 2) if task.cycles > 1 => {
            return refuse("samples are followed once: want cycles = 1, or no samples".into());
        }
        (TaskKind::ZeroMomentum, 2) => {
            let curve = samples.curve().ok_or_else(unsound)?;
            let begins = start(scenario, space, &[samples.point(0)])?;
            let (table, beside) = sampled_at_zero_momentum(scenario, begins, &curve)?;
            beside_base = beside;
            table
        }
        (TaskKind::Given, _) => {
            return refuse(samples_of_others(columns, drives));
        }
        (_, 2) => {
            return refuse(
                "samples of x and y want the kind given, reactionless, minimum-norm or zero-momentum".into(),
            );
        }
        _ => return refuse("samples of drive angles want the kind given".into()),
    };
    let motion = Motion { path: Path::Table(table), profile: Profile::running(task.time) };
    keeps_rules(scenario, &motion)?;
    let instants = (INSTANTS_PER_SAMPLE * samples.count()).clamp(MIN_INSTANTS, MAX_INSTANTS);
    let forecast = Forecast::at(&motion, &arm_on_base(scenario), &DriveLimits::of(&scenario.machine), instants);
    Ok(Plan { beside_base, ..Plan::foreseen(motion, forecast) })
}

/// Follows a sampled curve of the end effector with b held, or with least rates if no drive puts a moment on
/// the base.
///
/// # Errors
/// If the curve cannot be followed.
fn sampled(scenario: &Scenario, space: PlannerSpace<'_>, curve: &Curve) -> Result<PathTable, Refusal> {
    let points = scenario.task.points();
    let space = match space {
        Err(NoPoseSpace::Free) => {
            return Ok(minimum_norm_curve(
                scenario.machine.end_effector(),
                start(scenario, space, &points[..1])?,
                curve,
            )?);
        }
        space => space.map_err(Clone::clone)?,
    };
    let other = |why| Refusal::Task(format!("{why}: want minimum-norm, or samples of the drive angles"));
    space.follows_curves().map_err(other)?;
    match along_curves(scenario, space, std::slice::from_ref(curve), None, PlanningEffort::Whole)?.pop() {
        Some((Path::Table(table), _)) => Ok(table),
        _ => Err(Refusal::Task("the samples give no path".into())),
    }
}
