//! A [`Session`]: a scenario, what was done to it, and every frame so far.
//!
//! The window owns one and only sends it [`Edit`]s and transport commands (play, pause, seek); [`replay`] carries out
//! the same edits without a window. Because a run is a function of scenario and edits, undo, scrubbing and saving need
//! no snapshots of state: the run is made again.

use std::sync::Arc;

use super::changes::{Failed, in_order};
use super::edit::{Edit, TimedEdit};
use super::refusal::Refusal;
use super::replay;
use super::run::Run;
use super::script::Script;
use crate::session::scenario::{MAX_FRAMES, MAX_TIME, Scenario};
use crate::simulation::frame::Frame;

/// Everything that makes a run: what undo restores and what is saved.
#[derive(Clone, Debug)]
struct Document {
    /// Its edits are empty; they stand in `script`.
    scenario: Arc<Scenario>,
    /// None beyond `end`.
    script: Script,
    /// Steps done.
    end: u64,
}

/// One step of history.
#[derive(Clone, Debug)]
struct Change {
    before: Document,
    edit: Option<TimedEdit>,
    /// What takes it back while the machine moves.
    inverse: Option<Edit>,
    title: String,
}

impl Change {
    /// Whether it changes the task or the base: the motion is then planned anew, so it can stand only before the first
    /// step.
    fn plans(&self) -> bool {
        self.edit.as_ref().is_some_and(|e| e.edit.sets_path() || e.edit.sets(&["base"]))
    }
}

/// A run that a person edits while it goes on.
#[derive(Clone, Debug)]
pub struct Session {
    document: Document,
    /// The script of the document, one after the other.
    edits: Vec<TimedEdit>,
    run: Run,
    frames: Vec<Frame>,
    cursor: usize,
    playing: bool,
    undo: Vec<Change>,
    redo: Vec<Change>,
    /// Edits of one kind join into one undo while a gesture lasts.
    gesture: bool,
    /// Whether the gesture's parameter edits apply at the present step; the first one decides.
    gesture_now: Option<bool>,
    /// The run as it was before the last edit of the script, until the next step: where the gesture's next edit in
    /// the same step starts from.
    unedited: Option<Run>,
}

impl Session {
    /// Opens a scenario; its saved edits are replayed up to its duration, and the cursor stands at the start.
    ///
    /// # Errors
    /// If it cannot start, or one of its edits cannot apply. A session that was saved while it waited waits again.
    pub fn open(scenario: Scenario) -> Result<Self, Refusal> {
        // A saved session may have waited; a task that has just been written has not.
        let patient = !scenario.edits.is_empty();
        Self::opened(scenario, patient)
    }

    /// The same; a task that does not fit its machine waits, and [`Run::waiting`] says why.
    ///
    /// # Errors
    /// If a value is out of range, the machine has no reactionless planes, or one of its edits cannot apply.
    pub fn open_waiting(scenario: Scenario) -> Result<Self, Refusal> {
        Self::opened(scenario, true)
    }

    fn opened(mut scenario: Scenario, patient: bool) -> Result<Self, Refusal> {
        let edits = std::mem::take(&mut scenario.edits);
        Self::replayed(scenario, in_order(&edits), patient).map_err(|failed| failed.named(&edits))
    }

    fn replayed(scenario: Scenario, script: Vec<TimedEdit>, patient: bool) -> Result<Self, Failed> {
        let known: Script = script.iter().cloned().collect();
        let runs = known.is_led() || script.last().is_some_and(|e| e.step > 0);
        let end = match runs {
            true => {
                let run = Run::begin(&scenario, &script, None)?.0;
                let end = match run.waiting() {
                    Some(_) => {
                        let known = run.scenario().duration.map_or(0, |_| run.last_step());
                        known.max(script.last().map_or(0, |e| e.step))
                    }
                    None => run.whole(&script)?,
                };
                let end = end.min(MAX_FRAMES as u64 - 1);
                if let Some(late) = script.iter().position(|e| e.step > end) {
                    return Err(Failed::at(late, Refusal::Full { time: end as f64 * run.scenario().step }));
                }
                end
            }
            false => 0,
        };
        let mut session = Self::of(Document { scenario: Arc::new(scenario), script: known, end }, patient)?;
        session.cursor = 0;
        Ok(session)
    }

