//! Convex programs: minimise ½ xᵀ P x + q · x under linear equalities, inequalities and second-order cones, by an
//! interior-point method (Clarabel). The same program always has the same answer. The dual solution bounds how far the
//! answer is from the optimum.
//!
//! This crate serves the workspace alone, and may change in any version.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SecondOrderConeT, SolverStatus, ZeroConeT,
};
use thiserror::Error;

/// One row of a constraint: Σ value x_j, and the right side.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinearRow {
    /// Pairs of j and value; values at a repeated j add up.
    pub terms: Vec<(usize, f64)>,
    /// Right side.
    pub right: f64,
}

impl LinearRow {
    /// A row from its terms and its right side.
    pub fn new(terms: impl Into<Vec<(usize, f64)>>, right: f64) -> Self {
        Self { terms: terms.into(), right }
    }
}

/// A convex program, built row by row.
#[derive(Clone, Debug, Default)]
pub struct Program {
    /// Upper triangle of P, diagonal included: row, column, value. Repeated places add up.
    quadratic: Vec<(usize, usize, f64)>,
    /// q.
    pub linear: Vec<f64>,
    /// Equalities Σ value x_j = right.
    pub equal: Vec<LinearRow>,
    /// Inequalities Σ value x_j ≤ right, where right is finite.
    pub at_most: Vec<LinearRow>,
    /// Second-order cones a ≥ |(b, c, …)|, where a row gives each of a, b, c … as Σ value x_j + right.
    pub cones: Vec<Vec<LinearRow>>,
}

/// Solution of a program.
#[derive(Clone, Debug, PartialEq)]
pub struct Optimum {
    /// Unknowns.
    pub x: Vec<f64>,
    /// Value of the objective at `x`.
    pub value: f64,
    /// Multipliers of the equalities: by how much `value` falls per increase of the right side; empty without a program.
    pub multipliers: Vec<f64>,
    /// Duality gap: upper bound on `value` minus the optimum.
    pub gap: f64,
}

/// Why a program has no solution.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum NoOptimum {
    /// The program is infeasible; the numbers are the multipliers of the inequalities in the proof of infeasibility.
    #[error("what is wanted contradicts itself")]
    Contradiction(Vec<f64>),
    /// The solver failed; its status in words.
    #[error("the solver found no answer: {0}")]
    Failed(String),
}

/// Relative gap above which an answer is rough, so that a second attempt is made.
const ROUGH_GAP: f64 = 1e-7;

impl Program {
    /// Returns a program over `n` unknowns with objective zero and without constraints.
    pub fn over(n: usize) -> Self {
        Self { linear: vec![0.0; n], ..Self::default() }
    }

    /// Adds factor · x_i x_j to the objective.
    pub fn add_product(&mut self, i: usize, j: usize, factor: f64) {
        // P enters as ½ xᵀ P x: twice the factor on the diagonal. Off the diagonal P_ij and P_ji contribute one half
        // each.
        self.quadratic.push((i.min(j), i.max(j), if i == j { 2.0 * factor } else { factor }));
    }

    /// Adds the constraint x_u x_w ≥ Σ x_s² over the listed s, with x_u ≥ 0 and x_w ≥ 0.
    pub fn add_rotated_cone(&mut self, u: usize, w: usize, squared: impl IntoIterator<Item = usize>) {
        let mut cone = vec![LinearRow::new([(u, 1.0), (w, 1.0)], 0.0)];
        cone.extend(squared.into_iter().map(|s| LinearRow::new([(s, 2.0)], 0.0)));
        cone.push(LinearRow::new([(u, 1.0), (w, -1.0)], 0.0));
        self.cones.push(cone);
    }

    /// Adds the constraint x_v ≥ factor x_w².
    pub fn above_square(&mut self, v: usize, factor: f64, w: usize) {
        self.cones.push(vec![
            LinearRow::new([(v, 1.0)], 1.0),
            LinearRow::new([(w, 2.0 * factor.sqrt())], 0.0),
            LinearRow::new([(v, 1.0)], -1.0),
        ]);
    }

