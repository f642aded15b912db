//! [`PoseSpace`]: coordinates (a, b) of the poses of any machine that has a pose constant.
//!
//! Three drives with limits of both relative angles have [`Planes`], which know most in closed form: where a space has
//! them, it answers by them. Which of the two ways answers is decided inside of this module only.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use super::joint::Joint;
use super::lacking::{NoPoseSpace, OwnWay, held, is_reactionless};
use super::pattern::{Pattern, Patterns};
use super::planes::{PlaneError, Planes, plane_map};
use crate::mechanics::machine::{Inertia, Machine};
use crate::mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector, unit};
use crate::planning::reactionless::{PlaneMap, PlanePoint, WIDEST};

/// A point as near to B as this, as a share of the reach, is B: the workspace turned about it.
pub(super) const AT_BASE: f64 = 1e-12;

/// The poses of a machine by its relative angles and b.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseSpace {
    pub(super) tip: PerDrive,
    pub(super) lambda: PerDrive,
    pub(super) sum: f64,
    /// Each after the joint that leads to its nearer drive.
    pub(super) joints: Box<[Joint]>,
    pub(super) lead: Lead,
    inertia: f64,
    is_reactionless: bool,
    /// Of these arms and joints: a space of others has its own.
    pub(super) patterns: Patterns,
    /// What is known in closed form.
    planes: Result<Arc<Planes>, PlaneError>,
}

/// What a hand that leads the end effector makes of the freedoms that are left.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Lead {
    /// Every step takes the least kinetic energy.
    #[default]
    LeastEnergy,
    /// A drive keeps its angle, and so its links their orientation, while there is a way to.
    Keep(usize),
    /// Every step is the least by a weight; here its inverse, row by row.
    Weighed(Box<[[f64; MAX_DRIVES]; MAX_DRIVES]>),
    /// The pose that is nearest to the middle of all ranges is gone to.
    Middle,
}

impl PoseSpace {
    /// Of a machine whose D is constant, or nearly.
    ///
    /// # Errors
    /// Why it has no b.
    pub fn of(machine: &Machine) -> Result<Self, NoPoseSpace> {
        Self::holding(machine, Planes::of(machine).map(Arc::new))
    }

    /// The same by the way of any number of drives, for three drives too: the twin of their closed forms in tests.
    ///
    /// # Errors
    /// Why it has no b.
    pub fn general(machine: &Machine) -> Result<Self, NoPoseSpace> {
        Self::holding(machine, Err(PlaneError::LeftOut))
    }

    fn holding(machine: &Machine, planes: Result<Arc<Planes>, PlaneError>) -> Result<Self, NoPoseSpace> {
        let inertia = held(machine)?;
        Self::with(machine, inertia.lambda(), inertia.pose_inertia(), planes)
    }

    /// The same by what each drive has to turn alone, H_kk, where D depends on the pose or is nothing: its b only tells
    /// poses of a point apart.
    ///
    /// # Errors
    /// If the angles or arms give no coordinates.
    pub fn nominal(machine: &Machine) -> Result<Self, NoPoseSpace> {
        let inertia = Inertia::of(machine);
        let h = inertia.diagonals();
        Self::with(machine, h.scaled(1.0 / h[0]), h[0], Err(plane_map(machine).err().unwrap_or(PlaneError::LeftOut)))
    }

    fn with(
        machine: &Machine,
        lambda: PerDrive,
        inertia: f64,
        planes: Result<Arc<Planes>, PlaneError>,
    ) -> Result<Self, NoPoseSpace> {
        let sum: f64 = lambda.iter().sum();
        let tip = PerDrive::from_fn(machine.drives(), |k| machine.end_effector()[k]);
        let reach: f64 = tip.iter().map(|c| c.abs()).sum();
        let mut joints = joints(machine)?;
        match &planes {
            // Planes have checks of their own, and count angles as the machine does.
            Ok(_) => joints.sort_by_key(|joint| joint.angle),
            Err(_) if sum.partial_cmp(&1e-9) != Some(std::cmp::Ordering::Greater) => {
                return Err(NoPoseSpace::Sum { sum });
            }
            Err(_) if !(1e-9..=1e9).contains(&reach) => return Err(NoPoseSpace::Size { reach }),
            Err(_) => {}
        }
        Ok(Self {
            tip,
            lambda,
            sum,
            joints: joints.into(),
            lead: Lead::LeastEnergy,
            inertia,
            is_reactionless: is_reactionless(machine),
            patterns: Patterns::default(),
            planes,
        })
    }

