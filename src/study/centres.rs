//! Balance by moving the centres of mass of the links, with a report: [`designed`] from scratch, or [`kept`] with the
//! least change.

use serde::Serialize;

use super::balance_constants::BalanceConstants;
use super::measures::Measures;
use crate::mechanics::balance::{Adjusted, DesignError, Keep, NotKept, Quantity, design, keep};
use crate::mechanics::machine::{Inertia, Machine};
use crate::planning::Motion;

/// Report on a machine whose centres of mass were placed by Eq. (10).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DesignReport {
    /// l_c of each link, m.
    pub com: Vec<f64>,
    /// Comparison with the original machine.
    #[serde(flatten)]
    pub measures: Measures,
    /// Balance constants of the new machine.
    #[serde(flatten)]
    pub balance: BalanceConstants,
}

/// Report on a machine that was balanced with the least change.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KeptReport {
    /// Parameters that may change, in the order of the request.
    pub changes: Vec<KeptChange>,
    /// Value of the objective, Σ (p Δ)² over the changes.
    pub cost: f64,
    /// Whether the minimum within the limits is proven.
    pub certified: bool,
    /// Comparison with the original machine.
    #[serde(flatten)]
    pub measures: Measures,
    /// Balance constants of the new machine.
    #[serde(flatten)]
    pub balance: BalanceConstants,
}

/// One parameter that may change.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KeptChange {
    /// Key, such as `link.5.com`.
    pub key: String,
    /// Value before.
    pub from: f64,
    /// Value after.
    pub to: f64,
    /// Penalty p, 1/m or 1/kg.
    pub penalty: f64,
    /// Unit, m or kg.
    pub unit: &'static str,
}

/// Balances a machine by the centres of mass of its links with the least Σ (p l_c)², and reports on it. A motion has as
/// many drives as the machine.
///
/// # Errors
/// As [`design`].
pub fn designed(
    machine: &Machine,
    penalty: &[f64],
    motion: Option<&Motion>,
) -> Result<(Machine, DesignReport), DesignError> {
    let designed = design(machine, penalty)?;
    let report = DesignReport {
        com: designed.links().iter().map(|link| link.com).collect(),
        measures: Measures::of(machine, &designed, motion),
        balance: BalanceConstants::of(&Inertia::of(&designed)),
    };
    Ok((designed, report))
}

/// Balances a machine with the least change of the given parameters, and reports on it. A motion has as many drives as
/// the machine.
///
/// # Errors
/// As [`keep`].
pub fn kept(machine: &Machine, asked: &Keep, motion: Option<&Motion>) -> Result<(Machine, KeptReport), NotKept> {
    let kept = keep(machine, asked)?;
    let change = |(one, value): (&Adjusted, &f64)| KeptChange {
        key: one.parameter.key(machine),
        from: one.parameter.value(machine.spec()).unwrap_or_default(),
        to: *value,
        penalty: one.penalty,
        unit: if one.parameter.quantity == Quantity::Mass { "kg" } else { "m" },
    };
    let report = KeptReport {
        changes: asked.parameters.iter().zip(&kept.values).map(change).collect(),
        cost: kept.cost,
        certified: kept.certified,
        measures: Measures::of(machine, &kept.machine, motion),
        balance: BalanceConstants::of(&Inertia::of(&kept.machine)),
    };
    Ok((kept.machine, report))
}
