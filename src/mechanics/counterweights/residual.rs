//! [`ConditionResidual`]: residual of each condition of (7) and (8), and its change with counterweights.

use super::refusal::CounterweightError;
use super::spec::{CounterweightSite, CounterweightSpec};
use super::units::Units;
use crate::balance::Condition;
use crate::machine::{Inertia, Machine, ResolvedLink};
use crate::planar::Vector;

/// The residual of one condition of (7) or (8).
pub(super) struct ConditionResidual {
    pub condition: Condition,
    /// Residual of the bare machine with the mean payload: the real part along the axes, the imaginary part across
    /// them. All numbers are in the units of the machine.
    pub residual: Vector,
    /// Residual with the smallest and with the largest payload.
    pub ends: [Vector; 2],
    /// Derivatives with respect to each site's counterweight: of the real part by its mass w and by s = w x;
    /// of the imaginary part by t = w y, which are 0 where the counterweight must lie on the axis.
    pub changes: Vec<[f64; 3]>,
}

impl ConditionResidual {
    /// Returns whether a counterweight at any site changes the real part.
    pub fn is_touched(&self) -> bool {
        self.changes.iter().any(|[by_w, by_s, _]| *by_w != 0.0 || *by_s != 0.0)
    }

    /// Returns whether a counterweight at any site changes the imaginary part.
    pub fn is_touched_across(&self) -> bool {
        self.changes.iter().any(|[_, _, by_t]| *by_t != 0.0)
    }
}

/// Returns the residual of each condition, and its derivatives by w, s and t at each site, in units of the machine.
/// `parts` are its links in these units; `beyond` is in kg m and kg m².
pub(super) fn conditions(
    bare: &Machine,
    inertia: &Inertia,
    units: Units,
    parts: &[ResolvedLink],
    request: &CounterweightSpec,
    beyond: &[Vector],
) -> Result<Vec<ConditionResidual>, CounterweightError> {
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
        let change = |site: &CounterweightSite| {
            let part = &parts[site.link];
            let by_t = if site.across > 0.0 { condition.by_cross_moment(part) } else { 0.0 };
            [condition.by_mass(part), condition.by_moment(part), by_t]
        };
        let (more, unit) = (beyond.get(i).copied().unwrap_or_default(), units.residual(condition));
        ConditionResidual {
            condition,
            residual: (condition.residual(inertia) + more) / unit,
            ends: [0, 1].map(|i| (condition.residual(&ends[i]) + more) / unit),
            changes: request.sites.iter().map(change).collect(),
        }
    };
    Ok(Condition::all_of(bare).enumerate().map(of).collect())
}
