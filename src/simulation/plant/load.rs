//! [`Load`]: a payload that comes and goes.

use serde::{Deserialize, Serialize};

use super::each::is_default;
use crate::mechanics::machine::{Machine, MachineError, Payload};

/// A payload that the model lacks, and when it is held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// kg.
    #[serde(default)]
    pub mass: f64,
    /// About its own centre of mass, kg m².
    #[serde(default, skip_serializing_if = "is_default")]
    pub inertia: f64,
    /// Its centre of mass seen from the end effector: along the link that holds it, and to its left, m.
    #[serde(default, skip_serializing_if = "is_default")]
    pub offset: [f64; 2],
    /// Height of its centre of mass along the drives' axis, m.
    #[serde(default, skip_serializing_if = "is_default")]
    pub axial: f64,
    /// When it is picked up, s: by a hand that moves with it, so that no rate changes.
    #[serde(default, skip_serializing_if = "is_default")]
    pub from: f64,
    /// When it is let go, s; none: never.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until: Option<f64>,
}

impl Load {
    /// Whether there is any.
    pub fn is_some(&self) -> bool {
        self.mass > 0.0 || self.inertia > 0.0
    }

    /// Whether it is held at a time, s; `slack` is half a step.
    pub fn is_held(&self, time: f64, slack: f64) -> bool {
        self.is_some() && time >= self.from - slack && self.until.is_none_or(|until| time < until - slack)
    }

    /// The same as a payload of a machine.
    pub fn payload(&self) -> Payload {
        Payload { mass: self.mass, inertia: self.inertia, offset: self.offset, axial: self.axial }
    }

    /// The machine that holds it, together with what it held before.
    ///
    /// # Errors
    /// If that is no valid machine.
    pub fn held_by(&self, machine: &Machine) -> Result<Machine, MachineError> {
        let mut spec = machine.spec().clone();
        spec.payload = spec.payload.and(self.payload());
        Machine::new(spec)
    }
}
