//! [`Asked`]: an answer that may still be in the making.

use std::sync::Arc;

/// An answer that may still be in the making.
#[derive(Debug)]
pub struct Asked<A> {
    /// The newest there is; none if there was none yet.
    pub last: Option<Arc<A>>,
    /// What it is to what was asked.
    pub state: State,
}

/// How an answer stands to the input that was asked about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum State {
    /// It is of this input.
    Known,
    /// It is of an earlier one; so much of the work is done, from 0 to 1.
    UnderWay(f64),
    /// It is of an earlier one: the work was stopped by hand.
    Stopped,
    /// It is of an earlier one: the work broke off, which is a fault of the program.
    Broken,
}

impl<A> Asked<A> {
    /// The answer, if it is of what was asked.
    pub fn known(&self) -> Option<&Arc<A>> {
        self.last.as_ref().filter(|_| self.state == State::Known)
    }
}
