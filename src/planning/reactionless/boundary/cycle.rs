//! The weighted cycle of all spans. Its winding number about a point is the number of poses at that point.

use super::span::{BoundarySpan, Surface};
use stillbase_mechanics::planar::Vector;

/// Number of rows in y into which spans are sorted, so that a ray is tested against few of them.
const ROWS: usize = 64;

/// Axis-parallel bounds of a span, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct CycleBounds {
    pub low: Vector,
    pub high: Vector,
}

#[derive(Clone, Debug)]
pub(super) struct Cycle {
    pub spans: Vec<BoundarySpan>,
    pub bounds: Vec<CycleBounds>,
    /// Index in `members` at which each row begins, and the end of the last row.
    rows: Vec<u32>,
    /// Indices of spans by row; a span is in all rows that it passes through.
    members: Vec<u32>,
    low: f64,
    per_metre: f64,
}

impl Cycle {
    /// Returns the cycle of spans; `unit` is the map's unit of tolerances, m.
    pub fn of(spans: Vec<BoundarySpan>, unit: f64) -> Self {
        let bounds: Vec<CycleBounds> = spans
            .iter()
            .map(|s| {
                let slack = s.deviation + 1e-12 * unit;
                let [a, b] = s.at;
                CycleBounds {
                    low: Vector::new(a.re.min(b.re) - slack, a.im.min(b.im) - slack),
                    high: Vector::new(a.re.max(b.re) + slack, a.im.max(b.im) + slack),
                }
            })
            .collect();
        let low = bounds.iter().map(|b| b.low.im).fold(f64::INFINITY, f64::min);
        let high = bounds.iter().map(|b| b.high.im).fold(f64::NEG_INFINITY, f64::max);
        let per_metre = ROWS as f64 / (high - low);
        let mut cycle = Self { spans, bounds, rows: vec![0; ROWS + 1], members: Vec::new(), low, per_metre };
        let passed = |cycle: &Self, b: &CycleBounds| cycle.row(b.low.im)..=cycle.row(b.high.im);
        for b in &cycle.bounds.clone() {
            passed(&cycle, b).for_each(|row| cycle.rows[row + 1] += 1);
        }
        for row in 0..ROWS {
            cycle.rows[row + 1] += cycle.rows[row];
        }
        cycle.members = vec![0; cycle.rows[ROWS] as usize];
        let mut next = cycle.rows.clone();
        for (i, b) in cycle.bounds.iter().enumerate() {
            for row in passed(&cycle, b) {
                cycle.members[next[row] as usize] = i as u32;
                next[row] += 1;
            }
        }
        cycle
    }

    /// Returns the row of a y, m. The cast maps values below the first row, and NaN, to row 0.
    fn row(&self, y: f64) -> usize {
        (((y - self.low) * self.per_metre) as usize).min(ROWS - 1)
    }

    /// Returns the number of poses of p, m, as the winding number of the weighted cycle; on a curve, that of one of its
    /// sides.
    pub fn poses_at(&self, on: &Surface, p: Vector) -> i32 {
        let row = self.row(p.im);
        let mut count = 0;
        for &i in &self.members[self.rows[row] as usize..self.rows[row + 1] as usize] {
            let (span, b) = (&self.spans[i as usize], &self.bounds[i as usize]);
            if p.im >= b.low.im && p.im <= b.high.im && p.re <= b.high.re {
                let ends = [(0.0, span.at[0]), (1.0, span.at[1])];
                count += span.weight() * span.crossings(on, ends[0], ends[1], p).unwrap_or(0);
            }
        }
        count
    }
}
