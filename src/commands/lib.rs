//! The command line, one file for each subcommand: each reads its input, calls the library and prints.
//!
//! This crate serves the workspace alone, and may change in any version.
//!
//! Names and JSON keys are a contract that scripts depend on. Results go to standard output, messages and the progress
//! bar to standard error. Exit status: 0 done, 1 the question has no answer, 2 wrong input.

mod check;
mod compare;
mod design;
mod diff;
mod dimensions;
pub mod dynamics;
mod ends;
mod exit;
mod export;
mod export_model;
pub mod failure;
#[cfg(feature = "ui")]
mod figures;
#[cfg(feature = "record")]
mod headless;
mod holds;
mod import;
mod import_model;
pub mod input;
mod interrupt;
mod joints;
mod keys;
mod layers;
mod learn;
mod machines;
mod misnamed;
mod new_machine;
mod open;
mod output;
mod plan;
mod pose;
#[cfg(any(feature = "record", feature = "ui"))]
mod progress;
mod reach;
mod remedy;
#[cfg(feature = "ui")]
mod render;
#[cfg(feature = "record")]
mod replay;
#[cfg(feature = "ui")]
mod report;
mod rows;
mod signal_source;
mod simulate;
mod sites;
#[cfg(any(feature = "record", feature = "ui"))]
mod size;
mod spectrum;
#[cfg(feature = "record")]
mod table;
mod tolerance;
mod trim;
mod workspace;

pub use exit::{Line, exit_code, usage};
pub use input::words;
pub use interrupt::watch;
pub use open::OpenArguments;

use failure::Failure;

/// Declares the subcommands from one list: the name of each, and the type that reads its arguments and runs it.
macro_rules! subcommands {
    ($($(#[$gate:meta])? $name:ident: $file:ident::$command:ident,)*) => {
        /// The subcommands of the program.
        #[derive(clap::Subcommand)]
        #[expect(missing_docs, reason = "a line of documentation would replace the help of the arguments")]
        pub enum Subcommand {
            $($(#[$gate])? $name($file::$command),)*
        }

        /// Returns the names of the subcommands.
        fn names() -> Vec<String> {
            let all = <Subcommand as clap::Subcommand>::augment_subcommands(clap::Command::new("stillbase"));
            all.get_subcommands().map(|command| command.get_name().to_owned()).collect()
        }

        impl Subcommand {
            /// Runs the subcommand.
            pub fn run(&self) -> Result<(), Failure> {
                match self {
                    $($(#[$gate])? Self::$name(command) => command.run(),)*
                }
            }
        }
    };
}

// In the order of the help.
subcommands! {
    #[cfg(feature = "record")]
    Headless: headless::HeadlessArguments,
    Simulate: simulate::SimulateArguments,
    #[cfg(feature = "record")]
    Replay: replay::ReplayArguments,
    Diff: diff::DiffArguments,
    #[cfg(feature = "record")]
    Table: table::TableArguments,
    Compare: compare::CompareArguments,
    Joints: joints::JointsArguments,
    Machines: machines::MachinesArguments,
    Keys: keys::KeysArguments,
    Check: check::CheckArguments,
    Learn: learn::LearnArguments,
    Design: design::DesignArguments,
    Layers: layers::LayersArguments,
    Dynamics: dynamics::DynamicsArguments,
    Reach: reach::ReachArguments,
    Pose: pose::PoseArguments,
    Plan: plan::PlanArguments,
    Workspace: workspace::WorkspaceArguments,
    Import: import::ImportArguments,
    Export: export::ExportArguments,
    ExportModel: export_model::ExportModelArguments,
    ImportModel: import_model::ImportModelArguments,
    Tolerance: tolerance::ToleranceArguments,
    Spectrum: spectrum::SpectrumArguments,
    Trim: trim::TrimArguments,
    #[cfg(feature = "ui")]
    Render: render::RenderArguments,
    #[cfg(feature = "ui")]
    Report: report::ReportArguments,
    #[cfg(feature = "ui")]
    Figures: figures::FiguresArguments,
}
