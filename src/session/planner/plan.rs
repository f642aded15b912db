//! [`Plan`]: a planned task, and the forecast of its motion.

use std::sync::Arc;

use crate::Refusal;
use crate::scenario::Scenario;
use stillbase_mechanics::arm_on_base::ArmOnBase;
use stillbase_mechanics::dynamics::ExternalLoads;
use stillbase_mechanics::kinematics::end_effector;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Pose2, Vector, unit};
use stillbase_planning::curves::Path;
use stillbase_planning::off_plane::Price;
use stillbase_planning::off_plane::base_forecast::BaseForecast;
use stillbase_planning::off_plane::least_reaction::Verdicts;
use stillbase_planning::off_plane::momentum::MomentumModel;
use stillbase_planning::pose_space::{NoPoseSpace, PoseSpace};
use stillbase_planning::timing::limits::DriveLimit;
use stillbase_planning::timing::{DriveLimits, TimeLaw};
use stillbase_planning::{Forecast, Motion};
use stillbase_simulation::Guide;
use stillbase_simulation::plant::{Base, BaseKind};

/// The pose space of a machine, or the reason why its b cannot be held.
pub(super) type PlannerSpace<'a> = Result<&'a PoseSpace, &'a NoPoseSpace>;

/// Effort spent on the search for a path and for proposals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum PlanningEffort {
    /// Quick search without proposals, for a task that is itself a proposal on trial.
    Trial,
    /// Full search, with proposals if it fails.
    Whole,
}

/// A planned task.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Motion that the machine is to follow.
    pub motion: Arc<Motion>,
    /// Forecast torques, speeds and reactions of the motion.
    pub forecast: Forecast,
    /// For the fastest laws: duration, its lower bound, and the limit that holds the motion back.
    pub pace: Option<TimingBottleneck>,
    /// For a change of b: the reaction that it costs.
    pub price: Option<Price>,
    /// For the least reaction: comparison with a fixed b and with the minimum norm.
    pub verdicts: Option<Verdicts>,
    /// For motions of zero momentum: drive angles at the start and after each cycle, rad. For closed paths of four
    /// drives and more that do not close in joint space: drive angles at the start and at the end.
    pub cycles: Vec<DriveAngles>,
    /// The arm beside its free base, which places it in space, if the plan accounts for how the base shifts; otherwise
    /// it takes the base to stand still.
    pub beside_base: Option<Arc<MomentumModel>>,
    /// How that base turns, if the plan lets it.
    pub base_turn: Option<Arc<BaseForecast>>,
    /// For a loop that turns the base: its length in drive angles, rad.
    pub loop_length: Option<f64>,
    /// Duration with blended corners, s, if stops at the corners are faster; the motion then stops.
    pub blended: Option<f64>,
}

/// A closed path closes in joint space if no drive ends farther from its start than this, rad.
const CLOSURE_TOLERANCE_RAD: f64 = 1e-6;

/// Duration of the fastest motion, and the limit that determines it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TimingBottleneck {
    /// Duration T, s.
    pub time: f64,
    /// Least time T* without limits on jerk, s, if the law has such limits and T* is known.
    pub unlimited: Option<f64>,
    /// Limit that is active for the longest time in the first part of the path that has any active limit.
    pub leading: Option<DriveLimit>,
}

impl TimingBottleneck {
    /// Returns T/T* − 1, with T* the least time without limits on jerk. Returns `None` without such limits, and if they
    /// alone limit the motion.
    pub fn gap(&self) -> Option<f64> {
        self.unlimited.filter(|least| *least > 0.0).map(|least| (self.time / least - 1.0).max(0.0))
    }
}

impl Plan {
    /// Returns for each cycle the largest |Δq_k| between the start of the motion and the end of the cycle, rad.
    pub fn drift(&self) -> impl Iterator<Item = f64> {
        let first = self.cycles.first();
        self.cycles.iter().skip(1).filter_map(move |q| Some(q.0.minus(&first?.0).max_abs()))
    }

    /// Returns where the plan has the end effector of its machine at s of its path, 0 to 1, m, in space.
    pub fn place(&self, machine: &Machine, s: f64) -> Vector {
        let q = self.motion.path.at(s).q;
        match &self.beside_base {
            Some(model) => model.place_turned(&q, self.turn_at(s)),
            None => end_effector(machine.end_effector(), &q.units()),
        }
    }

    /// Returns by how much the plan has turned its base at s of its path, 0 to 1, rad.
    fn turn_at(&self, s: f64) -> f64 {
        self.base_turn.as_ref().map_or(0.0, |turn| turn.angle_at(s))
    }

    /// Returns the plan as the guide of a simulation.
    pub fn guide(&self, machine: &Machine) -> Guide {
        let seen = end_effector(machine.end_effector(), &self.motion.path.at(1.0).q.units());
        let angle = self.turn_at(1.0);
        let base_end =
            self.beside_base.is_some().then(|| Pose2 { at: self.place(machine, 1.0) - unit(angle) * seen, angle });
        Guide::Motion { motion: self.motion.clone(), start: 0.0, base_end }
    }

