//! Plans the motion of a task: poses of its points, a path through them, and the timing. The same code plans for any
//! number of drives; the pose space says what a machine cannot do.

mod along;
mod change_b;
mod choose;
mod given;
mod held;
mod least_reaction;
mod momentum;
mod plan;
mod poses;
mod posture;
mod proposals;
mod rates;
mod turn_base;

pub use along::curves;
pub(super) use choose::plan;
pub(crate) use momentum::{momentum_model, rays_from};
pub use plan::Plan;
