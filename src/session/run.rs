//! A [`Run`]: a scenario in motion. Window and headless advance the same one, so they cannot differ.

use std::sync::Arc;

use thiserror::Error;

use super::edit::{Edit, TimedEdit};
use super::planning::{Plan, plan};
use crate::mechanics::machine::{Machine, MachineError};
use crate::mechanics::planar::{DriveAngles, Vector};
use crate::planning::curves::{CurveError, PathError};
use crate::planning::following::follow::Bounds;
use crate::planning::following::{Blocked, Follower};
use crate::planning::motion::Motion;
use crate::planning::off_plane::drift::DriftError;
use crate::planning::off_plane::least_reaction::LeastReactionError;
use crate::planning::off_plane::price::PriceError;
use crate::planning::pose_constant::{NoCommon, PlaneError, Planes, Unreachable};
use crate::planning::reactionless::{Decimal, PlanePoint};
use crate::planning::timing::TimeError;
use crate::session::scenario::{MAX_STEPS, MAX_TIME, Scenario, ordinal};
use crate::settings::change;
use crate::settings::range::{Check, Short, Want, shortened};
use crate::simulation::audit::{Audit, Lamp};
use crate::simulation::frame::Frame;
use crate::simulation::{Guide, Simulation};

/// The most frames a session keeps: three minutes of motion at 1 kHz, some 150 MB.
pub(super) const MAX_FRAMES: usize = 180_000;

