//! [`CounterweightError`]: the reason why there are no counterweights, and the relaxed bounds with which there are.

use std::fmt;

use thiserror::Error;

use crate::machine::MachineError;

/// A bound that may contradict others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Bound {
    /// Lower bound of the position of a link's counterweight.
    From(String),
    /// Upper bound of the position of a link's counterweight.
    To(String),
    /// Upper bound of the distance of a link's counterweight to the left of the link's axis.
    Left(String),
    /// Upper bound of the distance of a link's counterweight to the right of the link's axis.
    Right(String),
    /// Upper bound of the mass of a link's counterweight.
    Most(String),
    /// Upper bound of the total mass of the counterweights.
    Mass,
    /// Upper bound of Σ D_k.
    Inertia,
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::From(link) => write!(f, "link {link}: no further back"),
            Self::To(link) => write!(f, "link {link}: no further out"),
            Self::Left(link) => write!(f, "link {link}: no further to the left"),
            Self::Right(link) => write!(f, "link {link}: no further to the right"),
            Self::Most(link) => write!(f, "link {link}: no heavier"),
            Self::Mass => write!(f, "added mass: no more"),
            Self::Inertia => write!(f, "Σ D_k: no more"),
        }
    }
}

fn listed(bounds: &[Bound]) -> String {
    bounds.iter().map(Bound::to_string).collect::<Vec<_>>().join("; ")
}

/// A kind of bound that may be relaxed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoundKind {
    /// The bounds of the masses of single counterweights.
    Most,
    /// The bound of their total mass.
    Mass,
    /// The bound of Σ D_k.
    Inertia,
    /// The clearance of discs from pins.
    Clearance,
    /// The distance of counterweights from the axes of their links.
    Across,
}

/// Bounds that are minimised instead of an objective.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RelaxedBounds {
    /// The value that all bounds of a kind share, kg or kg m². Of clearance and distance from the axes there is none.
    Value(BoundKind),
    /// The factor by which all bounds of masses and of Σ D_k are multiplied.
    Factor,
}

/// Relaxed value of the bounds of one kind: the least feasible bound, or the greatest feasible clearance, rounded to
/// the feasible side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BoundRelaxation {
    /// Bound of each mass that has a bound, kg.
    Most(f64),
    /// Bound of the total mass, kg.
    Mass(f64),
    /// Bound of Σ D_k, kg m².
    Inertia(f64),
    /// Clearance of discs from pins, m.
    Clearance(f64),
    /// Distance of every counterweight from the axis of its link, to either side, m.
    Across(f64),
}

impl fmt::Display for BoundRelaxation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Most(x) => write!(f, "up to {} kg on each link that is bounded", BoundKind::Most.printed(*x)),
            Self::Mass(x) => write!(f, "up to {} kg in all", BoundKind::Mass.printed(*x)),
            Self::Inertia(x) => write!(f, "Σ D_k up to {} kg m²", BoundKind::Inertia.printed(*x)),
            Self::Clearance(x) => write!(f, "a clearance of {} m", BoundKind::Clearance.printed(*x)),
            Self::Across(x) => {
                write!(f, "counterweights up to {} m off the axis of their link", BoundKind::Across.printed(*x))
            }
        }
    }
}

impl BoundKind {
    /// Returns the number of decimals with which a bound is printed: six for kg and kg m², four for m, and more for
    /// small numbers.
    pub(super) fn decimals(self, bound: f64) -> usize {
        let (usual, digits) = match self {
            Self::Most | Self::Mass | Self::Inertia => (6, 4),
            Self::Clearance | Self::Across => (4, 2),
        };
        let leading = if bound > 0.0 { -bound.log10().floor() } else { 0.0 };
        // Of a negative number of decimals, `as` makes 0.
        usual.max((leading + f64::from(digits - 1)) as usize)
    }

    fn printed(self, bound: f64) -> String {
        format!("{bound:.*}", self.decimals(bound))
    }
}

/// Describes sets of relaxed bounds in words; each set is sufficient.
fn sufficient_relief(would: &[Vec<BoundRelaxation>]) -> String {
    let one = |together: &Vec<BoundRelaxation>| {
        let all: Vec<String> = together.iter().map(BoundRelaxation::to_string).collect();
        format!("; {} would do{}", all.join(" and "), if all.len() > 1 { " together" } else { "" })
    };
    would.iter().map(one).collect()
}

