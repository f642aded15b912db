//! Motions at zero angular momentum. Two drives have one such curve through each pose; three drives and more can follow
//! any curve of the end effector. A free base that may turn lets two drives follow any curve, too.

use std::cell::Cell;
use std::f64::consts::TAU;
use std::sync::Arc;

use super::along::{curves, in_rounds};
use super::plan::{Plan, PlannerSpace, arm_on_base};
use super::poses::{no_b_refusal, reached, start, stated};
use crate::proposal::round_up;
use crate::refusal::Refusal;
use crate::scenario::{PathShape, Scenario, Task};
use stillbase_mechanics::machine::Inertia;
use stillbase_mechanics::planar::{DriveAngles, Vector};
use stillbase_planning::curves::{Curve, Path, PathTable};
use stillbase_planning::off_plane::b_integral::BIntegral;
use stillbase_planning::off_plane::base_forecast::BaseForecast;
use stillbase_planning::off_plane::drift::{DriftError, Singularity, zero_momentum_curve};
use stillbase_planning::off_plane::least_momentum::least_momentum_curve;
use stillbase_planning::off_plane::momentum::{MomentumModel, TipFrame};
use stillbase_planning::off_plane::null_space::MomentumFreedom;
use stillbase_planning::off_plane::rays::Rays;
use stillbase_planning::pose_space::PoseSpace;
use stillbase_settings::number::fixed;
use stillbase_simulation::plant::BaseKind;

/// Tolerance for a point to lie on the curve of two drives, as a fraction of the reach. Coordinates printed with nine
/// decimals are within it.
const CURVE_TOLERANCE: f64 = 1e-6;
/// Number of intervals of the curve in the search for its point nearest to a given point.
const CURVE_INTERVALS: usize = 720;

/// Plans a motion at zero angular momentum.
pub(super) fn zero_momentum(scenario: &Scenario, space: PlannerSpace<'_>) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    let arm = Inertia::of(&scenario.machine);
    match MomentumFreedom::of(&MomentumModel::from(&arm)) {
        MomentumFreedom::None => Err(Refusal::Task(
            "one drive has momentum as soon as it turns: want minimum-norm, and a machine of more drives".into(),
        )),
        MomentumFreedom::OneCurve => two_drives(scenario, &arm),
        MomentumFreedom::AnyCurve => followed(scenario, start(scenario, space, &task.points()[..1])?),
    }
}

/// Plans a motion of two drives. Without momentum of the arm they stay on one curve; a free base that may turn lets them
/// follow any other, in one way.
fn two_drives(scenario: &Scenario, arm: &Inertia) -> Result<Plan, Refusal> {
    let (task, base) = (&scenario.task, &scenario.base);
    let silent = || {
        let integral = BIntegral::of(arm).ok_or_else(|| {
            Refusal::NoWay(
                "turning as a whole, this machine has no angular momentum in some poses: want slower or lighter \
                 counter-rotating rotors"
                    .into(),
            )
        })?;
        along_curve(scenario, &integral)
    };
    let is_silent = base.kind != BaseKind::Free || arm.is_force_balanced();
    match task.shape {
        None | Some(PathShape::JointLine) if is_silent => match silent() {
            Err(why) if task.shape.is_none() && base.floats() => turned(scenario).map_err(|_| why),
            plan => plan,
        },
        None | Some(_) if base.floats() && task.shape != Some(PathShape::JointLine) => turned(scenario),
        Some(PathShape::JointLine) | None => Err(Refusal::Task(
            "two drives that shift a free base have no curve without momentum: want the shape line without a wheel, \
             which turns the base, a fixed base, a balanced machine, or three drives"
                .into(),
        )),
        Some(_) => Err(Refusal::Task(
            "at zero momentum two drives keep the end effector on a curve: want the shape joint-line, or minimum-norm, \
             the only motion along another; a free base without a wheel would turn"
                .into(),
        )),
    }
}

/// Follows the curves of the end effector of two drives on a free base, which turns: from the start of the task, or from
/// the pose of A that turns it least.
fn turned(scenario: &Scenario) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    let curves = curves(task, &task.points())?;
    let starts = match stated(task, scenario.machine.drives(), 0) {
        Some(start) => vec![start],
        None => elbows(task, &PoseSpace::nominal(&scenario.machine)?, 0, task.points()[0])?,
    };
    let plans = starts.into_iter().map(|start| turning(scenario, start, &curves));
    let least = plans.reduce(|one, other| match (&one, &other) {
        (Ok((_, kept)), Ok((_, next))) if next < kept => other,
        (Err(_), Ok(_)) => other,
        _ => one,
    });
    let (plan, peak) = least.unwrap_or_else(|| Err(Refusal::NoWay("A has no pose".into())))?;
    let is_bound = task.turn_limit > 0.0;
    if is_bound && peak > task.turn_limit {
        return Err(Refusal::Turns { stopped: None, turn_limit: round_up(peak) });
    }
    Ok(plan)
}

