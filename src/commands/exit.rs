//! Messages on standard error, and the exit status.

use std::fmt::Display;
use std::io::{self, Write};
use std::process::ExitCode;

use serde::Serialize;
use stillbase_session::Proposal;
use stillbase_settings::text::{plain, shell_word, shorten_message};

use super::failure::{Failure, RefusedScenario};
use super::output::Format;

/// Prints a message on standard error, in one line.
pub fn print_message(message: impl Display) {
    let message = message.to_string();
    let line = message.lines().map(str::trim).filter(|l| !l.is_empty()).collect::<Vec<_>>().join(" ");
    let line = shorten_message(&line);
    let line = plain(&line);
    // When standard error is closed, there is no place for a message.
    let _ = writeln!(io::stderr(), "stillbase: {line}");
}

/// A failure as JSON.
#[derive(Serialize)]
struct FailureReport<'a> {
    reason: &'a str,
    proposals: &'a [Proposal],
}

/// Prints the reason of a failure in one line, and a line for each proposal that leads out of it; returns the exit
/// status. With `as_json`, also prints the reason and the proposals of a refused scenario on standard output, unless
/// the answer there already holds them.
pub fn exit_code(done: Result<(), Failure>, as_json: bool) -> ExitCode {
    let Err(failure) = done else { return ExitCode::SUCCESS };
    // A failure other than a refusal may follow an answer; it prints no second object.
    let RefusedScenario { failure, proposals, is_printed } = match failure {
        Failure::Refused(refused) => *refused,
        failure => RefusedScenario { failure, proposals: Vec::new(), is_printed: true },
    };
    let (status, why) = match failure {
        Failure::NoAnswer(why) => (1, why),
        Failure::WrongInput(why) => (2, why),
        Failure::ReaderGone | Failure::Refused(_) => return ExitCode::SUCCESS,
    };
    if as_json && !is_printed {
        // Where standard output cannot be written either, standard error holds the reason.
        let report = FailureReport { reason: &why, proposals: &proposals };
        let _ = Format { json: true }.print(&report, |_| String::new());
    }
    print_message(why);
    for proposal in proposals {
        let settings: Vec<String> =
            proposal.settings().iter().map(|set| format!("--set {}", shell_word(set))).collect();
        print_message(format!("{}: {}", proposal.text, settings.join(" ")));
    }
    ExitCode::from(status)
}

/// Prints help, or the error of a command line that cannot be parsed; returns the exit status.
pub fn usage(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        let printed = error.print().and_then(|()| io::stdout().flush());
        return exit_code(printed.map_err(|e| Failure::standard_output(&e)), false);
    }
    exit_code(Err(Failure::WrongInput(in_one_line(&error.render().to_string()))), false)
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