    fn of(document: Document, patient: bool) -> Result<Self, Failed> {
        let (run, frames) = perform(&document, None, patient)?;
        let cursor = frames.len() - 1;
        Ok(Self {
            edits: document.script.to_vec(),
            document,
            run,
            frames,
            cursor,
            playing: false,
            undo: Vec::new(),
            redo: Vec::new(),
            gesture: false,
            gesture_now: None,
            unedited: None,
        })
    }

    /// The instant on display.
    pub fn frame(&self) -> &Frame {
        &self.frames[self.cursor]
    }

    /// Every frame so far, one a step.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// The scenario with everything that edits have set.
    pub fn scenario(&self) -> &Scenario {
        self.run.scenario()
    }

    /// The run at its newest step.
    pub fn run(&self) -> &Run {
        &self.run
    }

    /// Edits so far.
    pub fn script(&self) -> &[TimedEdit] {
        &self.edits
    }

    /// Whether time is to pass.
    pub fn is_playing(&self) -> bool {
        self.playing
    }

    /// Whether the display will change by itself.
    pub fn is_moving(&self) -> bool {
        self.playing && self.run.waiting().is_none() && !(self.is_at_end() && self.is_settled())
    }

    /// Whether there can be one more frame.
    fn has_room(&self) -> bool {
        let goes_on = self.frames.last().is_some_and(Frame::is_finite);
        goes_on && !self.is_full() && self.run.waiting().is_none()
    }

    /// Whether it holds as many frames as it can: time stands still until it starts over.
    pub fn is_full(&self) -> bool {
        self.frames.len() >= MAX_FRAMES || self.run.simulation().time() >= MAX_TIME
    }

    /// Whether the newest frame is on display.
    pub fn is_at_end(&self) -> bool {
        self.cursor + 1 == self.frames.len()
    }

    fn is_settled(&self) -> bool {
        self.run.simulation().is_settled()
    }

    /// Length of the time line, s: the planned motion, or as far as the run has got.
    pub fn length(&self) -> f64 {
        let done = self.run.simulation().time();
        if self.is_led() { done } else { done.max(self.run.planned_time()) }
    }

    /// The pose constant that the machine is sent to, rad; on display, if it was scrubbed back, what it was then.
    pub fn b_aim(&self) -> f64 {
        match self.run.simulation().guide() {
            crate::simulation::Guide::Follow(follower) if self.is_at_end() => follower.b_aim(),
            _ => self.frame().b_reference,
        }
    }

    /// The b nearest to one, rad, at which the points of the task stay where they are; `None` if no b serves them all.
    pub fn serving(&self, b: f64) -> Option<f64> {
        let task = &self.scenario().task;
        if task.samples.as_ref().is_some_and(|samples| samples.columns() != 2) {
            // Samples of the drives have a b of their own.
            return Some(task.b);
        }
        let common = self.run.planes()?.common(&task.points())?;
        let nearest = common.nearest(b)?;
        Some(if nearest == b { b } else { common.inwards(nearest, 1e-6) })
    }

    /// Whether somebody has led the machine off its planned motion.
    pub fn is_led(&self) -> bool {
        self.document.script.is_led()
    }

    /// Lets time pass. At the end of a finished motion it starts over.
    pub fn play(&mut self) {
        if self.run.waiting().is_some() {
            return;
        }
        if self.is_at_end() && self.is_settled() {
            self.cursor = 0;
        }
        self.playing = true;
    }

    /// Stops time.
    pub fn pause(&mut self) {
        self.playing = false;
    }

