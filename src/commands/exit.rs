//! Messages on standard error, and the exit status.

use std::error::Error;
use std::ffi::OsString;
use std::fmt::Display;
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};

use clap::builder::Styles;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_session::{Proposal, WayOut};
use stillbase_settings::fault::{Fault, Faults};
use stillbase_settings::range::shortened;
use stillbase_settings::text::{plain, shell_word, shorten_message};

use super::failure::{Failure, RefusedScenario};
use super::in_process::{is_in_process, take};
use super::input::WrongNumber;
use super::misnamed::Misnamed;
use super::output::{Format, has_answered};

/// Whether notes are left out.
static IS_QUIET: AtomicBool = AtomicBool::new(false);

/// Leaves out notes and progress from now on, or not; errors stay.
pub fn silence_notes(is_quiet: bool) {
    IS_QUIET.store(is_quiet, Ordering::Relaxed);
}

/// Returns whether notes and progress are left out.
pub fn is_quiet() -> bool {
    IS_QUIET.load(Ordering::Relaxed)
}

/// Prints a note on standard error, in one line, unless notes are left out.
pub fn print_message(message: impl Display) {
    if !is_quiet() {
        let line = in_one_line_of(message);
        if take(|said| said.notes.push(line.clone())).is_none() {
            print_line(&line, "stillbase:");
        }
    }
}

/// Prints an error on standard error, in one line, with the colour of errors in help if that is a terminal.
fn print_error(message: impl Display) {
    let line = in_one_line_of(message);
    if take(|said| said.errors.push(line.clone())).is_none() {
        let style = *Styles::styled().get_error();
        print_line(&line, &format!("{style}stillbase:{style:#}"));
    }
}

/// Returns a message in one line.
fn in_one_line_of(message: impl Display) -> String {
    let message = message.to_string();
    let line = message.lines().map(str::trim).filter(|l| !l.is_empty()).collect::<Vec<_>>().join(" ");
    plain(&shorten_message(&line)).into_owned()
}

fn print_line(line: &str, name: &str) {
    // When standard error is closed, there is no place for a message.
    let _ = writeln!(anstream::stderr(), "{name} {line}");
}

/// Prints the faults of a file, each in a line with its place and, below it, an example; `why` for a single one.
fn print_faults(why: &str, file: &str, faults: &Faults) {
    let example = |fault: &Fault| {
        if !fault.example.is_empty() {
            // Examples are printed as they may be pasted.
            print_error("for example:");
            for line in fault.example.lines() {
                let line = plain(format!("    {line}").trim_end()).into_owned();
                if take(|said| said.errors.push(line.clone())).is_none() {
                    let _ = writeln!(io::stderr(), "{line}");
                }
            }
        }
    };
    if let [only] = &faults.list[..] {
        print_error(why);
        return example(only);
    }
    let file = shortened(file, MAX_FILE_NAME);
    print_error(format!("{file}: {}", faults.counted()));
    for fault in &faults.list {
        print_error(fault.in_file(&file));
        example(fault);
    }
    faults.rest().into_iter().for_each(print_error);
}

/// Exit status of a command that was told to stop, as that of a program that an interrupt has ended.
const STOPPED: u8 = 130;

/// Maximum length of the name of a file in messages, characters.
const MAX_FILE_NAME: usize = 300;

/// A failure as JSON.
#[derive(JsonSchema, Serialize)]
pub struct FailureReport<'a> {
    reason: &'a str,
    proposals: &'a [Proposal],
    /// The faults of the file that was read, and how many more it has.
    #[serde(skip_serializing_if = "Option::is_none")]
    faults: Option<&'a [Fault]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    more_faults: Option<usize>,
}

