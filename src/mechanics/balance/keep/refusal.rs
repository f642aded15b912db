//! [`NotKept`]: why a machine cannot be kept balanced, and what would have to give.

use std::fmt;

use thiserror::Error;

use super::super::parameter::Parameter;
use crate::settings::number::nine_digits;

/// Which end of what a parameter may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// It may be no less.
    Least,
    /// It may be no more.
    Most,
}

/// An end of what a parameter may be. Of one that is fixed both ends are where it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// Of which.
    pub parameter: Parameter,
    /// Its key.
    pub key: String,
    /// The link that carries it, of a counterweight: its key says only its number.
    pub carrier: Option<String>,
    /// Which end.
    pub side: Side,
    /// Whether it is fixed.
    pub fixed: bool,
    /// Whether it is there because nothing else was said.
    pub usual: bool,
    /// Where, m or kg.
    pub value: f64,
}

impl Limit {
    fn named(&self) -> String {
        let Some(link) = &self.carrier else { return self.key.clone() };
        format!("{} (on link {link})", self.key)
    }
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (key, value) = (self.named(), nine_digits(self.value));
        match (self.fixed, self.side) {
            (true, _) => write!(f, "{key} stays {value}"),
            (false, Side::Least) => write!(f, "{key} at least {value}"),
            (false, Side::Most) => write!(f, "{key} at most {value}"),
        }?;
        if self.usual { write!(f, " unless bounded otherwise") } else { Ok(()) }
    }
}

/// A limit that gives way.
#[derive(Clone, Debug, PartialEq)]
pub struct Relief {
    /// Which.
    pub limit: Limit,
    /// As far as here, m or kg.
    pub to: f64,
}

impl fmt::Display for Relief {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (key, to) = (self.limit.named(), nine_digits(self.to));
        match (self.limit.fixed, self.limit.side) {
            (true, _) => write!(f, "{key} free as far as {to}"),
            (false, Side::Least) => write!(f, "{key} at least {to}"),
            (false, Side::Most) => write!(f, "{key} at most {to}"),
        }
    }
}

fn listed<T: fmt::Display>(all: &[T], between: &str) -> String {
    all.iter().map(T::to_string).collect::<Vec<_>>().join(between)
}

fn would_do(relief: &[Relief]) -> String {
    if relief.is_empty() { String::new() } else { format!("; {} would do", listed(relief, " and ")) }
}

/// Why a machine cannot be kept balanced.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NotKept {
    /// A number that cannot be.
    #[error("{what} {value}: want {want}")]
    OutOfRange {
        /// What it is of.
        what: String,
        /// What was given.
        value: f64,
        /// What would be right.
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
    /// However far all that may change goes.
    #[error(
        "nothing that may change balances this machine: {left} remain at best in {condition}; want more parameters free"
    )]
    Inconsistent {
        /// The condition that stays furthest from met.
        condition: String,
        /// What remains, with unit.
        left: String,
    },
    /// Some mass would have to vanish, or be less than nothing.
    #[error("only a mass of nothing or less would balance this machine: want more parameters free")]
    NoMass,
    /// These limits, and no fewer of them, leave no way.
    #[error("no balance within these limits: {}{}", listed(.limits, "; "), would_do(.relief))]
    Conflict {
        /// They contradict each other; with any of them away the others do not.
        limits: Vec<Limit>,
        /// What is enough to give way, of these and of all others: the least Σ p times how far.
        relief: Vec<Relief>,
    },
    /// The solver gave up.
    #[error("the solver found no answer: {0}")]
    Failed(String),
    /// The result is no machine.
    #[error("the machine with it: {0}")]
    Machine(String),
}
