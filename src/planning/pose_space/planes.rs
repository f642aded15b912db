//! [`Planes`]: the closed forms of three drives with limits of both relative angles. A pose space contains them and
//! gives access to their sheets, folds and change points.

use thiserror::Error;

use super::in_reach::Reach;
use super::no_pose_space::{NoPoseSpace, constant_inertia, is_reactionless};
use crate::reactionless::{AngleDefinition, AngleLimit, Boundary, NotAPlaneMap, PlaneMap};
use stillbase_mechanics::machine::{Machine, RelativeAngle};
use stillbase_mechanics::planar::Vector;
use stillbase_settings::number::counted;

/// The reactionless planes of a machine, with the boundary of their workspace.
#[derive(Clone, Debug)]
pub struct Planes {
    map: PlaneMap,
    boundary: Boundary,
    keep_off_change_points: bool,
    is_reactionless: bool,
}

impl PartialEq for Planes {
    /// The boundary is not compared, as it follows from the map.
    fn eq(&self, other: &Self) -> bool {
        let Self { map, boundary: _, keep_off_change_points, is_reactionless } = self;
        (map, keep_off_change_points, is_reactionless)
            == (&other.map, &other.keep_off_change_points, &other.is_reactionless)
    }
}

/// Why a machine has no reactionless planes in closed form.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PlaneError {
    /// The machine does not have three drives and two relative angles.
    #[error(
        "this machine has {} and {}: planes want three drives and two relative angles with limits, each an [[angle]] \
         with name, to, from, min and max",
        counted(drives, "drive"),
        counted(angles, "relative angle")
    )]
    Shape {
        /// Number of drives.
        drives: usize,
        /// Number of relative angles.
        angles: usize,
    },
    /// A relative angle has no limits.
    #[error(
        "the angle {0} has no limits: planes of three drives want limits of both angles, such as limits.{0}=0,3.1416"
    )]
    Unlimited(String),
    /// λ depends on the pose, or is zero.
    #[error(transparent)]
    NoPoseConstant(NoPoseSpace),
    /// Arms, λ or limits define no plane coordinates.
    #[error(transparent)]
    Map(#[from] NotAPlaneMap),
    /// The general method was requested.
    #[error("planes were not requested: the poses are computed by the general method")]
    NotRequested,
}

impl PlaneError {
    /// Whether a machine with this number of drives can have planes.
    pub fn could_have_planes(&self) -> bool {
        !matches!(self, Self::Shape { drives, .. } if *drives != 3)
    }
}

impl Planes {
    /// Returns the planes of a machine, with λ_k = D_k / D_1, (12).
    ///
    /// # Errors
    /// If it lacks three drives, two relative angles with limits, or a b, or these define no plane coordinates.
    pub(super) fn of(machine: &Machine) -> Result<Self, PlaneError> {
        let map = plane_map(machine)?;
        let (boundary, is_reactionless) = (Boundary::of(&map), is_reactionless(machine));
        Ok(Self { boundary, map, keep_off_change_points: false, is_reactionless })
    }

    /// Whether holding b keeps the base free of moments exactly; if not, it removes most of them.
    pub fn is_reactionless(&self) -> bool {
        self.is_reactionless
    }

    /// Returns the same planes. Paths avoid change points if `keep_off_change_points`, else they may cross them.
    #[must_use]
    pub(super) fn keeping_off_change_points(self, keep_off_change_points: bool) -> Self {
        Self { keep_off_change_points, ..self }
    }

    /// Whether paths avoid change points.
    pub fn keep_off_change_points(&self) -> bool {
        self.keep_off_change_points
    }

    /// Whether a fold, or a change point that is to be avoided, can block a path within the limits.
    pub fn has_barriers(&self) -> bool {
        self.keep_off_change_points || self.boundary.interior_singularity()
    }

    /// Returns the machine's coordinate map, Eqs (13)–(16).
    pub fn map(&self) -> &PlaneMap {
        &self.map
    }

    /// Returns the boundary of the workspace.
    pub fn boundary(&self) -> &Boundary {
        &self.boundary
    }

    /// Returns the pose that puts the end effector on p, m, on the plane b, continuously from another pose.
    pub fn follow(&self, p: Vector, b: f64, from: [f64; 2]) -> Option<[f64; 2]> {
        self.map.follow(p, b, from)
    }

