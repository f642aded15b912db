//! The arguments of the whole program, from which help, completions and manual pages are made.

use std::sync::OnceLock;

use clap::{CommandFactory, Parser};

use super::exit::silence_notes;
use super::failure::Failure;
use super::{OpenArguments, Subcommand};

/// Zero reaction manipulators: design, plan, simulate, see and record what a robot arm does to its base.
///
/// Without a command, opens a window on a scenario; without a display, records it instead.
#[derive(Parser)]
#[command(name = "stillbase", version = version(), args_conflicts_with_subcommands = true, after_help = EXAMPLES)]
pub struct Arguments {
    /// What to do; without it, a scenario is opened.
    #[command(subcommand)]
    pub command: Option<Subcommand>,
    /// What to open.
    #[command(flatten)]
    pub open: OpenArguments,
    /// Print no notes and no progress on standard error; errors stay
    #[arg(long, global = true)]
    pub quiet: bool,
}

const EXAMPLES: &str = "\
Examples:
  stillbase                                      the paper's case 3, in a window
  stillbase headless -o cases.rrd                the three cases, recorded for the Rerun viewer
  stillbase check nine-link --set link.5.com=0   what one misplaced centre of mass does
  stillbase import motion.csv -o quiet.toml      your own motion, and the nearest one without reactions
  stillbase reach nine-link 0.5,0.5 0.55,0.9     which b reach both points

Units are SI and angles are radians. `-` reads a scenario or a machine from standard input. Exit status: 0 done, 1 the
question has no answer, 2 wrong input.";

/// The commit that was built.
static COMMIT: OnceLock<&str> = OnceLock::new();

/// Says which commit was built, for `--version`.
pub fn name_commit(commit: &'static str) {
    COMMIT.get_or_init(|| commit);
}

/// Returns the version, the commit if it is known, and the profile.
fn version() -> String {
    let profile = if cfg!(debug_assertions) { "dev" } else { "release" };
    let commit = COMMIT.get().map_or_else(String::new, |commit| format!("commit {commit}, "));
    format!("{} ({commit}profile {profile})", env!("CARGO_PKG_VERSION"))
}

impl Arguments {
    /// Returns the program as clap knows it.
    pub fn program() -> clap::Command {
        Self::command()
    }

    /// Carries out what the arguments ask for.
    pub fn run(&self) -> Result<(), Failure> {
        silence_notes(self.quiet);
        match &self.command {
            Some(command) => command.run(),
            None => self.open.run(),
        }
    }
}
