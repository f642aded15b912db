//! The command line, one file for each subcommand: each reads its input, calls the library and prints.
//!
//! This crate serves the workspace alone, and may change in any version.
//!
//! Names and JSON keys are a contract that scripts depend on. Results go to standard output, messages and the progress
//! bar to standard error. Exit status: 0 done, 1 the question has no answer, 2 wrong input. A program that
//! carries out a command within itself may stop it.

mod check;
mod check_assembly;
mod compare;
mod completions;
mod design;
mod diff;
mod dimensions;
pub mod dynamics;
mod ends;
mod exit;
mod export;
mod export_model;
mod export_model_assembly;
pub mod failure;
#[cfg(feature = "ui")]
mod figures;
mod file_form;
#[cfg(feature = "record")]
mod headless;
#[cfg(feature = "record")]
mod holds;
mod import;
mod import_model;
mod in_process;
pub mod input;
mod interrupt;
mod joints;
mod keys;
mod layers;
mod learn;
mod lookup;
mod machines;
mod man;
mod misnamed;
mod new_machine;
mod open;
mod output;
mod plan;
mod pose;
mod program;
mod progress;
mod reach;
mod remedy;
#[cfg(feature = "ui")]
mod render;
#[cfg(feature = "record")]
mod replay;
#[cfg(feature = "ui")]
mod report;
mod results;
mod rows;
mod schema;
mod signal_choice;
mod signal_source;
mod simulate;
mod simulate_assembly;
mod sites;
#[cfg(any(feature = "record", feature = "ui"))]
mod size;
mod spectrum;
mod stop;
mod strict;
mod table;
mod tolerance;
mod trim;
mod turn_map;
mod workspace;

pub use in_process::{InProcessAnswer, answer, answer_until, carry_out, takes_one_value_each};
pub use interrupt::watch;
pub use open::OpenArguments;
pub use program::{Arguments, name_commit};
pub use stop::StopFlag;

use failure::Failure;
use stillbase_study::assembly_check::AssemblyReport;
use stillbase_study::assembly_weights::AssemblyWeightReport;
use stillbase_study::centres::{DesignReport, RebalanceReport};
use stillbase_study::counterweights::CounterweightReport;
use stillbase_study::equations::StatedEquations;
use stillbase_study::joint_extremes::JointReport;
use stillbase_study::layers::LayersReport;
use stillbase_study::plan_summary::PlanSummary;
use stillbase_study::trim::{OrbitReport, TrimReport};
use stillbase_study::workspace::WorkspaceReport;

/// Declares the subcommands from one list: the name of each, the type that reads its arguments and runs it, and the
/// types of what it prints with `--json`.
macro_rules! subcommands {
    ($($(#[$gate:meta])? $name:ident: $file:ident::$command:ident $(=> [$($answer:ty),+])?,)*) => {
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

        /// Returns the schemas of what each subcommand prints with `--json`, in the order of [`names`].
        fn answers() -> Vec<Vec<schemars::Schema>> {
            Vec::from([$($(#[$gate])? vec![$($(schema::of::<$answer>()),+)?]),*])
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
    Headless: headless::HeadlessArguments => [headless::Answer],
    Simulate: simulate::SimulateArguments => [simulate::Answer],
    #[cfg(feature = "record")]
    Replay: replay::ReplayArguments => [replay::Answer],
    Diff: diff::DiffArguments => [diff::Answer],
    Table: table::TableArguments,
    Compare: compare::CompareArguments => [compare::Answer],
    Joints: joints::JointsArguments => [JointReport],
    Machines: machines::MachinesArguments => [machines::Answer],
    Keys: keys::KeysArguments => [keys::Answer],
    Check: check::CheckArguments => [check::Answer, AssemblyReport],
    Learn: learn::LearnArguments => [StatedEquations],
    Design: design::DesignArguments => [
        DesignReport, RebalanceReport, CounterweightReport, AssemblyWeightReport, design::FrontsAnswer, design::VariedAnswer
    ],
    Layers: layers::LayersArguments => [LayersReport],
    Dynamics: dynamics::DynamicsArguments => [dynamics::Answer],
    Reach: reach::ReachArguments => [reach::Answer],
    Pose: pose::PoseArguments => [pose::Answer],
    Plan: plan::PlanArguments => [PlanSummary],
    Workspace: workspace::WorkspaceArguments => [WorkspaceReport],
    TurnMap: turn_map::TurnMapArguments => [turn_map::Answer],
    Import: import::ImportArguments => [import::Answer],
    Export: export::ExportArguments => [export::Answer],
    ExportModel: export_model::ExportModelArguments => [export_model::Answer],
    ImportModel: import_model::ImportModelArguments => [import_model::Answer],
    Tolerance: tolerance::ToleranceArguments => [tolerance::ToleranceAnswer, tolerance::MergedParts],
    Spectrum: spectrum::SpectrumArguments => [spectrum::Answer],
    Trim: trim::TrimArguments => [TrimReport, OrbitReport],
    #[cfg(feature = "ui")]
    Render: render::RenderArguments => [render::Answer],
    #[cfg(feature = "ui")]
    Report: report::ReportArguments => [report::Answer],
    #[cfg(feature = "ui")]
    Figures: figures::FiguresArguments,
    Results: results::ResultsArguments => [results::Answer],
    Schema: schema::SchemaArguments,
    Completions: completions::CompletionsArguments,
    Man: man::ManArguments,
}
