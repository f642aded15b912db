//! [`Difference`]: a signal at two instants, of one run at two times or of two runs.

use crate::simulation::frame::Frame;
use crate::simulation::signals::Signal;

/// A signal at two instants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// At the first.
    pub from: f64,
    /// At the second.
    pub to: f64,
}

impl Difference {
    /// Of a signal.
    pub fn of(signal: &Signal, from: &Frame, to: &Frame) -> Self {
        Self { from: signal.value(from), to: signal.value(to) }
    }

    /// Second less first.
    pub fn by(&self) -> f64 {
        self.to - self.from
    }
}
