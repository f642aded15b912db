//! [`Tour`]: the thought of the paper in seven steps on the live scene, each passed by doing.

pub mod card;

use super::{Command, SessionCommand};
use crate::mechanics::planar::Vector;
use crate::session::scenario::{Scenario, TaskKind};
use crate::session::verdict::Verdict;
use crate::session::{Edit, Session, TimedEdit};
use crate::simulation::frame::Reach;

/// Where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Tour {
    step: usize,
    seen: Seen,
    /// The step has been done, now or before.
    done: bool,
}

/// What has been seen of the session since a step began: a step is done by what happens in it, not by how things stand.
#[derive(Clone, Debug, PartialEq)]
struct Seen {
    /// The instant that was looked at last, s.
    last: f64,
    /// The run has been played from its start, without a jump.
    plays: bool,
    /// It has been played to its end.
    ran: bool,
    /// Something hung on the end effector.
    held: bool,
    /// How many edits there were at first, or in another session since.
    edits: usize,
    /// Where b stood before it was turned, rad.
    b: f64,
    /// Where the end effector was before it was dragged, m.
    tip: Vector,
}

impl Seen {
    fn nothing(session: &Session) -> Self {
        Self {
            last: session.frame().time,
            plays: session.frame().step == 0,
            ran: false,
            held: session.scenario().plant.payload.mass > 0.0,
            edits: session.script().len(),
            b: session.b_aim(),
            tip: session.frame().end_effector,
        }
    }

    fn look(&mut self, session: &Session) {
        let (now, last) = (session.frame().time, std::mem::replace(&mut self.last, session.frame().time));
        // To show another instant pauses: while it plays, time runs on, or has begun anew.
        let goes_on = self.plays && (0.0..=MAX_PLAYED_S).contains(&(now - last));
        let begins = now < last && now <= MAX_PLAYED_S;
        self.plays = now == 0.0 || (session.is_playing() && (goes_on || begins)) || (self.plays && now == last);
        self.ran = self.plays && session.is_at_end() && now > 0.0 && now >= 0.99 * session.length();
        self.held |= session.scenario().plant.payload.mass > 0.0;
        // Another session, or one that was taken back.
        self.edits = self.edits.min(session.script().len());
        if self.newest(session).next().is_none() {
            (self.b, self.tip) = (session.b_aim(), session.frame().end_effector);
        }
    }

    /// What was done to the session since, the newest first.
    fn newest<'a>(&self, session: &'a Session) -> impl Iterator<Item = &'a TimedEdit> {
        session.script().iter().rev().take(session.script().len().saturating_sub(self.edits))
    }

    /// The largest |n_B| since an edit, N m.
    fn moment(session: &Session, since: &TimedEdit) -> f64 {
        let newest = session.frames().iter().rev().take_while(|frame| frame.step > since.step);
        newest.take(MAX_LOOKS).map(|frame| frame.base_moment().abs()).fold(0.0, f64::max)
    }
}

/// More than one repaint plays, s; what goes farther is a jump.
const MAX_PLAYED_S: f64 = 0.25;

/// How many instants are looked at for what the base felt.
const MAX_LOOKS: usize = 4_000;

/// What a step says, what it asks for, and how the session shows that it was done.
struct Step {
    title: &'static str,
    words: &'static str,
    asks: &'static str,
    /// What does it, or most of it, at one press.
    shows: fn(&Session) -> Option<Shows>,
    done: fn(&Session, &Seen) -> bool,
}

