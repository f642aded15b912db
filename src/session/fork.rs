//! [`Fork`]: what tells two courses of one scenario apart.

use super::document::Left;
use super::edit::TimedEdit;
use super::events::{first_gesture, last_gesture};
use crate::query::{Quick, Same, Sequence};

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

impl Left {
    /// What tells it from a run with other edits, which ends after so many steps.
    pub(super) fn beside(&self, edits: &Sequence<TimedEdit>, end: u64) -> Fork {
        Fork::of((&self.script.in_order(), self.end, self.script.is_led()), (edits, end), self.step)
    }
}

/// What tells branches from a run, given its edits and how many steps it has done; the oldest first. No two have the
/// same title.
#[derive(Debug)]
pub(super) struct Forks;

impl Quick for Forks {
    type Input = (Same<Vec<Left>>, Sequence<TimedEdit>, u64);
    type Answer = Vec<Fork>;

    fn answer((branches, edits, end): &Self::Input) -> Vec<Fork> {
        let mut forks: Vec<Fork> = branches.0.iter().map(|left| left.beside(edits, *end)).collect();
        for i in 1..forks.len() {
            let title = forks[i].title.clone();
            let taken = |name: &String| forks[..i].iter().any(|fork| fork.title == *name);
            let another = (2..).map(|n| format!("{title} ({n})")).find(|name| !taken(name));
            if taken(&title) {
                forks[i].title = another.unwrap_or(title);
            }
        }
        forks
    }
}

impl Fork {
    /// Of edits with the step at which they end, beside others; steps last so long, s. `led`: by then somebody has led
    /// the machine off its planned motion.
    pub fn of(
        (edits, end, led): (&[&TimedEdit], u64, bool),
        (others, other_end): (&Sequence<TimedEdit>, u64),
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
