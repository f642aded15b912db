//! What a person did: a scenario, edits and what became of them, step by step; undo, replay, the verdict.

mod edit;
mod live;
mod planning;
mod run;
pub mod scenario;
mod script;
mod survey;
pub mod verdict;

pub use edit::{Edit, TimedEdit};
pub use live::Session;
pub use planning::{Plan, curves};
pub use run::{Refusal, Run, Waiting, felt, replay, replay_if, settled};
pub(crate) use survey::survey;