/// Why a scenario cannot start or an edit cannot apply; nothing has changed then.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Refusal {
    /// The machine has no reactionless planes of the kind the task needs.
    #[error(transparent)]
    NoPlanes(#[from] PlaneError),
    /// A or B cannot be reached there.
    #[error("{point} {unreachable}")]
    Unreachable {
        /// `A`, `1`, `2` … `B`.
        point: String,
        /// Why, and what would do.
        unreachable: Unreachable,
    },
    /// No plane serves all points.
    #[error("{said}")]
    NoCommonPlane {
        /// In words, points by their names.
        said: String,
        /// Why, and what would mend it.
        why: NoCommon,
    },
    /// The path.
    #[error(transparent)]
    Path(#[from] PathError),
    /// The points give no curve.
    #[error(transparent)]
    Curve(#[from] CurveError),
    /// The curve cannot be followed on the plane.
    #[error(transparent)]
    Blocked(#[from] Box<Blocked>),
    /// The task asks for something that does not fit together.
    #[error("{0}")]
    Task(String),
    /// b has no price here.
    #[error(transparent)]
    Price(#[from] PriceError),
    /// The redundancy cannot be resolved so.
    #[error(transparent)]
    LeastReaction(#[from] LeastReactionError),
    /// The end effector's curve cannot be followed at zero momentum.
    #[error(transparent)]
    Drift(#[from] DriftError),
    /// The fastest law.
    #[error(transparent)]
    Time(#[from] TimeError),
    /// The machine.
    #[error(transparent)]
    Machine(#[from] MachineError),
    /// The numbers have blown up.
    #[error(
        "the simulation diverges at {time:.3} s: want smaller gains, a smaller step, a lighter payload, or softer springs, dampers and \
             friction"
    )]
    Diverged {
        /// s.
        time: f64,
    },
    /// An audit of the run has failed.
    #[error("audit failed: {why}; want a smaller step")]
    Untrusted {
        /// Which, and by how much.
        why: String,
    },
    /// The motion in progress does not fit into new limits.
    #[error("the motion in progress would leave {key} = {value}: want wider limits, or set them at its start")]
    LeavesLimits {
        /// Which.
        key: String,
        /// What was given.
        value: String,
    },
    /// A number out of range.
    #[error("{what} is {}: want {want}", Short(*value))]
    OutOfRange {
        /// Which.
        what: String,
        /// What was given.
        value: f64,
        /// What would be right.
        want: Want,
    },
    /// The motion takes longer than any may.
    #[error("the motion would take {}: want at most {MAX_TIME} s, with higher limits or a shorter way", seconds(*time))]
    TooLong {
        /// s.
        time: f64,
    },
    /// The run has more steps than any may.
    #[error("{} s in steps of {} s are {steps} steps: want at most {MAX_STEPS}, with longer steps or a shorter duration", Short(*time), Short(*step))]
    TooManySteps {
        /// s.
        time: f64,
        /// s.
        step: f64,
        /// How many.
        steps: u64,
    },
    /// A session keeps no more frames.
    #[error(
        "a session keeps {MAX_FRAMES} frames and an hour at most, and this one is full at {time:.3} s: want an earlier \
         instant, or the start, to go on from; `simulate` and `headless` run longer"
    )]
    Full {
        /// s.
        time: f64,
    },
    /// What a run would write.
    #[error(
        "{rows} rows of {columns} numbers are up to {:.1} GB: want at most {:.0} GB, with fewer rows or a shorter duration",
        bytes / 1e9, most / 1e9
    )]
    TooLarge {
        /// How many.
        rows: u64,
        /// Numbers in each.
        columns: usize,
        /// At most.
        bytes: f64,
        /// How many there may be.
        most: f64,
    },
    /// One of the edits of a scenario.
    #[error("the {} [[edit]], {title} at step {step}: {refusal}", ordinal(*entry))]
    Edit {
        /// Which, counted from 1 in the order of the file.
        entry: usize,
        /// When.
        step: u64,
        /// What it would do.
        title: String,
        /// Why it cannot.
        refusal: Box<Refusal>,
    },
}

/// A time for a message.
fn seconds(time: f64) -> String {
    if time < 1e9 { format!("{time:.0} s") } else { "more than 1e9 s".into() }
}

/// A time that a motion finds itself obeys the same bound as one that it is given.
///
/// # Errors
/// If it is longer than any motion may take, or no number.
pub(super) fn allowed(time: f64) -> Result<(), Refusal> {
    if time <= MAX_TIME { Ok(()) } else { Err(Refusal::TooLong { time }) }
}

impl From<Check> for Refusal {
    fn from(Check { key, value, want, .. }: Check) -> Self {
        Self::OutOfRange { what: key.into(), value, want }
    }
}

impl Refusal {
    /// The pose constant nearest to the present one that would do, rad, if another b is all it takes.
    pub fn mending_b(&self) -> Option<f64> {
        match self {
            Self::Edit { refusal, .. } => refusal.mending_b(),
            Self::Blocked(blocked) => blocked.nearest_b,
            Self::Unreachable { unreachable: Unreachable::OnThisPlane { nearest_b, .. }, .. } => *nearest_b,
            _ => None,
        }
    }

    /// The same as it is shown: rounded to where it still does.
    pub fn shown_b(&self) -> Option<Decimal> {
        match self {
            Self::Edit { refusal, .. } => refusal.shown_b(),
            Self::Blocked(blocked) => blocked.shown_b,
            Self::Unreachable { unreachable: Unreachable::OnThisPlane { shown_b, .. }, .. } => *shown_b,
            _ => None,
        }
    }
}

/// Why a run waits: its task does not fit its machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Waiting {
    /// What is in the way.
    pub why: Refusal,
    /// Points that the plane of the task does not serve, counted from A, and the nearest b of each that would, rad, as printed.
    pub points: Vec<(usize, Option<Decimal>)>,
}

impl Waiting {
    fn of(scenario: &Scenario, planes: &Planes, why: Refusal) -> Self {
        let (task, map) = (&scenario.task, planes.map());
        let unserved = |(i, p): (usize, Vector)| {
            let would_do = || {
                let set = map.reach(p).ok()?;
                set.decimal(set.inwards(set.nearest(task.b)?, 1e-6), 4)
            };
            map.poses(p, task.b).is_empty().then(|| (i, would_do()))
        };
        Self { why, points: task.points().into_iter().enumerate().filter_map(unserved).collect() }
    }
}

/// A scenario in motion.
#[derive(Clone, Debug)]
pub struct Run {
    scenario: Scenario,
    planes: Option<Arc<Planes>>,
    plan: Plan,
    /// Set where the task cannot be planned; the plan is then to rest.
    waiting: Option<Waiting>,
    simulation: Simulation,
}

impl Run {
    /// At rest at the start of the scenario's task; its edits are left to the caller.
    ///
    /// # Errors
    /// If the task cannot be planned.
    pub fn new(scenario: &Scenario) -> Result<Self, Refusal> {
        Self::with_planes(scenario, None)
    }

    /// At the start of the task as edits before the first step leave it, up to the first that leads the machine; how
    /// many those are. Planned once, when all have been made: what stands between two of them need not be possible.
    ///
    /// # Errors
    /// If an edit is out of range, or the task cannot be planned.
    pub(super) fn begin(
        scenario: &Scenario,
        script: &[TimedEdit],
        known: Option<&Self>,
    ) -> Result<(Self, usize), Failed> {
        let mut planes = known.and_then(|run| Some((run.scenario.machine.clone(), run.planes.clone()?)));
        let (ground, count) = folded(scenario, script, &mut planes)?;
        let known = planes.filter(|(machine, _)| *machine == ground.machine).map(|(_, planes)| planes);
        Ok((Self::patient(&ground, known)?, count))
    }

    fn with_planes(scenario: &Scenario, known: Option<Arc<Planes>>) -> Result<Self, Refusal> {
        let run = Self::patient(scenario, known)?;
        match run.waiting {
            Some(waiting) => Err(waiting.why),
            None => Ok(run),
        }
    }

    /// At rest at the start of the task; where that cannot be planned, waiting.
    fn patient(scenario: &Scenario, known: Option<Arc<Planes>>) -> Result<Self, Refusal> {
        let planes = match known {
            Some(planes) => planes,
            None => Arc::new(Planes::of(&scenario.machine)?),
        };
        let keep_off = scenario.task.keep_off_change_points;
        let planes = match planes.keep_off_change_points() == keep_off {
            true => planes,
            false => Arc::new(Planes::clone(&planes).keeping_off_change_points(keep_off)),
        };
        let (plan, waiting) = match plan(scenario, &planes) {
            Ok(plan) => (plan, None),
            Err(why) => (Plan::rest(scenario, &planes), Some(Waiting::of(scenario, &planes, why))),
        };
        let guide = Guide::Motion { motion: plan.motion.clone(), start: 0.0 };
        let simulation = Simulation::new(&scenario.setup(), guide)?;
        Ok(Self { scenario: scenario.clone(), planes: Some(planes), plan, waiting, simulation })
    }

    /// Why it waits, if its task does not fit its machine.
    pub fn waiting(&self) -> Option<&Waiting> {
        self.waiting.as_ref()
    }

    /// The scenario with everything that edits have set.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// The machine's reactionless planes.
    pub fn planes(&self) -> Option<&Arc<Planes>> {
        self.planes.as_ref()
    }

    /// The simulation.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// The plan of the task.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// How long the planned motion takes, s.
    pub fn planned_time(&self) -> f64 {
        self.plan.motion.duration()
    }

    /// Where a pose has the end effector, m.
    pub fn place(&self, q: &DriveAngles) -> Vector {
        crate::mechanics::kinematics::end_effector(self.scenario.machine.tip(), &q.units())
    }

    /// Where the end effector is after a share of the planned time, m.
    pub fn on_path(&self, share: f64) -> Vector {
        self.place(&self.plan.motion.at(share * self.planned_time()).q)
    }

    /// The planned motion, while it leads.
    pub fn motion(&self) -> Option<&Motion> {
        match self.simulation.guide() {
            Guide::Motion { motion, .. } => Some(motion),
            Guide::Follow(_) => None,
        }
    }

    /// Everything that is true now.
    pub fn frame(&self) -> Frame {
        self.simulation.frame()
    }

    /// One step.
    pub fn advance(&mut self) {
        self.simulation.advance();
    }

    /// Applies an edit at the present step.
    ///
    /// # Errors
    /// If it cannot apply; then nothing has changed.
    pub fn apply(&mut self, edit: &Edit) -> Result<(), Refusal> {
        if matches!(edit, Edit::SetTolerance { .. }) {
            // Nothing of the run depends on it.
            self.scenario = checked(changed(&self.scenario, edit)?, edit)?;
            return Ok(());
        }
        if self.is_untouched() && !edit.leads() {
            let mut planes = self.planes.clone().map(|planes| (self.scenario.machine.clone(), planes));
            let scenario = checked(amended(&self.scenario, edit, &mut planes)?, edit)?;
            let known = planes.filter(|(machine, _)| *machine == scenario.machine).map(|(_, planes)| planes);
            *self = Self::with_planes(&scenario, known)?;
            return Ok(());
        }
        edit.check(self.scenario.step)?;
        match edit {
            Edit::DragTarget { x, y } => {
                let mut follower = self.follower()?;
                follower.set_target(Vector::new(*x, *y));
                self.simulation.lead(Guide::Follow(follower));
            }
            Edit::SlideB { b } => {
                let mut follower = self.follower()?;
                follower.set_b(*b);
                self.simulation.lead(Guide::Follow(follower));
            }
            Edit::PoseB { b } => {
                let mut follower = self.follower()?;
                follower.pose_at(*b);
                self.simulation.place(Guide::Follow(follower));
            }
            Edit::CompareB { b } => self.scenario.compare_b = *b,
            Edit::SetTolerance { .. } => {}
            Edit::Push { .. }
            | Edit::SetPlant { .. }
            | Edit::SetBase { .. }
            | Edit::SetControl { .. }
            | Edit::SetMachine { .. }
            | Edit::SetTime { .. }
            | Edit::SetTask { .. } => self.set(edit)?,
        }
        Ok(())
    }

    /// Whether the planned motion still lies ahead as a whole.
    fn is_untouched(&self) -> bool {
        self.simulation.step_count() == 0 && matches!(self.simulation.guide(), Guide::Motion { .. })
    }

    /// Parameters in motion: it keeps its path.
    fn set(&mut self, edit: &Edit) -> Result<(), Refusal> {
        if edit.is_of_the_start() {
            return Err(Refusal::Task(Edit::AT_START.into()));
        }
        let scenario = checked(changed(&self.scenario, edit)?, edit)?;
        if let (Edit::SetMachine { key, value }, true) = (edit, self.leaves_limits(&scenario)) {
            return Err(Refusal::LeavesLimits { key: key.clone(), value: value.clone() });
        }
        let mut simulation = self.simulation.clone();
        simulation.change(&scenario.setup())?;
        if scenario.machine != self.scenario.machine {
            let keep_off = scenario.task.keep_off_change_points;
            let planes = Arc::new(Planes::of(&scenario.machine)?.keeping_off_change_points(keep_off));
            if let Guide::Follow(old) = self.simulation.guide() {
                let bounds = bounds(&scenario, &planes);
                let mut follower = Follower::new(planes.clone(), bounds, scenario.step, self.simulation.reference());
                follower.set_target(old.target().at);
                // Another λ makes b another quantity.
                if planes.map().lambda() == old.planes().map().lambda() {
                    follower.set_b(old.b_aim());
                }
                simulation.lead(Guide::Follow(follower));
            }
            self.planes = Some(planes);
        }
        self.simulation = simulation;
        self.scenario = scenario;
        Ok(())
    }

    /// Whether the planned motion, where it leads, has yet to pass limits that it kept before.
    fn leaves_limits(&self, changed: &Scenario) -> bool {
        let Guide::Motion { motion, start } = self.simulation.guide() else { return false };
        let done = motion.profile.at(self.simulation.time() - start).s;
        (0..=64).map(|i| done + (1.0 - done) * f64::from(i) / 64.0).any(|s| {
            let q = motion.path.at(s).q;
            let keeps = |scenario: &Scenario| {
                scenario.machine.angles().iter().all(|a| {
                    let angle = q[a.to] - q[a.from] + a.offset;
                    angle >= a.limits.start() - 1e-9 && angle <= a.limits.end() + 1e-9
                })
            };
            keeps(&self.scenario) && !keeps(changed)
        })
    }

    /// The follower that leads, or one that takes over from the motion.
    fn follower(&self) -> Result<Follower, Refusal> {
        match self.simulation.guide() {
            Guide::Follow(follower) => Ok(follower.clone()),
            Guide::Motion { .. } => {
                let planes = match &self.planes {
                    Some(planes) => planes.clone(),
                    None => Arc::new(Planes::of(&self.scenario.machine)?),
                };
                let bounds = bounds(&self.scenario, &planes);
                Ok(Follower::new(planes, bounds, self.scenario.step, self.simulation.reference()))
            }
        }
    }
}

impl Run {
    /// What takes an edit back if applied after it; `None` if only what was before can.
    pub fn inverse_of(&self, edit: &Edit) -> Option<Edit> {
        let scenario = &self.scenario;
        let frame = self.frame();
        let b_aim = || match self.simulation.guide() {
            Guide::Follow(follower) => follower.b_aim(),
            Guide::Motion { .. } => frame.b_reference,
        };
        Some(match edit {
            Edit::DragTarget { .. } => Edit::DragTarget { x: frame.target.at.re, y: frame.target.at.im },
            Edit::SlideB { .. } => Edit::SlideB { b: b_aim() },
            Edit::PoseB { .. } => Edit::PoseB { b: b_aim() },
            Edit::Push { .. } => Edit::Push { x: scenario.plant.force[0], y: scenario.plant.force[1] },
            Edit::SetPlant { change } => Edit::SetPlant { change: change::only(&scenario.plant, change) },
            Edit::SetBase { change } => Edit::SetBase { change: change::only(&scenario.base, change) },
            Edit::SetControl { change } => Edit::SetControl { change: change::only(&scenario.control, change) },
            Edit::SetTolerance { change } => Edit::SetTolerance { change: change::only(&scenario.tolerance, change) },
            Edit::SetMachine { key, .. } => Edit::SetMachine { key: key.clone(), value: scenario.machine.get(key)? },
            Edit::SetTime { .. } => Edit::SetTime { time: scenario.task.time },
            Edit::SetTask { change } => Edit::SetTask { change: scenario.task.only(change) },
            Edit::CompareB { .. } => Edit::CompareB { b: scenario.compare_b },
        })
    }
}

/// A scenario with a parameter set; nothing is planned, and whether all fits together is for [`checked`] to say.
pub(super) fn changed(scenario: &Scenario, edit: &Edit) -> Result<Scenario, Refusal> {
    let mut scenario = scenario.clone();
    match edit {
        Edit::Push { x, y } => {
            scenario.plant.force = [*x, *y];
        }
        Edit::SetPlant { change } => {
            scenario.plant = change::with(&scenario.plant, change).map_err(|why| wrong("plant", &why))?;
        }
        Edit::SetBase { change } => {
            scenario.base = change::with(&scenario.base, change).map_err(|why| wrong("base", &why))?;
        }
        Edit::SetControl { change } => {
            scenario.control = change::with(&scenario.control, change).map_err(|why| wrong("control", &why))?;
        }
        Edit::SetTolerance { change } => {
            scenario.tolerance = change::with(&scenario.tolerance, change).map_err(|why| wrong("tolerance", &why))?;
        }
        Edit::SetMachine { key, value } => scenario.machine = scenario.machine.set(key, value)?,
        Edit::SetTime { time } => scenario.task.time = *time,
        Edit::CompareB { b } => scenario.compare_b = *b,
        Edit::SetTask { change } => {
            scenario.task = scenario.task.with(change).map_err(|why| wrong("task", &why))?;
        }
        Edit::PoseB { .. } | Edit::DragTarget { .. } | Edit::SlideB { .. } => {}
    }
    Ok(scenario)
}

fn wrong(of: &str, why: &str) -> Refusal {
    Refusal::Task(format!("{of}: {why}"))
}

/// A scenario that an edit of its keys has left sound.
fn checked(scenario: Scenario, edit: &Edit) -> Result<Scenario, Refusal> {
    match edit {
        Edit::Push { .. }
        | Edit::SetPlant { .. }
        | Edit::SetBase { .. }
        | Edit::SetControl { .. }
        | Edit::SetTolerance { .. }
        | Edit::SetTask { .. } => sound(scenario, edit.part()),
        _ => Ok(scenario),
    }
}

fn sound(scenario: Scenario, of: &str) -> Result<Scenario, Refusal> {
    scenario.check(of).map_err(|why| Refusal::Task(why.to_string()))?;
    Ok(scenario)
}

/// A scenario as an edit before its first step leaves it; planes are made if a pose needs them, and kept.
fn amended(scenario: &Scenario, edit: &Edit, planes: &mut Option<(Machine, Arc<Planes>)>) -> Result<Scenario, Refusal> {
    edit.check(scenario.step)?;
    let Edit::PoseB { b } = edit else { return changed(scenario, edit) };
    let known = planes.take().filter(|(machine, _)| *machine == scenario.machine);
    let planes = match known {
        Some(known) => planes.insert(known),
        None => planes.insert((scenario.machine.clone(), Arc::new(Planes::of(&scenario.machine)?))),
    };
    Ok(posed(scenario, &planes.1, *b))
}

/// The task on another plane: its points keep their places while one plane serves all; beyond that they turn with the
/// workspace.
fn posed(scenario: &Scenario, planes: &Planes, b: f64) -> Scenario {
    let mut scenario = scenario.clone();
    if let Some(task) = scenario.task.posed(&scenario.machine, b) {
        return Scenario { task, ..scenario };
    }
    scenario.task.b = b;
    let points = scenario.task.points();
    if let (Err(_), Some(turned)) = (planes.serve(&points, b), planes.serve_turned(&points, b)) {
        let place = |at: &PlanePoint| {
            let p = planes.map().forward(at.a, at.b);
            [p.re, p.im]
        };
        if let [from, via @ .., to] = &turned[..] {
            (scenario.task.from, scenario.task.to) = (place(from), place(to));
            scenario.task.via = via.iter().map(place).collect();
        }
    }
    scenario
}

/// Bounds of the follower: no torque limit of any drive is passed in any direction of (ä_1, ä_2).
fn bounds(scenario: &Scenario, planes: &Planes) -> Bounds {
    const UNLIMITED: f64 = 30.0;
    let machine = &scenario.machine;
    let inertia = crate::mechanics::machine::Inertia::of(machine);
    let joint = (0..machine.drives())
        .filter_map(|k| {
            let limit = machine.spec().drives[k].torque_limit?;
            let [u, v] = planes.map().u()[k];
            Some(limit / (inertia.diagonal(k) * u.hypot(v).max(1e-9)))
        })
        .fold(UNLIMITED, f64::min);
    Bounds { joint, pose: scenario.pose_acceleration }
}

/// A scenario with the edits before its first step made part of it, and the others left out, and how many those others are.
///
/// # Errors
/// If an edit cannot be made.
pub fn settled(scenario: &Scenario) -> Result<(Scenario, usize), Refusal> {
    let script = in_order(&scenario.edits);
    let (ground, count) = folded(scenario, &script, &mut None).map_err(|failed| failed.named(&scenario.edits))?;
    Ok((ground, script.len() - count))
}

/// Why a script cannot be carried out, and which of its edits is to blame, counted from 0, if it is one.
pub(super) struct Failed {
    edit: Option<usize>,
    refusal: Refusal,
}

impl Failed {
    pub(super) fn at(edit: usize, refusal: Refusal) -> Self {
        Self { edit: Some(edit), refusal }
    }

    /// Why.
    pub(super) fn refusal(self) -> Refusal {
        self.refusal
    }

    /// Why, with the entry of the file that the script was made of.
    pub(super) fn named(self, edits: &[TimedEdit]) -> Refusal {
        let order = order_of(edits);
        match self.edit.and_then(|i| order.get(i)).and_then(|&i| Some((i, edits.get(i)?))) {
            Some((i, timed)) => Refusal::Edit {
                entry: i + 1,
                step: timed.step,
                title: shortened(&timed.edit.title(), 80),
                refusal: Box::new(self.refusal),
            },
            None => self.refusal,
        }
    }
}

impl<E: Into<Refusal>> From<E> for Failed {
    fn from(error: E) -> Self {
        Self { edit: None, refusal: error.into() }
    }
}

/// How many edits come before the first step, up to the first that leads the machine.
pub(super) fn opening<'a>(script: impl IntoIterator<Item = &'a TimedEdit>) -> usize {
    script.into_iter().take_while(|e| e.step == 0 && !e.edit.leads()).count()
}

