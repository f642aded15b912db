//! The quadrilateral of the three arms and the vector from B to a point. Its configurations form the curve of poses
//! that keep the end effector on the point (the self-motion). The curve is split into arcs along which b is monotone.
//!
//! In a frame whose real axis is along the arm that both relative angles share, the curve is the level set
//! |m + x e^{iα} + y e^{iβ}| = |p|. For each α the law of cosines gives two β, so the curve consists of two graphs,
//! along which b has a closed form without jumps. The split points have closed forms too. They are the turning points
//! of α, the intersections with the joint limits, and the folds det = 0. The values of cos α at the folds are roots of
//! a cubic.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | m, x, y | lengths of the shared arm and of the other two; |c_k| | m |
//! | α, β | angles of arms x and y from arm m: ±a_i and a constant | rad |
//! | z, ρ | m + x e^{iα} and its length | m |
//! | w, r | z + y e^{iβ} and its length, the distance of the point from B | m |
//! | σ, γ | β = arg z + σγ, γ in [0, π], σ = ±1: the elbow | 1, rad |
//! | η | arg w = arg z + ση | rad |

mod arc;
mod cuts;
mod few;
mod folds;
mod lifts;
mod singular;
mod walk;

pub(super) use arc::{MonotoneArc, Site};

use std::f64::consts::{PI, TAU};

use lifts::lifts;

use super::plane::{AngleLimit, PlaneMap};
use stillbase_mechanics::planar::{Vector, unit};

/// Tolerance of the distance of a point at the limits of the reach, as a fraction of the reach.
pub(super) const REACH_ROUNDING: f64 = 1e-12;

/// The arms of a [`PlaneMap`], and a point.
#[derive(Clone, Debug)]
pub(super) struct Quadrilateral {
    m: f64,
    x: f64,
    y: f64,
    r: f64,
    /// λ of the arms m, x and y.
    lambda: [f64; 3],
    lambda_sum: f64,
    /// b = b_0 − Σλ arg w + λ_x α + λ_y β.
    b_0: f64,
    /// Bounds of α and β.
    limits: [AngleLimit; 2],
    /// Index of the relative angle that corresponds to α, and of the one that corresponds to β.
    index: [usize; 2],
    /// α = sign a + shift, and the same for β.
    sign: [f64; 2],
    shift: [f64; 2],
}

/// Returns the angle between sides u and v whose vector sum has length t, in [0, π].
fn bend(u: f64, v: f64, t: f64) -> f64 {
    let [open, closed] = [(u + v - t) * (u + v + t), (t - u + v) * (t + u - v)].map(|n| n.max(0.0).sqrt());
    2.0 * open.atan2(closed)
}

impl Quadrilateral {
    /// Returns the quadrilateral of a point, m, with limits widened by `slack`, rad.
    pub fn new(map: &PlaneMap, p: Vector, slack: f64) -> Self {
        let (c, lambda, angles) = (map.c(), map.lambda(), map.angles());
        let shared =
            if angles[1].to == angles[0].to || angles[1].from == angles[0].to { angles[0].to } else { angles[0].from };
        let half_turn = c.map(|c| if c < 0.0 { PI } else { 0.0 });
        let other = angles.map(|a| if a.to == shared { a.from } else { a.to });
        let sign = angles.map(|a| if a.to == shared { -1.0 } else { 1.0 });
        let shift = [0, 1].map(|i| half_turn[other[i]] - half_turn[shared] - sign[i] * angles[i].offset);
        let limits = [0, 1].map(|i| {
            let AngleLimit { min, max } = map.limits()[i];
            let ends = [min, max].map(|a| sign[i] * a + shift[i]);
            AngleLimit { min: ends[0].min(ends[1]) - slack, max: ends[0].max(ends[1]) + slack }
        });

        let length = c.map(f64::abs);
        let (m, l) = (length[shared], other.map(|k| length[k]));
        let far = length.iter().sum::<f64>();
        let near = (2.0 * length.into_iter().fold(0.0, f64::max) - far).max(0.0);
        let rounding = REACH_ROUNDING * far;
        let r = match p.norm() {
            r if r > far && r <= far + rounding => far,
            r if r < near && r >= near - rounding => near,
            r => r,
        };
        // For the closed form, arm y should be the longer one, and z should not vanish.
        let clearance = |x: usize| (m - l[x]).abs().max((r - l[1 - x]).abs());
        let x = usize::from(l[0] > l[1]);
        let flipped = clearance(x) < 1e-6 * far && clearance(1 - x) > clearance(x) && l[x] > 1e-3 * far;
        let x = if flipped { 1 - x } else { x };
        let index = [x, 1 - x];

        let lambda_sum = map.lambda_sum();
        Self {
            m,
            x: l[index[0]],
            y: l[index[1]],
            r,
            lambda: [lambda[shared], lambda[other[index[0]]], lambda[other[index[1]]]],
            lambda_sum,
            b_0: lambda_sum * p.im.atan2(p.re) - (0..3).map(|k| lambda[k] * half_turn[k]).sum::<f64>(),
            limits: index.map(|i| limits[i]),
            index,
            sign: index.map(|i| sign[i]),
            shift: index.map(|i| shift[i]),
        }
    }

