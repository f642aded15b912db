//! [`Designed`]: the machine as one change after the other has left it.

use toml::Table;

use super::changes::in_order;
use super::edit::{Edit, TimedEdit};
use super::events::GESTURE;
use super::refusal::Refusal;
use super::scenario::Scenario;
use crate::mechanics::machine::{Machine, is_of_machine};

/// A state of a design.
#[derive(Clone, Debug, PartialEq)]
pub struct Designed {
    /// How many changes of the machine have led to it.
    pub changes: usize,
    /// Steps since the start at which it holds.
    pub step: u64,
    /// The change that made it, in words; empty of the first, which is the scenario's machine.
    pub words: String,
    /// The machine.
    pub machine: Machine,
}

/// The most states that are told apart; of more the first and the newest.
const MOST: usize = 200;

/// The states of a scenario's machine in the order of its edits, the first before all of them. What a drag passes while
/// time runs is one change.
///
/// # Errors
/// If an edit cannot be made of the machine.
pub fn designs(scenario: &Scenario) -> Result<Vec<Designed>, Refusal> {
    let mut now = scenario.without_edits();
    let mut all = vec![Designed { changes: 0, step: 0, words: String::new(), machine: now.machine.clone() }];
    let edits: Vec<TimedEdit> = in_order(&scenario.edits).into_iter().filter(|e| e.edit.sets_machine()).collect();
    let mut changes = 0;
    for (i, timed) in edits.iter().enumerate() {
        let Edit::Set { change } = &timed.edit else { continue };
        let of_machine: Table = change.clone().into_iter().filter(|(key, _)| is_of_machine(key)).collect();
        now = now.with(&of_machine)?;
        if edits.get(i + 1).is_some_and(|next| is_dragged_on(timed, next, scenario.step)) {
            continue;
        }
        changes += 1;
        let (step, words) = (timed.step, Edit::Set { change: of_machine }.title());
        all.push(Designed { changes, step, words, machine: now.machine.clone() });
        if all.len() > MOST {
            all.remove(1);
        }
    }
    Ok(all)
}

/// Whether an edit is on the way of a drag that the next one goes on with; steps last so long, s.
fn is_dragged_on(timed: &TimedEdit, next: &TimedEdit, step: f64) -> bool {
    let later = next.step - timed.step;
    later > 0 && later as f64 * step <= GESTURE + 1e-9 && timed.edit.is_replaced_by(&next.edit)
}
