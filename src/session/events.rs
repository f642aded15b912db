//! What happens in a run, in words: changes by hand, the payload, limits, the base, the target. The time line of the
//! window and a recording tell the same.

use std::mem::discriminant;
use std::sync::Arc;

use super::edit::{Edit, TimedEdit};
use super::machines::Machines;
use super::verdict::PAST;
use crate::mechanics::machine::Machine;
use crate::query::{Growing, Shared};
use crate::session::scenario::Bookmark;
use crate::settings::number::{Short, significant};
use crate::simulation::frame::{Frame, Phase, Reach};

/// What an event is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A hand has changed something.
    Edit,
    /// A hand wants to find this instant again.
    Bookmark,
    /// The motion, the payload, or what becomes good again.
    Note,
    /// The target comes within reach.
    Within,
    /// It goes out of reach.
    Beyond,
    /// Something is at its limit, or the base begins to feel the arm.
    Warning,
    /// The base feels most.
    Peak,
    /// An audit fails.
    Fault,
}

/// One event.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Steps since the start.
    pub step: u64,
    /// What happens.
    pub words: String,
    /// What it is about.
    pub kind: Kind,
}

/// Changes go on as one gesture while they come so close, s: a screen brings one a frame.
pub(super) const GESTURE: f64 = 0.25;

/// The base has to feel nothing for so long, s, before it is said that it does: a moment also passes zero.
const QUIET: f64 = 0.05;

/// A motor is at its limit from this share of it on, and away from it below the other.
const AT_LIMIT: [f64; 2] = [0.999, 0.98];

/// What hands have done, each gesture as one event, at its beginning; steps last so long, s.
pub fn gestures(edits: &[TimedEdit], step: f64) -> Vec<Event> {
    let mut order: Vec<&TimedEdit> = edits.iter().collect();
    order.sort_by_key(|timed| timed.step);
    grouped(order, step).told().collect()
}

/// The first of them, of edits in the order of steps.
pub(super) fn first_gesture(edits: &[&TimedEdit], step: f64) -> Option<Event> {
    grouped(edits.iter().copied(), step).told().next()
}

/// The last of them.
pub(super) fn last_gesture(edits: &[&TimedEdit], step: f64) -> Option<Event> {
    grouped(edits.iter().copied(), step).told().next_back()
}

fn grouped<'a>(edits: impl IntoIterator<Item = &'a TimedEdit>, step: f64) -> Gestures {
    let mut all = Gestures::begin(&step);
    edits.into_iter().for_each(|timed| all.see(timed));
    all
}

/// The gestures of edits that come in the order of steps.
#[derive(Clone, Debug)]
pub struct Gestures {
    /// How long a step lasts, s.
    step: f64,
    all: Vec<Gesture>,
    /// The last of them before the newest edit, if that goes on with it.
    before: Option<Gesture>,
}

impl Gestures {
    /// What they are, one after the other.
    pub fn told(&self) -> impl DoubleEndedIterator<Item = Event> {
        self.all.iter().map(|gesture| gesture.told(self.step))
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

impl Growing for Gestures {
    type Item = TimedEdit;
    /// How long a step lasts, s.
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

    fn cut(&mut self, count: usize) {
        while self.all.pop_if(|last| last.count > count).is_some() {
            self.all.extend(self.before.take());
        }
    }
}

/// Edits that are one: a push until it is let go, a drag until the pointer rests.
#[derive(Clone, Debug)]
struct Gesture {
    first: u64,
    last: TimedEdit,
    /// The largest push, N.
    push: f64,
    /// Edits up to its last.
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
        // A push lasts until it is let go, however still the hand is.
        let goes_on = match &next.edit {
            Edit::Push { .. } => force(&next.edit) > 0.0 && force(last) > 0.0,
            _ => (next.step - self.last.step) as f64 * step <= GESTURE + 1e-9,
        };
        goes_on && last.is_replaced_by(&next.edit)
    }

    fn told(&self, step: f64) -> Event {
        let TimedEdit { step: last, edit } = &self.last;
        let words = match edit {
            Edit::Push { .. } if *last > self.first => format!("push with up to {:.2} N", self.push),
            edit => edit.title(),
        };
        let words = match *last - self.first {
            0 => words,
            steps => format!("{words}, within {:.3} s", steps as f64 * step),
        };
        Event { step: self.first, words, kind: Kind::Edit }
    }
}

/// Bookmarks as events.
pub fn bookmarked(bookmarks: &[Bookmark], step: f64) -> Vec<Event> {
    let event = |mark: &Bookmark| Event {
        step: (mark.time / step).round() as u64,
        words: format!("bookmark: {}", mark.name),
        kind: Kind::Bookmark,
    };
    bookmarks.iter().map(event).collect()
}

/// What frames tell, read one after the other, one a step from the start on.
#[derive(Clone, Debug)]
pub struct Watched {
    /// How long a step lasts, s.
    step: f64,
    machines: Machines,
    events: Arc<Vec<Event>>,
    now: Seen,
    /// Before the newest frame, which an edit may change.
    before: Seen,
}

/// What is known of the frames so far.
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
    /// Whether the base has felt something, ever and of late; and since when it has not.
    felt: [bool; 2],
    quiet: Option<u64>,
    /// When the arm exerted most on the base, and how much, N m.
    peak: (u64, f64),
}

impl Growing for Watched {
    type Item = Frame;
    /// How long a step lasts, s, and which machine there was when.
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