    /// Shows an instant, s, as far as the run has got or the planned motion goes.
    pub fn seek(&mut self, time: f64) {
        let step = (time / self.scenario().step).round().max(0.0) as usize;
        if !self.is_led() {
            let planned = (self.run.planned_time() / self.scenario().step - 1e-6).ceil() as usize;
            while self.frames.len() <= step.min(planned) && self.has_room() {
                self.advance_run();
            }
        }
        self.cursor = step.min(self.frames.len() - 1);
    }

    /// Moves the display by steps, either way; past the newest frame the run goes on.
    pub fn step_by(&mut self, steps: i64) {
        self.playing = false;
        let to = (self.cursor as i64).saturating_add(steps).max(0) as usize;
        while self.frames.len() <= to && self.has_room() {
            self.advance_run();
        }
        self.cursor = to.min(self.frames.len() - 1);
    }

    /// Lets `steps` steps pass, if time passes. Nothing happens once everything is at rest.
    pub fn tick(&mut self, steps: u64) {
        for _ in 0..steps {
            if !self.is_moving() {
                return;
            }
            if self.is_at_end() {
                if !self.has_room() {
                    self.playing = false;
                    return;
                }
                self.advance_run();
            }
            self.cursor += 1;
            if !self.frame().is_finite() {
                self.playing = false;
                return;
            }
        }
    }

    fn advance_run(&mut self) {
        self.unedited = None;
        self.run.advance();
        let frame = self.run.frame();
        self.frames.push(frame);
        // A session can be opened again only as far as its run has numbers.
        if frame.is_finite() {
            self.document.end = frame.step;
        }
    }

    /// Applies an edit: to the machine in motion at the present step; at rest, parameters and poses change the start,
    /// and the run so far is made again.
    ///
    /// # Errors
    /// If it cannot apply; then nothing has changed. Joint limits always apply: where the task does not fit into them,
    /// the run waits.
    pub fn apply(&mut self, edit: Edit) -> Result<(), Refusal> {
        let mut now = self.concerns_now(&edit);
        if let (true, Some(waiting)) = (now, self.run.waiting()) {
            return Err(waiting.why.clone());
        }
        let done = if now { self.apply_now(edit.clone()) } else { self.amend(edit.clone()) };
        match done {
            Err(_) if now && edit.sets_limits() => {
                // The motion in progress does not keep them: they hold from its start.
                now = false;
                self.amend(edit)?;
            }
            done => done?,
        }
        self.gesture_now = Some(now);
        Ok(())
    }

    /// Whether an edit applies at the present step rather than to the run as a whole.
    fn concerns_now(&self, edit: &Edit) -> bool {
        match edit {
            Edit::DragTarget { .. } | Edit::SlideB { .. } | Edit::Push { .. } => true,
            Edit::PoseB { .. } => self.is_led(),
            // A machine that is led by hand has the new limits from the present step on.
            edit if edit.sets_limits() && self.is_led() && self.run.waiting().is_none() => true,
            // A motion in progress cannot change its time or its base.
            edit if edit.is_of_the_whole() => false,
            // A slider that set the machine in motion goes on as it began.
            _ => self.gesture_now.unwrap_or_else(|| self.is_running()),
        }
    }

    /// Whether the newest frame is on display and time passes.
    fn is_running(&self) -> bool {
        self.is_moving() && self.is_at_end()
    }

