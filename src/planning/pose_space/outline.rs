//! The workspace of the end effector while b is held, as an outline.
//!
//! b only turns the workspace about B. Let β be the values of b at which the point at a distance r on the x axis can be
//! reached. Then the points at r that belong to the workspace have the angles φ = (b − β)/Σλ. The bounds of the
//! intervals of β, as functions of r, trace the boundary.

use super::loops::TracedBoundary;
use super::space::PoseSpace;
use crate::reactionless::BoundingBox;
use stillbase_mechanics::planar::{Vector, dot, unit};

/// The workspace of a b: a region, a curve for two drives, or a point for one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline {
    /// Area, m²; 0 for two drives.
    pub area: f64,
    /// Length of the curve of two drives, m.
    pub length: f64,
    /// Bounds `[x_min, x_max, y_min, y_max]`, m.
    pub extent: [f64; 4],
    /// Boundary, m: closed loops, the outer ones counter-clockwise.
    pub loops: Vec<Vec<[f64; 2]>>,
    /// The curve of two drives, or the point of one, m.
    pub curve: Vec<[f64; 2]>,
}

/// Maximum deviation of chords from the boundary, m: the area error is below 1e-6 m² for a boundary of 7 m.
const CHORD_TOLERANCE_M: f64 = 2e-7;
/// Maximum deviation of chords from the curve of two drives, as a fraction of the reach.
const CURVE_CHORD_TOLERANCE: f64 = 1e-5;

impl Outline {
    /// Returns the distance of a point from the boundary, m, negative outside; for two drives the distance from their
    /// curve.
    pub fn distance(&self, p: Vector) -> f64 {
        let at = |[x, y]: [f64; 2]| Vector::new(x, y);
        let beside = |from: [f64; 2], to: [f64; 2]| {
            let (from, way) = (at(from), at(to) - at(from));
            let share = dot(p - from, way) / way.norm_sqr();
            (p - from - way * if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 }).norm_sqr()
        };
        if self.loops.is_empty() {
            let first = self.curve.first().map(|x| beside(*x, *x));
            let spaces = self.curve.windows(2).map(|w| beside(w[0], w[1]));
            return spaces.chain(first).fold(f64::INFINITY, f64::min).sqrt();
        }
        let (mut far, mut inside) = (f64::INFINITY, false);
        for line in &self.loops {
            for (from, to) in line.iter().zip(line.iter().cycle().skip(1)) {
                far = far.min(beside(*from, *to));
                // A ray to the right crosses the boundary an odd number of times from inside.
                let ([ax, ay], [bx, by]) = (from, to);
                inside ^= (*ay > p.im) != (*by > p.im) && p.re < ax + (p.im - ay) / (by - ay) * (bx - ax);
            }
        }
        if inside { far.sqrt() } else { -far.sqrt() }
    }
}

impl PoseSpace {
    /// Returns the workspace of b.
    pub fn outline(&self, b: f64) -> Outline {
        self.outline_within(b, CHORD_TOLERANCE_M, &mut |_| true).unwrap_or_default()
    }

    /// Returns the workspace with chords that deviate by at most `chord`, m, from the boundary. With planes, or with
    /// one or two drives, `chord` has no effect. Progress from 0 to 1 is reported to `goes_on`; if that returns false,
    /// the result is `None`.
    pub fn outline_within(&self, b: f64, chord: f64, goes_on: &mut dyn FnMut(f64) -> bool) -> Option<Outline> {
        if let Ok(planes) = self.planes() {
            let (boundary, loops) = (planes.boundary(), planes.boundary().turned(b));
            let BoundingBox { x_min, x_max, y_min, y_max } = boundary.extent(b);
            return Some(Outline {
                area: boundary.area(),
                extent: [x_min, x_max, y_min, y_max],
                loops,
                ..Outline::default()
            });
        }
        Some(match self.drives() {
            1 => {
                let place = self.end_effector(&self.lift(&[], b));
                let at = [place.re, place.im];
                Outline { curve: vec![at], extent: [at[0], at[0], at[1], at[1]], ..Outline::default() }
            }
            2 => self.curve(b),
            _ => self.region(b, chord, goes_on)?,
        })
    }

    /// Returns the curve of the end effector of two drives, as the relative angle varies between its limits.
    fn curve(&self, b: f64) -> Outline {
        let [low, high] = self.joints[0].limits;
        let place = |a: f64| self.end_effector(&self.lift(&[a], b));
        let speed = |a: f64| {
            let q = self.lift(&[a], b);
            let rate = self.lift(&[a + 1.0], b).0.minus(&q.0);
            (0..2).map(|k| self.arms[k] * rate[k] * unit(q[k])).sum::<Vector>().norm()
        };
        // Number of chords from the curvature: |p″| is at most Σ |c_k| q_k′², with constant rates q_k′.
        let rate = self.lift(&[low + 1.0], b).0.minus(&self.lift(&[low], b).0);
        let bend: f64 = (0..2).map(|k| self.arms[k].abs() * rate[k] * rate[k]).sum();
        let turns = (high - low) * (bend / (8.0 * CURVE_CHORD_TOLERANCE * self.farthest().max(1e-3))).sqrt();
        let parts = (turns.ceil() as usize).clamp(16, 4000).next_multiple_of(2);
        let at = |i: usize| low + (high - low) * i as f64 / parts as f64;
        let curve: Vec<[f64; 2]> = (0..=parts).map(|i| place(at(i))).map(|p| [p.re, p.im]).collect();
        let h = (high - low) / parts as f64;
        let weight = |i: usize| {
            if i == 0 || i == parts {
                1.0
            } else if i % 2 == 1 {
                4.0
            } else {
                2.0
            }
        };
        let length = (0..=parts).map(|i| weight(i) * speed(at(i))).sum::<f64>() * h / 3.0;
        Outline { length, extent: extent(curve.iter()), curve, ..Outline::default() }
    }

    fn region(&self, b: f64, chord: f64, goes_on: &mut dyn FnMut(f64) -> bool) -> Option<Outline> {
        let TracedBoundary { area, loops } = self.rings(b, chord, goes_on)?.traced();
        Some(Outline { area, extent: extent(loops.iter().flatten()), loops, ..Outline::default() })
    }
}

fn extent<'a>(points: impl Iterator<Item = &'a [f64; 2]>) -> [f64; 4] {
    let none = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY];
    let all = points.fold(none, |[a, b, c, d], p| [a.min(p[0]), b.max(p[0]), c.min(p[1]), d.max(p[1])]);
    if all[0].is_finite() { all } else { [0.0; 4] }
}
