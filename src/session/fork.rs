//! [`Fork`]: the difference between two runs of one scenario.

use super::document::LeftBranch;
use super::edit::TimedEdit;
use super::events::{first_gesture, last_gesture};
use stillbase_query::{ByIdentity, QuickQuery, Sequence};

/// Difference between a branch and the run on display.
#[derive(Clone, Debug, PartialEq)]
pub struct Fork {
    /// First gesture that only the branch has; else the last gesture, if the machine was dragged, or `as planned`.
    pub title: String,
    /// Time at which the two runs diverge, s.
    pub from: f64,
    /// Time at which the branch ends, s.
    pub to: f64,
}

impl LeftBranch {
    /// Returns the difference between the branch and a run with other edits that ends at step `end`.
    pub(super) fn difference_from(&self, edits: &Sequence<TimedEdit>, end: u64) -> Fork {
        Fork::of((&self.script.in_order(), self.end, self.script.is_dragged()), (edits, end), self.step)
    }
}

/// Query for the differences between branches and a run, the oldest branch first, each with a unique title. The input
/// consists of the branches, the edits of the run and the number of its steps.
#[derive(Debug)]
pub(super) struct Forks;

impl QuickQuery for Forks {
    type Input = (ByIdentity<Vec<LeftBranch>>, Sequence<TimedEdit>, u64);
    type Answer = Vec<Fork>;

    fn answer((branches, edits, end): &Self::Input) -> Vec<Fork> {
        let mut forks: Vec<Fork> = branches.0.iter().map(|left| left.difference_from(edits, *end)).collect();
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
    /// Compares the edits of a branch, which ends at step `end`, with those of another run, which ends at step
    /// `other_end`. `dragged` says whether the user has dragged the machine of the branch off its planned motion.
    /// `step` is the step size, s.
    pub fn of(
        (edits, end, dragged): (&[&TimedEdit], u64, bool),
        (others, other_end): (&Sequence<TimedEdit>, u64),
        step: f64,
    ) -> Self {
        let same = edits.iter().zip(others).take_while(|(own, other)| **own == *other).count();
        let first = [edits.get(same).copied(), others.get(same)].into_iter().flatten().map(|timed| timed.step).min();
        let title = match first_gesture(&edits[same..], step) {
            Some(event) => event.words,
            None if dragged => match last_gesture(edits, step) {
                Some(event) => format!("{} at {:.3} s, then left alone", event.words, event.step as f64 * step),
                None => "left alone".into(),
            },
            None => "as planned".into(),
        };
        Self { title, from: first.unwrap_or(end.min(other_end)) as f64 * step, to: end as f64 * step }
    }
}
