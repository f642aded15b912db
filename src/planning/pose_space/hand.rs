//! Where a hand leads a machine while b is held: towards a point, continuously, and as near as can be where that is out
//! of reach.

use std::f64::consts::PI;

use super::in_reach::Reach;
use super::space::PoseSpace;
use crate::mechanics::planar::{DriveAngles, PerDrive, Vector};
use crate::planning::reactionless::{BSet, Decimal};

/// A point that a pose misses by less than this share of the reach is reached.
const REACHED_SHARE: f64 = 1e-9;
/// From how many poses the nearest one is sought.
const MAX_STARTS: usize = 24;
/// By how much of the reach another has to be nearer.
const NEARER_SHARE: f64 = 1e-4;
/// Looks along the curve of two drives, and halvings between two of them.
const LOOKS: usize = 240;
const HALVINGS: usize = 60;

impl PoseSpace {
    /// Whether a point and a b leave freedoms, so that a link can be pulled while the end effector stays.
    pub fn leaves_freedoms(&self) -> bool {
        self.drives() > 3
    }

    /// Whether something inside the limits can bar a straight way of joint space.
    pub fn has_bars(&self) -> bool {
        self.planes().is_ok_and(|planes| planes.has_bars())
    }

    /// Whether nothing bars the straight way of joint space between two poses of one b.
    pub fn is_open_way(&self, from: &PerDrive, to: &PerDrive) -> bool {
        self.planes().map_or(true, |planes| planes.is_open_way([from[0], from[1]], [to[0], to[1]]))
    }

    /// A pose at b with the end effector on p, m, or as near to it as the edge of what is reached comes, where that is
    /// known.
    pub fn standing(&self, p: Vector, b: f64) -> Option<DriveAngles> {
        let planes = self.planes().ok()?;
        let map = planes.map();
        let pose = map.poses(p, b).first().copied();
        let a = pose.map_or_else(|| map.clamp(planes.boundary().nearest(p, b, p).a), |pose| pose.a);
        Some(self.lift(&a, b))
    }

    /// The pose that puts the end effector on p, m, at b, continuously from another.
    pub fn follow(&self, p: Vector, b: f64, from: &PerDrive) -> Option<PerDrive> {
        if let Ok(planes) = self.planes() {
            return planes.follow(p, b, [from[0], from[1]]).map(PerDrive::from);
        }
        let keeping = self.toward_led(p, b, from).filter(|(_, off)| is_at(self, *off));
        let (a, off) = keeping.unwrap_or_else(|| self.toward(p, b, from));
        is_at(self, off).then_some(a)
    }

    /// Where to go for a target, m, at b: its pose, or the nearest that can be reached from another; sought all over the
    /// limits.
    pub fn pose_for(&self, p: Vector, b: f64, from: &PerDrive) -> (PerDrive, Reach) {
        if let Ok(planes) = self.planes() {
            let (a, reach) = planes.reach(p, b, [from[0], from[1]]);
            return (PerDrive::from(a), reach);
        }
        pose_for(self, p, b, from)
    }

    /// The same beside another pose, for a target out of reach from which b moves on: which b would do is as it was.
    pub fn pose_beside(&self, p: Vector, b: f64, from: &PerDrive, known: Reach) -> (PerDrive, Reach) {
        if self.planes().is_ok() {
            return self.pose_for(p, b, from);
        }
        let (a, off) = match self.drives() {
            2 => along_curve(self, p, b, from[0]),
            _ => self.toward_beside(p, b, from),
        };
        let reach = match known {
            _ if is_at(self, off) => Reach::Inside,
            Reach::Outside { mending_b, shown_b, other_sheet, .. } => {
                let nearest = self.place(&self.lift(&a, b));
                Reach::Outside { nearest, mending_b, shown_b, other_sheet }
            }
            known => known,
        };
        (a, reach)
    }
}

fn is_at(space: &PoseSpace, off: f64) -> bool {
    off <= REACHED_SHARE * space.farthest()
}

fn pose_for(space: &PoseSpace, p: Vector, b: f64, from: &PerDrive) -> (PerDrive, Reach) {
    if let Some((a, _)) = space.toward_led(p, b, from).filter(|(_, off)| is_at(space, *off)) {
        return (a, Reach::Inside);
    }
    let (mut a, mut off) = match space.drives() {
        2 => along_curve(space, p, b, from[0]),
        _ => space.toward(p, b, from),
    };
    if !is_at(space, off) && space.drives() > 3 {
        // Another elbow may reach it; nothing bars the way there.
        let poses = space.poses(p, b, from);
        match poses.first() {
            Some(q) => (a, off) = (space.angles(q), 0.0),
            None => (a, off) = nearest_of_all(space, p, b, (a, off)),
        }
    }
    if is_at(space, off) {
        return (a, Reach::Inside);
    }
    let set = space.reach(p).ok();
    let mending_b = set.as_ref().and_then(|set| set.nearest(b));
    // One b alone is printed with as many figures as it takes.
    let serves = |b: f64| space.reaches(p, b);
    let printed = |set: &BSet, b: f64| set.decimal(b, 3).or_else(|| Decimal::that(b, 3, serves));
    let shown_b = set.as_ref().zip(mending_b).and_then(|(set, b)| printed(set, b));
    let nearest = space.place(&space.lift(&a, b));
    (a, Reach::Outside { nearest, mending_b, shown_b, other_sheet: false })
}

/// The pose that is nearest to p, m, of those gone to from all over the limits; the one there is, unless another is clearly
/// nearer.
fn nearest_of_all(space: &PoseSpace, p: Vector, b: f64, (a, off): (PerDrive, f64)) -> (PerDrive, f64) {
    let others = (0..MAX_STARTS).map(|i| space.toward(p, b, &space.spread(i)));
    let best = others.min_by(|x, y| x.1.total_cmp(&y.1));
    best.filter(|(_, other)| *other < off - NEARER_SHARE * space.farthest()).unwrap_or((a, off))
}

/// Two drives: the point of their curve that is nearest to p, and how far that is, m; where it turns
/// freely, within half a turn of an angle.
fn along_curve(space: &PoseSpace, p: Vector, b: f64, turn: f64) -> (PerDrive, f64) {
    // Where it turns freely, within half a turn: the curve goes on from there.
    let is_free = space.joints()[0].bounds()[0].is_infinite();
    let [low, high] = if is_free { [turn - PI, turn + PI] } else { space.joints()[0].limits() };
    let off = |a: f64| (space.place(&space.lift(&[a], b)) - p).norm();
    let step = (high - low) / LOOKS as f64;
    let looks = (0..=LOOKS).map(|i| low + step * i as f64);
    let near = looks.min_by(|x, y| off(*x).total_cmp(&off(*y))).unwrap_or(low);
    let [mut from, mut to] = [(near - step).max(low), (near + step).min(high)];
    for _ in 0..HALVINGS {
        let thirds = [(2.0 * from + to) / 3.0, (from + 2.0 * to) / 3.0];
        if off(thirds[0]) < off(thirds[1]) { to = thirds[1] } else { from = thirds[0] }
    }
    let a = 0.5 * (from + to);
    (PerDrive::from([a]), off(a))
}
