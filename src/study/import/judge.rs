//! Assessment of motions of a machine by their reactions, and the check that a proposed motion has none.

use schemars::JsonSchema;
use serde::Serialize;

use super::given::GivenMotion;
use crate::advice::{Advice, Remedy};
use stillbase_mechanics::arm_on_base::ArmOnBase;
use stillbase_mechanics::dynamics::angular_momentum;
use stillbase_mechanics::machine::Machine;
use stillbase_planning::Motion;
use stillbase_planning::curves::Coordinates;
use stillbase_planning::following::nearest::Deviation;
use stillbase_planning::forecast::Forecast;
use stillbase_planning::off_plane::base_forecast::BaseForecast;
use stillbase_planning::pose_space::{NoPoseSpace, PoseSpace};
use stillbase_planning::timing::DriveLimits;
use stillbase_query::{ProgressCallback, part};
use stillbase_session::scenario::{Scenario, Task, TaskKind};
use stillbase_session::{Refusal, Run, arm_on_base, replay_while};

/// Fraction of the work for simulating a proposal; the rest is its assessment.
const SIMULATION_SHARE: f64 = 0.8;

/// Assessment of a motion that is followed exactly.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct MotionEffects {
    /// Largest |n_B|, N m.
    pub peak_base_moment: f64,
    /// Root mean square of n_B, N m.
    pub rms_base_moment: f64,
    /// ∫ |n_B| dt, N m s.
    pub moment_impulse: f64,
    /// Largest dynamic |f_B|, N.
    pub peak_base_force: f64,
    /// Root mean square of the dynamic |f_B|, N.
    pub rms_base_force: f64,
    /// Largest angle of a base that floats, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peak_base_turn: Option<f64>,
    /// Angle by which a base that floats turns from start to end, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub base_turn: Option<f64>,
    /// Largest |torque| of each motor, N m.
    pub peak_torque: Vec<f64>,
    /// Largest |rate| of each motor, rad/s.
    pub peak_speed: Vec<f64>,
    /// The limit of a drive that is exceeded most, and the ratio of the peak to it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub over: Option<(String, f64)>,
    /// Largest violation of the limits of a relative angle, rad; 0 if there is none.
    pub past_limits: f64,
    /// Smallest and largest b along the motion, rad.
    pub b_range: [f64; 2],
    /// Mean of b over time, rad.
    pub b_mean: f64,
    /// Angular momentum about B at the start, kg m²/s.
    pub angular_momentum_start: f64,
    /// Angular momentum about B at the end, kg m²/s.
    pub angular_momentum_end: f64,
    /// Largest |q̇_k| at the end, rad/s.
    pub speed_end: f64,
    /// Samples of n_B over time, for drawing: s and N m.
    #[serde(skip)]
    pub moment: Vec<[f64; 2]>,
}

/// A proposed motion, simulated.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Proposal {
    /// Method by which it was found: `same-tip`, `turned`, `on-plane`, `as-given` or `zero-momentum`.
    pub way: &'static str,
    /// Reason for choosing this motion, in words.
    pub why: String,
    /// Mean pose constant, rad; it varies along a motion by `zero-momentum`.
    pub b: f64,
    /// Largest distance of the end effector from the given motion, m.
    pub tip_deviation: f64,
    /// Largest deviation of each drive from the given motion, rad.
    pub joint_deviation: Vec<f64>,
    /// Deviation in the metric of kinetic energy, root mean square over time and drives, rad.
    pub rms_deviation: f64,
    /// Assessment of the motion if it is followed exactly.
    #[serde(flatten)]
    pub account: MotionEffects,
    /// Largest |n_B| in the simulation, N m.
    pub simulated_peak_base_moment: f64,
    /// Largest dynamic |f_B| in the simulation, N.
    pub simulated_peak_base_force: f64,
    /// Whether the simulated motion is reactionless.
    pub reactionless: bool,
    /// Whether the base feels no moment in the simulation. That is true of reactionless motions, too.
    pub turns_no_base: bool,
}

