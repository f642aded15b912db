//! A [`Run`]: a scenario in motion. Window and commands both use it, so their results cannot differ.

use std::sync::Arc;

use super::changes::{ScriptError, fold_start_edits};
use super::edit::{Edit, TimedEdit};
use super::planner::{Plan, momentum_model, plan, rays_from};
use super::refusal::Refusal;
use crate::assembly::SharedRun;
use crate::changes::{after_start_edit, changed, checked};
use crate::scenario::{MAX_STEPS, Scenario, UnfinishedDrawing};
use crate::whole_frame::WholeFrame;
use stillbase_mechanics::assembly::Block;
use stillbase_mechanics::machine::{Chain, Inertia};
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Pose2, Vector};
use stillbase_planning::Motion;
use stillbase_planning::following::follow::Bounds;
use stillbase_planning::following::{Follower, MomentumFollower, Pull};
use stillbase_planning::off_plane::momentum::TipFrame;
use stillbase_planning::off_plane::rays::Rays;
use stillbase_planning::pose_constant::{CommonB, PoseSpaceQuery};
use stillbase_planning::pose_space::{NoPoseSpace, Planes, PoseSpace};
use stillbase_planning::posture::GuidedSpace;
use stillbase_planning::reactionless::{BSet, Decimal};
use stillbase_query::{ByIdentity, Queries, QuickWork, Shared};
use stillbase_settings::key::Effect;
use stillbase_simulation::frame::Frame;
use stillbase_simulation::plant::BaseKind;
use stillbase_simulation::{Guide, Simulation};

/// Reason why a run waits: its task does not fit its machine, or its machine is not drawn to the end.
#[derive(Clone, Debug, PartialEq)]
pub struct WaitReason {
    /// Reason why the task cannot be planned.
    pub why: Refusal,
    /// Points that the b of the task does not reach: index, counted from A, and the nearest b that reaches the point,
    /// rad, as printed.
    pub points: Vec<(usize, Option<Decimal>)>,
}

impl WaitReason {
    fn of(scenario: &Scenario, space: Option<&PoseSpace>, why: Refusal) -> Self {
        let task = &scenario.task;
        let is_of_points = !matches!(why, Refusal::Unfinished(_));
        let Some(space) = space.filter(|_| is_of_points) else { return Self { why, points: Vec::new() } };
        let unserved = |(i, p): (usize, Vector)| {
            let nearest_b = || {
                let set = space.reach(p).ok()?;
                set.decimal(set.moved_inside(set.nearest(task.b)?, 1e-6), 4)
            };
            (!space.reaches(p, task.b)).then(|| (i, nearest_b()))
        };
        Self { why, points: task.points().into_iter().enumerate().filter_map(unserved).collect() }
    }
}

/// A scenario in motion.
#[derive(Clone, Debug)]
pub struct Run {
    scenario: Arc<Scenario>,
    /// The pose space, in which the user can drag the machine while b is held, or the reason why there is none.
    space: Result<Arc<PoseSpace>, NoPoseSpace>,
    plan: Arc<Plan>,
    /// Set if the task cannot be planned; the plan is then to stay at rest.
    waiting: Option<WaitReason>,
    simulation: Simulation,
    /// The other blocks of the assembly of which the machine is one.
    shared: Option<Box<SharedRun>>,
    /// Cache of queries about the run, which copies share.
    queries: Queries,
}

impl Run {
    /// Returns a run at rest at the start of the scenario's task. The caller applies the edits.
    ///
    /// # Errors
    /// If the task cannot be planned.
    pub fn new(scenario: &Scenario) -> Result<Self, Refusal> {
        Self::planned(scenario, &Queries::default())
    }

    /// Applies the edits at step 0 before the first drag. Returns a run at rest at the start of the task, and the
    /// number of these edits. The task is planned once after all of them, so intermediate states need not be feasible.
    /// Queries of a `known` run are reused.
    ///
    /// # Errors
    /// If an edit is out of range, or the scenario after the edits is not valid. If the task cannot be planned, the
    /// run waits.
    pub(super) fn begin(
        scenario: &Scenario,
        script: &[TimedEdit],
        known: Option<&Self>,
    ) -> Result<(Self, usize), ScriptError> {
        let queries = known.map_or_else(Queries::default, |run| run.queries.clone());
        let (start, count) = fold_start_edits(scenario, script, &queries)?;
        Ok((Self::patient(&start, &queries)?, count))
    }

