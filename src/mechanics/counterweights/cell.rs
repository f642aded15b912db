//! [`SearchCell`]: a range of mass w and position x = s/w of a counterweight, and upper bounds of its inertia there.
//!
//! If D_k is negative, more inertia reduces |D_k|, so s²/w and w² need upper bounds. For x from a to b,
//! s²/w ≤ (a + b) s − a b w. For w from a to b, w² ≤ (a + b) w − a b. Both are equalities at a and at b.

use super::spec::{CounterweightSite, CounterweightSpec};
use stillbase_convex::{LinearRow, Program};

/// Range of mass, kg, and of position, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SearchCell {
    pub mass: [f64; 2],
    pub at: [f64; 2],
}

/// Cells narrower than this, relative to 1 plus the magnitude of their lower bound, are not split.
const MIN_WIDTH: f64 = 1e-6;

impl SearchCell {
    /// Returns the cell of all masses and positions that a site allows.
    pub fn of(request: &CounterweightSpec, site: &CounterweightSite) -> Self {
        Self { mass: [0.0, site.most.min(request.max_added_mass.unwrap_or(f64::INFINITY))], at: [site.from, site.to] }
    }

    /// Adds rows that keep w and s in the cell, and upper bounds of u, which represents s²/w, and of v, the disc's own
    /// inertia.
    pub fn enter(&self, request: &CounterweightSpec, [w, s, u, v]: [usize; 4], program: &mut Program) {
        let ([light, heavy], [from, to]) = (self.mass, self.at);
        let mut most = |terms: &[(usize, f64)], right: f64| program.at_most.push(LinearRow::new(terms, right));
        most(&[(w, from), (s, -1.0)], 0.0);
        most(&[(s, 1.0), (w, -to)], 0.0);
        most(&[(u, 1.0), (s, -(from + to)), (w, from * to)], 0.0);
        if light > 0.0 {
            most(&[(w, -1.0)], -light);
        }
        if heavy.is_finite() {
            let own = request.disc.own();
            most(&[(w, 1.0)], heavy);
            most(&[(v, 1.0), (w, -own * (light + heavy))], -own * light * heavy);
        }
    }

    /// Splits the cell by position or by mass at the given point, clamped to the middle three fifths of the cell.
    /// `None` if the cell is too narrow.
    pub fn halves(&self, by_place: bool, [mass, at]: [f64; 2]) -> Option<[Self; 2]> {
        let halve = |[low, high]: [f64; 2], near: f64| {
            let high_enough = if high.is_finite() { high } else { 2.0 * near.max(low) + 1.0 };
            let width = high_enough - low;
            let place = near.clamp(low + 0.2 * width, high_enough - 0.2 * width);
            (width > MIN_WIDTH * (1.0 + low.abs())).then_some([[low, place], [place, high]])
        };
        Some(match by_place {
            true => halve(self.at, at)?.map(|at| Self { at, ..*self }),
            false => halve(self.mass, mass)?.map(|mass| Self { mass, ..*self }),
        })
    }
}
