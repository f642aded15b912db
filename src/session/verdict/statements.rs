//! [`Statements`]: separate assessments of a machine, of its plan and of its run. A balanced machine still reacts on
//! its base if its path leaves the plane b = const. Only a run shows the reactions that are transmitted.
//!
//! | statement | good | bad | open |
//! |---|---|---|---|
//! | machine | every g_k and C_kl vanishes, (7) and (8), with what it carries | one does not | it is not drawn whole |
//! | plan | b stays constant, (13), or no momentum | b changes, or a drive limit is exceeded | no plan, or no b |
//! | run | f_B and n_B vanish, or a wheel took n_B up | they do not, or an audit failed | nothing has moved |
//! | run, free base | it kept its attitude | it turned, or an audit failed | nothing has moved |
//!
//! The three agree: a machine is judged as it moves, with a payload that control does not know of; a hand that has
//! turned b is named by the plan and by the run; and a run that transmits something names what does it.
//!
//! Window, reports of commands and recordings show these statements.

mod moving;

use schemars::JsonSchema;
use serde::Serialize;

use super::{Attitude, Verdict, peaks_of};
use crate::Run;
use crate::scenario::{TaskKind, UnfinishedDrawing};
use stillbase_mechanics::assembly::{BlockConditions, Reacting};
use stillbase_mechanics::machine::Inertia;
use stillbase_settings::number::significant;
use stillbase_simulation::Guide;
use stillbase_simulation::frame::Frame;
use stillbase_simulation::plant::BaseKind;

pub(crate) use moving::inertia_of;
use moving::of_moving_machine;

/// b is held if it varies by no more than this, rad.
const B_TOLERANCE: f64 = 1e-6;

/// The distance of the run from the plane of its plan is stated from here on, rad: what three decimals show.
const MIN_SHOWN_OFF_RAD: f64 = 5e-4;

/// Outcome of a statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, JsonSchema, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum StatusLight {
    /// The condition for a base without reactions is met.
    Good,
    /// The condition is not met.
    Bad,
    /// Not decided yet.
    Open,
}

impl StatusLight {
    /// Returns the outcome as a word, to be shown with a colour.
    pub fn name(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Bad => "bad",
            Self::Open => "open",
        }
    }
}

/// One statement.
#[derive(Clone, Debug, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Statement {
    /// Outcome.
    #[serde(rename = "lamp")]
    pub outcome: StatusLight,
    /// Outcome in a few words that follow the name of the subject: `holds b`.
    pub words: String,
    /// Reason, in a sentence.
    pub why: String,
}

impl Statement {
    fn new(outcome: StatusLight, words: impl Into<String>, why: impl Into<String>) -> Self {
        Self { outcome, words: words.into(), why: why.into() }
    }

    /// States whether a machine is balanced, or by how much it is not.
    pub fn of_machine(inertia: &Inertia) -> Self {
        let (force, coupling) = (inertia.force_residual(), inertia.invariance_residual());
        let figures = format!("largest |g_k| {force:.1e} kg m, largest |C_kl| {coupling:.1e} kg m²");
        match (inertia.is_force_balanced(), inertia.is_invariant()) {
            (true, true) => Self::new(
                StatusLight::Good,
                "balanced",
                format!("force-balanced and invariant, (7) and (8): {figures}"),
            ),
            (false, _) => {
                let words = format!("off balance by {} kg m", significant(force));
                Self::new(StatusLight::Bad, words, format!("its centre of mass moves, (7) does not hold: {figures}"))
            }
            (true, false) => {
                let words = format!("drives coupled by {} kg m²", significant(coupling));
                Self::new(
                    StatusLight::Bad,
                    words,
                    format!("its mass matrix depends on the pose, (8) does not hold: {figures}"),
                )
            }
        }
    }