    fn planned(scenario: &Scenario, queries: &Queries) -> Result<Self, Refusal> {
        let run = Self::patient(scenario, queries)?;
        match run.waiting {
            Some(waiting) => Err(waiting.why),
            None => Ok(run),
        }
    }

    /// Returns a run at rest at the start of the task. If the task cannot be planned, the run waits.
    fn patient(scenario: &Scenario, queries: &Queries) -> Result<Self, Refusal> {
        let space = space_of(scenario, queries);
        let known = space.as_deref();
        let planned = match scenario.unfinished() {
            Some(unfinished) => Err(unfinished.into()),
            None => plan(scenario, known),
        };
        let (plan, waiting) = match planned {
            Ok(plan) => (plan, None),
            Err(why) => (Plan::rest(scenario, known.ok()), Some(WaitReason::of(scenario, known.ok(), why))),
        };
        let guide = plan.guide(&scenario.machine);
        let simulation = Simulation::new(&scenario.setup(), guide)?;
        let shared = match &scenario.assembly {
            Some(block) => Some(Box::new(SharedRun::new(&block.followed(scenario), &simulation.frame(), queries)?)),
            None => None,
        };
        let (scenario, plan) = (Arc::new(scenario.clone()), Arc::new(plan));
        Ok(Self { scenario, space, plan, waiting, simulation, shared, queries: queries.clone() })
    }

    /// Returns the bound on |b̈| while b is slid, rad/s²; `None` without a pose constant.
    pub fn pose_bound(&self) -> Option<f64> {
        Some(bounds(&self.scenario, self.space.as_ref().ok()?).pose)
    }

    /// Returns the reason why the run waits, if its task does not fit its machine or the drawing is no machine yet.
    pub fn waiting(&self) -> Option<&WaitReason> {
        self.waiting.as_ref()
    }

    /// Returns what the drawing of the machine lacks, if the run waits for that. The machine of the scenario is then
    /// the one before.
    pub fn unfinished(&self) -> Option<&UnfinishedDrawing> {
        match &self.waiting.as_ref()?.why {
            Refusal::Unfinished(unfinished) => Some(unfinished),
            _ => None,
        }
    }

    /// Returns the scenario with all settings of its edits.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// Returns the scenario as a shared value.
    pub fn shared_scenario(&self) -> Shared<Scenario> {
        Shared(self.scenario.clone())
    }

    /// Returns the cache of queries about the run and its copies.
    pub fn queries(&self) -> &Queries {
        &self.queries
    }

    /// Returns the reactionless planes of the machine, if it has some.
    pub fn planes(&self) -> Option<&Arc<Planes>> {
        self.space.as_ref().ok()?.planes().ok()
    }

    /// Returns the pose space, in which the user can drag the machine while b is held.
    ///
    /// # Errors
    /// If there is none; the error is the reason.
    pub fn pose_space(&self) -> Result<&Arc<PoseSpace>, &NoPoseSpace> {
        self.space.as_ref()
    }

    /// Returns whether the user can lead the end effector: with b held, or at zero momentum on a machine without b.
    pub fn can_be_led(&self) -> bool {
        self.waiting.is_none() && (self.space.is_ok() || self.leads_without_b())
    }

    /// Returns whether a hand leads the machine at zero momentum: it has no b to hold, and three drives or more.
    fn leads_without_b(&self) -> bool {
        self.space.is_err() && self.scenario.machine.drives() > 2
    }

    /// Returns the set of b that reach all points of the task, if there are any.
    pub fn feasible_b(&self) -> Option<BSet> {
        let space = ByIdentity(self.space.clone().ok()?);
        self.queries.ask::<QuickWork<CommonB>>(&(space, self.scenario.task.points())).all.clone()
    }

    /// Returns the simulation.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// Returns the plan of the task.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Returns the rays of the end effector from the start of the plan, or of a waiting run from where it stands: how far
    /// zero momentum leads, and least momentum beyond.
    ///
    /// # Errors
    /// If its machine has none.
    pub fn rays(&self) -> Result<Rays, Refusal> {
        rays_from(&self.scenario, self.plan.motion.path.at(0.0).q)
    }

    /// Returns the run of a scenario, which waits if its task cannot be planned.
    ///
    /// # Errors
    /// If the scenario cannot be simulated.
    pub fn or_waiting(scenario: &Scenario) -> Result<Self, Refusal> {
        Self::patient(scenario, &Queries::default())
    }

