//! [`Slices`]: a set of points of a plane, by the intervals in which lines of one direction meet it.
//!
//! A point is (s, v): s along the lines, v across. The boundary is split into chains along which v grows. Between
//! levels at which a chain begins, ends or has a corner, the ends of all intervals are smooth functions of v.

use stillbase_mechanics::planar::{Vector, cross, dot};

/// Least turn of a corner of a boundary, rad; smaller ones belong to a smooth curve.
const CORNER_RAD: f64 = 0.35;

/// Levels that are nearer than this, as a share of the size, are one.
const SAME_LEVEL: f64 = 1e-9;

/// Lines along the boundary of a set, or along a curve, m.
#[derive(Clone, Debug)]
pub struct Lines {
    /// Polylines; a closed one repeats its first point.
    pub lines: Vec<Vec<Vector>>,
    /// Whether they bound a region; otherwise the set is the lines themselves.
    pub bounds: bool,
}

/// An end of an interval over a band.
#[derive(Clone, Copy, Debug)]
pub struct End {
    /// s at both ends of the band, m.
    pub s: [f64; 2],
    /// Direction (s, v) in which the boundary leads from band to band, at both ends, of any length.
    pub along: [Vector; 2],
}

/// An interval over a band: its lower and its upper end, equal on a curve.
pub type Part = [End; 2];

/// Levels between which the same intervals are there, and their ends are straight.
#[derive(Clone, Debug)]
pub struct Band {
    /// v at its ends, m.
    pub range: [f64; 2],
    /// Intervals; those of a region in order, without overlap.
    pub parts: Vec<Part>,
}

/// A set of points of a plane, band by band.
#[derive(Clone, Debug, Default)]
pub struct Slices {
    /// Bands in order; the first begins where the set does, and each where the one before ends.
    pub bands: Vec<Band>,
}

/// A part of a boundary along which v grows.
struct Chain {
    points: Vec<Vector>,
    /// Direction at each point, before and after it, in the sense of the chain.
    along: Vec<[Vector; 2]>,
}

impl Lines {
    /// Returns the extent [least, most] of s and of v, m; `None` without points.
    pub fn extent(&self) -> Option<[[f64; 2]; 2]> {
        let mut points = self.lines.iter().flatten();
        let first = points.next()?;
        let wider = |[low, high]: [f64; 2], x: f64| [low.min(x), high.max(x)];
        Some(points.fold([[first.re; 2], [first.im; 2]], |[s, v], p| [wider(s, p.re), wider(v, p.im)]))
    }

    /// Returns the set with each point changed by a linear map.
    pub fn mapped(&self, map: impl Fn(Vector) -> Vector) -> Self {
        let line = |line: &Vec<Vector>| line.iter().map(|p| map(*p)).collect();
        Self { lines: self.lines.iter().map(line).collect(), bounds: self.bounds }
    }

    /// Returns the set with fewer points, so that lines deviate by at most `chord`, m.
    pub fn simplified(&self, chord: f64) -> Self {
        Self { lines: self.lines.iter().map(|line| simplified(line, chord)).collect(), bounds: self.bounds }
    }

    /// Returns its chains, and the levels between which nothing begins, ends or has a corner.
    fn chains(&self, size: f64) -> (Vec<Chain>, Vec<f64>) {
        let (mut chains, mut levels) = (Vec::new(), Vec::new());
        for line in &self.lines {
            let mut line = line.clone();
            line.dedup_by(|p, q| (*p - *q).norm() <= SAME_LEVEL * size);
            let Some(last) = line.len().checked_sub(1).filter(|last| *last > 0) else { continue };
            let is_closed = last > 1 && (line[0] - line[last]).norm() <= SAME_LEVEL * size;
            let way = |i: usize| line[i + 1] - line[i];
            let steps = |i: usize| match way(i).im {
                rise if rise.abs() <= SAME_LEVEL * size => 0.0,
                rise => rise.signum(),
            };
            // Direction before and after each point.
            let along = |i: usize| {
                let before = (i > 0).then(|| way(i - 1)).or(is_closed.then(|| way(last - 1)));
                let after = (i < last).then(|| way(i)).or(is_closed.then(|| way(0)));
                let (Some(a), Some(b)) = (before, after) else {
                    let only = before.or(after).unwrap_or_default();
                    return [only; 2];
                };
                // Weighted as by a circle through the three points.
                let (p, q) = (a.norm(), b.norm());
                match cross(a, b).atan2(dot(a, b)).abs() < CORNER_RAD {
                    true => [a / p * q + b / q * p; 2],
                    false => [a, b],
                }
            };
            // A closed line is walked from a turn of the sense, so that no chain is cut.
            let start = match is_closed {
                true => (0..last).find(|i| steps(*i) != steps((i + last - 1) % last)).unwrap_or(0),
                false => 0,
            };
            let mut chain: Option<(f64, Chain)> = None;
            for k in 0..last {
                let i = (start + k) % last;
                let sense = steps(i);
                if chain.as_ref().is_some_and(|(own, _)| *own != sense) {
                    chains.extend(chain.take().map(|(_, own)| own));
                }
                if sense == 0.0 {
                    continue;
                }
                let (_, own) =
                    chain.get_or_insert_with(|| (sense, Chain { points: vec![line[i]], along: vec![along(i)] }));
                own.points.push(line[i + 1]);
                own.along.push(along(if is_closed { (i + 1) % last } else { i + 1 }));
            }
            chains.extend(chain.map(|(_, own)| own));
        }
        for chain in &mut chains {
            let Chain { points, along } = chain;
            if points[0].im > points[1].im {
                points.reverse();
                along.reverse();
                along.iter_mut().for_each(|[before, after]| (*before, *after) = (-*after, -*before));
            }
            levels.extend([points[0].im, points[points.len() - 1].im]);
            levels.extend(points.iter().zip(along).filter(|(_, [a, b])| a != b).map(|(p, _)| p.im));
        }
        levels.sort_by(f64::total_cmp);
        levels.dedup_by(|b, a| *b - *a <= SAME_LEVEL * size);
        (chains, levels)
    }
}

