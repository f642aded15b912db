//! [`SmallList`]: a list of fixed capacity on the stack.

/// A list of fixed capacity on the stack: items beyond the capacity are dropped.
pub(super) struct SmallList<T, const N: usize> {
    pub len: usize,
    pub items: [T; N],
}

impl<T: Copy, const N: usize> SmallList<T, N> {
    /// Returns an empty list; the filler is never read.
    pub fn new(filler: T) -> Self {
        Self { len: 0, items: [filler; N] }
    }

    /// Appends an item.
    pub fn push(&mut self, item: T) {
        if self.len < N {
            self.items[self.len] = item;
            self.len += 1;
        }
    }

    /// Returns all items.
    pub fn as_slice(&self) -> &[T] {
        &self.items[..self.len]
    }
}