    /// Returns the duration of the planned motion, s.
    pub fn planned_time(&self) -> f64 {
        self.plan.motion.duration()
    }

    /// Returns the number of steps of the planned motion, rounded up; in an assembly, of the block with the longest one.
    pub fn planned_steps(&self) -> f64 {
        (self.whole_time() / self.scenario.step).ceil()
    }

    /// Returns the place of the end effector in a pose, m.
    pub fn end_effector_at(&self, q: &DriveAngles) -> Vector {
        stillbase_mechanics::kinematics::end_effector(self.scenario.machine.end_effector(), &q.units())
    }

    /// Returns the place of the end effector after a fraction of the planned time, m.
    pub fn end_effector_on_path(&self, share: f64) -> Vector {
        self.plan.place(&self.scenario.machine, self.plan.motion.profile.at(share * self.planned_time()).s)
    }

    /// Returns the planned motion, while the machine follows it.
    pub fn motion(&self) -> Option<&Motion> {
        match self.simulation.guide() {
            Guide::Motion { motion, .. } => Some(&**motion),
            Guide::Follow(_) | Guide::Lead(_) => None,
        }
    }

    /// Returns the planned motion, while the machine follows it, as a shared value.
    pub fn shared_motion(&self) -> Option<ByIdentity<Motion>> {
        match self.simulation.guide() {
            Guide::Motion { motion, .. } => Some(ByIdentity(motion.clone())),
            Guide::Follow(_) | Guide::Lead(_) => None,
        }
    }

    /// Returns the frame of the present step.
    pub fn frame(&self) -> Frame {
        let frame = self.simulation.frame();
        match &self.shared {
            Some(shared) => shared.in_space(shared.block().block, frame),
            None => frame,
        }
    }

    /// Returns the other blocks of the assembly of which the machine is one.
    pub fn shared(&self) -> Option<&SharedRun> {
        self.shared.as_deref()
    }

    /// Advances by one step.
    pub fn advance(&mut self) {
        self.simulation.advance();
        if let Some(shared) = &mut self.shared {
            shared.advance(&self.simulation.frame());
        }
    }

    /// Returns the duration of the planned motion, s; in an assembly, that of the block with the longest one.
    pub fn whole_time(&self) -> f64 {
        let Some(shared) = &self.shared else { return self.planned_time() };
        // Other blocks that were led by hand go on as long as that took.
        let led = self.scenario.duration.filter(|_| shared.has_edits()).unwrap_or(0.0);
        self.planned_time().max(shared.planned_time()).max(led)
    }

    /// Returns whether everything is at rest, and stays so.
    pub fn is_settled(&self) -> bool {
        self.simulation.is_settled() && self.shared.as_ref().is_none_or(|shared| shared.is_settled())
    }

