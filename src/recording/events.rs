//! Texts of events, phases and the verdict.

use crate::rerun::{EntityPath, StateChange, StateConfiguration, TextLog, TextLogLevel};

use super::rows::SparseRows;
use super::store::{Instant, RowTimes, Store, StoreError};
use super::style::{brief, colour, under};
use stillbase_picture::scene::Rgba;
use stillbase_picture::scene::palette::Palette;
use stillbase_query::IncrementalQuery;
use stillbase_session::events::{Event, EventKind, EventLog, bookmarked, gestures, noted};
use stillbase_session::scenario::{Scenario, Task};
use stillbase_session::verdict::Verdict;
use stillbase_simulation::frame::{Frame, Peaks, Phase};

/// Events and phases of a case.
#[derive(Debug)]
pub struct Events {
    /// Prefix of the texts, which names the case if there are several.
    prefix: String,
    palette: Palette,
    rows: Vec<Row>,
    phases: SparseRows<Phase>,
    watched: EventLog,
}

/// A row of the table.
#[derive(Debug)]
struct Row {
    at: Instant,
    text: String,
    level: &'static str,
    rgba: Rgba,
}

/// A run whose events are written.
#[derive(Clone, Copy, Debug)]
pub struct RecordedRun<'a> {
    pub scenario: &'a Scenario,
    /// Integration step, s.
    pub dt: f64,
    /// Its last instant.
    pub end: Instant,
    pub peaks: &'a Peaks,
    pub verdict: &'a Verdict,
}

impl Events {
    /// Returns an empty list of events.
    pub fn new(prefix: String, palette: Palette) -> Self {
        let watched = EventLog::begin(&Default::default());
        Self { prefix, palette, rows: Vec::new(), phases: SparseRows::new(), watched }
    }

    fn add(&mut self, at: Instant, text: String, level: &'static str, rgba: Rgba) {
        self.rows.push(Row { at, text, level, rgba });
    }

    /// Adds the start of the run.
    pub fn start(&mut self, at: Instant, title: &str, machine: &str) {
        self.add(at, format!("start: {title}, machine {machine}"), TextLogLevel::INFO, self.palette.ink);
    }

    /// Adds the plan; `time` is its duration T, s.
    pub fn plan(&mut self, at: Instant, task: &Task, time: f64) {
        self.add(at, format!("plan: {}, T = {time:.3} s", task.in_one_line()), TextLogLevel::INFO, self.palette.ink);
    }

    /// Records the phase and the events of an instant.
    pub fn note(&mut self, at: Instant, frame: &Frame, scenario: &Scenario) {
        self.phases.push(at, frame.phase);
        self.watched.see(frame, (scenario.step, &scenario.machine));
    }

    fn add_event(&mut self, event: &Event, dt: f64) {
        let (level, rgba) = match event.kind {
            EventKind::Edit => (TextLogLevel::INFO, self.palette.drive(0)),
            EventKind::Bookmark | EventKind::Within => (TextLogLevel::INFO, self.palette.amber),
            EventKind::Note | EventKind::Written => (TextLogLevel::INFO, self.palette.ink),
            EventKind::Beyond => (TextLogLevel::WARN, self.palette.amber),
            EventKind::Warning | EventKind::Peak => (TextLogLevel::WARN, self.palette.reaction),
            EventKind::Fault => (TextLogLevel::ERROR, self.palette.reaction),
        };
        let at = Instant::at(event.step, event.step as f64 * dt);
        self.add(at, event.words.clone(), level, rgba);
    }

    /// Writes all events, phases and the verdict of a run.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write(mut self, store: &mut Store, root: &EntityPath, run: &RecordedRun<'_>) -> Result<(), StoreError> {
        let RecordedRun { scenario, dt, end, peaks, verdict } = *run;
        let states = [Phase::Motion, Phase::Follow, Phase::Rest];
        let lanes = StateConfiguration::new()
            .with_values(states.map(Phase::name))
            .with_labels(states.map(Phase::name))
            .with_colors([self.palette.amber, self.palette.drive(0), self.palette.line].map(colour));
        store.fixed(&under(root, "phase"), &lanes)?;
        let (clock, phases) = self.phases.take();
        let states = StateChange::new().with_state(phases.into_iter().map(Phase::name));
        store.columns(&clock.columns(), &under(root, "phase"), states.columns_of_unit_batches()?)?;

        let mut all = gestures(&scenario.edits, dt);
        all.extend_from_slice(self.watched.events());
        // Bookmarks and notes may be beyond the end of the recording.
        let own = bookmarked(&scenario.bookmarks, dt).into_iter().chain(noted(&scenario.notes, dt));
        all.extend(own.filter(|mark| mark.step <= end.step));
        all.extend((!verdict.reactionless).then(|| self.watched.peak()));
        all.iter().for_each(|event| self.add_event(event, dt));
        let torques: Vec<String> = peaks.torque.iter().map(|t| brief(*t)).collect();
        self.add(end, format!("peak |τ| {} N m", torques.join(", ")), TextLogLevel::INFO, self.palette.ink);
        let (level, rgba) = match verdict.spares_base() {
            true => (TextLogLevel::INFO, self.palette.zero),
            false => (TextLogLevel::WARN, self.palette.reaction),
        };
        self.add(end, verdict.sentence(), level, rgba);
        self.rows.sort_by_key(|row| row.at.step);
        let mut clock = RowTimes::default();
        self.rows.iter().for_each(|row| clock.push(row.at));
        let log = TextLog::update_fields()
            .with_many_text(self.rows.iter().map(|row| format!("{}{}", self.prefix, row.text)))
            .with_many_level(self.rows.iter().map(|row| row.level))
            .with_many_color(self.rows.iter().map(|row| colour(row.rgba)));
        store.columns(&clock.columns(), &under(root, "events"), log.columns_of_unit_batches()?)
    }
}
