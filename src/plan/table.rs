//! A path by its nodes: poses with two derivatives, joined by quintics.

use super::path::PathPoint;

/// Nodes of a path at s from 0 to 1, in order, joined by quintics that keep q, q′ and q″; the quintic's error falls with
/// the sixth power of the spacing. Between nodes of one pose constant b, b is kept to rounding.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    s: Vec<f64>,
    nodes: Vec<PathPoint>,
    /// For each of as many even parts of 0..1 as there are spaces, the space in which it begins.
    guide: Vec<u32>,
}

impl Table {
    /// Nodes spaced evenly in s; at least two, all of one number of drives.
    pub fn even(nodes: Vec<PathPoint>) -> Option<Self> {
        let spaces = nodes.len().checked_sub(1).filter(|n| *n > 0)?;
        let s = (0..=spaces).map(|i| i as f64 / spaces as f64).collect();
        Self::new(s, nodes)
    }

    /// Nodes at given s that rise from 0 to 1; `None` if they do not, or if there are fewer than two.
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

    /// The nodes.
    pub fn nodes(&self) -> &[PathPoint] {
        &self.nodes
    }

    /// Their s.
    pub fn stations(&self) -> &[f64] {
        &self.s
    }

    /// The pose at s, 0..1.
    #[inline]
    pub fn at(&self, s: f64) -> PathPoint {
        let spaces = self.guide.len();
        let mut i = self.guide[((s * spaces as f64) as usize).min(spaces - 1)] as usize;
        while i + 1 < spaces && self.s[i + 1] <= s {
            i += 1;
        }
        let h = self.s[i + 1] - self.s[i];
        quintic(&self.nodes[i], &self.nodes[i + 1], h, (s - self.s[i]) / h)
    }
}

/// Between two nodes h apart, at the share u.
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
