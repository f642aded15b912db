//! The curves det = 0 within the limits, as spans.
//!
//! A quadtree over (a_1, a_2) isolates the spans. The intersections of the curves with the sides of a cell have a
//! closed form. A cell with two of them contains one span. No closed curve lies inside a cell: each passes through two
//! points at which all arms are in line, and these are π apart.

use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

use super::determinant::upright;
use super::span::{BoundaryCurve, BoundarySpan, Surface};

/// Maximum distance of grid lines, rad; only the last cell of each axis may be wider, by the offset of the lines.
const MAX_STEP_RAD: f64 = 0.35;
/// Zeros within this distance of a corner of the limits are treated as the corner, rad.
const CORNER_TOLERANCE_RAD: f64 = 1e-10;
/// Maximum number of bisections of a cell. In the smallest cells, 1e-5 rad wide, curves are treated as straight, which
/// moves their image by 1e-10 m.
const MAX_DEPTH: usize = 15;

/// Offset of the grid lines, and place at which cells are split, for each angle, as fractions of a cell.
const GRID_OFFSET: [f64; 2] = [0.381_966, 0.276_393];
const SPLIT: [f64; 2] = [0.471_404, 0.524_579];

/// A side of a cell: the coordinates at which det = 0 intersects it.
#[derive(Clone, Debug, Default)]
struct Side(Vec<f64>);

/// A cell, whose sides are at the least a_2, the greatest a_2, the least a_1 and the greatest a_1.
#[derive(Clone, Debug)]
struct Cell {
    low: [f64; 2],
    high: [f64; 2],
    sides: [Side; 4],
}

/// The curves det = 0.
#[derive(Clone, Debug, Default)]
pub(super) struct FoldCurves {
    pub spans: Vec<BoundarySpan>,
    /// (a_1, a_2) of the cusps of the image.
    pub cusps: Vec<[f64; 2]>,
}

/// Returns the zeros of det on the line where angle `fixed` is `x`, with the other angle within `range`, ascending.
pub(super) fn zeros(on: &Surface, fixed: usize, x: f64, range: [f64; 2]) -> Vec<f64> {
    zeros_on(on, upright(fixed, x), range)
}

/// Returns the zeros of det on the line `from` + y `way`, with y within `range`, ascending.
pub(super) fn zeros_on(on: &Surface, [from, way]: [[f64; 2]; 2], range: [f64; 2]) -> Vec<f64> {
    let [least, most] = [range[0] + CORNER_TOLERANCE_RAD, range[1] - CORNER_TOLERANCE_RAD];
    let mut found = Vec::new();
    for zero in on.det.zeros(from, way).into_iter().flatten() {
        let mut y = zero + TAU * ((least - zero) / TAU).ceil();
        while y <= most {
            found.push(y);
            y += TAU;
        }
    }
    found.sort_by(f64::total_cmp);
    found
}

/// Returns the grid lines of an axis, rad. Their places, and those at which cells are split, are not simple fractions
/// and differ between the axes. Straight folds, as in degenerate machines, then never run along a line or through a
/// corner.
fn lines(axis: usize, range: [f64; 2]) -> Vec<f64> {
    let width = range[1] - range[0];
    let n = (width / MAX_STEP_RAD).ceil().max(1.0);
    let mut lines = vec![range[0]];
    lines.extend((1..n as usize).map(|i| range[0] + width * (i as f64 - GRID_OFFSET[axis]) / n));
    lines.push(range[1]);
    lines
}

