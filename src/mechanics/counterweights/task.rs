//! [`CounterweightTask`]: one request for counterweights, with the problem derived from it.

use super::problem::CounterweightProblem;
use super::refusal::CounterweightError;
use super::search::search;
use super::search_node::{BalanceGoal, SearchNode};
use super::spec::CounterweightSpec;
use super::subject::Subject;
use stillbase_convex::{NoOptimum, Optimum};

/// One request for counterweights, with the problem derived from it.
pub(super) struct CounterweightTask<'a> {
    pub problem: &'a CounterweightProblem,
    pub subject: Subject<'a>,
    pub spec: &'a CounterweightSpec,
    /// The request in the units of the problem, in which it is solved.
    pub scaled: CounterweightSpec,
}

impl<'a> CounterweightTask<'a> {
    pub fn new(problem: &'a CounterweightProblem, subject: Subject<'a>, spec: &'a CounterweightSpec) -> Self {
        Self { problem, subject, spec, scaled: problem.units.request(spec) }
    }

    /// Returns the task with another objective or other bounds on the same sites.
    pub fn with<'b>(&self, spec: &'b CounterweightSpec) -> CounterweightTask<'b>
    where
        'a: 'b,
    {
        CounterweightTask::new(self.problem, self.subject, spec)
    }

    /// Returns the goal: exact balance, or the smallest residual over a range of payloads.
    pub fn balance(&self) -> BalanceGoal {
        match self.spec.payload {
            Some([low, high]) if low < high => BalanceGoal::Nearest,
            _ => BalanceGoal::Exact,
        }
    }

    /// Returns whether counterweights exist that satisfy the request; false if the solver fails.
    pub fn is_possible(&self) -> bool {
        matches!(self.on(&SearchNode::unconstrained(&self.scaled, self.balance())), Ok(Ok(_)))
    }

    /// Finds the optimum with a given form of the balance conditions.
    pub fn least(&self, balance: BalanceGoal) -> Result<Result<Optimum, NoOptimum>, CounterweightError> {
        self.on(&SearchNode::unconstrained(&self.scaled, balance))
    }

    /// Finds the optimum of the subproblem at a node of the search.
    pub fn on(&self, node: &SearchNode) -> Result<Result<Optimum, NoOptimum>, CounterweightError> {
        let is_convex = self.spec.clearance.is_none() && self.spec.objective.momentum == 0.0;
        match is_convex {
            true => Ok(self.problem.least(&self.scaled, node)),
            false => search(self.problem, &self.scaled, node),
        }
    }
}
