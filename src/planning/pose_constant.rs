//! A machine's pose constant and its reactionless planes: λ and b of (12), (13), and what can be reached on a plane.

use std::sync::Arc;

use thiserror::Error;

use crate::mechanics::machine::{Inertia, Machine, RelativeAngle};
use crate::mechanics::planar::Vector;
use crate::planning::common;
use crate::planning::pose_space::{NoPoseSpace, PoseSpace, held, is_reactionless};
use crate::planning::reactionless::{
    AngleDefinition, AngleLimit, Boundary, Decimal, NotAPlaneMap, PlaneMap, PlanePoint, Poses,
};
use crate::query::{Quick, Same};
use crate::settings::number::counted;

pub use crate::planning::unreachable::{Mend, NoCommon, ShownMend, Unreachable};

/// The reactionless planes of a machine, with the boundary of their workspace.
#[derive(Clone, Debug)]
pub struct Planes {
    map: PlaneMap,
    boundary: Boundary,
    keep_off_change_points: bool,
    is_reactionless: bool,
}

/// The planes of a machine, if it has some.
pub struct PlanesOf;

impl Quick for PlanesOf {
    type Input = Machine;
    type Answer = Option<Arc<Planes>>;

    fn answer(machine: &Machine) -> Self::Answer {
        Planes::of(machine).ok().map(Arc::new)
    }
}

/// The same planes, on which ways keep off change points.
pub struct KeepingOff;

impl Quick for KeepingOff {
    type Input = Same<Planes>;
    type Answer = Planes;

    fn answer(Same(planes): &Same<Planes>) -> Planes {
        Planes::clone(planes).keeping_off_change_points(true)
    }
}

/// Whether a machine has a pose constant b = Σ λ_k q_k, asked here alone.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PoseConstant {
    /// Holding b keeps every moment from the base.
    #[error("b = Σ λ_k q_k")]
    Exact,
    /// λ depends on the pose so little that holding b keeps most of the moment from the base.
    #[error(
        "b = Σ λ_k q_k, but only nearly: couplings of up to {residual:.1e} kg m² remain, so holding b is not exactly \
         reactionless; `stillbase design` removes them"
    )]
    Nearly {
        /// Largest |C_kl|, kg m².
        residual: f64,
    },
    /// None, and none is needed.
    #[error("none is needed: every motion is reactionless, as no drive turns the base")]
    Unneeded,
    /// None.
    #[error("none: {0}")]
    None(NoPoseSpace),
}

impl PoseConstant {
    /// Of a machine.
    pub fn of(machine: &Machine) -> Self {
        match PoseSpace::of(machine) {
            Ok(_) if is_reactionless(machine) => Self::Exact,
            Ok(_) => Self::Nearly { residual: Inertia::of(machine).invariance_residual() },
            Err(NoPoseSpace::Free) => Self::Unneeded,
            Err(why) => Self::None(why),
        }
    }

    /// In a word, for a key of JSON.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Nearly { .. } => "nearly",
            Self::Unneeded => "unneeded",
            Self::None(_) => "none",
        }
    }
}

/// Whether a target can be reached on the present plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reach {
    /// The target can be reached.
    Inside,
    /// It cannot; the machine waits at the nearest point that it can reach without leaving the plane.
    Outside {
        /// Where it waits, m.
        nearest: Vector,
        /// The b nearest to the present one that would reach the target, rad; none if no b does.
        mending_b: Option<f64>,
        /// The same as it is shown: rounded to where it still does.
        shown_b: Option<Decimal>,
        /// A pose of this plane reaches it, but beyond a fold, or a change point to keep off.
        other_sheet: bool,
    },
    /// It cannot any more since b was changed, so the machine keeps a_1 and a_2 and turns with its workspace.
    Carried,
}

