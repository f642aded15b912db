//! Limits of hinges and tendons.

use super::coupled::{CoupledBodies, HingeSum, RelativeSet};
use crate::import::linkage::{ImportedMotor, JointLimit};
use crate::import::read::{each, several};
use crate::import::refusal::ImportError;

/// A sum of hinges, its value in the reference pose, and its limits, rad.
type Limited = (HingeSum, f64, [f64; 2]);

impl CoupledBodies<'_> {
    /// Returns the limits of hinges and tendons that are angles between two drives, or between a drive and the base.
    pub(super) fn limits(
        &self,
        motors: &[(ImportedMotor, RelativeSet)],
        rotors: &[(usize, usize, f64)],
    ) -> Result<Vec<JointLimit>, ImportError> {
        let number_of = |set: usize| motors.iter().position(|(_, (to, _))| *to == set);
        let hinges = (0..self.base).filter(|i| !rotors.iter().any(|(rotor, ..)| rotor == i));
        let mut limited: Vec<Limited> = hinges.filter_map(|i| self.limits_of(i)).collect();
        limited.extend(self.limits_of_tendons()?);
        let limit = |(sum, now, range): Limited| {
            let (to, from) = self.against(&sum)?;
            let from = if self.set(from) == self.base { None } else { Some(number_of(self.set(from))?) };
            Some(JointLimit { name: None, to: number_of(self.set(to))?, from, now, range: Some(range) })
        };
        Ok(limited.into_iter().filter_map(limit).collect())
    }

    fn limits_of(&self, i: usize) -> Option<Limited> {
        let (now, [least, most]) = (self.bodies.angle(i), self.bodies.range(i)?);
        Some(match self.signs[i] < 0.0 {
            true => (vec![(i, 1.0)], -now, [-most, -least]),
            false => (vec![(i, 1.0)], now, [least, most]),
        })
    }

    fn limits_of_tendons(&self) -> Result<Vec<Limited>, ImportError> {
        let mut all = Vec::new();
        for node in each(self.bodies.model, "tendon").flat_map(|node| each(node, "fixed")) {
            let element = self.bodies.element(node)?;
            if let Some(range) = several::<2>(&element, "range")?.filter(|_| self.bodies.is_limit(&element, "limited"))
            {
                let sum = self.tendon(node, "name")?;
                let now = sum.iter().map(|(i, times)| times * self.signs[*i] * self.bodies.angle(*i)).sum();
                all.push((sum, now, range));
            }
        }
        Ok(all)
    }
}
