//! [`PoseSpace`]: coordinates (a, b) of the poses of any machine that has a pose constant.
//!
//! For three drives with limits of both relative angles, [`Planes`] gives most results in closed form, and a pose space
//! uses it.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use super::joint::RelativeJoint;
use super::no_pose_space::{NoPoseSpace, NotFollowable, constant_inertia, is_reactionless};
use super::pattern::{Pattern, Patterns};
use super::planes::{PlaneError, Planes, plane_map};
use crate::reactionless::{MAX_LIMIT_RANGE, PlaneMap, PlanePoint};
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector, unit};

/// A point within this distance of the base pin B, as a fraction of the reach, is treated as B: turning the workspace
/// does not move it.
pub(super) const BASE_RADIUS: f64 = 1e-12;

/// The set of poses of a machine in coordinates (a, b): relative angles and pose constant.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseSpace {
    pub(super) arms: PerDrive,
    pub(super) lambda: PerDrive,
    pub(super) lambda_sum: f64,
    /// Without planes, ordered as a tree: each follows the joint that leads to its nearer drive. With planes, in the
    /// machine's order.
    pub(super) joints: Box<[RelativeJoint]>,
    pub(super) guidance: GuidanceMode,
    inertia: f64,
    is_reactionless: bool,
    /// Cache of the patterns of these arms and joints; a space with different ones needs a new cache.
    pub(super) patterns: Patterns,
    /// The closed forms, or why there are none.
    planes: Result<Arc<Planes>, PlaneError>,
}

/// Use of the redundant freedoms while the end effector is dragged.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum GuidanceMode {
    /// Each step minimises the kinetic energy.
    #[default]
    LeastEnergy,
    /// One drive keeps its angle, so its links keep their orientation, as long as that is feasible.
    Keep(usize),
    /// Each step minimises a weighted norm; the matrix is the inverse of the weight, row by row.
    WeightedNorm(Box<[[f64; MAX_DRIVES]; MAX_DRIVES]>),
    /// The pose moves to the one nearest to the midpoints of all joint ranges.
    Middle,
}

impl PoseSpace {
    /// Returns the pose space of a machine whose D is constant, or nearly so; its angular momentum is D q̇.
    ///
    /// # Errors
    /// If the machine has no b; the error is the reason.
    pub fn of(machine: &Machine) -> Result<Self, NoPoseSpace> {
        Self::holding(machine, Planes::of(machine).map(Arc::new))
    }

    /// Returns the pose space by the general method, also for three drives: tests compare it with the closed forms.
    ///
    /// # Errors
    /// If the machine has no b; the error is the reason.
    pub fn general(machine: &Machine) -> Result<Self, NoPoseSpace> {
        Self::holding(machine, Err(PlaneError::NotRequested))
    }

    fn holding(machine: &Machine, planes: Result<Arc<Planes>, PlaneError>) -> Result<Self, NoPoseSpace> {
        let inertia = constant_inertia(machine)?;
        Self::with(machine, inertia.lambda(), inertia.pose_inertia(), planes)
    }

    /// Returns the pose space with λ from the inertia H_kk of each drive turning alone, for machines whose D depends on
    /// the pose or is zero. Its b only distinguishes poses of the same point.
    ///
    /// # Errors
    /// If the relative angles or arms define no coordinates.
    pub fn nominal(machine: &Machine) -> Result<Self, NoPoseSpace> {
        let inertia = Inertia::of(machine);
        let h = inertia.diagonals();
        Self::with(
            machine,
            h.scaled(1.0 / h[0]),
            h[0],
            Err(plane_map(machine).err().unwrap_or(PlaneError::NotRequested)),
        )
    }

    fn with(
        machine: &Machine,
        lambda: PerDrive,
        inertia: f64,
        planes: Result<Arc<Planes>, PlaneError>,
    ) -> Result<Self, NoPoseSpace> {
        let lambda_sum: f64 = lambda.iter().sum();
        let arms = PerDrive::from_fn(machine.drives(), |k| machine.end_effector()[k]);
        let reach: f64 = arms.iter().map(|c| c.abs()).sum();
        let mut joints = joints(machine)?;
        match &planes {
            // [`PlaneMap`] has checked λ and the arms already, and orders the angles as the machine does.
            Ok(_) => joints.sort_by_key(|joint| joint.angle),
            Err(_) if lambda_sum.partial_cmp(&1e-9) != Some(std::cmp::Ordering::Greater) => {
                return Err(NoPoseSpace::Sum { sum: lambda_sum });
            }
            Err(_) if !(1e-9..=1e9).contains(&reach) => return Err(NoPoseSpace::Size { reach }),
            Err(_) => {}
        }
        Ok(Self {
            arms,
            lambda,
            lambda_sum,
            joints: joints.into(),
            guidance: GuidanceMode::LeastEnergy,
            inertia,
            is_reactionless: is_reactionless(machine),
            patterns: Patterns::default(),
            planes,
        })
    }