    /// Returns a plan at rest for a run that waits. The pose is one of A, at the b of the task or otherwise at the
    /// nearest b, or the one that the task states. If no b reaches A, the joints are in the middle of their ranges;
    /// without coordinates (a, b), q = 0.
    pub fn rest(scenario: &Scenario, space: Option<&PoseSpace>) -> Self {
        let (task, machine) = (&scenario.task, &scenario.machine);
        let p = task.points()[0];
        let stated = task.start_pose(machine.drives());
        let at_b = || space.and_then(|space| space.pose_at(p, task.b));
        let q = stated.or_else(at_b).unwrap_or_else(|| match PoseSpace::nominal(machine) {
            Ok(space) => space.pose_at_nearest_b(p, task.b).unwrap_or_else(|| space.lift(&space.middle(), task.b)),
            Err(_) => DriveAngles(PerDrive::zeros(machine.drives())),
        });
        let path = Path::JointLine { from: q, to: q };
        Self::of(scenario, Motion::new(path, TimeLaw::Quintic, task.time))
    }

    pub(super) fn of(scenario: &Scenario, motion: Motion) -> Self {
        let forecast = Forecast::of(&motion, &arm_on_base(scenario), &DriveLimits::of(&scenario.machine));
        let ends = [0.0, motion.duration()].map(|t| motion.at(t).q);
        let mut plan = Self::foreseen(motion, forecast);
        let is_closed = scenario.task.closed && scenario.condition_for_effect("task.posture").is_none();
        if is_closed && ends[1].0.minus(&ends[0].0).max_abs() > CLOSURE_TOLERANCE_RAD {
            plan.cycles = ends.to_vec();
        }
        plan
    }

    /// Returns a plan of a motion with its forecast and no other results.
    pub(super) fn foreseen(motion: Motion, forecast: Forecast) -> Self {
        Self {
            motion: Arc::new(motion),
            forecast,
            pace: None,
            price: None,
            verdicts: None,
            cycles: Vec::new(),
            beside_base: None,
            base_turn: None,
            loop_length: None,
            blended: None,
        }
    }
}

/// Refuses a motion that passes a joint limit, or a change point if the task forbids these. Planning by joint rates
/// checks neither.
pub(super) fn keeps_rules(scenario: &Scenario, motion: &Motion) -> Result<(), Refusal> {
    const MIN_SAMPLES: usize = 1000;
    let samples = (100 * motion.path.parts()).clamp(MIN_SAMPLES, 100_000);
    let mut last: Option<DriveAngles> = None;
    for i in 0..=samples {
        let s = i as f64 / samples as f64;
        let q = motion.path.at(s).q;
        let before = last.replace(q).filter(|_| scenario.task.keep_off_change_points);
        for (k, l) in Inertia::pairs(q.len()) {
            let side = |q: &DriveAngles| (q[k] - q[l]).sin();
            if before.is_some_and(|before| side(&before) * side(&q) < 0.0) {
                return Err(Refusal::NoWay(format!(
                    "{:.1} % along, drives {} and {} become parallel, a change point: want another path or b, or \
                     keep_off_change_points = false",
                    100.0 * s,
                    k + 1,
                    l + 1,
                )));
            }
        }
        for (k, angle) in scenario.machine.angles().iter().enumerate() {
            if angle.past_limit(&q) > 1e-6 {
                let posture = match scenario.condition_for_effect("task.posture") {
                    None if scenario.task.start.is_some() => "another start, ",
                    None => "another posture, ",
                    Some(_) => "",
                };
                return Err(Refusal::NoWay(format!(
                    "{:.1} % along, a{} would pass its {} limit: want another path, another b, {posture}or wider limits",
                    100.0 * s,
                    k + 1,
                    if angle.value(&q) > *angle.limits.end() { "upper" } else { "lower" },
                )));
            }
        }
    }
    Ok(())
}

/// Returns the machine that control assumes on its base, without a force at the end effector. A compliant base is taken
/// to stand still.
pub fn arm_on_base(scenario: &Scenario) -> ArmOnBase {
    carried(&scenario.machine, &scenario.base)
}

/// Returns a machine on a base, as [`arm_on_base`].
pub(crate) fn carried(machine: &Machine, base: &Base) -> ArmOnBase {
    let arm = Inertia::of(machine);
    let free = match base.kind {
        BaseKind::Free if base.floats() => ArmOnBase::floating(arm.clone(), &base.body()).ok(),
        BaseKind::Free => ArmOnBase::held(arm.clone(), &base.body()).ok(),
        BaseKind::Fixed | BaseKind::Compliant => None,
    };
    // A machine of too many drives for a free base is refused before a run begins.
    free.unwrap_or_else(|| {
        let around = ExternalLoads { gravity: machine.gravity(), force: Vector::default() };
        ArmOnBase::fixed(arm, &around)
    })
}
