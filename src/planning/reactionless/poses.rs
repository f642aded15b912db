//! The inverse of (16): all poses that put the end effector on a point of a plane b = const.
//!
//! Source: (13)–(16). The curve of poses that keep the end effector on the point is split into arcs along which b is
//! monotone. So each pose is bracketed before Newton's iteration refines it, and none is missed.

use std::fmt;
use std::ops::Deref;

use super::plane::{LIMIT_SLACK, PlaneMap, PlanePoint};
use super::quadrilateral::{Quadrilateral, Site};
use stillbase_mechanics::planar::{Vector, cross, unit};

/// Number of poses stored without heap memory: many more than exist within one turn of each angle.
const INLINE: usize = 64;

/// Tolerance of b at a fold, rad. Also, as a fraction of the reach, of the position of a pose with all arms in line.
const FOLD_TOLERANCE: f64 = 1e-12;

/// Tolerance of the position of poses clamped to the limits, as a fraction of the reach.
const CLAMPED_TOLERANCE: f64 = 10.0 * LIMIT_SLACK;

/// Poses nearer to each other than this are equal, rad. Where two poses merge at a fold, they differ by about the
/// square root of the rounding error.
const SAME_POSE_RAD: f64 = 1e-7;

/// All poses of a point on a plane, sorted by a_1; dereferences to a slice.
#[derive(Clone)]
pub struct Poses {
    len: usize,
    few: [PlanePoint; INLINE],
    /// All poses, if there are more than fit inline; this only occurs for limits many turns apart.
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

    /// Adds a pose; of two equal ones it keeps the one with the smaller residual.
    fn push(&mut self, a: [f64; 2], miss: impl Fn([f64; 2]) -> f64) {
        let same = |pose: &&mut PlanePoint| {
            (pose.a[0] - a[0]).abs() < SAME_POSE_RAD && (pose.a[1] - a[1]).abs() < SAME_POSE_RAD
        };
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
    /// Returns all poses within the limits that put the end effector on `p`, m, on the plane `b`, rad, over all elbow
    /// configurations and sheets.
    ///
    /// b is not wrapped: Σ λ_k q_k of the lifted pose is `b`. Poses that exceed limits by up to [`LIMIT_SLACK`] are
    /// included, moved onto the limits. The result is empty if there is no pose; [`reach`](Self::reach) gives the
    /// reason. Poses that form a continuum (the end effector is moved by one arm only) are not listed.
    pub fn poses(&self, p: Vector, b: f64) -> Poses {
        let mut poses = Poses::new(b);
        if !(p.re.is_finite() && p.im.is_finite() && b.is_finite()) {
            return poses;
        }
        let curve = Quadrilateral::new(self, p, LIMIT_SLACK);
        let farthest: f64 = self.c().iter().map(|c| c.abs()).sum();
        let mut push = |a: [f64; 2], tolerance: f64| {
            let a = self.clamp(a);
            let miss = |a: [f64; 2]| (self.forward(a, b) - p).norm();
            if miss(a) <= tolerance * farthest {
                poses.push(a, miss);
            }
        };
        if curve.is_at_base() {
            curve.triangles(|a| push(self.polished(p, b, a), CLAMPED_TOLERANCE));
        } else {
            let period = self.period();
            curve.arcs(|arc| {
                let [low, high] = if arc.from.b < arc.to.b { [arc.from.b, arc.to.b] } else { [arc.to.b, arc.from.b] };
                let first = ((low - FOLD_TOLERANCE - b) / period).ceil();
                // By index, since adding periods one by one has no effect if b is huge.
                let turns = ((high - low + 2.0 * FOLD_TOLERANCE) / period) as usize + 1;
                let lifted = (0..=turns).map(|i| b + (first + i as f64) * period);
                for b_there in lifted.take_while(|b| *b <= high + FOLD_TOLERANCE) {
                    let Site { alpha, beta, .. } = curve.solve(arc, b_there);
                    push(self.polished(p, b, curve.relative_angles(alpha, beta)), CLAMPED_TOLERANCE);
                }
            });
            // The curve is singular at flat poses, and rounding may make it miss such a pose.
            curve.flat(|a| push(a, FOLD_TOLERANCE));
        }
        poses.sort();
        poses
    }

    /// Refines a pose by Newton's iteration. If a step would lead far from the start, as may happen near a fold,
    /// returns the pose before that step.
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