/// Prints the reason of a failure in one line, and a line for each proposal that leads out of it; returns the exit
/// status. With `as_json`, also prints the reason and the proposals on standard output, unless an answer is there
/// already. `line` is the command line that has failed.
pub(super) fn status(done: Result<(), Failure>, as_json: bool, line: &Line<'_>) -> u8 {
    let Err(failure) = done else { return 0 };
    let RefusedScenario { failure, mut proposals, misnamed, faults } = match failure {
        Failure::Refused(refused) => *refused,
        failure => RefusedScenario { failure, proposals: Vec::new(), misnamed: None, faults: None },
    };
    proposals.extend(misnamed.iter().flat_map(|misnamed| instead(misnamed, line)));
    let (status, why) = match failure {
        Failure::NoAnswer(why) => (1, why),
        Failure::WrongInput(why) => (2, why),
        Failure::Stopped => (STOPPED, "stopped before its end".into()),
        Failure::ReaderGone | Failure::Refused(_) => return 0,
        Failure::Told => return 1,
    };
    if as_json && !is_in_process() && !has_answered() {
        // If this fails because standard output cannot be written, standard error still gives the reason.
        let list = faults.as_ref().map(|(_, faults)| &faults.list[..]);
        let more_faults = faults.as_ref().map(|(_, faults)| faults.more);
        let report = FailureReport { reason: &why, proposals: &proposals, faults: list, more_faults };
        let _ = Format { json: true }.print(&report, |_| String::new());
    }
    match &faults {
        Some((file, faults)) => print_faults(&why, file, faults),
        None => print_error(why),
    }
    for proposal in proposals {
        let typed = match &proposal.way {
            WayOut::Set(_) => {
                let settings = proposal.settings();
                settings.iter().map(|set| format!("--set {}", shell_word(set))).collect::<Vec<_>>().join(" ")
            }
            WayOut::Command(command) => command.clone(),
            // No command takes edits.
            WayOut::Edits(_) => continue,
        };
        print_error(format!("{}: {typed}", proposal.text));
    }
    status
}

/// A command line.
pub struct Line<'a> {
    /// Its words, the name of the program first.
    pub words: &'a [OsString],
    /// Returns whether another command line can be parsed.
    pub parses: &'a dyn Fn(&[OsString]) -> bool,
}

/// Returns the command lines with a word that names nothing replaced by those that it may have been to name.
fn instead(misnamed: &Misnamed, line: &Line<'_>) -> Vec<Proposal> {
    let way = |name: &String| {
        let words = replaced(line.words, &misnamed.given, name)?;
        if (line.parses)(&words) {
            return Some(Proposal::of_command(format!("take {name}"), as_typed(&words)?));
        }
        // A command that lacks arguments tells them.
        let is_command = super::names().contains(name);
        is_command.then(|| Proposal::of_command(format!("see what {name} takes"), format!("stillbase {name} --help")))
    };
    misnamed.nearest.iter().filter_map(way).collect()
}

/// Prints help, or the error of a command line that cannot be parsed, with the nearest one that can; returns the exit
/// status.
pub(super) fn usage_status(mut error: clap::Error, line: &Line<'_>) -> u8 {
    if is_in_process() {
        // How to give a value that looks like an option is of use in a shell only.
        error.remove(ContextKind::Suggested);
    }
    let error = &error;
    if !error.use_stderr() {
        let printed = error.print().and_then(|()| io::stdout().flush());
        return status(printed.map_err(|e| Failure::standard_output(&e)), false, line);
    }
    let as_json = line.words.iter().any(|word| word == "--json");
    let nearest = nearest_line(error, line.words).filter(|words| (line.parses)(words));
    let failure = match nearest.and_then(|words| as_typed(&words)) {
        Some(nearest) => {
            let nearest = Proposal::of_command("take the nearest that is allowed", nearest);
            Failure::WrongInput(in_one_line(&error.render().to_string())).with_proposals(vec![nearest])
        }
        None => match misspelt_command(error, line) {
            Some(misnamed) => {
                let why =
                    format!("{}: no such command: want {} (nearest)", misnamed.given, misnamed.nearest.join(" or "));
                Failure::WrongInput(format!("{why}; see --help")).with_misnamed(Some(misnamed))
            }
            None => {
                let why = unknown_command(line).unwrap_or_else(|| in_one_line(&error.render().to_string()));
                Failure::WrongInput(why).with_proposals(Vec::new())
            }
        },
    };
    status(Err(failure), as_json, line)
}

