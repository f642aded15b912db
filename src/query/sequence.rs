//! [`Sequence`]: items that are mostly appended, stored in shared pieces. Its [`Revision`] shows how many of the first
//! items are unchanged since an earlier revision.

use std::ops::Index;
use std::sync::{Arc, Weak};

/// Number of items in a piece. Appending to a clone copies one piece at most.
const PIECE_LEN: usize = 256;

/// Maximum number of earlier revisions that a revision remembers.
const MAX_REMEMBERED: usize = 32;

/// Items in order. Clones share the items, so that cloning is cheap at any length.
#[derive(Clone, Debug)]
pub struct Sequence<T> {
    /// All pieces but the last have `PIECE_LEN` items.
    pieces: Vec<Arc<Vec<T>>>,
    revision: Revision,
}

impl<T> Default for Sequence<T> {
    fn default() -> Self {
        Self { pieces: Vec::new(), revision: Revision::new() }
    }
}

impl<T: Clone> Sequence<T> {
    /// Appends an item.
    pub fn push(&mut self, item: T) {
        // Another clone may be extended differently.
        if self.revision.is_shared() {
            self.revision = self.revision.changed_after(self.len());
        }
        match self.pieces.last_mut() {
            Some(last) if last.len() < PIECE_LEN => Arc::make_mut(last).push(item),
            _ => {
                let mut piece = Vec::with_capacity(PIECE_LEN);
                piece.push(item);
                self.pieces.push(Arc::new(piece));
            }
        }
    }

    /// Replaces the last item; an empty sequence stays empty.
    pub fn replace_last(&mut self, item: T) {
        self.revision = self.revision.changed_after(self.len().saturating_sub(1));
        if let Some(last) = self.pieces.last_mut().and_then(|last| Arc::make_mut(last).last_mut()) {
            *last = item;
        }
    }

    /// Keeps the first `count` items.
    pub fn truncate(&mut self, count: usize) {
        if count >= self.len() {
            return;
        }
        self.revision = self.revision.changed_after(count);
        self.pieces.truncate(count.div_ceil(PIECE_LEN));
        if let Some(last) = self.pieces.last_mut().filter(|_| !count.is_multiple_of(PIECE_LEN)) {
            Arc::make_mut(last).truncate(count % PIECE_LEN);
        }
    }

    /// Returns all items in one vector.
    pub fn to_vec(&self) -> Vec<T> {
        self.iter().cloned().collect()
    }
}

impl<T> Sequence<T> {
    /// Returns the revision.
    #[doc(hidden)]
    pub fn revision(&self) -> &Revision {
        &self.revision
    }

    /// Returns the number of items.
    pub fn len(&self) -> usize {
        self.pieces.last().map_or(0, |last| (self.pieces.len() - 1) * PIECE_LEN + last.len())
    }

    /// Returns whether there are no items.
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// Returns an item by its index.
    pub fn get(&self, place: usize) -> Option<&T> {
        self.pieces.get(place / PIECE_LEN)?.get(place % PIECE_LEN)
    }

    /// Returns the first item.
    pub fn first(&self) -> Option<&T> {
        self.get(0)
    }

    /// Returns the last item.
    pub fn last(&self) -> Option<&T> {
        self.pieces.last()?.last()
    }

    /// Iterates over all items, in order.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &T> + Clone {
        self.pieces.iter().flat_map(|piece| piece.iter())
    }

    /// Returns the items from an index to the end of its piece; empty past the end.
    pub fn from(&self, place: usize) -> &[T] {
        self.pieces.get(place / PIECE_LEN).and_then(|piece| piece.get(place % PIECE_LEN..)).unwrap_or_default()
    }

    /// Returns the number of leading items that satisfy `is_first`, by bisection. No item after the first failure may
    /// satisfy it.
    pub fn partition_point(&self, is_first: impl Fn(&T) -> bool) -> usize {
        let whole = self.pieces.partition_point(|piece| piece.last().is_some_and(&is_first));
        self.pieces.get(whole).map_or(self.len(), |piece| whole * PIECE_LEN + piece.partition_point(is_first))
    }
}

impl<T> Index<usize> for Sequence<T> {
    type Output = T;