    /// Returns the same space with another use of redundant freedoms.
    #[must_use]
    pub fn with_guidance(self, guidance: GuidanceMode) -> Self {
        Self { guidance, ..self }
    }

    /// Returns the same space. Paths avoid change points only if `keep_off`. Without planes it has no effect.
    #[must_use]
    pub fn keeping_off_change_points(self, keep_off: bool) -> Self {
        let kept = |planes: Arc<Planes>| match planes.keep_off_change_points() == keep_off {
            true => planes,
            false => Arc::new(Planes::clone(&planes).keeping_off_change_points(keep_off)),
        };
        Self { planes: self.planes.map(kept), ..self }
    }

    /// Returns the closed forms of three drives with limits of both relative angles: sheets, folds, change points and
    /// Eq. (16).
    ///
    /// # Errors
    /// If there are none: the reason.
    pub fn planes(&self) -> Result<&Arc<Planes>, &PlaneError> {
        self.planes.as_ref()
    }

    /// Returns the coordinate map of Eqs (13)–(16); `None` without planes.
    #[inline]
    pub(super) fn map(&self) -> Option<&PlaneMap> {
        self.planes.as_ref().ok().map(|planes| planes.map())
    }

    /// Returns each choice of active limits and signs for which b can be stationary; computed at the first call.
    pub(super) fn patterns(&self) -> &[Pattern] {
        self.patterns.of(&self.arms, &self.lambda, &self.joints)
    }

    /// Returns the number of drives.
    pub fn drives(&self) -> usize {
        self.arms.len()
    }

    /// Returns the arms c_k, m: the end effector is Σ_k c_k e^{iq_k}.
    pub fn arms(&self) -> &PerDrive {
        &self.arms
    }

    /// Returns the weights λ_k of b = Σ_k λ_k q_k, Eq. (13).
    pub fn lambda(&self) -> &PerDrive {
        &self.lambda
    }

    /// Returns Σλ.
    pub fn lambda_sum(&self) -> f64 {
        self.lambda_sum
    }

    /// Returns the inertia D_1, kg m²: the base moment is n_B = −D_1 b̈.
    pub fn inertia(&self) -> f64 {
        self.inertia
    }

    /// Whether holding b keeps the base free of moments exactly; if not, it removes most of them.
    pub fn is_reactionless(&self) -> bool {
        self.is_reactionless
    }

    /// Returns the n − 1 relative angles.
    pub fn joints(&self) -> &[RelativeJoint] {
        &self.joints
    }

    /// Whether the workspace at fixed b is an area, so that the b of a point form intervals. Otherwise it is a curve or
    /// a point, and each point has single values of b.
    pub fn reaches_area(&self) -> bool {
        self.joints.len() > 1
    }

    /// Checks whether the end effector can follow prescribed curves while b is held.
    ///
    /// # Errors
    /// If not: the reason.
    pub fn follows_curves(&self) -> Result<(), NotFollowable> {
        if self.reaches_area() { Ok(()) } else { Err(NotFollowable { drives: self.drives() }) }
    }

    /// Returns the period of b, 2π Σλ, rad: one turn of all drives changes b by a period and leaves the end effector in
    /// place.
    pub fn period(&self) -> f64 {
        TAU * self.lambda_sum
    }

    /// Returns the greatest distance from the base that the arms reach, m.
    pub fn farthest(&self) -> f64 {
        self.arms.iter().map(|c| c.abs()).sum()
    }

    /// Returns the least distance from the base, m: more than 0 if one arm is longer than all others together.
    pub fn nearest(&self) -> f64 {
        (2.0 * self.arms.max_abs() - self.farthest()).max(0.0)
    }

    /// Returns the drive angles of relative angles and b, rad. Never wrapped.
    pub fn lift(&self, a: &[f64], b: f64) -> DriveAngles {
        if let Some(map) = self.map() {
            return DriveAngles::from(map.lift(PlanePoint { a: [a[0], a[1]], b }));
        }
        let mut q = self.unturned(a);
        let turn = (b - self.lambda.dot(&q)) / self.lambda_sum;
        q.iter_mut().for_each(|q| *q += turn);
        DriveAngles(q)
    }

    /// Returns the drive rates for rates of the relative angles and ḃ, in their unit.
    pub fn lift_rates(&self, ad: &[f64], bd: f64) -> PerDrive {
        if let Some(map) = self.map() {
            return PerDrive::from(map.lift_rates([ad[0], ad[1]], bd));
        }
        let mut qd = PerDrive::zeros(self.drives());
        for (joint, ad) in self.joints.iter().zip(ad) {
            qd[joint.ends[1]] = qd[joint.ends[0]] + joint.sense * ad;
        }
        let turn = (bd - self.lambda.dot(&qd)) / self.lambda_sum;
        qd.iter_mut().for_each(|qd| *qd += turn);
        qd
    }