/// Why a machine has no reactionless planes that can be drawn.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PlaneError {
    /// Not three drives.
    #[error(
        "this machine has {} and {}: planes want three drives and two relative angles with limits, each an [[angle]] \
         with name, to, from, min and max",
        counted(drives, "drive"),
        counted(angles, "relative angle")
    )]
    Shape {
        /// Drives of the machine.
        drives: usize,
        /// Its relative joint angles.
        angles: usize,
    },
    /// An angle that turns freely.
    #[error(
        "the angle {0} has no limits: planes of three drives want limits of both angles, such as limits.{0}=0,3.1416"
    )]
    Unlimited(String),
    /// λ depends on the pose, or is nothing.
    #[error(transparent)]
    NoPoseConstant(NoPoseSpace),
    /// The lengths, λ or limits give no plane coordinates.
    #[error(transparent)]
    Map(#[from] NotAPlaneMap),
}

impl Planes {
    /// The planes of a machine, by the λ of its constant diagonal D_k = H_kk.
    ///
    /// # Errors
    /// If it has not three drives and two relative angles, or no b.
    pub fn of(machine: &Machine) -> Result<Self, PlaneError> {
        let map = plane_map(machine)?;
        let (boundary, is_reactionless) = (Boundary::of(&map), is_reactionless(machine));
        Ok(Self { boundary, map, keep_off_change_points: false, is_reactionless })
    }

    /// Whether holding b keeps every moment from the base; where not, it keeps most of it.
    pub fn is_reactionless(&self) -> bool {
        self.is_reactionless
    }

    /// The same planes, on which ways lead across change points or keep off them.
    #[must_use]
    pub fn keeping_off_change_points(self, keep_off_change_points: bool) -> Self {
        Self { keep_off_change_points, ..self }
    }

    /// Whether ways keep off change points.
    pub fn keep_off_change_points(&self) -> bool {
        self.keep_off_change_points
    }

    /// Whether something inside the limits can bar a way: a fold, or a change point to keep off.
    pub fn has_bars(&self) -> bool {
        self.keep_off_change_points || self.boundary.interior_singularity()
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
        if let Some(a) = self.follow(p, b, from).filter(|a| self.is_open_way(from, *a)) {
            return (a, Reach::Inside);
        }
        let far = |a: &[f64; 2]| (a[0] - from[0]).hypot(a[1] - from[1]);
        let poses = self.map.poses(p, b);
        let same = poses.iter().map(|x| x.a).filter(|a| self.is_open_way(from, *a));
        if let Some(a) = same.min_by(|x, y| far(x).total_cmp(&far(y))) {
            return (a, Reach::Inside);
        }
        let other_sheet = !poses.is_empty();
        let set = self.map.reach(p).ok().filter(|_| !other_sheet);
        let mending_b = set.as_ref().and_then(|set| set.nearest(b));
        let shown_b = set.zip(mending_b).and_then(|(set, b)| set.decimal(b, 3));
        let nearest = self.boundary.nearest(p, b, self.map.forward(from, b));
        let edge = self.map.clamp(nearest.a);
        if !other_sheet && self.is_open_way(from, edge) {
            return (edge, Reach::Outside { nearest: nearest.at, mending_b, shown_b, other_sheet });
        }
        // Something lies between: as near as the straight way goes.
        let a = self.towards(p, b, from);
        (a, Reach::Outside { nearest: self.map.forward(a, b), mending_b, shown_b, other_sheet })
    }

    /// The last pose on the straight way of the end effector to p that continues a pose of the plane b.
    fn towards(&self, p: Vector, b: f64, from: [f64; 2]) -> [f64; 2] {
        let start = self.map.forward(from, b);
        let (mut a, mut t, mut step) = (from, 0.0, 0.125);
        while step > 1e-6 && t < 1.0 {
            let next = self.follow(start + (t + step) * (p - start), b, a);
            let near = |x: &[f64; 2]| (x[0] - a[0]).hypot(x[1] - a[1]) < 0.5 && self.is_open_way(from, *x);
            match next.filter(near) {
                Some(x) => (a, t) = (x, t + step),
                None => step *= 0.5,
            }
        }
        a
    }

