//! [`Parameter`]: a mass or a position of a body that may be changed to balance its machine.

use super::breakdown::Body;
use crate::machine::{Machine, MachineSpec, ranges};
use stillbase_settings::range::Range;

/// A quantity of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum BodyQuantity {
    /// Its mass, kg.
    Mass,
    /// Position of its centre of mass along the link, from the root, m.
    Along,
    /// Distance of its centre of mass to the left of the link's axis, m.
    Across,
}

/// One quantity of a link or a counterweight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Parameter {
    /// The body.
    pub body: Body,
    /// The quantity of the body.
    pub quantity: BodyQuantity,
}

impl Parameter {
    /// Makes the parameter of a body.
    pub const fn new(body: Body, quantity: BodyQuantity) -> Self {
        Self { body, quantity }
    }

    /// Returns the parameter for the position of a link's centre of mass along the link.
    pub const fn com(link: usize) -> Self {
        Self::new(Body::Link(link), BodyQuantity::Along)
    }

    /// Returns all parameters of a machine: mass and both positions of each link and of each counterweight.
    pub fn all(machine: &Machine) -> Vec<Self> {
        let links = (0..machine.links().len()).map(Body::Link);
        let bodies = links.chain((0..machine.spec().counterweights.len()).map(Body::Counterweight));
        let quantities = [BodyQuantity::Mass, BodyQuantity::Along, BodyQuantity::Across];
        bodies.flat_map(|body| quantities.map(|quantity| Self::new(body, quantity))).collect()
    }

    /// Returns its key, as `--set` names it.
    pub fn key(self, machine: &Machine) -> String {
        let what = match (self.quantity, self.body) {
            (BodyQuantity::Mass, _) => "mass",
            (BodyQuantity::Along, Body::Counterweight(_)) => "at",
            (BodyQuantity::Along, _) => "com",
            (BodyQuantity::Across, Body::Counterweight(_)) => "across",
            (BodyQuantity::Across, _) => "com_normal",
        };
        match self.body {
            Body::Link(j) => format!("link.{}.{what}", machine.links()[j].name),
            Body::Counterweight(i) => format!("counterweight.{}.{what}", i + 1),
            Body::Payload => format!("payload.{what}"),
        }
    }

    /// Returns its value, kg or m. `None` if the machine has no such parameter, and for the payload, which never
    /// changes.
    pub fn value(self, spec: &MachineSpec) -> Option<f64> {
        match self.body {
            Body::Link(j) => {
                let link = spec.links.get(j)?;
                Some(match self.quantity {
                    BodyQuantity::Mass => link.mass,
                    BodyQuantity::Along => link.com,
                    BodyQuantity::Across => link.com_normal,
                })
            }
            Body::Counterweight(i) => {
                let weight = spec.counterweights.get(i)?;
                Some(match self.quantity {
                    BodyQuantity::Mass => weight.mass,
                    BodyQuantity::Along => weight.at,
                    BodyQuantity::Across => weight.across,
                })
            }
            Body::Payload => None,
        }
    }

    /// Returns the range of valid values, kg or m.
    pub const fn range(self) -> Range {
        match self.quantity {
            BodyQuantity::Mass => ranges::MASS,
            BodyQuantity::Along | BodyQuantity::Across => ranges::PLACE,
        }
    }

    /// Sets its value, kg or m. The disc of a counterweight keeps its thickness, so its radius follows its mass. The
    /// inertia of a link about its own centre of mass does not change.
    pub fn set(self, spec: &mut MachineSpec, value: f64) {
        match (self.body, self.quantity) {
            (Body::Link(j), BodyQuantity::Mass) => spec.links[j].mass = value,
            (Body::Link(j), BodyQuantity::Along) => spec.links[j].com = value,
            (Body::Link(j), BodyQuantity::Across) => spec.links[j].com_normal = value,
            (Body::Counterweight(i), BodyQuantity::Mass) => {
                spec.counterweights[i] = spec.counterweights[i].with_mass(value);
            }
            (Body::Counterweight(i), BodyQuantity::Along) => spec.counterweights[i].at = value,
            (Body::Counterweight(i), BodyQuantity::Across) => spec.counterweights[i].across = value,
            (Body::Payload, _) => {}
        }
    }
}
