//! A machine's pose constant and its reactionless planes: λ and b of (12), (13), and what can be reached on a plane.

use thiserror::Error;

use crate::machine::{Inertia, Machine};
use crate::planar::Vector;
use crate::reactionless::{AngleDefinition, BSet, Boundary, Limit, NoReach, NotAPlaneMap, PlaneMap, PlanePoint};

/// The reactionless planes of a machine, with the boundary of their workspace.
#[derive(Clone, Debug)]
pub struct Planes {
    map: PlaneMap,
    boundary: Boundary,
}

/// Whether a target can be reached on the present plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reach {
    /// It can.
    Inside,
    /// It cannot; the machine waits at the nearest point that it can reach without leaving the plane.
    Outside {
        /// Where it waits, m.
        nearest: Vector,
        /// The b nearest to the present one that would reach the target, rad; none if no b does.
        mending_b: Option<f64>,
    },
    /// It cannot any more since b was changed, so the machine keeps a_1 and a_2 and turns with its workspace.
    Carried,
}

/// Why a machine has no reactionless planes that can be drawn.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PlaneError {
    /// Not three drives.
    #[error("{drives} drives and {angles} relative angles: reactionless workspaces in the plane want three and two")]
    Shape {
        /// How many.
        drives: usize,
        /// How many.
        angles: usize,
    },
    /// The numbers.
    #[error(transparent)]
    Map(#[from] NotAPlaneMap),
}

/// Why a point is not on a plane, and what would do.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Unreachable {
    /// Not on any plane.
    #[error("({x:.3}, {y:.3}) m: {reason}")]
    Anywhere {
        /// m.
        x: f64,
        /// m.
        y: f64,
        /// Why.
        reason: NoReach,
    },
    /// Not on this plane.
    #[error("({x:.3}, {y:.3}) m is outside the reactionless workspace of b = {b:.3} rad: want {would_do}")]
    OnThisPlane {
        /// m.
        x: f64,
        /// m.
        y: f64,
        /// rad.
        b: f64,
        /// The b that would do, in words.
        would_do: String,
    },
    /// Each point on some plane, but no plane serves both.
    #[error("({x:.3}, {y:.3}) m shares no b with the other point: no reactionless path joins them")]
    NoCommonPlane {
        /// m.
        x: f64,
        /// m.
        y: f64,
    },
}

impl Planes {
    /// The planes of a machine, by the λ of its constant diagonal D_k = H_kk.
    ///
    /// # Errors
    /// If it has not three drives and two relative angles.
    pub fn of(machine: &Machine) -> Result<Self, PlaneError> {
        let map = plane_map(machine)?;
        Ok(Self { boundary: Boundary::of(&map), map })
    }

    /// Eqs (13)–(16).
    pub fn map(&self) -> &PlaneMap {
        &self.map
    }

    /// The boundary of the workspace.
    pub fn boundary(&self) -> &Boundary {
        &self.boundary
    }

    /// The pose that puts the end effector on p on the plane b, continuously from another.
    pub fn follow(&self, p: Vector, b: f64, from: [f64; 2]) -> Option<[f64; 2]> {
        self.map.follow(p, b, from)
    }

    /// Where to go for a target: its pose on the plane b and the sheet of `from`, or the nearest that can be reached.
    pub fn reach(&self, p: Vector, b: f64, from: [f64; 2]) -> ([f64; 2], Reach) {
        if let Some(a) = self.follow(p, b, from) {
            return (a, Reach::Inside);
        }
        let sheet = self.map.det(from);
        let far = |a: &[f64; 2]| (a[0] - from[0]).hypot(a[1] - from[1]);
        let poses = self.map.poses(p, b);
        let same = poses.iter().map(|x| x.a).filter(|a| self.map.det(*a) * sheet >= 0.0);
        if let Some(a) = same.min_by(|x, y| far(x).total_cmp(&far(y))) {
            return (a, Reach::Inside);
        }
        let nearest = self.boundary.nearest(p, b, self.map.forward(from, b));
        let mending_b = self.map.reach(p).ok().and_then(|set| set.nearest(b));
        (self.map.clamp(nearest.a), Reach::Outside { nearest: nearest.at, mending_b })
    }