    /// At the present step; later frames, if the display was scrubbed back, are replaced.
    fn apply_now(&mut self, edit: Edit) -> Result<(), Refusal> {
        if self.is_full() && self.is_at_end() && (edit.leads() || matches!(edit, Edit::Push { .. })) {
            return Err(Refusal::Full { time: self.run.simulation().time() });
        }
        let before = self.document.clone();
        let mut document = before.clone();
        let mut remade = None;
        if !self.is_at_end() {
            document.end = self.cursor as u64;
            document.script.cut(document.end);
            remade = Some(perform(&document, Some(&self.run), false).map_err(Failed::refusal)?);
        }
        let timed = TimedEdit { step: document.end, edit };
        let joins = self.gesture
            && remade.is_none()
            && document.script.last().is_some_and(|e| e.step == timed.step && e.edit.is_replaced_by(&timed.edit));
        // An edit that replaces the one before starts from the run before that one, so that it leaves no trace.
        let unedited = match (&remade, &self.unedited) {
            (Some((run, _)), _) => run.clone(),
            (None, Some(run)) if joins => {
                document.script.pop();
                run.clone()
            }
            _ => self.run.clone(),
        };
        let inverse = unedited.inverse_of(&timed.edit);
        let mut run = unedited.clone();
        run.apply(&timed.edit)?;
        self.edits.truncate(document.script.len());
        self.edits.push(timed.clone());
        document.script.push(timed.clone());
        if let Some((_, frames)) = remade {
            self.frames = frames;
        }
        (self.document, self.run, self.unedited) = (document, run, Some(unedited));
        self.show_present();
        self.cursor = self.frames.len() - 1;
        if timed.edit.leads() {
            self.playing = true;
        }
        self.remember(before, timed, inverse);
        Ok(())
    }

    /// Before the first step, whatever has happened since: for a parameter, during the whole run.
    fn amend(&mut self, edit: Edit) -> Result<(), Refusal> {
        let (before, inverse) = (self.document.clone(), self.run.inverse_of(&edit));
        let timed = TimedEdit { step: 0, edit };
        let document = self.amended(&timed);
        match &timed.edit {
            edit if edit.is_aside() => {
                self.run.apply(&timed.edit)?;
                self.edits = document.script.to_vec();
                self.document = document;
            }
            edit => {
                let patient = edit.sets_machine() || self.run.waiting().is_some();
                self.restore(document, patient)?;
            }
        }
        self.remember(before, timed, inverse);
        Ok(())
    }

