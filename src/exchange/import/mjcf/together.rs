//! [`Together`]: which sets turn as one.

/// Which sets turn together; the last is the base.
pub(super) struct Together {
    of: Vec<usize>,
}

impl Together {
    /// Each of so many parts by itself.
    pub fn new(parts: usize) -> Self {
        Self { of: (0..=parts).collect() }
    }

    fn base(&self) -> usize {
        self.of.len() - 1
    }

    /// What stands for all that turn with one.
    pub fn root(&self, mut i: usize) -> usize {
        while self.of[i] != i {
            i = self.of[i];
        }
        i
    }

    /// Both turn as one; the base, or else the first of them, stands for both.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        let (stands, follows) = if b == self.base() { (b, a) } else { (a.min(b), a.max(b)) };
        let (stands, follows) = if a == self.base() { (a, b) } else { (stands, follows) };
        self.of[follows] = stands;
    }
}
