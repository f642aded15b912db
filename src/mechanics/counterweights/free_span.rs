//! [`FreeSpan`]: an interval between pins of a link in which a disc is clear of them.
//!
//! A disc of mass w at x has radius κ √w. Between pins at a and b, with clearance c, it must keep x ≥ a + c + κ √w and
//! x ≤ b − c − κ √w. With s = w x these are s ≥ (a + c) w + κ w^1.5 and s ≤ (b − c) w − κ w^1.5, both convex.

use super::spec::CounterweightSpec;
use stillbase_convex::{LinearRow, Program};

/// Interval between neighbouring pins, or beyond the outermost, m from the root; infinite where there is no pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FreeSpan {
    from: f64,
    to: f64,
}

impl FreeSpan {
    /// Returns the intervals of a link with pins in ascending order, m from the root.
    pub fn all(pins: &[f64]) -> Vec<Self> {
        let mut bounds = vec![f64::NEG_INFINITY];
        bounds.extend(pins);
        bounds.push(f64::INFINITY);
        bounds.windows(2).map(|pair| Self { from: pair[0], to: pair[1] }).collect()
    }

    /// Adds constraints that keep the disc with unknowns w and s in the interval.
    pub fn enter(&self, request: &CounterweightSpec, [w, s]: [usize; 2], program: &mut Program) {
        let (clearance, spread) = (request.clearance.unwrap_or_default(), request.disc.spread());
        // y ≤ √w and z ≥ w²/y, so z ≥ w^1.5.
        let (y, z) = (program.linear.len(), program.linear.len() + 1);
        program.linear.extend([0.0, 0.0]);
        program.above_square(w, 1.0, y);
        program.add_rotated_cone(z, y, w);
        if self.from.is_finite() {
            program.at_most.push(LinearRow::new([(w, self.from + clearance), (z, spread), (s, -1.0)], 0.0));
        }
        if self.to.is_finite() {
            program.at_most.push(LinearRow::new([(s, 1.0), (z, spread), (w, clearance - self.to)], 0.0));
        }
    }

    /// Returns the length by which a disc violates the clearance, m; zero or negative if it does not.
    pub fn violation(&self, clearance: f64, radius: f64, at: f64) -> f64 {
        (self.from + clearance + radius - at).max(at + radius + clearance - self.to)
    }
}
