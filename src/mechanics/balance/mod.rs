//! Balance of a machine: residuals of the conditions, and masses and centres of mass that satisfy them, (7)–(10).
//!
//! Force balance g_k = 0 and invariance C_kl = 0 (k < l) are n + n(n−1)/2 complex conditions. Each is a sum over
//! all bodies; [`Breakdown`] lists the contributions. The conditions are linear in the mass m of a body and its first
//! moment m l_c. So [`design`](design()) solves them in one step for all positions of centres of mass.
//! [`rebalance`](rebalance()) solves them with the least change of chosen parameters within bounds.

mod basis;
mod breakdown;
mod condition;
mod design;
mod distance;
mod keep;
mod parameter;
mod plane;

pub use breakdown::{BalanceTerm, Body, Breakdown, CarriedBody};
pub use condition::Condition;
pub use design::{DesignError, Preset, conditions, design};
pub use keep::{
    LimitRelaxation, LimitSide, ListedParameter, ParameterBounds, ParameterLimit, RebalanceError, RebalanceRequest,
    RebalancedMachine, rebalance, rebalance_with, unreachable_by_changes,
};
pub use parameter::{BodyQuantity, Parameter};
pub(crate) use plane::{LinearEquation, SolutionSpace};
