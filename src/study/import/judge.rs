//! What motions of a machine do to its base, and whether a proposed motion has no reactions, as it is meant to.

use serde::Serialize;

use super::given::GivenMotion;
use crate::mechanics::dynamics::{Surroundings, angular_momentum, inverse_with_wrench};
use crate::mechanics::machine::{Inertia, Machine};
use crate::mechanics::planar::Vector;
use crate::planning::Motion;
use crate::planning::curves::Coordinates;
use crate::planning::following::nearest::Deviation;
use crate::planning::forecast::Forecast;
use crate::planning::pose_space::{NoPoseSpace, PoseSpace};
use crate::planning::timing::Limits;
use crate::query::{Watch, part};
use crate::session::scenario::{Scenario, Task, TaskKind};
use crate::session::{Refusal, Run, replay_while};
use crate::study::advice::{Advice, Remedy};

/// Up to this share of the work a proposal is simulated; in the rest it is found what it does.
const SIMULATED: f64 = 0.8;

/// What a motion does, if it is followed exactly.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Account {
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
    /// Largest torque of each motor, either way, N m.
    pub peak_torque: Vec<f64>,
    /// Largest rate of each motor, rad/s.
    pub peak_speed: Vec<f64>,
    /// The limit of a drive that is passed by most, and by what factor.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub over: Option<(String, f64)>,
    /// By how much a relative angle passes its limits at most, rad; 0 if all keep them.
    pub past_limits: f64,
    /// Least and greatest b on the way, rad.
    pub b_range: [f64; 2],
    /// Mean of b over time, rad.
    pub b_mean: f64,
    /// Angular momentum about B at the start, kg m²/s.
    pub angular_momentum_start: f64,
    /// The same at the end, kg m²/s.
    pub angular_momentum_end: f64,
    /// Largest |q̇_k| at the end, rad/s.
    pub speed_end: f64,
    /// n_B over time, to be drawn: s, N m.
    #[serde(skip)]
    pub moment: Vec<[f64; 2]>,
}

/// A motion that is proposed, simulated.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Proposal {
    /// `same-tip`, `turned`, `on-plane` or `as-given`.
    pub way: &'static str,
    /// Why it is this one, in words.
    pub why: String,
    /// rad.
    pub b: f64,
    /// Greatest distance of the end effector from the given motion, m.
    pub tip_deviation: f64,
    /// Greatest distance of each drive from the given motion, rad.
    pub joint_deviation: Vec<f64>,
    /// Root mean square over time and drives in the metric of kinetic energy, rad.
    pub rms_deviation: f64,
    /// What it does, if it is followed exactly.
    #[serde(flatten)]
    pub account: Account,
    /// Largest |n_B| when it is simulated, N m.
    pub simulated_peak_base_moment: f64,
    /// Largest dynamic |f_B| when it is simulated, N.
    pub simulated_peak_base_force: f64,
    /// Whether the simulated motion leaves the base alone.
    pub reactionless: bool,
}

/// In so many parts n_B over time is drawn.
const DRAWN: usize = 240;

/// A motion that might be proposed.
pub(super) struct Candidate {
    pub way: &'static str,
    pub why: String,
    pub task: Task,
}

/// A motion as it is given, and what it does.
pub(super) struct Given {
    pub motion: Motion,
    pub account: Account,
}

/// The machine with what is needed to assess motions of it.
pub(super) struct Judge {
    /// Everything but the task.
    pub scenario: Scenario,
    pub machine: Machine,
    pub model: Inertia,
    pub around: Surroundings,
    pub space: Result<PoseSpace, NoPoseSpace>,
    pub instants: usize,
}

impl Judge {
    /// Of the machine of a scenario, whose motions are looked at at so many instants.
    pub fn new(scenario: &Scenario, instants: usize) -> Self {
        let scenario = Scenario { compare_b: None, edits: Vec::new(), ..scenario.clone() };
        let machine = scenario.machine.clone();
        Self {
            model: Inertia::of(&machine),
            around: Surroundings { gravity: machine.gravity(), force: Vector::default() },
            space: PoseSpace::of(&machine),
            instants,
            scenario,
            machine,
        }
    }

    /// n_B at instants that are enough to draw it, s, N m.
    fn moment(&self, motion: &Motion) -> Vec<[f64; 2]> {
        let at = |i: usize| {
            let t = motion.duration() * i as f64 / DRAWN as f64;
            let r = motion.at(t);
            let (_, wrench) = inverse_with_wrench(&self.model, &r.q.units(), &r.qd, &r.qdd, &self.around);
            [t, wrench.total().moment + 0.0]
        };
        (0..=DRAWN).map(at).collect()
    }

