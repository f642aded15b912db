//! [`SearchNode`]: one subproblem of the search for counterweights.

use super::cell::{DiscPlace, SearchCell};
use super::pin_sector::PinSector;
use super::refusal::{BoundKind, RelaxedBounds};
use super::spec::CounterweightSpec;

/// Form of the balance conditions (7) and (8).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum BalanceGoal {
    /// The conditions hold exactly.
    Exact,
    /// The largest residual over a range of payloads is the objective.
    Nearest,
    /// The largest residual over a range of payloads is at most this, in the unit of (7); (8) counts divided by the
    /// reach.
    Within(f64),
}

/// One subproblem of the search for counterweights.
#[derive(Clone, Debug)]
pub(super) struct SearchNode {
    /// Directions chosen for the disc of each site from pins of its link.
    pub sectors: Vec<Vec<PinSector>>,
    pub balance: BalanceGoal,
    /// Upper bound of the objective. If set, added mass and Σ H_kk are minimised instead, to choose among optima.
    pub most: Option<f64>,
    /// Kinds of bounds that are dropped.
    pub loose: Vec<BoundKind>,
    /// Bounds that are minimised instead of the objective.
    pub least: Option<RelaxedBounds>,
    /// Ranges of mass and position of each counterweight; they apply only if the objective contains |D_k|.
    pub cells: Vec<SearchCell>,
    /// Discs at which H_kk is linearised in −D_k ≤ |D_k|, so that this bound is convex. The
    /// linearised inertia is a lower bound, so |D_k| is not underestimated.
    pub tangents: Option<Vec<DiscPlace>>,
    /// Masses at which the own inertia of each counterweight is bounded by tangents, where it has a remainder
    /// beyond its powers of the mass.
    pub own_tangents: Vec<Vec<f64>>,
}

impl SearchNode {
    /// Returns the subproblem without choices: no clearance of pins, and cells as wide as the bounds.
    pub fn unconstrained(request: &CounterweightSpec, balance: BalanceGoal) -> Self {
        Self {
            sectors: vec![Vec::new(); request.sites.len()],
            balance,
            most: None,
            loose: Vec::new(),
            least: None,
            cells: request.sites.iter().map(|site| SearchCell::of(request, site)).collect(),
            tangents: None,
            own_tangents: vec![vec![0.0]; request.sites.len()],
        }
    }
}
