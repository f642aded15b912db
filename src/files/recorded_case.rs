//! [`RecordedCase`]: a session and its signals, as a recording holds them.

use crate::find::assembly_scenario_of;
use stillbase_session::scenario::{Scenario, ScenarioError};
use stillbase_session::{Refusal, signal_table};
use stillbase_simulation::signal_table::SignalTable;
use stillbase_study::difference::{SAME_INSTANT_S, TableDifference, Tolerances};

/// Ending of the name of a recording.
pub const ENDING: &str = ".rrd";

/// Returns whether a name is that of a recording or, such as `cases.rrd:case-2`, of one of its cases.
pub fn is_recording(name: &str) -> bool {
    let lower = name.to_ascii_lowercase();
    lower.ends_with(ENDING) || lower.contains(".rrd:")
}

/// Largest permitted difference of a recording of another version, absolute in SI units, and relative to the largest
/// value of the signal.
const OTHER_VERSION: f64 = 1e-9;

/// A case of a recording.
#[derive(Clone, Debug)]
pub struct RecordedCase {
    /// Name of its scenario.
    pub name: String,
    /// Version of the program that recorded it.
    pub version: String,
    /// Its session as TOML: scenario, machine and edits.
    pub session: String,
    /// Its signals, at the recorded steps.
    pub table: SignalTable,
}

impl RecordedCase {
    /// Returns the recorded scenario with its edits.
    ///
    /// # Errors
    /// If this version of the program cannot read it.
    pub fn scenario(&self) -> Result<Scenario, ScenarioError> {
        let text = (self.session.as_str(), self.name.as_str(), None);
        match assembly_scenario_of::<ScenarioError>(text, &toml::Table::new(), Ok)? {
            Some(whole) => Ok(whole.leading(whole.lead)),
            None => Scenario::parse(&self.session, &self.name, None),
        }
    }

    /// Returns by how much its signals may differ when this version simulates it again: not at all if it recorded them.
    pub fn tolerances(&self) -> Tolerances {
        let all = if self.version == env!("CARGO_PKG_VERSION") { 0.0 } else { OTHER_VERSION };
        Tolerances { all, relative: all, named: Vec::new() }
    }

    /// Simulates its scenario again. Returns how the recorded signals differ from those at the same instants; the last
    /// instant counts too.
    ///
    /// # Errors
    /// If the scenario cannot run, or `goes_on` returns `false`.
    pub fn simulated_again(
        &self,
        scenario: &Scenario,
        tolerances: &Tolerances,
        goes_on: impl Fn() -> bool,
    ) -> Result<TableDifference, Refusal> {
        let mut recorded = self.table.time.iter().peekable();
        let again = signal_table(
            scenario,
            |_, _| Ok(()),
            |run, frame| {
                while recorded.next_if(|time| **time < frame.time - SAME_INSTANT_S).is_some() {}
                let is_recorded = recorded.peek().is_some_and(|time| **time <= frame.time + SAME_INSTANT_S);
                is_recorded || frame.step == run.last_step()
            },
            goes_on,
        )?;
        Ok(TableDifference::between(&self.table, &again, tolerances))
    }
}
