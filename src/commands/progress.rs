//! [`Progress`]: tells how far a command is, and asks whether it is to go on.

use indicatif::ProgressBar;
use stillbase_query::{Query, answer_while};

use super::failure::Failure;
use super::in_process::stop_flag;
use super::stop::StopFlag;

/// How far the command of a thread is: a bar on standard error, if that is a terminal, and the flag that stops it.
pub struct Progress {
    bar: ProgressBar,
    stop: StopFlag,
}

impl Progress {
    /// Returns the progress of the command on this thread, with a bar.
    pub fn with_bar(bar: ProgressBar) -> Self {
        Self { bar, stop: stop_flag() }
    }

    /// Returns the progress of the command on this thread, without a bar.
    pub fn hidden() -> Self {
        Self::with_bar(ProgressBar::hidden())
    }

    /// Returns the progress of the command on this thread, with a bar of a length unless notes are left out.
    #[cfg(any(feature = "record", feature = "ui"))]
    pub fn of_length(length: u64) -> Self {
        if super::exit::is_quiet() {
            return Self::hidden();
        }
        let bar = ProgressBar::new(length);
        if let Ok(style) = indicatif::ProgressStyle::with_template("{msg:12} {wide_bar} {percent:>3} %  {eta:>4}") {
            bar.set_style(style);
        }
        Self::with_bar(bar)
    }

    /// Returns the bar.
    #[cfg(any(feature = "record", feature = "ui"))]
    pub fn bar(&self) -> &ProgressBar {
        &self.bar
    }

    /// Returns whether the command is to go on. Any thread may ask.
    pub fn goes_on(&self) -> bool {
        self.stop.goes_on()
    }

    /// Counts more parts as done.
    pub fn add(&self, parts: u64) {
        self.bar.inc(parts);
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// Returns whether the command on this thread is to go on.
pub fn goes_on() -> bool {
    stop_flag().goes_on()
}

/// Returns the failure of a command that is not to go on.
pub fn check() -> Result<(), Failure> {
    if goes_on() { Ok(()) } else { Err(Failure::Stopped) }
}

/// Returns the answer to the input of a query.
///
/// # Errors
/// If the command is not to go on.
pub fn answered<Q: Query>(input: Q::Input) -> Result<Q::Answer, Failure> {
    let stop = stop_flag();
    answer_while::<Q>(input, &mut |_| stop.goes_on()).ok_or(Failure::Stopped)
}
