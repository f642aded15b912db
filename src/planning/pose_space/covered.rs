//! [`Covered`]: what of the circle of b reaches points at a distance from B.

use super::critical::Critical;
use crate::planning::reactionless::BSet;

/// Values as near to a gap as this, as a share of b's period, may pass it from one circle to the next.
const NEAR_GAP: f64 = 0.125;

/// What of the circle of b is covered at a distance. Sets begin and end at critical values only, so at a distance near by
/// what lies between the same two is covered as well, or not, unless a third one has passed both: then there are mostly
/// others about them.
#[derive(Clone, Debug, Default)]
pub(super) struct Covered {
    /// The critical values, from the least.
    pub ends: Vec<Critical>,
    /// Whether what lies between each and the next is covered; one, of the whole circle, where there are no values.
    pub gaps: Vec<bool>,
    pub period: f64,
}

impl Covered {
    /// As intervals of b.
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

    /// What comes to a value at which nothing ends goes on there.
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

    /// The names of the values about gap i, two on either side.
    fn around(&self, i: usize) -> [u64; 4] {
        let n = self.ends.len();
        [n - 1, 0, 1, 2].map(|j| self.ends[(i + j) % n].name)
    }

    /// The gap between the same two values as one of another distance; with the same ones on either side of it, too, if
    /// all have to be. Two values that pass each other keep their order round the circle: of two, it has to be the same
    /// from 0 on.
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

    /// Whether no value has passed gap j on its way to gap i of another distance: those near either have kept their sides,
    /// and none is new or gone.
    fn has_sides(&self, j: usize, of: &Self, i: usize) -> bool {
        let near = NEAR_GAP * self.period;
        let (here, there) = (self.middle(j), of.middle(i));
        let off = |c: &Critical, middle: f64| {
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

    /// The b in the middle of a gap, rad.
    fn middle(&self, i: usize) -> f64 {
        let [from, to] = self.edges(i);
        0.5 * (from + to)
    }

    /// The b at which a gap begins and ends, rad.
    pub fn edges(&self, i: usize) -> [f64; 2] {
        let n = self.ends.len();
        [self.ends[i].b, if i + 1 < n { self.ends[i + 1].b } else { self.ends[0].b + self.period }]
    }

    /// How far below and above gap i poses in it may come from without passing a gap that is empty, rad.
    pub fn free(&self, i: usize, empty: &[bool]) -> [f64; 2] {
        let n = self.ends.len();
        let [from, to] = self.edges(i);
        let below = (1..n).map(|k| (i + n - k) % n).find(|j| empty[*j]);
        let above = (1..n).map(|k| (i + k) % n).find(|j| empty[*j]);
        let low = below.map_or(self.period, |j| (from - self.edges(j)[1]).rem_euclid(self.period));
        let high = above.map_or(self.period, |j| (self.edges(j)[0] - to).rem_euclid(self.period));
        [low, high]
    }

    /// Covers what is covered at a distance beside this one: what was found there cannot be missing here.
    pub fn covers_too(&mut self, beside: &Self) {
        for i in 0..self.ends.len() {
            self.gaps[i] |= beside.gap(self, i, true).is_some_and(|j| beside.gaps[j]);
        }
        self.spread();
    }

    /// Whether all of it was covered, where there were no values.
    pub fn whole(&self) -> Option<bool> {
        self.gaps.first().copied().filter(|_| self.ends.is_empty())
    }
}