    /// Whether the straight way of joint space between two poses of one plane keeps to a sheet, where det has one sign,
    /// and, if so asked, to one side of every change point.
    pub fn is_open_way(&self, from: [f64; 2], to: [f64; 2]) -> bool {
        /// At least so many looks, and one for each tenth of a radian.
        const LOOKS: i32 = 32;
        if self.keep_off_change_points && self.map.sides(from) != self.map.sides(to) {
            return false;
        }
        if !self.boundary.interior_singularity() {
            return true;
        }
        let sheet = self.map.det(from);
        let at = |t: f64| [0, 1].map(|i| from[i] + t * (to[i] - from[i]));
        let far = (to[0] - from[0]).hypot(to[1] - from[1]);
        // As a cast: limits keep it below a thousand.
        let looks = LOOKS.max((10.0 * far) as i32);
        (1..=looks).all(|i| self.map.det(at(f64::from(i) / f64::from(looks))) * sheet >= 0.0)
    }

    /// One pose for each of some points on the plane b: all on one sheet if possible, else each near the one before.
    ///
    /// # Errors
    /// Which point (counted from 0) cannot be reached, and what b would do.
    pub fn serve(&self, points: &[Vector], b: f64) -> Result<Vec<PlanePoint>, (usize, Unreachable)> {
        let poses: Vec<Poses> = points.iter().map(|p| self.map.poses(*p, b)).collect();
        if let Some(why) = common::unreached(&self.map, points, b) {
            return Err(why);
        }
        let Some((first, others)) = poses.split_first() else { return Ok(Vec::new()) };
        let far = |x: &PlanePoint, y: &PlanePoint| (x.a[0] - y.a[0]).hypot(x.a[1] - y.a[1]);
        // The nearest pose to the last one, of those that a filter lets pass.
        let chain = |start: &PlanePoint, one_sheet: bool| {
            let sheet = self.map.det(start.a);
            let mut served = vec![*start];
            for poses in others {
                let last = served[served.len() - 1];
                let fit = poses.iter().filter(|y| !one_sheet || self.map.det(y.a) * sheet >= 0.0);
                served.push(*fit.min_by(|x, y| far(x, &last).total_cmp(&far(y, &last)))?);
            }
            Some(served)
        };
        let on_one_sheet = first.iter().find_map(|start| chain(start, true));
        Ok(on_one_sheet.or_else(|| first.iter().find_map(|start| chain(start, false))).unwrap_or_default())
    }

    /// The poses of points at the b nearest to the given one that serves all, turned rigidly to that b: the points move
    /// along with the workspace.
    pub fn serve_turned(&self, points: &[Vector], b: f64) -> Option<Vec<PlanePoint>> {
        let common = common::common(&self.map, points)?;
        // A hair inside, so that rounding does not put the pose outside again.
        let nearest = common.nearest(b)?;
        let served = self.serve(points, nearest).or_else(|_| self.serve(points, common.inwards(nearest, 1e-9))).ok()?;
        Some(served.into_iter().map(|x| PlanePoint { a: x.a, b }).collect())
    }
}

/// Eqs (13)–(16) of a machine.
///
/// # Errors
/// If it has not three drives and two relative angles, or no b.
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
    let lambda = held(machine).map_err(PlaneError::NoPoseConstant)?.lambda();
    let angle = |a: &RelativeAngle| AngleDefinition { to: a.to, from: a.from, offset: a.offset };
    let limit = |a: &RelativeAngle| AngleLimit { min: *a.limits.start(), max: *a.limits.end() };
    Ok(PlaneMap::new(
        [tip[0], tip[1], tip[2]],
        [lambda[0], lambda[1], lambda[2]],
        [angle(first), angle(second)],
        [limit(first), limit(second)],
    )?)
}
