//! [`Few`]: a list on the stack.

/// A list on the stack: what does not fit is dropped.
pub(super) struct Few<T, const N: usize> {
    pub len: usize,
    pub items: [T; N],
}

impl<T: Copy, const N: usize> Few<T, N> {
    /// Nothing; the filler is never seen.
    pub fn new(filler: T) -> Self {
        Self { len: 0, items: [filler; N] }
    }

    /// One more.
    pub fn push(&mut self, item: T) {
        if self.len < N {
            self.items[self.len] = item;
            self.len += 1;
        }
    }

    /// All.
    pub fn as_slice(&self) -> &[T] {
        &self.items[..self.len]
    }
}