    /// States what keeps a balanced block of an assembly from being silent; `None` if nothing does.
    fn of_block(conditions: &BlockConditions) -> Option<Self> {
        let reasons: Vec<Reacting> = conditions.reasons().collect();
        let words = match (reasons.contains(&Reacting::Ground), reasons.contains(&Reacting::Tilt)) {
            (true, _) => "carries something off its end effector",
            (false, true) => "has heights that tilt the base",
            (false, false) => return None,
        };
        let [ground, tilt] = [conditions.ground, conditions.tilt].map(significant);
        let why = format!("largest |C_0k| {ground} kg m², largest |Σ m h a_k| {tilt} kg m²: both have to be 0");
        Some(Self::new(StatusLight::Bad, words, why))
    }

    /// States whether the planned or dragged motion of a run holds b.
    fn of_plan(run: &Run, frame: &Frame, inertia: &Inertia) -> Self {
        if run.waiting().is_some() {
            return Self::new(StatusLight::Open, "none, the run waits", "the task does not fit the machine");
        }
        if matches!(run.simulation().guide(), Guide::Lead(_)) {
            let why = "a hand leads the machine at zero angular momentum";
            return Self::new(StatusLight::Good, "led by hand, has no momentum", why);
        }
        if let (Guide::Motion { .. }, Some(length)) = (run.simulation().guide(), run.plan().loop_length) {
            let (task, length) = (&run.scenario().task, significant(length));
            let way = if task.cycles == 1 { "one loop".into() } else { format!("{} loops", task.cycles) };
            let why = format!("{way} of the drives, {length} rad long, and the arm is back; its momentum stays zero");
            let turn = significant(task.base_turn.to_radians());
            return Self::new(StatusLight::Good, format!("turns its base by {turn} rad"), why);
        }
        if let (Guide::Motion { .. }, Some(turn)) = (run.simulation().guide(), &run.plan().base_turn) {
            let (peak, limit) = (significant(turn.angle), run.scenario().task.turn_limit.to_radians());
            if !run.scenario().machine.is_redundant() {
                let why = format!("two drives follow the path in one way, and the base turns by up to {peak} rad");
                return match limit > 0.0 {
                    true => Self::new(StatusLight::Good, "turns its base within its limit", why),
                    false => Self::new(StatusLight::Bad, "turns its base", why),
                };
            }
            let limit = significant(limit);
            let why = format!("where zero momentum leads no farther, the base turns, by up to {peak} of {limit} rad");
            return Self::new(StatusLight::Good, "turns its base within its limit", why);
        }
        if !inertia.is_invariant() && moves_without_momentum(run) {
            let about = match run.scenario().base.kind {
                BaseKind::Free => "the common centre of mass",
                BaseKind::Fixed | BaseKind::Compliant => "the base pin",
            };
            let why = format!("the angular momentum about {about} stays zero all along the path");
            return Self::new(StatusLight::Good, "has no momentum", why);
        }
        if !inertia.is_invariant() {
            let why = "the angular momentum of this machine depends on its pose: it has no pose constant";
            return Self::new(StatusLight::Open, "no b to hold", why);
        }
        if inertia.pose_inertia() == 0.0 {
            return Self::new(
                StatusLight::Good,
                "needs no b",
                "no drive of this machine turns its base: any path will do",
            );
        }
        match run.simulation().guide() {
            Guide::Follow(follower) if (follower.b_aim() - follower.b()).abs() > B_TOLERANCE => {
                let change = significant(follower.b_aim() - follower.b());
                let why = format!("a hand turns b by {change} rad: the base feels −D₁ b̈");
                Self::new(StatusLight::Bad, format!("turns b by {change} rad"), why)
            }
            Guide::Follow(follower) => match turned_by_hand(run, frame) {
                Some(turned) => {
                    let turned = significant(turned);
                    let why = format!(
                        "a hand has turned b by {turned} rad to {:.3} rad; the base has felt −D₁ b̈, now b is held",
                        follower.b()
                    );
                    Self::new(StatusLight::Bad, format!("b turned by {turned} rad"), why)
                }
                None => {
                    let why = format!("a hand leads the machine on the plane b = {:.3} rad", follower.b());
                    Self::new(StatusLight::Good, "led by hand, holds b", why)
                }
            },
            Guide::Motion { .. } | Guide::Lead(_) => {
                let forecast = &run.plan().forecast;
                let [least, greatest] = forecast.b;
                let change = greatest - least;
                let (outcome, words, why) = if change <= B_TOLERANCE {
                    let why = format!("the whole path lies on the plane b = {:.3} rad", forecast.b_start);
                    // The plan is of the model; what the run makes of it is said with it.
                    let off = frame.b - frame.b_reference;
                    match off.abs() > MIN_SHOWN_OFF_RAD {
                        true => {
                            let off = significant(off);
                            let why =
                                format!("{why}; the run is {off} rad off it now, as its machine is not the model");
                            (StatusLight::Good, format!("holds b, the run is off by {off} rad"), why)
                        }
                        false => (StatusLight::Good, "holds b".to_owned(), why),
                    }
                } else {
                    // A base that floats gives way.
                    let law = if run.scenario().base.floats() { "n_B" } else { "n_B = −D₁ b̈" };
                    let why = format!(
                        "b goes from {:.3} rad to {:.3} rad, within {least:.3} to {greatest:.3}; {law}, up to {} N m foreseen",
                        forecast.b_start,
                        forecast.b_end,
                        significant(forecast.moment)
                    );
                    (StatusLight::Bad, format!("changes b by {} rad", significant(change)), why)
                };
                match forecast.exceeded_limit {
                    None => Self::new(outcome, words, why),
                    Some((limit, factor)) => {
                        let past = format!("the {limit} is {factor:.2} times its limit");
                        Self::new(StatusLight::Bad, format!("{words}, but {past}"), format!("{why}; {past}"))
                    }
                }
            }
        }
    }

