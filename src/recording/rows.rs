//! Rows that gather until they are written.

use super::store::{Clock, Instant};

/// Rows of something that changes rarely: equal ones are left out.
#[derive(Debug)]
pub struct Track<T> {
    clock: Clock,
    rows: Vec<T>,
    last: Option<T>,
}

impl<T: Clone + PartialEq> Track<T> {
    /// No row.
    pub fn new() -> Self {
        Self { clock: Clock::default(), rows: Vec::new(), last: None }
    }

    /// What holds from an instant on.
    pub fn push(&mut self, at: Instant, row: T) {
        if self.last.as_ref() != Some(&row) {
            self.clock.push(at);
            self.rows.push(row.clone());
            self.last = Some(row);
        }
    }

    /// Whether there never was a row.
    pub fn is_new(&self) -> bool {
        self.last.is_none()
    }

    /// What holds now.
    pub fn last(&self) -> Option<&T> {
        self.last.as_ref()
    }

    /// The rows since the last time.
    pub fn take(&mut self) -> (Clock, Vec<T>) {
        (std::mem::take(&mut self.clock), std::mem::take(&mut self.rows))
    }
}

/// Every so many items, and never more than so many: past that, every other goes.
#[derive(Debug)]
pub struct Thinned<T> {
    items: Vec<T>,
    every: u64,
    seen: u64,
    most: usize,
}

impl<T> Thinned<T> {
    /// No item.
    pub fn new(every: u64, most: usize) -> Self {
        Self { items: Vec::new(), every: every.max(1), seen: 0, most }
    }

    /// One more; the last one of all is kept whatever its turn.
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

    /// What was kept.
    pub fn take(&mut self) -> Vec<T> {
        std::mem::take(&mut self.items)
    }
}
