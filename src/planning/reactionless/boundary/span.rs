//! Spans: short pieces of the curves whose images can bound a workspace: limits, change points, folds with det = 0.
//!
//! A span is a graph in (a_1, a_2): one coordinate varies linearly between the ends, the other follows the curve. It is
//! oriented with more poses on its left: two more for a fold, one more for any other curve. So all spans together
//! are a weighted cycle whose winding number about p is the number of poses of p.

use super::determinant::{Determinant, FOLD_INSET, upright};
use crate::golden::golden;
use crate::reactionless::{AngleLimit, PlaneMap};
use stillbase_mechanics::planar::{Vector, cross, dot};

/// A curve in (a_1, a_2) whose image can bound the workspace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoundaryCurve {
    /// A relative angle is at its limit.
    Limit {
        /// Index of the angle: 0 for a_1, 1 for a_2.
        angle: usize,
        /// Whether it is at its greatest value, else at its least.
        upper: bool,
    },
    /// A fold, det = 0.
    Fold,
    /// A change point of a pair of drives: the boundary of the part of the workspace on one side of it.
    Change {
        /// Index of the pair in [`DRIVE_PAIRS`](super::super::DRIVE_PAIRS).
        pair: usize,
    },
}

#[derive(Clone, Copy, Debug)]
pub(super) struct BoundarySpan {
    pub curve: BoundaryCurve,
    /// Index of the coordinate that varies linearly.
    chart: usize,
    pub ends: [[f64; 2]; 2],
    pub at: [Vector; 2],
    /// Derivative of the other coordinate with respect to the chart coordinate, at the ends.
    slopes: [f64; 2],
    /// Whether the other coordinate solves det = 0; else it varies linearly too.
    solved: bool,
    /// Bound on the distance between chord and curve, m; τ² times this for a part of parameter length τ.
    pub deviation: f64,
}

/// A point of a span: plane coordinates, position, and derivative of the position with respect to the parameter.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpanPoint {
    pub a: [f64; 2],
    pub at: Vector,
    pub rate: Vector,
}

/// The map from (a_1, a_2) to positions at b = 0, with its determinant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface {
    pub map: PlaneMap,
    pub det: Determinant,
}

impl Surface {
    pub fn of(map: &PlaneMap) -> Self {
        let det = Determinant::of(map);
        let mut limits = map.limits();
        for (i, limit) in limits.iter_mut().enumerate() {
            let [low, high] = [limit.min, limit.max].map(|x| {
                let [from, way] = upright(i, x);
                if det.vanishes(from, way) { FOLD_INSET } else { 0.0 }
            });
            if limit.max - limit.min > 4.0 * FOLD_INSET {
                *limit = AngleLimit { min: limit.min + low, max: limit.max - high };
            }
        }
        // The narrowed limits are still valid.
        Self { map: map.with_limits(limits).unwrap_or(*map), det }
    }

    /// Returns a straight span between two points.
    pub fn straight(&self, curve: BoundaryCurve, ends: [[f64; 2]; 2]) -> BoundarySpan {
        let [from, to] = ends;
        let chart = usize::from((to[1] - from[1]).abs() > (to[0] - from[0]).abs());
        let run = to[chart] - from[chart];
        let slope = if run == 0.0 { 0.0 } else { (to[1 - chart] - from[1 - chart]) / run };
        let step = [to[0] - from[0], to[1] - from[1]];
        // sup |P''| from its value at the midpoint and a bound on P'''.
        let arms = self.map.arms([0, 1].map(|j| 0.5 * (from[j] + to[j])));
        let rates = self.map.u().map(|u| u[0] * step[0] + u[1] * step[1]);
        let bend: Vector = (0..3).map(|k| arms[k] * rates[k] * rates[k]).sum();
        // Arms with equal rates move as one.
        let (mut jerk, mut seen) = (0.0, [false; 3]);
        for k in 0..3 {
            let together = |l: &usize| (rates[*l] - rates[k]).abs() < 1e-9;
            let arm: Vector = (k..3).filter(|l| !seen[*l] && together(l)).map(|l| arms[l]).sum();
            (k..3).filter(together).for_each(|l| seen[l] = true);
            jerk += arm.norm() * rates[k].abs().powi(3);
        }
        BoundarySpan {
            curve,
            chart,
            ends,
            at: ends.map(|a| self.map.forward_unturned(a)),
            slopes: [slope; 2],
            solved: false,
            deviation: (bend.norm() + 0.5 * jerk) / 8.0,
        }
    }

