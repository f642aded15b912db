//! The motor that turns each part, and the parts that are rotors.

use super::coupled::{CoupledBodies, GearedPart, PARALLEL_WANTED, RelativeSet};
use crate::import::linkage::{ImportedMotor, ImportedPart};
use crate::import::refusal::{ImportError, element_error};

impl CoupledBodies<'_> {
    /// Returns the rotors: the part, its motor, and the gear ratio.
    ///
    /// # Errors
    /// If a coupling is not that of a rotor to its motor.
    pub(super) fn rotors(
        &self,
        motors: &[(ImportedMotor, RelativeSet)],
    ) -> Result<Vec<(usize, usize, f64)>, ImportError> {
        let rotor = |geared: &GearedPart| {
            let turned = self.against(&geared.to).map(|(to, from)| (self.set(to), self.set(from)));
            let k = motors.iter().position(|(_, against)| Some(*against) == turned);
            let is_leaf = !self.bodies.parts.iter().any(|part| part.parent == Some(geared.part));
            let sits = |k: &usize| motors[*k].1.1 == self.set(self.on(geared.part));
            k.filter(|k| is_leaf && sits(k))
                .map(|k| (geared.part, k, geared.ratio))
                .ok_or_else(|| element_error(geared.node, "it does not couple a rotor to its motor", PARALLEL_WANTED))
        };
        self.geared.iter().map(rotor).collect()
    }

    /// Returns the motor that turns each part, directly or through its set.
    ///
    /// # Errors
    /// If no motor turns a part that has a hinge.
    pub(super) fn sets(
        &self,
        motors: &[(ImportedMotor, RelativeSet)],
        rotors: &[(usize, usize, f64)],
    ) -> Result<Vec<Option<usize>>, ImportError> {
        let set = |(i, part): (usize, &ImportedPart)| {
            let own = self.owner(Some(i));
            let k = motors.iter().position(|(_, (to, _))| own != self.base && *to == self.set(own));
            let is_rotor = rotors.iter().any(|(rotor, ..)| *rotor == i);
            match k.is_some() || own != i || is_rotor || self.set(own) == self.base {
                true => Ok(k),
                false => {
                    let what = "no motor turns it, and nothing keeps it parallel to a body that a motor turns";
                    Err(part.wrong(what, "a motor, a loop or an equality"))
                }
            }
        };
        self.bodies.parts.iter().enumerate().map(set).collect()
    }
}
