//! What happened: events, phases and the verdict, in words.

use std::mem::discriminant;

use rerun::{EntityPath, StateChange, StateConfiguration, TextLog, TextLogLevel};

use super::rows::Track;
use super::store::{Clock, Instant, Store, StoreError};
use super::style::{brief, colour, under};
use crate::picture::scene::Rgba;
use crate::picture::scene::palette::Palette;
use crate::session::Edit;
use crate::session::scenario::Task;
use crate::session::verdict::Verdict;
use crate::simulation::frame::{Frame, Peaks, Phase, Reach};

/// Events and phases of a case.
#[derive(Debug)]
pub struct Events {
    /// Tells the events of several cases apart.
    prefix: String,
    palette: Palette,
    events: Vec<Event>,
    phases: Track<Phase>,
    reach: Option<Reach>,
    held: Option<bool>,
    saturated: bool,
    faulty: bool,
    peak: (Instant, f64),
    gesture: Option<Gesture>,
}

/// Edits that are one gesture: a push until it is let go, a drag until the pointer rests.
#[derive(Debug)]
struct Gesture {
    /// Which event tells of it.
    event: usize,
    first: Instant,
    last: Instant,
    edit: Edit,
    /// The largest push, N.
    push: f64,
}

/// A gesture goes on while its edits come so close, ns: a screen brings one a frame.
const GESTURE: i64 = 250_000_000;

#[derive(Debug)]
struct Event {
    at: Instant,
    text: String,
    level: &'static str,
    rgba: Rgba,
}

impl Events {
    /// Nothing has happened yet.
    pub fn new(prefix: String, palette: Palette) -> Self {
        let peak = (Instant { step: 0, nanos: 0 }, 0.0);
        Self {
            prefix,
            palette,
            events: Vec::new(),
            phases: Track::new(),
            reach: None,
            held: None,
            saturated: false,
            faulty: false,
            peak,
            gesture: None,
        }
    }

    fn add(&mut self, at: Instant, text: String, level: &'static str, rgba: Rgba) {
        self.events.push(Event { at, text, level, rgba });
    }

    /// It begins.
    pub fn start(&mut self, at: Instant, title: &str, machine: &str) {
        self.add(at, format!("start: {title}, machine {machine}"), TextLogLevel::INFO, self.palette.ink);
    }

    /// What is planned, to take T, s.
    pub fn plan(&mut self, at: Instant, task: &Task, time: f64) {
        self.add(at, format!("plan: {}, T = {time:.3} s", task.in_one_line()), TextLogLevel::INFO, self.palette.ink);
    }

    /// Somebody changed something. What one gesture does, frame by frame, is one event, at its beginning.
    pub fn edit(&mut self, at: Instant, edit: &Edit) {
        let force = |edit: &Edit| match edit {
            Edit::Push { x, y } => x.hypot(*y),
            _ => 0.0,
        };
        // A push lasts until it is let go, however still the hand is.
        let goes_on = |gesture: &Gesture| match edit {
            Edit::Push { .. } => force(edit) > 0.0 && force(&gesture.edit) > 0.0,
            _ => at.nanos - gesture.last.nanos <= GESTURE,
        };
        if let Some(gesture) = &mut self.gesture
            && gesture.edit.is_replaced_by(edit)
            && goes_on(gesture)
        {
            (gesture.last, gesture.edit) = (at, edit.clone());
            gesture.push = gesture.push.max(force(edit));
            let lasts = 1e-9 * (at.nanos - gesture.first.nanos) as f64;
            let title = match edit {
                Edit::Push { .. } => format!("push with up to {:.2} N", gesture.push),
                other => other.title(),
            };
            if let Some(event) = self.events.get_mut(gesture.event) {
                event.text = if lasts > 0.0 { format!("{title}, within {lasts:.3} s") } else { title };
            }
            return;
        }
        let event = self.events.len();
        self.gesture = Some(Gesture { event, first: at, last: at, edit: edit.clone(), push: force(edit) });
        self.add(at, edit.title(), TextLogLevel::INFO, self.palette.drive(0));
    }

