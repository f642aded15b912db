//! Events of a run, in words: edits by the user, payload, limits, base, target. The time line of the window and a
//! recording show the same events.

use std::mem::discriminant;
use std::sync::Arc;

use super::edit::{Edit, TimedEdit};
use super::machines::Machines;
use super::verdict::LIMIT_TOLERANCE;
use crate::scenario::{Bookmark, Note};
use stillbase_mechanics::machine::Machine;
use stillbase_query::{IncrementalQuery, Shared};
use stillbase_settings::number::{ShortNumber, significant};
use stillbase_simulation::frame::{Frame, Phase, Reach};

/// Kind of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// The user has changed something.
    Edit,
    /// The user has set a bookmark.
    Bookmark,
    /// The user has written a note.
    Written,
    /// A change of the motion or of the payload, or the end of a warning.
    Note,
    /// The target comes within reach.
    Within,
    /// The target goes out of reach.
    Beyond,
    /// A quantity reaches its limit, or reactions begin to reach the base.
    Warning,
    /// |n_B| has its peak.
    Peak,
    /// An audit fails.
    Fault,
}

/// What keeps the machine from what is asked of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hindrance {
    /// The target lies where the machine cannot go.
    Target,
    /// The reaction wheel is saturated.
    Wheel,
    /// A motor is at its torque limit.
    Torque,
}

impl Hindrance {
    /// All hindrances.
    pub const ALL: [Self; 3] = [Self::Target, Self::Wheel, Self::Torque];

    /// Returns what is refused, in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Target => "target out of reach",
            Self::Wheel => "reaction wheel saturated",
            Self::Torque => "drive at its torque limit",
        }
    }
}

/// One event.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Steps since the start.
    pub step: u64,
    /// Description.
    pub words: String,
    /// Kind.
    pub kind: EventKind,
}

/// Maximum time between successive edits of one gesture, s; a drag sends one edit for each picture.
pub(super) const GESTURE_PAUSE: f64 = 0.25;

/// Minimum time without reactions before an event reports their end, s. A moment that changes sign is zero
/// only for an instant.
const MIN_QUIET_S: f64 = 0.05;

/// A motor counts as at its torque limit from this fraction of the limit on, until its torque is below
/// [`AT_LIMIT_UNTIL`] (hysteresis).
const AT_LIMIT_FROM: f64 = 0.999;
/// See [`AT_LIMIT_FROM`].
const AT_LIMIT_UNTIL: f64 = 0.98;

/// Returns the gestures of the user, each as one event at its first step. `step` is the step size, s.
pub fn gestures(edits: &[TimedEdit], step: f64) -> Vec<Event> {
    let mut order: Vec<&TimedEdit> = edits.iter().collect();
    order.sort_by_key(|timed| timed.step);
    grouped(order, step).events().collect()
}

/// Returns the first gesture of edits in the order of steps.
pub(super) fn first_gesture(edits: &[&TimedEdit], step: f64) -> Option<Event> {
    grouped(edits.iter().copied(), step).events().next()
}

/// Returns the last gesture of edits in the order of steps.
pub(super) fn last_gesture(edits: &[&TimedEdit], step: f64) -> Option<Event> {
    grouped(edits.iter().copied(), step).events().next_back()
}

fn grouped<'a>(edits: impl IntoIterator<Item = &'a TimedEdit>, step: f64) -> Gestures {
    let mut all = Gestures::begin(&step);
    edits.into_iter().for_each(|timed| all.see(timed));
    all
}

/// Gestures of edits that come in the order of steps.
#[derive(Clone, Debug)]
pub struct Gestures {
    /// Step size, s.
    step: f64,
    all: Vec<Gesture>,
    /// The last gesture without its newest edit, if that edit continues an earlier one.
    before: Option<Gesture>,
}

impl Gestures {
    /// Returns the gestures as events, in order.
    pub fn events(&self) -> impl DoubleEndedIterator<Item = Event> {
        self.all.iter().map(|gesture| gesture.event(self.step))
    }

