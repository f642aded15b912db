//! Opens sessions.

use super::Session;
use crate::changes::{ScriptError, in_order};
use crate::document::{Document, DocumentRun};
use crate::edit::TimedEdit;
use crate::refusal::Refusal;
use crate::run::Run;
use crate::scenario::{MAX_FRAMES, Scenario};
use crate::script::Script;
use stillbase_query::ProgressCallback;

impl Session {
    /// Opens a scenario; its saved edits are replayed up to its duration, and the first frame is on display.
    ///
    /// # Errors
    /// If the scenario cannot start, or one of its edits cannot be applied. A session that was saved while waiting is
    /// no error: it waits again.
    pub fn open(scenario: Scenario) -> Result<Self, Refusal> {
        Self::open_while(scenario, &mut |_| true)
    }

    /// Does the same as [`open`](Self::open), unless `watch` cancels it.
    ///
    /// # Errors
    /// As [`open`](Self::open), and if `watch` cancels it.
    pub fn open_while(scenario: Scenario, watch: ProgressCallback<'_>) -> Result<Self, Refusal> {
        // Only a scenario with edits or a drawing can be a session that was saved while it waited.
        let patient = !scenario.edits.is_empty() || scenario.unfinished().is_some();
        Self::opened(scenario, patient, watch)
    }

    /// Does the same as [`open`](Self::open), but waits if the task does not fit its machine; [`Run::waiting`] then
    /// says why.
    ///
    /// # Errors
    /// If the simulation cannot be set up, or an edit cannot be applied.
    pub fn open_waiting(scenario: Scenario) -> Result<Self, Refusal> {
        Self::opened(scenario, true, &mut |_| true)
    }

    fn opened(mut scenario: Scenario, patient: bool, watch: ProgressCallback<'_>) -> Result<Self, Refusal> {
        let edits = std::mem::take(&mut scenario.edits);
        let (bookmarks, branches) = (std::mem::take(&mut scenario.bookmarks), std::mem::take(&mut scenario.branches));
        let notes = std::mem::take(&mut scenario.notes);
        let opened = Self::replayed(scenario, in_order(&edits), patient, watch);
        let mut session = opened.map_err(|failed| failed.named(&edits))?;
        session.keep_beside(bookmarks, notes, &branches);
        Ok(session)
    }

    fn replayed(
        scenario: Scenario,
        script: Vec<TimedEdit>,
        patient: bool,
        watch: ProgressCallback<'_>,
    ) -> Result<Self, ScriptError> {
        let known: Script = script.iter().cloned().collect();
        let runs = known.is_dragged() || script.last().is_some_and(|e| e.step > 0);
        let end = match runs {
            true => {
                let run = Run::begin(&scenario, &script, None)?.0;
                let end = match run.waiting() {
                    Some(_) => {
                        let known = run.scenario().duration.map_or(0, |_| run.last_step());
                        known.max(script.last().map_or(0, |e| e.step))
                    }
                    None => run.checked_last_step(&script)?,
                };
                let end = end.min(MAX_FRAMES as u64 - 1);
                if let Some(late) = script.iter().position(|e| e.step > end) {
                    return Err(ScriptError::at(late, Refusal::Full { time: end as f64 * run.scenario().step }));
                }
                end
            }
            false => 0,
        };
        let mut session = Self::of(Document::new(scenario, known, end), patient, watch)?;
        session.cursor = 0;
        Ok(session)
    }

    fn of(document: Document, patient: bool, watch: ProgressCallback<'_>) -> Result<Self, ScriptError> {
        let DocumentRun { run, frames, others, machines } = document.perform(None, patient, watch)?;
        let cursor = frames.len() - 1;
        Ok(Self {
            edits: document.script.to_vec().into_iter().collect(),
            document,
            run,
            frames,
            others,
            machines,
            cursor,
            playing: false,
            undo: Vec::new(),
            redo: Vec::new(),
            gesture: false,
            gesture_now: None,
            unedited: None,
            branch_events: (0, None),
        })
    }
}