/// Follows curves with least momentum from a pose. Returns the plan, and how far the base turns, degrees.
fn turning(scenario: &Scenario, start: DriveAngles, curves: &[Curve]) -> Result<(Plan, f64), Refusal> {
    let model = momentum_model(scenario, &start, scenario.task.frame());
    let turn = Cell::new(0.0);
    let plan = along(scenario, start, curves, &|q, curve, cycle| {
        let (table, turned) = least_momentum_curve(&model, q, turn.get(), curve, cycle)?;
        turn.set(turned);
        Ok(table)
    })?;
    let beside_base = beside_base(scenario, &start);
    let course = BaseForecast::of(&arm_on_base(scenario), &plan.motion);
    let peak = course.as_ref().map_or(0.0, |course| course.angle).to_degrees();
    Ok((Plan { beside_base, base_turn: course.map(Arc::new), ..plan }, peak))
}

/// Returns the angular momentum of the machine of a scenario as its base keeps its orientation, for motions from a pose,
/// with its end effector in a frame. A base that is not free stands still.
pub(crate) fn momentum_model(scenario: &Scenario, start: &DriveAngles, frame: TipFrame) -> MomentumModel {
    let arm = Inertia::of(&scenario.machine);
    match scenario.base.kind {
        BaseKind::Free => MomentumModel::floating(&arm, &scenario.base.body(), frame, start),
        BaseKind::Fixed | BaseKind::Compliant => MomentumModel::from(&arm),
    }
}

/// Returns the arm beside its free base, with its end effector in space, for motions from a pose.
fn beside_base(scenario: &Scenario, start: &DriveAngles) -> Option<Arc<MomentumModel>> {
    let is_free = scenario.base.kind == BaseKind::Free;
    is_free.then(|| Arc::new(momentum_model(scenario, start, TipFrame::Space)))
}

/// Follows a sampled curve of the end effector at zero angular momentum from a pose. Returns the path, and the arm beside
/// a free base.
pub(super) fn sampled_at_zero_momentum(
    scenario: &Scenario,
    start: DriveAngles,
    curve: &Curve,
) -> Result<(PathTable, Option<Arc<MomentumModel>>), Refusal> {
    let model = momentum_model(scenario, &start, scenario.task.frame());
    Ok((zero_momentum_curve(&model, start, curve, 1)?, beside_base(scenario, &start)))
}

/// Follows the curves of the end effector at zero angular momentum from a pose of A.
fn followed(scenario: &Scenario, start: DriveAngles) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    let model = momentum_model(scenario, &start, task.frame());
    let curves = curves(task, &task.points())?;
    let silent = along(scenario, start, &curves, &|q, curve, cycle| zero_momentum_curve(&model, q, curve, cycle));
    let crosses = scenario.base.floats() && model.drives() == 3;
    match silent {
        Err(Refusal::Drift(stopped @ DriftError::Singular { why: Singularity::Dynamic, .. })) if crosses => {
            let plan = turning(scenario, start, &curves);
            // Without a limit, the obstacle is where zero momentum ends.
            let (plan, peak) = plan.map_err(|beyond| if task.turn_limit > 0.0 { beyond } else { stopped.into() })?;
            if peak > task.turn_limit {
                return Err(Refusal::Turns { stopped: Some(stopped), turn_limit: round_up(peak) });
            }
            Ok(plan)
        }
        plan => Ok(Plan { beside_base: beside_base(scenario, &start), ..plan? }),
    }
}

/// Follows curves from a pose, cycle by cycle; `follow` finds the path along each, given its start pose and the number
/// of the cycle.
fn along(
    scenario: &Scenario,
    start: DriveAngles,
    curves: &[Curve],
    follow: &dyn Fn(DriveAngles, &Curve, usize) -> Result<PathTable, DriftError>,
) -> Result<Plan, Refusal> {
    in_rounds(scenario, start, &|mut q, cycle| {
        let mut parts = Vec::new();
        for curve in curves {
            let table = follow(q, curve, cycle)?;
            q = table.nodes().last().map_or(q, |last| last.q);
            parts.push((Path::Table(table), curve.length()));
        }
        Ok((parts, q))
    })
}

/// Returns the rays of the end effector of a scenario from a pose, as points after A are meant.
///
/// # Errors
/// If its machine has none.
pub(crate) fn rays_from(scenario: &Scenario, start: DriveAngles) -> Result<Rays, Refusal> {
    let model = momentum_model(scenario, &start, scenario.task.frame());
    Rays::new(model, scenario.machine.angles(), start).map_err(|why| Refusal::Task(why.to_string()))
}

