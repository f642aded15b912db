//! [`SignalSource`]: signals over time from a recording, a table or a scenario.

use std::path::Path;

use stillbase_files::table::{has_signal_head, is_table, signals_of};
use stillbase_files::text::STANDARD_INPUT;
use stillbase_session::signal_table;
use stillbase_simulation::signal_table::SignalTable;

use super::failure::Failure;
use super::input::{Settings, scenario_of_any};
use super::output::check_size;
use super::progress::goes_on;

/// A name and the signals of each case; a table has one case without a name.
type Cases = Vec<(Option<String>, SignalTable)>;

/// Where signals come from.
pub struct SignalSource {
    /// What the command line calls it.
    pub name: String,
    /// Its cases.
    pub cases: Cases,
}

impl SignalSource {
    /// Reads a recording or a table, CSV or Parquet, or CSV from standard input; `None` if the name is that of neither.
    ///
    /// # Errors
    /// If there is no such file, or it cannot be read.
    pub fn of_file(name: &str) -> Option<Result<Self, Failure>> {
        let named = |cases| Self { name: name.to_owned(), cases };
        let of_table = |table: Result<SignalTable, _>| Ok(vec![(None, table?)]);
        let cases = match recorded(name) {
            Some(cases) => cases,
            None if is_table(Path::new(name)) => of_table(stillbase_files::table::signals(Path::new(name))),
            None if name == STANDARD_INPUT => {
                let text = stillbase_files::text::read(Path::new(name)).ok().filter(|text| has_signal_head(text))?;
                of_table(signals_of(&text, "standard input"))
            }
            None => return None,
        };
        Some(cases.map(named))
    }

    /// Runs a scenario; its signals have a row at every step.
    ///
    /// # Errors
    /// If there is no such scenario, or it cannot run.
    pub fn of_scenario(name: &str, settings: &Settings) -> Result<Self, Failure> {
        let scenario = scenario_of_any(name, settings)?;
        let table = table_of(&scenario)?;
        Ok(Self { name: name.to_owned(), cases: vec![(Some(scenario.name), table)] })
    }

    /// Returns the signals of its only case.
    ///
    /// # Errors
    /// If it has several.
    pub fn only_case(&self) -> Result<&SignalTable, Failure> {
        match &self.cases[..] {
            [(_, table)] => Ok(table),
            several => {
                let names: Vec<&str> = several.iter().filter_map(|(name, _)| name.as_deref()).collect();
                let example = format!("{}:{}", self.name, names.first().copied().unwrap_or_default());
                let why = format!("it has the cases {}: want one of them, such as {example}", names.join(", "));
                Err(Failure::wrong_input(why).with_context(&self.name))
            }
        }
    }
}

#[cfg(feature = "record")]
fn recorded(name: &str) -> Option<Result<Cases, Failure>> {
    let cases = stillbase_files::recorded::CaseName::of(name)?.cases();
    let named = |case: stillbase_files::recorded::RecordedCase| (Some(case.name), case.table);
    Some(cases.map(|cases| cases.into_iter().map(named).collect()).map_err(Failure::wrong_input))
}

#[cfg(not(feature = "record"))]
fn recorded(_: &str) -> Option<Result<Cases, Failure>> {
    None
}

/// Returns the signals of a scenario at every step.
///
/// # Errors
/// If it cannot run, or has too many steps.
pub fn table_of(scenario: &stillbase_session::scenario::Scenario) -> Result<SignalTable, Failure> {
    let fits = |last: u64, signals: usize| check_size(last + 1, signals + 1, true);
    signal_table(scenario, fits, |_, _| true, goes_on).map_err(|e| Failure::refused(scenario, e))
}