    fn see(&mut self, timed: &TimedEdit) {
        let count = self.count() + 1;
        self.before = self.all.pop_if(|last| last.goes_on(timed, self.step));
        self.all.push(match &self.before {
            Some(last) => Gesture { last: timed.clone(), push: last.push.max(force(&timed.edit)), count, ..*last },
            None => Gesture { first: timed.step, last: timed.clone(), push: force(&timed.edit), count },
        });
    }
}

impl IncrementalQuery for Gestures {
    type Item = TimedEdit;
    /// Step size, s.
    type Input = f64;

    fn begin(step: &f64) -> Self {
        Self { step: *step, all: Vec::new(), before: None }
    }

    fn count(&self) -> usize {
        self.all.last().map_or(0, |last| last.count)
    }

    fn take(&mut self, edits: &[TimedEdit]) {
        edits.iter().for_each(|timed| self.see(timed));
    }

    fn truncate(&mut self, count: usize) {
        while self.all.pop_if(|last| last.count > count).is_some() {
            self.all.extend(self.before.take());
        }
    }
}

/// Edits that form one gesture: a push until its force is zero, a drag until the pointer rests.
#[derive(Clone, Debug)]
struct Gesture {
    first: u64,
    last: TimedEdit,
    /// Largest force, N.
    push: f64,
    /// Number of edits up to the last one of this gesture.
    count: usize,
}

fn force(edit: &Edit) -> f64 {
    match edit {
        Edit::Push { x, y } => x.hypot(*y),
        _ => 0.0,
    }
}

impl Gesture {
    fn goes_on(&self, next: &TimedEdit, step: f64) -> bool {
        let last = &self.last.edit;
        // A push lasts until its force is zero, however long the pointer rests.
        let goes_on = match &next.edit {
            Edit::Push { .. } => force(&next.edit) > 0.0 && force(last) > 0.0,
            _ => (next.step - self.last.step) as f64 * step <= GESTURE_PAUSE + 1e-9,
        };
        goes_on && last.is_replaced_by(&next.edit)
    }

    fn event(&self, step: f64) -> Event {
        let TimedEdit { step: last, edit } = &self.last;
        let words = match edit {
            Edit::Push { .. } if *last > self.first => format!("push with up to {:.2} N", self.push),
            edit => edit.title(),
        };
        let words = match *last - self.first {
            0 => words,
            steps => format!("{words}, within {:.3} s", steps as f64 * step),
        };
        Event { step: self.first, words, kind: EventKind::Edit }
    }
}

/// Returns bookmarks as events. `step` is the step size, s.
pub fn bookmarked(bookmarks: &[Bookmark], step: f64) -> Vec<Event> {
    let event = |mark: &Bookmark| Event {
        step: (mark.time / step).round() as u64,
        words: format!("bookmark: {}", mark.name),
        kind: EventKind::Bookmark,
    };
    bookmarks.iter().map(event).collect()
}

/// Returns notes as events; a note for all times is at the start of the run. `step` is the step size, s.
pub fn noted(notes: &[Note], step: f64) -> Vec<Event> {
    let event = |note: &Note| Event {
        step: (note.time.start().unwrap_or_default() / step).round() as u64,
        words: format!("note: {}", note.in_one_line()),
        kind: EventKind::Written,
    };
    notes.iter().map(event).collect()
}

/// Events found in frames, which are read in order, one for each step from the start on.
#[derive(Clone, Debug)]
pub struct EventLog {
    /// Step size, s.
    step: f64,
    machines: Machines,
    events: Arc<Vec<Event>>,
    now: Seen,
    /// State before the newest frame; an edit may replace that frame.
    before: Seen,
}

/// State after the frames so far.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    frames: usize,
    events: usize,
    phase: Option<Phase>,
    reach: Option<Reach>,
    held: Option<bool>,
    saturated: bool,
    faulty: bool,
    past: bool,
    /// Motors at their limits, one bit for each.
    limited: u32,
    /// Whether reactions have reached the base: at any time, and since the last quiet period.
    felt: [bool; 2],
    /// Step since which no reaction has reached the base.
    quiet: Option<u64>,
    /// Step at which |n_B| was largest, and its value there, N m.
    peak: (u64, f64),
}

