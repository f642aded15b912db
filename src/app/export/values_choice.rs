//! [`ValuesChoice`]: which signals of a run are written, and of which time.

use std::collections::BTreeSet;

use super::{RowForm, ValuesOrder};
use crate::{ViewState, plots};
use stillbase_session::{Session, row_options};
use stillbase_settings::number::fixed;
use stillbase_simulation::signals::Signal;

/// Choices for values of signals.
#[derive(Clone, Debug, PartialEq)]
pub struct ValuesChoice {
    /// The signals that are written.
    pub signals: SignalChoice,
    /// The time of which they are written.
    pub times: TimeChoice,
    /// Format that is suggested; the ending of the file's name decides.
    pub form: RowForm,
}

/// Signals to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SignalChoice {
    /// Those of the plots on display.
    Plots,
    /// All.
    All,
    /// Those of these paths.
    These(BTreeSet<String>),
}

/// A time interval of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeChoice {
    /// The whole run.
    Whole,
    /// What the plots show.
    Shown,
    /// From one time to another, s.
    Between([f64; 2]),
}

impl SignalChoice {
    /// Returns the chosen signals in the order of the table `all`.
    pub fn of<'a>(&self, session: &Session, view_state: &ViewState, all: &'a [Signal]) -> Vec<&'a Signal> {
        let filtered = |is_chosen: &dyn Fn(&Signal) -> bool| all.iter().filter(|s| is_chosen(s)).collect();
        match self {
            Self::All => all.iter().collect(),
            Self::Plots => {
                let shown = plots::shown_signals(&view_state.plots(session.scenario(), all));
                let paths: BTreeSet<&str> = shown.iter().map(|signal| signal.path.as_str()).collect();
                filtered(&|signal| paths.contains(signal.path.as_str()))
            }
            Self::These(paths) => filtered(&|signal| paths.contains(&signal.path)),
        }
    }
}

impl TimeChoice {
    /// Returns first and last instant, s.
    pub fn of(self, session: &Session, view_state: &ViewState) -> [f64; 2] {
        let end = session.length();
        match self {
            Self::Whole => [0.0, end],
            Self::Shown => {
                let shown = plots::extent(session).shown(view_state.charts.range);
                shown.map(|time| time.clamp(0.0, end))
            }
            Self::Between(times) => times,
        }
    }
}

impl ValuesChoice {
    /// Returns what is to be written of a session; `all` is the table of its signals.
    ///
    /// # Errors
    /// If no signal is chosen, or no time of the run.
    pub fn order(
        &self,
        session: &Session,
        view_state: &ViewState,
        all: &[Signal],
    ) -> Result<ValuesOrder, &'static str> {
        let signals = self.signals.of(session, view_state, all);
        let times = self.times.of(session, view_state);
        match refusal(&signals, times, session) {
            Some(why) => Err(why),
            None => Ok(ValuesOrder { signals: signals.into_iter().cloned().collect(), times }),
        }
    }

    /// Returns the options of the command `simulate` that write the signals `chosen` at `times`, s; `None` if no
    /// options can.
    pub fn options(
        &self,
        (chosen, times): (&[&Signal], [f64; 2]),
        session: &Session,
        all: &[Signal],
    ) -> Option<String> {
        let [from, to] = times;
        let is_part = from > 0.0 || to < session.length();
        let rows = row_options(all, chosen, is_part.then_some(times))?;
        Some(format!(" -o values.{}{rows}", self.form.ending()))
    }
}

/// Returns why these signals at these times, s, cannot be written; `None` if they can.
pub fn refusal(chosen: &[&Signal], [from, to]: [f64; 2], session: &Session) -> Option<&'static str> {
    if chosen.is_empty() {
        Some("no signal is chosen: want at least one")
    } else if from > to {
        Some("the time ends before it begins: want the first before the second")
    } else if from > session.length() {
        Some("the time begins after the run: want one within it")
    } else {
        None
    }
}

/// Returns a time interval in words.
pub fn times_in_words([from, to]: [f64; 2]) -> String {
    format!("{} to {} s", fixed(from, 3), fixed(to, 3))
}
