//! What two instants differ in: of one run at two times, or of two runs.

use crate::frame::Frame;
use crate::signals::Signal;

/// A signal at two instants.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The signal's place in its table.
    pub signal: usize,
    /// At the first.
    pub from: f64,
    /// At the second.
    pub to: f64,
}

impl Difference {
    /// Second less first.
    pub fn by(&self) -> f64 {
        self.to - self.from
    }
}

/// Every signal of a table at two instants.
pub fn differences(table: &[Signal], from: &Frame, to: &Frame) -> Vec<Difference> {
    let one = |(signal, s): (usize, &Signal)| Difference { signal, from: s.value(from), to: s.value(to) };
    table.iter().enumerate().map(one).collect()
}