    fn cut(&mut self, count: usize) {
        if count < self.now.frames {
            self.now = if self.before.frames <= count { self.before } else { Seen::default() };
            Arc::make_mut(&mut self.events).truncate(self.now.events);
        }
    }

    fn turn_to(&mut self, input: &Self::Input) {
        let (step, machines) = input;
        if self.step != *step {
            *self = Self::begin(input);
            return;
        }
        // There is a frame a step.
        self.cut(usize::try_from(self.machines.differ_from(machines)).unwrap_or(usize::MAX));
        self.machines = machines.clone();
    }
}

impl Watched {
    /// What has happened, apart from what hands did.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// The same, to be kept.
    pub fn shared_events(&self) -> Shared<Vec<Event>> {
        Shared(self.events.clone())
    }

    /// When the arm exerted most on its base.
    pub fn peak(&self) -> Event {
        let (step, moment) = self.now.peak;
        Event { step, words: format!("peak |n_B| {} N m", significant(moment)), kind: Kind::Peak }
    }

    /// Takes one more instant of a run whose frames are not kept. Steps last so long, s, and it has this machine by then.
    pub fn see(&mut self, frame: &Frame, (step, machine): (f64, &Machine)) {
        self.step = step;
        self.machines.hold(frame.step, machine);
        self.note(frame, Some(machine));
    }

    fn note(&mut self, frame: &Frame, machine: Option<&Machine>) {
        self.before = self.now;
        let step = frame.step;
        if frame.peaks.arm_moment > self.now.peak.1 {
            self.now.peak = (step, frame.peaks.arm_moment);
        }
        match (self.now.phase.replace(frame.phase), frame.phase) {
            (Some(Phase::Motion), Phase::Rest) => self.add(step, Kind::Note, "end of motion"),
            (Some(Phase::Follow), Phase::Rest) => self.add(step, Kind::Note, "at rest"),
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

    fn add(&mut self, step: u64, kind: Kind, words: impl Into<String>) {
        Arc::make_mut(&mut self.events).push(Event { step, words: words.into(), kind });
    }

    /// What becomes of payload and wheel, and the first time that an audit fails.
    fn carried(&mut self, frame: &Frame) {
        let step = frame.step;
        match (self.now.held.replace(frame.loaded), frame.loaded) {
            (Some(false), true) => self.add(step, Kind::Note, "the payload is picked up"),
            (None, true) => self.add(step, Kind::Note, "the payload is held"),
            (Some(true), false) => self.add(step, Kind::Note, "the payload is let go"),
            _ => {}
        }
        match (std::mem::replace(&mut self.now.saturated, frame.wheel.saturated), frame.wheel.saturated) {
            (false, true) => {
                let text = format!("the reaction wheel saturates at {} rad/s", significant(frame.wheel.rate));
                self.add(step, Kind::Warning, text);
            }
            (true, false) => self.add(step, Kind::Note, "the reaction wheel gives what is wanted again"),
            _ => {}
        }
        if let Some(fault) = (!self.now.faulty).then(|| frame.fault()).flatten() {
            self.now.faulty = true;
            let text = format!("audit failed: {} ({}) {:.1e} {}", fault.name, fault.meaning, fault.value, fault.unit);
            self.add(step, Kind::Fault, text);
        }
    }

    /// Motors that come to their limits, and the first joint that passes its own.
    fn limits(&mut self, frame: &Frame, machine: &Machine) {
        let drives = &machine.spec().drives;
        for (k, (torque, drive)) in frame.torque.iter().zip(drives).enumerate() {
            let (Some(limit), bit) = (drive.torque_limit, 1 << k) else { continue };
            let share = torque.abs() / limit;
            if share >= AT_LIMIT[0] && self.now.limited & bit == 0 {
                self.now.limited |= bit;
                let text = format!("drive {} comes to its torque limit, {} N m", k + 1, Short(limit));
                self.add(frame.step, Kind::Warning, text);
            } else if share < AT_LIMIT[1] {
                self.now.limited &= !bit;
            }
        }
        let (by, angle) = frame.peaks.past_limit;
        if by > PAST && !self.now.past {
            self.now.past = true;
            let angle = machine.angles().get(angle).map_or("a joint", |angle| &angle.name);
            self.add(frame.step, Kind::Warning, format!("{angle} passes its limit"));
        }
    }

    /// When the base begins to feel the arm, and when it feels nothing again.
    fn base(&mut self, frame: &Frame, dt: f64) {
        let [ever, of_late] = self.now.felt;
        if !frame.base_feels_nothing() && !frame.peaks.base_feels_nothing() {
            self.now.quiet = None;
            self.now.felt = [true, true];
            match (ever, of_late) {
                (false, _) => self.add(frame.step, Kind::Warning, "the base begins to feel the arm"),
                (true, false) => self.add(frame.step, Kind::Warning, "the base feels the arm again"),
                (true, true) => {}
            }
        } else if of_late {
            let since = *self.now.quiet.get_or_insert(frame.step);
            if (frame.step - since) as f64 * dt >= QUIET {
                self.now.felt[1] = false;
                self.add(since, Kind::Note, "the base feels nothing again");
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
            Reach::Inside => ("the target is inside the reactionless workspace".into(), Kind::Within),
            Reach::Carried => ("the target turns with the workspace".into(), Kind::Within),
            Reach::Outside { shown_b, .. } => {
                let mend = shown_b.map_or("no b reaches it".into(), |b| format!("b = {b} rad would reach it"));
                (format!("the target is outside the reactionless workspace: {mend}"), Kind::Beyond)
            }
        };
        self.add(frame.step, kind, text);
    }
}