/// A scenario with the edits before its first step made, up to the first that leads the machine, and their number; it
/// carries no edits any more.
fn folded(
    scenario: &Scenario,
    script: &[TimedEdit],
    planes: &mut Option<(Machine, Arc<Planes>)>,
) -> Result<(Scenario, usize), Failed> {
    let count = opening(script);
    // With its edits, each copy of it would cost as much as all of them.
    let mut ground = scenario.without_edits();
    for (i, timed) in script[..count].iter().enumerate() {
        ground = amended(&ground, &timed.edit, planes).map_err(|refusal| Failed::at(i, refusal))?;
    }
    // What stands between two of them need not fit together.
    let ground = if count > 0 { sound(ground, "the scenario")? } else { ground };
    Ok((ground, count))
}

/// Frames of a scenario with its edits, from the first to the last step, one at a time.
///
/// # Errors
/// If it cannot start, or an edit cannot apply.
pub fn replay(scenario: &Scenario, see: impl FnMut(&Run, &Frame)) -> Result<Run, Refusal> {
    replay_if(scenario, |_| Ok(()), see)
}

/// The same, unless what knows the last step has something against it before the first.
///
/// # Errors
/// As [`replay`], and if it is refused.
pub fn replay_if(
    scenario: &Scenario,
    allow: impl FnOnce(u64) -> Result<(), Refusal>,
    see: impl FnMut(&Run, &Frame),
) -> Result<Run, Refusal> {
    let end = |run: &Run, script: &[TimedEdit]| {
        let last = run.whole(script)?;
        allow(last).map(|()| last).map_err(Failed::from)
    };
    let done = perform(scenario, &in_order(&scenario.edits), (end, false), None, see);
    done.map_err(|failed| failed.named(&scenario.edits))
}

