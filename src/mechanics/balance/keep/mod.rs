//! Keeping a machine balanced: the least change of chosen parameters with which (7) and (8) hold.
//!
//! The objective is Σ (p Δ)² over the parameters that may change. Δ, kg or m, is the change from the reference value
//! [`from`](ListedParameter::from). With all l_c as parameters and reference 0 it is the objective of
//! [`design`](super::design()). (7) and (8) are linear in m and s = m l_c, and so is a bound on l_c: lo m ≤ s ≤ hi m.
//! If no body may change both its mass and a position, this is a quadratic program with one optimum. The solutions of
//! (7) and (8) form a plane; the answer is the point of this plane within the bounds that has the least change. If one
//! body may change both, [`search`] starts from several points, and the answer is not certified.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | m, l_c | mass of a body; its position along or across its link | kg, m |
//! | m₀, l₀ | their reference values, from which changes are measured | kg, m |
//! | p | penalty on a change | 1/kg, 1/m |
//! | y | p (m − m₀) of a mass, p (m/m₀)(l_c − l₀) of a position: (7) and (8) are linear in them | |
//! | z | y = y₀ + N z satisfies (7) and (8) for every z; N has orthonormal columns | |

mod problem;
mod refusal;
mod request;
mod search;

pub use problem::{RebalancedMachine, rebalance, rebalance_with, unreachable_by_changes};
pub use refusal::{LimitRelaxation, LimitSide, ParameterLimit, RebalanceError};
pub use request::{ListedParameter, ParameterBounds, RebalanceRequest};
