//! The sum of two sets in one plane.
//!
//! Over two bands the sum of two intervals is that of two convex sets. So it meets a line of a level v in one interval,
//! from the least to the greatest sum of their ends at levels that add up to v. These are straight, so their extremes
//! are at the ends of the range of such levels. The sum of both sets has the union of all these intervals.

use super::slices::{End, Slices};
use super::strips::Piece;

/// Number of levels from which it is refined.
const LEVELS: usize = 64;

/// Least distance of levels, as a share of the distance by which ends may deviate.
const LEAST: f64 = 0.25;

/// The sum of two sets, line by line.
pub struct FlatSum<'a>(pub &'a Slices, pub &'a Slices);

fn at(end: &End, [from, to]: [f64; 2], v: f64) -> f64 {
    let share = if to > from { ((v - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 };
    end.s[0] + share * (end.s[1] - end.s[0])
}

impl FlatSum<'_> {
    /// Returns the intervals at a level, in order.
    fn at(&self, level: f64) -> Vec<[f64; 2]> {
        let mut all = Vec::new();
        for a in &self.0.bands {
            for b in &self.1.bands {
                let from = a.range[0].max(level - b.range[1]);
                let to = a.range[1].min(level - b.range[0]);
                if from > to {
                    continue;
                }
                for (p, q) in a.parts.iter().flat_map(|p| b.parts.iter().map(move |q| (p, q))) {
                    let sum = |i: usize, v: f64| at(&p[i], a.range, v) + at(&q[i], b.range, level - v);
                    all.push([sum(0, from).min(sum(0, to)), sum(1, from).max(sum(1, to))]);
                }
            }
        }
        all.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut joined: Vec<[f64; 2]> = Vec::new();
        for own in all {
            match joined.last_mut() {
                Some(last) if own[0] <= last[1] => last[1] = last[1].max(own[1]),
                _ => joined.push(own),
            }
        }
        joined
    }

    /// Returns trapezoids that fill it; their ends deviate by at most about `chord`, m.
    pub fn pieces(&self, chord: f64) -> Vec<Piece> {
        let range = |of: &Slices| Some([of.bands.first()?.range[0], of.bands.last()?.range[1]]);
        let (Some(a), Some(b)) = (range(self.0), range(self.1)) else { return Vec::new() };
        let [from, to] = [a[0] + b[0], a[1] + b[1]];
        let level = |i: usize| from + (to - from) * i as f64 / LEVELS as f64;
        let mut open: Vec<[(f64, Vec<[f64; 2]>); 2]> =
            (0..LEVELS).rev().map(|i| [level(i), level(i + 1)].map(|v| (v, self.at(v)))).collect();
        let mut pieces = Vec::new();
        while let Some([low, high]) = open.pop() {
            let middle = 0.5 * (low.0 + high.0);
            let between = self.at(middle);
            let is_alike =
                low.1.len() == high.1.len() && low.1.iter().zip(&high.1).all(|(a, b)| a[0] <= b[1] && b[0] <= a[1]);
            let is_straight = between.len() == low.1.len()
                && between
                    .iter()
                    .zip(low.1.iter().zip(&high.1))
                    .all(|(own, (a, b))| (0..2).all(|k| (own[k] - 0.5 * (a[k] + b[k])).abs() <= chord));
            if is_alike && is_straight || high.0 - low.0 <= LEAST * chord {
                let range = [low.0, high.0];
                let of = |ends: [[f64; 2]; 2]| Piece { range, ends, is_of_first: true };
                match is_alike {
                    true => pieces.extend(low.1.iter().zip(&high.1).map(|(a, b)| of([[a[0], b[0]], [a[1], b[1]]]))),
                    false => pieces.extend(between.iter().map(|own| of(own.map(|s| [s; 2])))),
                }
                continue;
            }
            let here = (middle, between);
            open.extend([[here.clone(), high], [low, here]]);
        }
        pieces
    }
}