/// Number of intervals at which n_B is sampled for drawing.
const DRAWN_INTERVALS: usize = 240;

/// A candidate for the proposal.
pub(super) struct MotionCandidate {
    pub method: &'static str,
    pub why: String,
    pub task: Task,
}

/// The given motion and its assessment.
pub(super) struct AssessedMotion {
    pub motion: Motion,
    pub account: MotionEffects,
}

/// A machine with everything needed to assess its motions.
pub(super) struct MotionEvaluator {
    /// The scenario; its task is not used.
    pub scenario: Scenario,
    pub machine: Machine,
    pub arm: ArmOnBase,
    pub space: Result<PoseSpace, NoPoseSpace>,
    pub instants: usize,
}

impl MotionEvaluator {
    /// Builds the evaluator of a scenario's machine, which evaluates motions at a number of instants.
    pub fn new(scenario: &Scenario, instants: usize) -> Self {
        let scenario = Scenario { compare_b: None, edits: Vec::new(), ..scenario.clone() };
        let machine = scenario.machine.clone();
        Self { arm: arm_on_base(&scenario), space: PoseSpace::of(&machine), instants, scenario, machine }
    }

    /// Returns n_B at the instants for drawing, s, N m.
    fn moment(&self, motion: &Motion) -> Vec<[f64; 2]> {
        let at = |i: usize| {
            let t = motion.duration() * i as f64 / DRAWN_INTERVALS as f64;
            let r = motion.at(t);
            let (_, wrench) = self.arm.dynamics(&r.q.units(), &r.qd, &r.qdd);
            [t, wrench.total().moment + 0.0]
        };
        (0..=DRAWN_INTERVALS).map(at).collect()
    }

    fn past_limits(&self, motion: &Motion) -> f64 {
        let past = |i: usize| {
            let q = motion.path.at(i as f64 / self.instants as f64).q;
            self.machine.angles().iter().map(|angle| angle.past_limit(&q)).fold(0.0, f64::max)
        };
        let most = (0..=self.instants).map(past).fold(0.0, f64::max);
        // Violations within rounding are treated as zero.
        if most > 1e-6 { most } else { 0.0 }
    }

    /// Assesses a motion.
    fn account(&self, motion: &Motion, goes_on: ProgressCallback<'_>) -> MotionEffects {
        let limits = DriveLimits::of(&self.machine);
        let f = Forecast::at_while(motion, &self.arm, &limits, self.instants, goes_on);
        let ends = [0.0, motion.duration()].map(|t| motion.at(t));
        let turn = BaseForecast::of(&self.arm, motion);
        let [start, end] = [0, 1].map(|i| angular_momentum(self.arm.arm(), &ends[i].q.units(), &ends[i].qd) + 0.0);
        MotionEffects {
            peak_base_moment: f.moment,
            rms_base_moment: f.moment_rms,
            moment_impulse: f.impulse,
            peak_base_force: f.force,
            rms_base_force: f.force_rms,
            peak_base_turn: turn.as_ref().map(|turn| turn.angle),
            base_turn: turn.map(|turn| turn.angle_end),
            peak_torque: f.torque.to_vec(),
            peak_speed: f.speed.to_vec(),
            over: f.exceeded_limit.map(|(limit, factor)| (limit.to_string(), factor)),
            past_limits: self.past_limits(motion),
            b_range: f.b,
            b_mean: f.b_mean,
            angular_momentum_start: start,
            angular_momentum_end: end,
            speed_end: ends[1].qd.max_abs(),
            moment: self.moment(motion),
        }
    }
}

impl MotionEvaluator {
    /// Returns a given motion with its assessment.
    pub fn given(&self, motion: Motion, goes_on: ProgressCallback<'_>) -> AssessedMotion {
        AssessedMotion { account: self.account(&motion, goes_on), motion }
    }

    /// Checks that a task can be planned.
    ///
    /// The error says why it cannot.
    pub fn plans(&self, task: &Task) -> Result<(), String> {
        let own = Scenario { task: task.clone(), ..self.scenario.clone() };
        Run::new(&own).map(|_| ()).map_err(|refusal| refusal.to_string())
    }

