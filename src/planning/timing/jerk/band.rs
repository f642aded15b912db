//! [`Band`]: a symmetric pentadiagonal matrix.

/// A symmetric pentadiagonal matrix, or its factors L D Lᵀ in the same storage.
pub(super) struct Band {
    /// For each row the diagonal entry and the two entries right of it.
    pub rows: Vec<[f64; 3]>,
}

impl Band {
    /// Returns a zero matrix of n rows.
    pub fn new(n: usize) -> Self {
        Self { rows: vec![[0.0; 3]; n] }
    }

    /// Sets all entries to zero.
    pub fn clear(&mut self) {
        self.rows.fill([0.0; 3]);
    }

    /// Adds a symmetric 3×3 block at three neighbouring rows, given by its upper triangle row by row.
    pub fn add(&mut self, first: usize, sum: &[f64; 6]) {
        let [a, b, c] = &mut self.rows[first..first + 3] else { return };
        (0..3).for_each(|k| a[k] += sum[k]);
        (0..2).for_each(|k| b[k] += sum[3 + k]);
        c[0] += sum[5];
    }

    /// Replaces the matrix by its factors; `None` if it is not positive definite.
    pub fn factor(&mut self) -> Option<()> {
        for i in 0..self.rows.len() {
            let [d, p, q] = self.rows[i];
            if !(d > 0.0 && d.is_finite()) {
                return None;
            }
            let (l, m) = (p / d, q / d);
            self.rows[i] = [d, l, m];
            if let Some(next) = self.rows.get_mut(i + 1) {
                next[0] -= l * p;
                next[1] -= l * q;
            }
            if let Some(next) = self.rows.get_mut(i + 2) {
                next[0] -= m * q;
            }
        }
        Some(())
    }

    /// Solves the factorised equations in place.
    pub fn solve(&self, x: &mut [f64]) {
        let n = x.len();
        for i in 0..n {
            let [_, l, m] = self.rows[i];
            if i + 1 < n {
                x[i + 1] -= l * x[i];
            }
            if i + 2 < n {
                x[i + 2] -= m * x[i];
            }
        }
        for i in (0..n).rev() {
            let [d, l, m] = self.rows[i];
            let mut sum = x[i] / d;
            if i + 1 < n {
                sum -= l * x[i + 1];
            }
            if i + 2 < n {
                sum -= m * x[i + 2];
            }
            x[i] = sum;
        }
    }
}
