//! [`answer`]: a command carried out within another program, which gets its answer and messages instead of a terminal.

use std::cell::RefCell;
use std::ffi::OsString;

use clap::{ArgAction, ArgMatches, FromArgMatches};

use super::exit::{Line, status, usage_status};
use super::input::words;
use super::output::begin;
use super::program::Arguments;
use super::stop::StopFlag;
use stillbase_simulation::signal_table::SignalTable;

/// What a command printed and said.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct InProcessAnswer {
    /// Exit status: 0 done, 1 the question has no answer, 2 wrong input, 130 stopped.
    pub status: u8,
    /// What it printed with `--json`, if anything.
    pub json: Option<String>,
    /// The file that it wrote to standard output (`-o -`) as a whole, if any; rows of tables still go there.
    pub file: Option<Vec<u8>>,
    /// The signals of a simulation, which are then not in `json`.
    pub signals: Option<SignalTable>,
    /// Its notes, a line each.
    pub notes: Vec<String>,
    /// Its error, with the ways out of it, a line each.
    pub errors: Vec<String>,
}

thread_local! {
    /// What the command in progress on this thread has said; `None` if it speaks to a terminal.
    static SAID: RefCell<Option<InProcessAnswer>> = const { RefCell::new(None) };
    /// The flag that stops the command on this thread. Nobody sets that of a command that speaks to a terminal.
    static STOP: RefCell<StopFlag> = RefCell::default();
}

/// Returns the flag that stops the command on this thread.
pub(super) fn stop_flag() -> StopFlag {
    STOP.with_borrow(Clone::clone)
}

/// Gives what a command says to the program that carries it out; `None` if there is none.
pub(super) fn take(say: impl FnOnce(&mut InProcessAnswer)) -> Option<()> {
    SAID.with_borrow_mut(|said| said.as_mut().map(say))
}

/// Forgets what a command said, and its flag, also after a panic.
struct Forgets;

impl Drop for Forgets {
    fn drop(&mut self) {
        SAID.set(None);
        STOP.take();
    }
}

/// Returns whether a command is carried out within another program on this thread.
pub(super) fn is_in_process() -> bool {
    SAID.with_borrow(Option::is_some)
}

/// Carries out a command line as the program does, with its answers on standard output and its messages on standard error;
/// returns the exit status. The first word is the name of the program.
pub fn carry_out(line: impl IntoIterator<Item = OsString>) -> u8 {
    begin();
    let words: Vec<OsString> = words(line.into_iter()).collect();
    let parses = |words: &[_]| Arguments::program().try_get_matches_from(words).is_ok();
    let line = Line { words: &words, parses: &parses };
    let matches = Arguments::program().try_get_matches_from(&words);
    let parsed = matches.and_then(|matches| Ok((Arguments::from_arg_matches(&matches)?, asks_for_json(&matches))));
    match parsed {
        Ok((arguments, as_json)) => status(arguments.run(), as_json, &line),
        Err(error) => usage_status(error, &line),
    }
}

/// Returns whether the subcommand is to print JSON.
fn asks_for_json(matches: &ArgMatches) -> bool {
    let asks = |(_, own): (&str, &ArgMatches)| matches!(own.try_get_one::<bool>("json"), Ok(Some(true)));
    matches.subcommand().is_some_and(asks)
}

/// Returns whether an option of a command is repeated for several values, as `--merge A --merge B`; others take them in one
/// word, with commas.
pub fn takes_one_value_each(command: &str, option: &str) -> bool {
    let program = Arguments::program();
    let of = program.find_subcommand(command).unwrap_or(&program);
    let found = of.get_arguments().find(|own| own.get_long() == Some(option));
    found.is_some_and(|own| matches!(own.get_action(), ArgAction::Append) && own.get_value_delimiter().is_none())
}

/// Carries out a command line without the name of the program, such as `check spot --json`. Only answers with `--json` are
/// returned; files are written as ever, but one for standard output is returned.
pub fn answer(line: impl IntoIterator<Item = OsString>) -> InProcessAnswer {
    answer_until(line, &StopFlag::default())
}

/// Does the same as [`answer`], until a flag is set: then the command ends within a moment, with status 130 and without
/// files that it has not finished.
pub fn answer_until(line: impl IntoIterator<Item = OsString>, stop: &StopFlag) -> InProcessAnswer {
    let _forgets = Forgets;
    STOP.set(stop.clone());
    SAID.set(Some(InProcessAnswer::default()));
    let status = carry_out([OsString::from("stillbase")].into_iter().chain(line));
    let said = SAID.take().unwrap_or_default();
    InProcessAnswer { status, ..said }
}