    /// States the reactions that a run up to a frame has transmitted to its base.
    fn of_run(run: &Run, frame: &Frame, machine: &Self) -> Self {
        let (verdict, peaks) = (Verdict::of(run.scenario(), frame), &frame.peaks);
        if let Some(figure) = &verdict.fault {
            return Self::new(StatusLight::Bad, "cannot be trusted", format!("an audit has failed: {figure}"));
        }
        if run.waiting().is_some() {
            return Self::new(StatusLight::Open, "waits", "nothing moves until the task fits the machine");
        }
        if !verdict.moved {
            let words = if frame.step == 0 { "none yet" } else { "nothing moved" };
            return Self::new(
                StatusLight::Open,
                words,
                "the arm has not moved, so there is nothing to say of what it transmits",
            );
        }
        let figures = match &verdict.shared {
            Some(shared) => peaks_of(shared),
            None => format!(
                "peak |n_B| {} N m, peak |f_B| {} N",
                significant(verdict.arm_moment),
                significant(verdict.force)
            ),
        };
        if verdict.reactionless {
            return Self::new(StatusLight::Good, "transmitted nothing", figures);
        }
        if let Some(attitude) = verdict.attitude {
            return Self::of_attitude(run, frame, machine, &verdict, attitude);
        }
        if let Some(past_wheel) = verdict.past_wheel.filter(|_| verdict.is_base_unloaded) {
            let words = format!("the wheel took up {:.3} N m", verdict.arm_moment);
            let why = format!("{figures}; the moment past the wheel is {} N m", significant(past_wheel));
            return Self::new(StatusLight::Good, words, why);
        }
        if let Some(shared) = &verdict.shared {
            let six = ["f_x", "f_y", "f_z", "n_x", "n_y", "n_z"].iter().zip(shared.silent());
            let felt: Vec<&str> = six.filter(|(_, silent)| !silent).map(|(name, _)| *name).collect();
            let words = format!("{} on the shared base", felt.join(", "));
            return Self::new(
                StatusLight::Bad,
                words,
                format!("{figures}; `stillbase check` tells the blocks that react"),
            );
        }
        let parts = [
            peaks.transmits_moment().then(|| format!("|n_B| {} N m", significant(verdict.arm_moment))),
            peaks.transmits_force().then(|| format!("|f_B| {} N", significant(verdict.force))),
        ];
        let words = format!("peak {}", parts.into_iter().flatten().collect::<Vec<_>>().join(", "));
        Self::new(StatusLight::Bad, words, format!("{figures}; {}", cause(run, frame, machine)))
    }