    /// What becomes of payload and wheel, and the first time that an audit fails.
    fn watch(&mut self, at: Instant, frame: &Frame) {
        match (self.held.replace(frame.loaded), frame.loaded) {
            (Some(false), true) => {
                self.add(at, "the payload is picked up".into(), TextLogLevel::INFO, self.palette.ink);
            }
            (None, true) => self.add(at, "the payload is held".into(), TextLogLevel::INFO, self.palette.ink),
            (Some(true), false) => {
                self.add(at, "the payload is let go".into(), TextLogLevel::INFO, self.palette.ink);
            }
            _ => {}
        }
        match (std::mem::replace(&mut self.saturated, frame.wheel.saturated), frame.wheel.saturated) {
            (false, true) => {
                let text = format!("the reaction wheel saturates at {} rad/s", brief(frame.wheel.rate));
                self.add(at, text, TextLogLevel::WARN, self.palette.reaction);
            }
            (true, false) => {
                let text = "the reaction wheel gives what is wanted again".into();
                self.add(at, text, TextLogLevel::INFO, self.palette.ink);
            }
            _ => {}
        }
        if let (false, Some(fault)) = (self.faulty, frame.fault()) {
            self.faulty = true;
            let text = format!("audit failed: {} ({}) {:.1e} {}", fault.name, fault.meaning, fault.value, fault.unit);
            self.add(at, text, TextLogLevel::ERROR, self.palette.reaction);
        }
    }

    /// What an instant brings.
    pub fn note(&mut self, at: Instant, frame: &Frame) {
        if frame.peaks.arm_moment > self.peak.1 {
            self.peak = (at, frame.peaks.arm_moment);
        }
        match (self.phases.last(), frame.phase) {
            (Some(Phase::Motion), Phase::Rest) => {
                self.add(at, "end of motion".into(), TextLogLevel::INFO, self.palette.ink);
            }
            (Some(Phase::Follow), Phase::Rest) => self.add(at, "at rest".into(), TextLogLevel::INFO, self.palette.ink),
            _ => {}
        }
        self.phases.push(at, frame.phase);
        self.watch(at, frame);
        let reach = frame.target.reach;
        let before = self.reach.replace(reach);
        if before.is_some_and(|before| discriminant(&before) != discriminant(&reach)) {
            let (text, level) = match reach {
                Reach::Inside => ("the target is inside the reactionless workspace".into(), TextLogLevel::INFO),
                Reach::Carried => ("the target turns with the workspace".into(), TextLogLevel::INFO),
                Reach::Outside { shown_b, .. } => {
                    let mend = shown_b.map_or("no b reaches it".into(), |b| format!("b = {b} rad would reach it"));
                    (format!("the target is outside the reactionless workspace: {mend}"), TextLogLevel::WARN)
                }
            };
            self.add(at, text, level, self.palette.amber);
        }
    }

    /// Writes everything, with the verdict.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write(
        mut self,
        store: &mut Store,
        root: &EntityPath,
        (end, peaks, verdict): (Instant, &Peaks, &Verdict),
    ) -> Result<(), StoreError> {
        let states = [Phase::Motion, Phase::Follow, Phase::Rest];
        let lanes = StateConfiguration::new()
            .with_values(states.map(Phase::name))
            .with_labels(states.map(Phase::name))
            .with_colors([self.palette.amber, self.palette.drive(0), self.palette.line].map(colour));
        store.fixed(&under(root, "phase"), &lanes)?;
        let (clock, phases) = self.phases.take();
        let states = StateChange::new().with_state(phases.into_iter().map(Phase::name));
        store.columns(&clock.columns(), &under(root, "phase"), states.columns_of_unit_batches()?)?;

        if !verdict.reactionless {
            let (at, moment) = self.peak;
            self.add(at, format!("peak |n_B| {} N m", brief(moment)), TextLogLevel::WARN, self.palette.reaction);
        }
        let torques: Vec<String> = peaks.torque.iter().map(|t| brief(*t)).collect();
        self.add(end, format!("peak |τ| {} N m", torques.join(", ")), TextLogLevel::INFO, self.palette.ink);
        let (level, rgba) = match verdict.is_good() {
            true => (TextLogLevel::INFO, self.palette.zero),
            false => (TextLogLevel::WARN, self.palette.reaction),
        };
        self.add(end, verdict.sentence(), level, rgba);
        self.events.sort_by_key(|event| event.at.step);
        let mut clock = Clock::default();
        self.events.iter().for_each(|event| clock.push(event.at));
        let log = TextLog::update_fields()
            .with_many_text(self.events.iter().map(|event| format!("{}{}", self.prefix, event.text)))
            .with_many_level(self.events.iter().map(|event| event.level))
            .with_many_color(self.events.iter().map(|event| colour(event.rgba)));
        store.columns(&clock.columns(), &under(root, "events"), log.columns_of_unit_batches()?)
    }
}
