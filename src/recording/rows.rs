//! Rows of an entity, kept until they are written.

use super::store::{Clock, Instant};

/// Rows of something that changes rarely: equal ones are left out.
#[derive(Debug)]
pub struct Track<T> {
    clock: Clock,
    rows: Vec<T>,
    last: Option<T>,
}

impl<T: Clone + PartialEq> Track<T> {
    /// Without a row.
    pub fn new() -> Self {
        Self { clock: Clock::default(), rows: Vec::new(), last: None }
    }

    /// Adds a row at an instant, unless it equals the last one.
    pub fn push(&mut self, at: Instant, row: T) {
        if self.last.as_ref() != Some(&row) {
            self.clock.push(at);
            self.rows.push(row.clone());
            self.last = Some(row);
        }
    }

    /// The last row there was.
    pub fn last(&self) -> Option<&T> {
        self.last.as_ref()
    }

    /// Hands over the rows since it was last asked, with their instants.
    pub fn take(&mut self) -> (Clock, Vec<T>) {
        (std::mem::take(&mut self.clock), std::mem::take(&mut self.rows))
    }
}

/// Keeps every n-th item, and at most `most` of them: when there are more, it drops every other one and doubles n.
#[derive(Debug)]
pub struct Thinned<T> {
    items: Vec<T>,
    every: u64,
    seen: u64,
    most: usize,
}

impl<T> Thinned<T> {
    /// Nothing kept so far, to keep every n-th item from now on.
    pub fn new(every: u64, most: usize) -> Self {
        Self { items: Vec::new(), every: every.max(1), seen: 0, most }
    }

    /// Takes the next item, and keeps it if it is the n-th or the last of all.
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

    /// Hands over what was kept.
    pub fn take(&mut self) -> Vec<T> {
        std::mem::take(&mut self.items)
    }
}
