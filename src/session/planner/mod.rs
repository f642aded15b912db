//! From a task to a motion: poses for its points, a path through them, and when to be where. One way for any number of
//! drives: what a machine cannot do its pose space says.

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

pub use along::curves;
pub(super) use choose::plan;
pub use plan::Plan;
