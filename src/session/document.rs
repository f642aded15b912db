//! A [`Document`]: everything that makes a run, and what an edit before its first step makes of it.

use std::sync::Arc;

use super::changes::{Failed, changed};
use super::edit::{Edit, TimedEdit};
use super::machines::Machines;
use super::replay;
use super::run::Run;
use super::script::Script;
use crate::query::Sequence;
use crate::session::scenario::{Bookmark, Scenario};
use crate::simulation::frame::Frame;

/// Hears how much is done, from 0 to 1, and says whether the rest is still wanted.
pub use crate::query::Watch;

/// Frames between two words to whoever watches.
pub(super) const WORD: usize = 256;

/// What is kept beside a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kept {
    /// Names of instants.
    Bookmarks,
    /// Runs that it left.
    Branches,
}

/// Everything that makes a run, and what is kept beside it: what undo restores and what is saved.
#[derive(Clone, Debug)]
pub(super) struct Document {
    /// Without edits and what is kept; they stand below.
    pub scenario: Arc<Scenario>,
    /// None beyond `end`.
    pub script: Script,
    /// Steps done.
    pub end: u64,
    /// Instants to find again, by time.
    pub bookmarks: Arc<Vec<Bookmark>>,
    /// How it went on before somebody went back, the oldest first.
    pub branches: Arc<Vec<Left>>,
}

/// What a document comes to.
pub(super) struct Performed {
    /// At its end.
    pub run: Run,
    /// One a step.
    pub frames: Sequence<Frame>,
    pub machines: Machines,
}

/// A branch that was left: the same scenario with another script.
#[derive(Clone, Debug)]
pub(super) struct Left {
    pub script: Script,
    /// Steps to its end.
    pub end: u64,
    /// How long a step lasts in it, s.
    pub step: f64,
}

impl Document {
    /// One beside which nothing is kept.
    pub fn new(scenario: Scenario, script: Script, end: u64) -> Self {
        Self { scenario: Arc::new(scenario), script, end, bookmarks: Arc::default(), branches: Arc::default() }
    }

    /// Keeps this beside the run as another one does.
    pub fn keep_as(&mut self, other: &Self, kept: Kept) {
        match kept {
            Kept::Bookmarks => self.bookmarks.clone_from(&other.bookmarks),
            Kept::Branches => self.branches.clone_from(&other.branches),
        }
    }

    /// Runs it from its start to its end.
    pub fn perform(&self, known: Option<&Run>, patient: bool, watch: Watch<'_>) -> Result<Performed, Failed> {
        let (mut frames, mut machines) = (Sequence::default(), Machines::default());
        let see = |run: &Run, frame: &Frame| {
            frames.push(*frame);
            machines.hold(frame.step, &run.scenario().machine);
            !frames.len().is_multiple_of(WORD) || watch(frames.len() as f64 / (self.end + 1) as f64)
        };
        let end = |_: &Run, _: &[TimedEdit]| Ok(self.end);
        let run = replay::perform(&self.scenario, &self.script.to_vec(), (end, patient), known, see)?;
        Ok(Performed { run, frames, machines })
    }

    /// Whether it gives the same frames as another because nothing else differs than keys on which no frame depends, and
    /// how far it has got; then the scenario of the run with those keys as this one leaves them.
    pub fn aside_of(&self, other: &Self) -> Option<Scenario> {
        fn moving(document: &Document) -> impl Iterator<Item = &TimedEdit> {
            document.script.in_order().into_iter().filter(|timed| !timed.edit.is_aside())
        }
        if !moving(self).eq(moving(other)) || other.scenario.with_asides_of(&self.scenario).ok()? != *self.scenario {
            return None;
        }
        let mut asides = self.script.in_order().into_iter().filter_map(|timed| timed.edit.asides());
        asides.try_fold(Scenario::clone(&self.scenario), |now, edit| changed(&now, &edit).ok())
    }

    /// With an edit before the first step.
    pub fn amended(&self, timed: &TimedEdit) -> Self {
        let mut document = self.clone();
        let mut timed = timed.clone();
        if let Some(change) = timed.edit.take("duration") {
            // A saved session says there how long it took, so no edit may say otherwise.
            if let Ok(scenario) = document.scenario.with(&change) {
                document.scenario = Arc::new(scenario);
            }
            if timed.edit.sets_nothing() {
                return document;
            }
        }
        let mut script = document.script.to_vec();
        script.retain(|e| !e.edit.is_replaced_by(&timed.edit));
        if timed.edit.sets_path() && document.script.is_led() {
            // A new plan puts a machine that was led back on its path: the edits that led it go, the settings stay.
            let mut kept: Vec<TimedEdit> = Vec::with_capacity(script.len());
            for e in script.drain(..).filter(|e| !e.edit.leads()) {
                if e.step > 0 && matches!(e.edit, Edit::PoseB { .. }) {
                    continue;
                }
                kept.retain(|old| !old.edit.is_replaced_by(&e.edit));
                kept.push(TimedEdit { step: 0, edit: e.edit });
            }
            script = kept;
            document.end = 0;
        }
        // An edit that leads the machine from the start does so from where this one puts it.
        let place = script.iter().position(|e| e.step > 0 || e.edit.leads());
        let says_nothing = timed.edit.part("task").is_some_and(toml::Table::is_empty);
        if !says_nothing {
            script.insert(place.unwrap_or(script.len()), timed.clone());
        }
        document.script = document.script.replaced(script);
        document
    }
}