    /// The document with an edit before the first step.
    fn amended(&self, timed: &TimedEdit) -> Document {
        let mut document = self.document.clone();
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
        let mut script: Vec<TimedEdit> =
            self.edits.iter().filter(|e| !e.edit.is_replaced_by(&timed.edit)).cloned().collect();
        if timed.edit.sets_path() && self.is_led() {
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

    /// The newest frame once more, after an edit.
    fn show_present(&mut self) {
        if let Some(last) = self.frames.last_mut() {
            *last = self.run.frame();
        }
    }

    fn remember(&mut self, before: Document, timed: TimedEdit, inverse: Option<Edit>) {
        self.redo.clear();
        let joins = self.gesture
            && self.undo.last().is_some_and(|c| c.edit.as_ref().is_some_and(|e| e.edit.is_replaced_by(&timed.edit)));
        match self.undo.last_mut() {
            Some(last) if joins => {
                last.title = timed.edit.title();
                last.edit = Some(timed);
            }
            _ => {
                let title = timed.edit.title();
                self.undo.push(Change { before, edit: Some(timed), inverse, title });
            }
        }
        self.gesture = true;
    }

    /// Ends a drag: the next edit is an undo of its own.
    pub fn end_gesture(&mut self) {
        self.gesture = false;
        self.gesture_now = None;
        self.unedited = None;
    }

    /// What undo would take back.
    pub fn undo_title(&self) -> Option<&str> {
        self.undo.last().map(|c| c.title.as_str())
    }

    /// What redo would bring back.
    pub fn redo_title(&self) -> Option<&str> {
        self.redo.last().map(|c| c.title.as_str())
    }

    /// Takes the last edit back: in motion by its inverse at the present step, paused or at rest by restoring what was.
    ///
    /// # Errors
    /// If what was cannot be restored; then nothing has changed.
    pub fn undo(&mut self) -> Result<(), Refusal> {
        self.end_gesture();
        let Some(change) = self.undo.last().cloned() else { return Ok(()) };
        let after = self.document.clone();
        let done = match &change.inverse {
            Some(inverse) if self.is_running() && !change.plans() => {
                self.append(inverse.clone()).or_else(|_| self.return_to(&change.before))
            }
            _ => self.return_to(&change.before),
        };
        done?;
        self.undo.pop();
        self.redo.push(Change { before: after, ..change });
        Ok(())
    }

    /// Brings back what undo took.
    ///
    /// # Errors
    /// If it cannot apply; then nothing has changed.
    pub fn redo(&mut self) -> Result<(), Refusal> {
        self.end_gesture();
        let Some(change) = self.redo.last().cloned() else { return Ok(()) };
        let before = self.document.clone();
        let done = match &change.edit {
            Some(timed) if self.is_running() && !change.plans() => {
                self.append(timed.edit.clone()).or_else(|_| self.return_to(&change.before))
            }
            _ => self.return_to(&change.before),
        };
        done?;
        self.redo.pop();
        self.undo.push(Change { before, ..change });
        Ok(())
    }

    /// Applies while time passes, without touching history.
    fn append(&mut self, edit: Edit) -> Result<(), Refusal> {
        if !self.concerns_now(&edit) {
            return self.restore(self.amended(&TimedEdit { step: 0, edit }), false);
        }
        self.run.apply(&edit)?;
        let timed = TimedEdit { step: self.document.end, edit };
        self.edits.push(timed.clone());
        self.document.script.push(timed);
        self.show_present();
        Ok(())
    }

    /// What was, with time standing still.
    fn return_to(&mut self, document: &Document) -> Result<(), Refusal> {
        self.restore(document.clone(), true)?;
        self.playing = false;
        if self.is_led() {
            self.cursor = self.frames.len() - 1;
        }
        Ok(())
    }

    /// Makes the run of a document; the display stays where it is, if there is a frame. With patience, a task that does
    /// not fit its machine waits; the document stays whole, to go on where it was once it fits again.
    fn restore(&mut self, document: Document, patient: bool) -> Result<(), Refusal> {
        let (run, frames) = perform(&document, Some(&self.run), patient).map_err(Failed::refusal)?;
        self.playing &= run.waiting().is_none();
        self.edits = document.script.to_vec();
        (self.document, self.run, self.frames, self.unedited) = (document, run, frames, None);
        self.cursor = self.cursor.min(self.frames.len() - 1);
        Ok(())
    }

    /// Replaces everything by another scenario; undo brings this one back.
    ///
    /// # Errors
    /// If it cannot start; then nothing has changed.
    pub fn switch(&mut self, scenario: Scenario) -> Result<(), Refusal> {
        let title = format!("open {}", scenario.title);
        let mut next = Self::open(scenario)?;
        next.undo = std::mem::take(&mut self.undo);
        next.undo.push(Change { before: self.document.clone(), edit: None, inverse: None, title });
        *self = next;
        Ok(())
    }

    /// The session as a scenario: replayed or opened again, it gives equal frames. One that has not begun covers its
    /// motion.
    pub fn to_scenario(&self) -> Scenario {
        let mut scenario = Scenario::clone(&self.document.scenario);
        scenario.edits.clone_from(&self.edits);
        scenario.duration = match self.document.end {
            0 => self.scenario().duration,
            end => Some(end as f64 * self.scenario().step),
        };
        scenario
    }
}

/// Runs a document from its start to its end.
fn perform(document: &Document, known: Option<&Run>, patient: bool) -> Result<(Run, Vec<Frame>), Failed> {
    let mut frames = Vec::with_capacity(document.end as usize + 1);
    let see = |_: &Run, frame: &Frame| frames.push(*frame);
    let end = |_: &Run, _: &[TimedEdit]| Ok(document.end);
    let run = replay::perform(&document.scenario, &document.script.to_vec(), (end, patient), known, see)?;
    Ok((run, frames))
}
