//! Paths with the b of their task held, so that no reaction reaches the base.

use super::along::{PathSegments, along_parts, by_least_rates, curves};
use super::plan::{Plan, PlannerSpace, PlanningEffort};
use super::poses::{posed, poses_at_b, poses_facing, reached, refusal, stated};
use super::posture;
use super::proposals::proved_refusal;
use crate::refusal::Refusal;
use crate::scenario::{Corners, PathShape, Scenario, Task};
use stillbase_mechanics::planar::{DriveAngles, Vector};
use stillbase_planning::common::unreached;
use stillbase_planning::curves::{Curve, Path};
use stillbase_planning::following::{Rule, trace};
use stillbase_planning::pose_space::{NoPoseSpace, Planes, PoseSpace};
use stillbase_planning::posed::PoseAngles;
use stillbase_planning::timing::TimeLaw;

/// Plans a motion with b held. A refusal proposes only alternatives that have been tried.
pub(super) fn held(scenario: &Scenario, space: PlannerSpace<'_>) -> Result<Plan, Refusal> {
    let task = &scenario.task;
    along_parts(scenario, &|scenario| reactionless(scenario, space, PlanningEffort::Whole)).map_err(|refusal| {
        let Ok(known) = space else { return refusal };
        // A path on a plane does not depend on the time law; for other paths, the quintic law serves for the trial.
        let own = |task: &Task| Scenario { task: Task { law: TimeLaw::Quintic, ..task.clone() }, ..scenario.clone() };
        let try_path = |task: &Task, effort| match known.planes() {
            // A path found on a plane already keeps the joint limits.
            Ok(_) => reactionless(&own(task), space, effort).map(|_| ()),
            Err(_) => along_parts(&own(task), &|scenario| reactionless(scenario, space, effort)).map(|_| ()),
        };
        proved_refusal(task, known, &try_path, refusal)
    })
}

/// Finds the parts of a path with b held.
pub(super) fn reactionless(
    scenario: &Scenario,
    space: PlannerSpace<'_>,
    effort: PlanningEffort,
) -> Result<PathSegments, Refusal> {
    let (task, points) = (&scenario.task, scenario.task.points());
    let space = match space {
        Err(NoPoseSpace::Free) => return free(scenario, &PoseSpace::nominal(&scenario.machine)?, &points),
        space => space.map_err(Clone::clone)?,
    };
    if let Ok(planes) = space.planes() {
        return match task.shape() {
            PathShape::JointLine => joint_lines(scenario, space, poses_at_b(task, space, &points)?),
            _ => on_plane(task, space, planes, &points),
        };
    }
    if let Some((i, why)) = unreached(space, &points, task.b) {
        return Err(refusal(task, i, why));
    }
    match task.shape() {
        PathShape::JointLine => {
            cornered(task, space, points.len())?;
            joint_lines(scenario, space, one_by_one(scenario, space, &points)?)
        }
        _ => {
            space.follows_curves().map_err(|why| Refusal::Task(format!("{why}: want the shape joint-line")))?;
            along_curves(scenario, space, &curves(task, &points)?, Some(task.law), effort)
        }
    }
}

/// Follows curves of the end effector with b held, for a machine without planes; `law` as in
/// [`PostureRequest`](stillbase_planning::posture::PostureRequest).
pub(super) fn along_curves(
    scenario: &Scenario,
    space: &PoseSpace,
    curves: &[Curve],
    law: Option<TimeLaw>,
    effort: PlanningEffort,
) -> Result<PathSegments, Refusal> {
    let lengths = curves.iter().map(Curve::length);
    if space.leaves_freedoms() {
        let tables = posture::tables(scenario, space, curves, law, effort)?;
        return Ok(tables.into_iter().map(Path::Table).zip(lengths).collect());
    }
    // Without remaining freedoms, there is one motion for each b.
    let start = posed(&scenario.task, space, &scenario.task.points()[..1], 0, &space.middle())?;
    by_least_rates(scenario, start, curves, Some(space))
}

/// Finds the path of a machine no motion of which exerts a moment on its base, so that there is no b to hold.
fn free(scenario: &Scenario, space: &PoseSpace, points: &[Vector]) -> Result<PathSegments, Refusal> {
    let task = &scenario.task;
    if task.shape() != PathShape::JointLine {
        let start = reached(task, space, 0, points[0])?;
        return by_least_rates(scenario, start, &curves(task, points)?, None);
    }
    cornered(task, space, points.len())?;
    let pose = |(i, p): (usize, &Vector)| Ok(PoseAngles::of(space, reached(task, space, i, *p)?));
    joint_lines(scenario, space, points.iter().enumerate().map(pose).collect::<Result<_, Refusal>>()?)
}