/// Returns a polyline with as few points as keep it within `chord` of all: those farthest from the chords so far.
fn simplified(line: &[Vector], chord: f64) -> Vec<Vector> {
    let Some(last) = line.len().checked_sub(1).filter(|last| *last > 1) else { return line.to_vec() };
    // A closed line is divided first where it is farthest from its begin.
    let far = (0..=last).max_by(|i, k| (line[*i] - line[0]).norm().total_cmp(&(line[*k] - line[0]).norm()));
    let mut kept = vec![false; line.len()];
    let mut open = vec![(0, far.unwrap_or(last)), (far.unwrap_or(last), last)];
    (kept[0], kept[last]) = (true, true);
    while let Some((from, to)) = open.pop() {
        kept[from] = true;
        if to <= from + 1 {
            continue;
        }
        let worst = (from + 1..to).map(|i| (i, beside(line[i], line[from], line[to])));
        if let Some((i, off)) = worst.max_by(|a, b| a.1.total_cmp(&b.1))
            && off > chord
        {
            open.extend([(from, i), (i, to)]);
        }
    }
    line.iter().zip(kept).filter_map(|(p, kept)| kept.then_some(*p)).collect()
}

/// Returns the distance of a point from a chord, m.
fn beside(p: Vector, from: Vector, to: Vector) -> f64 {
    let way = to - from;
    let share = dot(p - from, way) / way.norm_sqr();
    (p - from - way * if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 }).norm()
}

impl Chain {
    fn covers(&self, v: f64) -> bool {
        self.points[0].im <= v && v <= self.points[self.points.len() - 1].im
    }

    /// Returns s and the direction at a level, as seen from above it or from below.
    fn at(&self, v: f64, from_above: bool) -> (f64, Vector) {
        let last = self.points.len() - 1;
        let after = self.points.partition_point(|p| if from_above { p.im <= v } else { p.im < v });
        let i = after.clamp(1, last) - 1;
        let ([p, q], [a, b]) = ([self.points[i], self.points[i + 1]], [self.along[i][1], self.along[i + 1][0]]);
        let share = ((v - p.im) / (q.im - p.im)).clamp(0.0, 1.0);
        (p.re + share * (q.re - p.re), a / a.norm() * (1.0 - share) + b / b.norm() * share)
    }

    /// Returns the point between two levels farthest from the chord, and its distance from it, m.
    fn farthest(&self, [from, to]: [f64; 2]) -> Option<(f64, f64)> {
        let [a, b] = [(from, true), (to, false)].map(|(v, above)| Vector::new(self.at(v, above).0, v));
        let first = self.points.partition_point(|p| p.im <= from);
        let inside = self.points[first..].iter().take_while(|p| p.im < to);
        inside.map(|p| (beside(*p, a, b), p.im)).max_by(|a, b| a.0.total_cmp(&b.0))
    }
}

impl Slices {
    /// Returns the intervals of a set; their ends deviate by at most `chord`, m.
    pub fn of(set: &Lines, chord: f64) -> Self {
        let Some([s, v]) = set.extent() else { return Self::default() };
        let size = (s[1] - s[0]).max(v[1] - v[0]);
        let (chains, levels) = set.chains(size);
        let mut bands = Vec::new();
        for pair in levels.windows(2) {
            let middle = 0.5 * (pair[0] + pair[1]);
            let here: Vec<&Chain> = chains.iter().filter(|chain| chain.covers(middle)).collect();
            let mut open = vec![[pair[0], pair[1]]];
            while let Some(range) = open.pop() {
                let worst = here.iter().filter_map(|chain| chain.farthest(range)).max_by(|a, b| a.0.total_cmp(&b.0));
                let [from, to] = range;
                match worst {
                    // Next to a level there is nothing to divide.
                    Some((off, v)) if off > chord && (v - from).min(to - v) > SAME_LEVEL * size => {
                        open.extend([[v, to], [from, v]]);
                    }
                    _ => bands.push(Band { range, parts: parts(&here, range, set.bounds) }),
                }
            }
        }
        Self { bands }
    }
}

/// Returns the intervals over a band.
fn parts(chains: &[&Chain], [from, to]: [f64; 2], bounds: bool) -> Vec<Part> {
    let end = |chain: &&Chain| {
        let [(a, along_a), (b, along_b)] = [chain.at(from, true), chain.at(to, false)];
        End { s: [a, b], along: [along_a, along_b] }
    };
    let mut ends: Vec<End> = chains.iter().map(end).collect();
    ends.sort_by(|a, b| (a.s[0] + a.s[1]).total_cmp(&(b.s[0] + b.s[1])));
    match bounds {
        // Chords of curves that touch may cross by what they deviate.
        true => ends.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect(),
        false => ends.into_iter().map(|end| [end, end]).collect(),
    }
}
