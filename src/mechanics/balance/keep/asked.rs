//! [`Keep`]: what may change for the sake of balance, how far, and how dear that is.

use super::super::breakdown::Body;
use super::super::parameter::{Parameter, Quantity};
use super::refusal::NotKept;
use crate::mechanics::machine::Machine;
use crate::settings::number::Short;

/// How far a parameter may go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hold {
    /// It stays what it is in the machine. Unlike one that is not listed, it may be named as what stands in the way.
    Fixed,
    /// As far as is usual from where its change is measured: a mass from a tenth to ten times, a place ten times as far as
    /// the machine reaches, or 10 m where that is more.
    Free,
    /// From one value to another. A mass stays above a thousandth of what it is and is measured from.
    Within([f64; 2]),
}

/// The least that a mass which may change may become, as a fraction of what it is or is measured from.
pub(super) const MIN_MASS: f64 = 1e-3;

/// How much lighter and heavier a mass may become unless it is bounded.
const USUAL_MASS: f64 = 10.0;

/// How far a place may move unless it is bounded, in what the machine reaches or in metres.
const USUAL_WAY: f64 = 10.0;

/// A parameter that is listed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adjusted {
    /// Which.
    pub parameter: Parameter,
    /// How far it may go.
    pub hold: Hold,
    /// p: on each m or kg of change.
    pub penalty: f64,
    /// Where its change is measured from, m or kg.
    pub from: f64,
}

impl Adjusted {
    /// From where to where it may go; one that is fixed has no room.
    pub(super) fn ends(&self, machine: &Machine) -> Option<[f64; 2]> {
        let value = self.parameter.value(machine.spec())?;
        Some(match (self.hold, self.parameter.quantity) {
            (Hold::Fixed, _) => [value; 2],
            (Hold::Within(ends), _) => ends,
            // What it is already it may stay.
            (Hold::Free, Quantity::Mass) => [value.min(self.from / USUAL_MASS), value.max(self.from * USUAL_MASS)],
            (Hold::Free, Quantity::Along | Quantity::Across) => {
                let way = USUAL_WAY * machine.reach().max(1.0);
                [value.min(self.from - way), value.max(self.from + way)]
            }
        })
    }

    /// How far it may go at most if its own limits give way: as far as is usual, or as they let it.
    pub(super) fn widest(&self, machine: &Machine) -> Option<[f64; 2]> {
        let ([low, high], usual) = (self.ends(machine)?, Self { hold: Hold::Free, ..*self }.ends(machine)?);
        Some([low.min(usual[0]), high.max(usual[1])])
    }
}

/// What may change. All that is not listed stays as it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Keep {
    /// Each at most once.
    pub parameters: Vec<Adjusted>,
}

impl Keep {
    /// All centres of mass along the links are free, from where they are; a penalty for each link, such as those of a
    /// [`Preset`](super::super::Preset).
    pub fn coms(machine: &Machine, penalty: &[f64]) -> Self {
        let adjusted = |(j, link): (usize, &crate::mechanics::machine::Link)| Adjusted {
            parameter: Parameter::com(j),
            hold: Hold::Free,
            penalty: penalty.get(j).copied().unwrap_or(1.0),
            from: link.com,
        };
        Self { parameters: machine.spec().links.iter().enumerate().map(adjusted).collect() }
    }

    /// The same with changes measured from another machine: one that is kept while a hand goes on changing it is always
    /// measured from where it started.
    #[must_use]
    pub fn measured_from(mut self, machine: &Machine) -> Self {
        for one in &mut self.parameters {
            one.from = one.parameter.value(machine.spec()).unwrap_or(one.from);
        }
        self
    }

    /// The entry of a parameter.
    pub fn of(&self, parameter: Parameter) -> Option<&Adjusted> {
        self.parameters.iter().find(|one| one.parameter == parameter)
    }

    /// Says how far a parameter may go; one that is not listed yet is, from where it is, with penalty 1.
    pub fn hold(&mut self, machine: &Machine, parameter: Parameter, hold: Hold) {
        match self.parameters.iter_mut().find(|one| one.parameter == parameter) {
            Some(one) => one.hold = hold,
            None => {
                let from = parameter.value(machine.spec()).unwrap_or_default();
                self.parameters.push(Adjusted { parameter, hold, penalty: 1.0, from });
            }
        }
    }

    /// Whether it can be asked of a machine.
    pub(super) fn check(&self, machine: &Machine) -> Result<(), NotKept> {
        for (i, one) in self.parameters.iter().enumerate() {
            let bad = |what: &str, value: f64, want: String| {
                Err(NotKept::OutOfRange { what: format!("{}: {what}", one.parameter.key(machine)), value, want })
            };
            if one.parameter.value(machine.spec()).is_none() {
                return Err(NotKept::NoParameter(name(one.parameter, machine)));
            }
            if self.parameters[..i].iter().any(|other| other.parameter == one.parameter) {
                return Err(NotKept::Twice(one.parameter.key(machine)));
            }
            if !(1e-6..=1e6).contains(&one.penalty) {
                return bad("a penalty of", one.penalty, "1e-6 to 1e6".into());
            }
            let range = one.parameter.range();
            if !range.contains(one.from) {
                return bad("a change measured from", one.from, range.to_string());
            }
            let Hold::Within([low, high]) = one.hold else { continue };
            let of_nothing = low == 0.0 && one.parameter.quantity == Quantity::Mass;
            if !(range.contains(low) || of_nothing) {
                return bad("bounds from", low, range.to_string());
            }
            if !range.contains(high) {
                return bad("bounds up to", high, range.to_string());
            }
            if low > high {
                return bad("bounds up to", high, format!("no less than {}", Short(low)));
            }
        }
        Ok(())
    }
}

fn name(parameter: Parameter, machine: &Machine) -> String {
    match parameter.body {
        Body::Link(j) if j >= machine.links().len() => format!("link {} (counted from 0)", j),
        _ => parameter.key(machine),
    }
}