/// Returns all curves det = 0 within the limits as spans in order, split at the cusps of their images.
pub(super) fn spans(on: &Surface) -> FoldCurves {
    let range = on.map.limits().map(|l| [l.min, l.max]);
    let grid = [0, 1].map(|axis| lines(axis, range[axis]));
    // crossings[axis][line]: zeros on the line where that axis is fixed.
    let crossings: [Vec<Vec<f64>>; 2] =
        [0, 1].map(|axis| grid[axis].iter().map(|&x| zeros(on, axis, x, range[1 - axis])).collect());
    let between =
        |list: &[f64], low: f64, high: f64| Side(list.iter().copied().filter(|y| (low..high).contains(y)).collect());
    let mut folds = FoldCurves::default();
    for (i, a1) in grid[0].windows(2).enumerate() {
        for (j, a2) in grid[1].windows(2).enumerate() {
            let mut cell = Cell {
                low: [a1[0], a2[0]],
                high: [a1[1], a2[1]],
                sides: [
                    between(&crossings[1][j], a1[0], a1[1]),
                    between(&crossings[1][j + 1], a1[0], a1[1]),
                    between(&crossings[0][i], a2[0], a2[1]),
                    between(&crossings[0][i + 1], a2[0], a2[1]),
                ],
            };
            cell.mend_corner(on, range);
            cell.trace(on, MAX_DEPTH, &mut folds);
        }
    }
    folds.spans = in_order(&folds.spans);
    folds
}

/// Orders spans such that each precedes the one that begins at its end.
fn in_order(spans: &[BoundarySpan]) -> Vec<BoundarySpan> {
    let key = |a: [f64; 2]| a.map(f64::to_bits);
    let begins: HashMap<_, usize> = spans.iter().enumerate().map(|(i, s)| (key(s.ends[0]), i)).collect();
    let ends: HashSet<_> = spans.iter().map(|s| key(s.ends[1])).collect();
    let mut used = vec![false; spans.len()];
    let mut ordered = Vec::with_capacity(spans.len());
    // Open curves from their start, then closed ones from any span.
    let (inner, first): (Vec<_>, Vec<_>) = (0..spans.len()).partition(|&i| ends.contains(&key(spans[i].ends[0])));
    for start in first.into_iter().chain(inner) {
        let mut next = Some(start);
        while let Some(i) = next.filter(|&i| !used[i]) {
            used[i] = true;
            ordered.push(spans[i]);
            next = begins.get(&key(spans[i].ends[1])).copied();
        }
    }
    ordered
}

impl FoldCurves {
    /// Adds a span, split at its cusps so that no piece turns back.
    fn push(&mut self, on: &Surface, span: BoundarySpan) {
        let cusps: Vec<[f64; 2]> = on.cusps(&span).into_iter().map(|t| on.point(&span, t)).collect();
        let mut stops = vec![span.ends[0]];
        stops.extend(&cusps);
        stops.push(span.ends[1]);
        let pieces: Option<Vec<BoundarySpan>> = stops.windows(2).map(|w| on.fold([w[0], w[1]])).collect();
        match pieces {
            Some(pieces) if !cusps.is_empty() => {
                self.spans.extend(pieces);
                self.cusps.extend(cusps);
            }
            _ => self.spans.push(span),
        }
    }
}

impl Cell {
    fn count(&self) -> usize {
        self.sides.iter().map(|s| s.0.len()).sum()
    }

    /// Adds the zero of a curve that ends exactly in a corner of the limits, so that the number of zeros is even.
    fn mend_corner(&mut self, on: &Surface, range: [[f64; 2]; 2]) {
        if self.count().is_multiple_of(2) {
            return;
        }
        for (i, x) in [self.low[0], self.high[0]].into_iter().enumerate() {
            for (j, y) in [self.low[1], self.high[1]].into_iter().enumerate() {
                let corner = x == range[0][i] && y == range[1][j];
                if corner && on.det.value([x, y]).abs() < 1e-8 * on.det.scale() {
                    self.sides[j].0.push(x);
                    return;
                }
            }
        }
    }

    fn points(&self) -> impl Iterator<Item = [f64; 2]> {
        let [bottom, top, left, right] = &self.sides;
        let (low, high) = (self.low, self.high);
        let level = |side: &Side, y: f64| side.0.clone().into_iter().map(move |x| [x, y]);
        let upright = |side: &Side, x: f64| side.0.clone().into_iter().map(move |y| [x, y]);
        level(bottom, low[1]).chain(level(top, high[1])).chain(upright(left, low[0])).chain(upright(right, high[0]))
    }

