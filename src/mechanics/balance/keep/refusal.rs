//! [`RebalanceError`]: the reason why a machine cannot be kept balanced, and the relaxed limits with which it can.

use std::fmt;

use thiserror::Error;

use super::super::parameter::Parameter;
use stillbase_settings::number::nine_digits;

/// Lower or upper limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitSide {
    /// Lower limit.
    Least,
    /// Upper limit.
    Most,
}

/// A limit of a parameter. Both limits of a fixed parameter are its value.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterLimit {
    /// The parameter.
    pub parameter: Parameter,
    /// Key of the parameter.
    pub key: String,
    /// For a counterweight, the link that carries it, because its key has only its number.
    pub carrier: Option<String>,
    /// Side of the limit: lower or upper.
    pub side: LimitSide,
    /// Whether the parameter is fixed.
    pub fixed: bool,
    /// Whether the limit is a default.
    pub is_default: bool,
    /// Value of the limit, m or kg.
    pub value: f64,
}

impl ParameterLimit {
    fn named(&self) -> String {
        let Some(link) = &self.carrier else { return self.key.clone() };
        format!("{} (on link {link})", self.key)
    }
}

impl fmt::Display for ParameterLimit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (key, value) = (self.named(), nine_digits(self.value));
        match (self.fixed, self.side) {
            (true, _) => write!(f, "{key} stays {value}"),
            (false, LimitSide::Least) => write!(f, "{key} at least {value}"),
            (false, LimitSide::Most) => write!(f, "{key} at most {value}"),
        }?;
        if self.is_default { write!(f, " unless bounded otherwise") } else { Ok(()) }
    }
}

/// A limit with the value to which it is relaxed.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitRelaxation {
    /// The limit.
    pub limit: ParameterLimit,
    /// Its relaxed value, m or kg.
    pub to: f64,
}

impl fmt::Display for LimitRelaxation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (key, to) = (self.limit.named(), nine_digits(self.to));
        match (self.limit.fixed, self.limit.side) {
            (true, _) => write!(f, "{key} free as far as {to}"),
            (false, LimitSide::Least) => write!(f, "{key} at least {to}"),
            (false, LimitSide::Most) => write!(f, "{key} at most {to}"),
        }
    }
}

fn listed<T: fmt::Display>(all: &[T], between: &str) -> String {
    all.iter().map(T::to_string).collect::<Vec<_>>().join(between)
}

fn sufficient_relief(relief: &[LimitRelaxation]) -> String {
    if relief.is_empty() { String::new() } else { format!("; {} would do", listed(relief, " and ")) }
}

/// Reason why a machine cannot be kept balanced.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RebalanceError {
    /// A number that is out of range.
    #[error("{what} {value}: want {want}")]
    OutOfRange {
        /// Meaning of the number.
        what: String,
        /// The number.
        value: f64,
        /// The allowed range.
        want: String,
    },
    /// There is no such parameter.
    #[error(
        "{0} cannot be changed to balance this machine: want mass, com or com_normal of a link, or mass or at of a counterweight"
    )]
    NoParameter(String),
    /// One parameter is listed twice.
    #[error("{0} is listed twice: want it once")]
    Twice(String),
    /// No values of the listed parameters balance the machine.
    #[error(
        "no change of these parameters balances this machine: {residual} remain at best in {condition}; want more parameters free"
    )]
    Inconsistent {
        /// The condition with the largest residual.
        condition: String,
        /// Its residual, with unit.
        residual: String,
    },
    /// Balance would need a mass of zero or less.
    #[error("only a mass of zero or less would balance this machine: want more parameters free")]
    NoMass,
    /// These limits contradict each other: a minimal set.
    #[error("no balance within these limits: {}{}", listed(.limits, "; "), sufficient_relief(.relief))]
    Conflict {
        /// The limits; if any one of them is removed, the others are feasible together.
        limits: Vec<ParameterLimit>,
        /// Relaxed limits with which there is a solution, with the least Σ p |change|. They may include limits not in
        /// `limits`.
        relief: Vec<LimitRelaxation>,
    },
    /// The solver failed.
    #[error("the solver found no answer: {0}")]
    Failed(String),
    /// The result is not a valid machine.
    #[error("the rebalanced machine is not valid: {0}")]
    Machine(String),
}
