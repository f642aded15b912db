//! Texts of events, phases and the verdict.

use crate::rerun::{EntityPath, StateChange, StateConfiguration, TextLog, TextLogLevel};

use super::rows::SparseRows;
use super::store::{Instant, RowTimes, Store, StoreError};
use super::style::{brief, colour, under};
use stillbase_picture::scene::Rgba;
use stillbase_picture::scene::palette::Palette;
use stillbase_query::IncrementalQuery;
use stillbase_session::events::{Event, EventKind, EventLog, Hindrance, bookmarked, gestures, noted};
use stillbase_session::scenario::{Scenario, Task};
use stillbase_session::verdict::Verdict;
use stillbase_simulation::frame::{Frame, Peaks, Phase};

/// Paths of the lanes of phases and of refusals.
pub const PHASE_PATH: &str = "phase";
/// See [`PHASE_PATH`].
pub const REFUSALS_PATH: &str = "refusals";

/// State of the lane of refusals while nothing is refused.
const NOTHING_REFUSED: &str = "nothing refused";

/// Events and phases of a case.
#[derive(Debug)]
pub struct Events {
    /// Prefix of the texts, which names the case if there are several.
    prefix: String,
    palette: Palette,
    rows: Vec<Row>,
    phases: SparseRows<Phase>,
    refusals: SparseRows<Option<Hindrance>>,
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
        let (phases, refusals) = (SparseRows::new(), SparseRows::new());
        Self { prefix, palette, rows: Vec::new(), phases, refusals, watched }
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

    /// Records the phase, the refusal and the events of an instant.
    pub fn note(&mut self, at: Instant, frame: &Frame, scenario: &Scenario) {
        self.phases.push(at, frame.phase);
        self.watched.see(frame, (scenario.step, &scenario.machine));
        self.refusals.push(at, self.watched.hindrance());
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
        let Palette { amber, line, reaction, .. } = self.palette;
        let phases = [Phase::Motion, Phase::Follow, Phase::Rest].map(Phase::name);
        let colours = [amber, self.palette.drive(0), line];
        let (clock, rows) = self.phases.take();
        let names = rows.into_iter().map(Phase::name);
        write_lane(store, &under(root, PHASE_PATH), (&phases, &colours), &clock, names)?;
        let [target, wheel, torque] = Hindrance::ALL.map(Hindrance::name);
        let refusals = [target, wheel, torque, NOTHING_REFUSED];
        let (clock, rows) = self.refusals.take();
        let names = rows.into_iter().map(|what| what.map_or(NOTHING_REFUSED, Hindrance::name));
        write_lane(store, &under(root, REFUSALS_PATH), (&refusals, &[amber, reaction, reaction, line]), &clock, names)?;

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

/// Writes a lane: the colours of its states, and the states from each instant on.
fn write_lane(
    store: &mut Store,
    path: &EntityPath,
    (names, colours): (&[&'static str], &[Rgba]),
    clock: &RowTimes,
    states: impl Iterator<Item = &'static str>,
) -> Result<(), StoreError> {
    let looks = StateConfiguration::new()
        .with_values(names.iter().copied())
        .with_labels(names.iter().copied())
        .with_colors(colours.iter().copied().map(colour));
    store.fixed(path, &looks)?;
    store.columns(&clock.columns(), path, StateChange::new().with_state(states).columns_of_unit_batches()?)
}
