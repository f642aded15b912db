//! [`Tour`]: the idea of the paper in seven steps, each with an exercise in a scene of its own.

pub mod card;

use super::pointing::Pointed;
use super::{Command, SessionCommand};
use stillbase_mechanics::planar::Vector;
use stillbase_session::scenario::{Scenario, TaskKind};
use stillbase_session::verdict::Verdict;
use stillbase_session::{Edit, Session, TimedEdit};
use stillbase_settings::number::subscript;
use stillbase_simulation::frame::Reach;

/// State of the tour.
#[derive(Clone, Debug, PartialEq)]
pub struct Tour {
    step: usize,
    seen: Seen,
    /// Whether the step has been done.
    done: bool,
    /// Why the tour shows another machine than the person's own, if it does.
    note: Option<String>,
}

/// Observations of the session since a step began: only an action during the step completes it, not the state at its
/// start.
#[derive(Clone, Debug, PartialEq)]
struct Seen {
    /// The time on display in the last pass, s.
    last: f64,
    /// Whether the run has been played from its start without a jump.
    plays: bool,
    /// Whether the run has been played to its end.
    ran: bool,
    /// Whether the end effector has held a payload.
    held: bool,
    /// Number of edits at the start of the step, or fewer after an undo or in another session.
    edits: usize,
    /// b before it was changed, rad.
    b: f64,
    /// Position of the end effector before it was dragged, m.
    tip: Vector,
}

impl Seen {
    fn start(session: &Session) -> Self {
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

    fn observe(&mut self, session: &Session) {
        let (now, last) = (session.frame().time, std::mem::replace(&mut self.last, session.frame().time));
        // Seeking pauses the run. While the run plays, time only advances or starts over.
        let goes_on = self.plays && (0.0..=MAX_PLAYED_S).contains(&(now - last));
        let begins = now < last && now <= MAX_PLAYED_S;
        self.plays = now == 0.0 || (session.is_playing() && (goes_on || begins)) || (self.plays && now == last);
        self.ran = self.plays && session.is_at_end() && now > 0.0 && now >= 0.99 * session.length();
        self.held |= session.scenario().plant.payload.mass > 0.0;
        // After an undo, or in another session, there may be fewer edits.
        self.edits = self.edits.min(session.script().len());
        if self.newest(session).next().is_none() {
            (self.b, self.tip) = (session.b_aim(), session.frame().end_effector);
        }
    }

    /// Returns the edits since the start of the step, the newest first.
    fn newest<'a>(&self, session: &'a Session) -> impl Iterator<Item = &'a TimedEdit> {
        session.script().iter().rev().take(session.script().len().saturating_sub(self.edits))
    }

    /// Returns the largest |n_B| since an edit, N m.
    fn moment(session: &Session, since: &TimedEdit) -> f64 {
        let newest = session.frames().iter().rev().take_while(|frame| frame.step > since.step);
        newest.take(MAX_FRAMES).map(|frame| frame.base_moment().abs()).fold(0.0, f64::max)
    }
}

/// Maximum time that one repaint plays, s; a larger change is a jump.
const MAX_PLAYED_S: f64 = 0.25;

/// Maximum number of frames that are searched for the base moment.
const MAX_FRAMES: usize = 4_000;

