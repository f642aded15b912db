//! Messages on standard error, and the exit status.

use std::fmt::Display;
use std::io::{self, Write};
use std::process::ExitCode;

use stillbase_settings::text::{plain, shorten_message};

use super::failure::Failure;

/// Prints a message on standard error, in one line.
pub fn print_message(message: impl Display) {
    let message = message.to_string();
    let line = message.lines().map(str::trim).filter(|l| !l.is_empty()).collect::<Vec<_>>().join(" ");
    let line = shorten_message(&line);
    let line = plain(&line);
    // When standard error is closed, there is no place for a message.
    let _ = writeln!(io::stderr(), "stillbase: {line}");
}

/// Prints the reason of a failure, in one line, and returns the exit status.
pub fn exit_code(done: Result<(), Failure>) -> ExitCode {
    match done {
        Ok(()) | Err(Failure::ReaderGone) => ExitCode::SUCCESS,
        Err(Failure::NoAnswer(why)) => {
            print_message(why);
            ExitCode::from(1)
        }
        Err(Failure::WrongInput(why)) => {
            print_message(why);
            ExitCode::from(2)
        }
    }
}

/// Prints help, or the error of a command line that cannot be parsed; returns the exit status.
pub fn usage(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        let printed = error.print().and_then(|()| io::stdout().flush());
        return exit_code(printed.map_err(|e| Failure::standard_output(&e)));
    }
    exit_code(Err(Failure::WrongInput(in_one_line(&error.render().to_string()))))
}

/// Returns the error and its tips in one line, without the usage that follows.
fn in_one_line(rendered: &str) -> String {
    let parts = rendered.split("\n\n").filter(|p| !p.starts_with("Usage:") && !p.starts_with("For more information"));
    let mut line = String::new();
    for part in parts {
        let words: Vec<&str> = part.split_whitespace().collect();
        if !line.is_empty() {
            line.push_str("; ");
        }
        line.push_str(&words.join(" "));
    }
    // Negative numbers have been padded with a space, see `words`.
    format!("{}; see --help", line.strip_prefix("error: ").unwrap_or(&line).replace("' -", "'-"))
}
