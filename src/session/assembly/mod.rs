//! Scenarios of assemblies: each block has a task of its own, and all share one base.
//!
//! A block is planned as a machine by itself that holds what it carries, so tasks, time laws, limits and refusals are those
//! of one machine. What the blocks put on the base together is computed in space.
//!
//! Window, command line and recording lead one block: its [`Scenario`](crate::scenario::Scenario) holds the
//! [`AssemblyBlock`], and its [`Run`](crate::Run) takes the others along, step by step. Friction, and payloads unknown to
//! the model, are left to scenarios of one machine.

mod against;
mod base;
mod block;
mod catalog;
mod effects;
mod file;
mod frame;
mod keys;
mod run;
mod shared;
mod stated_base;
mod tip;
mod tip_time;
mod words;

pub use base::{AssemblyBase, FreeBase, SpringBase};
pub use block::AssemblyBlock;
pub use catalog::{builtin_assembly_scenarios, builtin_scenario_text};
pub use file::{AssemblyScenario, BlockTask, TipTask, changed_keys};
pub use frame::{AssemblyFrame, AssemblyVerdict};
pub use keys::{ASSEMBLY_KEYS, assembly_key_of};
pub use shared::SharedRun;
pub use tip::TipPath;
