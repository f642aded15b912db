//! [`PoseSpace`]: coordinates (a, b) of the poses of any machine that has a pose constant.

use std::f64::consts::{PI, TAU};

use thiserror::Error;

use super::joint::Joint;
use super::pattern::{Pattern, Patterns};
use crate::mechanics::machine::{Inertia, Machine};
use crate::mechanics::planar::{DriveAngles, MAX_DRIVES, PerDrive, Vector, unit};
use crate::planning::reactionless::WIDEST;
use crate::settings::number::{Short, significant};

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

/// Why a machine has no pose constant, in words.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoPoseSpace {
    /// D depends on the pose.
    #[error(
        "this machine has no pose constant b: its angular momentum depends on the pose, because drives {} and {} are \
         coupled by {} kg m², most of it through link {link}; `stillbase design` finds centres of mass that undo it{}",
        .pair[0], .pair[1], significant(*residual), if *.only { ONLY_TWO } else { "" }
    )]
    Varies {
        /// The drives that are coupled most, counted from 1.
        pair: [usize; 2],
        /// |C_kl|, kg m².
        residual: f64,
        /// The link that contributes most.
        link: String,
        /// Whether there are only these two drives.
        only: bool,
    },
    /// Every D_k is 0.
    #[error("every motion of this machine is reactionless, as no drive turns the base: there is no b to hold")]
    Free,
    /// Turning the machine as a whole changes b the wrong way, or not at all.
    #[error(
        "turned as a whole, this machine changes b by Σλ = {}: want it above 0, with rotors that turn the other way less \
         fast or lighter", Short(*sum)
    )]
    Sum {
        /// Σλ.
        sum: f64,
    },
    /// The relative angles bind each other.
    #[error(
        "angle {angle:?} joins drives that the angles before it join already: want at most one way between two drives \
         for reactionless planes"
    )]
    Loop {
        /// The angle.
        angle: String,
    },
    /// Limits too far apart to count windings one by one.
    #[error("angle {angle:?} may turn by {width:.2} rad: want limits at most eight turns apart, {WIDEST} rad")]
    TooWide {
        /// The angle.
        angle: String,
        /// max − min, rad.
        width: f64,
    },
    /// An arm that is nothing, or all of them.
    #[error("the arms reach {} m: want a reach of 1e-9 to 1e9 m", Short(*reach))]
    Size {
        /// Σ |c_k|, m.
        reach: f64,
    },
}

/// Two drives keep something even so: see [`b_integral`](crate::planning::off_plane::b_integral).
const ONLY_TWO: &str = "; without a moment its two drives keep q₁ plus an integral over q₂ − q₁, which is not offered as \
                        b, because its λ changes with the pose";

/// Up to this share λ changes so little that to hold b keeps most of the moment from the base.
const NEARLY: f64 = 0.1;

/// Whether holding Σ λ_k q_k keeps every moment from the base.
pub(crate) fn is_reactionless(machine: &Machine) -> bool {
    Inertia::of(machine).is_invariant()
}

/// The inertia of a machine with λ that are constant, or nearly.
///
/// # Errors
/// Why it has none.
pub(crate) fn held(machine: &Machine) -> Result<Inertia, NoPoseSpace> {
    let inertia = Inertia::of(machine);
    if inertia.pose_dependence() > NEARLY {
        return Err(varies(machine, &inertia));
    }
    if inertia.pose_inertia() == 0.0 {
        return Err(NoPoseSpace::Free);
    }
    Ok(inertia)
}

impl PoseSpace {
    /// Of a machine whose D is constant, or nearly.
    ///
    /// # Errors
    /// Why it has no b.
    pub fn of(machine: &Machine) -> Result<Self, NoPoseSpace> {
        let inertia = held(machine)?;
        Self::with(machine, inertia.lambda(), inertia.pose_inertia())
    }

    /// The same by what each drive has to turn alone, H_kk, where D depends on the pose or is nothing: its b only tells
    /// poses of a point apart.
    ///
    /// # Errors
    /// If the angles or arms give no coordinates.
    pub fn nominal(machine: &Machine) -> Result<Self, NoPoseSpace> {
        let inertia = Inertia::of(machine);
        let h = inertia.diagonals();
        Self::with(machine, h.scaled(1.0 / h[0]), h[0])
    }

    fn with(machine: &Machine, lambda: PerDrive, inertia: f64) -> Result<Self, NoPoseSpace> {
        let n = machine.drives();
        let sum: f64 = lambda.iter().sum();
        if sum.partial_cmp(&1e-9) != Some(std::cmp::Ordering::Greater) {
            return Err(NoPoseSpace::Sum { sum });
        }
        let tip = PerDrive::from_fn(n, |k| machine.end_effector()[k]);
        let reach: f64 = tip.iter().map(|c| c.abs()).sum();
        if !(1e-9..=1e9).contains(&reach) {
            return Err(NoPoseSpace::Size { reach });
        }
        let joints = joints(machine)?.into();
        Ok(Self {
            tip,
            lambda,
            sum,
            joints,
            lead: Lead::LeastEnergy,
            inertia,
            is_reactionless: is_reactionless(machine),
            patterns: Patterns::default(),
        })
    }

    /// The same, led otherwise.
    #[must_use]
    pub fn led(self, lead: Lead) -> Self {
        Self { lead, ..self }
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
        let mut q = self.unturned(a);
        let turn = (b - self.lambda.dot(&q)) / self.sum;
        q.iter_mut().for_each(|q| *q += turn);
        DriveAngles(q)
    }

    /// Rates of the drives for rates of the relative angles and ḃ.
    pub fn lift_rates(&self, ad: &[f64], bd: f64) -> PerDrive {
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
        PerDrive::from_fn(self.joints.len(), |i| {
            let Joint { ends, sense, .. } = self.joints[i];
            sense * (qd[ends[1]] - qd[ends[0]])
        })
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
        PerDrive::from_fn(self.joints.len(), |i| self.joints[i].of(q))
    }

    /// b of a pose, rad.
    pub fn b(&self, q: &[f64]) -> f64 {
        self.lambda.dot(q)
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

/// The drives that are coupled most, and the link that contributes most to that.
fn varies(machine: &Machine, inertia: &Inertia) -> NoPoseSpace {
    let n = machine.drives();
    let coupled = |(k, l): &(usize, usize)| inertia.coupling(*k, *l).norm();
    let (k, l) = Inertia::pairs(n).max_by(|x, y| coupled(x).total_cmp(&coupled(y))).unwrap_or((0, 0));
    let whole = inertia.coupling(k, l);
    let part = |j: &usize| {
        let a = machine.com_chain(*j);
        // As far as it adds to the sum, rather than taking from it.
        (machine.links()[*j].mass * a[k].conj() * a[l] * whole.conj()).re
    };
    let most = (0..machine.links().len()).max_by(|i, j| part(i).total_cmp(&part(j))).unwrap_or(0);
    let link = machine.links()[most].name.clone();
    NoPoseSpace::Varies { pair: [k + 1, l + 1], residual: whole.norm(), link, only: n == 2 }
}