    /// States whether a free base has kept its attitude up to a frame.
    fn of_attitude(run: &Run, frame: &Frame, machine: &Self, verdict: &Verdict, attitude: Attitude) -> Self {
        let Attitude { peak, end, shift, wanted } = attitude;
        let limit = run.scenario().task.turn_limit.to_radians();
        let within = if limit > 0.0 && peak <= limit { ", within its limit" } else { "" };
        let [peak, now, shift] = [peak, end, shift].map(significant);
        let figures = format!("peak |θ| {peak} rad, {now} rad at the end, base shifted by up to {shift} m");
        if let Some(wanted) = wanted {
            let wanted = significant(wanted);
            return match (attitude.is_as_wanted(), verdict.ended) {
                (true, _) => {
                    Self::new(StatusLight::Good, format!("turned its base by {wanted} rad, as wanted"), figures)
                }
                (false, false) => {
                    Self::new(StatusLight::Open, format!("has turned its base by {now} of {wanted} rad"), figures)
                }
                (false, true) => Self::new(
                    StatusLight::Bad,
                    format!("turned its base by {now} rad, not by {wanted} rad"),
                    format!("{figures}; {}", cause(run, frame, machine)),
                ),
            };
        }
        match (attitude.is_kept(), &verdict.wheel) {
            (true, Some(wheel)) => Self::new(
                StatusLight::Good,
                format!("kept its attitude, the wheel took up {} N m s", significant(wheel.momentum)),
                format!("{figures}; {}", wheel.sentence()),
            ),
            (true, None) => Self::new(StatusLight::Good, "kept its attitude", figures),
            (false, Some(wheel)) => Self::new(
                StatusLight::Bad,
                format!("turned its base by {peak} rad{within}"),
                format!("{figures}; {}", wheel.sentence()),
            ),
            (false, None) => Self::new(
                StatusLight::Bad,
                format!("turned its base by {peak} rad{within}"),
                format!("{figures}; {}", cause(run, frame, machine)),
            ),
        }
    }
}

/// Returns what transmits a reaction, in a sentence.
fn cause(run: &Run, frame: &Frame, machine: &Statement) -> &'static str {
    match machine.outcome {
        _ if moves_without_momentum(run) => {
            "the path has no momentum, so what the model leaves out does this: a payload, a push, friction, gains"
        }
        StatusLight::Bad if inertia_of(run).is_balanced() => {
            "what control does not know of does this: with it the machine is not balanced"
        }
        StatusLight::Bad => "the machine does this: it is not balanced",
        _ if turned_by_hand(run, frame).is_some() => "a hand does this, not the machine: it has turned b",
        _ if changes_b(run) => "the path does this, not the machine: b changes on it",
        _ => {
            "neither machine nor path do this, but what the model leaves out: a payload, a push, friction, unequal \
             gains, or a hand that turned b"
        }
    }
}

/// Returns whether a run follows a motion that is planned without angular momentum.
fn moves_without_momentum(run: &Run) -> bool {
    match run.simulation().guide() {
        Guide::Motion { .. } => match run.scenario().task.kind {
            TaskKind::ZeroMomentum => run.plan().base_turn.is_none(),
            kind => kind == TaskKind::TurnBase,
        },
        Guide::Lead(_) => true,
        Guide::Follow(_) => false,
    }
}

