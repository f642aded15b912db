//! [`PlantDifferences`]: what differs in the machine that moves.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::each::is_default;
use super::friction::Friction;
use super::load::Load;
use crate::mechanics::machine::{Machine, MachineError};
use crate::settings::range::{Check, Range};

/// What differs in the machine that moves.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlantDifferences {
    /// Whether motors give no more than the drives' torque limits.
    #[serde(default, skip_serializing_if = "is_default")]
    pub torque_limits: bool,
    /// A force held at the end effector, in base axes as they are at the start, N.
    #[serde(default, skip_serializing_if = "is_default")]
    pub force: [f64; 2],
    /// A payload that the model lacks; it adds to the machine's own.
    #[serde(default, skip_serializing_if = "is_default")]
    pub payload: Load,
    /// Friction.
    #[serde(default, skip_serializing_if = "is_default")]
    pub friction: Friction,
    /// Named lengths that differ, m: bars that share one stay equal, so that parallelograms stay closed.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub length: BTreeMap<String, f64>,
    /// Links that differ.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub link: BTreeMap<String, LinkDifference>,
}

/// What differs in a link: its true values, where they are not the model's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinkDifference {
    /// kg.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass: Option<f64>,
    /// About its own centre of mass, kg m².
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia: Option<f64>,
    /// Centre of mass along the link, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub com: Option<f64>,
    /// Centre of mass off the link's axis, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub com_normal: Option<f64>,
}

impl PlantDifferences {
    /// The machine that moves, without the payload that comes and goes.
    ///
    /// # Errors
    /// If what differs leaves no valid machine, or names what the machine does not have.
    pub fn machine(&self, model: &Machine) -> Result<Machine, MachineError> {
        let lengths = self.length.iter().map(|(name, value)| (format!("length.{name}"), value.to_string()));
        let links = self.link.iter().flat_map(|(name, d)| {
            let fields = [("mass", d.mass), ("inertia", d.inertia), ("com", d.com), ("com_normal", d.com_normal)];
            let key =
                move |(field, value): (&str, Option<f64>)| Some((format!("link.{name}.{field}"), value?.to_string()));
            fields.into_iter().filter_map(key)
        });
        let pairs: Vec<(String, String)> = lengths.chain(links).collect();
        match pairs.is_empty() {
            true => Ok(model.clone()),
            false => model.set_all(pairs.iter().map(|(key, value)| (key.as_str(), value.as_str()))),
        }
    }

    /// Every number with its key, what it should be, and whether it is.
    pub(crate) fn checks(&self, n: usize) -> Vec<Check> {
        let (load, friction) = (&self.payload, &self.friction);
        let mut list = vec![
            MASS.check("plant.payload.mass", load.mass),
            INERTIA.check("plant.payload.inertia", load.inertia),
            PLACE.check("plant.payload.offset", load.offset[0]),
            PLACE.check("plant.payload.offset", load.offset[1]),
            PLACE.check("plant.payload.axial", load.axial),
            TIME.check("plant.payload.from", load.from),
            FORCE.check("plant.force", self.force[0]),
            FORCE.check("plant.force", self.force[1]),
            VISCOUS.check("plant.friction.pin_viscous", friction.pin_viscous),
            COULOMB.check("plant.friction.pin_coulomb", friction.pin_coulomb),
        ];
        if let Some(until) = load.until {
            list.push(TIME.check("plant.payload.until", until));
            let want = "later than plant.payload.from, s";
            list.push(Check::words("plant.payload.until", until, until > load.from, want));
        }
        for (key, each, range) in [
            ("plant.friction.viscous", friction.viscous, VISCOUS),
            ("plant.friction.coulomb", friction.coulomb, COULOMB),
        ] {
            list.extend(each.values().into_iter().map(|x| range.check(key, x)));
            list.extend(each.misfit(n, key));
        }
        list
    }
}

/// The heaviest unknown payload, kg; also the bound on its inertia, kg m², and on friction.
pub const MAX_PAYLOAD: f64 = 1e4;

const MASS: Range = Range::new(0.0, MAX_PAYLOAD, "kg");
const INERTIA: Range = Range::new(0.0, MAX_PAYLOAD, "kg m²");
const PLACE: Range = Range::either_way(1e3, "m");
const TIME: Range = Range::new(0.0, 1e6, "s");
const FORCE: Range = Range::either_way(1e6, "N");
const VISCOUS: Range = Range::new(0.0, MAX_PAYLOAD, "N m s");
const COULOMB: Range = Range::new(0.0, MAX_PAYLOAD, "N m");
