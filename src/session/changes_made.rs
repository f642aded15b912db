//! What a saved session holds: how many changes, and the last of them.

use super::changes::changed;
use super::edit::Edit;
use super::events::gestures;
use super::scenario::Scenario;

/// The changes that a scenario contains as edits.
#[derive(Clone, Debug, PartialEq)]
pub struct ChangesMade {
    /// Number of gestures; a drag is one.
    pub count: usize,
    /// The last of them in words, and its time, s.
    pub last: Option<(String, f64)>,
}

impl ChangesMade {
    /// Reads the changes of a scenario.
    pub fn of(scenario: &Scenario) -> Self {
        let gestures = gestures(&scenario.edits, scenario.step);
        let last = gestures.last().map(|last| {
            let words = last_points(scenario).unwrap_or_else(|| last.words.clone());
            (words, last.step as f64 * scenario.step)
        });
        Self { count: gestures.len(), last }
    }
}

/// Describes the last edit, if it moves points of the path, with the places where they were.
fn last_points(scenario: &Scenario) -> Option<String> {
    let (last, earlier) = scenario.edits.split_last()?;
    let Edit::Set { change } = &last.edit else { return None };
    last.edit.part("task")?;
    let mut before = scenario.without_edits();
    for edit in earlier.iter().map(|timed| &timed.edit).filter(|edit| edit.part("task").is_some()) {
        before = changed(&before, edit).ok()?;
    }
    let inverse = Edit::Set { change: before.present_values(change)? };
    Some(last.edit.title_after(Some(&inverse)))
}
