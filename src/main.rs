//! The program: a window on a scenario, and a command for everything else.

use std::process::ExitCode;

use clap::{ArgMatches, CommandFactory, FromArgMatches, Parser};
use stillbase_commands as commands;

/// Zero reaction manipulators: design, plan, simulate, see and record what a robot arm does to its base.
///
/// Without a command, opens a window on a scenario; without a display, records it instead.
#[derive(Parser)]
#[command(name = "stillbase", version, args_conflicts_with_subcommands = true, after_help = EXAMPLES)]
struct Arguments {
    #[command(subcommand)]
    command: Option<commands::Subcommand>,
    #[command(flatten)]
    open: commands::OpenArguments,
}

const EXAMPLES: &str = "\
Examples:
  stillbase                                      the paper's case 3, in a window
  stillbase headless -o cases.rrd                the three cases, recorded for the Rerun viewer
  stillbase check nine-link --set link.5.com=0   what one misplaced centre of mass does
  stillbase import motion.csv -o quiet.toml      your own motion, and the nearest one without reactions
  stillbase reach nine-link 0.5,0.5 0.55,0.9     which b reach both points

Units are SI and angles are radians. Exit status: 0 done, 1 the question has no answer, 2 wrong input.";

/// Sets `XDG_RUNTIME_DIR`, if unset, to a folder that does not exist. Otherwise graphics libraries that look for a
/// display there print on standard error that the variable is not set.
fn name_runtime_folder() {
    const FOLDER: &str = "XDG_RUNTIME_DIR";
    if cfg!(target_os = "linux") && std::env::var_os(FOLDER).is_none_or(|folder| folder.is_empty()) {
        // SAFETY: the program has just begun and has no other thread.
        unsafe { std::env::set_var(FOLDER, "/nonexistent") };
    }
}

/// Returns whether the subcommand is to print JSON.
fn asks_for_json(matches: &ArgMatches) -> bool {
    let asks = |(_, own): (&str, &ArgMatches)| matches!(own.try_get_one::<bool>("json"), Ok(Some(true)));
    matches.subcommand().is_some_and(asks)
}

fn main() -> ExitCode {
    name_runtime_folder();
    commands::watch();
    #[cfg(debug_assertions)]
    if let Ok(wanted) = std::env::var("STILLBASE_FAULT") {
        stillbase::files::fault::arm_fault(&wanted);
    }
    let words: Vec<_> = commands::words(std::env::args_os()).collect();
    let parses = |words: &[_]| Arguments::command().try_get_matches_from(words).is_ok();
    let line = commands::Line { words: &words, parses: &parses };
    let matches = Arguments::command().try_get_matches_from(&words);
    let parsed = matches.and_then(|matches| Ok((Arguments::from_arg_matches(&matches)?, asks_for_json(&matches))));
    let (arguments, as_json) = match parsed {
        Ok(parsed) => parsed,
        Err(error) => return commands::usage(&error, &line),
    };
    let done = arguments.command.map_or_else(|| arguments.open.run(), |command| command.run());
    commands::exit_code(done, as_json, &line)
}