/// Reason why there are no counterweights.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CounterweightError {
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
    /// One link is named twice.
    #[error("link {0} may carry its counterweight in two ranges: want one a link")]
    Twice(String),
    /// A Pareto front is asked for while the rotor of this drive is free: Σ H_kk, which is minimised, and Σ D_k, which
    /// is measured, then differ by more than a constant.
    #[error("the rotor of drive {0} is free: want it fixed for a Pareto front, or one objective without a front")]
    FreeRotorOfFront(String),
    /// One rotor is named twice.
    #[error("the rotor of drive {0} is free in two ways: want its inertia or its ratio")]
    RotorTwice(String),
    /// A free gear ratio of a drive without a rotor.
    #[error("drive {0} has no rotor whose ratio could be chosen: want drive.{0}.rotor.inertia above 0")]
    NoRotor(String),
    /// The masses of the links lie off their axes, where no counterweight on an axis balances them.
    #[error(
        "{condition}, has {residual} that no counterweight on an axis takes away: want centres of mass on the axes of \
         their links (com_normal = 0), or a counterweight that may lie off the axis of {want}{}",
        sufficient_relief(.reliefs)
    )]
    OffAxis {
        /// The condition.
        condition: String,
        /// Its residual, with unit.
        residual: String,
        /// Links on which a counterweight off the axis would change it.
        want: String,
        /// A distance from the axes that is sufficient; empty if there is none.
        reliefs: Vec<Vec<BoundRelaxation>>,
    },
    /// A condition is not satisfied, and no counterweight on these links changes it.
    #[error("{condition}, stays at {residual}: want a counterweight on another link, too: {want}")]
    Untouched {
        /// The condition.
        condition: String,
        /// Its residual, with unit.
        residual: String,
        /// Links on which a counterweight would change it.
        want: String,
    },
    /// These bounds contradict each other: a minimal set.
    #[error(
        "no counterweights balance these links within these bounds: {}{}",
        listed(.bounds),
        sufficient_relief(.reliefs)
    )]
    Conflict {
        /// The bounds; if any one of them is removed, the others are feasible together.
        bounds: Vec<Bound>,
        /// Sets of relaxed bounds. Each set is sufficient with all other bounds unchanged, and contains as few kinds of
        /// bounds as possible.
        reliefs: Vec<Vec<BoundRelaxation>>,
    },
    /// No masses and positions on these links balance the machine.
    #[error("no counterweights on these links alone balance the whole: want more links that may carry one")]
    TooFew,
    /// No masses and positions on these links balance a block of an assembly.
    #[error("block {0}: no counterweights on these links alone balance it: want more of its links that may carry one")]
    TooFewOnBlock(String),
    /// Every solution would violate the clearance of a pin.
    #[error(
        "no counterweights balance these links and stay {clearance} m clear of every pin{}",
        sufficient_relief(.reliefs)
    )]
    Reaches {
        /// The clearance requested, m.
        clearance: f64,
        /// Sets of relaxed bounds. Each set is sufficient with all other bounds unchanged, and contains as few kinds of
        /// bounds as possible.
        reliefs: Vec<Vec<BoundRelaxation>>,
    },
    /// There are too many choices of intervals between pins to search all.
    #[error(
        "after {0} ways round the pins it is still not known whether there are counterweights: want fewer links that may carry one"
    )]
    TooMany(usize),
    /// The objective contains torque, which is D_k q̈_k only if each motor turns its drive alone.
    #[error(
        "the torque of a motor in a joint or behind a gear depends on more than its drive: want mass or inertia to be least"
    )]
    Coupled,
    /// A range of payloads is asked for, and the machine is a block of an assembly.
    #[error("a range of payloads is for one machine by itself: want payload.mass of a block")]
    PayloadOfAssembly,
    /// The solver failed.
    #[error(
        "whether there are such counterweights is closer than the solver can tell ({0}): want bounds a little wider, or tighter"
    )]
    Failed(String),
    /// The result is not a valid machine.
    #[error("the machine with them: {0}")]
    Machine(String),
}

impl CounterweightError {
    pub(super) fn out(what: &str, value: f64, want: impl ToString) -> Self {
        Self::OutOfRange { what: what.into(), value, want: want.to_string() }
    }
}

impl From<MachineError> for CounterweightError {
    fn from(why: MachineError) -> Self {
        Self::Machine(why.to_string())
    }
}