    /// Returns the span of det = 0 between two of its points, det > 0 on its left; `None` if it is not clearly a graph.
    pub fn fold(&self, ends: [[f64; 2]; 2]) -> Option<BoundarySpan> {
        let [from, to] = ends;
        let chart = usize::from((to[1] - from[1]).abs() > (to[0] - from[0]).abs());
        let run = (to[chart] - from[chart]).abs();
        let gradients = ends.map(|a| self.det.gradient(a));
        let steep = |g: [f64; 2]| g[1 - chart].abs() > 0.3 * g[chart].abs();
        if !(gradients.iter().all(|&g| steep(g)) && gradients[0][1 - chart] * gradients[1][1 - chart] > 0.0) {
            return None;
        }
        let slopes = gradients.map(|g| -g[chart] / g[1 - chart]);
        let at = ends.map(|a| self.map.forward_unturned(a));
        let mut span =
            BoundarySpan { curve: BoundaryCurve::Fold, chart, ends, at, slopes, solved: true, deviation: 0.0 };
        let middle = self.jet(&span, 0.5).a;
        let gradient = self.det.gradient(middle);
        let smooth = (slopes[1] - slopes[0]).abs() < 0.5
            && steep(gradient)
            && gradient[1 - chart] * gradients[0][1 - chart] > 0.0
            && (middle[1 - chart] - span.guess(0.5)).abs() < 2e-3 * run;
        if !smooth {
            return None;
        }
        let along = [to[0] - from[0], to[1] - from[1]];
        if along[0] * gradient[1] - along[1] * gradient[0] < 0.0 {
            span.ends.reverse();
            span.at.reverse();
            span.slopes.reverse();
        }
        // sup |P''| from second differences, extrapolated to the ends, with a margin.
        let p: [Vector; 9] = std::array::from_fn(|i| self.at(&span, i as f64 / 8.0));
        let bend: [Vector; 7] = std::array::from_fn(|i| 64.0 * (p[i] - 2.0 * p[i + 1] + p[i + 2]));
        let ends = [2.0 * bend[0] - bend[1], 2.0 * bend[6] - bend[5]];
        span.deviation = 1.3 / 8.0 * bend.iter().chain(&ends).map(|b| b.norm()).fold(0.0, f64::max);
        Some(span)
    }

    /// Returns the part of a span over a parameter range, whose ends have the given plane coordinates.
    pub fn part(&self, span: &BoundarySpan, range: [f64; 2], ends: [[f64; 2]; 2]) -> BoundarySpan {
        let slope = |a: [f64; 2]| {
            let g = self.det.gradient(a);
            -g[span.chart] / g[1 - span.chart]
        };
        BoundarySpan {
            ends,
            at: ends.map(|a| self.map.forward_unturned(a)),
            slopes: if span.solved { ends.map(slope) } else { span.slopes },
            deviation: span.deviation * (range[1] - range[0]).powi(2),
            ..*span
        }
    }

    /// Returns the parameter of a point on a span; `None` if the point is not on it.
    pub fn locate(&self, span: &BoundarySpan, a: [f64; 2]) -> Option<f64> {
        let [from, to] = span.ends.map(|e| e[span.chart]);
        let t = (a[span.chart] - from) / (to - from);
        let there = (0.0..=1.0).contains(&t) && (self.point(span, t)[1 - span.chart] - a[1 - span.chart]).abs() < 1e-8;
        there.then_some(t)
    }

