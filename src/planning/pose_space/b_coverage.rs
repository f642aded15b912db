//! [`BCoverage`]: the values of b at which points at a given distance from B can be reached.

use super::critical::CriticalPose;
use crate::reactionless::BSet;

/// Critical values farther than this from a gap, as a fraction of the period of b, cannot cross the gap from one
/// distance from B to the next.
const NEAR_GAP: f64 = 0.125;

/// The circle of b at a distance from B, divided by the critical values into gaps that are feasible or not. Feasible
/// sets begin and end at critical values only. At a nearby distance, the gap between the same two values therefore
/// has the same feasibility, unless a third value has passed both. In that case the neighbouring values have mostly
/// changed.
#[derive(Clone, Debug, Default)]
pub(super) struct BCoverage {
    /// The critical values, ascending in b.
    pub ends: Vec<CriticalPose>,
    /// Whether the gap after each critical value is feasible; a single entry for the whole circle if there are no
    /// critical values.
    pub gaps: Vec<bool>,
    pub period: f64,
}

impl BCoverage {
    /// Returns the feasible set of b.
    pub fn set(&self, period: f64) -> BSet {
        let n = self.ends.len();
        if n == 0 {
            let whole = self.gaps.first() == Some(&true);
            return BSet { intervals: if whole { vec![[0.0, period]] } else { Vec::new() }, period };
        }
        let mut parts: Vec<[f64; 2]> = Vec::with_capacity(2 * n);
        parts.extend(self.ends.iter().map(|c| [c.b, c.b]));
        for (i, covered) in self.gaps.iter().enumerate() {
            if *covered {
                let to = if i + 1 < n { self.ends[i + 1].b } else { self.ends[0].b + period };
                parts.push([self.ends[i].b, to]);
            }
        }
        BSet::union(parts, period)
    }

    /// Extends feasible gaps across critical values at which no connected component of poses ends.
    pub fn spread(&mut self) {
        let n = self.ends.len();
        for _ in 0..2 {
            for i in 0..n {
                let next = (i + 1) % n;
                self.gaps[next] |= self.gaps[i] && self.ends[next].passes_up();
            }
            for i in (0..n).rev() {
                let next = (i + 1) % n;
                self.gaps[i] |= self.gaps[next] && self.ends[next].passes_down();
            }
        }
    }

    /// Returns the names of the critical values around gap i, two on either side.
    fn around(&self, i: usize) -> [u64; 4] {
        let n = self.ends.len();
        [n - 1, 0, 1, 2].map(|j| self.ends[(i + j) % n].name)
    }

    /// Finds the gap between the same two critical values as gap `i` of another distance. With `all`, the next values
    /// on either side must agree too, and none may have passed the gap. Two values alone that pass each other keep
    /// their cyclic order; so with fewer than three values the index must agree too.
    pub fn gap(&self, of: &Self, i: usize, all: bool) -> Option<usize> {
        let (n, around) = (self.ends.len(), of.around(i));
        let same = |j: &usize| {
            let own = self.around(*j);
            own[1..3] == around[1..3] && (!all || (own == around && self.has_sides(*j, of, i)))
        };
        if n < 3 || of.ends.len() < 3 {
            return (n == of.ends.len() && same(&i)).then_some(i);
        }
        (0..n).find(same)
    }

    /// Returns whether no critical value passes the gap that is i at another distance and j at this one. Then the
    /// values near both gaps are the same and lie on the same sides.
    fn has_sides(&self, j: usize, of: &Self, i: usize) -> bool {
        let near = NEAR_GAP * self.period;
        let (here, there) = (self.middle(j), of.middle(i));
        let off = |c: &CriticalPose, middle: f64| {
            let half = 0.5 * self.period;
            (c.b - middle + half).rem_euclid(self.period) - half
        };
        let keeps = |one: &Self, middle: f64, other: &Self, others: f64| {
            one.ends.iter().all(|c| {
                let own = off(c, middle);
                own.abs() > near || other.ends.iter().any(|d| d.name == c.name && (off(d, others) > 0.0) == (own > 0.0))
            })
        };
        keeps(self, here, of, there) && keeps(of, there, self, here)
    }

    /// Returns the b at the midpoint of a gap, rad.
    fn middle(&self, i: usize) -> f64 {
        let [from, to] = self.edges(i);
        0.5 * (from + to)
    }

    /// Returns the b at which a gap begins and ends, rad.
    pub fn edges(&self, i: usize) -> [f64; 2] {
        let n = self.ends.len();
        [self.ends[i].b, if i + 1 < n { self.ends[i + 1].b } else { self.ends[0].b + self.period }]
    }

    /// Returns the distances, rad, from gap i down and up to the nearest gaps known to be empty. A component of poses
    /// in gap i cannot extend beyond these gaps.
    pub fn free(&self, i: usize, empty: &[bool]) -> [f64; 2] {
        let n = self.ends.len();
        let [from, to] = self.edges(i);
        let below = (1..n).map(|k| (i + n - k) % n).find(|j| empty[*j]);
        let above = (1..n).map(|k| (i + k) % n).find(|j| empty[*j]);
        let low = below.map_or(self.period, |j| (from - self.edges(j)[1]).rem_euclid(self.period));
        let high = above.map_or(self.period, |j| (self.edges(j)[0] - to).rem_euclid(self.period));
        [low, high]
    }

    /// Marks gaps as feasible that are feasible at a neighbouring distance: a component found there exists here too.
    pub fn covers_too(&mut self, neighbour: &Self) {
        for i in 0..self.ends.len() {
            self.gaps[i] |= neighbour.gap(self, i, true).is_some_and(|j| neighbour.gaps[j]);
        }
        self.spread();
    }

    /// Whether the whole circle is feasible; `None` if there are critical values.
    pub fn whole(&self) -> Option<bool> {
        self.gaps.first().copied().filter(|_| self.ends.is_empty())
    }
}
