//! [`QueryResult`]: the newest answer of a query, and whether it belongs to the current input.

use std::sync::Arc;

/// The newest answer of a query, and whether it belongs to the current input.
#[derive(Debug)]
pub struct QueryResult<A> {
    /// The newest answer; `None` before the first one.
    pub last: Option<Arc<A>>,
    /// Whether `last` belongs to the current input, and if not, why.
    pub state: QueryStatus,
}

/// State of the newest answer relative to the current input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum QueryStatus {
    /// The answer belongs to the current input.
    Known,
    /// The answer belongs to an earlier input; work on the current one is under way. Fraction done, from 0 to 1.
    UnderWay(f64),
    /// The answer belongs to an earlier input; the user stopped the work on the current one.
    Stopped,
    /// The answer belongs to an earlier input; the work on the current one ended without an answer, by a fault of the
    /// program.
    Broken,
}

impl<A> QueryResult<A> {
    /// Returns the answer if it belongs to the current input.
    pub fn known(&self) -> Option<&Arc<A>> {
        self.last.as_ref().filter(|_| self.state == QueryStatus::Known)
    }
}