/// A step: its text, its exercise, and the test whether the exercise has been done.
struct Step {
    title: &'static str,
    /// Its text; what stands in braces depends on the machine.
    words: &'static str,
    exercise: &'static str,
    /// The paper's case in which it takes place, and the payload, kg.
    scene: (&'static str, f64),
    /// What it mentions.
    points_at: &'static [Pointed],
    /// A button that does the exercise, or most of it.
    button: fn(&Session) -> Option<StepButton>,
    done: fn(&Session, &Seen) -> bool,
}

/// Text and commands of a button.
type StepButton = (&'static str, Vec<Command>);

/// A moment, N m, or a force, N, above the first value disturbs the base; a moment below the second is treated as
/// zero.
const FELT_ABOVE: f64 = 0.05;
const ZERO_BELOW_N_M: f64 = 1e-6;

/// Payload of the exercises, kg.
const LOAD_KG: f64 = 0.3;

/// Minimum displacement of the end effector, m, and minimum change of b, rad, paused and during a run, that
/// complete an exercise.
const MIN_DRAG_M: f64 = 0.02;
const MIN_B_CHANGE_PAUSED_RAD: f64 = 0.2;
const MIN_B_CHANGE_RUNNING_RAD: f64 = 0.02;

fn payload(mass: f64) -> Vec<Command> {
    vec![
        Command::Session(SessionCommand::Edit(Edit::set("plant.payload.mass", mass))),
        Command::Session(SessionCommand::EndGesture),
    ]
}

/// Returns the command that opens one of the paper's cases, with the machine on display.
fn case(session: &Session, name: &str) -> Vec<Command> {
    let case = Scenario::builtin(name).map(|case| with_machine(session, case));
    case.into_iter().map(|case| Command::Session(SessionCommand::Open(Box::new(case)))).collect()
}

/// Returns a case with the machine of a session.
fn with_machine(session: &Session, case: Scenario) -> Scenario {
    let machine = &session.scenario().machine;
    match machine.name() == case.machine.name() {
        true => case,
        false => case.on_machine(machine),
    }
}

/// Returns a text in which names in braces, such as `{area}` and `{moment}`, are replaced by words for the machine.
fn said(text: &str, session: &Session) -> String {
    let n = session.scenario().machine.drives();
    let is_area = session.run().pose_space().is_ok_and(|map| map.reaches_area());
    let (inside, area) = if is_area { ("inside", "area") } else { ("along", "curve") };
    let sum = |term: &dyn Fn(usize) -> String| (1..=n).map(term).collect::<Vec<_>>().join(" + ");
    let constant = sum(&|k| match k {
        1 => "q₁".to_owned(),
        k => format!("λ{0} q{0}", subscript(k)),
    });
    let moment = sum(&|k| format!("D{0} q̈{0}", subscript(k)));
    let free = if n == 2 { "one free angle".to_owned() } else { format!("{} free angles", counted_word(n - 1)) };
    let plane = if n == 2 { "a line" } else { "a plane" };
    [
        ("{area}", area),
        ("{inside}", inside),
        ("{constant}", &constant),
        ("{moment}", &moment),
        ("{free}", &free),
        ("{plane}", plane),
        ("{angles}", &counted_word(n)),
    ]
    .into_iter()
    .fold(text.to_owned(), |text, (name, words)| text.replace(name, words))
}

/// Returns a small number as a word.
fn counted_word(n: usize) -> String {
    const WORDS: [&str; 9] = ["no", "one", "two", "three", "four", "five", "six", "seven", "eight"];
    WORDS.get(n).map_or_else(|| n.to_string(), |word| (*word).to_owned())
}

const STEPS: [Step; 7] = [
    Step {
        title: "An arm shakes what it stands on",
        words: "To speed up its links it pushes against its base, and twists it. Here it takes its end effector from A to \
                B along a straight line: the red arc is the moment on the base, n_B.",
        exercise: "Run the straight line to its end.",
        scene: ("case-1", 0.0),
        points_at: &[Pointed::Base],
        button: |session| Some(("Show me", case(session, "case-1"))),
        done: |session, seen| {
            let straight = session.scenario().task.kind == TaskKind::MinimumNorm && !session.is_dragged();
            seen.ran && straight && session.frame().peaks.moment > FELT_ABOVE
        },
    },
    Step {
        title: "Balance takes the force away",
        words: "Counterweights keep the centre of mass in B, the cross, in every pose. What does not move needs no force: \
                f_B = 0. Hang something on the end effector, and the force is there. (Eq. 7)",
        exercise: "Let it hold 0.3 kg, and run it.",
        scene: ("case-1", 0.0),
        points_at: &[Pointed::Base, Pointed::Target],
        button: |_| {
            let commands = [
                vec![Command::Session(SessionCommand::Seek(0.0))],
                payload(LOAD_KG),
                vec![Command::Session(SessionCommand::TogglePlay)],
            ]
            .concat();
            Some(("Hang 0.3 kg on it", commands))
        },
        done: |session, seen| {
            let loaded = session.scenario().plant.payload.mass >= LOAD_KG - 1e-9;
            seen.ran && loaded && session.frame().peaks.force > FELT_ABOVE
        },
    },
    Step {
        title: "Balance makes the mass matrix constant",
        words: "Without the load nothing in the equations of motion depends on the pose: the moment on the base is a sum \
                of the drives' accelerations with constant weights, n_B = −({moment}). (Eqs. 6, 8)",
        exercise: "Take the load off again.",
        scene: ("case-1", LOAD_KG),
        points_at: &[Pointed::Target],
        button: |session| match session.scenario().plant.payload.mass > 0.0 {
            true => Some(("Take it off", payload(0.0))),
            false => Some(("Hang 0.3 kg on it", payload(LOAD_KG))),
        },
        done: |session, seen| seen.held && session.scenario().plant.payload.mass == 0.0,
    },
    Step {
        title: "On a plane the drives cancel out",
        words: "So the drives only have to move together: as long as {constant} keeps one value, the pose constant \
                b, the sum is zero. That is {plane} in the space of the {angles} angles. (Eq. 13)",
        exercise: "Run the same task on its plane.",
        scene: ("case-3", 0.0),
        points_at: &[Pointed::Base, Pointed::Widget("run:")],
        button: |session| Some(("Show me", case(session, "case-3"))),
        done: |session, seen| {
            let verdict = Verdict::of(session.scenario(), session.frame());
            seen.ran && verdict.moved && verdict.arm_moment < ZERO_BELOW_N_M && !session.is_dragged()
        },
    },
    Step {
        title: "The reactionless workspace",
        words: "One b leaves {free}: enough to go anywhere {inside} the amber {area}. Every path in it is free of \
                reactions, whichever way it goes. (Eqs. 15, 16)",
        exercise: "Drag the white ring about {inside} the amber {area}.",
        scene: ("case-3", 0.0),
        points_at: &[Pointed::Target],
        button: |_| None,
        done: |session, seen| {
            let dragged = |e: &&TimedEdit| matches!(e.edit, Edit::DragTarget { .. });
            let moved = (session.frame().end_effector - seen.tip).norm() >= MIN_DRAG_M;
            session.frame().target.reach == Reach::Inside
                && moved
                && seen.newest(session).find(dragged).is_some_and(|e| Seen::moment(session, e) < ZERO_BELOW_N_M)
        },
    },
    Step {
        title: "b only turns it",
        words: "Another plane, another b: the {area} is the same, turned about the base. What one b leaves out another \
                one reaches. (Eq. 16)",
        exercise: "Turn b by 0.2 rad: the amber ring at the base, the slider, or keys [ and ].",
        scene: ("case-3", 0.0),
        points_at: &[Pointed::Ring, Pointed::Widget("b slider")],
        button: |_| None,
        done: |session, seen| {
            let turned = |e: &TimedEdit| matches!(e.edit, Edit::SlideB { .. } | Edit::PoseB { .. });
            (session.b_aim() - seen.b).abs() >= MIN_B_CHANGE_PAUSED_RAD && seen.newest(session).any(turned)
        },
    },
    Step {
        title: "What it costs to change planes",
        words: "To go from one plane to another the arm must turn as a whole, and the base feels it: the faster, the more. \
                n_B = −D₁ b̈.",
        exercise: "Let the run end. Time goes on: now turn b, with three presses of ] or at the ring.",
        scene: ("case-3", 0.0),
        points_at: &[Pointed::Ring, Pointed::Widget("b slider")],
        button: |session| Some(("Start time", case(session, "case-3"))),
        done: |session, seen| {
            let slid = |e: &&TimedEdit| matches!(e.edit, Edit::SlideB { .. });
            (session.b_aim() - seen.b).abs() > MIN_B_CHANGE_RUNNING_RAD
                && seen.newest(session).find(slid).is_some_and(|e| Seen::moment(session, e) > FELT_ABOVE)
        },
    },
];

impl Tour {
    /// Starts at the first step; `session` is the person's own.
    pub fn begin(session: &Session) -> Self {
        let name = session.scenario().machine.name();
        let why = session.run().pose_space().err();
        let note = why.map(|why| format!("Shown on the paper's machine, as {name} has no amber area: {why}."));
        Self { note, ..Self::at(0, session) }
    }

    fn at(step: usize, session: &Session) -> Self {
        Self { step, seen: Seen::start(session), done: false, note: None }
    }

    /// Returns the tour at the next or previous step; `None` after the last.
    pub fn turned(self, forward: bool, session: &Session) -> Option<Self> {
        let step = if forward { self.step + 1 } else { self.step.saturating_sub(1) };
        (step < STEPS.len()).then(|| Self { note: self.note, ..Self::at(step, session) })
    }

    /// Returns the scene of the step, with the person's own machine unless `note` is set. Also returns the
    /// scene to be shown in its place if that machine cannot do the task, and the message about it.
    pub fn scene(&self, own: &Session) -> (Scenario, Option<Box<(Scenario, String)>>) {
        let (name, load) = STEPS[self.step].scene;
        let case = Scenario::builtin(name).unwrap_or_else(|| own.scenario().without_edits());
        let mut papers = Scenario { compare_b: None, ..case };
        papers.plant.payload.mass = load;
        let own_name = own.scenario().machine.name();
        if self.note.is_some() || own_name == papers.machine.name() {
            return (papers, None);
        }
        let said = format!("shown on the paper's machine, as {own_name} cannot do this task");
        (with_machine(own, papers.clone()), Some(Box::new((papers, said))))
    }

    /// The things that the step mentions.
    pub fn points_at(&self) -> &'static [Pointed] {
        STEPS[self.step].points_at
    }

    /// Observes the session, and records whether the step has been done.
    pub fn follow(&mut self, session: &Session) {
        self.seen.observe(session);
        self.done |= (STEPS[self.step].done)(session, &self.seen);
    }
}
