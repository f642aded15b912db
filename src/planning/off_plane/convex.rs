//! Quadratic and linear programs: least ½ xᵀ P x + q · x under linear equalities and inequalities, by an interior-point
//! method (Clarabel). The same program always has the same answer.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, ZeroConeT};

/// A program, row by row.
#[derive(Clone, Debug, Default)]
pub(super) struct Program {
    /// P above and on its diagonal: row, column, value; repeated places add up.
    quadratic: Vec<(usize, usize, f64)>,
    linear: Vec<f64>,
    equal: Rows,
    at_most: Rows,
}

#[derive(Clone, Debug, Default)]
struct Rows {
    entries: Vec<(usize, usize, f64)>,
    right: Vec<f64>,
}

impl Rows {
    fn push<const N: usize>(&mut self, row: [(usize, f64); N], right: f64) {
        let i = self.right.len();
        self.entries.extend(row.into_iter().filter(|(_, value)| *value != 0.0).map(|(j, value)| (i, j, value)));
        self.right.push(right);
    }
}

impl Program {
    /// Nothing to be least yet, over `n` unknowns.
    pub fn over(n: usize) -> Self {
        Self { linear: vec![0.0; n], ..Self::default() }
    }

    /// Adds factor · x_i x_j to what is to be least.
    pub fn add_product(&mut self, i: usize, j: usize, factor: f64) {
        // Twice the square on the diagonal, half of the sum of both halves beside it.
        self.quadratic.push((i.min(j), i.max(j), if i == j { 2.0 * factor } else { factor }));
    }

    /// Adds factor · x_i to what is to be least.
    pub fn add_linear(&mut self, i: usize, factor: f64) {
        self.linear[i] += factor;
    }

    /// Wants Σ value x_j = right.
    pub fn equal<const N: usize>(&mut self, row: [(usize, f64); N], right: f64) {
        self.equal.push(row, right);
    }

    /// Wants Σ value x_j ≤ right, if that is finite.
    pub fn at_most<const N: usize>(&mut self, row: [(usize, f64); N], right: f64) {
        if right.is_finite() {
            self.at_most.push(row, right);
        }
    }

    /// The x at which it is least, or the solver's word for why there is none.
    pub fn solve(&self) -> Result<Vec<f64>, String> {
        let n = self.linear.len();
        let p = sparse(n, n, self.quadratic.iter().copied());
        let below = self.equal.right.len();
        let rows = self.equal.entries.iter().copied();
        let rows = rows.chain(self.at_most.entries.iter().map(|&(i, j, value)| (below + i, j, value)));
        let right = [&self.equal.right[..], &self.at_most.right[..]].concat();
        let a = sparse(right.len(), n, rows);
        let mut cones = vec![ZeroConeT(below), NonnegativeConeT(right.len() - below)];
        cones.retain(|cone| !matches!(cone, ZeroConeT(0) | NonnegativeConeT(0)));
        let settings = DefaultSettings {
            verbose: false,
            max_iter: 100,
            tol_gap_abs: 1e-10,
            tol_gap_rel: 1e-10,
            tol_feas: 1e-11,
            ..DefaultSettings::default()
        };
        let mut solver =
            DefaultSolver::new(&p, &self.linear, &a, &right, &cones, settings).map_err(|e| e.to_string())?;
        solver.solve();
        match solver.solution.status {
            SolverStatus::Solved | SolverStatus::AlmostSolved => Ok(solver.solution.x),
            status => Err(status.to_string()),
        }
    }
}

fn sparse(m: usize, n: usize, entries: impl Iterator<Item = (usize, usize, f64)>) -> CscMatrix<f64> {
    let (mut rows, mut columns, mut values) = (Vec::new(), Vec::new(), Vec::new());
    for (i, j, value) in entries {
        rows.push(i);
        columns.push(j);
        values.push(value);
    }
    CscMatrix::new_from_triplets(m, n, rows, columns, values)
}