    /// The same, led otherwise.
    #[must_use]
    pub fn led(self, lead: Lead) -> Self {
        Self { lead, ..self }
    }

    /// The same, with ways that lead across change points or keep off them, where it has planes.
    #[must_use]
    pub fn keeping_off_change_points(self, keep_off: bool) -> Self {
        let kept = |planes: Arc<Planes>| match planes.keep_off_change_points() == keep_off {
            true => planes,
            false => Arc::new(Planes::clone(&planes).keeping_off_change_points(keep_off)),
        };
        Self { planes: self.planes.map(kept), ..self }
    }

    /// What only three drives with limits of both relative angles have: sheets, folds, change points and Eq. (16).
    ///
    /// # Errors
    /// Why there are none.
    pub fn planes(&self) -> Result<&Arc<Planes>, &PlaneError> {
        self.planes.as_ref()
    }

    /// Eqs (13)–(16), where they answer.
    #[inline]
    pub(super) fn map(&self) -> Option<&PlaneMap> {
        self.planes.as_ref().ok().map(|planes| planes.map())
    }

    /// Every choice of limits and signs for which b can be stationary: made once, at the first point that is asked for.
    pub(super) fn patterns(&self) -> &[Pattern] {
        self.patterns.of(&self.tip, &self.lambda, &self.joints)
    }

    /// Number of drives.
    pub fn drives(&self) -> usize {
        self.tip.len()
    }

    /// c_k, m: the end effector is Σ_k c_k e^{iq_k}.
    pub fn tip(&self) -> &PerDrive {
        &self.tip
    }

    /// λ_k.
    pub fn lambda(&self) -> &PerDrive {
        &self.lambda
    }

    /// Σλ.
    pub fn lambda_sum(&self) -> f64 {
        self.sum
    }

    /// n_B = −D_1 b̈, kg m².
    pub fn inertia(&self) -> f64 {
        self.inertia
    }

    /// Whether holding b keeps every moment from the base; where not, it keeps most of it.
    pub fn is_reactionless(&self) -> bool {
        self.is_reactionless
    }

    /// The relative angles, n − 1 of them.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Whether what is reached while b is held is an area, whose points are reached by ranges of b; else it is a curve or
    /// one place, and each point has its b.
    pub fn reaches_area(&self) -> bool {
        self.joints.len() > 1
    }

    /// Whether the end effector can follow curves while b is held.
    ///
    /// # Errors
    /// Why not.
    pub fn follows_curves(&self) -> Result<(), OwnWay> {
        if self.reaches_area() { Ok(()) } else { Err(OwnWay { drives: self.drives() }) }
    }

    /// Turning all drives once adds this to b and changes nothing else: 2π Σλ, rad.
    pub fn period(&self) -> f64 {
        TAU * self.sum
    }

    /// How far the arms reach at most, m.
    pub fn farthest(&self) -> f64 {
        self.tip.iter().map(|c| c.abs()).sum()
    }

    /// How near the longest arm lets them come to the base, m.
    pub fn nearest(&self) -> f64 {
        (2.0 * self.tip.max_abs() - self.farthest()).max(0.0)
    }

    /// Drive angles of relative angles on b. Never wrapped.
    pub fn lift(&self, a: &[f64], b: f64) -> DriveAngles {
        if let Some(map) = self.map() {
            return DriveAngles::from(map.lift(PlanePoint { a: [a[0], a[1]], b }));
        }
        let mut q = self.unturned(a);
        let turn = (b - self.lambda.dot(&q)) / self.sum;
        q.iter_mut().for_each(|q| *q += turn);
        DriveAngles(q)
    }

    /// Rates of the drives for rates of the relative angles and ḃ.
    pub fn lift_rates(&self, ad: &[f64], bd: f64) -> PerDrive {
        if let Some(map) = self.map() {
            return PerDrive::from(map.lift_rates([ad[0], ad[1]], bd));
        }
        let mut qd = PerDrive::zeros(self.drives());
        for (joint, ad) in self.joints.iter().zip(ad) {
            qd[joint.ends[1]] = qd[joint.ends[0]] + joint.sense * ad;
        }
        let turn = (bd - self.lambda.dot(&qd)) / self.sum;
        qd.iter_mut().for_each(|qd| *qd += turn);
        qd
    }

