//! A machine balanced by where the masses of its links lie, and what that comes to: [`designed`] anew, or [`kept`] with
//! the least change.

use serde::Serialize;

use super::balance_constants::BalanceConstants;
use super::measures::Measures;
use crate::mechanics::balance::{Adjusted, DesignError, Keep, NotKept, Quantity, design, keep};
use crate::mechanics::machine::{Inertia, Machine};
use crate::planning::Motion;

/// A machine whose centres of mass were placed, Eq. (10).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DesignReport {
    /// l_c of each link, m.
    pub com: Vec<f64>,
    /// Beside the machine that it was made from.
    #[serde(flatten)]
    pub measures: Measures,
    /// What is left of balance.
    #[serde(flatten)]
    pub balance: BalanceConstants,
}

/// A machine that was changed as little as it can be to be balanced.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KeptReport {
    /// What may change, in the order of what was asked.
    pub changes: Vec<KeptChange>,
    /// Σ (p Δ)² over the changes.
    pub cost: f64,
    /// Whether nothing else within the limits has less.
    pub certified: bool,
    /// Beside the machine that it was made from.
    #[serde(flatten)]
    pub measures: Measures,
    /// What is left of balance.
    #[serde(flatten)]
    pub balance: BalanceConstants,
}

/// One number that may change.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KeptChange {
    /// Such as `link.5.com`.
    pub key: String,
    /// Before.
    pub from: f64,
    /// Now.
    pub to: f64,
    /// p, 1/m or 1/kg.
    pub penalty: f64,
    /// m or kg.
    pub unit: &'static str,
}

/// A machine balanced by the centres of mass of its links with the least Σ (p l_c)², and what that comes to; a motion is
/// one of as many drives.
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

/// A machine balanced with the least change of what may change, and what that comes to; a motion is one of as many
/// drives.
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
