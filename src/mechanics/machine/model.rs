//! [`Machine`]: a checked specification with the quantities derived from it.

use std::ops::RangeInclusive;
use std::sync::Arc;

use super::Chain;
use super::check::place_on_link;
use super::error::{KeyPath, MachineError};
use super::motors::Motors;
use super::parts::{PartBody, PartSource, PlaneBody, sum_of};
use super::spec::{Link, MachineSpec, PlaceOnLink};
use crate::planar::{MAX_DRIVES, Vector};

/// A valid machine. Copies share their data, so that copying a machine and comparing copies are cheap.
#[derive(Clone, Debug)]
pub struct Machine(Arc<MachineData>);

/// Data of a machine.
#[derive(Debug, PartialEq)]
pub(super) struct MachineData {
    pub(super) spec: MachineSpec,
    pub(super) bodies: Vec<Link>,
    pub(super) part_bodies: Vec<PartBody>,
    pub(super) parts: Vec<ResolvedLink>,
    pub(super) end_effector: Chain,
    pub(super) end_link: usize,
    pub(super) angles: Vec<RelativeAngle>,
    pub(super) loops: Vec<ResolvedClosure>,
    pub(super) motors: Motors,
}

/// Quantities derived from the specification of a link.
#[derive(Clone, Debug, PartialEq)]
pub struct ResolvedLink {
    /// The drive whose orientation it has, counted from 0. The number of drives stands for the ground, which never turns.
    pub drive: usize,
    /// Direction of the link: +1 along e(q), −1 against it.
    pub sign: f64,
    /// Length from root to tip, m.
    pub length: f64,
    /// Position of its root, m.
    pub root: Chain,
    /// The link to which its root is pinned; `None` for the base.
    pub parent: Option<usize>,
    /// Position of its root along the parent, from the parent's root, m; 0 on the base.
    pub at: f64,
    /// Positions of pins along it, from the root, m, in ascending order without duplicates.
    pub pins: Vec<f64>,
}

/// A relative joint angle, resolved: a = q_to − q_from + offset.
#[derive(Clone, Debug, PartialEq)]
pub struct RelativeAngle {
    /// Its name.
    pub name: String,
    /// Index of the drive whose angle is added, from 0.
    pub to: usize,
    /// Index of the drive whose angle is subtracted, from 0.
    pub from: usize,
    /// Offset, rad.
    pub offset: f64,
    /// Limits, rad; infinite if there are none.
    pub limits: RangeInclusive<f64>,
}

impl RelativeAngle {
    /// Returns its value at drive angles q, rad.
    #[inline]
    pub fn value(&self, q: &[f64]) -> f64 {
        q[self.to] - q[self.from] + self.offset
    }

    /// Returns how far drive angles q take it past its limits, rad; below 0 within them.
    #[inline]
    pub fn past_limit(&self, q: &[f64]) -> f64 {
        let value = self.value(q);
        (self.limits.start() - value).max(value - self.limits.end())
    }
}

/// A closure, resolved: a point of link `a` is pinned to a point of link `b`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResolvedClosure {
    /// Index of the first link.
    pub a: usize,
    /// Position of the pin along link `a`, from its root, m.
    pub at_a: f64,
    /// Index of the second link.
    pub b: usize,
    /// Position of the pin along link `b`, from its root, m.
    pub at_b: f64,
}

impl ResolvedLink {
    /// Returns the point at distance `s`, m, from the root.
    pub fn point(&self, s: f64) -> Chain {
        let mut c = self.root;
        c[self.drive] += self.sign * s;
        c
    }
}

impl From<MachineData> for Machine {
    fn from(model: MachineData) -> Self {
        Self(Arc::new(model))
    }
}

impl PartialEq for Machine {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl Machine {
    /// Returns the specification of the machine.
    pub fn spec(&self) -> &MachineSpec {
        &self.0.spec
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.0.spec.name
    }

    /// Number of drives n.
    pub fn drives(&self) -> usize {
        self.0.spec.drives.len()
    }

    /// Returns the index that stands for the ground if links keep their orientation: the number of drives, at which unit
    /// vectors are 1 and rates 0. `None` if every link follows a drive.
    pub fn ground(&self) -> Option<usize> {
        let n = self.drives();
        self.0.parts.iter().any(|part| part.drive == n).then_some(n)
    }

    /// Checks that all links follow drives; `what` takes no other machines, in the plural.
    ///
    /// # Errors
    /// If a link keeps its orientation.
    pub fn check_all_turn(&self, what: &'static str) -> Result<(), MachineError> {
        let ground = (0..self.links().len()).find(|j| self.drive_of_link(*j).is_none());
        ground.map_or(Ok(()), |j| Err(MachineError::Ground { link: self.links()[j].name.clone(), what }))
    }

