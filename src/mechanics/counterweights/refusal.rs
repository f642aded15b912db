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

/// What would do instead of the bounds of one kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Relief {
    /// The least bound on the masses that have one, kg.
    Most(f64),
    /// The least bound on what all weigh together, kg.
    Mass(f64),
    /// The least bound on Σ D_k, kg m².
    Inertia(f64),
}

impl fmt::Display for Relief {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Upwards, so that what is said does.
        let up = |x: &f64| format!("{:.6}", (x * 1e6 * (1.0 + 1e-9)).ceil() * 1e-6);
        match self {
            Self::Most(x) => write!(f, "; up to {} kg on each link that is bounded would do", up(x)),
            Self::Mass(x) => write!(f, "; up to {} kg in all would do", up(x)),
            Self::Inertia(x) => write!(f, "; Σ D_k up to {} kg m² would do", up(x)),
        }
    }
}

fn would_do(relief: &Option<Relief>) -> String {
    relief.map_or(String::new(), |relief| relief.to_string())
}

fn would_clear(would: &Option<f64>) -> String {
    match would {
        // Downwards, so that what is said does.
        Some(x) => format!("; {:.4} m would do", (x * 1e4).floor() * 1e-4),
        None => "; not even that they touch would do".into(),
    }
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
    #[error("no counterweights balance this machine within these bounds: {}{}", listed(.bounds), would_do(.relief))]
    Conflict {
        /// The bounds that contradict each other: with any of them away there is a way.
        bounds: Vec<Bound>,
        /// What would do, if bounds on masses or on inertia are among them.
        relief: Option<Relief>,
    },
    /// Whatever they weigh and wherever they sit.
    #[error("no counterweights on these links alone balance this machine: want more links that may carry one")]
    TooFew,
    /// They would reach a pin.
    #[error("no counterweights balance this machine and stay {} m clear of every pin{}", asked, would_clear(.would))]
    Reaches {
        /// How far they were to stay away, m.
        asked: f64,
        /// The furthest with which there is a way, m.
        would: Option<f64>,
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
