//! [`Besides`]: what URDF has no word for.

use std::collections::BTreeMap;

use nalgebra::{Point3, Vector3};
use roxmltree::Node;

use crate::exchange::import::linkage::{Limit, Motor, Part, Point, owners};
use crate::exchange::import::read::{each, given, number, word};
use crate::exchange::import::refusal::{ImportError, wrong};
use crate::exchange::urdf::meet;
use crate::settings::range::clipped;

/// Rates, and limits in rad, that differ by less are the same.
pub(super) const SAME: f64 = 1e-9;
/// The most joints: what this program writes of the largest machine has fewer.
pub(super) const MAX_JOINTS: usize = 4000;

/// What this program writes beside URDF: `<stillbase>`.
pub(super) struct Besides<'a> {
    pub(super) robot: Node<'a, 'a>,
    /// Joints that move by themselves, as motors are counted.
    pub(super) joints: Vec<Node<'a, 'a>>,
    /// Parts by the names of their links.
    pub(super) links: BTreeMap<&'a str, usize>,
}

impl<'a> Besides<'a> {
    fn each(&self, name: &'static str) -> impl Iterator<Item = Node<'a, 'a>> + use<'a> {
        each(self.robot, "stillbase").flat_map(move |node| each(node, name))
    }

    /// The motor of the joint that an attribute names.
    fn motor(&self, node: Node<'a, 'a>, attribute: &'static str) -> Result<usize, ImportError> {
        let name = word(node, attribute)?;
        let known = self.joints.iter().position(|joint| joint.attribute("name") == Some(name));
        let what = || format!("no joint \"{}\" moves by itself", clipped(name));
        known.ok_or_else(|| wrong(node, what(), "the name of one that does"))
    }

    pub(super) fn gravity(&self) -> Result<Vector3<f64>, ImportError> {
        let Some(node) = self.each("gravity").next() else { return Ok(Vector3::zeros()) };
        Ok(Vector3::new(number(node, "x")?.unwrap_or(0.0), number(node, "y")?.unwrap_or(0.0), 0.0))
    }

    /// Adds limits of angles between what two joints turn; what says the same as a joint takes its place.
    pub(super) fn limits(&self, limits: &mut Vec<Limit>) -> Result<(), ImportError> {
        let mut own = Vec::new();
        for node in self.each("angle").take(MAX_JOINTS) {
            let (to, from) = (self.motor(node, "to")?, self.motor(node, "from")?);
            let now = number(node, "offset")?.unwrap_or(0.0);
            let range = number(node, "lower")?.zip(number(node, "upper")?).map(|(least, most)| [least, most]);
            let name = node.attribute("name").map(Into::into);
            own.push(Limit { name, to, from: Some(from), now, range });
        }
        // What all angles of the pair leave, as the joint between them turns.
        let left = |joint: &Limit| {
            let of = |own: &Limit| {
                let [least, most] = own.range?.map(|x| x - own.now);
                match (own.to, own.from) {
                    (to, from) if to == joint.to && from == joint.from => Some([least, most]),
                    (to, from) if Some(to) == joint.from && from == Some(joint.to) => Some([-most, -least]),
                    _ => None,
                }
            };
            own.iter().filter_map(of).reduce(meet)
        };
        let is_near = |a: f64, b: f64| (a - b).abs() <= SAME * (1.0 + b.abs());
        let is_said = |joint: &Limit| {
            let (said, own) = (left(joint), joint.range);
            said.zip(own).is_some_and(|(said, own)| (0..2).all(|i| is_near(said[i], own[i])))
        };
        limits.retain(|joint| !is_said(joint));
        own.append(limits);
        *limits = own;
        Ok(())
    }

    /// Adds limits that URDF has no word for.
    pub(super) fn motors(&self, motors: &mut [Motor]) -> Result<(), ImportError> {
        for node in self.each("limit").take(MAX_JOINTS) {
            let k = self.motor(node, "joint")?;
            motors[k].acceleration_limit = number(node, "acceleration")?;
            motors[k].jerk_limit = number(node, "jerk")?;
        }
        Ok(())
    }

    /// Pins that close loops.
    pub(super) fn loops(&self, parts: &[Part]) -> Result<Vec<[Point; 2]>, ImportError> {
        let owners = owners(parts);
        let end = |node: Node<'a, 'a>, link: &'static str, at: &'static str| {
            let name = word(node, link)?;
            let known = self.links.get(name).copied();
            let i = known.ok_or_else(|| wrong(node, format!("no link \"{}\"", clipped(name)), "the name of one"))?;
            let at = parts[i].frame * Point3::new(given(node, at)?, 0.0, 0.0);
            let owner =
                owners[i].ok_or_else(|| wrong(node, "a pin on what does not turn", "pins on links that turn"))?;
            Ok::<_, ImportError>((owner, at.coords))
        };
        let pin = |node| Ok([end(node, "a", "at_a")?, end(node, "b", "at_b")?]);
        self.each("pin").take(MAX_JOINTS).map(pin).collect()
    }
}
