//! [`Tour`]: the thought of the paper in seven steps on the live scene, each passed by doing.

pub mod card;

use super::Command;
use crate::session::{Edit, Session};
use crate::simulation::frame::Reach;

/// Where it stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tour {
    step: usize,
    /// b when the step began, rad.
    b: f64,
    /// The step has been done, now or before.
    done: bool,
}

/// What a step says, what it asks for, and how the session shows that it was done.
struct Step {
    title: &'static str,
    words: &'static str,
    asks: &'static str,
    /// What does it, or most of it, at one press.
    shows: Option<Shows>,
    done: fn(&Session, b: f64) -> bool,
}

/// The words of a button, and what it does.
type Shows = (&'static str, fn() -> Vec<Command>);

/// A moment that is felt, N m, and one that is none.
const FELT: f64 = 0.05;
const NONE: f64 = 1e-6;

fn has_run(session: &Session) -> bool {
    session.is_at_end() && session.frame().time >= 0.99 * session.length() && session.frame().time > 0.0
}

fn payload(mass: f64) -> Vec<Command> {
    vec![Command::Edit(Edit::set("plant.payload.mass", mass)), Command::EndGesture]
}

const STEPS: [Step; 7] = [
    Step {
        title: "An arm shakes what it stands on",
        words: "To speed up its links it pushes against its base, and twists it. Here it takes its end effector from A to \
                B along a straight line: the red arc is the moment on the base, n_B.",
        asks: "Run the straight line to its end.",
        shows: Some(("Show me", || vec![Command::Case("case-1")])),
        done: |session, _| has_run(session) && session.frame().peaks.moment > FELT,
    },
    Step {
        title: "Balance takes the force away",
        words: "Counterweights keep the centre of mass in B, the cross, in every pose. What does not move needs no force: \
                f_B = 0. Hang something on the end effector, and the force is there. (Eq. 7)",
        asks: "Let it hold 0.3 kg, and run it.",
        shows: Some(("Hang 0.3 kg on it", || {
            [vec![Command::Seek(0.0)], payload(0.3), vec![Command::TogglePlay]].concat()
        })),
        done: |session, _| has_run(session) && session.frame().peaks.force > FELT,
    },
    Step {
        title: "Balance makes the mass matrix constant",
        words: "Without the load nothing in the equations of motion depends on the pose: the moment on the base is a sum \
                of the drives' accelerations with constant weights, n_B = −(D₁ q̈₁ + D₂ q̈₂ + D₃ q̈₃). (Eqs. 6, 8)",
        asks: "Take the load off again.",
        shows: Some(("Take it off", || payload(0.0))),
        done: |session, _| session.scenario().plant.payload.mass == 0.0,
    },
    Step {
        title: "On a plane the drives cancel out",
        words: "So the drives only have to move together: as long as q₁ + λ₂ q₂ + λ₃ q₃ keeps one value, the pose constant \
                b, the sum is zero. That is a plane in the space of the three angles. (Eq. 13)",
        asks: "Run the same task on its plane.",
        shows: Some(("Show me", || vec![Command::Case("case-3")])),
        done: |session, _| has_run(session) && session.frame().peaks.moment < NONE,
    },
    Step {
        title: "The reactionless workspace",
        words: "A plane leaves two free angles: enough to go anywhere inside the amber area. Every path in it is free of \
                reactions, whichever way it goes. (Eqs. 15, 16)",
        asks: "Drag the white ring about inside the amber area.",
        shows: None,
        done: |session, _| {
            session.is_led() && session.frame().target.reach == Reach::Inside && session.frame().peaks.moment < NONE
        },
    },
    Step {
        title: "b only turns it",
        words: "Another plane, another b: the area is the same, turned about the base. What one b leaves out another \
                one reaches. (Eq. 16)",
        asks: "Turn b by 0.2 rad: slider on the left, keys [ and ], or the amber ring at the base.",
        shows: None,
        done: |session, b| (session.b_aim() - b).abs() >= 0.2,
    },
    Step {
        title: "What it costs to change planes",
        words: "To go from one plane to another the arm must turn as a whole, and the base feels it: the faster, the more. \
                n_B = −D₁ b̈.",
        asks: "Turn b while time runs.",
        shows: Some(("Start time", || vec![Command::Case("case-3")])),
        done: |session, b| {
            session.is_led() && session.frame().peaks.moment > FELT && (session.b_aim() - b).abs() > 0.05
        },
    },
];

impl Tour {
    /// From its first step.
    pub fn begin(session: &Session) -> Self {
        Self::at(0, session)
    }

    fn at(step: usize, session: &Session) -> Self {
        Self { step, b: session.b_aim(), done: false }
    }

    /// Another step; none after the last.
    pub fn turned(self, forward: bool, session: &Session) -> Option<Self> {
        let step = if forward { self.step + 1 } else { self.step.saturating_sub(1) };
        (step < STEPS.len()).then(|| Self::at(step, session))
    }

    /// Looks whether the step has been done.
    pub fn follow(&mut self, session: &Session) {
        self.done |= (STEPS[self.step].done)(session, self.b);
    }
}