    /// Returns the x that minimises the objective. Fails if the program is infeasible or the solver finds no answer.
    pub fn solve(&self) -> Result<Optimum, NoOptimum> {
        let n = self.linear.len();
        let (mut entries, mut right) = (Vec::new(), Vec::new());
        // Clarabel takes constraints in the form: right − Σ lies in the cone.
        let linear = self.equal.iter().chain(&self.at_most).map(|row| (row, 1.0));
        for (i, (row, sign)) in linear.chain(self.cones.iter().flatten().map(|row| (row, -1.0))).enumerate() {
            entries.extend(row.terms.iter().map(|&(j, value)| (i, j, sign * value)));
            right.push(row.right);
        }
        let mut cones = vec![ZeroConeT(self.equal.len()), NonnegativeConeT(self.at_most.len())];
        cones.retain(|cone| !matches!(cone, ZeroConeT(0) | NonnegativeConeT(0)));
        cones.extend(self.cones.iter().map(|cone| SecondOrderConeT(cone.len())));
        let (a, p) = (sparse(right.len(), n, &entries), sparse(n, n, &self.quadratic));
        let (mut failed, mut rough): (String, Option<Optimum>) = (String::new(), None);
        // Close to the boundary of feasibility, a second attempt with larger tolerances may still succeed.
        for [gap_tolerance, feasibility_tolerance] in [[1e-10, 1e-11], [1e-8, 1e-9]] {
            let settings = DefaultSettings {
                verbose: false,
                max_iter: 200,
                tol_gap_abs: gap_tolerance,
                tol_gap_rel: gap_tolerance,
                tol_feas: feasibility_tolerance,
                ..DefaultSettings::default()
            };
            let mut solver = DefaultSolver::new(&p, &self.linear, &a, &right, &cones, settings)
                .map_err(|why| NoOptimum::Failed(why.to_string()))?;
            solver.solve();
            let found = solver.solution;
            match found.status {
                SolverStatus::Solved | SolverStatus::AlmostSolved => {
                    let gap = (found.obj_val - found.obj_val_dual).abs();
                    let multipliers = found.z[..self.equal.len()].to_vec();
                    let optimum = Optimum { x: found.x, value: found.obj_val, multipliers, gap };
                    // An answer that is almost solved may have a gap far above the tolerance.
                    if gap <= ROUGH_GAP * (1.0 + optimum.value.abs()) {
                        return Ok(optimum);
                    }
                    rough = rough.filter(|rough| rough.gap <= gap).or(Some(optimum));
                }
                SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => {
                    let from = self.equal.len();
                    return Err(NoOptimum::Contradiction(found.z[from..from + self.at_most.len()].to_vec()));
                }
                status => failed = status.to_string(),
            }
        }
        rough.ok_or(NoOptimum::Failed(failed))
    }
}

fn sparse(m: usize, n: usize, entries: &[(usize, usize, f64)]) -> CscMatrix<f64> {
    let entries = entries.iter().filter(|entry| entry.2 != 0.0);
    let column = |pick: fn(&(usize, usize, f64)) -> usize| entries.clone().map(pick).collect();
    CscMatrix::new_from_triplets(m, n, column(|e| e.0), column(|e| e.1), entries.clone().map(|e| e.2).collect())
}

/// Returns an irreducible infeasible subset of contradicting bounds: without any one of them, the others are feasible.
///
/// The bounds are the last inequalities of the program, and `multipliers` are those of the solver's proof of infeasibility;
/// there may be none. Starts from the bounds whose multipliers are not zero, or from all bounds if those do
/// not contradict each other. Then removes each bound without which the rest still contradicts itself.
pub fn infeasible_bounds<B: Clone>(
    bounds: Vec<(B, LinearRow)>,
    multipliers: &[f64],
    contradicts: impl Fn(&[(B, LinearRow)]) -> bool,
) -> Vec<B> {
    let own = multipliers.len().checked_sub(bounds.len()).map_or_else(Default::default, |first| &multipliers[first..]);
    let most = own.iter().fold(0.0_f64, |most, z| most.max(z.abs()));
    let used = bounds.iter().zip(own).filter(|(_, z)| z.abs() > 1e-7 * most).map(|(bound, _)| bound.clone());
    let mut kept: Vec<(B, LinearRow)> = used.collect();
    if !contradicts(&kept) {
        kept = bounds;
    }
    let mut i = 0;
    while i < kept.len() {
        let mut without = kept.clone();
        without.remove(i);
        match contradicts(&without) {
            true => kept = without,
            false => i += 1,
        }
    }
    kept.into_iter().map(|(bound, _)| bound).collect()
}