impl IncrementalQuery for EventLog {
    type Item = Frame;
    /// Step size, s, and the machine at each step.
    type Input = (f64, Machines);

    fn begin((step, machines): &Self::Input) -> Self {
        let (now, before) = (Seen::default(), Seen::default());
        Self { step: *step, machines: machines.clone(), events: Arc::default(), now, before }
    }

    fn count(&self) -> usize {
        self.now.frames
    }

    fn take(&mut self, frames: &[Frame]) {
        let machines = self.machines.clone();
        for frame in frames {
            self.note(frame, machines.at(frame.step));
        }
    }

    fn truncate(&mut self, count: usize) {
        if count < self.now.frames {
            self.now = if self.before.frames <= count { self.before } else { Seen::default() };
            Arc::make_mut(&mut self.events).truncate(self.now.events);
        }
    }

    fn set_input(&mut self, input: &Self::Input) {
        let (step, machines) = input;
        if self.step != *step {
            *self = Self::begin(input);
            return;
        }
        // Each step has one frame.
        self.truncate(usize::try_from(self.machines.differ_from(machines)).unwrap_or(usize::MAX));
        self.machines = machines.clone();
    }
}

impl EventLog {
    /// Returns the events that are not edits of the user.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Returns the same events as a shared value.
    pub fn shared_events(&self) -> Shared<Vec<Event>> {
        Shared(self.events.clone())
    }

    /// Returns what keeps the machine from what is asked of it at the last frame.
    pub fn hindrance(&self) -> Option<Hindrance> {
        let Seen { reach, saturated, limited, .. } = self.now;
        let is_beyond = reach.is_some_and(|reach| reach.waits_at().is_some());
        Hindrance::ALL
            .into_iter()
            .zip([is_beyond, saturated, limited != 0])
            .find_map(|(what, holds)| holds.then_some(what))
    }

    /// Returns the event of the largest |n_B|.
    pub fn peak(&self) -> Event {
        let (step, moment) = self.now.peak;
        Event { step, words: format!("peak |n_B| {} N m", significant(moment)), kind: EventKind::Peak }
    }

    /// Reads one more frame of a run whose frames are not kept, with the step size, s, and the machine at that step.
    pub fn see(&mut self, frame: &Frame, (step, machine): (f64, &Machine)) {
        self.step = step;
        self.machines.set_from(frame.step, machine);
        self.note(frame, Some(machine));
    }

    fn note(&mut self, frame: &Frame, machine: Option<&Machine>) {
        self.before = self.now;
        let step = frame.step;
        if frame.peaks.arm_moment > self.now.peak.1 {
            self.now.peak = (step, frame.peaks.arm_moment);
        }
        match (self.now.phase.replace(frame.phase), frame.phase) {
            (Some(Phase::Motion), Phase::Rest) => self.add(step, EventKind::Note, "end of motion"),
            (Some(Phase::Follow), Phase::Rest) => self.add(step, EventKind::Note, "at rest"),
            _ => {}
        }
        self.carried(frame);
        if let Some(machine) = machine {
            self.limits(frame, machine);
        }
        self.base(frame, self.step);
        self.target(frame);
        self.now.frames += 1;
        self.now.events = self.events.len();
    }

    fn add(&mut self, step: u64, kind: EventKind, words: impl Into<String>) {
        Arc::make_mut(&mut self.events).push(Event { step, words: words.into(), kind });
    }

    /// Adds events of payload and wheel, and the first failure of an audit.
    fn carried(&mut self, frame: &Frame) {
        let step = frame.step;
        match (self.now.held.replace(frame.loaded), frame.loaded) {
            (Some(false), true) => self.add(step, EventKind::Note, "the payload is picked up"),
            (None, true) => self.add(step, EventKind::Note, "the payload is held"),
            (Some(true), false) => self.add(step, EventKind::Note, "the payload is let go"),
            _ => {}
        }
        match (std::mem::replace(&mut self.now.saturated, frame.wheel.saturated), frame.wheel.saturated) {
            (false, true) => {
                let text = format!("the reaction wheel saturates at {} rad/s", significant(frame.wheel.rate));
                self.add(step, EventKind::Warning, text);
            }
            (true, false) => self.add(step, EventKind::Note, "the reaction wheel is no longer saturated"),
            _ => {}
        }
        if let Some(fault) = (!self.now.faulty).then(|| frame.first_violation()).flatten() {
            self.now.faulty = true;
            let text = format!("audit failed: {} ({}) {:.1e} {}", fault.name, fault.meaning, fault.value, fault.unit);
            self.add(step, EventKind::Fault, text);
        }
    }