/// The words of a button, and what it does.
type Shows = (&'static str, Vec<Command>);

/// A moment that is felt, N m, and one that is none.
const FELT: f64 = 0.05;
const NONE: f64 = 1e-6;

/// What is hung on the end effector, kg.
const LOAD: f64 = 0.3;

/// How far the ring is dragged, m, and how far b is turned, rad: paused, and while time runs.
const DRAGGED: f64 = 0.02;
const TURNED: [f64; 2] = [0.2, 0.05];

fn payload(mass: f64) -> Vec<Command> {
    vec![
        Command::Session(SessionCommand::Edit(Edit::set("plant.payload.mass", mass))),
        Command::Session(SessionCommand::EndGesture),
    ]
}

/// One of the paper's cases, with the paper's machine.
fn case(name: &str) -> Vec<Command> {
    Scenario::builtin(name).into_iter().map(|case| Command::Session(SessionCommand::Open(Box::new(case)))).collect()
}

/// The paper's machine, where the present one has no plane to drag on.
fn paper_machine(session: &Session) -> Option<Shows> {
    let has_planes = session.run().planes().is_some() && session.follows_hands();
    (!has_planes).then(|| ("Take the paper's machine", case("case-3")))
}

const STEPS: [Step; 7] = [
    Step {
        title: "An arm shakes what it stands on",
        words: "To speed up its links it pushes against its base, and twists it. Here it takes its end effector from A to \
                B along a straight line: the red arc is the moment on the base, n_B.",
        asks: "Run the straight line to its end.",
        shows: |_| Some(("Show me", case("case-1"))),
        done: |session, seen| {
            let straight = session.scenario().task.kind == TaskKind::MinimumNorm && !session.is_led();
            seen.ran && straight && session.frame().peaks.moment > FELT
        },
    },
    Step {
        title: "Balance takes the force away",
        words: "Counterweights keep the centre of mass in B, the cross, in every pose. What does not move needs no force: \
                f_B = 0. Hang something on the end effector, and the force is there. (Eq. 7)",
        asks: "Let it hold 0.3 kg, and run it.",
        shows: |_| {
            let commands = [
                vec![Command::Session(SessionCommand::Seek(0.0))],
                payload(LOAD),
                vec![Command::Session(SessionCommand::TogglePlay)],
            ]
            .concat();
            Some(("Hang 0.3 kg on it", commands))
        },
        done: |session, seen| {
            let loaded = session.scenario().plant.payload.mass >= LOAD - 1e-9;
            seen.ran && loaded && session.frame().peaks.force > FELT
        },
    },
    Step {
        title: "Balance makes the mass matrix constant",
        words: "Without the load nothing in the equations of motion depends on the pose: the moment on the base is a sum \
                of the drives' accelerations with constant weights, n_B = −(D₁ q̈₁ + D₂ q̈₂ + D₃ q̈₃). (Eqs. 6, 8)",
        asks: "Take the load off again.",
        shows: |session| match session.scenario().plant.payload.mass > 0.0 {
            true => Some(("Take it off", payload(0.0))),
            false => Some(("Hang 0.3 kg on it", payload(LOAD))),
        },
        done: |session, seen| seen.held && session.scenario().plant.payload.mass == 0.0,
    },
    Step {
        title: "On a plane the drives cancel out",
        words: "So the drives only have to move together: as long as q₁ + λ₂ q₂ + λ₃ q₃ keeps one value, the pose constant \
                b, the sum is zero. That is a plane in the space of the three angles. (Eq. 13)",
        asks: "Run the same task on its plane.",
        shows: |_| Some(("Show me", case("case-3"))),
        done: |session, seen| {
            let verdict = Verdict::of(session.scenario(), session.frame());
            seen.ran && verdict.moved && verdict.arm_moment < NONE && !session.is_led()
        },
    },
    Step {
        title: "The reactionless workspace",
        words: "A plane leaves two free angles: enough to go anywhere inside the amber area. Every path in it is free of \
                reactions, whichever way it goes. (Eqs. 15, 16)",
        asks: "Drag the white ring about inside the amber area.",
        shows: paper_machine,
        done: |session, seen| {
            let dragged = |e: &&TimedEdit| matches!(e.edit, Edit::DragTarget { .. });
            let moved = (session.frame().end_effector - seen.tip).norm() >= DRAGGED;
            session.frame().target.reach == Reach::Inside
                && moved
                && seen.newest(session).find(dragged).is_some_and(|e| Seen::moment(session, e) < NONE)
        },
    },
    Step {
        title: "b only turns it",
        words: "Another plane, another b: the area is the same, turned about the base. What one b leaves out another \
                one reaches. (Eq. 16)",
        asks: "Turn b by 0.2 rad: the amber ring at the base, the slider, or keys [ and ].",
        shows: paper_machine,
        done: |session, seen| {
            let turned = |e: &TimedEdit| matches!(e.edit, Edit::SlideB { .. } | Edit::PoseB { .. });
            (session.b_aim() - seen.b).abs() >= TURNED[0] && seen.newest(session).any(turned)
        },
    },
    Step {
        title: "What it costs to change planes",
        words: "To go from one plane to another the arm must turn as a whole, and the base feels it: the faster, the more. \
                n_B = −D₁ b̈.",
        asks: "Turn b while time runs.",
        shows: |_| Some(("Start time", case("case-3"))),
        done: |session, seen| {
            let slid = |e: &&TimedEdit| matches!(e.edit, Edit::SlideB { .. });
            (session.b_aim() - seen.b).abs() > TURNED[1]
                && seen.newest(session).find(slid).is_some_and(|e| Seen::moment(session, e) > FELT)
        },
    },
];

impl Tour {
    /// From its first step.
    pub fn begin(session: &Session) -> Self {
        Self::at(0, session)
    }

    fn at(step: usize, session: &Session) -> Self {
        Self { step, seen: Seen::nothing(session), done: false }
    }

    /// Another step; none after the last.
    pub fn turned(self, forward: bool, session: &Session) -> Option<Self> {
        let step = if forward { self.step + 1 } else { self.step.saturating_sub(1) };
        (step < STEPS.len()).then(|| Self::at(step, session))
    }

    /// Looks whether the step has been done.
    pub fn follow(&mut self, session: &Session) {
        self.seen.look(session);
        self.done |= (STEPS[self.step].done)(session, &self.seen);
    }
}
