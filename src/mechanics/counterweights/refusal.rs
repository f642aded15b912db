//! [`NoWeights`]: why there are no counterweights, and what would have to give.

use std::fmt;

use thiserror::Error;

use crate::mechanics::machine::MachineError;

/// A bound that may stand in the way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Bound {
    /// How far back a link may carry its counterweight.
    From(String),
    /// How far towards its tip.
    To(String),
    /// How much it may weigh.
    Most(String),
    /// How much all may weigh together.
    Mass,
    /// Σ D_k.
    Inertia,
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::From(link) => write!(f, "link {link}: no further back"),
            Self::To(link) => write!(f, "link {link}: no further out"),
            Self::Most(link) => write!(f, "link {link}: no heavier"),
            Self::Mass => write!(f, "added mass: no more"),
            Self::Inertia => write!(f, "Σ D_k: no more"),
        }
    }
}

fn listed(bounds: &[Bound]) -> String {
    bounds.iter().map(Bound::to_string).collect::<Vec<_>>().join("; ")
}

/// A kind of bound that may give way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// On the mass of each counterweight that has one.
    Most,
    /// On what all weigh together.
    Mass,
    /// On Σ D_k.
    Inertia,
    /// How far discs stay from pins.
    Clearance,
}

/// What would do instead of the bounds of one kind: the least bound, or the greatest clearance, rounded so that it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Relief {
    /// On the masses that have a bound, kg.
    Most(f64),
    /// On what all weigh together, kg.
    Mass(f64),
    /// On Σ D_k, kg m².
    Inertia(f64),
    /// How far discs stay from pins, m.
    Clearance(f64),
}

impl fmt::Display for Relief {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Most(x) => write!(f, "up to {x:.6} kg on each link that is bounded"),
            Self::Mass(x) => write!(f, "up to {x:.6} kg in all"),
            Self::Inertia(x) => write!(f, "Σ D_k up to {x:.6} kg m²"),
            Self::Clearance(x) => write!(f, "a clearance of {x:.4} m"),
        }
    }
}

/// Each that would do, or what would do together.
fn would_do(would: &[Vec<Relief>]) -> String {
    let one = |together: &Vec<Relief>| {
        let all: Vec<String> = together.iter().map(Relief::to_string).collect();
        format!("; {} would do{}", all.join(" and "), if all.len() > 1 { " together" } else { "" })
    };
    would.iter().map(one).collect()
}

/// Why there are no counterweights.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoWeights {
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
    /// One link is named twice.
    #[error("link {0} may carry its counterweight in two ranges: want one a link")]
    Twice(String),
    /// One rotor is named twice.
    #[error("the rotor of drive {0} is free in two ways: want its inertia or its ratio")]
    RotorTwice(String),
    /// There is nothing to turn.
    #[error("drive {0} has no rotor whose ratio could be chosen: want drive.{0}.rotor.inertia above 0")]
    NoRotor(String),
    /// The masses of the links lie off their axes, where nothing on an axis balances them.
    #[error("{condition}, has {left} that no counterweight on an axis takes away: want com_normal 0")]
    OffAxis {
        /// The condition.
        condition: String,
        /// What remains, with unit.
        left: String,
    },
    /// No counterweight on these links changes a condition that is not met.
    #[error("{condition}, stays at {left}: want a counterweight on another link, too: {want}")]
    Untouched {
        /// The condition.
        condition: String,
        /// What remains, with unit.
        left: String,
        /// Links on which one would change it.
        want: String,
    },
    /// These bounds, and no fewer of them, leave no way.
    #[error("no counterweights balance this machine within these bounds: {}{}", listed(.bounds), would_do(.would))]
    Conflict {
        /// The bounds that contradict each other: with any of them away there is a way.
        bounds: Vec<Bound>,
        /// What would do with all other bounds as they are; where nothing does alone, what does together.
        would: Vec<Vec<Relief>>,
    },
    /// Whatever they weigh and wherever they sit.
    #[error("no counterweights on these links alone balance this machine: want more links that may carry one")]
    TooFew,
    /// They would reach a pin.
    #[error("no counterweights balance this machine and stay {asked} m clear of every pin{}", would_do(.would))]
    Reaches {
        /// How far they were to stay away, m.
        asked: f64,
        /// What would do with all other bounds as they are; where nothing does alone, what does together.
        would: Vec<Vec<Relief>>,
    },
    /// Too many ways round the pins to look at all.
    #[error(
        "after {0} ways round the pins it is still not known whether there are counterweights: want fewer links that may carry one"
    )]
    TooMany(usize),
    /// Torque is D_k q̈_k only where each motor turns its drive alone.
    #[error(
        "the torque of a motor in a joint or behind a gear depends on more than its drive: want mass or inertia to be least"
    )]
    Coupled,
    /// The solver gave up.
    #[error(
        "whether there are such counterweights is closer than the solver can tell ({0}): want bounds a little wider, or tighter"
    )]
    Failed(String),
    /// The result is no machine.
    #[error("the machine with them: {0}")]
    Machine(String),
}

impl NoWeights {
    pub(super) fn out(what: &str, value: f64, want: impl ToString) -> Self {
        Self::OutOfRange { what: what.into(), value, want: want.to_string() }
    }
}

impl From<MachineError> for NoWeights {
    fn from(why: MachineError) -> Self {
        Self::Machine(why.to_string())
    }
}
