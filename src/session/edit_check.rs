//! Checks the edits of a file without planning or simulating.

use super::changes::{changed, opening, order_of};
use super::edit::{Edit, TimedEdit};
use super::refusal::Refusal;
use crate::scenario::Scenario;

/// Checks numbers and settings of every edit of a scenario, in the order of steps.
///
/// # Errors
/// If an entry is wrong: the index of the first such entry, and a description of the fault.
pub(crate) fn check_edits(scenario: &Scenario) -> Result<(), (usize, String)> {
    let edits = &scenario.edits;
    if edits.is_empty() {
        return Ok(());
    }
    let order = order_of(edits);
    let script: Vec<&TimedEdit> = order.iter().map(|i| &edits[*i]).collect();
    let opening = opening(script.iter().copied());
    let mut now = scenario.without_edits();
    // Edits at step 0 before the first drag need to give a valid scenario together, not one by one.
    let mut unsound = None;
    for (place, (entry, timed)) in order.iter().zip(&script).enumerate() {
        let of_entry = |why: String| (*entry, why);
        if place == opening
            && let Some(wrong) = unsound.take()
        {
            return Err(wrong);
        }
        timed.edit.check().map_err(|check| of_entry(Refusal::from(check).to_string()))?;
        if timed.edit.acts_in_motion() || matches!(timed.edit, Edit::PoseB { .. }) {
            continue;
        }
        now = changed(&now, &timed.edit).map_err(|why| of_entry(why.to_string()))?;
        match now.check(timed.edit.name()) {
            Ok(()) if place >= opening && timed.edit.changes_plan() => {
                return Err(of_entry(Edit::START_ONLY_REASON.into()));
            }
            Ok(()) => unsound = None,
            Err(why) if place >= opening => return Err(of_entry(why.to_string())),
            Err(why) => unsound = unsound.or_else(|| Some(of_entry(why.to_string()))),
        }
    }
    unsound.map_or(Ok(()), Err)
}
