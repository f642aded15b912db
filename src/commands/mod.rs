//! The command line, one file a subcommand: each reads its input, asks the library, prints.
//!
//! Names and JSON keys are a contract that scripts depend on. Results go to standard output, messages and the progress
//! bar to standard error. Exit status: 0 done, 1 the question has no answer, 2 wrong input.

mod check;
pub(crate) mod columns;
mod compare;
mod csv_file;
mod design;
pub(crate) mod dynamics;
mod exit;
mod export;
pub(crate) mod failure;
#[cfg(feature = "ui")]
mod figures;
#[cfg(feature = "record")]
mod headless;
mod import;
pub(crate) mod input;
mod interrupt;
mod joints;
mod machines;
mod open;
mod output;
mod plan;
mod pose;
mod reach;
mod simulate;
mod spectrum;
pub(crate) mod tolerance;
mod workspace;

pub use check::Check;
pub use compare::Compare;
pub use design::Design;
pub use dynamics::Dynamics;
pub use exit::{exit_code, usage};
pub use export::Export;
#[cfg(feature = "ui")]
pub use figures::Figures;
#[cfg(feature = "record")]
pub use headless::Headless;
pub use import::Import;
pub use input::words;
pub use interrupt::watch;
pub use joints::JointsCommand;
pub use machines::Machines;
pub use open::Open;
pub use plan::Plan;
pub use pose::Pose;
pub use reach::Reach;
pub use simulate::Simulate;
pub use spectrum::SpectrumOf;
pub use tolerance::Tolerance;
pub use workspace::Workspace;
