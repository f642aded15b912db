//! [`SearchCell`]: a range of mass w and position (x, y) of a counterweight, and upper bounds of its inertia there.
//!
//! If D_k is negative, more inertia reduces |D_k|, so (s² + t²)/w and w² need upper bounds. For x from a to b,
//! s²/w ≤ (a + b) s − a b w, and likewise t²/w for y. For w from a to b, the disc's own inertia lies below its
//! chord. All are equalities at a and at b.

use super::spec::{CounterweightSite, CounterweightSpec};
use super::unknowns::UnknownIndices;
use stillbase_convex::{LinearRow, Program};

/// Mass and position of a disc on its link.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct DiscPlace {
    /// Mass w, kg.
    pub mass: f64,
    /// Position x of its centre along the link, m from the root.
    pub at: f64,
    /// Distance y of its centre to the left of the link's axis, m.
    pub across: f64,
}

/// Range of mass, kg, and of position, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SearchCell {
    pub mass: [f64; 2],
    pub at: [f64; 2],
    pub across: [f64; 2],
}

/// A side of a cell along which it is split.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum CellSide {
    Mass,
    At,
    Across,
}

/// Cells narrower than this, relative to 1 plus the magnitude of their lower bound, are not split.
const MIN_WIDTH: f64 = 1e-6;

impl SearchCell {
    /// Returns the cell of all masses and positions that a site allows.
    pub fn of(request: &CounterweightSpec, site: &CounterweightSite) -> Self {
        let heaviest = site.most.min(request.max_added_mass.unwrap_or(f64::INFINITY));
        Self { mass: [0.0, heaviest], at: [site.from, site.to], across: [-site.across, site.across] }
    }

    /// Adds rows that keep the disc of site j in the cell, and upper bounds of u, which represents (s² + t²)/w, and of
    /// v, the disc's own inertia.
    pub fn enter(&self, request: &CounterweightSpec, unknowns: &UnknownIndices, j: usize, program: &mut Program) {
        let [w, s, u, v] = [unknowns.w(j), unknowns.s(j), unknowns.u(j), unknowns.v(j)];
        let ([light, heavy], [from, to], [right, left]) = (self.mass, self.at, self.across);
        let mut most = |terms: &[(usize, f64)], right: f64| program.at_most.push(LinearRow::new(terms, right));
        most(&[(w, from), (s, -1.0)], 0.0);
        most(&[(s, 1.0), (w, -to)], 0.0);
        let mut inertia = vec![(u, 1.0), (s, -(from + to)), (w, from * to)];
        if let Some(t) = unknowns.t(j) {
            most(&[(w, right), (t, -1.0)], 0.0);
            most(&[(t, 1.0), (w, -left)], 0.0);
            inertia.extend([(t, -(right + left)), (w, right * left)]);
        }
        most(&inertia, 0.0);
        if light > 0.0 {
            most(&[(w, -1.0)], -light);
        }
        if heavy.is_finite() {
            most(&[(w, 1.0)], heavy);
            // The chord of the own inertia, which is convex in the mass.
            let [least, greatest] = [light, heavy].map(|mass| request.stock.own(mass));
            let slope = match heavy > light {
                true => (greatest - least) / (heavy - light),
                false => request.stock.own_slope(light),
            };
            most(&[(v, 1.0), (w, -slope)], least - slope * light);
        }
    }

    /// Returns the side along which the cell is split to bound the inertia from the position of `disc` more tightly.
    pub fn looser_side(&self, disc: &DiscPlace) -> CellSide {
        let slack = |[low, high]: [f64; 2], x: f64| (x - low) * (high - x);
        match slack(self.across, disc.across) > slack(self.at, disc.at) {
            true => CellSide::Across,
            false => CellSide::At,
        }
    }

    /// Splits the cell along a side at the given disc, clamped to the middle three fifths of the cell. `None` if the
    /// cell is too narrow.
    pub fn halves(&self, side: CellSide, disc: &DiscPlace) -> Option<[Self; 2]> {
        let halve = |[low, high]: [f64; 2], near: f64| {
            let high_enough = if high.is_finite() { high } else { 2.0 * near.max(low) + 1.0 };
            let width = high_enough - low;
            let place = near.clamp(low + 0.2 * width, high_enough - 0.2 * width);
            (width > MIN_WIDTH * (1.0 + low.abs())).then_some([[low, place], [place, high]])
        };
        Some(match side {
            CellSide::At => halve(self.at, disc.at)?.map(|at| Self { at, ..*self }),
            CellSide::Across => halve(self.across, disc.across)?.map(|across| Self { across, ..*self }),
            CellSide::Mass => halve(self.mass, disc.mass)?.map(|mass| Self { mass, ..*self }),
        })
    }
}