    /// Returns the parameters of the cusps of a fold's image, where the null vector of the Jacobian is tangent to the
    /// fold.
    pub fn cusps(&self, span: &BoundarySpan) -> Vec<f64> {
        // On the fold both columns are parallel, so that the component along one of them gives the sense of motion.
        let columns = |t: f64| self.map.columns(&self.map.arms(self.point(span, t)));
        let [start, end] = [columns(0.0), columns(1.0)];
        let least = |j: usize| start[j].norm().min(end[j].norm());
        let j = usize::from(least(1) > least(0));
        let speed = |t: f64| dot(self.jet(span, t).rate, columns(t)[j]);
        const N: usize = 8;
        let t = |i: usize| i as f64 / N as f64;
        let mut stops: Vec<(f64, f64)> = (0..=N).map(|i| (t(i), speed(t(i)))).collect();
        // Two cusps close to each other appear as a local minimum of |speed|.
        for i in (1..N).rev() {
            let [before, here, after] = [stops[i - 1].1, stops[i].1, stops[i + 1].1];
            let dip =
                here.abs() < before.abs() && here.abs() <= after.abs() && here * before > 0.0 && here * after > 0.0;
            if dip {
                let sign = here.signum();
                let (bottom, least) = golden([stops[i - 1].0, stops[i + 1].0], 40, |t| sign * speed(t));
                let value = sign * least;
                if value * here < 0.0 {
                    stops.push((bottom, value));
                }
            }
        }
        stops.sort_by(|a, b| a.0.total_cmp(&b.0));
        let crossing = |w: &[(f64, f64)]| {
            let (mut low, mut high) = (w[0], w[1].0);
            if low.1 * w[1].1 >= 0.0 {
                return None;
            }
            for _ in 0..50 {
                let middle = 0.5 * (low.0 + high);
                let value = speed(middle);
                if value * low.1 > 0.0 { low = (middle, value) } else { high = middle }
            }
            Some(0.5 * (low.0 + high))
        };
        stops.windows(2).filter_map(crossing).filter(|t| (1e-9..1.0 - 1e-9).contains(t)).collect()
    }

    /// Returns the plane coordinates at t from 0 to 1.
    pub fn point(&self, span: &BoundarySpan, t: f64) -> [f64; 2] {
        if t <= 0.0 {
            return span.ends[0];
        }
        if t >= 1.0 {
            return span.ends[1];
        }
        let (chart, other) = (span.chart, 1 - span.chart);
        let mut a = [0.0; 2];
        a[chart] = span.ends[0][chart] + t * (span.ends[1][chart] - span.ends[0][chart]);
        a[other] = span.guess(t);
        if span.solved {
            for _ in 0..4 {
                let step = self.det.value(a) / self.det.gradient(a)[other];
                if !step.is_finite() {
                    break;
                }
                a[other] -= step;
                if step.abs() < 1e-9 {
                    break;
                }
            }
        }
        a
    }

    /// Returns the position at t, m.
    pub fn at(&self, span: &BoundarySpan, t: f64) -> Vector {
        if t <= 0.0 {
            span.at[0]
        } else if t >= 1.0 {
            span.at[1]
        } else {
            self.map.forward_unturned(self.point(span, t))
        }
    }

    /// Returns the position and its derivative at t.
    pub fn jet(&self, span: &BoundarySpan, t: f64) -> SpanPoint {
        let a = self.point(span, t);
        let (chart, other) = (span.chart, 1 - span.chart);
        let arms = self.map.arms(a);
        let columns = self.map.columns(&arms);
        let run = span.ends[1][chart] - span.ends[0][chart];
        let slope = if span.solved {
            let g = self.det.gradient(a);
            -g[chart] / g[other]
        } else {
            span.slopes[0]
        };
        SpanPoint { a, at: arms.iter().sum(), rate: run * (columns[chart] + slope * columns[other]) }
    }

