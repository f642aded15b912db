//! [`PlantDifferences`]: differences of the plant from the model of control.

use std::collections::BTreeMap;

use super::friction::Friction;
use super::load::Load;
use stillbase_mechanics::machine::ranges::{INERTIA, LENGTH, MASS, PLACE};
use stillbase_mechanics::machine::{Machine, MachineError};
use stillbase_settings::key::Key;
use stillbase_settings::keyed::keyed;
use stillbase_settings::number::ShortNumber;
use stillbase_settings::range::{Range, RangeCheck};

const AS_MODEL: &str = "as the model has it";

keyed! {
    /// Differences of the plant from the model of control.
    #[derive(Clone, Debug, PartialEq)]
    pub struct PlantDifferences at "plant" {
        /// Whether motors give no more than the drives' torque limits, whatever control commands.
        torque_limits: bool = "false";
        /// A constant force F at the end effector, along the axes of the base as they are at the start.
        force: [f64; 2] = "0,0", range: Range::either_way(1e6, "N");
        tables:
        /// A payload that the model does not contain, in addition to the machine's own.
        payload: Load;
        /// Friction.
        friction: Friction;
        /// True values of named lengths, m. Bars that share a named length stay equal, so that parallelograms stay
        /// closed.
        length: BTreeMap<String, f64>;
        /// Links with true values that differ from the model.
        link: BTreeMap<String, LinkDifference>;
    }
}

/// Keys of the true values of named lengths.
pub const LENGTH_KEYS: &[Key] =
    &[Key::number("plant.length.*", LENGTH, Key::NONE, "True length of all bars that share a named length.")
        .instead(AS_MODEL)];

keyed! {
    /// True values of a link that differ from the model's.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct LinkDifference at "plant.link.*" {
        /// True mass of a link.
        mass: Option<f64> = Key::NONE, range: MASS, instead: AS_MODEL;
        /// True inertia of a link about its own centre of mass.
        inertia: Option<f64> = Key::NONE, range: INERTIA, instead: AS_MODEL;
        /// True place of a link's centre of mass along the link, from its root.
        com: Option<f64> = Key::NONE, range: PLACE, instead: AS_MODEL;
        /// True place of a link's centre of mass off the link's axis, to the left.
        com_normal: Option<f64> = Key::NONE, range: PLACE, instead: AS_MODEL;
    }
}

impl PlantDifferences {
    /// Returns the plant's machine, without the temporary payload.
    ///
    /// # Errors
    /// If the differences give no valid machine, or name a length or link that the machine does not have.
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

    /// Returns the checks that depend on several settings or on the number `n` of drives.
    pub fn range_checks(&self, n: usize) -> Vec<RangeCheck> {
        let (load, friction) = (&self.payload, &self.friction);
        let later = |until| {
            let from = || format!("more than plant.payload.from, {} s", ShortNumber(load.from));
            RangeCheck::depending("plant.payload.until", until, until > load.from, from)
        };
        let mut list: Vec<RangeCheck> = load.until.map(later).into_iter().collect();
        list.extend(friction.viscous.misfit(n, "plant.friction.viscous"));
        list.extend(friction.coulomb.misfit(n, "plant.friction.coulomb"));
        list
    }
}
