//! [`relaxed_weights_if_any`]: counterweights that balance a machine with bounds as tight as they can be.

use super::place::PlacedCounterweights;
use super::problem::CounterweightProblem;
use super::refusal::{BoundKind, CounterweightError, RelaxedBounds};
use super::search_node::SearchNode;
use super::spec::{CounterweightSpec, Objective};
use super::subject::Subject;
use super::task::CounterweightTask;
use crate::assembly::Assembly;
use crate::machine::Machine;
use stillbase_convex::NoOptimum;

/// Finds counterweights that balance a machine, (7) and (8), and minimise some of the bounds of a request instead of its
/// objective. The value of the answer is that of the bounds, kg or kg m², or their factor. The other bounds hold. `None` if
/// no value of these bounds is sufficient.
///
/// # Errors
/// If the request is not valid, a condition cannot be changed, or the search or the solver gives up.
pub fn relaxed_weights_if_any(
    machine: &Machine,
    request: &CounterweightSpec,
    relaxed: RelaxedBounds,
) -> Result<Option<PlacedCounterweights>, CounterweightError> {
    let whole = Assembly::from(machine.clone());
    let subject = Subject::machine(&whole, &[]);
    let problem = CounterweightProblem::new(&subject, request)?;
    problem.check(&subject)?;
    let spec = CounterweightSpec { objective: Objective::mass(), ..request.clone() };
    let task = CounterweightTask::new(&problem, subject, &spec);
    let (all, unit) = (SearchNode::unconstrained(&task.scaled, task.balance()), problem.units.of_relaxed(relaxed));
    match task.on(&SearchNode { least: Some(relaxed), ..all })? {
        Ok(least) => {
            let (added_mass, machine) = task.machine(&least, task.balance())?;
            let (value, gap) = (unit * least.value, unit * least.gap);
            Ok(Some(PlacedCounterweights { machine, added_mass, value, gap, unit }.of_machine()))
        }
        Err(NoOptimum::Contradiction(_)) => Ok(None),
        Err(NoOptimum::Failed(why)) => Err(CounterweightError::Failed(why)),
    }
}

impl CounterweightSpec {
    /// Returns the kinds of bounds of masses and of Σ D_k that are set.
    pub fn limited(&self) -> Vec<BoundKind> {
        let limits = [BoundKind::Most, BoundKind::Mass, BoundKind::Inertia];
        BoundKind::of(self).into_iter().filter(|kind| limits.contains(kind)).collect()
    }

    /// Returns the request without the bounds of these kinds. The distance from the axes always stays.
    pub fn without_bounds(&self, kinds: &[BoundKind]) -> Self {
        let mut request = self.clone();
        for kind in kinds {
            match kind {
                BoundKind::Most => request.sites.iter_mut().for_each(|site| site.most = f64::INFINITY),
                BoundKind::Mass => request.max_added_mass = None,
                BoundKind::Inertia => request.max_inertia = None,
                BoundKind::Clearance => request.clearance = None,
                BoundKind::Across => {}
            }
        }
        request
    }
}
