//! [`RebalanceRequest`]: the parameters that may change to balance a machine, with bounds and penalties.

use super::super::breakdown::Body;
use super::super::parameter::{BodyQuantity, Parameter};
use super::refusal::RebalanceError;
use crate::machine::Machine;
use stillbase_settings::number::ShortNumber;

/// Bounds of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParameterBounds {
    /// The parameter keeps its value in the machine. If there is no solution, the error may name this parameter as a
    /// cause; it never names one that is not listed.
    Fixed,
    /// Default bounds about the reference value. A mass may change by a factor of ten either way; a position by ten
    /// times the machine's reach, or 10 m if that is more.
    Free,
    /// Lower and upper bound, kg or m. A mass also stays above a thousandth of the smaller of its present and its
    /// reference value.
    Within([f64; 2]),
}

/// Lower bound of a mass that may change, as a fraction of the smaller of its present and its reference value.
pub(super) const MIN_MASS: f64 = 1e-3;

/// Default bounds of a mass: its reference value divided and multiplied by this factor.
const DEFAULT_MASS_FACTOR: f64 = 10.0;

/// Default bounds of a position: its reference value plus or minus this factor times the machine's reach, or times 1 m
/// if the reach is shorter.
const DEFAULT_TRAVEL_FACTOR: f64 = 10.0;

/// A listed parameter, with its bounds and its penalty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ListedParameter {
    /// The parameter.
    pub parameter: Parameter,
    /// Its bounds.
    pub bounds: ParameterBounds,
    /// Penalty p on its change, 1/m or 1/kg.
    pub penalty: f64,
    /// Reference value from which its change is measured, m or kg.
    pub from: f64,
}

impl ListedParameter {
    /// Returns its lower and upper bound, kg or m; both are the present value if it is fixed.
    pub(super) fn ends(&self, machine: &Machine) -> Option<[f64; 2]> {
        let value = self.parameter.value(machine.spec())?;
        Some(match (self.bounds, self.parameter.quantity) {
            (ParameterBounds::Fixed, _) => [value; 2],
            (ParameterBounds::Within(ends), _) => ends,
            // The default bounds include the present value.
            (ParameterBounds::Free, BodyQuantity::Mass) => {
                [value.min(self.from / DEFAULT_MASS_FACTOR), value.max(self.from * DEFAULT_MASS_FACTOR)]
            }
            (ParameterBounds::Free, BodyQuantity::Along | BodyQuantity::Across) => {
                let way = DEFAULT_TRAVEL_FACTOR * machine.reach().max(1.0);
                [value.min(self.from - way), value.max(self.from + way)]
            }
        })
    }

    /// Returns the bounds to which its limits may be relaxed, kg or m: the union of its bounds and the default bounds.
    pub(super) fn widest(&self, machine: &Machine) -> Option<[f64; 2]> {
        let ([low, high], usual) =
            (self.ends(machine)?, Self { bounds: ParameterBounds::Free, ..*self }.ends(machine)?);
        Some([low.min(usual[0]), high.max(usual[1])])
    }
}

/// The parameters that may change, and fixed ones. All parameters that are not listed keep their values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RebalanceRequest {
    /// The parameters, each at most once.
    pub parameters: Vec<ListedParameter>,
}

impl RebalanceRequest {
    /// Lists the positions of all links' centres of mass along the links, with default bounds about their present
    /// values. `penalty` holds the penalty of each link, such as those of a [`Preset`](super::super::Preset).
    pub fn coms(machine: &Machine, penalty: &[f64]) -> Self {
        let adjusted = |(j, link): (usize, &crate::machine::Link)| ListedParameter {
            parameter: Parameter::com(j),
            bounds: ParameterBounds::Free,
            penalty: penalty.get(j).copied().unwrap_or(1.0),
            from: link.com,
        };
        Self { parameters: machine.spec().links.iter().enumerate().map(adjusted).collect() }
    }

    /// Returns the same list with the values of another machine as reference values. During a drag, that is the machine
    /// before the drag.
    #[must_use]
    pub fn measured_from(mut self, machine: &Machine) -> Self {
        for one in &mut self.parameters {
            one.from = one.parameter.value(machine.spec()).unwrap_or(one.from);
        }
        self
    }

    /// Returns the entry of a parameter; `None` if it is not listed.
    pub fn of(&self, parameter: Parameter) -> Option<&ListedParameter> {
        self.parameters.iter().find(|one| one.parameter == parameter)
    }

    /// Sets the bounds of a parameter. A parameter that is not listed is added with its present value as reference and
    /// penalty 1.
    pub fn set_bounds(&mut self, machine: &Machine, parameter: Parameter, hold: ParameterBounds) {
        match self.parameters.iter_mut().find(|one| one.parameter == parameter) {
            Some(one) => one.bounds = hold,
            None => {
                let from = parameter.value(machine.spec()).unwrap_or_default();
                self.parameters.push(ListedParameter { parameter, bounds: hold, penalty: 1.0, from });
            }
        }
    }

    /// Checks that the parameters exist in a machine, none is listed twice, and all numbers are within range.
    pub(super) fn check(&self, machine: &Machine) -> Result<(), RebalanceError> {
        for (i, one) in self.parameters.iter().enumerate() {
            let bad = |what: &str, value: f64, want: String| {
                Err(RebalanceError::OutOfRange { what: format!("{}: {what}", one.parameter.key(machine)), value, want })
            };
            if one.parameter.value(machine.spec()).is_none() {
                return Err(RebalanceError::NoParameter(name(one.parameter, machine)));
            }
            if self.parameters[..i].iter().any(|other| other.parameter == one.parameter) {
                return Err(RebalanceError::Twice(one.parameter.key(machine)));
            }
            if !(1e-6..=1e6).contains(&one.penalty) {
                return bad("a penalty of", one.penalty, "1e-6 to 1e6".into());
            }
            let range = one.parameter.range();
            if !range.contains(one.from) {
                return bad("a change measured from", one.from, range.to_string());
            }
            let ParameterBounds::Within([low, high]) = one.bounds else { continue };
            let zero_mass = low == 0.0 && one.parameter.quantity == BodyQuantity::Mass;
            if !(range.contains(low) || zero_mass) {
                return bad("bounds from", low, range.to_string());
            }
            if !range.contains(high) {
                return bad("bounds up to", high, range.to_string());
            }
            if low > high {
                return bad("bounds up to", high, format!("no less than {}", ShortNumber(low)));
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
