//! [`Fork`]: what tells two courses of one scenario apart.

use super::edit::TimedEdit;
use super::events::{first_gesture, last_gesture};

/// What tells a branch from the run on display.
#[derive(Clone, Debug, PartialEq)]
pub struct Fork {
    /// What is done in it first that is not done in the other; if nothing is, what was done last.
    pub title: String,
    /// Where the two part, s.
    pub from: f64,
    /// Where it ends, s.
    pub to: f64,
}

impl Fork {
    /// Of edits with the step at which they end, beside others; steps last so long, s. `led`: by then somebody has led
    /// the machine off its planned motion.
    pub fn of(
        (edits, end, led): (&[&TimedEdit], u64, bool),
        (others, other_end): (&[TimedEdit], u64),
        step: f64,
    ) -> Self {
        let same = edits.iter().zip(others).take_while(|(own, other)| **own == *other).count();
        let first = [edits.get(same).copied(), others.get(same)].into_iter().flatten().map(|timed| timed.step).min();
        let title = match first_gesture(&edits[same..], step) {
            Some(event) => event.words,
            None if led => match last_gesture(edits, step) {
                Some(event) => format!("{} at {:.3} s, then left alone", event.words, event.step as f64 * step),
                None => "left alone".into(),
            },
            None => "as planned".into(),
        };
        Self { title, from: first.unwrap_or(end.min(other_end)) as f64 * step, to: end as f64 * step }
    }
}
