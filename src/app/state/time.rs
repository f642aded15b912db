//! Wall time, turned into steps of the run on display.

use super::AppState;

/// The most wall time that one repaint makes up for, s: after a pause of the program time does not jump.
const MOST_OWED: f64 = 0.1;

impl AppState {
    /// Lets wall time pass, s.
    pub fn pass(&mut self, wall: f64) {
        // While the session is being changed, time stands: what is made has to fit what is shown.
        if self.background.is_changing() {
            self.owed = 0.0;
            self.pace.rest();
            return;
        }
        if let Some(from) = self.starts_over(wall) {
            self.session.seek(from);
            self.session.play();
        }
        if !self.session.is_moving() {
            self.owed = 0.0;
            self.pace.rest();
            return;
        }
        let dt = self.session.scenario().step;
        self.owed += wall.clamp(0.0, MOST_OWED) * self.view_state.speed;
        let wanted = (self.owed / dt).floor();
        self.owed -= wanted * dt;
        let (steps, before) = (wanted.min(self.pace.most_steps()), self.session.frame().step);
        self.session.tick(steps as u64);
        let done = self.session.frame().step.abs_diff(before) as f64;
        // What ends on the way is not slow.
        if self.session.is_moving() {
            self.pace.count(wall, done * dt, done, self.view_state.speed);
        } else {
            self.pace.rest();
        }
    }

    /// What the last [`pass`](Self::pass) has taken, s, from who reads a clock: steps that take long are done in smaller
    /// portions, so that the picture stays smooth.
    pub fn took(&mut self, seconds: f64) {
        self.pace.took(seconds);
    }

    /// Simulated seconds a second, where that is less than asked for.
    pub fn behind(&self) -> Option<f64> {
        self.pace.behind()
    }

    /// Where time goes back to, if it does, s: to the start in the first minute; while the run is played over and over to
    /// the start or to the beginning of the range that was chosen in the plots. After so much more wall time, s.
    fn starts_over(&mut self, wall: f64) -> Option<f64> {
        if self.intro.as_mut().is_some_and(|intro| intro.rests(&self.session, wall)) {
            return Some(0.0);
        }
        let [from, to] = self.view_state.charts.range.unwrap_or([0.0, f64::INFINITY]);
        let now = self.session.frame().time;
        (self.loops() && now > from && (now >= to || !self.session.is_moving())).then_some(from)
    }

    pub(super) fn loops(&self) -> bool {
        self.view_state.loops && self.session.is_playing() && self.view_state.gesture.grabbed.is_none()
    }
}
