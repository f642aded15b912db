//! [`PlanSummary`]: cost of a planned task, or the obstacle to the plan with changes that would make it feasible.

use schemars::JsonSchema;
use serde::Serialize;

use stillbase_mechanics::arm_on_base::FloatingBase;
use stillbase_mechanics::machine::Inertia;
use stillbase_planning::common::common_b_set;
use stillbase_planning::following::Blocked;
use stillbase_planning::off_plane::Price;
use stillbase_planning::off_plane::least_reaction::Verdicts;
use stillbase_planning::off_plane::price::PriceError;
use stillbase_planning::pose_constant::PointCorrection;
use stillbase_planning::pose_space::PoseSpace;
use stillbase_session::scenario::Scenario;
use stillbase_session::{ProgressCallback, Proposal, Refusal, Run, base_forecast, proposals_while};

/// Summary of a task.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct PlanSummary {
    /// Whether the task can be planned.
    pub feasible: bool,
    /// Reason that the task cannot be planned.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Name of the scenario.
    pub scenario: String,
    /// Pose constant at the start, rad.
    pub b: f64,
    /// Whether the machine has a b.
    #[serde(skip)]
    pub has_b: bool,
    /// Intervals of b at which all points of the task can be reached, rad.
    pub b_common: Vec<[f64; 2]>,
    /// Cost of the plan.
    #[serde(flatten)]
    pub cost: Option<PlanCost>,
    /// Obstacle to the plan, if it is not feasible.
    #[serde(flatten)]
    pub obstacle: Option<Obstacle>,
}

/// Cost of a planned motion, if it is followed exactly.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct PlanCost {
    /// Duration T, s.
    pub duration: f64,
    /// Angles of all drives at the start, rad.
    pub q_start: Vec<f64>,
    /// Angles of all drives at the end, rad.
    pub q_end: Vec<f64>,
    /// Smallest and largest b along the motion, rad.
    pub b_range: [f64; 2],
    /// Largest |torque| of each motor, N m.
    pub peak_torque: Vec<f64>,
    /// Largest |rate| of each motor, rad/s.
    pub peak_speed: Vec<f64>,
    /// Largest |n_B|, N m.
    pub peak_base_moment: f64,
    /// ∫ |n_B| dt, N m s.
    pub moment_impulse: f64,
    /// Largest dynamic |f_B|, N.
    pub peak_base_force: f64,
    /// Largest |θ| of a free base without a wheel, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub base_angle: Option<f64>,
    /// θ of a free base at the end without a wheel, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub base_angle_end: Option<f64>,
    /// Largest |p_B| of a free base without a wheel, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub base_shift: Option<f64>,
    /// Largest momentum of a wheel that keeps the attitude of a free base, N m s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wheel_momentum: Option<f64>,
    /// Largest |torque| of this wheel, N m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peak_wheel_torque: Option<f64>,
    /// For the fastest motion: the limit that is active longest in the first part of the path with any active limit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limiting: Option<String>,
    /// For the fastest smooth motion: T/T* − 1, where T* is the least time without limits on jerk.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gap: Option<f64>,
    /// Duration with rounded corners, s; given only if the motion stops at the corners because that is faster.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub blended: Option<f64>,
    /// Cost of a change of b.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub price: Option<PriceOfB>,
    /// Comparison of three ways to perform the same motion of the end effector.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub alternatives: Option<Verdicts>,
    /// The limit of a drive that is exceeded most, and the ratio of the peak to it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub over: Option<(String, f64)>,
    /// Length of the loop that turns the base, in drive angles, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub loop_length: Option<f64>,
    /// Angles of the drives at the start and after each cycle, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cycles: Option<Vec<Vec<f64>>>,
    /// Largest change of a drive angle from the start to the end of each cycle of a closed path, rad.
    #[serde(skip)]
    pub drift: Vec<f64>,
}

/// Cost of a change of b.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct PriceOfB {
    /// Change of b, rad.
    pub delta_b: f64,
    /// Smallest possible peak |n_B| of any motion of this duration, N m.
    pub least_peak: f64,
    /// Rotation of a freely floating base, rad.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub base_turn: Option<f64>,
}

