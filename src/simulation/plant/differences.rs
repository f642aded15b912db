//! [`PlantDifferences`]: what differs in the machine that moves.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::each::is_default;
use super::friction::Friction;
use super::load::Load;
use crate::mechanics::machine::ranges::{INERTIA as LINK_INERTIA, LENGTH, MASS as LINK_MASS, PLACE as LINK_PLACE};
use crate::mechanics::machine::{Machine, MachineError};
use crate::settings::key::{Holds, Key};
use crate::settings::number::Short;
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

    /// Whether a key of this part has an effect as things are.
    pub fn uses(&self, key: &str) -> bool {
        match key.strip_prefix("payload.") {
            Some("mass" | "inertia") | None => true,
            Some(_) => self.payload.is_some(),
        }
    }

    /// What no range says: how its numbers fit together, and the drives of a machine with `n` of them.
    pub(crate) fn fits(&self, n: usize) -> Vec<Check> {
        let (load, friction) = (&self.payload, &self.friction);
        let later = |until| {
            let from = || format!("more than plant.payload.from, {} s", Short(load.from));
            Check::said("plant.payload.until", until, until > load.from, from)
        };
        let mut list: Vec<Check> = load.until.map(later).into_iter().collect();
        list.extend(friction.viscous.misfit(n, "plant.friction.viscous"));
        list.extend(friction.coulomb.misfit(n, "plant.friction.coulomb"));
        list
    }
}

/// The heaviest unknown payload, kg; also the bound on its inertia, kg m², and on friction.
pub const MAX_PAYLOAD: f64 = 1e4;

const FRICTION_TORQUE: Range = Range::new(0.0, MAX_PAYLOAD, "N m");
const VISCOUS: Range = Range::new(0.0, MAX_PAYLOAD, "N m s");
const TIME: Range = Range::new(0.0, 1e6, "s");
const PLACE: Range = Range::either_way(1e3, "m");
const AS_MODEL: &str = "as the model has it";
const PAYLOAD: &str = "plant.payload.mass or plant.payload.inertia above 0";

/// Every key of `[plant]`.
pub const KEYS: [Key; 17] = [
    Key::new(
        "plant.torque_limits",
        Holds::Switch,
        "false",
        "Whether motors give no more than the drives' torque limits, whatever control asks for.",
    ),
    Key::new(
        "plant.force",
        Holds::List(2, Range::either_way(1e6, "N")),
        "0,0",
        "A constant force F at the end effector, along the axes of the base as they are at the start.",
    ),
    Key::number(
        "plant.payload.mass",
        Range::new(0.0, MAX_PAYLOAD, "kg"),
        "0",
        "Mass of a payload that control does not know of; it adds to the machine's own and unbalances it.",
    ),
    Key::number(
        "plant.payload.inertia",
        Range::new(0.0, MAX_PAYLOAD, "kg m²"),
        "0",
        "Inertia of the payload about its own centre of mass.",
    ),
    Key::new(
        "plant.payload.offset",
        Holds::List(2, PLACE),
        "0,0",
        "Centre of mass of the payload, seen from the end effector: along the link that holds it, and to its left.",
    )
    .when(PAYLOAD),
    Key::number("plant.payload.axial", PLACE, "0", "Height of the payload's centre of mass along the drives' axis.")
        .when(PAYLOAD),
    Key::number("plant.payload.from", TIME, "0", "When the payload is picked up, by a hand that moves with it.")
        .when(PAYLOAD),
    Key::number("plant.payload.until", TIME, Key::NONE, "When the payload is let go.")
        .when(PAYLOAD)
        .instead("it is held to the end"),
    Key::new(
        "plant.friction.viscous",
        Holds::PerDrive(VISCOUS),
        "0",
        "Viscous friction in the bearings of the drives: a torque against the rate relative to the base.",
    ),
    Key::new(
        "plant.friction.coulomb",
        Holds::PerDrive(FRICTION_TORQUE),
        "0",
        "Coulomb friction in the bearings of the drives; a drive at rest sticks until more than this pulls.",
    ),
    Key::number(
        "plant.friction.pin_viscous",
        VISCOUS,
        "0",
        "Viscous friction in every pin, against the rate between its two links.",
    ),
    Key::number(
        "plant.friction.pin_coulomb",
        FRICTION_TORQUE,
        "0",
        "Coulomb friction in every pin; a pin at rest sticks.",
    ),
    Key::number("plant.length.*", LENGTH, Key::NONE, "True length of all bars that share a named length.")
        .instead(AS_MODEL),
    Key::number("plant.link.*.mass", LINK_MASS, Key::NONE, "True mass of a link.").instead(AS_MODEL),
    Key::number(
        "plant.link.*.inertia",
        LINK_INERTIA,
        Key::NONE,
        "True inertia of a link about its own centre of mass.",
    )
    .instead(AS_MODEL),
    Key::number(
        "plant.link.*.com",
        LINK_PLACE,
        Key::NONE,
        "True place of a link's centre of mass along the link, from its root.",
    )
    .instead(AS_MODEL),
    Key::number(
        "plant.link.*.com_normal",
        LINK_PLACE,
        Key::NONE,
        "True place of a link's centre of mass off the link's axis, to the left.",
    )
    .instead(AS_MODEL),
];