    /// Applies an edit at the present step.
    ///
    /// # Errors
    /// If it cannot apply; then nothing has changed.
    pub fn apply(&mut self, edit: &Edit) -> Result<(), Refusal> {
        if edit.affects_no_frame() {
            self.scenario = Arc::new(checked(changed(&self.scenario, edit)?, edit)?);
            return Ok(());
        }
        if self.is_untouched() && !edit.acts_in_motion() {
            let scenario = checked(after_start_edit(&self.scenario, edit, &self.queries)?, edit)?;
            *self = Self::planned(&scenario, &self.queries)?;
            return Ok(());
        }
        edit.check()?;
        match edit {
            Edit::DragTarget { x, y } if self.leads_without_b() => {
                let mut follower = match self.simulation.guide() {
                    Guide::Lead(follower) => follower.clone(),
                    _ => momentum_follower(&self.scenario, &self.simulation),
                };
                follower.set_target(Vector::new(*x, *y));
                self.simulation.set_guide(Guide::Lead(follower));
            }
            Edit::DragTarget { x, y } => {
                let frame = self.frame();
                let mut follower = self.follower()?;
                let at = Vector::new(*x, *y);
                follower.set_target(if frame.floats { frame.in_base(at) } else { at });
                self.simulation.set_guide(Guide::Follow(follower));
            }
            Edit::DragBlocks { targets } => {
                let Some(shared) = &self.shared else {
                    return Err(Refusal::Task("drag-blocks leads blocks of an assembly: want drag-target".into()));
                };
                shared.check_targets(targets)?;
                if let Some([x, y]) = targets.get(shared.block().name()) {
                    let mut follower = self.follower()?;
                    follower.set_target(Vector::new(*x, *y));
                    self.simulation.set_guide(Guide::Follow(follower));
                }
            }
            Edit::HandOver { from, to } => {
                let Some(shared) = &mut self.shared else {
                    return Err(Refusal::Task("hand-over is for blocks of an assembly: want plant.payload".into()));
                };
                shared.hand_over(from, to)?;
            }
            Edit::DragAngles { a1, a2 } => {
                let mut follower = self.follower()?;
                if follower.aim().len() != 2 {
                    return Err(Refusal::Task(ANGLES_OF_THREE.into()));
                }
                follower.set_angles(&PerDrive::from([*a1, *a2]));
                self.simulation.set_guide(Guide::Follow(follower));
            }
            Edit::PullLink { link, along, x, y } => {
                let chain = self.point_of(link, *along)?;
                let mut follower = self.follower()?;
                if !follower.map().leaves_freedoms() {
                    return Err(Refusal::Task(NO_FREEDOMS.into()));
                }
                follower.set_pull(Pull { chain, at: Vector::new(*x, *y) });
                self.simulation.set_guide(Guide::Follow(follower));
            }
            Edit::SlideB { b } => {
                let mut follower = self.follower()?;
                follower.set_b(*b);
                self.simulation.set_guide(Guide::Follow(follower));
            }
            Edit::PoseB { b } => {
                let mut follower = self.follower()?;
                follower.pose_at(*b);
                self.simulation.move_to_reference(Guide::Follow(follower));
            }
            // No motion depends on this edit.
            edit if edit.effect() == Effect::Picture => {
                self.scenario = Arc::new(checked(changed(&self.scenario, edit)?, edit)?)
            }
            Edit::Push { .. } | Edit::Set { .. } | Edit::Sketch(_) => self.set(edit)?,
        }
        if let Some(shared) = &mut self.shared {
            shared.follow(edit)?;
            shared.see(&self.simulation.frame());
        }
        Ok(())
    }

    /// Adopts those settings of a scenario on which no frame depends.
    pub(super) fn set_asides(&mut self, scenario: &Scenario) -> Result<(), Refusal> {
        self.scenario = Arc::new(self.scenario.with_asides_of(scenario)?);
        Ok(())
    }

    /// Returns whether the planned motion has not begun.
    fn is_untouched(&self) -> bool {
        self.simulation.step_count() == 0 && matches!(self.simulation.guide(), Guide::Motion { .. })
    }

    /// Changes settings during a motion, which keeps its path.
    fn set(&mut self, edit: &Edit) -> Result<(), Refusal> {
        if edit.changes_plan() {
            return Err(Refusal::Task(Edit::START_ONLY_REASON.into()));
        }
        let scenario = checked(changed(&self.scenario, edit)?, edit)?;
        if let Some((key, value)) = edit.limits().filter(|_| self.leaves_limits(&scenario)) {
            return Err(Refusal::LeavesLimits { key, value });
        }
        let mut simulation = self.simulation.clone();
        simulation.reconfigure(&scenario.setup())?;
        let bound = scenario.pose_acceleration != self.scenario.pose_acceleration;
        let is_new_model = scenario.machine != self.scenario.machine || scenario.base != self.scenario.base;
        if let Guide::Lead(old) = self.simulation.guide()
            && is_new_model
        {
            let mut follower = momentum_follower(&scenario, &simulation);
            follower.set_target(old.target().at);
            simulation.set_guide(Guide::Lead(follower));
        }
        if scenario.machine != self.scenario.machine || bound {
            let space = space_of(&scenario, &self.queries);
            if let Guide::Follow(old) = self.simulation.guide() {
                let map = space.clone()?;
                let bounds = bounds(&scenario, &map);
                let lambda = *map.lambda();
                let mut follower = Follower::new(map, bounds, scenario.step, self.simulation.reference());
                follower.set_target(old.target().at);
                // If λ has changed, b is a different quantity.
                if lambda == *old.map().lambda() {
                    follower.set_b(old.b_aim());
                }
                simulation.set_guide(Guide::Follow(follower));
            }
            self.space = space;
        }
        self.simulation = simulation;
        self.scenario = Arc::new(scenario);
        Ok(())
    }