/// What shakes the base at every step of a scenario: f_Bx and f_By of motion, N, and the moment that it feels, N m; and
/// the first audit that the run has failed.
///
/// # Errors
/// As [`replay`].
pub fn felt(scenario: &Scenario) -> Result<([Vec<f64>; 3], Option<Lamp>), Refusal> {
    let mut course: [Vec<f64>; 3] = Default::default();
    let run = replay(scenario, |_, frame| {
        let force = frame.wrench.dynamic.force;
        let now = [force.re, force.im, frame.felt_moment()];
        course.iter_mut().zip(now).for_each(|(all, x)| all.push(x));
    })?;
    Ok((course, Audit::fault(&run.frame())))
}

impl Run {
    /// The step at which the scenario's duration is over, or else its planned motion.
    pub fn last_step(&self) -> u64 {
        let step = self.scenario.step;
        match self.scenario.duration {
            Some(duration) => (duration / step).round() as u64,
            // A motion that ends between two steps is seen to its end.
            None => (self.planned_time() / step - 1e-6).ceil() as u64,
        }
    }

    /// The same, if a run may have so many and no edit comes after it.
    ///
    /// # Errors
    /// If it may not, or one does.
    pub(super) fn whole(&self, script: &[TimedEdit]) -> Result<u64, Failed> {
        let (last, step) = (self.last_step(), self.scenario.step);
        if last > MAX_STEPS {
            let time = self.scenario.duration.unwrap_or(self.planned_time());
            return Err(Refusal::TooManySteps { time, step, steps: last }.into());
        }
        match script.iter().position(|e| e.step > last) {
            Some(late) => Err(Failed::at(
                late,
                Refusal::Task(format!("the run ends at step {last}: want an earlier one, or a longer duration")),
            )),
            None => Ok(last),
        }
    }
}

