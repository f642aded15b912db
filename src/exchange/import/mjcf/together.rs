//! [`CoupledSets`]: the sets of parts that turn together.

/// Disjoint sets of parts that turn together; the last index is the base.
pub(super) struct CoupledSets {
    of: Vec<usize>,
}

impl CoupledSets {
    /// Begins with each part in a separate set.
    pub fn new(parts: usize) -> Self {
        Self { of: (0..=parts).collect() }
    }

    fn base(&self) -> usize {
        self.of.len() - 1
    }

    /// Returns the representative of a part's set.
    pub fn root(&self, mut i: usize) -> usize {
        while self.of[i] != i {
            i = self.of[i];
        }
        i
    }

    /// Joins two sets; the base, or else the lower index, represents both.
    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        let (root, child) = if b == self.base() { (b, a) } else { (a.min(b), a.max(b)) };
        let (root, child) = if a == self.base() { (a, b) } else { (root, child) };
        self.of[child] = root;
    }
}
