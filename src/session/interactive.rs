//! A [`Session`]: a scenario, what was done to it, and every frame so far.
//!
//! The window owns one and only sends it [`Edit`]s and transport commands (play, pause, seek); [`replay`] carries out
//! the same edits without a window. Because a run is a function of scenario and edits, undo, scrubbing and saving need
//! no snapshots of state: the run is made again.

mod bookmarks;
mod branches;

use std::sync::Arc;

use super::changes::{Failed, in_order};
use super::document::{Document, Kept, Performed, WORD, Watch};
use super::edit::{Edit, TimedEdit};
use super::events::{Gestures, Watched};
use super::machines::Machines;
use super::refusal::Refusal;
use super::run::Run;
use super::script::Script;
use crate::query::{Grown, Queries, Sequence};
use crate::session::scenario::{MAX_FRAMES, MAX_TIME, Scenario};
use crate::simulation::frame::Frame;

/// One step of history.
#[derive(Clone, Debug)]
struct Change {
    before: Document,
    edit: Option<TimedEdit>,
    /// What takes it back while the machine moves.
    inverse: Option<Edit>,
    title: String,
    /// Only this of what is kept beside the run has changed.
    beside: Option<Kept>,
}

impl Change {
    /// Whether it changes the task or the base: the motion is then planned anew, so it can stand only before the first
    /// step.
    fn plans(&self) -> bool {
        self.edit.as_ref().is_some_and(|e| e.edit.sets_path() || e.edit.sets(&["base"]))
    }

    /// Whether no frame depends on what it has changed.
    fn is_aside(&self) -> bool {
        self.edit.as_ref().is_some_and(|e| e.edit.is_aside())
    }
}

/// A run that a person edits while it goes on. A copy shares frames and history, so that it costs the same however long
/// the session is; what takes long can be done to it beside the window.
#[derive(Clone, Debug)]
pub struct Session {
    document: Document,
    /// The script of the document, one after the other.
    edits: Sequence<TimedEdit>,
    run: Run,
    frames: Sequence<Frame>,
    machines: Machines,
    cursor: usize,
    playing: bool,
    undo: Vec<Arc<Change>>,
    redo: Vec<Arc<Change>>,
    /// Edits of one kind join into one undo while a gesture lasts.
    gesture: bool,
    /// Whether the gesture's parameter edits apply at the present step; the first one decides.
    gesture_now: Option<bool>,
    /// The run as it was before the last edit of the script, until the next step: where the gesture's next edit in
    /// the same step starts from.
    unedited: Option<Run>,
    /// How many branches were left, and the title of the one that the last has displaced.
    partings: (u64, Option<String>),
}

impl Session {
    /// Opens a scenario; its saved edits are replayed up to its duration, and the cursor stands at the start.
    ///
    /// # Errors
    /// If it cannot start, or one of its edits cannot apply. A session that was saved while it waited waits again.
    pub fn open(scenario: Scenario) -> Result<Self, Refusal> {
        Self::open_while(scenario, &mut |_| true)
    }

    /// The same, while it is wanted.
    ///
    /// # Errors
    /// As [`open`](Self::open), and if it is not wanted any more.
    pub fn open_while(scenario: Scenario, watch: Watch<'_>) -> Result<Self, Refusal> {
        // A saved session may have waited; a task that has just been written has not.
        let patient = !scenario.edits.is_empty();
        Self::opened(scenario, patient, watch)
    }

    /// The same; a task that does not fit its machine waits, and [`Run::waiting`] says why.
    ///
    /// # Errors
    /// If a value is out of range, the machine has no reactionless planes, or one of its edits cannot apply.
    pub fn open_waiting(scenario: Scenario) -> Result<Self, Refusal> {
        Self::opened(scenario, true, &mut |_| true)
    }

    fn opened(mut scenario: Scenario, patient: bool, watch: Watch<'_>) -> Result<Self, Refusal> {
        let edits = std::mem::take(&mut scenario.edits);
        let (bookmarks, branches) = (std::mem::take(&mut scenario.bookmarks), std::mem::take(&mut scenario.branches));
        let opened = Self::replayed(scenario, in_order(&edits), patient, watch);
        let mut session = opened.map_err(|failed| failed.named(&edits))?;
        session.keep_beside(bookmarks, &branches);
        Ok(session)
    }

