//! [`Reach`]: whether the target of a drag can be reached while b is held.

use crate::following::Barrier;
use crate::reactionless::Decimal;
use stillbase_mechanics::planar::Vector;

/// Whether a target can be reached at the present b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reach {
    /// The target can be reached.
    Inside,
    /// The target cannot be reached; the machine stays at the nearest point that is feasible with b held.
    Outside {
        /// The nearest feasible point, m.
        nearest: Vector,
        /// The b nearest to the present one at which the target can be reached, rad; `None` if there is none.
        feasible_b: Option<f64>,
        /// `feasible_b` as displayed: rounded to a value that is still feasible.
        displayed_b: Option<Decimal>,
        /// Whether a pose at the present b reaches the target, but only beyond a fold or a change point that is to be
        /// avoided.
        other_sheet: bool,
    },
    /// On the way to the target, rates of zero momentum end; the machine waits there.
    Stopped {
        /// Where it waits, m.
        nearest: Vector,
        /// What it waits before.
        why: Barrier,
    },
    /// A change of b has made the target infeasible, so the machine keeps its relative angles and turns with its
    /// workspace.
    Carried,
}

impl Reach {
    /// Returns where the machine waits if the target cannot be reached, m.
    pub fn waits_at(&self) -> Option<Vector> {
        match *self {
            Self::Outside { nearest, .. } | Self::Stopped { nearest, .. } => Some(nearest),
            Self::Inside | Self::Carried => None,
        }
    }
}
