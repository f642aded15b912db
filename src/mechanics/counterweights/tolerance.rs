//! [`worst_residual`]: residuals of balance from tolerances of mass and position of counterweights.

use serde::Serialize;

use crate::assembly::Assembly;
use crate::balance::Condition;
use crate::machine::Machine;
use crate::planar::Vector;

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
    worst_with(machine, 0.0, tolerance)
}

/// Does the same for the blocks of an assembly: the largest residuals of any of them. What a block carries deviates by
/// the masses of its counterweights.
pub fn worst_residual_in_assembly(assembly: &Assembly, tolerance: &PlacementTolerance) -> WorstResidual {
    let weights = |block: usize| -> f64 {
        assembly.blocks()[block].machine.spec().counterweights.iter().map(|weight| weight.mass).sum()
    };
    let of = |block: usize| {
        let carried = assembly.branch(block).1.into_iter().skip(1).map(weights).sum();
        worst_with(&assembly.blocks()[block].machine, carried, tolerance)
    };
    let worse = |a: WorstResidual, b: WorstResidual| WorstResidual {
        force: a.force.max(b.force),
        coupling: a.coupling.max(b.coupling),
    };
    (0..assembly.blocks().len()).map(of).fold(WorstResidual { force: 0.0, coupling: 0.0 }, worse)
}

/// Returns the largest residuals of a machine that carries counterweights of a mass, kg, at its end effector.
fn worst_with(machine: &Machine, carried: f64, tolerance: &PlacementTolerance) -> WorstResidual {
    let end = machine.end_effector().map(|x| Vector::new(x, 0.0));
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
        let sum = each.sum::<f64>() + tolerance.mass * condition.of(carried, &end).norm();
        match condition {
            Condition::Force(_) => worst.force = worst.force.max(sum),
            Condition::Coupling(..) => worst.coupling = worst.coupling.max(sum),
        }
    }
    worst
}
