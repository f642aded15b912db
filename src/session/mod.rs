//! What a person did: a scenario, edits and what became of them, step by step; undo, replay, the verdict.

mod changes;
mod edit;
mod live;
mod planner;
mod refusal;
mod replay;
mod run;
pub mod scenario;
mod script;
mod survey;
pub mod verdict;

pub use edit::{Edit, TimedEdit};
pub use live::Session;
pub use planner::{Plan, curves};
pub use refusal::Refusal;
pub use replay::{felt, replay, replay_if, settled};
pub use run::{Run, Waiting};
pub(crate) use survey::survey;
