//! Conversion of wall time into steps of the run on display.

use super::AppState;

/// Maximum wall time that one repaint simulates, s, so that time does not jump after a suspension of the program.
const MAX_CATCH_UP_S: f64 = 0.1;

impl AppState {
    /// Advances the run by a wall time, s, at the playback rate.
    pub fn pass(&mut self, wall: f64) {
        self.go_on(wall);
        self.refresh_blocks();
    }

    fn go_on(&mut self, wall: f64) {
        // While the session is being changed, time stands still: the new session must match the display.
        if self.background.is_changing() {
            self.due_s = 0.0;
            self.pace.restart();
            return;
        }
        if let Some(from) = self.starts_over(wall) {
            self.session.seek(from);
            self.session.play();
        }
        if !self.session.is_moving() {
            self.due_s = 0.0;
            self.pace.restart();
            return;
        }
        let dt = self.session.scenario().step;
        self.due_s += wall.clamp(0.0, MAX_CATCH_UP_S) * self.view_state.speed;
        let wanted = (self.due_s / dt).floor();
        self.due_s -= wanted * dt;
        let (steps, before) = (wanted.min(self.pace.most_steps()), self.session.frame().step);
        self.session.tick(steps as u64);
        let done = self.session.frame().step.abs_diff(before) as f64;
        // A run that has ended during these steps does not lag.
        if self.session.is_moving() {
            self.pace.record_repaint(wall, done * dt, done, self.view_state.speed);
        } else {
            self.pace.restart();
        }
    }

    /// Records the wall time that the last [`pass`](Self::pass) took, s, measured by the caller. Slow steps are
    /// spread over several repaints, so that the picture stays smooth.
    pub fn record_cost(&mut self, seconds: f64) {
        self.pace.record_cost(seconds);
    }

    /// Returns the playback rate, simulated seconds per second, if it lags behind the requested one.
    pub fn lagging_rate(&self) -> Option<f64> {
        self.pace.lagging_rate()
    }

    /// Returns the time from which the run starts over, s, if it must start over. In the introduction that is 0; in a
    /// loop it is the start of the run or of the range chosen in the plots. `wall` is the wall time that has passed,
    /// s.
    fn starts_over(&mut self, wall: f64) -> Option<f64> {
        if self.demonstrates() && self.intro.as_mut().is_some_and(|intro| intro.advance_rest(&self.session, wall)) {
            return Some(0.0);
        }
        let [from, to] = self.view_state.charts.range.unwrap_or([0.0, f64::INFINITY]);
        let now = self.session.frame().time;
        (self.loops() && now > from && (now >= to || !self.session.is_moving())).then_some(from)
    }

    /// Whether the demonstration before the hints runs: the machine has not been touched yet.
    fn demonstrates(&self) -> bool {
        self.view_state.pair.as_ref().is_some_and(|pair| pair.demonstrates)
    }

    pub(super) fn loops(&self) -> bool {
        self.view_state.loops && self.session.is_playing() && self.view_state.gesture.grabbed.is_none()
    }
}
