//! [`Cell`]: within what mass and place a counterweight is sought, and how much its inertia can be there.
//!
//! What lowers |D_k| where D_k is below zero is more inertia, not less, so s²/w and w² count from above: for x from a to b
//! s²/w ≤ (a + b) s − a b w, and for w from a to b w² ≤ (a + b) w − a b, each with equality at both ends.

use super::asked::{Sites, Weighing};
use crate::convex::{Program, Row};

/// From the least to the greatest mass, kg, and place, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    pub mass: [f64; 2],
    pub at: [f64; 2],
}

/// Cells narrower than this fraction of their place are not split.
const NARROW: f64 = 1e-6;

impl Cell {
    /// All of a site.
    pub fn of(asked: &Weighing, site: &Sites) -> Self {
        Self { mass: [0.0, site.most.min(asked.most_mass.unwrap_or(f64::INFINITY))], at: [site.from, site.to] }
    }

    /// Keeps w and s in it, and what its inertias u and v are at most.
    pub fn enter(&self, asked: &Weighing, [w, s, u, v]: [usize; 4], program: &mut Program) {
        let ([light, heavy], [from, to]) = (self.mass, self.at);
        let mut most = |terms: &[(usize, f64)], right: f64| program.at_most.push(Row::new(terms, right));
        most(&[(w, from), (s, -1.0)], 0.0);
        most(&[(s, 1.0), (w, -to)], 0.0);
        most(&[(u, 1.0), (s, -(from + to)), (w, from * to)], 0.0);
        if light > 0.0 {
            most(&[(w, -1.0)], -light);
        }
        if heavy.is_finite() {
            let own = asked.disc.own();
            most(&[(w, 1.0)], heavy);
            most(&[(v, 1.0), (w, -own * (light + heavy))], -own * light * heavy);
        }
    }

    /// Both halves by place, where it is far from its ends, or by mass.
    pub fn halves(&self, by_place: bool, [mass, at]: [f64; 2]) -> Option<[Self; 2]> {
        let halve = |[low, high]: [f64; 2], near: f64| {
            let high_enough = if high.is_finite() { high } else { 2.0 * near.max(low) + 1.0 };
            let width = high_enough - low;
            let place = near.clamp(low + 0.2 * width, high_enough - 0.2 * width);
            (width > NARROW * (1.0 + low.abs())).then_some([[low, place], [place, high]])
        };
        Some(match by_place {
            true => halve(self.at, at)?.map(|at| Self { at, ..*self }),
            false => halve(self.mass, mass)?.map(|mass| Self { mass, ..*self }),
        })
    }
}
