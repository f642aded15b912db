//! A [`Growing`] answer: one of a [`Sequence`], which takes up what is appended instead of being made again.

use std::any::Any;
use std::sync::Arc;

use super::sequence::{Mark, Revision, Sequence};
use super::slot::Kept;

/// An answer that grows with a sequence. It follows from its input and the items that it has taken, alone: taken one at
/// a time or together, cut back and taken again, they give the same.
pub trait Growing: Clone + Send + Sync + 'static {
    /// What is taken.
    type Item: Clone;
    /// What else it depends on.
    type Input: Clone + PartialEq + Send + 'static;

    /// Of no items yet.
    fn begin(input: &Self::Input) -> Self;

    /// How many items it has taken.
    fn count(&self) -> usize;

    /// Takes those that follow.
    fn take(&mut self, items: &[Self::Item]);

    /// Goes back to the first so many items, or to fewer.
    fn cut(&mut self, count: usize);

    /// Goes over to another input. It may keep what is the same for both.
    fn turn_to(&mut self, input: &Self::Input) {
        *self = Self::begin(input);
    }
}

/// The answer to a whole sequence, at once and not kept.
pub fn grown<G: Growing>(input: &G::Input, items: &Sequence<G::Item>) -> G {
    let mut answer = G::begin(input);
    while let together @ [_, ..] = items.from(answer.count()) {
        let count = answer.count() + together.len();
        answer.take(together);
        if answer.count() < count {
            break;
        }
    }
    answer
}

/// A growing answer as it is when it is asked. As an input of others it is the same until it takes or loses something.
#[derive(Debug)]
pub struct Grown<G> {
    version: Arc<()>,
    answer: Option<Arc<G>>,
    /// Whether it has taken all there is.
    pub is_whole: bool,
}

impl<G> Clone for Grown<G> {
    fn clone(&self) -> Self {
        Self { version: self.version.clone(), answer: self.answer.clone(), is_whole: self.is_whole }
    }
}

impl<G> PartialEq for Grown<G> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.version, &other.version)
    }
}

impl<G> Grown<G> {
    /// The answer; none once it was let go.
    pub fn answer(&self) -> Option<&Arc<G>> {
        self.answer.as_ref()
    }

    /// Keeps only what it is compared by: whoever has the answer itself keeps it from growing where it is.
    pub fn let_go(&mut self) {
        self.answer = None;
    }
}

/// An answer, and how far it is.
pub(super) struct Growth<G: Growing> {
    of: Mark,
    input: G::Input,
    version: Arc<()>,
    answer: Arc<G>,
}

impl<G: Growing> Growth<G> {
    pub fn begin(revision: &Revision, input: &G::Input) -> Self {
        let answer = Arc::new(G::begin(input));
        Self { of: revision.mark(), input: input.clone(), version: Arc::default(), answer }
    }

    /// Takes what there is more than before, so many items at most.
    pub fn follow(&mut self, input: &G::Input, items: &Sequence<G::Item>, at_most: usize) {
        let kept = items.revision().kept_of(&self.of).min(items.len());
        self.of = items.revision().mark();
        if self.answer.count() > kept {
            self.change().cut(kept);
        }
        if self.input != *input {
            self.input = input.clone();
            self.change().turn_to(input);
        }
        let mut left = at_most;
        loop {
            let count = self.answer.count();
            let together = items.from(count);
            let taken = &together[..together.len().min(left)];
            if taken.is_empty() {
                return;
            }
            self.change().take(taken);
            left -= taken.len();
            if self.answer.count() <= count {
                return;
            }
        }
    }

    fn change(&mut self) -> &mut G {
        self.version = Arc::default();
        Arc::make_mut(&mut self.answer)
    }

    pub fn grown(&self, count: usize) -> Grown<G> {
        let is_whole = self.answer.count() == count;
        Grown { version: self.version.clone(), answer: Some(self.answer.clone()), is_whole }
    }
}

/// The answers of one kind, of each sequence that lives.
pub(super) struct Growths<G: Growing>(Vec<Growth<G>>);

impl<G: Growing> Default for Growths<G> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<G: Growing> Kept for Growths<G> {
    fn works(&mut self) -> bool {
        false
    }

    fn count(&self) -> usize {
        self.0.len()
    }

    fn as_any(&mut self) -> &mut dyn Any {
        self
    }
}

impl<G: Growing> Growths<G> {
    /// That which has most in common with a revision, to be grown outside of the store. Of others that have less in common
    /// with it only those stay whose sequences live.
    pub fn take(&mut self, revision: &Revision) -> Option<Growth<G>> {
        let kept = |growth: &Growth<G>| revision.kept_of(&growth.of);
        let best = (0..self.0.len()).max_by_key(|i| kept(&self.0[*i])).filter(|i| kept(&self.0[*i]) > 0);
        let found = best.map(|i| self.0.swap_remove(i));
        self.0.retain(|growth| match kept(growth) {
            0 => !growth.of.has_ended(),
            _ => growth.of.is_had(),
        });
        found
    }

    pub fn keep(&mut self, growth: Growth<G>) {
        self.0.push(growth);
    }
}
