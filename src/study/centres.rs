//! Balance by moving the links' centres of mass, with a report: [`design_centres`] places them all anew, and
//! [`rebalance_report`] changes the machine as little as possible.

use schemars::JsonSchema;
use serde::Serialize;

use super::balance_constants::BalanceConstants;
use super::measures::Measures;
use stillbase_mechanics::balance::{
    BodyQuantity, DesignError, ListedParameter, RebalanceError, RebalanceRequest, design, rebalance,
};
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_planning::Motion;

/// Report on a machine whose centres of mass were placed by Eq. (10).
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
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
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct RebalanceReport {
    /// Parameters that may change, in the order of the request.
    pub changes: Vec<RebalanceChange>,
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
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct RebalanceChange {
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

/// Balances a machine by the centres of mass of its links with the least Σ (p l_c)², and reports on it. The motion must
/// have as many drives as the machine.
///
/// # Errors
/// As [`design`].
pub fn design_centres(
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

/// Balances a machine with the least change of the given parameters, and reports on it. The motion must have as many
/// drives as the machine.
///
/// # Errors
/// As [`rebalance`].
pub fn rebalance_report(
    machine: &Machine,
    request: &RebalanceRequest,
    motion: Option<&Motion>,
) -> Result<(Machine, RebalanceReport), RebalanceError> {
    let rebalanced = rebalance(machine, request)?;
    let change = |(one, value): (&ListedParameter, &f64)| RebalanceChange {
        key: one.parameter.key(machine),
        from: one.parameter.value(machine.spec()).unwrap_or_default(),
        to: *value,
        penalty: one.penalty,
        unit: if one.parameter.quantity == BodyQuantity::Mass { "kg" } else { "m" },
    };
    let report = RebalanceReport {
        changes: request.parameters.iter().zip(&rebalanced.values).map(change).collect(),
        cost: rebalanced.cost,
        certified: rebalanced.certified,
        measures: Measures::of(machine, &rebalanced.machine, motion),
        balance: BalanceConstants::of(&Inertia::of(&rebalanced.machine)),
    };
    Ok((rebalanced.machine, report))
}
