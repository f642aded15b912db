//! [`SignalDifference`]: values of a signal at two instants, of one run or of two.

use stillbase_simulation::frame::Frame;
use stillbase_simulation::signals::Signal;

/// Values of a signal at two instants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignalDifference {
    /// Value at the first instant.
    pub from: f64,
    /// Value at the second instant.
    pub to: f64,
}

impl SignalDifference {
    /// Returns the values of a signal in two frames.
    pub fn of(signal: &Signal, from: &Frame, to: &Frame) -> Self {
        Self { from: signal.value(from), to: signal.value(to) }
    }

    /// Returns the second value less the first.
    pub fn difference(&self) -> f64 {
        self.to - self.from
    }
}
