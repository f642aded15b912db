//! Whether two solids overlap in plan at some pose within the joint limits, by bisection of the range of poses.
//!
//! In a cell of poses, of half widths h_k around its middle, no point of one solid moves by more than Σ L_k h_k as the
//! other sees it, with L_k the lever of drive k. So a cell whose middle has a gap above that sum is free. The cell with
//! the least bound is split first.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::f64::consts::TAU;

use super::plan::{Nearness, PlanSolid, nearness};
use super::range::PoseRange;
use stillbase_mechanics::planar::{MAX_DRIVES, UnitVectors, Vector, unit};

/// A gap that is not known better than this, m, counts as not decided.
pub const TOLERANCE: f64 = 1e-4;

/// Whether two solids overlap.
#[derive(Clone, Debug)]
pub enum Overlap {
    /// They are apart in every pose.
    Never,
    /// They overlap in a pose.
    In(Vec<f64>, Nearness),
    /// They may come closer than the tolerance, or the work was cut short; a pose, and how near they are there.
    Undecided(Vec<f64>, Nearness),
}

/// Two solids, with the drives on which their distance depends.
pub struct Pair<'a> {
    a: &'a PlanSolid,
    b: &'a PlanSolid,
    /// The drives: first the one that is held, then those that turn relative to it.
    drives: Vec<usize>,
    /// Lever of each drive, m.
    levers: [f64; MAX_DRIVES],
    /// Pairs of sides, of which each takes a share of the work.
    cost: usize,
}

/// Angles of the drives relative to the one that is held.
#[derive(Clone, Copy, Debug)]
struct Cell {
    /// Least gap in the cell, m, or less.
    bound: f64,
    middle: [f64; MAX_DRIVES],
    half: [f64; MAX_DRIVES],
    /// Order in which cells were made, which decides between equal bounds.
    number: usize,
}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Cell {}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Cell {
    /// The greatest cell, which a heap returns first, is the one with the least bound.
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound).then(other.number.cmp(&self.number))
    }
}

impl<'a> Pair<'a> {
    /// Returns the pair of two solids.
    pub fn of(a: &'a PlanSolid, b: &'a PlanSolid) -> Self {
        let mut levers: [f64; MAX_DRIVES] = std::array::from_fn(|k| (a.root[k] - b.root[k]).abs());
        levers[a.drive] += a.lever();
        levers[b.drive] += b.lever();
        let mut drives: Vec<usize> = (0..MAX_DRIVES).filter(|k| levers[*k] > 0.0).collect();
        // The drive with the longest lever is held, because the bound then changes least.
        drives.sort_by(|k, l| levers[*l].total_cmp(&levers[*k]).then(k.cmp(l)));
        Self { a, b, drives, levers, cost: a.sides() * b.sides() }
    }

    /// Returns the most that a point of one solid moves relative to the other, m, if drives turn by `by`, rad.
    pub fn motion(&self, by: impl Fn(usize) -> f64) -> f64 {
        let Some((&held, others)) = self.drives.split_first() else { return 0.0 };
        others.iter().map(|&k| self.levers[k] * (by(k) - by(held)).abs()).sum()
    }

    /// Returns the work of [`at`](Self::at), in pairs of sides.
    pub fn cost(&self) -> usize {
        self.cost
    }

    /// Returns how near the solids are in a pose.
    pub fn at(&self, e: &UnitVectors) -> Nearness {
        nearness(self.a, self.b, e)
    }

    fn others(&self) -> &[usize] {
        self.drives.get(1..).unwrap_or_default()
    }

    /// Returns whether the solids overlap in a pose of the range; divides cells while there is work left in `budget`, in
    /// pairs of sides, and takes what it needs from it.
    pub fn overlap(&self, range: &PoseRange, budget: &mut usize) -> Overlap {
        let Some(&held) = self.drives.first() else {
            let e = [Vector::new(1.0, 0.0); MAX_DRIVES];
            let near = self.at(&e);
            return if near.gap < 0.0 { Overlap::In(range.completed(&[]), near) } else { Overlap::Never };
        };
        let mut whole = Cell { bound: 0.0, middle: [0.0; MAX_DRIVES], half: [0.0; MAX_DRIVES], number: 0 };
        let mut wraps = [false; MAX_DRIVES];
        for &k in self.others() {
            let angle = range.difference(held, k);
            (whole.middle[k], whole.half[k], wraps[k]) = (angle.middle, angle.half, angle.wraps);
        }
        let mut cells = BinaryHeap::new();
        let mut made = 0;
        let mut parts = vec![whole];
        loop {
            for mut cell in parts.drain(..) {
                if !self.is_possible(range, &cell, &wraps, true) {
                    continue;
                }
                let near = self.at(&units(&cell, held));
                if near.gap < 0.0 && self.is_possible(range, &cell, &wraps, false) {
                    return self.found(range, &cell, held, Overlap::In);
                }
                cell.bound = near.gap - self.others().iter().map(|&k| self.levers[k] * cell.half[k]).sum::<f64>();
                if cell.bound < 0.0 {
                    made += 1;
                    cells.push(Cell { number: made, ..cell });
                }
            }
            let Some(cell) = cells.pop() else { return Overlap::Never };
            let reach = |k: &usize| self.levers[*k] * cell.half[*k];
            let widest = self.others().iter().copied().max_by(|k, l| reach(k).total_cmp(&reach(l)));
            let Some(k) = widest.filter(|k| reach(k) > 0.25 * TOLERANCE && *budget > 0) else {
                return self.found(range, &cell, held, Overlap::Undecided);
            };
            *budget = budget.saturating_sub(self.cost);
            let half = 0.5 * cell.half[k];
            parts.extend([-half, half].map(|shift| {
                let mut part = cell;
                part.middle[k] += shift;
                part.half[k] = half;
                part
            }));
        }
    }

    fn found(&self, range: &PoseRange, cell: &Cell, held: usize, result: fn(Vec<f64>, Nearness) -> Overlap) -> Overlap {
        let turned = self.others().iter().map(|&k| (k, cell.middle[k]));
        let start = range.completed(&[])[held];
        let known: Vec<(usize, f64)> =
            [(held, start)].into_iter().chain(turned.map(|(k, angle)| (k, start + angle))).collect();
        let q = range.completed(&known);
        let e = std::array::from_fn(|k| unit(q.get(k).copied().unwrap_or_default()));
        let near = self.at(&e);
        result(q, near)
    }

    /// Returns whether a cell, or only its middle, may hold poses within the limits between the turned drives.
    fn is_possible(&self, range: &PoseRange, cell: &Cell, wraps: &[bool; MAX_DRIVES], whole: bool) -> bool {
        let others = self.others();
        let pairs = others.iter().enumerate().flat_map(|(i, &k)| others[i + 1..].iter().map(move |&l| (k, l)));
        pairs.into_iter().all(|(k, l)| {
            let allowed = range.difference(k, l);
            if allowed.wraps {
                return true;
            }
            let away = cell.middle[l] - cell.middle[k] - allowed.middle;
            let away = if wraps[k] || wraps[l] { away - TAU * (away / TAU).round() } else { away };
            // A pose on a limit is within it, whatever rounding says.
            let slack = if whole { cell.half[k] + cell.half[l] + 1e-12 } else { 1e-12 };
            away.abs() <= allowed.half + slack
        })
    }
}

/// Returns the unit vectors of all drives in the middle of a cell, with the held drive along x.
fn units(cell: &Cell, held: usize) -> UnitVectors {
    std::array::from_fn(|k| if k == held { Vector::new(1.0, 0.0) } else { unit(cell.middle[k]) })
}
