//! [`Parameter`]: a number of a machine that its balance depends on, and that may be changed for its sake.

use super::breakdown::Body;
use crate::mechanics::machine::{Machine, MachineSpec, ranges};
use crate::settings::range::Range;

/// What of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Quantity {
    /// Its mass, kg.
    Mass,
    /// Where its centre of mass is along the link, m from the root.
    Along,
    /// Where that is across the link, m to the left of its axis.
    Across,
}

/// One number of a link or a counterweight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Parameter {
    /// Whose.
    pub body: Body,
    /// What of it.
    pub quantity: Quantity,
}

impl Parameter {
    /// Of a body.
    pub const fn new(body: Body, quantity: Quantity) -> Self {
        Self { body, quantity }
    }

    /// Where a link's centre of mass is along the link.
    pub const fn com(link: usize) -> Self {
        Self::new(Body::Link(link), Quantity::Along)
    }

    /// Every one of a machine: of the links mass and both places, of the counterweights mass and place.
    pub fn all(machine: &Machine) -> Vec<Self> {
        let links = (0..machine.links().len()).flat_map(|j| {
            [Quantity::Mass, Quantity::Along, Quantity::Across].map(|quantity| Self::new(Body::Link(j), quantity))
        });
        let weights = (0..machine.spec().counterweights.len()).flat_map(|i| {
            [Quantity::Mass, Quantity::Along].map(|quantity| Self::new(Body::Counterweight(i), quantity))
        });
        links.chain(weights).collect()
    }

    /// Its key, as `--set` names it.
    pub fn key(self, machine: &Machine) -> String {
        let what = match (self.quantity, self.body) {
            (Quantity::Mass, _) => "mass",
            (Quantity::Along, Body::Counterweight(_)) => "at",
            (Quantity::Along, _) => "com",
            (Quantity::Across, _) => "com_normal",
        };
        match self.body {
            Body::Link(j) => format!("link.{}.{what}", machine.links()[j].name),
            Body::Counterweight(i) => format!("counterweight.{}.{what}", i + 1),
            Body::Payload => format!("payload.{what}"),
        }
    }

    /// What it holds; `None` if the machine has no such number, or none that may be changed: what the end effector holds
    /// is given.
    pub fn value(self, spec: &MachineSpec) -> Option<f64> {
        match self.body {
            Body::Link(j) => {
                let link = spec.links.get(j)?;
                Some(match self.quantity {
                    Quantity::Mass => link.mass,
                    Quantity::Along => link.com,
                    Quantity::Across => link.com_normal,
                })
            }
            Body::Counterweight(i) => {
                let weight = spec.counterweights.get(i)?;
                match self.quantity {
                    Quantity::Mass => Some(weight.mass),
                    Quantity::Along => Some(weight.at),
                    Quantity::Across => None,
                }
            }
            Body::Payload => None,
        }
    }

    /// Where it may lie.
    pub const fn range(self) -> Range {
        match self.quantity {
            Quantity::Mass => ranges::MASS,
            Quantity::Along | Quantity::Across => ranges::PLACE,
        }
    }

    /// Changes it. The disc of a counterweight keeps its thickness: its radius follows its mass. The inertia of a link
    /// about its own centre of mass stays.
    pub(crate) fn set(self, spec: &mut MachineSpec, value: f64) {
        match (self.body, self.quantity) {
            (Body::Link(j), Quantity::Mass) => spec.links[j].mass = value,
            (Body::Link(j), Quantity::Along) => spec.links[j].com = value,
            (Body::Link(j), Quantity::Across) => spec.links[j].com_normal = value,
            (Body::Counterweight(i), Quantity::Mass) => {
                let weight = &mut spec.counterweights[i];
                weight.radius *= (value / weight.mass).sqrt();
                weight.mass = value;
            }
            (Body::Counterweight(i), Quantity::Along) => spec.counterweights[i].at = value,
            (Body::Counterweight(_), Quantity::Across) | (Body::Payload, _) => {}
        }
    }
}
