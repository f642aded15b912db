//! [`worst_residual`]: residuals of balance from tolerances of mass and position of counterweights.

use serde::Serialize;

use crate::balance::Condition;
use crate::machine::Machine;

/// Tolerances of a counterweight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacementTolerance {
    /// Relative tolerance of its mass: 0.01 is one per cent.
    pub mass: f64,
    /// Tolerance of its position, m.
    pub place: f64,
}

impl PlacementTolerance {
    /// Tolerances of one per cent and of half a millimetre.
    pub const DEFAULT: Self = Self { mass: 0.01, place: 5e-4 };
}

/// Largest residuals of (7) and (8).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WorstResidual {
    /// Largest |g_k|, kg m.
    pub force: f64,
    /// Largest |C_kl|, kg m².
    pub coupling: f64,
}

/// Returns the largest residuals of a balanced machine if all counterweights deviate by their tolerances with the worst
/// signs. Products of deviations are neglected.
pub fn worst_residual(machine: &Machine, tolerance: &PlacementTolerance) -> WorstResidual {
    let mut worst = WorstResidual { force: 0.0, coupling: 0.0 };
    for condition in Condition::all_of(machine) {
        let each = machine.spec().counterweights.iter().filter_map(|weight| {
            let link = machine.spec().link_index(&weight.link)?;
            let part = &machine.resolved_links()[link];
            let (by_mass, by_moment) = (condition.by_mass(part), condition.by_moment(part));
            let by_cross = condition.by_cross_moment(part);
            let per_mass = (by_mass + weight.at * by_moment).hypot(weight.across * by_cross);
            // Off the axis, a deviation of the position may point anywhere; `by_cross` has the magnitude of `by_moment`.
            Some(weight.mass * (tolerance.mass * per_mass + tolerance.place * by_moment.abs()))
        });
        let sum: f64 = each.sum();
        match condition {
            Condition::Force(_) => worst.force = worst.force.max(sum),
            Condition::Coupling(..) => worst.coupling = worst.coupling.max(sum),
        }
    }
    worst
}