    /// Returns the rates of the relative angles for drive rates, in their unit.
    pub fn angle_rates(&self, qd: &[f64]) -> PerDrive {
        if let Some(map) = self.map() {
            return PerDrive::from(map.project_rates(qd).0);
        }
        PerDrive::from_fn(self.joints.len(), |i| {
            let RelativeJoint { ends, sense, .. } = self.joints[i];
            sense * (qd[ends[1]] - qd[ends[0]])
        })
    }

    /// Returns the bounds of a relative angle, rad; infinite if it turns freely.
    pub fn limits(&self, i: usize) -> [f64; 2] {
        self.joints[i].bounds()
    }

    /// Returns the angle by which b turns the workspace, rad.
    pub fn turn(&self, b: f64) -> f64 {
        b / self.lambda_sum
    }

    /// Returns the drive angles of relative angles with drive 1 at 0, rad.
    pub(super) fn unturned(&self, a: &[f64]) -> PerDrive {
        let mut q = PerDrive::zeros(self.drives());
        for (joint, a) in self.joints.iter().zip(a) {
            q[joint.ends[1]] = q[joint.ends[0]] + joint.sense * (a - joint.offset);
        }
        q
    }

    /// Returns the relative angles of a pose, rad, in the order of [`joints`](Self::joints).
    pub fn angles(&self, q: &[f64]) -> PerDrive {
        if let Some(map) = self.map() {
            return PerDrive::from(map.project(q).a);
        }
        PerDrive::from_fn(self.joints.len(), |i| self.joints[i].of(q))
    }

    /// Returns b of a pose, rad.
    pub fn b(&self, q: &[f64]) -> f64 {
        self.map().map_or_else(|| self.lambda.dot(q), |map| map.project(q).b)
    }

    /// Returns the relative angles and b of a pose, rad.
    pub fn project(&self, q: &[f64]) -> (PerDrive, f64) {
        (self.angles(q), self.b(q))
    }

    /// Returns the rates of the relative angles and ḃ for drive rates, in their unit.
    pub fn project_rates(&self, qd: &[f64]) -> (PerDrive, f64) {
        (self.angle_rates(qd), self.b(qd))
    }

    /// Returns the position of the end effector from B for relative angles and b, m.
    pub fn forward(&self, a: &[f64], b: f64) -> Vector {
        match self.map() {
            Some(map) => map.forward([a[0], a[1]], b),
            None => self.end_effector(&self.lift(a, b)),
        }
    }

    /// Returns the position of the end effector of a pose from B, m.
    pub fn end_effector(&self, q: &[f64]) -> Vector {
        self.arms.iter().zip(q).map(|(c, q)| *c * unit(*q)).sum()
    }

    /// Returns the midpoints of the limits of all relative angles, rad.
    pub fn middle(&self) -> PerDrive {
        PerDrive::from_fn(self.joints.len(), |i| 0.5 * (self.joints[i].limits[0] + self.joints[i].limits[1]))
    }
}

/// Orders the machine's relative angles as a tree from drive 1. Drives that they leave unconnected get a free joint to
/// drive 1.
fn joints(machine: &Machine) -> Result<Vec<RelativeJoint>, NoPoseSpace> {
    let n = machine.drives();
    let mut joints: Vec<RelativeJoint> = Vec::with_capacity(n - 1);
    let mut known = [false; MAX_DRIVES];
    known[0] = true;
    let mut used = vec![false; machine.angles().len()];
    loop {
        let next = machine.angles().iter().enumerate().find(|(i, a)| !used[*i] && known[a.to] != known[a.from]);
        if let Some((i, a)) = next {
            let (ends, sense) = if known[a.from] { ([a.from, a.to], 1.0) } else { ([a.to, a.from], -1.0) };
            let limits = window(*a.limits.start(), *a.limits.end());
            let width = limits[1] - limits[0];
            if width > MAX_LIMIT_RANGE {
                return Err(NoPoseSpace::TooWide { angle: a.name.clone(), width });
            }
            known[ends[1]] = true;
            used[i] = true;
            let free = !(a.limits.start().is_finite() && a.limits.end().is_finite());
            joints.push(RelativeJoint { ends, sense, offset: a.offset, limits, free, angle: Some(i) });
        } else if let Some(k) = (0..n).find(|k| !known[*k]) {
            known[k] = true;
            joints.push(RelativeJoint {
                ends: [0, k],
                sense: 1.0,
                offset: 0.0,
                limits: [-PI, PI],
                free: true,
                angle: None,
            });
        } else {
            break;
        }
    }
    match used.iter().position(|used| !used) {
        Some(i) => Err(NoPoseSpace::Loop { angle: machine.angles()[i].name.clone() }),
        None => Ok(joints),
    }
}

/// Returns the given limits, or [−π, π] if one of them is infinite.
fn window(min: f64, max: f64) -> [f64; 2] {
    if min.is_finite() && max.is_finite() { [min, max] } else { [-PI, PI] }
}
