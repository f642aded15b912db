//! Playback of a session: how time passes, and which frame is on display.

use super::Session;
use crate::document::REPORT_FRAMES;
use stillbase_query::ProgressCallback;

impl Session {
    /// Starts playback. At the end of a finished motion it starts over.
    pub fn play(&mut self) {
        if self.run.waiting().is_some() {
            return;
        }
        if self.is_at_end() && self.is_settled() {
            self.cursor = 0;
        }
        self.playing = true;
    }

    /// Stops playback.
    pub fn pause(&mut self) {
        self.playing = false;
    }

    /// Shows an instant, s, at most the end of the run so far or of the planned motion.
    pub fn seek(&mut self, time: f64) {
        self.seek_while(time, &mut |_| true);
    }

    /// Does the same as [`seek`](Self::seek), until `watch` cancels it.
    pub fn seek_while(&mut self, time: f64, watch: ProgressCallback<'_>) {
        let step = (time / self.scenario().step).round().max(0.0) as usize;
        let ahead = self.steps_to(time);
        for i in 1..=ahead {
            if !self.has_room() || (i.is_multiple_of(REPORT_FRAMES) && !watch(i as f64 / ahead as f64)) {
                break;
            }
            self.advance_run();
        }
        self.cursor = step.min(self.frames.len() - 1);
    }

    /// Returns the number of steps that the run still needs to reach a time, s, of its planned motion.
    fn steps_to(&self, time: f64) -> usize {
        if self.is_dragged() {
            return 0;
        }
        let step = self.scenario().step;
        let planned = (self.run.whole_time() / step - 1e-6).ceil() as usize;
        let to = (time / step).round().max(0.0) as usize;
        (to.min(planned) + 1).saturating_sub(self.frames.len())
    }

    /// Moves the display by a number of steps, either way; past the newest frame the run goes on.
    pub fn step_by(&mut self, steps: i64) {
        self.playing = false;
        let to = (self.cursor as i64).saturating_add(steps).max(0) as usize;
        while self.frames.len() <= to && self.has_room() {
            self.advance_run();
        }
        self.cursor = to.min(self.frames.len() - 1);
    }

    /// Advances playback by a number of steps. Does nothing if paused, or once everything is at rest.
    pub fn tick(&mut self, steps: u64) {
        for _ in 0..steps {
            if !self.is_moving() {
                return;
            }
            if self.is_at_end() {
                if !self.has_room() {
                    self.playing = false;
                    return;
                }
                self.advance_run();
            }
            self.cursor += 1;
            if !self.frame().is_finite() {
                self.playing = false;
                return;
            }
        }
    }

    fn advance_run(&mut self) {
        self.unedited = None;
        self.run.advance();
        let frame = self.run.frame();
        self.frames.push(frame);
        self.others.push(&self.run);
        // A session can be opened again only up to its last finite frame.
        if frame.is_finite() {
            self.document.end = frame.step;
        }
    }
}