    /// Returns whether any of 65 poses on the rest of the planned motion keeps the present joint limits but exceeds
    /// the new ones.
    fn leaves_limits(&self, changed: &Scenario) -> bool {
        let Guide::Motion { motion, start, .. } = self.simulation.guide() else { return false };
        let done = motion.profile.at(self.simulation.time() - start).s;
        (0..=64).map(|i| done + (1.0 - done) * f64::from(i) / 64.0).any(|s| {
            let q = motion.path.at(s).q;
            let keeps =
                |scenario: &Scenario| scenario.machine.angles().iter().all(|angle| angle.past_limit(&q) <= 1e-9);
            keeps(&self.scenario) && !keeps(changed)
        })
    }

    /// Returns the chain from the base to a point of a link, `along` m from its root.
    fn point_of(&self, link: &str, along: f64) -> Result<Chain, Refusal> {
        let machine = &self.scenario.machine;
        let found = machine.spec().link_index(link);
        let names = || machine.links().iter().map(|own| own.name.as_str()).collect::<Vec<_>>().join(", ");
        let found = found.ok_or_else(|| Refusal::Task(format!("no link {link:?}: want one of {}", names())))?;
        Ok(machine.resolved_links()[found].point(along))
    }

    /// Returns the present follower, or a new one that takes over from the planned motion.
    fn follower(&self) -> Result<Follower, Refusal> {
        match self.simulation.guide() {
            Guide::Follow(follower) => Ok(follower.clone()),
            Guide::Motion { .. } | Guide::Lead(_) => {
                let map = self.space.clone()?;
                let bounds = bounds(&self.scenario, &map);
                Ok(Follower::new(map, bounds, self.scenario.step, self.simulation.reference()))
            }
        }
    }
}

impl Run {
    /// Returns the edit that undoes an edit if applied after it, or `None` if there is no such edit. Has to be called
    /// before the edit is applied.
    pub fn inverse_of(&self, edit: &Edit) -> Option<Edit> {
        let scenario = &self.scenario;
        let frame = self.frame();
        let b_aim = || match self.simulation.guide() {
            Guide::Follow(follower) => follower.b_aim(),
            Guide::Motion { .. } | Guide::Lead(_) => frame.b_reference,
        };
        Some(match edit {
            Edit::DragTarget { .. } => Edit::DragTarget { x: frame.target.at.re, y: frame.target.at.im },
            Edit::DragBlocks { targets } => {
                let shared = self.shared.as_ref()?;
                let blocks = shared.block().scenario.assembly.blocks();
                let whole = WholeFrame::of(self, &frame);
                let present = |(i, block): (usize, &Block)| {
                    let at = whole.frame(i).target.at;
                    targets.contains_key(&block.name).then(|| (block.name.clone(), [at.re, at.im]))
                };
                Edit::DragBlocks { targets: blocks.iter().enumerate().filter_map(present).collect() }
            }
            Edit::HandOver { .. } => edit.clone(),
            Edit::DragAngles { .. } => {
                let planes = self.planes()?;
                let [a1, a2] = match self.simulation.guide() {
                    Guide::Follow(follower) => [follower.aim()[0], follower.aim()[1]],
                    Guide::Motion { .. } | Guide::Lead(_) => planes.map().project(&self.simulation.reference().q).a,
                };
                Edit::DragAngles { a1, a2 }
            }
            Edit::PullLink { link, along, .. } => {
                let chain = self.point_of(link, *along).ok()?;
                let at = stillbase_mechanics::kinematics::end_effector(&chain, &self.simulation.reference().q.units());
                Edit::PullLink { link: link.clone(), along: *along, x: at.re, y: at.im }
            }
            Edit::SlideB { .. } => Edit::SlideB { b: b_aim() },
            Edit::PoseB { .. } => Edit::PoseB { b: b_aim() },
            Edit::Push { .. } => Edit::Push { x: scenario.plant.force[0], y: scenario.plant.force[1] },
            Edit::Set { change } => Edit::Set { change: scenario.present_values(change)? },
            Edit::Sketch(_) => return None,
        })
    }
}

/// Returns a follower at zero momentum that takes over from a simulation. A free base need not point where it started.
fn momentum_follower(scenario: &Scenario, simulation: &Simulation) -> MomentumFollower {
    let reference = simulation.reference();
    let anchor = if scenario.base.kind == BaseKind::Free { simulation.frame().base } else { Pose2::default() };
    let model = Arc::new(momentum_model(scenario, &reference.q, TipFrame::Space));
    MomentumFollower::new(model, &scenario.machine, anchor, scenario.step, reference)
}