/// Places of edits in the order of their steps; those of one step stay in theirs.
pub(super) fn order_of(edits: &[TimedEdit]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..edits.len()).collect();
    order.sort_by_key(|i| edits[*i].step);
    order
}

/// Edits in the order of their steps; those of one step stay in theirs.
pub(super) fn in_order(edits: &[TimedEdit]) -> Vec<TimedEdit> {
    order_of(edits).into_iter().map(|i| edits[i].clone()).collect()
}

/// Runs a scenario, as edits at the start leave it, to a last step, with a script in order, and shows every frame. A task
/// that does not fit its machine is refused, or, with patience, waits at its first step.
pub(super) fn perform(
    scenario: &Scenario,
    script: &[TimedEdit],
    (end, patient): (impl FnOnce(&Run, &[TimedEdit]) -> Result<u64, Failed>, bool),
    known: Option<&Run>,
    mut see: impl FnMut(&Run, &Frame),
) -> Result<Run, Failed> {
    let (mut run, begun) = Run::begin(scenario, script, known)?;
    if let Some(waiting) = &run.waiting {
        if !patient {
            return Err(waiting.why.clone().into());
        }
        see(&run, &run.frame());
        return Ok(run);
    }
    let end = end(&run, script)?;
    let mut edits = script.iter().enumerate().skip(begun).peekable();
    loop {
        let step = run.simulation().step_count();
        while let Some((i, timed)) = edits.next_if(|(_, e)| e.step <= step) {
            run.apply(&timed.edit).map_err(|refusal| Failed::at(i, refusal))?;
        }
        let frame = run.frame();
        if !frame.is_finite() {
            return Err(Refusal::Diverged { time: frame.time }.into());
        }
        see(&run, &frame);
        if step >= end {
            return Ok(run);
        }
        run.advance();
    }
}