/// Returns the first word if it was taken for a scenario, but is near the name of a command.
fn misspelt_command(error: &clap::Error, line: &Line<'_>) -> Option<Misnamed> {
    let is_taken = matches!(error.kind(), ErrorKind::ArgumentConflict | ErrorKind::UnknownArgument);
    let first = line.words.get(1)?.to_str().filter(|first| is_taken && !first.starts_with('-'))?;
    let names = super::names();
    Misnamed::command(first, &names).filter(|misnamed| !misnamed.nearest.iter().any(|name| name == first))
}

/// Returns what is wrong with the name of a command. A program that carries out a command within itself opens no
/// window, so its first word is never a scenario.
fn unknown_command(line: &Line<'_>) -> Option<String> {
    let names = super::names();
    let first = line.words.get(1).map_or("".into(), |word| word.to_string_lossy());
    let is_unknown = is_in_process() && !names.iter().any(|name| *name == first);
    let given = if first.is_empty() || first.starts_with('-') {
        "no command".into()
    } else {
        format!("{first}: no such command")
    };
    is_unknown.then(|| format!("{given}: want one of {}", names.join(", ")))
}

/// Returns the command line with the wrong word replaced by the nearest one that is allowed, if one is known.
fn nearest_line(error: &clap::Error, words: &[OsString]) -> Option<Vec<OsString>> {
    let said = |kind: ContextKind| match error.get(kind)? {
        ContextValue::String(word) => Some(word.clone()),
        ContextValue::Strings(words) => words.first().cloned(),
        _ => None,
    };
    let number = error.source().and_then(|source| source.downcast_ref::<WrongNumber>());
    let (wrong, right) = match error.kind() {
        ErrorKind::ValueValidation => (said(ContextKind::InvalidValue)?, number?.nearest.clone()?),
        ErrorKind::InvalidValue => (said(ContextKind::InvalidValue)?, said(ContextKind::SuggestedValue)?),
        ErrorKind::UnknownArgument => (said(ContextKind::InvalidArg)?, said(ContextKind::SuggestedArg)?),
        ErrorKind::InvalidSubcommand => {
            (said(ContextKind::InvalidSubcommand)?, said(ContextKind::SuggestedSubcommand)?)
        }
        _ => return None,
    };
    replaced(words, &wrong, &right)
}

/// Returns a command line with the first word `wrong` replaced; `None` if no word is.
fn replaced(words: &[OsString], wrong: &str, right: &str) -> Option<Vec<OsString>> {
    let wrong = wrong.trim();
    // An option may be joined to its value: --b=1e9.
    let replaced = |word: &OsString| {
        let word = word.to_str()?;
        let (option, value) = word.split_once('=').map_or((None, word), |(option, value)| (Some(option), value));
        match (option, word.trim() == wrong, value == wrong) {
            (_, true, _) => Some(OsString::from(right)),
            (Some(option), _, true) => Some(OsString::from(format!("{option}={right}"))),
            (Some(option), ..) if option == wrong => Some(OsString::from(format!("{right}={value}"))),
            _ => None,
        }
    };
    let place = words.iter().skip(1).position(|word| replaced(word).is_some())? + 1;
    let mut words = words.to_vec();
    words[place] = replaced(&words[place])?;
    Some(words)
}

/// Returns a command line as a shell takes it; `None` if a word is not valid UTF-8.
fn as_typed(words: &[OsString]) -> Option<String> {
    let rest = words.iter().skip(1).map(|word| Some(shell_word(word.to_str()?.trim()).to_string()));
    Some(std::iter::once(Some("stillbase".to_owned())).chain(rest).collect::<Option<Vec<_>>>()?.join(" "))
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
    // Negative numbers were padded with a space by `words` in input.rs.
    format!("{}; see --help", line.strip_prefix("error: ").unwrap_or(&line).replace("' -", "'-"))
}