/// Refuses blended corners of joint lines on machines without planes.
fn cornered(task: &Task, space: &PoseSpace, points: usize) -> Result<(), Refusal> {
    let Err(lacking) = space.planes() else { return Ok(()) };
    if task.corners != Corners::Blend || (points <= 2 && !task.closed) {
        return Ok(());
    }
    Err(Refusal::Task(match lacking.could_have_planes() {
        true => format!("corners of joint lines are rounded off on planes only: {lacking}, or corners = stop"),
        false => "corners of joint lines are rounded off for three drives only: want corners = stop".into(),
    }))
}

/// Returns a pose of each point, near that of the point before, with the orientation of the last link that the task
/// sets.
fn one_by_one(scenario: &Scenario, space: &PoseSpace, points: &[Vector]) -> Result<Vec<PoseAngles>, Refusal> {
    let machine = &scenario.machine;
    let end_drive = machine.resolved_links()[machine.end_link()].drive;
    let mut near = space.middle();
    let mut poses: Vec<PoseAngles> = Vec::with_capacity(points.len() + 1);
    for i in 0..points.len() {
        let kept = poses.first().map(|pose| pose.q[end_drive]);
        poses.push(PoseAngles::of(space, poses_facing(scenario, space, points, i, &near, kept)?));
        near = poses[i].a;
    }
    Ok(poses)
}

/// Joins poses by straight lines in joint space, with stops or blends at the corners.
fn joint_lines(scenario: &Scenario, space: &PoseSpace, mut poses: Vec<PoseAngles>) -> Result<PathSegments, Refusal> {
    let task = &scenario.task;
    if let Ok(planes) = space.planes() {
        if task.keep_off_change_points {
            same_side(task, &poses)?;
        }
        if task.corners == Corners::Blend && (poses.len() > 2 || task.closed) {
            let corners: Vec<Vector> = poses.iter().map(|pose| Vector::new(pose.a[0], pose.a[1])).collect();
            // `Curve::polyline` closes the path, so that an error names only points of the task.
            let curves = Curve::polyline(&corners, task.closed, task.blend)?;
            let path = |curve: Curve| {
                let length = curve.length();
                (Path::OnPlane { map: *planes.map(), b: task.b, curve }, length)
            };
            return Ok(curves.into_iter().map(path).collect());
        }
    }
    poses.extend(task.closed.then(|| poses[0]));
    let way = |i: usize| poses[i].distance_to(space, &poses[i + 1]);
    let line = |i: usize| (Path::JointLine { from: poses[i].q, to: poses[i + 1].q }, way(i).max(1e-12));
    // A point equal to the previous one adds no part to the path.
    let moving = (0..poses.len() - 1).filter(|i| poses.len() == 2 || way(*i) > 1e-12);
    Ok(moving.map(line).collect())
}

/// Refuses poses between which two drives would become parallel.
fn same_side(task: &Task, poses: &[PoseAngles]) -> Result<(), Refusal> {
    for (i, w) in poses.windows(2).enumerate() {
        let [from, to] = [w[0].q, w[1].q];
        for [k, l] in [[0, 1], [0, 2], [1, 2]] {
            let side = |q: &DriveAngles| (q[k] - q[l]).sin();
            let turns = |q: &DriveAngles| ((q[k] - q[l]) / std::f64::consts::PI).floor();
            if side(&from) * side(&to) < 0.0 || (turns(&from) != turns(&to) && side(&from) * side(&to) > 0.0) {
                let between = [task.name_of(i), task.name_of(i + 1)];
                return Err(Refusal::NoWay(format!(
                    "between {} and {} drives {} and {} become parallel, a change point: want points on one side of \
                     it, another b, or keep_off_change_points = false",
                    between[0],
                    between[1],
                    k + 1,
                    l + 1
                )));
            }
        }
    }
    Ok(())
}

/// Returns the relative angles of the start that the task states, rad, if it states one.
pub(super) fn sheet_of(task: &Task, space: &PoseSpace) -> Option<[f64; 2]> {
    stated(task, space.drives(), 0).map(|q| PoseAngles::of(space, q).a).map(|a| [a[0], a[1]])
}

/// Follows the curves of the end effector on the plane of the task.
fn on_plane(task: &Task, space: &PoseSpace, planes: &Planes, points: &[Vector]) -> Result<PathSegments, Refusal> {
    let curves = curves(task, points)?;
    let rule = Rule { keep_off_change_points: task.keep_off_change_points };
    // Points are checked first, because an unreachable point is the clearer reason.
    let prefer = match task.shape() {
        PathShape::Freehand => sheet_of(task, space),
        _ => poses_at_b(task, space, points)?.first().map(|pose| [pose.a[0], pose.a[1]]),
    };
    let tables = trace::follow(planes.map(), &curves, task.b, prefer, rule)?;
    Ok(tables.into_iter().zip(&curves).map(|(table, curve)| (Path::Table(table), curve.length())).collect())
}
