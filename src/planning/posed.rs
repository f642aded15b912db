//! Poses of the points of a task: one pose for each point at one b, or the nearest two poses at two b. Also how points
//! move when b changes.

use crate::common;
use crate::pose_space::PoseSpace;
use crate::unreachable::Unreachable;
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector, unit};

/// A pose in coordinates (a, b) and in drive angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseAngles {
    /// Relative angles, rad.
    pub a: PerDrive,
    /// Pose constant, rad.
    pub b: f64,
    /// Drive angles, rad.
    pub q: DriveAngles,
}

impl PoseAngles {
    /// Returns the pose of drive angles, rad.
    pub fn of(space: &PoseSpace, q: DriveAngles) -> Self {
        let (a, b) = space.project(&q);
        Self { a, b, q }
    }

    /// Returns the pose of relative angles and b, rad.
    pub fn lifted(space: &PoseSpace, a: PerDrive, b: f64) -> Self {
        Self { a, b, q: space.lift(&a, b) }
    }

    /// Length of the straight line in joint space to another pose, rad: with planes |Δa|, else the largest |Δq_k|.
    pub fn distance_to(&self, space: &PoseSpace, to: &Self) -> f64 {
        match space.planes() {
            Ok(_) => across(&self.a, &to.a),
            Err(_) => to.q.0.minus(&self.q.0).max_abs(),
        }
    }
}

/// √((Δa_1)² + (Δa_2)²).
fn across(x: &PerDrive, y: &PerDrive) -> f64 {
    (x[0] - y[0]).hypot(x[1] - y[1])
}

/// Returns one pose for each point, m, at b, rad. With planes, all lie on one sheet if possible; otherwise each is near
/// the previous one.
///
/// # Errors
/// The index of the point that cannot be reached (counted from 0), and which b would be feasible.
pub fn poses_of_points(space: &PoseSpace, points: &[Vector], b: f64) -> Result<Vec<PoseAngles>, (usize, Unreachable)> {
    if let Some(why) = common::unreached(space, points, b) {
        return Err(why);
    }
    let Ok(planes) = space.planes() else {
        let mut near = space.middle();
        let mut served = Vec::with_capacity(points.len());
        for (i, p) in points.iter().enumerate() {
            let q = space
                .poses(*p, b, &near)
                .first()
                .copied()
                .ok_or_else(|| (i, common::unreachable_reason(space, points, i, b)))?;
            served.push(PoseAngles::of(space, q));
            near = served[i].a;
        }
        return Ok(served);
    };
    let poses: Vec<Vec<PerDrive>> = points.iter().map(|p| space.representative_poses(*p, b)).collect();
    let Some((first, others)) = poses.split_first() else { return Ok(Vec::new()) };
    let det = |a: &PerDrive| planes.map().det([a[0], a[1]]);
    // For each point, the pose nearest to the previous one, optionally only among those on the sheet of the first.
    let chain = |start: &PerDrive, one_sheet: bool| {
        let sheet = det(start);
        let mut served = vec![*start];
        for poses in others {
            let last = served[served.len() - 1];
            let fit = poses.iter().filter(|y| !one_sheet || det(y) * sheet >= 0.0);
            served.push(*fit.min_by(|x, y| across(x, &last).total_cmp(&across(y, &last)))?);
        }
        Some(served)
    };
    let on_one_sheet = first.iter().find_map(|start| chain(start, true));
    let served = on_one_sheet.or_else(|| first.iter().find_map(|start| chain(start, false))).unwrap_or_default();
    Ok(served.into_iter().map(|a| PoseAngles::lifted(space, a, b)).collect())
}

/// Returns the nearest pair of poses of two points, m, each point at its own b, rad.
pub fn nearest_poses(space: &PoseSpace, points: [Vector; 2], b: [f64; 2]) -> Option<[PoseAngles; 2]> {
    let pairs: Vec<([PoseAngles; 2], f64)> = match space.planes() {
        Ok(_) => {
            let [starts, ends] = [0, 1].map(|i| space.representative_poses(points[i], b[i]));
            let pair = |x: PerDrive, y: PerDrive| {
                ([PoseAngles::lifted(space, x, b[0]), PoseAngles::lifted(space, y, b[1])], across(&x, &y))
            };
            starts.iter().flat_map(|x| ends.iter().map(move |y| pair(*x, *y))).collect()
        }
        Err(_) => {
            let starts = space.poses(points[0], b[0], &space.middle()).into_iter().map(|q| PoseAngles::of(space, q));
            let nearest = |x: PoseAngles| {
                let far = |y: &PoseAngles| y.a.minus(&x.a).max_abs();
                let ends = space.poses(points[1], b[1], &x.a).into_iter().map(|q| PoseAngles::of(space, q));
                ends.min_by(|y, z| far(y).total_cmp(&far(z))).map(|y| ([x, y], far(&y)))
            };
            starts.filter_map(nearest).collect()
        }
    };
    pairs.into_iter().min_by(|x, y| x.1.total_cmp(&y.1)).map(|(pair, _)| pair)
}

/// Returns the positions of points, m, after b has changed from `old` to `new`, rad. They stay if all can be reached at
/// `new`. Otherwise they turn with the workspace. Without planes they turn from `old`; with planes from the b nearest
/// to `new` at which all can be reached; if there is no such b, they stay.
pub fn carried_points(space: &PoseSpace, points: &[Vector], [old, new]: [f64; 2]) -> Vec<Vector> {
    if points.iter().all(|p| space.reaches(*p, new)) {
        return points.to_vec();
    }
    if space.planes().is_err() {
        let turn = unit(space.turn(new - old));
        return points.iter().map(|p| turn * p).collect();
    }
    let turned = || {
        let shared = common::common_b_set(space, points)?;
        // Second try slightly inside the interval, where rounding does not make the pose infeasible.
        let nearest = shared.nearest(new)?;
        let served = poses_of_points(space, points, nearest)
            .or_else(|_| poses_of_points(space, points, shared.moved_inside(nearest, 1e-9)))
            .ok()?;
        Some(served.iter().map(|pose| space.forward(&pose.a, new)).collect())
    };
    turned().unwrap_or_else(|| points.to_vec())
}
