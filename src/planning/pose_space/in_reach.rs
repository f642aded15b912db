//! [`Reach`]: whether a hand's target can be reached while b is held.

use crate::mechanics::planar::Vector;
use crate::planning::reactionless::Decimal;

/// Whether a target can be reached at the present b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reach {
    /// The target can be reached.
    Inside,
    /// It cannot; the machine waits at the nearest point that it can reach with b held.
    Outside {
        /// Where it waits, m.
        nearest: Vector,
        /// The b nearest to the present one that would reach the target, rad; none if no b does.
        mending_b: Option<f64>,
        /// The same as it is shown: rounded to where it still does.
        shown_b: Option<Decimal>,
        /// A pose of this b reaches it, but beyond a fold, or a change point to keep off.
        other_sheet: bool,
    },
    /// It cannot any more since b was changed, so the machine keeps its relative angles and turns with its workspace.
    Carried,
}
