//! [`SignalSource`]: signals over time from a recording, a table or a scenario.

use std::path::Path;

use stillbase_session::signal_table;
use stillbase_simulation::signal_table::SignalTable;

use super::failure::Failure;
use super::input::{Settings, scenario};
use super::output::check_size;

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
    /// Reads a recording, a CSV or Parquet file, or runs a scenario.
    ///
    /// # Errors
    /// If there is no such file or scenario, it cannot be read, or the scenario cannot run.
    pub fn open(name: &str) -> Result<Self, Failure> {
        let ending = Path::new(name).extension().unwrap_or_default().to_ascii_lowercase();
        let cases = match recorded(name) {
            Some(cases) => cases?,
            None if ending == "csv" => vec![(None, stillbase_files::table::signals(Path::new(name))?)],
            None => vec![simulated(name)?],
        };
        Ok(Self { name: name.to_owned(), cases })
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

/// Runs a scenario; its signals have a row at every step.
fn simulated(name: &str) -> Result<(Option<String>, SignalTable), Failure> {
    let scenario = scenario(name, &Settings::default())?;
    table_of(&scenario).map(|table| (Some(scenario.name), table))
}

/// Returns the signals of a scenario at every step.
///
/// # Errors
/// If it cannot run, or has too many steps.
pub fn table_of(scenario: &stillbase_session::scenario::Scenario) -> Result<SignalTable, Failure> {
    let fits = |last: u64, signals: usize| check_size(last + 1, signals + 1, true);
    signal_table(scenario, fits, |_, _| true).map_err(|e| Failure::refused(scenario, e))
}