    fn index(&self, place: usize) -> &T {
        &self.pieces[place / PIECE_LEN][place % PIECE_LEN]
    }
}

impl<'a, T> IntoIterator for &'a Sequence<T> {
    type Item = &'a T;
    type IntoIter = std::iter::FlatMap<std::slice::Iter<'a, Arc<Vec<T>>>, &'a [T], fn(&'a Arc<Vec<T>>) -> &'a [T]>;

    fn into_iter(self) -> Self::IntoIter {
        let slice: fn(&'a Arc<Vec<T>>) -> &'a [T] = |piece| piece;
        self.pieces.iter().flat_map(slice)
    }
}

impl<T: Clone> FromIterator<T> for Sequence<T> {
    fn from_iter<I: IntoIterator<Item = T>>(items: I) -> Self {
        let mut all = Self::default();
        items.into_iter().for_each(|item| all.push(item));
        all
    }
}

/// Compares the items; revisions do not matter.
impl<T: PartialEq> PartialEq for Sequence<T> {
    fn eq(&self, other: &Self) -> bool {
        let mut pairs = self.pieces.iter().zip(&other.pieces);
        self.len() == other.len() && pairs.all(|(one, other)| Arc::ptr_eq(one, other) || one == other)
    }
}

impl<T: PartialEq> PartialEq<[T]> for Sequence<T> {
    fn eq(&self, other: &[T]) -> bool {
        self.len() == other.len() && self.iter().eq(other)
    }
}

impl<T: PartialEq> PartialEq<Vec<T>> for Sequence<T> {
    fn eq(&self, other: &Vec<T>) -> bool {
        *self == other[..]
    }
}

/// Identifies a state of a sequence. As long as the revision is the same, items have only been appended.
#[derive(Clone, Debug)]
pub struct Revision {
    own: Arc<()>,
    /// Shared by clones of this revision only, not by later revisions that remember it.
    alive: Arc<()>,
    /// Earlier revisions, and how many of their first items are unchanged.
    before: Vec<(Arc<()>, usize)>,
}

/// Weak reference to a revision, for comparison with later ones.
#[derive(Clone, Debug)]
pub struct RevisionMark {
    own: Weak<()>,
    alive: Weak<()>,
}

impl RevisionMark {
    /// Returns whether a sequence still has this revision.
    pub fn is_current(&self) -> bool {
        self.alive.strong_count() > 0
    }

    /// Returns whether no sequence has this revision or remembers it.
    pub fn is_forgotten(&self) -> bool {
        self.own.strong_count() == 0
    }
}

impl Revision {
    /// Returns a revision that differs from all others.
    fn new() -> Self {
        Self { own: Arc::new(()), alive: Arc::new(()), before: Vec::new() }
    }

    /// Returns the revision after a change of all items but the first `kept`.
    fn changed_after(&self, kept: usize) -> Self {
        let older = self.before.iter().map(|(earlier, count)| (earlier.clone(), kept.min(*count)));
        let known = std::iter::once((self.own.clone(), kept)).chain(older).filter(|(_, count)| *count > 0);
        let before = known.take(MAX_REMEMBERED).collect();
        Self { before, ..Self::new() }
    }

    /// Returns whether another sequence has this revision too.
    fn is_shared(&self) -> bool {
        Arc::strong_count(&self.alive) > 1
    }

    /// Returns a weak reference, for comparison with later revisions.
    pub fn mark(&self) -> RevisionMark {
        RevisionMark { own: Arc::downgrade(&self.own), alive: Arc::downgrade(&self.alive) }
    }

    /// Returns how many leading items are unchanged since an earlier revision: `usize::MAX` if it is this revision, 0
    /// if it is unknown.
    pub fn unchanged_since(&self, earlier: &RevisionMark) -> usize {
        let is_it = |own: &Arc<()>| std::ptr::eq(Arc::as_ptr(own), earlier.own.as_ptr());
        if is_it(&self.own) {
            return usize::MAX;
        }
        self.before.iter().find(|(own, _)| is_it(own)).map_or(0, |(_, count)| *count)
    }
}

impl PartialEq for Revision {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.own, &other.own)
    }
}
