//! The inverse of (16): all poses that put the end effector on a point of a plane b = const.
//!
//! Source: (13)–(16). The curve of poses that keep the end effector on the point is cut into arcs along which b is
//! monotone, so each pose is bracketed before it is polished, and none is missed.

use std::fmt;
use std::ops::Deref;

use super::plane::{PlaneMap, PlanePoint, SLACK};
use super::quadrilateral::{Quadrilateral, Site};
use crate::mechanics::planar::{Vector, cross, unit};

/// Poses that fit without memory of their own: many more than there are within one turn of each angle.
const INLINE: usize = 64;

/// b may pass a fold by this much and still meet it, rad; a flat pose may miss the point by this share of the reach.
const AT_FOLD: f64 = 1e-12;

/// What keeping the limits may cost: the end effector misses the point by no more than this share of the reach.
const CLAMPED: f64 = 10.0 * SLACK;

/// Poses nearer to each other than this are one, rad: where two meet at a fold, rounding tells them apart by its root.
const SAME: f64 = 1e-7;

/// All poses of a point on a plane, in order of a_1. Reads as a slice.
#[derive(Clone)]
pub struct Poses {
    len: usize,
    few: [PlanePoint; INLINE],
    /// All of them, once they are more than fit; only limits of many turns have so many.
    many: Vec<PlanePoint>,
}

impl Deref for Poses {
    type Target = [PlanePoint];
    fn deref(&self) -> &[PlanePoint] {
        if self.many.is_empty() { &self.few[..self.len] } else { &self.many }
    }
}

impl fmt::Debug for Poses {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

impl<'a> IntoIterator for &'a Poses {
    type Item = &'a PlanePoint;
    type IntoIter = std::slice::Iter<'a, PlanePoint>;
    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl Poses {
    fn new(b: f64) -> Self {
        Self { len: 0, few: [PlanePoint { a: [0.0; 2], b }; INLINE], many: Vec::new() }
    }

    fn all(&mut self) -> &mut [PlanePoint] {
        if self.many.is_empty() { &mut self.few[..self.len] } else { &mut self.many }
    }

    /// Takes in a pose; of two that are the same, the one with the smaller miss.
    fn push(&mut self, a: [f64; 2], miss: impl Fn([f64; 2]) -> f64) {
        let same = |pose: &&mut PlanePoint| (pose.a[0] - a[0]).abs() < SAME && (pose.a[1] - a[1]).abs() < SAME;
        if let Some(pose) = self.all().iter_mut().find(same) {
            if miss(a) < miss(pose.a) {
                pose.a = a;
            }
            return;
        }
        if let Some(free) = self.few.get_mut(self.len) {
            free.a = a;
            self.len += 1;
            return;
        }
        if self.many.is_empty() {
            self.many.extend(self.few);
        }
        self.many.push(PlanePoint { a, ..self.few[0] });
    }

    fn sort(&mut self) {
        let key = |pose: &PlanePoint| pose.a;
        self.all().sort_unstable_by(|s, t| {
            let [s, t] = [key(s), key(t)];
            s[0].total_cmp(&t[0]).then(s[1].total_cmp(&t[1]))
        });
    }
}

impl PlaneMap {
    /// All poses within the limits that put the end effector on `p`, m, on the plane `b`, rad: every elbow, every
    /// sheet.
    ///
    /// b is not wrapped: Σ λ_k q_k of the lifted pose is `b`. Limits count as kept when passed by [`SLACK`]; the poses
    /// returned keep them. Empty where there is none: [`reach`](Self::reach) says why. Poses that form a continuum (an
    /// end effector that two of the arms do not move) are not listed.
    pub fn poses(&self, p: Vector, b: f64) -> Poses {
        let mut poses = Poses::new(b);
        if !(p.re.is_finite() && p.im.is_finite() && b.is_finite()) {
            return poses;
        }
        let curve = Quadrilateral::new(self, p, SLACK);
        let farthest: f64 = self.c().iter().map(|c| c.abs()).sum();
        let mut push = |a: [f64; 2], tolerance: f64| {
            let a = self.clamp(a);
            let miss = |a: [f64; 2]| (self.forward(a, b) - p).norm();
            if miss(a) <= tolerance * farthest {
                poses.push(a, miss);
            }
        };
        if curve.is_at_base() {
            curve.triangles(|a| push(self.polished(p, b, a), CLAMPED));
        } else {
            let period = self.period();
            curve.arcs(|arc| {
                let [low, high] = if arc.from.b < arc.to.b { [arc.from.b, arc.to.b] } else { [arc.to.b, arc.from.b] };
                let first = ((low - AT_FOLD - b) / period).ceil();
                // Counted, for a sum of turns stands still where b is huge.
                let turns = ((high - low + 2.0 * AT_FOLD) / period) as usize + 1;
                let lifted = (0..=turns).map(|i| b + (first + i as f64) * period);
                for b_there in lifted.take_while(|b| *b <= high + AT_FOLD) {
                    let Site { alpha, beta, .. } = curve.solve(arc, b_there);
                    push(self.polished(p, b, curve.relative_angles(alpha, beta)), CLAMPED);
                }
            });
            // The curve is singular where the arms are flat, and rounding may keep it off such a pose.
            curve.flat(|a| push(a, AT_FOLD));
        }
        poses.sort();
        poses
    }

    /// Newton's iteration for the last digits; the start where it leads away, at a fold.
    fn polished(&self, p: Vector, b: f64, start: [f64; 2]) -> [f64; 2] {
        let goal = p * unit(-self.turn(b));
        let mut a = start;
        for _ in 0..4 {
            let arms = self.arms(a);
            let gap = goal - arms.iter().sum::<Vector>();
            let [first, second] = self.columns(&arms);
            let det = cross(first, second);
            let step = [cross(gap, second) / det, cross(first, gap) / det];
            let length = step[0].hypot(step[1]);
            let leads_away = (a[0] + step[0] - start[0]).abs().max((a[1] + step[1] - start[1]).abs()) > 1e-6;
            if !length.is_finite() || leads_away {
                break;
            }
            a = [a[0] + step[0], a[1] + step[1]];
            if length < 1e-14 {
                break;
            }
        }
        a
    }
}
