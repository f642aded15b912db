//! Balance: what of it a machine lacks, and where its masses must lie for it to have it, (7)–(10).
//!
//! Force balance g_k = 0 and invariance C_kl = 0 (k ≠ l) are n + n(n−1)/2 conditions, each a sum over what the machine
//! is made of: [`Breakdown`] says who brings what. They are linear in the mass m of a body and its first moment m l_c,
//! so [`design`](design()) solves them in one step for all centres of mass, and [`keep`](keep()) for whatever may change,
//! as little as it can and within bounds.

mod basis;
mod breakdown;
mod condition;
mod design;
mod distance;
mod keep;
mod parameter;
mod plane;

pub use breakdown::{Body, Breakdown, Source, Term};
pub use condition::Condition;
pub use design::{DesignError, Preset, conditions, design};
pub use keep::{Adjusted, Hold, Keep, Kept, Limit, NotKept, Relief, Side, keep, keep_with, unreachable_by_changes};
pub use parameter::{Parameter, Quantity};
pub(crate) use plane::{Equation, Plane};