    /// Returns the pose for a target p, m, on the plane b and the sheet of `from`, or the nearest feasible one.
    pub fn reach(&self, p: Vector, b: f64, from: [f64; 2]) -> ([f64; 2], Reach) {
        if let Some(a) = self.follow(p, b, from).filter(|a| self.is_unblocked(from, *a)) {
            return (a, Reach::Inside);
        }
        let far = |a: &[f64; 2]| (a[0] - from[0]).hypot(a[1] - from[1]);
        let poses = self.map.poses(p, b);
        let same = poses.iter().map(|x| x.a).filter(|a| self.is_unblocked(from, *a));
        if let Some(a) = same.min_by(|x, y| far(x).total_cmp(&far(y))) {
            return (a, Reach::Inside);
        }
        let other_sheet = !poses.is_empty();
        let set = self.map.reach(p).ok().filter(|_| !other_sheet);
        let feasible_b = set.as_ref().and_then(|set| set.nearest(b));
        let displayed_b = set.zip(feasible_b).and_then(|(set, b)| set.decimal(b, 3));
        let nearest = self.boundary.nearest(p, b, self.map.forward(from, b));
        let edge = self.map.clamp(nearest.a);
        if !other_sheet && self.is_unblocked(from, edge) {
            return (edge, Reach::Outside { nearest: nearest.at, feasible_b, displayed_b, other_sheet });
        }
        // The straight line in joint space is blocked: move as near to the target as possible.
        let a = self.towards(p, b, from);
        (a, Reach::Outside { nearest: self.map.forward(a, b), feasible_b, displayed_b, other_sheet })
    }

    /// Returns the last pose that continues `from` on the plane b while the end effector moves straight to p.
    fn towards(&self, p: Vector, b: f64, from: [f64; 2]) -> [f64; 2] {
        let start = self.map.forward(from, b);
        let (mut a, mut t, mut step) = (from, 0.0, 0.125);
        while step > 1e-6 && t < 1.0 {
            let next = self.follow(start + (t + step) * (p - start), b, a);
            let near = |x: &[f64; 2]| (x[0] - a[0]).hypot(x[1] - a[1]) < 0.5 && self.is_unblocked(from, *x);
            match next.filter(near) {
                Some(x) => (a, t) = (x, t + step),
                None => step *= 0.5,
            }
        }
        a
    }

    /// Whether the straight line in joint space between two poses of one plane stays on one sheet, where det keeps its
    /// sign. If change points are to be avoided, it must also stay on one side of each.
    pub fn is_unblocked(&self, from: [f64; 2], to: [f64; 2]) -> bool {
        /// Minimum number of samples; long lines have one for each 0.1 rad.
        const MIN_SAMPLES: i32 = 32;
        if self.keep_off_change_points && self.map.sides(from) != self.map.sides(to) {
            return false;
        }
        if !self.boundary.interior_singularity() {
            return true;
        }
        let sheet = self.map.det(from);
        let at = |t: f64| [0, 1].map(|i| from[i] + t * (to[i] - from[i]));
        let far = (to[0] - from[0]).hypot(to[1] - from[1]);
        // The cast is safe: the limits keep this number below a thousand.
        let samples = MIN_SAMPLES.max((10.0 * far) as i32);
        (1..=samples).all(|i| self.map.det(at(f64::from(i) / f64::from(samples))) * sheet >= 0.0)
    }
}

/// Returns the workspace area of a machine with planes, m²; it is the same for each b.
pub fn plane_area(machine: &Machine) -> Option<f64> {
    Some(Boundary::of(&plane_map(machine).ok()?).area())
}

/// Returns the coordinate map of a machine, Eqs (13)–(16).
///
/// # Errors
/// If it lacks three drives, two relative angles with limits, or a b, or these define no plane coordinates.
pub fn plane_map(machine: &Machine) -> Result<PlaneMap, PlaneError> {
    let shape = || PlaneError::Shape { drives: machine.drives(), angles: machine.angles().len() };
    let [first, second] = machine.angles() else { return Err(shape()) };
    if machine.drives() != 3 {
        return Err(shape());
    }
    let bounded = |a: &RelativeAngle| a.limits.start().is_finite() && a.limits.end().is_finite();
    if let Some(free) = [first, second].into_iter().find(|a| !bounded(a)) {
        return Err(PlaneError::Unlimited(free.name.clone()));
    }
    let tip = machine.end_effector();
    let lambda = constant_inertia(machine).map_err(PlaneError::NoPoseConstant)?.lambda();
    let angle = |a: &RelativeAngle| AngleDefinition { to: a.to, from: a.from, offset: a.offset };
    let limit = |a: &RelativeAngle| AngleLimit { min: *a.limits.start(), max: *a.limits.end() };
    Ok(PlaneMap::new(
        [tip[0], tip[1], tip[2]],
        [lambda[0], lambda[1], lambda[2]],
        [angle(first), angle(second)],
        [limit(first), limit(second)],
    )?)
}
