//! det ∂(x, y)/∂(a_1, a_2) as a sum of three sines, its gradient, and its zeros in closed form.
//!
//! With K_kl = (u_k × u_l) c_k c_l, det = Σ_{k<l} K_kl sin((u_l − u_k) · a + v_l − v_k). As two relative angles connect
//! three drives, each u_l − u_k has integer components. So every term is a sine of a_1, of a_2, or of their sum or
//! difference.

use std::f64::consts::TAU;

use crate::reactionless::PlaneMap;
use stillbase_mechanics::planar::{Vector, cross};

/// Limits that coincide with a straight fold are moved inwards by this, rad, so that det has a sign on them.
pub(super) const FOLD_INSET: f64 = 4e-10;

#[derive(Clone, Copy, Debug)]
struct Sine {
    k: f64,
    n: [f64; 2],
    offset: f64,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Determinant {
    terms: [Sine; 3],
}

impl Determinant {
    pub fn of(map: &PlaneMap) -> Self {
        let (c, u, v) = (map.c(), map.u(), map.v());
        let term = |k: usize, l: usize| Sine {
            k: cross(Vector::new(u[k][0], u[k][1]), Vector::new(u[l][0], u[l][1])) * c[k] * c[l],
            n: [0, 1].map(|j| (u[l][j] - u[k][j]).round()),
            offset: v[l] - v[k],
        };
        Self { terms: [term(0, 1), term(1, 2), term(0, 2)] }
    }

    /// Returns the largest |K_kl|, m²: the scale of the determinant.
    pub fn scale(&self) -> f64 {
        self.terms.iter().fold(0.0, |m, t| m.max(t.k.abs()))
    }

    pub fn value(&self, a: [f64; 2]) -> f64 {
        self.terms.iter().map(|t| t.k * (t.n[0] * a[0] + t.n[1] * a[1] + t.offset).sin()).sum()
    }

    pub fn gradient(&self, a: [f64; 2]) -> [f64; 2] {
        let mut g = [0.0; 2];
        for t in &self.terms {
            let slope = t.k * (t.n[0] * a[0] + t.n[1] * a[1] + t.offset).cos();
            g[0] += slope * t.n[0];
            g[1] += slope * t.n[1];
        }
        g
    }

    /// Returns (C, S, Q) with det = C + S sin y + Q cos y along the line `from` + y `way`. The line must keep one
    /// coordinate, or the sum or difference in one of the terms, constant.
    fn along(&self, from: [f64; 2], way: [f64; 2]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for t in &self.terms {
            let (sin, cos) = (t.n[0] * from[0] + t.n[1] * from[1] + t.offset).sin_cos();
            let n = t.n[0] * way[0] + t.n[1] * way[1];
            if n == 0.0 {
                sum[0] += t.k * sin;
            } else {
                sum[1] += t.k * n * cos;
                sum[2] += t.k * sin;
            }
        }
        sum
    }

    /// Returns the two y in [0, 2π) at which the determinant is 0 on the line `from` + y `way`. Returns `None` if there
    /// are none, or if the determinant is constant on the line.
    pub fn zeros(&self, from: [f64; 2], way: [f64; 2]) -> Option<[f64; 2]> {
        let [c, s, q] = self.along(from, way);
        let radius = s.hypot(q);
        if c.abs() > radius || radius <= 1e-14 * self.scale() {
            return None;
        }
        let (middle, half) = (s.atan2(q), (-c / radius).acos());
        Some([(middle - half).rem_euclid(TAU), (middle + half).rem_euclid(TAU)])
    }

    /// Whether the determinant is 0 all along a line.
    pub fn vanishes(&self, from: [f64; 2], way: [f64; 2]) -> bool {
        self.along(from, way).iter().all(|x| x.abs() < FOLD_INSET * self.scale())
    }
}

/// Returns the line on which angle `fixed` is `x`, as a point `from` and a direction `way`.
pub(super) fn upright(fixed: usize, x: f64) -> [[f64; 2]; 2] {
    let (mut from, mut way) = ([0.0; 2], [0.0; 2]);
    from[fixed] = x;
    way[1 - fixed] = 1.0;
    [from, way]
}
