//! [`DesignVersion`]: the states of the machine after each of its changes.

use toml::Table;

use super::changes::{changed, in_order};
use super::edit::{Edit, TimedEdit};
use super::events::GESTURE_PAUSE;
use super::refusal::Refusal;
use super::scenario::{DesignBrief, Scenario};
use stillbase_mechanics::machine::{Machine, is_of_machine};

/// A state of the machine.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignVersion {
    /// Number of changes of the machine up to this state.
    pub changes: usize,
    /// Step from which the machine is in this state.
    pub step: u64,
    /// Description of the change that led to this state; empty for the first state, the machine of the scenario.
    pub words: String,
    /// The machine.
    pub machine: Machine,
    /// The bounds on its design.
    pub brief: DesignBrief,
}

/// Maximum number of states that are kept: the first one and the newest.
const MAX_STATES: usize = 200;

/// Returns the states of a scenario's machine in the order of its edits, beginning before the first edit. All edits of
/// a drag while time passes count as one change.
///
/// # Errors
/// If an edit cannot be applied to the machine.
pub fn designs(scenario: &Scenario) -> Result<Vec<DesignVersion>, Refusal> {
    let mut now = scenario.without_edits();
    let version = |changes: usize, step: u64, words: String, now: &Scenario| DesignVersion {
        changes,
        step,
        words,
        machine: now.machine.clone(),
        brief: now.design.clone(),
    };
    let mut all = vec![version(0, 0, String::new(), &now)];
    let edits: Vec<TimedEdit> =
        in_order(&scenario.edits).into_iter().filter(|e| e.edit.sets_machine() || e.edit.sets_design()).collect();
    let mut changes = 0;
    for (i, timed) in edits.iter().enumerate() {
        let Edit::Set { change } = &timed.edit else {
            let before = now.machine.clone();
            now = changed(&now, &timed.edit)?;
            if now.machine != before {
                changes += 1;
                all.push(version(changes, timed.step, timed.edit.title(), &now));
                if all.len() > MAX_STATES {
                    all.remove(1);
                }
            }
            continue;
        };
        let part = |is_part: &dyn Fn(&str) -> bool| -> Table {
            change.clone().into_iter().filter(|(key, _)| is_part(key)).collect()
        };
        now = now.with_settings(&part(&|key| is_of_machine(key) || key == "design"))?;
        let of_machine = part(&is_of_machine);
        if of_machine.is_empty() {
            continue;
        }
        if edits.get(i + 1).is_some_and(|next| is_dragged_on(timed, next, scenario.step)) {
            continue;
        }
        changes += 1;
        let (step, words) = (timed.step, Edit::Set { change: of_machine }.title());
        all.push(version(changes, step, words, &now));
        if all.len() > MAX_STATES {
            all.remove(1);
        }
    }
    Ok(all)
}

/// Returns whether an edit belongs to a drag that the next edit continues. `step` is the step size, s.
fn is_dragged_on(timed: &TimedEdit, next: &TimedEdit, step: f64) -> bool {
    let later = next.step - timed.step;
    later > 0 && later as f64 * step <= GESTURE_PAUSE + 1e-9 && timed.edit.is_replaced_by(&next.edit)
}