    /// Returns the drive that a link follows; `None` if it keeps its orientation.
    pub fn drive_of_link(&self, j: usize) -> Option<usize> {
        Some(self.0.parts[j].drive).filter(|drive| *drive < self.drives())
    }

    /// Returns whether the drives keep degrees of freedom when the end effector is held in place.
    pub fn is_redundant(&self) -> bool {
        self.redundancy() > 0
    }

    /// Returns the number of degrees of freedom that the drives keep when the end effector is held in place. Keeping b
    /// constant removes one of them.
    pub fn redundancy(&self) -> usize {
        self.drives().saturating_sub(2)
    }

    /// Returns its links, each combined with the counterweights that it carries.
    pub fn links(&self) -> &[Link] {
        &self.0.bodies
    }

    /// Returns the derived quantities of its links, in the order of [`links`](Self::links).
    pub fn resolved_links(&self) -> &[ResolvedLink] {
        &self.0.parts
    }

    /// The position of the end effector, (14), as weights of unit vectors, m.
    pub fn end_effector(&self) -> &Chain {
        &self.0.end_effector
    }

    /// Returns an upper bound of the end effector's distance from B, m: the sum of the magnitudes of its weights.
    pub fn reach(&self) -> f64 {
        self.0.end_effector.iter().map(|length| length.abs()).sum()
    }

    /// Returns what every part and lump brings, parts first, in the order of the file.
    pub fn part_bodies(&self) -> &[PartBody] {
        &self.0.part_bodies
    }

    /// Returns where a part begins and ends along its link, m from the root, in ascending order; `None` if there is no
    /// such part.
    pub fn part_ends(&self, part: usize) -> Option<[f64; 2]> {
        let body = self.0.part_bodies.iter().find(|body| body.source == PartSource::Part(part))?;
        Some([body.ends[0].min(body.ends[1]), body.ends[0].max(body.ends[1])])
    }

    /// Returns all parts and lumps of a link combined; `None` if it has none. Typed numbers of the link overrule it.
    pub fn parts_of_link(&self, link: usize) -> Option<PlaneBody> {
        sum_of(&self.0.part_bodies, link)
    }

    /// Returns a place on a link, m from its root; `None` if there is no such link or length.
    pub fn place_on(&self, link: &str, place: &PlaceOnLink) -> Option<f64> {
        let i = self.spec().link_index(link)?;
        place_on_link(self.spec(), i, place, KeyPath::default).ok()
    }

    /// Returns the index of the link that carries the end effector.
    pub fn end_link(&self) -> usize {
        self.0.end_link
    }

    /// Relative joint angles and their limits.
    pub fn angles(&self) -> &[RelativeAngle] {
        &self.0.angles
    }

    /// Returns its closures, resolved, in the order of the file.
    pub fn loops(&self) -> &[ResolvedClosure] {
        &self.0.loops
    }

    /// Returns the placement of its motors.
    pub fn motors(&self) -> &Motors {
        &self.0.motors
    }

    /// Acceleration of gravity, m/s².
    pub fn gravity(&self) -> Vector {
        Vector::new(self.0.spec.gravity[0], self.0.spec.gravity[1])
    }

    /// Total mass with payload, kg.
    pub fn mass(&self) -> f64 {
        self.0.bodies.iter().map(|l| l.mass).sum::<f64>() + self.0.spec.payload.mass
    }

    /// Returns the coefficients a_jk, m, of the CM Σ_k a_jk e(q_k) of link j; they are complex if the CM lies off the
    /// link's axis.
    pub fn com_chain(&self, j: usize) -> [Vector; MAX_DRIVES] {
        let (link, part) = (&self.0.bodies[j], &self.0.parts[j]);
        let mut a = part.root.map(|w| Vector::new(w, 0.0));
        a[part.drive] += part.sign * Vector::new(link.com, link.com_normal);
        a
    }

    /// Returns the difference of the two points of each closure as weights of unit vectors, m; it is zero to rounding.
    pub fn closure_gaps(&self) -> Vec<Chain> {
        let gap = |l: &ResolvedClosure| {
            let (a, b) = (self.0.parts[l.a].point(l.at_a), self.0.parts[l.b].point(l.at_b));
            std::array::from_fn(|k| a[k] - b[k])
        };
        self.0.loops.iter().map(gap).collect()
    }

    /// Returns the coefficients, m, of the payload's centre of mass as a sum of unit vectors; they are complex if it
    /// lies off the link's axis.
    pub fn payload_chain(&self) -> [Vector; MAX_DRIVES] {
        let (part, [along, left]) = (&self.0.parts[self.0.end_link], self.0.spec.payload.offset);
        let mut a = self.0.end_effector.map(|w| Vector::new(w, 0.0));
        a[part.drive] += part.sign * Vector::new(along, left);
        a
    }
}
