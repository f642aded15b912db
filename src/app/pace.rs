//! [`PlaybackRate`] measures whether playback lags behind the requested rate. It limits the number of steps in a
//! repaint, so that the picture stays smooth.

/// Measured playback rate and cost of a step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PlaybackRate {
    /// Playback rate, simulated seconds per second, averaged over [`AVERAGING_TIME_S`].
    rate: Option<f64>,
    /// Wall time in the average, s.
    counted_s: f64,
    /// Whether playback lags behind the requested rate.
    lags: bool,
    /// Wall time of a step, s; `None` until it has been measured.
    step_cost_s: Option<f64>,
    /// Number of steps in the last repaint.
    steps: f64,
}

/// Time constant of the average, wall time, s.
const AVERAGING_TIME_S: f64 = 0.5;
/// Longer gaps between repaints, s, mean that the program was suspended, not that it is slow.
const MAX_REPAINT_GAP_S: f64 = 2.0;
/// Hysteresis: playback lags once its rate is below the first fraction of the requested rate, until it reaches the
/// second.
const LAG_BELOW: f64 = 0.9;
const LAG_ENDS_AT: f64 = 0.97;
/// Wall time that the steps of one repaint may take, s.
const STEP_BUDGET_S: f64 = 0.012;
/// Maximum number of steps in a repaint: the first while the cost of a step is unknown, the second always.
const MAX_STEPS_UNMEASURED: f64 = 2000.0;
const MAX_STEPS: f64 = 20_000.0;
/// Upper bound of the measured wall time that the steps of a repaint take, s.
const MAX_MEASURED_S: f64 = 0.2;
/// Weight of the newest measurement in the cost of a step.
const NEWEST_WEIGHT: f64 = 0.3;

impl PlaybackRate {
    /// Returns the maximum number of steps in a repaint.
    pub fn most_steps(&self) -> f64 {
        self.step_cost_s
            .map_or(MAX_STEPS_UNMEASURED, |cost| (STEP_BUDGET_S / cost.max(1e-9)).floor().clamp(1.0, MAX_STEPS))
    }

    /// Records one repaint.
    /// * `wall`: wall time since the last repaint, s;
    /// * `simulated`: simulated time of its steps, s;
    /// * `steps`: number of steps;
    /// * `speed`: requested playback rate, simulated seconds per second.
    pub fn record_repaint(&mut self, wall: f64, simulated: f64, steps: f64, speed: f64) {
        self.steps = steps;
        if wall <= 0.0 || wall > MAX_REPAINT_GAP_S {
            return;
        }
        let now = simulated / wall;
        let share = 1.0 - (-wall / AVERAGING_TIME_S).exp();
        let rate = self.rate.map_or(speed, |rate| rate) * (1.0 - share) + now * share;
        (self.rate, self.counted_s) = (Some(rate), self.counted_s + wall);
        let threshold = if self.lags { LAG_ENDS_AT } else { LAG_BELOW };
        self.lags = self.counted_s >= AVERAGING_TIME_S && rate < threshold * speed;
    }

    /// Records the wall time that the steps of the last repaint took, s.
    pub fn record_cost(&mut self, seconds: f64) {
        if self.steps >= 1.0 {
            // The bound limits the influence of a suspension of the program on the cost of a step.
            let now = seconds.min(MAX_MEASURED_S) / self.steps;
            self.step_cost_s = Some(self.step_cost_s.map_or(now, |cost| cost + NEWEST_WEIGHT * (now - cost)));
        }
    }

    /// Restarts the average, because the run does not move or the session is being changed.
    pub fn restart(&mut self) {
        *self = Self { step_cost_s: self.step_cost_s, ..Self::default() };
    }

    /// Returns the playback rate, simulated seconds per second, if it lags behind the requested one.
    pub fn lagging_rate(&self) -> Option<f64> {
        self.rate.filter(|_| self.lags)
    }
}
