//! [`One`]: one request for counterweights, with the problem derived from it.

use super::asked::Weighing;
use super::problem::Problem;
use super::refusal::NoWeights;
use super::search::search;
use super::way::{Balance, Way};
use crate::convex::{Least, NoX};
use crate::mechanics::machine::Machine;
use crate::mechanics::planar::Vector;

/// One request for counterweights on a machine, with the problem derived from it.
#[derive(Clone, Copy)]
pub(super) struct One<'a> {
    pub problem: &'a Problem,
    pub machine: &'a Machine,
    pub asked: &'a Weighing,
    pub beyond: &'a [Vector],
}

impl One<'_> {
    /// Returns whether balance is to be exact, or as near as possible over a range of payloads.
    pub fn balance(&self) -> Balance {
        match self.asked.payload {
            Some([low, high]) if low < high => Balance::Nearest,
            _ => Balance::Exact,
        }
    }

    /// Returns whether there are such counterweights.
    pub fn is_possible(&self) -> bool {
        matches!(self.on(&Way::free(self.asked, self.balance())), Ok(Ok(_)))
    }

    /// Finds the optimum with a given form of the balance conditions.
    pub fn least(&self, balance: Balance) -> Result<Result<Least, NoX>, NoWeights> {
        self.on(&Way::free(self.asked, balance))
    }

    /// Finds the optimum of one subproblem.
    pub fn on(&self, way: &Way) -> Result<Result<Least, NoX>, NoWeights> {
        let is_convex = self.asked.clearance.is_none() && self.asked.objective.momentum == 0.0;
        match is_convex {
            true => Ok(self.problem.least(self.machine, self.asked, way)),
            false => search(self.problem, self.machine, self.asked, way),
        }
    }
}
