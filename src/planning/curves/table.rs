//! A path as a table of nodes: poses with two derivatives, joined by quintics.

use crate::curves::PathPoint;
use stillbase_mechanics::planar::PerDrive;

/// Nodes of a path at s from 0 to 1, in order, joined by quintics that match q, q′ and q″. The error of the quintics
/// falls with the sixth power of the spacing. If all nodes have the same b, so has every pose between them, up to
/// rounding.
#[derive(Clone, Debug, PartialEq)]
pub struct PathTable {
    s: Vec<f64>,
    nodes: Vec<PathPoint>,
    /// Lookup table: 0..1 has as many equal parts as there are intervals; entry i is the interval where part i begins.
    guide: Vec<u32>,
}

impl PathTable {
    /// Builds a table of nodes spaced evenly in s; at least two, all with the same number of drives.
    pub fn even(nodes: Vec<PathPoint>) -> Option<Self> {
        let spaces = nodes.len().checked_sub(1).filter(|n| *n > 0)?;
        let s = (0..=spaces).map(|i| i as f64 / spaces as f64).collect();
        Self::new(s, nodes)
    }

    /// Builds a table of nodes at given s. Returns `None` if the s do not rise from 0 to 1, their number differs from
    /// that of the nodes, or there are fewer than two nodes.
    pub fn new(s: Vec<f64>, nodes: Vec<PathPoint>) -> Option<Self> {
        let spaces = nodes.len().checked_sub(1).filter(|n| *n > 0)?;
        let rising = s.len() == nodes.len() && s[0] == 0.0 && s[spaces] == 1.0 && s.windows(2).all(|w| w[0] < w[1]);
        if !rising {
            return None;
        }
        let mut guide = Vec::with_capacity(spaces);
        let mut at = 0;
        for i in 0..spaces {
            let begin = i as f64 / spaces as f64;
            while at + 1 < spaces && s[at + 1] <= begin {
                at += 1;
            }
            guide.push(at as u32);
        }
        Some(Self { s, nodes, guide })
    }

    /// Returns the nodes.
    pub fn nodes(&self) -> &[PathPoint] {
        &self.nodes
    }

    /// Returns the s of the nodes.
    pub fn stations(&self) -> &[f64] {
        &self.s
    }

    /// Returns the index of the interval in which s, 0..1, lies.
    #[inline]
    fn interval(&self, s: f64) -> usize {
        let spaces = self.guide.len();
        let part = ((s * spaces as f64) as usize).min(spaces - 1);
        let first = self.guide[part] as usize;
        // Nodes may be much denser in one part than in another.
        let last = self.guide.get(part + 1).map_or(spaces - 1, |next| *next as usize);
        if last - first > 8 {
            return first + self.s[first + 1..=last].partition_point(|node| *node <= s);
        }
        let mut i = first;
        while i + 1 < spaces && self.s[i + 1] <= s {
            i += 1;
        }
        i
    }

    /// Returns the pose at s, 0..1, and its derivatives.
    #[inline]
    pub fn at(&self, s: f64) -> PathPoint {
        let i = self.interval(s);
        let h = self.s[i + 1] - self.s[i];
        quintic(&self.nodes[i], &self.nodes[i + 1], h, (s - self.s[i]) / h)
    }

    /// Returns d³q/ds³ at s, 0..1.
    pub(super) fn third(&self, s: f64) -> PerDrive {
        let i = self.interval(s);
        let h = self.s[i + 1] - self.s[i];
        third(&self.nodes[i], &self.nodes[i + 1], h, (s - self.s[i]) / h)
    }

    /// Returns the s of the nodes at which q‴ jumps, and both ends.
    pub(super) fn joints(&self) -> Vec<f64> {
        let width = |i: usize| self.s[i + 1] - self.s[i];
        let side = |i: usize, u: f64| third(&self.nodes[i], &self.nodes[i + 1], width(i), u);
        let jumps = |i: &usize| {
            let (before, after) = (side(*i - 1, 1.0), side(*i, 0.0));
            // Interpolation and rounding errors of q‴ do not count as jumps.
            let noise = 1e-12 / width(*i - 1).min(width(*i)).powi(3);
            after.minus(&before).max_abs() > 0.02 * before.max_abs().max(after.max_abs()) + noise
        };
        let inner = (1..self.guide.len()).filter(jumps).map(|i| self.s[i]);
        std::iter::once(0.0).chain(inner).chain([1.0]).collect()
    }
}

/// Evaluates the quintic between two nodes, h apart in s, at the fraction u of the interval.
#[inline]
fn quintic(a: &PathPoint, b: &PathPoint, h: f64, u: f64) -> PathPoint {
    let mut p = PathPoint { q: a.q, first: a.first, second: a.second };
    for k in 0..a.q.len() {
        let (c0, c1, c2) = (a.q[k], a.first[k] * h, a.second[k] * h * h / 2.0);
        let (v, v1, v2) = (b.q[k] - c0 - c1 - c2, b.first[k] * h - c1 - 2.0 * c2, b.second[k] * h * h - 2.0 * c2);
        let (c3, c4, c5) = (10.0 * v - 4.0 * v1 + v2 / 2.0, -15.0 * v + 7.0 * v1 - v2, 6.0 * v - 3.0 * v1 + v2 / 2.0);
        p.q.0[k] = c0 + u * (c1 + u * (c2 + u * (c3 + u * (c4 + u * c5))));
        p.first[k] = (c1 + u * (2.0 * c2 + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)))) / h;
        p.second[k] = (2.0 * c2 + u * (6.0 * c3 + u * (12.0 * c4 + u * 20.0 * c5))) / (h * h);
    }
    p
}

/// Returns d³q/ds³ of the quintic between two nodes, h apart in s, at the fraction u of the interval.
fn third(a: &PathPoint, b: &PathPoint, h: f64, u: f64) -> PerDrive {
    PerDrive::from_fn(a.q.len(), |k| {
        let (c0, c1, c2) = (a.q[k], a.first[k] * h, a.second[k] * h * h / 2.0);
        let (v, v1, v2) = (b.q[k] - c0 - c1 - c2, b.first[k] * h - c1 - 2.0 * c2, b.second[k] * h * h - 2.0 * c2);
        let (c3, c4, c5) = (10.0 * v - 4.0 * v1 + v2 / 2.0, -15.0 * v + 7.0 * v1 - v2, 6.0 * v - 3.0 * v1 + v2 / 2.0);
        (6.0 * c3 + u * (24.0 * c4 + u * 60.0 * c5)) / (h * h * h)
    })
}
