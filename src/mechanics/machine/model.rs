//! [`Machine`]: a description that has been checked, with what follows from it.

use std::ops::RangeInclusive;
use std::sync::Arc;

use super::Chain;
use super::motors::Motors;
use super::spec::{Link, MachineSpec};
use crate::mechanics::planar::{MAX_DRIVES, Vector};

/// A valid machine; copies share what they hold, so they are made and told from others at once.
#[derive(Clone, Debug)]
pub struct Machine(Arc<Model>);

/// What a machine holds.
#[derive(Debug, PartialEq)]
pub(super) struct Model {
    pub(super) spec: MachineSpec,
    pub(super) bodies: Vec<Link>,
    pub(super) parts: Vec<ResolvedLink>,
    pub(super) end_effector: Chain,
    pub(super) end_link: usize,
    pub(super) angles: Vec<RelativeAngle>,
    pub(super) loops: Vec<ResolvedClosure>,
    pub(super) motors: Motors,
}

/// What is derived of a link.
#[derive(Clone, Debug, PartialEq)]
pub struct ResolvedLink {
    /// The drive whose orientation it has, counted from 0.
    pub drive: usize,
    /// ±1: along or against e(q).
    pub sign: f64,
    /// Root to tip, m.
    pub length: f64,
    /// Its root.
    pub root: Chain,
    /// The link its root is pinned to; none: the base.
    pub parent: Option<usize>,
    /// How far from the root of that link, m; 0 on the base.
    pub at: f64,
    /// Where pins sit along it, m from the root, in rising order and without repetition.
    pub pins: Vec<f64>,
}

/// A relative joint angle, resolved: a = q_to − q_from + offset.
#[derive(Clone, Debug, PartialEq)]
pub struct RelativeAngle {
    /// Its name.
    pub name: String,
    /// Drive, counted from 0.
    pub to: usize,
    /// Drive, counted from 0.
    pub from: usize,
    /// rad.
    pub offset: f64,
    /// rad.
    pub limits: RangeInclusive<f64>,
}

/// A closure, resolved: a point of link `a` is pinned to a point of link `b`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResolvedClosure {
    /// A link.
    pub a: usize,
    /// Where on it, m from its root.
    pub at_a: f64,
    /// Another link.
    pub b: usize,
    /// Where on that, m from its root.
    pub at_b: f64,
}

impl ResolvedLink {
    /// The point `s` metres from the root.
    pub fn point(&self, s: f64) -> Chain {
        let mut c = self.root;
        c[self.drive] += self.sign * s;
        c
    }
}

impl From<Model> for Machine {
    fn from(model: Model) -> Self {
        Self(Arc::new(model))
    }
}

impl PartialEq for Machine {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl Machine {
    /// What it was made of.
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

    /// Whether a place of the end effector leaves the drives freedoms.
    pub fn is_redundant(&self) -> bool {
        self.redundancy() > 0
    }

    /// How many freedoms of the drives a place of the end effector leaves; holding b takes one of them.
    pub fn redundancy(&self) -> usize {
        self.drives().saturating_sub(2)
    }

    /// Its links, each with the counterweights that it carries as one body; as described where it carries none.
    pub fn links(&self) -> &[Link] {
        &self.0.bodies
    }

    /// Its links as resolved, in the same order.
    pub fn resolved_links(&self) -> &[ResolvedLink] {
        &self.0.parts
    }

    /// The end effector as a sum of unit vectors, (14).
    pub fn end_effector(&self) -> &Chain {
        &self.0.end_effector
    }

    /// How far the end effector can be from B at most, Σ |L_k|, m.
    pub fn reach(&self) -> f64 {
        self.0.end_effector.iter().map(|length| length.abs()).sum()
    }

    /// The link that carries the end effector.
    pub fn end_link(&self) -> usize {
        self.0.end_link
    }

    /// Relative joint angles and their limits.
    pub fn angles(&self) -> &[RelativeAngle] {
        &self.0.angles
    }

    /// Its closures as resolved, in the order of the file.
    pub fn loops(&self) -> &[ResolvedClosure] {
        &self.0.loops
    }

    /// Where its motors sit.
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

    /// The CM of link j as Σ_k a_jk e(q_k), complex where the CM lies off the link's axis.
    pub fn com_chain(&self, j: usize) -> [Vector; MAX_DRIVES] {
        let (link, part) = (&self.0.bodies[j], &self.0.parts[j]);
        let mut a = part.root.map(|w| Vector::new(w, 0.0));
        a[part.drive] += part.sign * Vector::new(link.com, link.com_normal);
        a
    }

    /// For every pin that closes a loop, how its one description differs from the other: a sum of unit vectors that is
    /// zero in every pose.
    pub fn closure_gaps(&self) -> Vec<Chain> {
        let gap = |l: &ResolvedClosure| {
            let (a, b) = (self.0.parts[l.a].point(l.at_a), self.0.parts[l.b].point(l.at_b));
            std::array::from_fn(|k| a[k] - b[k])
        };
        self.0.loops.iter().map(gap).collect()
    }

    /// The centre of mass of the payload as a sum of unit vectors, complex where it lies off the link's axis.
    pub fn payload_chain(&self) -> [Vector; MAX_DRIVES] {
        let (part, [along, left]) = (&self.0.parts[self.0.end_link], self.0.spec.payload.offset);
        let mut a = self.0.end_effector.map(|w| Vector::new(w, 0.0));
        a[part.drive] += part.sign * Vector::new(along, left);
        a
    }
}