/// Obstacle to a plan, and changes that would make the task feasible.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Obstacle {
    /// Point at which the path is blocked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub blocked: Option<Box<Blocked>>,
    /// Nearest b to the requested one at which the task is feasible, rad.
    #[serde(rename = "mending_b", skip_serializing_if = "Option::is_none")]
    pub feasible_b: Option<f64>,
    /// Smallest move of one point after which all points have a b in common.
    #[serde(rename = "mend", skip_serializing_if = "Option::is_none")]
    pub correction: Option<PointCorrection>,
    /// Settings after which the task is feasible.
    pub proposals: Vec<Proposal>,
}

impl PlanSummary {
    /// Summarises the task of a scenario, from its run or from the reason that there is none. `space` is the pose space
    /// of its machine, if the machine has a b. With `base`, a change of b is assessed for that freely floating base.
    /// The search for proposals ends, without any, if `goes_on` returns `false`.
    ///
    /// # Errors
    /// Fails if the parameters of the base are invalid.
    pub fn of(
        scenario: &Scenario,
        space: Option<&PoseSpace>,
        planned: Result<&Run, &Refusal>,
        base: Option<&FloatingBase>,
        goes_on: ProgressCallback<'_>,
    ) -> Result<Self, PriceError> {
        let common = space.and_then(|space| common_b_set(space, &scenario.task.points()));
        let (b, cost, obstacle) = match planned {
            Ok(run) => (run.plan().forecast.b_start, Some(PlanCost::of(run, base)?), None),
            Err(refusal) => (scenario.task.b, None, Some(Obstacle::of(scenario, refusal, goes_on))),
        };
        Ok(Self {
            feasible: planned.is_ok(),
            reason: planned.err().map(ToString::to_string),
            scenario: scenario.name.clone(),
            b,
            has_b: space.is_some(),
            b_common: common.map_or_else(Vec::new, |set| set.intervals),
            cost,
            obstacle,
        })
    }
}

impl PlanCost {
    /// Returns the cost of the plan of a run.
    ///
    /// # Errors
    /// Fails if the parameters of the base are invalid.
    pub fn of(run: &Run, base: Option<&FloatingBase>) -> Result<Self, PriceError> {
        let plan = run.plan();
        let forecast = &plan.forecast;
        let model = || Inertia::of(&run.scenario().machine);
        let price = |price: Price| {
            Ok(PriceOfB {
                delta_b: price.delta_b(),
                least_peak: price.least_peak(forecast.time),
                base_turn: base.map(|base| price.base_turn(&model(), base)).transpose()?,
            })
        };
        let closed = run.scenario().task.closed;
        let moved = base_forecast(run);
        Ok(Self {
            duration: forecast.time,
            q_start: plan.motion.at(0.0).q.to_vec(),
            q_end: plan.motion.at(run.planned_time()).q.to_vec(),
            b_range: forecast.b,
            peak_torque: forecast.torque.to_vec(),
            peak_speed: forecast.speed.to_vec(),
            peak_base_moment: forecast.moment,
            moment_impulse: forecast.impulse,
            peak_base_force: forecast.force,
            base_angle: moved.as_ref().map(|base| base.angle),
            base_angle_end: moved.as_ref().map(|base| base.angle_end),
            base_shift: moved.as_ref().map(|base| base.shift),
            wheel_momentum: moved.as_ref().map(|base| base.wheel_momentum),
            peak_wheel_torque: moved.as_ref().map(|base| base.wheel_torque),
            limiting: plan.pace.and_then(|pace| pace.leading).map(|limit| limit.to_string()),
            gap: plan.pace.and_then(|pace| pace.gap()),
            blended: plan.blended,
            price: plan.price.map(price).transpose()?,
            loop_length: plan.loop_length,
            alternatives: plan.verdicts.clone(),
            over: forecast.exceeded_limit.map(|(limit, factor)| (limit.to_string(), factor)),
            cycles: (!plan.cycles.is_empty()).then(|| plan.cycles.iter().map(|q| q.to_vec()).collect()),
            drift: if closed { plan.drift().collect() } else { Vec::new() },
        })
    }
}

impl Obstacle {
    /// Returns the obstacle that the refusal of a scenario states; it has no proposals if `goes_on` ends the search.
    pub fn of(scenario: &Scenario, refusal: &Refusal, goes_on: ProgressCallback<'_>) -> Self {
        Self {
            blocked: if let Refusal::Blocked(blocked) = refusal { Some(blocked.clone()) } else { None },
            feasible_b: refusal.feasible_b(),
            correction: if let Refusal::NoCommonPlane { why, .. } = refusal { why.correction } else { None },
            proposals: proposals_while(scenario, refusal, goes_on).unwrap_or_default(),
        }
    }
}