    /// Returns (a_1, a_2) of (α, β).
    pub fn relative_angles(&self, alpha: f64, beta: f64) -> [f64; 2] {
        let mut a = [0.0; 2];
        for (i, angle) in [alpha, beta].into_iter().enumerate() {
            a[self.index[i]] = self.sign[i] * (angle - self.shift[i]);
        }
        a
    }

    fn period(&self) -> f64 {
        TAU * self.lambda_sum
    }

    fn size(&self) -> f64 {
        self.m + self.x + self.y
    }

    /// Whether the point is B itself, whose poses exist at every b.
    pub fn is_at_base(&self) -> bool {
        self.r <= REACH_ROUNDING * self.size()
    }

    /// Whether arms whose vector sum has this length reach the point.
    fn is_level(&self, length: f64) -> bool {
        (length.abs() - self.r).abs() <= 10.0 * REACH_ROUNDING * self.size()
    }

    /// Visits all (a_1, a_2) within the limits that equal (α, β) modulo whole turns.
    fn within_limits(&self, alpha: f64, beta: f64, mut visit: impl FnMut([f64; 2])) {
        for alpha in lifts(alpha, self.limits[0]) {
            for beta in lifts(beta, self.limits[1]) {
                visit(self.relative_angles(alpha, beta));
            }
        }
    }

    /// Returns z with arm x along the unit vector e.
    #[inline]
    fn side(&self, e: Vector) -> Vector {
        Vector::new(self.m + self.x * e.re, self.x * e.im)
    }

    /// Returns z and its argument, continuous in α unless z passes through 0.
    #[inline]
    fn z(&self, alpha: f64) -> (Vector, f64) {
        let e = unit(alpha);
        let z = self.side(e);
        let arg =
            if self.x > self.m { alpha + f64::atan2(-self.m * e.im, self.x + self.m * e.re) } else { z.im.atan2(z.re) };
        (z, arg)
    }

    /// Returns the point of a graph at α; `cos_gamma` is given where it is known to be ±1.
    #[inline]
    fn at(&self, alpha: f64, sigma: f64, cos_gamma: Option<f64>) -> Site {
        let (z, arg_z) = self.z(alpha);
        let rho = z.norm_sqr().sqrt();
        let (gamma, sin, cos) = match cos_gamma {
            Some(cos) => (if cos > 0.0 { 0.0 } else { PI }, 0.0, cos),
            None => self.gamma(rho),
        };
        let eta = (self.y * sin).atan2(rho + self.y * cos);
        let beta = arg_z + sigma * gamma;
        let b = self.b_0 - self.lambda_sum * (arg_z + sigma * eta) + self.lambda[1] * alpha + self.lambda[2] * beta;
        Site { alpha, beta, b }
    }

    /// Returns γ for a length ρ of z, and its sine and cosine.
    #[inline]
    fn gamma(&self, rho: f64) -> (f64, f64, f64) {
        let (y, r) = (self.y, self.r);
        // Half-angle form of the law of cosines: accurate where the quadrilateral is nearly flat.
        let open = ((rho + y - r) * (rho + y + r)).max(0.0);
        let closed = ((r - rho + y) * (r + rho - y)).max(0.0);
        let sum = open + closed;
        if sum > 0.0 {
            let gamma = 2.0 * open.sqrt().atan2(closed.sqrt());
            (gamma, 2.0 * (open * closed).sqrt() / sum, (closed - open) / sum)
        } else {
            (0.5 * PI, 1.0, 0.0)
        }
    }

    /// Returns β of the point of a graph at α, without its b.
    #[inline]
    fn beta(&self, alpha: f64, sigma: f64) -> f64 {
        let (z, arg_z) = self.z(alpha);
        arg_z + sigma * self.gamma(z.norm_sqr().sqrt()).0
    }

    /// Returns the point of a graph at a known (α, β), so that b has full precision.
    fn through(&self, alpha: f64, beta: f64, sigma: f64) -> Site {
        let near = self.at(alpha, sigma, None);
        let beta = beta + TAU * ((near.beta - beta) / TAU).round();
        let w = self.z(alpha).0 + self.y * unit(beta);
        let b = self.b_0 - self.lambda_sum * w.im.atan2(w.re) + self.lambda[1] * alpha + self.lambda[2] * beta;
        Site { alpha, beta, b: b + self.period() * ((near.b - b) / self.period()).round() }
    }
}