    fn past_limits(&self, motion: &Motion) -> f64 {
        let past = |i: usize| {
            let q = motion.path.at(i as f64 / self.instants as f64).q;
            let angles = self.machine.angles().iter().map(|angle| {
                let a = q[angle.to] - q[angle.from] + angle.offset;
                (angle.limits.start() - a).max(a - angle.limits.end())
            });
            angles.fold(0.0, f64::max)
        };
        let most = (0..=self.instants).map(past).fold(0.0, f64::max);
        // What rounding passes by is none.
        if most > 1e-6 { most } else { 0.0 }
    }

    /// What a motion does.
    fn account(&self, motion: &Motion, goes_on: Watch<'_>) -> Account {
        let limits = Limits::of(&self.machine);
        let f = Forecast::at_while(motion, (&self.model, &self.around, &limits), self.instants, goes_on);
        let ends = [0.0, motion.duration()].map(|t| motion.at(t));
        let [start, end] = [0, 1].map(|i| angular_momentum(&self.model, &ends[i].q.units(), &ends[i].qd) + 0.0);
        Account {
            peak_base_moment: f.moment,
            rms_base_moment: f.moment_rms,
            moment_impulse: f.impulse,
            peak_base_force: f.force,
            rms_base_force: f.force_rms,
            peak_torque: f.torque.to_vec(),
            peak_speed: f.speed.to_vec(),
            over: f.over.map(|(limit, factor)| (limit.to_string(), factor)),
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

impl Judge {
    /// A motion as it is given.
    pub fn given(&self, motion: Motion, goes_on: Watch<'_>) -> Given {
        Given { account: self.account(&motion, goes_on), motion }
    }

    /// Whether a task can be planned.
    ///
    /// Errors say why it cannot.
    pub fn plans(&self, task: &Task) -> Result<(), String> {
        let own = Scenario { task: task.clone(), ..self.scenario.clone() };
        Run::new(&own).map(|_| ()).map_err(|refusal| refusal.to_string())
    }

    /// A motion as a scenario of its own, with the step, s.
    pub fn scenario(&self, task: Task, step: f64, way: &str) -> Scenario {
        let title = format!("{} · {way}", self.scenario.title);
        Scenario { task, step, title, ..self.scenario.clone() }
    }

    /// A given motion as a scenario of its own, of the end effector with minimum-norm rates from the pose of b, rad; none
    /// if the samples make no task.
    pub fn as_given(&self, motion: &GivenMotion, b: f64, step: f64) -> Option<Scenario> {
        let sampled = |kind, b| Task::sampled(kind, motion.samples.clone(), Some(b), &self.machine).ok();
        let task = match motion.coordinates {
            Coordinates::Drives => {
                let b = self.model.lambda().dot(motion.samples.values(0));
                sampled(TaskKind::Given, b).map(|task| Task { b, ..task })
            }
            Coordinates::EndEffector => sampled(TaskKind::MinimumNorm, b),
        };
        let own = self.scenario(task?, step, "as given");
        Some(Scenario { name: format!("{}-given", own.name), ..own })
    }

    /// A candidate, planned and simulated; `goes_on` is told how much is done, from 0 to 1, and says whether the rest is
    /// still wanted.
    ///
    /// Errors say why it cannot be carried out.
    pub fn proposal(
        &self,
        candidate: &Candidate,
        scenario: &Scenario,
        given: Option<&Given>,
        goes_on: Watch<'_>,
    ) -> Result<Proposal, Refusal> {
        let run = replay_while(scenario, |run, frame| goes_on(SIMULATED * frame.time / run.planned_time()))?;
        let peaks = run.frame().peaks;
        let (motion, tip) = (&run.plan().motion, self.machine.end_effector());
        let deviation =
            given.map(|Given { motion: given, .. }| Deviation::between(tip, &self.model, given, motion, self.instants));
        let account = self.account(motion, &mut part(goes_on, [SIMULATED, 1.0]));
        Ok(Proposal {
            way: candidate.way,
            why: candidate.why.clone(),
            b: account.b_mean,
            tip_deviation: deviation.as_ref().map_or(0.0, |d| d.tip),
            joint_deviation: deviation.as_ref().map_or_else(Vec::new, |d| d.joints.to_vec()),
            rms_deviation: deviation.as_ref().map_or(0.0, |d| d.rms),
            account,
            simulated_peak_base_moment: peaks.moment,
            simulated_peak_base_force: peaks.force,
            reactionless: peaks.is_reactionless(),
        })
    }

    /// Why holding b is not enough.
    pub fn why_not_reactionless(&self, proposal: &Proposal, given: Option<&Account>) -> Advice {
        let most = |a: &Account| a.peak_torque.iter().fold(0.0, |m: f64, x| m.max(*x));
        if given.is_some_and(|given| most(&proposal.account) < 1e-6 * most(given)) {
            return "on a plane nothing of the motion is left: all of it turns the arm as a whole".into();
        }
        let what = format!(
            "with b held the machine still transmits up to {:.2e} N m and {:.2e} N",
            proposal.simulated_peak_base_moment, proposal.simulated_peak_base_force
        );
        let what = Advice::from(what);
        match self.model.is_balanced() {
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
