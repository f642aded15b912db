//! [`Covered`]: what of the circle of b reaches points at a distance from B.

use super::critical::Critical;
use crate::planning::reactionless::BSet;

/// Values as near to a gap as this, as a share of b's period, may pass it from one circle to the next, if they move so far:
/// by the farthest move of any such value, and so many times more.
const NEAR_GAP: f64 = 0.125;
const MOVES: f64 = 4.0;
/// rad.
const ROUNDING: f64 = 1e-9;

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
                self.gaps[next] |= self.gaps[i] && !self.ends[next].down;
            }
            for i in (0..n).rev() {
                let next = (i + 1) % n;
                self.gaps[i] |= self.gaps[next] && !self.ends[next].up;
            }
        }
    }

    /// The gap between the same two values as one of another distance, whatever passed it in between. Two values that
    /// pass each other keep their order round the circle: of two, it has to be the same from 0 on.
    fn named(&self, of: &Self, i: usize) -> Option<usize> {
        let n = self.ends.len();
        let names = |one: &Self, i: usize| [i, i + 1].map(|j| one.ends[j % one.ends.len()].name);
        let wanted = names(of, i);
        let same = |j: &usize| names(self, *j) == wanted;
        if n < 3 || of.ends.len() < 3 {
            return (n == of.ends.len() && same(&i)).then_some(i);
        }
        (0..n).find(same)
    }

    /// The gap that goes on to one of another distance; if that has to be sure, with no value that may have passed it in
    /// between.
    pub fn gap(&self, of: &Self, i: usize, sure: bool) -> Option<usize> {
        let named = self.named(of, i);
        if !sure {
            return named;
        }
        let there = || (of.ends.len() > 2 && self.ends.len() > 2).then(|| self.about(of.middle(i)));
        named.or_else(there).filter(|j| self.has_sides(*j, of, i))
    }

    /// Whether no value has passed gap j on its way to gap i of another distance: all that are near have kept their sides,
    /// and those that are new or gone would have had to move much faster than the others. Poses that are new or gone have
    /// their least value on one side and their greatest on the other; a gap that opens or closes has both its ends so.
    fn has_sides(&self, j: usize, of: &Self, i: usize) -> bool {
        let [here, there] = [self.edges(j), of.edges(i)];
        let (mut moved, mut least): (f64, f64) = (0.0, f64::INFINITY);
        for (one, edges, other, others) in [(self, here, of, there), (of, there, self, here)] {
            let (mut across, mut ends) = ([false; 2], 0);
            for c in &one.ends {
                let [off, side] = one.beside(c, &edges);
                if off > NEAR_GAP * self.period {
                    continue;
                }
                match other.ends.iter().find(|d| d.name == c.name) {
                    Some(d) if other.beside(d, &others)[1] != side => return false,
                    Some(d) => moved = moved.max(one.apart(c.b, d.b)),
                    None => {
                        least = least.min(off);
                        ends += usize::from(off == 0.0);
                        across[0] |= side < 0.0 && c.up && !c.down;
                        across[1] |= side > 0.0 && c.down && !c.up;
                    }
                }
            }
            if across == [true; 2] || ends > 1 {
                return false;
            }
        }
        let width = (here[1] - here[0]).min(there[1] - there[0]);
        least + width > MOVES * moved
    }

    /// The gap in which b lies.
    fn about(&self, b: f64) -> usize {
        let n = self.ends.len();
        (self.ends.partition_point(|c| c.b <= b.rem_euclid(self.period)) + n - 1) % n
    }

    fn middle(&self, i: usize) -> f64 {
        let [from, to] = self.edges(i);
        0.5 * (from + to)
    }

    /// How far a value is from a gap, rad, and on which side, by the shorter way round.
    fn beside(&self, c: &Critical, [from, to]: &[f64; 2]) -> [f64; 2] {
        let half = 0.5 * self.period;
        let off = (c.b - 0.5 * (from + to) + half).rem_euclid(self.period) - half;
        let past = off.abs() - 0.5 * (to - from);
        [if past > ROUNDING { past } else { 0.0 }, off.signum()]
    }

    /// How far two values are apart, by the shorter way round, rad.
    fn apart(&self, x: f64, y: f64) -> f64 {
        let by = (x - y).rem_euclid(self.period);
        by.min(self.period - by)
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
