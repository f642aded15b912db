//! The program: a window on a scenario, and a command for everything else.

use std::process::ExitCode;

use clap::{ArgMatches, FromArgMatches};
use stillbase_commands as commands;
use stillbase_commands::Arguments;

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
    option_env!("STILLBASE_COMMIT").into_iter().for_each(commands::name_commit);
    commands::watch();
    #[cfg(debug_assertions)]
    if let Ok(wanted) = std::env::var("STILLBASE_FAULT") {
        stillbase::files::fault::arm_fault(&wanted);
    }
    let words: Vec<_> = commands::words(std::env::args_os()).collect();
    let parses = |words: &[_]| Arguments::program().try_get_matches_from(words).is_ok();
    let line = commands::Line { words: &words, parses: &parses };
    let matches = Arguments::program().try_get_matches_from(&words);
    let parsed = matches.and_then(|matches| Ok((Arguments::from_arg_matches(&matches)?, asks_for_json(&matches))));
    let (arguments, as_json) = match parsed {
        Ok(parsed) => parsed,
        Err(error) => return commands::usage(&error, &line),
    };
    commands::exit_code(arguments.run(), as_json, &line)
}
