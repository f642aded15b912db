//! Answers to an [`IncrementalQuery`] are derived from a [`Sequence`]. When items are appended, an answer is extended
//! instead of being derived again.

use std::any::Any;
use std::sync::Arc;

use super::sequence::{Revision, RevisionMark, Sequence};
use super::slot::AnySlot;

/// An answer that grows with a sequence. It depends only on its input and on the items taken. The answer is the same
/// whether items are taken one at a time, all at once, or again after a truncation.
pub trait IncrementalQuery: Clone + Send + Sync + 'static {
    /// Item of the sequence.
    type Item: Clone;
    /// Everything else that the answer depends on.
    type Input: Clone + PartialEq + Send + 'static;

    /// Returns the answer for no items.
    fn begin(input: &Self::Input) -> Self;

    /// Returns the number of items taken so far.
    fn count(&self) -> usize;

    /// Takes the next items of the sequence.
    fn take(&mut self, items: &[Self::Item]);

    /// Goes back to the answer for the first `count` items, or for fewer.
    fn truncate(&mut self, count: usize);

    /// Changes to another input. An implementation may keep everything that both inputs share.
    fn set_input(&mut self, input: &Self::Input) {
        *self = Self::begin(input);
    }
}

/// Returns the answer for a whole sequence, computed at once and without a cache entry.
pub fn answer_sequence<G: IncrementalQuery>(input: &G::Input, items: &Sequence<G::Item>) -> G {
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

/// A snapshot of a growing answer. As an input of other queries, two snapshots are equal as long as the answer has not
/// changed between them.
#[derive(Debug)]
pub struct IncrementalAnswer<G> {
    version: Arc<()>,
    answer: Option<Arc<G>>,
    /// Whether the answer has taken all items of the sequence.
    pub is_whole: bool,
}

impl<G> Clone for IncrementalAnswer<G> {
    fn clone(&self) -> Self {
        Self { version: self.version.clone(), answer: self.answer.clone(), is_whole: self.is_whole }
    }
}

impl<G> PartialEq for IncrementalAnswer<G> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.version, &other.version)
    }
}

impl<G> IncrementalAnswer<G> {
    /// Returns the answer; `None` after [`let_go`](Self::let_go).
    pub fn answer(&self) -> Option<&Arc<G>> {
        self.answer.as_ref()
    }

    /// Drops the answer and keeps only the version that is compared. While a snapshot holds the answer, the answer
    /// cannot grow in place and is copied instead.
    pub fn let_go(&mut self) {
        self.answer = None;
    }
}

/// A cache entry: an answer with its input, and the revision of the sequence that it has taken.
pub(super) struct IncrementalState<G: IncrementalQuery> {
    of: RevisionMark,
    input: G::Input,
    version: Arc<()>,
    answer: Arc<G>,
}

impl<G: IncrementalQuery> IncrementalState<G> {
    pub fn begin(revision: &Revision, input: &G::Input) -> Self {
        let answer = Arc::new(G::begin(input));
        Self { of: revision.mark(), input: input.clone(), version: Arc::default(), answer }
    }

    /// Takes at most `at_most` new items of the sequence, after truncating the answer to the items that are unchanged.
    pub fn follow(&mut self, input: &G::Input, items: &Sequence<G::Item>, at_most: usize) {
        let kept = items.revision().unchanged_since(&self.of).min(items.len());
        self.of = items.revision().mark();
        if self.answer.count() > kept {
            self.change().truncate(kept);
        }
        if self.input != *input {
            self.input = input.clone();
            self.change().set_input(input);
        }
        let mut remaining = at_most;
        loop {
            let count = self.answer.count();
            let together = items.from(count);
            let taken = &together[..together.len().min(remaining)];
            if taken.is_empty() {
                return;
            }
            self.change().take(taken);
            remaining -= taken.len();
            if self.answer.count() <= count {
                return;
            }
        }
    }

    fn change(&mut self) -> &mut G {
        self.version = Arc::default();
        Arc::make_mut(&mut self.answer)
    }

    pub fn grown(&self, count: usize) -> IncrementalAnswer<G> {
        let is_whole = self.answer.count() == count;
        IncrementalAnswer { version: self.version.clone(), answer: Some(self.answer.clone()), is_whole }
    }
}

/// Cache entries of one kind of growing answer, one for each sequence in use.
pub(super) struct IncrementalAnswers<G: IncrementalQuery>(Vec<IncrementalState<G>>);

impl<G: IncrementalQuery> Default for IncrementalAnswers<G> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<G: IncrementalQuery> AnySlot for IncrementalAnswers<G> {
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

impl<G: IncrementalQuery> IncrementalAnswers<G> {
    /// Removes and returns the entry that has most items in common with a revision, so that it grows outside of the
    /// store. Entries without common items stay while a sequence has their revision or lists it as an earlier one.
    /// Other entries with common items stay only while a sequence still has their revision.
    pub fn take(&mut self, revision: &Revision) -> Option<IncrementalState<G>> {
        let kept = |growth: &IncrementalState<G>| revision.unchanged_since(&growth.of);
        let best = (0..self.0.len()).max_by_key(|i| kept(&self.0[*i])).filter(|i| kept(&self.0[*i]) > 0);
        let found = best.map(|i| self.0.swap_remove(i));
        self.0.retain(|growth| match kept(growth) {
            0 => !growth.of.is_forgotten(),
            _ => growth.of.is_current(),
        });
        found
    }

    pub fn keep(&mut self, growth: IncrementalState<G>) {
        self.0.push(growth);
    }
}
