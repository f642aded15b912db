//! A [`Sequence`]: items that are mostly appended, shared in pieces, with a [`Revision`] that tells how many of the
//! first items are still those of before.

use std::ops::Index;
use std::sync::{Arc, Weak};

/// Items in a piece: a copy that is appended to copies one piece at most.
const PIECE: usize = 256;

/// How many changes back are remembered.
const REMEMBERED: usize = 32;

/// Items in order. Copies share them, so a copy costs little however long it is.
#[derive(Clone, Debug)]
pub struct Sequence<T> {
    /// All of the same length but the last.
    pieces: Vec<Arc<Vec<T>>>,
    revision: Revision,
}

impl<T> Default for Sequence<T> {
    fn default() -> Self {
        Self { pieces: Vec::new(), revision: Revision::new() }
    }
}

impl<T: Clone> Sequence<T> {
    /// One more item at the end.
    pub fn push(&mut self, item: T) {
        // A copy may go on in another way.
        if self.revision.is_shared() {
            self.revision = self.revision.changed_after(self.len());
        }
        match self.pieces.last_mut() {
            Some(last) if last.len() < PIECE => Arc::make_mut(last).push(item),
            _ => {
                let mut piece = Vec::with_capacity(PIECE);
                piece.push(item);
                self.pieces.push(Arc::new(piece));
            }
        }
    }

    /// Puts another item in place of the last; nothing happens if there is none.
    pub fn replace_last(&mut self, item: T) {
        self.revision = self.revision.changed_after(self.len().saturating_sub(1));
        if let Some(last) = self.pieces.last_mut().and_then(|last| Arc::make_mut(last).last_mut()) {
            *last = item;
        }
    }

    /// Keeps the first so many items.
    pub fn truncate(&mut self, count: usize) {
        if count >= self.len() {
            return;
        }
        self.revision = self.revision.changed_after(count);
        self.pieces.truncate(count.div_ceil(PIECE));
        if let Some(last) = self.pieces.last_mut().filter(|_| !count.is_multiple_of(PIECE)) {
            Arc::make_mut(last).truncate(count % PIECE);
        }
    }

    /// All items in one vector.
    pub fn to_vec(&self) -> Vec<T> {
        self.iter().cloned().collect()
    }
}

impl<T> Sequence<T> {
    /// Which revision it is.
    pub fn revision(&self) -> &Revision {
        &self.revision
    }

    /// How many items there are.
    pub fn len(&self) -> usize {
        self.pieces.last().map_or(0, |last| (self.pieces.len() - 1) * PIECE + last.len())
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.pieces.is_empty()
    }

    /// An item by its place.
    pub fn get(&self, place: usize) -> Option<&T> {
        self.pieces.get(place / PIECE)?.get(place % PIECE)
    }

    /// The first item.
    pub fn first(&self) -> Option<&T> {
        self.get(0)
    }

    /// The last item.
    pub fn last(&self) -> Option<&T> {
        self.pieces.last()?.last()
    }

    /// All items, in order.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = &T> + Clone {
        self.pieces.iter().flat_map(|piece| piece.iter())
    }

    /// Items from a place on, as many as lie together; none past the end.
    pub fn from(&self, place: usize) -> &[T] {
        self.pieces.get(place / PIECE).and_then(|piece| piece.get(place % PIECE..)).unwrap_or_default()
    }

    /// How many of the first items have a property that only first items have.
    pub fn partition_point(&self, is_first: impl Fn(&T) -> bool) -> usize {
        let whole = self.pieces.partition_point(|piece| piece.last().is_some_and(&is_first));
        self.pieces.get(whole).map_or(self.len(), |piece| whole * PIECE + piece.partition_point(is_first))
    }
}

impl<T> Index<usize> for Sequence<T> {
    type Output = T;

    fn index(&self, place: usize) -> &T {
        &self.pieces[place / PIECE][place % PIECE]
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

/// By what they hold, whatever their revisions.
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

/// As long as it is the same, items are only appended.
#[derive(Clone, Debug)]
pub struct Revision {
    own: Arc<()>,
    /// Shared by those alone that are this one, not by those that remember it.
    had: Arc<()>,
    /// Earlier ones, and how many of their first items are still the same.
    before: Vec<(Arc<()>, usize)>,
}

/// A revision to be compared with later ones.
#[derive(Clone, Debug)]
pub struct Mark {
    own: Weak<()>,
    had: Weak<()>,
}

impl Mark {
    /// Whether a sequence has it still.
    pub fn is_had(&self) -> bool {
        self.had.strong_count() > 0
    }

    /// Whether no sequence has it, or remembers that it had it.
    pub fn has_ended(&self) -> bool {
        self.own.strong_count() == 0
    }
}

impl Revision {
    /// Another one than all before.
    fn new() -> Self {
        Self { own: Arc::new(()), had: Arc::new(()), before: Vec::new() }
    }

    /// What it becomes where all items change but the first so many.
    fn changed_after(&self, kept: usize) -> Self {
        let older = self.before.iter().map(|(earlier, count)| (earlier.clone(), kept.min(*count)));
        let known = std::iter::once((self.own.clone(), kept)).chain(older).filter(|(_, count)| *count > 0);
        let before = known.take(REMEMBERED).collect();
        Self { before, ..Self::new() }
    }

    /// Whether another sequence has it too.
    fn is_shared(&self) -> bool {
        Arc::strong_count(&self.had) > 1
    }

    /// To be compared with later ones.
    pub fn mark(&self) -> Mark {
        Mark { own: Arc::downgrade(&self.own), had: Arc::downgrade(&self.had) }
    }

    /// How many of the first items are those of an earlier revision: all if it is the same, none if nothing is known of it.
    pub fn kept_of(&self, earlier: &Mark) -> usize {
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