    /// One pose for each of two points on the plane b, on one sheet.
    ///
    /// # Errors
    /// Which point (0 or 1) cannot be reached, and what b would do.
    pub fn serve(&self, points: [Vector; 2], b: f64) -> Result<[PlanePoint; 2], (usize, Unreachable)> {
        let [first, second] = points.map(|p| self.map.poses(p, b));
        for x in first.iter() {
            let sheet = self.map.det(x.a);
            if let Some(y) = second.iter().find(|y| self.map.det(y.a) * sheet >= 0.0) {
                return Ok([*x, *y]);
            }
        }
        let i = usize::from(!first.is_empty());
        Err((i, self.why_not(points, i, b)))
    }

    /// The poses of two points at the b nearest to the given one that serves both, turned rigidly to that b: the
    /// points move along with the workspace.
    pub fn serve_turned(&self, points: [Vector; 2], b: f64) -> Option<[PlanePoint; 2]> {
        let common = self.common(points)?;
        // A hair inside, so that rounding does not put the pose outside again.
        let nearest = common.nearest(b)?;
        let served = self.serve(points, nearest).or_else(|_| self.serve(points, inwards(&common, nearest))).ok()?;
        Some(served.map(|x| PlanePoint { a: x.a, b }))
    }

    /// The b that serve all points.
    pub fn common(&self, points: [Vector; 2]) -> Option<BSet> {
        let [a, b] = points.map(|p| self.map.reach(p).ok());
        let common = BSet::overlap(&[a?, b?]);
        (!common.intervals.is_empty()).then_some(common)
    }

    fn why_not(&self, points: [Vector; 2], i: usize, b: f64) -> Unreachable {
        let (x, y) = (points[i].re, points[i].im);
        if let Err(reason) = self.map.reach(points[i]) {
            return Unreachable::Anywhere { x, y, reason };
        }
        match self.common(points) {
            Some(common) => Unreachable::OnThisPlane { x, y, b, would_do: in_words(&common) },
            None => Unreachable::NoCommonPlane { x, y },
        }
    }
}

/// A b a hair further inside the interval that it is an end of.
fn inwards(set: &BSet, b: f64) -> f64 {
    let lifted = |x: f64| x + set.period * ((b - x) / set.period).round();
    let middles = set.intervals.iter().map(|[low, high]| lifted(0.5 * (low + high)));
    middles.min_by(|x, y| (x - b).abs().total_cmp(&(y - b).abs())).map_or(b, |middle| b + (middle - b) * 1e-9)
}

/// `b from 2.216 to 2.661 rad`.
pub fn in_words(set: &BSet) -> String {
    let ranges: Vec<String> = set.intervals.iter().map(|[a, b]| format!("from {a:.3} to {b:.3}")).collect();
    format!("b {} rad", ranges.join(" or "))
}

/// Eqs (13)–(16) of a machine.
///
/// # Errors
/// If it has not three drives and two relative angles.
pub fn plane_map(machine: &Machine) -> Result<PlaneMap, PlaneError> {
    let shape = || PlaneError::Shape { drives: machine.drives(), angles: machine.angles().len() };
    let [first, second] = machine.angles() else { return Err(shape()) };
    if machine.drives() != 3 {
        return Err(shape());
    }
    let tip = machine.tip();
    let lambda = Inertia::of(machine).lambda();
    let angle = |a: &crate::machine::RelativeAngle| AngleDefinition { to: a.to, from: a.from, offset: a.offset };
    let limit = |a: &crate::machine::RelativeAngle| Limit { min: *a.limits.start(), max: *a.limits.end() };
    Ok(PlaneMap::new(
        [tip[0], tip[1], tip[2]],
        [lambda[0], lambda[1], lambda[2]],
        [angle(first), angle(second)],
        [limit(first), limit(second)],
    )?)
}