/// Refusal to drag relative angles of machines that do not have three drives.
const ANGLES_OF_THREE: &str =
    "two relative angles are set for machines of three drives: want the target dragged instead";

/// Refusal to pull a link of machines without freedoms while the end effector and b are held.
const NO_FREEDOMS: &str =
    "with the end effector and b held, fewer than four drives cannot move: want the target dragged instead";

/// Returns bounds of the follower on |ä| and |b̈|, rad/s². Within them no torque exceeds its limit, for any direction
/// of ä and also while b changes.
fn bounds(scenario: &Scenario, map: &PoseSpace) -> Bounds {
    // Upper bound of |ä|, also without torque limits.
    const MAX_ACCELERATION_RAD_S2: f64 = 30.0;
    // Maximum fraction of a torque limit that a change of b may use.
    const MAX_SLIDE_FRACTION: f64 = 0.5;
    let machine = &scenario.machine;
    let inertia = Inertia::of(machine);
    // Torque of each motor, also through gears, for accelerations of the relative angles and of b. Couplings are
    // omitted: on a machine with a pose constant they are only rounding errors.
    let torques_of = |of: &PerDrive, bdd: f64| {
        let (n, u) = (machine.drives(), map.lift_rates(of, bdd));
        let h = PerDrive::from_fn(n, |k| (0..n).map(|l| inertia.constant(k, l) * u[l]).sum());
        inertia.motors().motor_torques(&h)
    };
    let one = |of: usize| PerDrive::from_fn(map.joints().len(), |i| f64::from(u8::from(i == of)));
    let all: Vec<PerDrive> = (0..map.joints().len()).map(|of| torques_of(&one(of), 0.0)).collect();
    let sliding = torques_of(&PerDrive::zeros(map.joints().len()), 1.0);
    let limits = || machine.spec().drives.iter().enumerate().filter_map(|(k, drive)| Some((k, drive.torque_limit?)));
    let pose = limits()
        .map(|(k, limit)| MAX_SLIDE_FRACTION * limit / sliding[k].abs())
        .fold(scenario.pose_acceleration, f64::min);
    let largest = |k: usize| all.iter().fold(0.0, |sum: f64, torque| sum.hypot(torque[k]));
    let joint = |(k, limit): (usize, f64)| (limit - pose * sliding[k].abs()) / largest(k).max(1e-9);
    Bounds { joint: limits().map(joint).fold(MAX_ACCELERATION_RAD_S2, f64::min), pose }
}

impl Run {
    /// Returns the step at the end of the scenario's duration or, without one, of the planned motion.
    pub fn last_step(&self) -> u64 {
        let step = self.scenario.step;
        match self.scenario.duration {
            Some(duration) => (duration / step).round() as u64,
            // Rounded up, so that a motion that ends between two steps is complete.
            None => (self.whole_time() / step - 1e-6).ceil() as u64,
        }
    }

    /// Returns the last step, if it is not too late and no edit comes after it.
    ///
    /// # Errors
    /// If it is later than [`MAX_STEPS`], or an edit comes after it.
    pub(super) fn checked_last_step(&self, script: &[TimedEdit]) -> Result<u64, ScriptError> {
        let (last, step) = (self.last_step(), self.scenario.step);
        if last > MAX_STEPS {
            let time = self.scenario.duration.unwrap_or(self.whole_time());
            return Err(Refusal::TooManySteps { time, step, steps: last }.into());
        }
        match script.iter().position(|e| e.step > last) {
            Some(late) => Err(ScriptError::at(
                late,
                Refusal::Task(format!("the run ends at step {last}: want an earlier one, or a longer duration")),
            )),
            None => Ok(last),
        }
    }
}

/// Returns the pose space of a scenario's machine. Drags in it follow the posture of the task and its rule on change
/// points.
fn space_of(scenario: &Scenario, queries: &Queries) -> Result<Arc<PoseSpace>, NoPoseSpace> {
    let task = &scenario.task;
    let space = Result::clone(&queries.ask::<QuickWork<PoseSpaceQuery>>(&scenario.machine))?;
    let guided = (ByIdentity(space), scenario.machine.clone(), task.posture, task.keep_off_change_points);
    Ok(Arc::clone(&queries.ask::<QuickWork<GuidedSpace>>(&guided)))
}
