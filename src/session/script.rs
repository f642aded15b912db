//! [`Script`]: the edits of a document, in the order of steps. Versions of a script share their common beginning, so
//! another version stores only the edits that it adds.

use std::sync::Arc;

use super::{Edit, TimedEdit};

/// Edits in the order of steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Script {
    last: Option<Arc<Entry>>,
    count: usize,
}

#[derive(Debug)]
struct Entry {
    timed: TimedEdit,
    /// Whether the user has dragged the machine off its planned motion, in this edit or before.
    is_dragged: bool,
    before: Option<Arc<Self>>,
}

impl Drop for Entry {
    fn drop(&mut self) {
        // In a loop: dropping the chain recursively could overflow the stack.
        let mut next = self.before.take();
        while let Some(mut entry) = next.and_then(Arc::into_inner) {
            next = entry.before.take();
        }
    }
}

impl Script {
    /// Adds an edit at the end.
    pub fn push(&mut self, timed: TimedEdit) {
        let leads = timed.edit.is_drag() || (timed.step > 0 && matches!(timed.edit, Edit::PoseB { .. }));
        let is_dragged = leads || self.is_dragged();
        self.last = Some(Arc::new(Entry { timed, is_dragged, before: self.last.take() }));
        self.count += 1;
    }

    /// Removes the last edit.
    pub fn pop(&mut self) {
        if let Some(entry) = self.last.take() {
            self.last.clone_from(&entry.before);
            self.count -= 1;
        }
    }

    /// Returns the last edit.
    pub fn last(&self) -> Option<&TimedEdit> {
        self.last.as_ref().map(|entry| &entry.timed)
    }

    /// Returns whether the script contains the same edits as another.
    pub fn is(&self, other: &Self) -> bool {
        let mut pairs = self.entries().zip(other.entries());
        // All entries before a shared entry are shared too.
        let same = pairs.find(|(own, other)| Arc::ptr_eq(own, other) || own.timed != other.timed);
        self.count == other.count && same.is_none_or(|(own, other)| Arc::ptr_eq(own, other))
    }

    /// Returns the number of edits.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Returns whether the user has dragged the machine off its planned motion.
    pub fn is_dragged(&self) -> bool {
        self.last.as_ref().is_some_and(|entry| entry.is_dragged)
    }

    /// Removes the edits after a step.
    pub fn truncate(&mut self, end: u64) {
        while self.last().is_some_and(|timed| timed.step > end) {
            self.pop();
        }
    }

    /// Returns copies of all edits, in order.
    pub fn to_vec(&self) -> Vec<TimedEdit> {
        self.in_order().into_iter().cloned().collect()
    }

    /// Returns references to all edits, in order.
    pub fn in_order(&self) -> Vec<&TimedEdit> {
        let mut all: Vec<&TimedEdit> = self.entries().map(|entry| &entry.timed).collect();
        all.reverse();
        all
    }

    /// Returns a script of other edits, which shares the common beginning with this one.
    pub fn replaced(&self, edits: Vec<TimedEdit>) -> Self {
        let mut own: Vec<&Arc<Entry>> = self.entries().collect();
        own.reverse();
        let same = own.iter().zip(&edits).take_while(|(own, new)| own.timed == **new).count();
        let last = same.checked_sub(1).map(|i| own[i].clone());
        let mut script = Self { last, count: same };
        edits.into_iter().skip(same).for_each(|timed| script.push(timed));
        script
    }

    /// Yields the entries from the last to the first.
    fn entries(&self) -> impl Iterator<Item = &Arc<Entry>> {
        std::iter::successors(self.last.as_ref(), |entry| entry.before.as_ref())
    }
}

impl FromIterator<TimedEdit> for Script {
    fn from_iter<T: IntoIterator<Item = TimedEdit>>(edits: T) -> Self {
        let mut script = Self::default();
        edits.into_iter().for_each(|timed| script.push(timed));
        script
    }
}
