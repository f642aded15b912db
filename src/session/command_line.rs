//! [`simulate_command`] and [`session_command`]: the command that runs a scenario as it is on display.

use super::scenario::Scenario;
use super::{Edit, Session, TimedEdit};
use stillbase_settings::change::{join, leaves, same_value, single_change, typed};
use stillbase_settings::text::shell_word;
use toml::Table;

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

/// Returns the command that simulates a session from its start, as [`simulate_command`]. Returns `None` if the session
/// has edits other than settings at its start; a file is then needed.
pub fn session_command(session: &Session) -> Option<String> {
    let is_setting = |timed: &TimedEdit| timed.step == 0 && matches!(timed.edit, Edit::Set { .. });
    simulate_command(session.scenario()).filter(|_| session.script().iter().all(is_setting))
}
