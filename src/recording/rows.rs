//! Rows of an entity, buffered until they are written.

use super::store::{Instant, RowTimes};

/// Rows of a component that changes rarely; rows equal to their predecessor are omitted.
#[derive(Debug)]
pub struct SparseRows<T> {
    clock: RowTimes,
    rows: Vec<T>,
    last: Option<T>,
}

impl<T: Clone + PartialEq> SparseRows<T> {
    /// Returns an empty list of rows.
    pub fn new() -> Self {
        Self { clock: RowTimes::default(), rows: Vec::new(), last: None }
    }

    /// Adds a row at an instant, unless it equals the last one.
    pub fn push(&mut self, at: Instant, row: T) {
        if self.last.as_ref() != Some(&row) {
            self.clock.push(at);
            self.rows.push(row.clone());
            self.last = Some(row);
        }
    }

    /// Returns the last row, even if it has been taken.
    pub fn last(&self) -> Option<&T> {
        self.last.as_ref()
    }

    /// Returns and removes the buffered rows with their instants.
    pub fn take(&mut self) -> (RowTimes, Vec<T>) {
        (std::mem::take(&mut self.clock), std::mem::take(&mut self.rows))
    }
}

/// A list of every n-th item, with at most `most` items besides the last: if there are more, every other one is
/// dropped and n is
/// doubled.
#[derive(Debug)]
pub struct Thinned<T> {
    items: Vec<T>,
    every: u64,
    seen: u64,
    most: usize,
}

impl<T> Thinned<T> {
    /// Returns an empty list that keeps every n-th item, n = `every`.
    pub fn new(every: u64, most: usize) -> Self {
        Self { items: Vec::new(), every: every.max(1), seen: 0, most }
    }

    /// Counts the next item, and keeps it if its number is a multiple of n or if it is the last one.
    pub fn push(&mut self, item: impl FnOnce() -> T, last: bool) {
        if self.seen.is_multiple_of(self.every) || last {
            self.items.push(item());
            if self.items.len() > self.most && !last {
                let mut keep = false;
                self.items.retain(|_| {
                    keep = !keep;
                    keep
                });
                self.every *= 2;
            }
        }
        self.seen += 1;
    }

    /// Returns and removes the kept items.
    pub fn take(&mut self) -> Vec<T> {
        std::mem::take(&mut self.items)
    }
}