    fn trace(&self, on: &Surface, depth: usize, folds: &mut FoldCurves) {
        let count = self.count();
        if count == 0 {
            return;
        }
        if count == 2 {
            let mut points = self.points();
            let ends = [points.next(), points.next()].map(Option::unwrap_or_default);
            if let Some(span) = on.fold(ends) {
                folds.push(on, span);
                return;
            }
        }
        if depth == 0 {
            self.join(on, &mut folds.spans);
        } else {
            self.quarters(on).iter().for_each(|q| q.trace(on, depth - 1, folds));
        }
    }

    /// Joins the zeros of a very small cell in pairs: each inward crossing with some outward one.
    fn join(&self, on: &Surface, spans: &mut Vec<BoundarySpan>) {
        // Whether det > 0 on the left of the line from a to b, by the gradient at a given point.
        let forward = |a: [f64; 2], b: [f64; 2], at: [f64; 2]| {
            let [g1, g2] = on.det.gradient(at);
            g2 * (b[0] - a[0]) - g1 * (b[1] - a[1]) > 0.0
        };
        let halfway = |a: [f64; 2], b: [f64; 2]| [0, 1].map(|j| 0.5 * (a[j] + b[j]));
        let points: Vec<_> = self.points().collect();
        if let [a, b] = points[..] {
            let ends = if forward(a, b, halfway(a, b)) { [a, b] } else { [b, a] };
            spans.push(on.straight(BoundaryCurve::Fold, ends));
            return;
        }
        let middle = halfway(self.low, self.high);
        let (ways_in, ways_out): (Vec<_>, Vec<_>) = points.into_iter().partition(|&a| forward(a, middle, a));
        spans.extend(ways_in.into_iter().zip(ways_out).map(|(from, to)| on.straight(BoundaryCurve::Fold, [from, to])));
    }

    fn quarters(&self, on: &Surface) -> [Self; 4] {
        let middle = [0, 1].map(|j| self.low[j] + SPLIT[j] * (self.high[j] - self.low[j]));
        let inside = |axis: usize| {
            let other = 1 - axis;
            let limit = on.map.limits()[other];
            let range = [
                (self.low[other] - CORNER_TOLERANCE_RAD).max(limit.min),
                (self.high[other] + CORNER_TOLERANCE_RAD).min(limit.max),
            ];
            let all = zeros(on, axis, middle[axis], range);
            halves(&Side(all), middle[other])
        };
        // The two inner lines, then the outer sides, each split in two.
        let (upright, level) = (inside(0), inside(1));
        let [bottom, top] = [&self.sides[0], &self.sides[1]].map(|s| halves(s, middle[0]));
        let [left, right] = [&self.sides[2], &self.sides[3]].map(|s| halves(s, middle[1]));
        let (low, high) = (self.low, self.high);
        let cell = |low, high, sides| Self { low, high, sides };
        let [bottom_0, bottom_1] = bottom;
        let [top_0, top_1] = top;
        let [left_0, left_1] = left;
        let [right_0, right_1] = right;
        let [upright_0, upright_1] = upright;
        let [level_0, level_1] = level;
        [
            cell(low, middle, [bottom_0, level_0.clone(), left_0, upright_0.clone()]),
            cell([middle[0], low[1]], [high[0], middle[1]], [bottom_1, level_1.clone(), upright_0, right_0]),
            cell([low[0], middle[1]], [middle[0], high[1]], [level_0, top_0, left_1, upright_1.clone()]),
            cell(middle, high, [level_1, top_1, upright_1, right_1]),
        ]
    }
}

fn halves(side: &Side, middle: f64) -> [Side; 2] {
    let (first, second): (Vec<f64>, Vec<f64>) = side.0.iter().partition(|&&y| y < middle);
    [Side(first), Side(second)]
}
