//! [`Room`]: where a disc is clear of the pins of its link.
//!
//! A disc of mass w at x has radius κ √w. Between pins at a and b it has to keep x ≥ a + c + κ √w and x ≤ b − c − κ √w,
//! with s = w x: s ≥ (a + c) w + κ w^1.5 and s ≤ (b − c) w − κ w^1.5, both convex.

use super::asked::Weighing;
use crate::convex::{Program, Row};

/// Between two pins that follow each other, or beyond the last: m from the root, infinite where there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Room {
    from: f64,
    to: f64,
}

impl Room {
    /// Those of a link with pins in rising order, m from the root.
    pub fn all(pins: &[f64]) -> Vec<Self> {
        let mut ends = vec![f64::NEG_INFINITY];
        ends.extend(pins);
        ends.push(f64::INFINITY);
        ends.windows(2).map(|pair| Self { from: pair[0], to: pair[1] }).collect()
    }

    /// Keeps the disc of w and s in it.
    pub fn enter(&self, asked: &Weighing, [w, s]: [usize; 2], program: &mut Program) {
        let (clearance, spread) = (asked.clearance.unwrap_or_default(), asked.disc.spread());
        // y ≤ √w and z ≥ w²/y.
        let (y, z) = (program.linear.len(), program.linear.len() + 1);
        program.linear.extend([0.0, 0.0]);
        program.above_square(w, 1.0, y);
        program.above_quotient(z, y, w);
        if self.from.is_finite() {
            program.at_most.push(Row::new([(w, self.from + clearance), (z, spread), (s, -1.0)], 0.0));
        }
        if self.to.is_finite() {
            program.at_most.push(Row::new([(s, 1.0), (z, spread), (w, clearance - self.to)], 0.0));
        }
    }

    /// How far a disc reaches into what it has to keep clear, m; not above 0 for none.
    pub fn missed(&self, clearance: f64, radius: f64, at: f64) -> f64 {
        (self.from + clearance + radius - at).max(at + radius + clearance - self.to)
    }
}
