//! Poses of points of a task: one for each at a b, the nearest two of two b, and where points go as b does.

use crate::mechanics::planar::{DriveAngles, PerDrive, Vector, unit};
use crate::planning::common;
use crate::planning::pose_space::PoseSpace;
use crate::planning::unreachable::Unreachable;

/// A pose by its relative angles and b, and by its drives, rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posed {
    /// Relative angles.
    pub a: PerDrive,
    /// Pose constant.
    pub b: f64,
    /// Drive angles.
    pub q: DriveAngles,
}

impl Posed {
    /// Of drive angles.
    pub fn of(space: &PoseSpace, q: DriveAngles) -> Self {
        let (a, b) = space.project(&q);
        Self { a, b, q }
    }

    /// Of relative angles and b.
    pub fn lifted(space: &PoseSpace, a: PerDrive, b: f64) -> Self {
        Self { a, b, q: space.lift(&a, b) }
    }

    /// How far the straight line of joint space to another pose goes, rad: on planes in their own coordinates, else as far
    /// as the drive that turns most.
    pub fn way(&self, space: &PoseSpace, to: &Self) -> f64 {
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

/// One pose for each of some points at b: all on one sheet if that is known and possible, else each near the one before.
///
/// # Errors
/// Which point (counted from 0) cannot be reached, and what b would do.
pub fn serve(space: &PoseSpace, points: &[Vector], b: f64) -> Result<Vec<Posed>, (usize, Unreachable)> {
    if let Some(why) = common::unreached(space, points, b) {
        return Err(why);
    }
    let Ok(planes) = space.planes() else {
        let mut near = space.middle();
        let mut served = Vec::with_capacity(points.len());
        for (i, p) in points.iter().enumerate() {
            let q =
                space.poses(*p, b, &near).first().copied().ok_or_else(|| (i, common::why_not(space, points, i, b)))?;
            served.push(Posed::of(space, q));
            near = served[i].a;
        }
        return Ok(served);
    };
    let poses: Vec<Vec<PerDrive>> = points.iter().map(|p| space.sheets(*p, b)).collect();
    let Some((first, others)) = poses.split_first() else { return Ok(Vec::new()) };
    let det = |a: &PerDrive| planes.map().det([a[0], a[1]]);
    // The nearest pose to the last one, of those that a filter lets pass.
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
    Ok(served.into_iter().map(|a| Posed::lifted(space, a, b)).collect())
}

/// Of the poses of two points, m, each at its own b, rad, the two that lie nearest together.
pub fn nearest_poses(space: &PoseSpace, points: [Vector; 2], b: [f64; 2]) -> Option<[Posed; 2]> {
    let pairs: Vec<([Posed; 2], f64)> = match space.planes() {
        Ok(_) => {
            let [starts, ends] = [0, 1].map(|i| space.sheets(points[i], b[i]));
            let pair = |x: PerDrive, y: PerDrive| {
                ([Posed::lifted(space, x, b[0]), Posed::lifted(space, y, b[1])], across(&x, &y))
            };
            starts.iter().flat_map(|x| ends.iter().map(move |y| pair(*x, *y))).collect()
        }
        Err(_) => {
            let starts = space.poses(points[0], b[0], &space.middle()).into_iter().map(|q| Posed::of(space, q));
            let nearest = |x: Posed| {
                let far = |y: &Posed| y.a.minus(&x.a).max_abs();
                let ends = space.poses(points[1], b[1], &x.a).into_iter().map(|q| Posed::of(space, q));
                ends.min_by(|y, z| far(y).total_cmp(&far(z))).map(|y| ([x, y], far(&y)))
            };
            starts.filter_map(nearest).collect()
        }
    };
    pairs.into_iter().min_by(|x, y| x.1.total_cmp(&y.1)).map(|(pair, _)| pair)
}

/// Where points are taken when b goes from one value to another, rad: they stay while the new one serves all, and else
/// turn with what is reached; on planes from the nearest b that serves all, with other spaces from the old one.
pub fn carried(space: &PoseSpace, points: &[Vector], [old, new]: [f64; 2]) -> Vec<Vector> {
    if points.iter().all(|p| space.reaches(*p, new)) {
        return points.to_vec();
    }
    if space.planes().is_err() {
        let turn = unit(space.turn(new - old));
        return points.iter().map(|p| turn * p).collect();
    }
    let turned = || {
        let shared = common::common(space, points)?;
        // A hair inside, so that rounding does not put the pose outside again.
        let nearest = shared.nearest(new)?;
        let served =
            serve(space, points, nearest).or_else(|_| serve(space, points, shared.inwards(nearest, 1e-9))).ok()?;
        Some(served.iter().map(|pose| space.forward(&pose.a, new)).collect())
    };
    turned().unwrap_or_else(|| points.to_vec())
}
