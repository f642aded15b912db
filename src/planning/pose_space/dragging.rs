//! Dragging the end effector while b is held: towards a point, continuously, and to the nearest feasible pose if the
//! point is out of reach.

use std::f64::consts::PI;

use super::in_reach::Reach;
use super::space::PoseSpace;
use crate::reactionless::{BSet, Decimal};
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector};

/// Residual below which a point is treated as reached, as a fraction of the reach.
const REACHED_TOLERANCE: f64 = 1e-9;
/// Number of samples along the curve of two drives, and of steps of the ternary search between two samples.
const CURVE_SAMPLES: usize = 240;
const TERNARY_STEPS: usize = 60;

impl PoseSpace {
    /// Whether freedoms remain at a given point and b, so that a link can be dragged while the end effector stays.
    pub fn leaves_freedoms(&self) -> bool {
        self.drives() > 3
    }

    /// Whether a fold, or a change point to be avoided, can block a straight line in joint space within the limits.
    pub fn has_barriers(&self) -> bool {
        self.planes().is_ok_and(|planes| planes.has_barriers())
    }

    /// Whether the straight line in joint space between two poses of one b is not blocked.
    pub fn is_unblocked(&self, from: &PerDrive, to: &PerDrive) -> bool {
        self.planes().map_or(true, |planes| planes.is_unblocked([from[0], from[1]], [to[0], to[1]]))
    }

    /// Returns a pose at b with the end effector on p, m, or at the nearest boundary point; `None` without planes.
    pub fn pose_at(&self, p: Vector, b: f64) -> Option<DriveAngles> {
        let planes = self.planes().ok()?;
        let map = planes.map();
        let pose = map.poses(p, b).first().copied();
        let a = pose.map_or_else(|| map.clamp(planes.boundary().nearest(p, b, p).a), |pose| pose.a);
        Some(self.lift(&a, b))
    }

    /// Returns the pose that puts the end effector on p, m, at b, continuously from another pose.
    pub fn follow(&self, p: Vector, b: f64, from: &PerDrive) -> Option<PerDrive> {
        if let Ok(planes) = self.planes() {
            return planes.follow(p, b, [from[0], from[1]]).map(PerDrive::from);
        }
        let keeping = self.drag_to_guided(p, b, from).filter(|(_, off)| is_at(self, *off));
        let (a, off) = keeping.unwrap_or_else(|| self.drag_to(p, b, from));
        is_at(self, off).then_some(a)
    }

    /// Returns the pose for a target p, m, at b, rad, or the nearest feasible one, searched within all limits.
    pub fn target_pose(&self, p: Vector, b: f64, from: &PerDrive) -> (PerDrive, Reach) {
        if let Ok(planes) = self.planes() {
            let (a, reach) = planes.reach(p, b, [from[0], from[1]]);
            return (PerDrive::from(a), reach);
        }
        pose_for(self, p, b, from)
    }

    /// Returns the pose for a target as [`target_pose`](Self::target_pose) does, but starts from a nearby pose, for a
    /// target out of reach while b changes. The feasible b in `known` are kept.
    pub fn target_pose_nearby(&self, p: Vector, b: f64, from: &PerDrive, known: Reach) -> (PerDrive, Reach) {
        if self.planes().is_ok() {
            return self.target_pose(p, b, from);
        }
        let (a, off) = match self.drives() {
            2 => along_curve(self, p, b, from[0]),
            _ => self.drag_to_from_nearby(p, b, from),
        };
        let reach = match known {
            _ if is_at(self, off) => Reach::Inside,
            Reach::Outside { feasible_b, displayed_b, other_sheet, .. } => {
                let nearest = self.end_effector(&self.lift(&a, b));
                Reach::Outside { nearest, feasible_b, displayed_b, other_sheet }
            }
            known => known,
        };
        (a, reach)
    }
}

fn is_at(space: &PoseSpace, off: f64) -> bool {
    off <= REACHED_TOLERANCE * space.farthest()
}

fn pose_for(space: &PoseSpace, p: Vector, b: f64, from: &PerDrive) -> (PerDrive, Reach) {
    if let Some((a, _)) = space.drag_to_guided(p, b, from).filter(|(_, off)| is_at(space, *off)) {
        return (a, Reach::Inside);
    }
    let (mut a, mut off) = match space.drives() {
        2 => along_curve(space, p, b, from[0]),
        _ => space.drag_to(p, b, from),
    };
    if !is_at(space, off) && space.drives() > 3 {
        // A pose with another elbow configuration may reach it; without planes nothing blocks the path there.
        let poses = space.poses(p, b, from);
        match poses.first() {
            Some(q) => (a, off) = (space.angles(q), 0.0),
            None => (a, off) = space.nearest_of_all(p, b, a, off),
        }
    }
    if is_at(space, off) {
        return (a, Reach::Inside);
    }
    let set = space.reach(p).ok();
    let feasible_b = set.as_ref().and_then(|set| set.nearest(b));
    // A single value of b is printed with as many decimals as it needs.
    let serves = |b: f64| space.reaches(p, b);
    let printed = |set: &BSet, b: f64| set.decimal(b, 3).or_else(|| Decimal::shortest_passing(b, 3, serves));
    let displayed_b = set.as_ref().zip(feasible_b).and_then(|(set, b)| printed(set, b));
    let nearest = space.end_effector(&space.lift(&a, b));
    (a, Reach::Outside { nearest, feasible_b, displayed_b, other_sheet: false })
}

/// Returns the relative angle of two drives, rad, with the end effector nearest to p, and its distance, m. A free
/// joint is searched within half a turn of `turn`, rad.
fn along_curve(space: &PoseSpace, p: Vector, b: f64, turn: f64) -> (PerDrive, f64) {
    // The curve of a free joint is periodic.
    let is_free = space.joints()[0].bounds()[0].is_infinite();
    let [low, high] = if is_free { [turn - PI, turn + PI] } else { space.joints()[0].limits() };
    let off = |a: f64| (space.end_effector(&space.lift(&[a], b)) - p).norm();
    let step = (high - low) / CURVE_SAMPLES as f64;
    let samples = (0..=CURVE_SAMPLES).map(|i| low + step * i as f64);
    let near = samples.min_by(|x, y| off(*x).total_cmp(&off(*y))).unwrap_or(low);
    let [mut from, mut to] = [(near - step).max(low), (near + step).min(high)];
    for _ in 0..TERNARY_STEPS {
        let thirds = [(2.0 * from + to) / 3.0, (from + 2.0 * to) / 3.0];
        if off(thirds[0]) < off(thirds[1]) { to = thirds[1] } else { from = thirds[0] }
    }
    let a = 0.5 * (from + to);
    (PerDrive::from([a]), off(a))
}
