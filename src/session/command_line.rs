//! [`simulate_command`] and [`session_command`]: the command that runs a scenario as it is on display.

use std::borrow::Borrow;
use std::collections::HashSet;

use super::scenario::Scenario;
use super::{Edit, Session, TimedEdit};
use stillbase_query::{Queries, QuickQuery, QuickWork, Shared};
use stillbase_settings::change::{join, leaves, same_value, single_change, typed};
use stillbase_settings::text::shell_word;
use stillbase_simulation::signals::Signal;
use toml::Table;

/// Bounds of time intervals are rounded to multiples of 1 s divided by this.
const TIMES_PER_SECOND: f64 = 1e9;

/// Returns the command that simulates a scenario without its edits: the built-in scenario of its name, and the settings
/// that differ. Returns `None` if no settings lead from a built-in scenario to this one; a file is then needed.
pub fn simulate_command(scenario: &Scenario) -> Option<String> {
    let wanted = scenario.without_edits();
    let builtin = Scenario::builtin(&scenario.name)?.without_edits();
    let differs = |(path, _, value): &(String, _, toml::Value)| {
        builtin.value(path).is_none_or(|known| !same_value(&known, value))
    };
    let settings = wanted.settings().into_iter().filter(differs);
    let change = settings.fold(Table::new(), |all, (path, _, value)| join(all, &single_change(&path, value)));
    let same = builtin.with_settings(&change).ok()? == wanted;
    let words =
        leaves(&change).into_iter().map(|(path, value)| shell_word(&format!("{path}={}", typed(value))).into_owned());
    let settings: String = words.map(|word| format!(" --set {word}")).collect();
    same.then(|| format!("stillbase simulate {}{settings}", shell_word(&scenario.name)))
}

/// Query for [`simulate_command`].
struct SimulateCommand;

impl QuickQuery for SimulateCommand {
    type Input = Shared<Scenario>;
    type Answer = Option<String>;

    fn answer(scenario: &Self::Input) -> Self::Answer {
        simulate_command(&scenario.0)
    }
}

/// Returns the command that simulates a session from its start, as [`simulate_command`]. Returns `None` if the session
/// has edits other than settings at its start; a file is then needed.
pub fn session_command(session: &Session, queries: &Queries) -> Option<String> {
    let is_setting = |timed: &TimedEdit| timed.step == 0 && matches!(timed.edit, Edit::Set { .. });
    let command = || queries.ask::<QuickWork<SimulateCommand>>(&session.run().shared_scenario());
    session.script().iter().all(is_setting).then(command)?.as_ref().clone()
}

/// Returns the options of `simulate` that write the signals `chosen` of a table in a time interval, s; `None` for a
/// signal that no option can name. A group of signals that is chosen as a whole is one name.
pub fn row_options(table: &[Signal], chosen: &[impl Borrow<Signal>], times: Option<[f64; 2]>) -> Option<String> {
    let mut options = String::new();
    let paths: HashSet<&str> = chosen.iter().map(|signal| signal.borrow().path.as_str()).collect();
    let left_out = table.iter().filter(|signal| !paths.contains(signal.path.as_str()));
    let parts: HashSet<&str> = left_out.map(Signal::group).collect();
    if !parts.is_empty() {
        let (mut names, mut known): (Vec<&str>, HashSet<&str>) = Default::default();
        for signal in chosen.iter().map(Borrow::borrow) {
            let name = if parts.contains(signal.group()) { &signal.path } else { signal.group() };
            // Names are separated by commas.
            if name.contains(',') {
                return None;
            }
            if known.insert(name) {
                names.push(name);
            }
        }
        options = format!(" --signals {}", shell_word(&names.join(",")));
    }
    let rounded = |time: f64| (TIMES_PER_SECOND * time).round() / TIMES_PER_SECOND;
    if let Some([from, to]) = times.map(|times| times.map(rounded)) {
        options += &format!(" --from {from} --to {to}");
    }
    Some(options)
}
