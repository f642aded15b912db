//! The program: a window on a scenario, and a command for everything else.

mod commands;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Zero reaction manipulators: design, plan, simulate, see and record what a robot arm does to its base.
///
/// Without a command, opens a window on a scenario; without a display, records it instead.
#[derive(Parser)]
#[command(name = "stillbase", version, args_conflicts_with_subcommands = true, after_help = EXAMPLES)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    open: commands::Open,
}

#[derive(Subcommand)]
enum Command {
    #[cfg(feature = "record")]
    Headless(commands::Headless),
    Simulate(commands::Simulate),
    Compare(commands::Compare),
    Joints(commands::JointsCommand),
    Machines(commands::Machines),
    Check(commands::Check),
    Design(commands::Design),
    Dynamics(commands::Dynamics),
    Reach(commands::Reach),
    Pose(commands::Pose),
    Plan(commands::Plan),
    Workspace(commands::Workspace),
    Import(commands::Import),
    Export(commands::Export),
    Tolerance(commands::Tolerance),
    Spectrum(commands::SpectrumOf),
    #[cfg(feature = "ui")]
    Figures(commands::Figures),
}

const EXAMPLES: &str = "\
Examples:
  stillbase                                      the paper's case 3, in a window
  stillbase headless -o cases.rrd                the three cases, recorded for the Rerun viewer
  stillbase check nine-link --set link.5.com=0   what one misplaced centre of mass does
  stillbase import motion.csv -o quiet.toml      your own motion, and the nearest one without reactions
  stillbase reach nine-link 0.5,0.5 0.55,0.9     which b reach both points

Units are SI and angles are radians. Exit status: 0 done, 1 the question has no answer, 2 wrong input.";

fn main() -> ExitCode {
    commands::watch();
    #[cfg(debug_assertions)]
    if let Ok(wanted) = std::env::var("STILLBASE_FAULT") {
        stillbase::files::fault::arm(&wanted);
    }
    let arguments = match Arguments::try_parse_from(commands::words(std::env::args_os())) {
        Ok(arguments) => arguments,
        Err(error) => return commands::usage(&error),
    };
    let done = match arguments.command {
        None => arguments.open.run(),
        #[cfg(feature = "record")]
        Some(Command::Headless(command)) => command.run(),
        Some(Command::Simulate(command)) => command.run(),
        Some(Command::Compare(command)) => command.run(),
        Some(Command::Joints(command)) => command.run(),
        Some(Command::Machines(command)) => command.run(),
        Some(Command::Check(command)) => command.run(),
        Some(Command::Design(command)) => command.run(),
        Some(Command::Dynamics(command)) => command.run(),
        Some(Command::Reach(command)) => command.run(),
        Some(Command::Pose(command)) => command.run(),
        Some(Command::Plan(command)) => command.run(),
        Some(Command::Workspace(command)) => command.run(),
        Some(Command::Import(command)) => command.run(),
        Some(Command::Export(command)) => command.run(),
        Some(Command::Tolerance(command)) => command.run(),
        Some(Command::Spectrum(command)) => command.run(),
        #[cfg(feature = "ui")]
        Some(Command::Figures(command)) => command.run(),
    };
    commands::exit_code(done)
}