    /// Returns ½ ∫ p × dp over a part of a span, m².
    pub fn swept(&self, span: &BoundarySpan, from: f64, to: f64) -> f64 {
        let whole = self.gauss(span, from, to);
        match span.curve {
            BoundaryCurve::Limit { .. } | BoundaryCurve::Change { .. } => whole,
            BoundaryCurve::Fold => self.refined(span, from, to, whole, 8),
        }
    }

    fn refined(&self, span: &BoundarySpan, from: f64, to: f64, whole: f64, depth: usize) -> f64 {
        let middle = 0.5 * (from + to);
        let (first, second) = (self.gauss(span, from, middle), self.gauss(span, middle, to));
        if depth == 0 || (first + second - whole).abs() < 1e-16 * self.map.unit().powi(2) {
            return first + second;
        }
        self.refined(span, from, middle, first, depth - 1) + self.refined(span, middle, to, second, depth - 1)
    }

    fn gauss(&self, span: &BoundarySpan, from: f64, to: f64) -> f64 {
        const NODES: [(f64, f64); 4] = [
            (0.183_434_642_495_649_8, 0.362_683_783_378_362),
            (0.525_532_409_916_329, 0.313_706_645_877_887_3),
            (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
            (0.960_289_856_497_536_3, 0.101_228_536_290_376_3),
        ];
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let value = |t: f64| {
            let jet = self.jet(span, t);
            0.5 * cross(jet.at, jet.rate)
        };
        half * NODES.iter().map(|&(x, w)| w * (value(middle - half * x) + value(middle + half * x))).sum::<f64>()
    }
}

impl BoundarySpan {
    /// Returns the number of poses on the left minus that on the right.
    pub fn weight(&self) -> i32 {
        match self.curve {
            BoundaryCurve::Limit { .. } | BoundaryCurve::Change { .. } => 1,
            BoundaryCurve::Fold => 2,
        }
    }

    /// Returns the other coordinate by the cubic Hermite interpolant of the ends and slopes.
    fn guess(&self, t: f64) -> f64 {
        let other = 1 - self.chart;
        let run = self.ends[1][self.chart] - self.ends[0][self.chart];
        // In this form, a coordinate that is constant along the span stays exact.
        let (rise, s) = (self.ends[1][other] - self.ends[0][other], 1.0 - t);
        let bulge = (self.slopes[0] * run - rise) * s - (self.slopes[1] * run - rise) * t;
        self.ends[0][other] + rise * t + t * s * bulge
    }

    /// Returns the contribution of the part from `from` to `to` to the winding number about p, as signed crossings of
    /// the ray from p towards +x. Returns `None` if p lies on the part.
    pub fn crossings(&self, on: &Surface, from: (f64, Vector), to: (f64, Vector), p: Vector) -> Option<i32> {
        let (a, b) = (from.1, to.1);
        let unit = on.map.unit();
        let slack = self.deviation * (to.0 - from.0).powi(2) + 1e-15 * unit;
        let (low, high) = (a.im.min(b.im) - slack, a.im.max(b.im) + slack);
        let (left, right) = (a.re.min(b.re) - slack, a.re.max(b.re) + slack);
        if p.im < low || p.im > high || p.re > right {
            return Some(0);
        }
        if p.re < left {
            return Some(i32::from(a.im <= p.im && p.im < b.im) - i32::from(b.im <= p.im && p.im < a.im));
        }
        if (high - low).max(right - left) < 1e-13 * unit || to.0 - from.0 < 1e-12 {
            return None;
        }
        let middle = 0.5 * (from.0 + to.0);
        let middle = (middle, on.at(self, middle));
        Some(self.crossings(on, from, middle, p)? + self.crossings(on, middle, to, p)?)
    }
}