    /// Returns a scenario that runs a task with an integration step, s.
    pub fn scenario(&self, task: Task, step: f64, way: &str) -> Scenario {
        let title = format!("{} · {way}", self.scenario.title);
        Scenario { task, step, title, ..self.scenario.clone() }
    }

    /// Returns a scenario that runs a given motion; for samples of the end effector, with minimum-norm rates from the
    /// pose at b, rad. `None` if the samples give no valid task.
    pub fn as_given(&self, motion: &GivenMotion, b: f64, step: f64) -> Option<Scenario> {
        let sampled = |kind, b| Task::sampled(kind, motion.samples.clone(), Some(b), &self.machine).ok();
        let task = match motion.coordinates {
            Coordinates::Drives => {
                let b = self.arm.arm().lambda().dot(motion.samples.values(0));
                sampled(TaskKind::Given, b).map(|task| Task { b, ..task })
            }
            Coordinates::EndEffector => sampled(TaskKind::MinimumNorm, b),
        };
        let own = self.scenario(task?, step, "as given");
        Some(Scenario { name: format!("{}-given", own.name), ..own })
    }

    /// Plans, simulates and assesses a candidate. Calls `goes_on` with the fraction done, from 0 to 1, and stops if it
    /// returns `false`.
    ///
    /// The error says why the candidate cannot be run.
    pub fn proposal(
        &self,
        candidate: &MotionCandidate,
        scenario: &Scenario,
        given: Option<&AssessedMotion>,
        goes_on: ProgressCallback<'_>,
    ) -> Result<Proposal, Refusal> {
        let run = replay_while(scenario, |run, frame| goes_on(SIMULATION_SHARE * frame.time / run.planned_time()))?;
        let peaks = run.frame().peaks;
        let (motion, tip) = (&run.plan().motion, self.machine.end_effector());
        let deviation = given.map(|AssessedMotion { motion: given, .. }| {
            Deviation::between(tip, self.arm.arm(), given, motion, self.instants)
        });
        let account = self.account(motion, &mut part(goes_on, [SIMULATION_SHARE, 1.0]));
        Ok(Proposal {
            way: candidate.method,
            why: candidate.why.clone(),
            b: account.b_mean,
            tip_deviation: deviation.as_ref().map_or(0.0, |d| d.end_effector),
            joint_deviation: deviation.as_ref().map_or_else(Vec::new, |d| d.joints.to_vec()),
            rms_deviation: deviation.as_ref().map_or(0.0, |d| d.rms),
            account,
            simulated_peak_base_moment: peaks.arm_moment,
            simulated_peak_base_force: peaks.force,
            reactionless: peaks.is_reactionless(),
            turns_no_base: peaks.turns_no_base(),
        })
    }

    /// Returns the reason that the proposal is not reactionless despite its constant b, with a remedy.
    pub fn why_not_reactionless(&self, proposal: &Proposal, given: Option<&MotionEffects>) -> Advice {
        let most = |a: &MotionEffects| a.peak_torque.iter().fold(0.0, |m: f64, x| m.max(*x));
        if given.is_some_and(|given| most(&proposal.account) < 1e-6 * most(given)) {
            return "the motion only turns the arm as a whole, which changes b: with b held, nothing is left".into();
        }
        let what = format!(
            "with b held the machine still transmits up to {:.2e} N m and {:.2e} N",
            proposal.simulated_peak_base_moment, proposal.simulated_peak_base_force
        );
        let what = Advice::from(what);
        match self.arm.arm().is_balanced() {
            false => {
                let mends = what.then(": it is not balanced; ").name(Remedy::Design).then(" mends that, ");
                mends.name(Remedy::Check).then(" says where")
            }
            true => {
                let rough = what.then(": the samples are too rough or too dense for their digits; want ");
                rough.name(Remedy::Smoothing).then(", or fewer")
            }
        }
    }
}