/// Returns how far a hand has turned b out of its range on the planned path, rad; `None` if b is in it, no hand leads
/// the machine, or no moment has reached the base.
fn turned_by_hand(run: &Run, frame: &Frame) -> Option<f64> {
    let Guide::Follow(follower) = run.simulation().guide() else { return None };
    let [least, greatest] = run.plan().forecast.b;
    let turned = follower.b_aim() - follower.b_aim().clamp(least.min(greatest), greatest.max(least));
    (turned.abs() > B_TOLERANCE && frame.peaks.transmits_moment()).then_some(turned)
}

/// Returns whether the motion of a run, planned or dragged, changes b.
pub(crate) fn changes_b(run: &Run) -> bool {
    let change = match run.simulation().guide() {
        Guide::Lead(_) => 0.0,
        Guide::Follow(follower) => (follower.b_aim() - follower.b()).abs(),
        Guide::Motion { .. } => {
            let [least, greatest] = run.plan().forecast.b;
            greatest - least
        }
    };
    change > B_TOLERANCE && inertia_of(run).is_invariant()
}

/// The statements on a session.
#[derive(Clone, Debug, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Statements {
    /// Whether the machine is balanced.
    pub machine: Statement,
    /// Whether the plan holds b.
    pub plan: Statement,
    /// Whether the run has transmitted nothing.
    pub run: Statement,
}

impl Statements {
    /// Name of the statement on the machine.
    pub const MACHINE: &str = "machine";
    /// Name of the statement on the plan.
    pub const PLAN: &str = "plan";
    /// Name of the statement on the run.
    pub const RUN: &str = "run";

    /// Makes the statements on a run up to a frame. While the machine is not drawn to the end, they say what is missing
    /// and judge nothing.
    pub fn of(run: &Run, frame: &Frame) -> Self {
        if let Some(unfinished) = run.unfinished() {
            return Self::of_drawing(unfinished);
        }
        let mut machine = Statement::clone(&of_moving_machine(run, frame));
        if let Some(shared) = run.shared().filter(|_| machine.outcome == StatusLight::Good) {
            // What the block holds at the step of the frame may be another payload than at the start.
            let conditions = shared.assembly_at(frame.step).conditions(shared.block().block);
            machine = Statement::of_machine(&conditions.inertia);
            if machine.outcome == StatusLight::Good {
                machine = Statement::of_block(&conditions).unwrap_or(machine);
            }
        }
        let mut plan = Statement::of_plan(run, frame, &inertia_of(run));
        if run.shared().is_some() && plan.outcome == StatusLight::Bad {
            // What a block does alone, the others may cancel.
            plan.outcome = StatusLight::Open;
            plan.why += "; what the other blocks do at the same time may cancel it";
        }
        let run = Statement::of_run(run, frame, &machine);
        Self { machine, plan, run }
    }

    fn of_drawing(unfinished: &UnfinishedDrawing) -> Self {
        let open = |words: String, why: String| Statement::new(StatusLight::Open, words, why);
        let none = || open("none yet".into(), format!("the drawing {:?} is no machine yet", unfinished.drawing));
        let missing = unfinished.missing.join("; ");
        Self {
            machine: open(unfinished.count(), format!("still missing in {:?}: {missing}", unfinished.drawing)),
            plan: none(),
            run: none(),
        }
    }

    /// Returns each statement with the name of its subject.
    pub fn named(&self) -> [(&'static str, &Statement); 3] {
        [(Self::MACHINE, &self.machine), (Self::PLAN, &self.plan), (Self::RUN, &self.run)]
    }

    /// Returns all statements in one line, such as `machine: balanced · plan: holds b · run: none yet`.
    pub fn line(&self) -> String {
        self.named().map(|(name, statement)| format!("{name}: {}", statement.words)).join(" · ")
    }
}