/// Moves two drives from point to point along a curve q₁ + ∫ D₂/(D₁ + D₂) dδ = const, δ = q₂ − q₁.
fn along_curve(scenario: &Scenario, integral: &BIntegral) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    let space = PoseSpace::nominal(&scenario.machine)?;
    let mut points = task.points();
    points.extend(task.closed.then(|| points[0]));
    let starts = match stated(task, space.drives(), 0) {
        Some(start) => vec![start],
        None => elbows(task, &space, 0, points[0])?,
    };
    // Take the first pose of A from which all points are reached. If there is none, return the refusal of the pose that
    // gets farthest.
    let mut refused: Option<(usize, Refusal)> = None;
    for start in &starts {
        match deltas_along(task, &space, integral, *start, &points) {
            Ok(turns) => {
                return in_rounds(scenario, *start, &|mut q, _| {
                    let mut parts = Vec::new();
                    for to in &turns {
                        let far = (to - (q[1] - q[0])).abs();
                        let table = integral.motion(&q, *to);
                        let table = table.ok_or_else(|| Refusal::NoWay("A and B are too far apart".into()))?;
                        q = table.nodes().last().map_or(q, |last| last.q);
                        // A point equal to the previous one adds no part to the path.
                        if far > 1e-12 || turns.len() == 1 {
                            parts.push((Path::Table(table), far.max(1e-12)));
                        }
                    }
                    Ok((parts, q))
                });
            }
            Err((i, why)) if refused.as_ref().is_none_or(|(at, _)| i > *at) => refused = Some((i, why)),
            Err(_) => {}
        }
    }
    Err(refused.map_or_else(|| Refusal::NoWay("A has no pose".into()), |(_, why)| why))
}

/// Returns every pose of a point; poses that differ by whole turns of all drives count once.
fn elbows(task: &Task, space: &PoseSpace, i: usize, p: Vector) -> Result<Vec<DriveAngles>, Refusal> {
    let set = space.reach(p).map_err(|reason| no_b_refusal(task, i, p, reason))?.shifted_near(task.b);
    let poses: Vec<DriveAngles> = set.intervals.iter().flat_map(|[b, _]| space.poses(p, *b, &space.middle())).collect();
    if poses.is_empty() { reached(task, space, i, p).map(|q| vec![q]) } else { Ok(poses) }
}

/// Returns δ, rad, of each point after A on the curve through a pose of A. Fails with the index of the first point that
/// is not on the curve.
fn deltas_along(
    task: &Task,
    space: &PoseSpace,
    integral: &BIntegral,
    start: DriveAngles,
    points: &[Vector],
) -> Result<Vec<f64>, (usize, Refusal)> {
    let b = integral.b([start[0], start[1]]);
    let mut turns = Vec::new();
    let mut now = start[1] - start[0];
    for (i, p) in points.iter().enumerate().skip(1) {
        let miss = |delta: f64| (space.end_effector(&integral.pose(b, delta)) - p).norm();
        let poses = elbows(task, space, i, *p).map_err(|why| (i, why))?;
        let deltas =
            poses.iter().map(|q| q[1] - q[0]).filter(|delta| miss(*delta) <= CURVE_TOLERANCE * space.farthest());
        let Some(delta) = deltas.min_by(|x, y| (x - now).abs().total_cmp(&(y - now).abs())) else {
            return Err((i, off_curve(task, space, integral, b, now, i, *p)));
        };
        turns.push(delta);
        now = delta;
    }
    Ok(turns)
}

/// Refuses a point off the curve, with its distance from the curve and the nearest point of the curve, m.
fn off_curve(task: &Task, space: &PoseSpace, integral: &BIntegral, b: f64, now: f64, i: usize, p: Vector) -> Refusal {
    let joint = space.joints()[0];
    let [low, high] = joint.bounds();
    let place = |delta: f64| space.end_effector(&integral.pose(b, delta));
    let allowed = |delta: &f64| {
        let a = joint.of(&[0.0, *delta]);
        a >= low - 1e-9 && a <= high + 1e-9
    };
    let (from, to) = match low.is_finite() {
        true => {
            // δ of the limits: the angle is ±δ + offset.
            let at = |a: f64| (a - joint.of(&[0.0, 0.0])) / (joint.of(&[0.0, 1.0]) - joint.of(&[0.0, 0.0]));
            (at(low).min(at(high)), at(low).max(at(high)))
        }
        false => (now - 0.5 * TAU, now + 0.5 * TAU),
    };
    let samples = (0..=CURVE_INTERVALS).map(|k| from + (to - from) * k as f64 / CURVE_INTERVALS as f64).filter(allowed);
    let far = |delta: &f64| (place(*delta) - p).norm();
    let nearest = samples.min_by(|x, y| far(x).total_cmp(&far(y))).unwrap_or(now);
    let at = place(nearest);
    Refusal::NoWay(format!(
        "at zero momentum two drives move their end effector along one curve, and {} lies {} m beside it: want it at \
         ({}, {}) m, or minimum-norm",
        task.name_of(i.min(task.via.len() + 1)),
        fixed(far(&nearest), 3),
        exactly(at.re),
        exactly(at.im)
    ))
}

/// Prints a coordinate, m, with enough digits to lie on the curve.
fn exactly(x: f64) -> String {
    fixed(x, 9)
}
