//! [`ConditionResidual`]: residual of each condition of (7) and (8), and its change with counterweights.

use super::refusal::CounterweightError;
use super::spec::{CounterweightSite, CounterweightSpec};
use crate::balance::Condition;
use crate::machine::{Inertia, Machine};
use crate::planar::Vector;

/// The residual of one condition of (7) or (8).
pub(super) struct ConditionResidual {
    pub condition: Condition,
    /// Residual of the bare machine with the mean payload, kg m or kg m²: the real part along the axes, the imaginary
    /// part across them.
    pub residual: Vector,
    /// Residual along the axes with the smallest and with the largest payload.
    pub ends: [f64; 2],
    /// Derivatives of the residual with respect to the mass w, kg, and s = w x, kg m, of each site's counterweight.
    pub changes: Vec<[f64; 2]>,
}

impl ConditionResidual {
    /// Returns whether a counterweight at any site changes it.
    pub fn is_touched(&self) -> bool {
        self.changes.iter().flatten().any(|by| *by != 0.0)
    }
}

/// Returns the residual of each condition, and its derivatives by w and s at each site.
pub(super) fn conditions(
    bare: &Machine,
    inertia: &Inertia,
    request: &CounterweightSpec,
    beyond: &[Vector],
) -> Result<Vec<ConditionResidual>, CounterweightError> {
    let parts = bare.resolved_links();
    let holding = |mass: f64| -> Result<Inertia, CounterweightError> {
        let mut spec = bare.spec().clone();
        spec.payload.mass = mass;
        Ok(Inertia::of(&Machine::new(spec)?))
    };
    let ends = match request.payload {
        Some([low, high]) => [holding(low)?, holding(high)?],
        None => [inertia.clone(), inertia.clone()],
    };
    let of = |(i, condition): (usize, Condition)| {
        let change =
            |site: &CounterweightSite| [condition.by_mass(&parts[site.link]), condition.by_moment(&parts[site.link])];
        let more = beyond.get(i).copied().unwrap_or_default();
        ConditionResidual {
            condition,
            residual: condition.residual(inertia) + more,
            ends: [0, 1].map(|i| (condition.residual(&ends[i]) + more).re),
            changes: request.sites.iter().map(change).collect(),
        }
    };
    Ok(Condition::all(bare.drives()).enumerate().map(of).collect())
}
