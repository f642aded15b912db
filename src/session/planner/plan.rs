//! [`Plan`]: a planned task, and what it will cost.

use std::sync::Arc;

use crate::mechanics::dynamics::Surroundings;
use crate::mechanics::machine::Inertia;
use crate::mechanics::planar::{DriveAngles, PerDrive, Vector};
use crate::planning::curves::Path;
use crate::planning::off_plane::Price;
use crate::planning::off_plane::least_reaction::Verdicts;
use crate::planning::pose_space::{NoPoseSpace, PoseSpace};
use crate::planning::timing::limits::DriveLimit;
use crate::planning::timing::{Limits, TimeLaw};
use crate::planning::{Forecast, Motion};
use crate::session::Refusal;
use crate::session::scenario::Scenario;

/// The pose space of a machine, or why its b cannot be held.
pub(super) type Space<'a> = Result<&'a PoseSpace, &'a NoPoseSpace>;

/// How much is done to find a path and to say what would do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Effort {
    /// A quick search, and no proposals: the task itself is only tried as a proposal.
    Trial,
    /// Everything.
    Whole,
}

/// A planned task.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// What the machine is to do.
    pub motion: Arc<Motion>,
    /// What it will cost.
    pub forecast: Forecast,
    /// For the fastest motion: what holds it back.
    pub pace: Option<Pace>,
    /// For a change of b: its price.
    pub price: Option<Price>,
    /// For the least reaction: what other ways would cost.
    pub verdicts: Option<Verdicts>,
    /// For motions of zero momentum: the drives at the start and after each cycle, rad. For closed paths of four drives
    /// and more whose drives end elsewhere than they began: both.
    pub cycles: Vec<DriveAngles>,
    /// T with corners rounded off as the task asks, s, where it would take longer than resting at them: the motion
    /// rests.
    pub blended: Option<f64>,
}

/// Drives that end as near to their start as this, rad, end there.
const CLOSES: f64 = 1e-6;

/// What holds the fastest motion back.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pace {
    /// T, s.
    pub taken: f64,
    /// The least time without limits on jerk, s, where there are any.
    pub unlimited: Option<f64>,
    /// The limit that leads for the greatest share of the first part.
    pub leading: Option<DriveLimit>,
}

impl Pace {
    /// T/T* − 1, T* the least time without limits on jerk; for a law with such limits, where something besides them
    /// limits.
    pub fn gap(&self) -> Option<f64> {
        self.unlimited.filter(|least| *least > 0.0).map(|least| (self.taken / least - 1.0).max(0.0))
    }
}

impl Plan {
    /// The largest |Δq_k| between the start and the end of each cycle, rad.
    pub fn drift(&self) -> impl Iterator<Item = f64> {
        let first = self.cycles.first();
        self.cycles.iter().skip(1).filter_map(move |q| Some(q.0.minus(&first?.0).max_abs()))
    }

    /// Rest where the end effector is as near to A as the b of the task lets it be: for a run that waits.
    pub fn rest(scenario: &Scenario, space: Option<&PoseSpace>) -> Self {
        let (task, machine) = (&scenario.task, &scenario.machine);
        let p = task.points()[0];
        let q =
            space.and_then(|space| space.standing(p, task.b)).unwrap_or_else(|| match PoseSpace::nominal(machine) {
                Ok(space) => space.near(p, task.b).unwrap_or_else(|| space.lift(&space.middle(), task.b)),
                Err(_) => DriveAngles(PerDrive::zeros(machine.drives())),
            });
        let path = Path::JointLine { from: q, to: q };
        Self::of(scenario, Motion::new(path, TimeLaw::Quintic, task.time))
    }

    pub(super) fn of(scenario: &Scenario, motion: Motion) -> Self {
        let (model, around) = dynamics_of(scenario);
        let forecast = Forecast::of(&motion, &model, &around, &Limits::of(&scenario.machine));
        let ends = [0.0, motion.duration()].map(|t| motion.at(t).q);
        let mut plan = Self::foreseen(motion, forecast);
        let is_closed = scenario.task.closed && scenario.idle("task.posture").is_none();
        if is_closed && ends[1].0.minus(&ends[0].0).max_abs() > CLOSES {
            plan.cycles = ends.to_vec();
        }
        plan
    }

    /// A motion and what was found of it, with nothing else to say.
    pub(super) fn foreseen(motion: Motion, forecast: Forecast) -> Self {
        Self {
            motion: Arc::new(motion),
            forecast,
            pace: None,
            price: None,
            verdicts: None,
            cycles: Vec::new(),
            blended: None,
        }
    }
}

/// Refuses a motion that passes a joint limit, or a change point to keep off, which rates alone do not know of.
pub(super) fn keeps_rules(scenario: &Scenario, motion: &Motion) -> Result<(), Refusal> {
    const LOOKS: usize = 1000;
    let looks = (100 * motion.path.parts()).clamp(LOOKS, 100_000);
    let mut last: Option<DriveAngles> = None;
    for i in 0..=looks {
        let s = i as f64 / looks as f64;
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
            let a = q[angle.to] - q[angle.from] + angle.offset;
            let past = (angle.limits.start() - a).max(a - angle.limits.end());
            if past > 1e-6 {
                let posture = if scenario.idle("task.posture").is_none() { "another posture, " } else { "" };
                return Err(Refusal::NoWay(format!(
                    "{:.1} % along, a{} would pass its {} limit: want another path, another b, {posture}or wider limits",
                    100.0 * s,
                    k + 1,
                    if a > *angle.limits.end() { "upper" } else { "lower" },
                )));
            }
        }
    }
    Ok(())
}

/// What control believes in.
pub(super) fn dynamics_of(scenario: &Scenario) -> (Inertia, Surroundings) {
    let around = Surroundings { gravity: scenario.machine.gravity(), force: Vector::default() };
    (Inertia::of(&scenario.machine), around)
}