    fn replayed(scenario: Scenario, script: Vec<TimedEdit>, patient: bool, watch: Watch<'_>) -> Result<Self, Failed> {
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
        let mut session = Self::of(Document::new(scenario, known, end), patient, watch)?;
        session.cursor = 0;
        Ok(session)
    }

    fn of(document: Document, patient: bool, watch: Watch<'_>) -> Result<Self, Failed> {
        let Performed { run, frames, machines } = document.perform(None, patient, watch)?;
        let cursor = frames.len() - 1;
        Ok(Self {
            edits: document.script.to_vec().into_iter().collect(),
            document,
            run,
            frames,
            machines,
            cursor,
            playing: false,
            undo: Vec::new(),
            redo: Vec::new(),
            gesture: false,
            gesture_now: None,
            unedited: None,
            partings: (0, None),
        })
    }

    /// The instant on display.
    pub fn frame(&self) -> &Frame {
        &self.frames[self.cursor]
    }

    /// Every frame so far, one a step.
    pub fn frames(&self) -> &Sequence<Frame> {
        &self.frames
    }

    /// Which machine it had when.
    pub fn machines(&self) -> &Machines {
        &self.machines
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
    pub fn script(&self) -> &Sequence<TimedEdit> {
        &self.edits
    }

    /// What hands have done, told by a store of answers.
    pub fn gestures(&self, queries: &Queries) -> Grown<Gestures> {
        queries.grow(&self.scenario().step, &self.edits, usize::MAX)
    }

    /// What has happened apart from that, told by a store of answers that reads so many new frames at most.
    pub fn events(&self, queries: &Queries, at_most: usize) -> Grown<Watched> {
        queries.grow(&(self.scenario().step, self.machines.clone()), &self.frames, at_most)
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
        // Where a point is reached at one b alone, points turn with it.
        let several = self.run.pose_space().is_ok_and(|space| space.reaches_area());
        let common = if several { self.run.bands()? } else { return None };
        let nearest = common.nearest(b)?;
        Some(if nearest == b { b } else { common.inwards(nearest, 1e-6) })
    }

    /// The b nearest to one within a range, rad, at which the points of the task stay where they are: unlike
    /// [`serving`](Self::serving) it never goes round the circle of b.
    pub fn serving_within(&self, b: f64, [low, high]: [f64; 2]) -> Option<f64> {
        if self.serving(b)? == b {
            return Some(b);
        }
        let common = self.run.bands()?;
        let turns = |from: f64| [-1.0, 0.0, 1.0].map(|turn| from + turn * common.period);
        let near = common.near(0.5 * (low + high));
        let ends = near.intervals.iter().flatten().flat_map(|end| turns(*end));
        let ends = ends.filter(|end| (low..=high).contains(end));
        let nearest = ends.min_by(|x, y| (x - b).abs().total_cmp(&(y - b).abs()))?;
        Some(common.inwards(nearest, 1e-6))
    }

    /// Whether somebody has led the machine off its planned motion.
    pub fn is_led(&self) -> bool {
        self.document.script.is_led()
    }

    /// Whether a hand can lead the machine: it has a b to hold, and the run does not wait.
    pub fn follows_hands(&self) -> bool {
        self.run.waiting().is_none() && self.run.pose_space().is_ok()
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
        self.seek_while(time, &mut |_| true);
    }

    /// The same, as far as it is wanted.
    pub fn seek_while(&mut self, time: f64, watch: Watch<'_>) {
        let step = (time / self.scenario().step).round().max(0.0) as usize;
        let ahead = self.steps_to(time);
        for i in 1..=ahead {
            if !self.has_room() || (i.is_multiple_of(WORD) && !watch(i as f64 / ahead as f64)) {
                break;
            }
            self.advance_run();
        }
        self.cursor = step.min(self.frames.len() - 1);
    }

    /// How many steps the run has still to do before it is at a time, s, of its planned motion.
    fn steps_to(&self, time: f64) -> usize {
        if self.is_led() {
            return 0;
        }
        let step = self.scenario().step;
        let planned = (self.run.planned_time() / step - 1e-6).ceil() as usize;
        let to = (time / step).round().max(0.0) as usize;
        (to.min(planned) + 1).saturating_sub(self.frames.len())
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
        self.apply_while(edit, &mut |_| true)
    }

    /// The same, while it is wanted.
    ///
    /// # Errors
    /// As [`apply`](Self::apply), and if it is not wanted any more.
    pub fn apply_while(&mut self, edit: Edit, watch: Watch<'_>) -> Result<(), Refusal> {
        let mut now = self.concerns_now(&edit);
        if let (true, Some(waiting)) = (now, self.run.waiting()) {
            return Err(waiting.why.clone());
        }
        let done = match now {
            true => self.apply_now(edit.clone(), watch),
            false => self.amend(edit.clone(), watch),
        };
        match done {
            Err(why) if now && edit.sets_limits() && why != Refusal::Stopped => {
                // The motion in progress does not keep them: they hold from its start.
                now = false;
                self.amend(edit, watch)?;
            }
            done => done?,
        }
        self.gesture_now = Some(now);
        Ok(())
    }

    /// Whether an edit applies at the present step rather than to the run as a whole.
    fn concerns_now(&self, edit: &Edit) -> bool {
        match edit {
            edit if edit.leads() => true,
            Edit::Push { .. } => true,
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
    fn apply_now(&mut self, edit: Edit, watch: Watch<'_>) -> Result<(), Refusal> {
        if self.is_full() && self.is_at_end() && (edit.leads() || matches!(edit, Edit::Push { .. })) {
            return Err(Refusal::Full { time: self.run.simulation().time() });
        }
        let before = self.document.clone();
        let mut document = before.clone();
        let (mut remade, mut partings) = (None, self.partings.clone());
        if !self.is_at_end() {
            (document.branches, partings) = self.with_left();
            document.end = self.cursor as u64;
            document.script.cut(document.end);
            remade = Some(document.perform(Some(&self.run), false, watch).map_err(Failed::refusal)?);
        }
        let timed = TimedEdit { step: document.end, edit };
        let joins = self.gesture
            && remade.is_none()
            && document.script.last().is_some_and(|e| e.step == timed.step && e.edit.is_replaced_by(&timed.edit));
        // An edit that replaces the one before starts from the run before that one, so that it leaves no trace.
        let unedited = match (&remade, &self.unedited) {
            (Some(remade), _) => remade.run.clone(),
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
        if let Some(remade) = remade {
            (self.frames, self.machines) = (remade.frames, remade.machines);
        }
        (self.document, self.run, self.unedited, self.partings) = (document, run, Some(unedited), partings);
        self.show_present();
        self.cursor = self.frames.len() - 1;
        if timed.edit.leads() {
            self.playing = true;
        }
        self.remember(before, timed, inverse);
        Ok(())
    }

    /// Before the first step, whatever has happened since: for a parameter, during the whole run.
    fn amend(&mut self, edit: Edit, watch: Watch<'_>) -> Result<(), Refusal> {
        let (before, inverse) = (self.document.clone(), self.run.inverse_of(&edit));
        let timed = TimedEdit { step: 0, edit };
        let mut document = self.document.amended(&timed);
        let mut partings = self.partings.clone();
        // What was led by hand would be gone.
        if self.is_led() && !document.script.is_led() {
            (document.branches, partings) = self.with_left();
        }
        match &timed.edit {
            edit if edit.is_aside() => {
                self.run.apply(&timed.edit)?;
                self.unedited = None;
                self.edits = document.script.to_vec().into_iter().collect();
                self.document = document;
            }
            edit => {
                let patient = edit.sets_machine() || self.run.waiting().is_some();
                self.restore(document, patient, watch)?;
            }
        }
        self.partings = partings;
        self.remember(before, timed, inverse);
        Ok(())
    }

    /// The newest frame once more, after an edit.
    fn show_present(&mut self) {
        let frame = self.run.frame();
        self.machines.hold(frame.step, &self.scenario().machine.clone());
        self.frames.replace_last(frame);
    }

    fn remember(&mut self, before: Document, timed: TimedEdit, inverse: Option<Edit>) {
        self.redo.clear();
        let joins = self.gesture
            && self.undo.last().is_some_and(|c| c.edit.as_ref().is_some_and(|e| e.edit.is_replaced_by(&timed.edit)));
        match self.undo.last_mut() {
            Some(last) if joins => {
                let last = Arc::make_mut(last);
                last.title = timed.edit.title();
                last.edit = Some(timed);
            }
            _ => {
                let title = timed.edit.title();
                self.undo.push(Arc::new(Change { before, edit: Some(timed), inverse, title, beside: None }));
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

    /// Whether the last change is of a drag that goes on.
    pub fn is_in_gesture(&self) -> bool {
        self.gesture
    }

    /// How many changes can be undone.
    pub fn undo_count(&self) -> usize {
        self.undo.len()
    }

    /// What undo would take back.
    pub fn undo_title(&self) -> Option<&str> {
        self.undo.last().map(|c| c.title.as_str())
    }

    /// What redo would bring back.
    pub fn redo_title(&self) -> Option<&str> {
        self.redo.last().map(|c| c.title.as_str())
    }

    /// Titles of all changes: those that can be undone from the first on, then those that can be brought back.
    pub fn history(&self) -> impl Iterator<Item = &str> {
        self.undo.iter().chain(self.redo.iter().rev()).map(|change| change.title.as_str())
    }

    /// Takes the last edit back: in motion by its inverse at the present step, paused or at rest by restoring what was.
    ///
    /// # Errors
    /// If what was cannot be restored; then nothing has changed.
    pub fn undo(&mut self) -> Result<(), Refusal> {
        self.undo_while(&mut |_| true)
    }

    /// The same, while it is wanted.
    ///
    /// # Errors
    /// As [`undo`](Self::undo), and if it is not wanted any more.
    pub fn undo_while(&mut self, watch: Watch<'_>) -> Result<(), Refusal> {
        self.end_gesture();
        let Some(change) = self.undo.last().cloned() else { return Ok(()) };
        let after = self.document.clone();
        let done = match (&change.inverse, change.beside) {
            (_, Some(kept)) => {
                self.document.keep_as(&change.before, kept);
                Ok(())
            }
            (_, None) if change.is_aside() && self.go_aside(&change.before) => Ok(()),
            (Some(inverse), None) if self.is_running() && !change.plans() => {
                self.append(inverse.clone(), watch).or_else(|why| self.instead(why, &change.before, watch))
            }
            _ => self.return_to(&change.before, watch),
        };
        done?;
        self.undo.pop();
        self.redo.push(Arc::new(Change { before: after, ..Change::clone(&change) }));
        Ok(())
    }

    /// Brings back what undo took.
    ///
    /// # Errors
    /// If it cannot apply; then nothing has changed.
    pub fn redo(&mut self) -> Result<(), Refusal> {
        self.redo_while(&mut |_| true)
    }

    /// The same, while it is wanted.
    ///
    /// # Errors
    /// As [`redo`](Self::redo), and if it is not wanted any more.
    pub fn redo_while(&mut self, watch: Watch<'_>) -> Result<(), Refusal> {
        self.end_gesture();
        let Some(change) = self.redo.last().cloned() else { return Ok(()) };
        let before = self.document.clone();
        let done = match (&change.edit, change.beside) {
            (_, Some(kept)) => {
                self.document.keep_as(&change.before, kept);
                Ok(())
            }
            (_, None) if change.is_aside() && self.go_aside(&change.before) => Ok(()),
            (Some(timed), None) if self.is_running() && !change.plans() => {
                self.append(timed.edit.clone(), watch).or_else(|why| self.instead(why, &change.before, watch))
            }
            _ => self.return_to(&change.before, watch),
        };
        done?;
        self.redo.pop();
        self.undo.push(Arc::new(Change { before, ..Change::clone(&change) }));
        Ok(())
    }

    /// What was, with the frames that are there, if it differs in nothing on which they depend; the scenario of its run.
    fn aside(&self, before: &Document) -> Option<(Document, Scenario)> {
        let document = Document { end: self.document.end, ..before.clone() };
        let scenario = document.aside_of(&self.document)?;
        Some((document, scenario))
    }

    /// Returns to that; whether it could.
    fn go_aside(&mut self, before: &Document) -> bool {
        let Some((document, scenario)) = self.aside(before) else { return false };
        if self.run.set_asides(&scenario).is_err() {
            return false;
        }
        self.unedited = None;
        self.edits = document.script.to_vec().into_iter().collect();
        self.document = document;
        true
    }

    /// Applies while time passes, without touching history.
    fn append(&mut self, edit: Edit, watch: Watch<'_>) -> Result<(), Refusal> {
        if !self.concerns_now(&edit) {
            return self.restore(self.document.amended(&TimedEdit { step: 0, edit }), false, watch);
        }
        self.run.apply(&edit)?;
        let timed = TimedEdit { step: self.document.end, edit };
        self.edits.push(timed.clone());
        self.document.script.push(timed);
        self.show_present();
        Ok(())
    }

    /// What was, where the inverse cannot apply; not if the inverse is not wanted any more.
    fn instead(&mut self, why: Refusal, document: &Document, watch: Watch<'_>) -> Result<(), Refusal> {
        if why == Refusal::Stopped { Err(why) } else { self.return_to(document, watch) }
    }

    /// What was, with time standing still.
    fn return_to(&mut self, document: &Document, watch: Watch<'_>) -> Result<(), Refusal> {
        self.restore(document.clone(), true, watch)?;
        self.playing = false;
        if self.is_led() {
            self.cursor = self.frames.len() - 1;
        }
        Ok(())
    }

    /// Makes the run of a document; the display stays where it is, if there is a frame. With patience, a task that does
    /// not fit its machine waits; the document stays whole, to go on where it was once it fits again.
    fn restore(&mut self, document: Document, patient: bool, watch: Watch<'_>) -> Result<(), Refusal> {
        let Performed { run, frames, machines } =
            document.perform(Some(&self.run), patient, watch).map_err(Failed::refusal)?;
        self.playing &= run.waiting().is_none();
        self.edits = document.script.to_vec().into_iter().collect();
        (self.document, self.run, self.unedited) = (document, run, None);
        (self.frames, self.machines) = (frames, machines);
        self.cursor = self.cursor.min(self.frames.len() - 1);
        Ok(())
    }

    /// Replaces everything by another scenario; undo brings this one back.
    ///
    /// # Errors
    /// If it cannot start; then nothing has changed.
    pub fn switch(&mut self, scenario: Scenario) -> Result<(), Refusal> {
        self.take_over(Self::open(scenario)?);
        Ok(())
    }

    /// Replaces everything by another session that has just been opened; undo brings this one back.
    pub fn take_over(&mut self, mut next: Self) {
        let title = format!("open {}", next.document.scenario.title);
        next.undo = std::mem::take(&mut self.undo);
        next.partings.0 = self.partings.0;
        next.undo.push(Arc::new(Change {
            before: self.document.clone(),
            edit: None,
            inverse: None,
            title,
            beside: None,
        }));
        *self = next;
    }

    /// The session as a scenario: replayed or opened again, it gives equal frames. One that has not begun covers its
    /// motion.
    pub fn to_scenario(&self) -> Scenario {
        let mut scenario = Scenario::clone(&self.document.scenario);
        scenario.edits = self.edits.to_vec();
        scenario.bookmarks.clone_from(&self.document.bookmarks);
        scenario.branches = self.kept_branches();
        scenario.duration = match self.document.end {
            0 => self.scenario().duration,
            end => Some(end as f64 * self.scenario().step),
        };
        scenario
    }
}