    /// Adds events of motors that reach their torque limits, and of the first joint that passes its limit.
    fn limits(&mut self, frame: &Frame, machine: &Machine) {
        let drives = &machine.spec().drives;
        for (k, (torque, drive)) in frame.torque.iter().zip(drives).enumerate() {
            let (Some(limit), bit) = (drive.torque_limit, 1 << k) else { continue };
            let share = torque.abs() / limit;
            if share >= AT_LIMIT_FROM && self.now.limited & bit == 0 {
                self.now.limited |= bit;
                let text = format!("drive {} comes to its torque limit, {} N m", k + 1, ShortNumber(limit));
                self.add(frame.step, EventKind::Warning, text);
            } else if share < AT_LIMIT_UNTIL {
                self.now.limited &= !bit;
            }
        }
        let (by, angle) = frame.peaks.past_limit;
        if by > LIMIT_TOLERANCE && !self.now.past {
            self.now.past = true;
            let angle = machine.angles().get(angle).map_or("a joint", |angle| &angle.name);
            self.add(frame.step, EventKind::Warning, format!("{angle} passes its limit"));
        }
    }

    /// Adds events when reactions begin or cease to reach the base. `dt` is the step size, s.
    fn base(&mut self, frame: &Frame, dt: f64) {
        let [ever, of_late] = self.now.felt;
        // A force shifts a base that floats, whatever the arm does; only a moment is news.
        let (is_quiet, what) = match frame.floats {
            true => (frame.turns_no_base() || frame.peaks.turns_no_base(), "a turning moment"),
            false => (frame.is_base_unloaded() || frame.peaks.is_base_unloaded(), "the arm"),
        };
        if !is_quiet {
            self.now.quiet = None;
            self.now.felt = [true, true];
            match (ever, of_late) {
                (false, _) => self.add(frame.step, EventKind::Warning, format!("the base begins to feel {what}")),
                (true, false) => self.add(frame.step, EventKind::Warning, format!("the base feels {what} again")),
                (true, true) => {}
            }
        } else if of_late {
            let since = *self.now.quiet.get_or_insert(frame.step);
            if (frame.step - since) as f64 * dt >= MIN_QUIET_S {
                self.now.felt[1] = false;
                let nothing = if frame.floats { "no turning moment any more" } else { "nothing again" };
                self.add(since, EventKind::Note, format!("the base feels {nothing}"));
            }
        }
    }

    fn target(&mut self, frame: &Frame) {
        let reach = frame.target.reach;
        let before = self.now.reach.replace(reach);
        if before.is_none_or(|before| discriminant(&before) == discriminant(&reach)) {
            return;
        }
        let (text, kind) = match reach {
            Reach::Inside if matches!(before, Some(Reach::Stopped { .. })) => {
                ("the end effector moves on".into(), EventKind::Within)
            }
            Reach::Inside => ("the target is inside the reactionless workspace".into(), EventKind::Within),
            Reach::Stopped { why, .. } => {
                (format!("the end effector stops before its target: {why}"), EventKind::Beyond)
            }
            Reach::Carried => ("the target turns with the workspace".into(), EventKind::Within),
            Reach::Outside { displayed_b, .. } => {
                let held = if frame.floats { ", were the base held" } else { "" };
                let mend =
                    displayed_b.map_or("no b reaches it".into(), |b| format!("b = {b} rad would reach it{held}"));
                (format!("the target is outside the reactionless workspace: {mend}"), EventKind::Beyond)
            }
        };
        self.add(frame.step, kind, text);
    }
}
