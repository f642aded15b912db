//! [`Envelope`]: a symmetric matrix in envelope (skyline) storage, with Cholesky factorisation.

/// A symmetric matrix. For each row it stores the entries from the first non-zero one to the diagonal.
#[derive(Clone, Debug)]
pub(super) struct Envelope {
    first: Vec<usize>,
    start: Vec<usize>,
    values: Vec<f64>,
}

/// Relative pivot tolerance: a pivot below this fraction of its diagonal entry is treated as zero.
const PIVOT_TOLERANCE: f64 = 1e-12;

impl Envelope {
    /// Returns a zero matrix whose rows begin at the given columns.
    pub fn zeros(first: Vec<usize>) -> Self {
        let mut start = Vec::with_capacity(first.len() + 1);
        let mut size = 0;
        for (i, first) in first.iter().enumerate() {
            start.push(size);
            size += i + 1 - first;
        }
        start.push(size);
        Self { first, start, values: vec![0.0; size] }
    }

    /// Sets all entries to zero.
    pub fn clear(&mut self) {
        self.values.fill(0.0);
    }

    /// Returns the entry of row i and column j ≤ i.
    pub fn entry(&mut self, i: usize, j: usize) -> &mut f64 {
        &mut self.values[self.start[i] + j - self.first[i]]
    }

    fn row(&self, i: usize) -> &[f64] {
        &self.values[self.start[i]..self.start[i + 1]]
    }

    /// Returns the product with a vector.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; x.len()];
        for (i, own) in x.iter().enumerate() {
            let (from, row) = (self.first[i], self.row(i));
            for (j, value) in (from..i).zip(row) {
                product[i] += value * x[j];
                product[j] += value * own;
            }
            product[i] += row[i - from] * own;
        }
        product
    }

    /// Replaces the matrix by its Cholesky factor. Returns `false` if it is not positive definite.
    pub fn factor(&mut self) -> bool {
        for i in 0..self.first.len() {
            let from = self.first[i];
            let (before, own) = self.values.split_at_mut(self.start[i]);
            let own = &mut own[..=i - from];
            let whole = own[i - from];
            for j in from..i {
                let begin = self.first[j].max(from);
                let other = &before[self.start[j]..self.start[j + 1]];
                let sum: f64 =
                    own[begin - from..j - from].iter().zip(&other[begin - self.first[j]..]).map(|(x, y)| x * y).sum();
                own[j - from] = (own[j - from] - sum) / other[j - self.first[j]];
            }
            let pivot = whole - own[..i - from].iter().map(|x| x * x).sum::<f64>();
            if pivot.is_nan() || pivot <= PIVOT_TOLERANCE * whole.abs() {
                return false;
            }
            own[i - from] = pivot.sqrt();
        }
        true
    }

    /// Solves the factorised equations in place.
    pub fn solve(&self, x: &mut [f64]) {
        for i in 0..x.len() {
            let (row, from) = (self.row(i), self.first[i]);
            let known: f64 = row[..i - from].iter().zip(&x[from..i]).map(|(l, x)| l * x).sum();
            x[i] = (x[i] - known) / row[i - from];
        }
        for i in (0..x.len()).rev() {
            let (row, from) = (self.row(i), self.first[i]);
            x[i] /= row[i - from];
            let own = x[i];
            x[from..i].iter_mut().zip(row).for_each(|(x, l)| *x -= l * own);
        }
    }
}