    /// Rates of the relative angles for rates of the drives.
    pub fn angle_rates(&self, qd: &[f64]) -> PerDrive {
        if let Some(map) = self.map() {
            return PerDrive::from(map.project_rates(qd).0);
        }
        PerDrive::from_fn(self.joints.len(), |i| {
            let Joint { ends, sense, .. } = self.joints[i];
            sense * (qd[ends[1]] - qd[ends[0]])
        })
    }

    /// Least and greatest value of a relative angle, rad; infinite where it turns freely.
    pub fn limits(&self, i: usize) -> [f64; 2] {
        self.joints[i].bounds()
    }

    /// How far the workspace is turned at b, rad.
    pub fn turn(&self, b: f64) -> f64 {
        b / self.sum
    }

    /// Drive angles with drive 1 at 0.
    pub(super) fn unturned(&self, a: &[f64]) -> PerDrive {
        let mut q = PerDrive::zeros(self.drives());
        for (joint, a) in self.joints.iter().zip(a) {
            q[joint.ends[1]] = q[joint.ends[0]] + joint.sense * (a - joint.offset);
        }
        q
    }

    /// Relative angles of a pose, in the order of [`joints`](Self::joints).
    pub fn angles(&self, q: &[f64]) -> PerDrive {
        if let Some(map) = self.map() {
            return PerDrive::from(map.project(q).a);
        }
        PerDrive::from_fn(self.joints.len(), |i| self.joints[i].of(q))
    }

    /// b of a pose, rad.
    pub fn b(&self, q: &[f64]) -> f64 {
        self.map().map_or_else(|| self.lambda.dot(q), |map| map.project(q).b)
    }

    /// Relative angles and b of a pose, rad.
    pub fn project(&self, q: &[f64]) -> (PerDrive, f64) {
        (self.angles(q), self.b(q))
    }

    /// Rates of the relative angles and ḃ for rates of the drives.
    pub fn project_rates(&self, qd: &[f64]) -> (PerDrive, f64) {
        (self.angle_rates(qd), self.b(qd))
    }

    /// The end effector of relative angles on b, m.
    pub fn forward(&self, a: &[f64], b: f64) -> Vector {
        match self.map() {
            Some(map) => map.forward([a[0], a[1]], b),
            None => self.place(&self.lift(a, b)),
        }
    }

    /// The end effector, m.
    pub fn place(&self, q: &[f64]) -> Vector {
        self.tip.iter().zip(q).map(|(c, q)| *c * unit(*q)).sum()
    }

    /// Relative angles in the middle of their limits, rad.
    pub fn middle(&self) -> PerDrive {
        PerDrive::from_fn(self.joints.len(), |i| 0.5 * (self.joints[i].limits[0] + self.joints[i].limits[1]))
    }
}

/// The machine's angles as a tree that grows from drive 1; where they leave drives apart, a free joint between these.
fn joints(machine: &Machine) -> Result<Vec<Joint>, NoPoseSpace> {
    let n = machine.drives();
    let mut joints: Vec<Joint> = Vec::with_capacity(n - 1);
    let mut known = [false; MAX_DRIVES];
    known[0] = true;
    let mut used = vec![false; machine.angles().len()];
    loop {
        let next = machine.angles().iter().enumerate().find(|(i, a)| !used[*i] && known[a.to] != known[a.from]);
        if let Some((i, a)) = next {
            let (ends, sense) = if known[a.from] { ([a.from, a.to], 1.0) } else { ([a.to, a.from], -1.0) };
            let limits = window(*a.limits.start(), *a.limits.end());
            let width = limits[1] - limits[0];
            if width > WIDEST {
                return Err(NoPoseSpace::TooWide { angle: a.name.clone(), width });
            }
            known[ends[1]] = true;
            used[i] = true;
            let free = !(a.limits.start().is_finite() && a.limits.end().is_finite());
            joints.push(Joint { ends, sense, offset: a.offset, limits, free, angle: Some(i) });
        } else if let Some(k) = (0..n).find(|k| !known[*k]) {
            known[k] = true;
            joints.push(Joint { ends: [0, k], sense: 1.0, offset: 0.0, limits: [-PI, PI], free: true, angle: None });
        } else {
            break;
        }
    }
    match used.iter().position(|used| !used) {
        Some(i) => Err(NoPoseSpace::Loop { angle: machine.angles()[i].name.clone() }),
        None => Ok(joints),
    }
}

/// Limits as they are; one turn about 0 where there are none.
fn window(min: f64, max: f64) -> [f64; 2] {
    if min.is_finite() && max.is_finite() { [min, max] } else { [-PI, PI] }
}
