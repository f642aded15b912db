//! Poses at which the curve is singular or ends: with the point at B, flat poses, and corners of the limits.

use std::f64::consts::PI;

use super::{Quadrilateral, bend};
use stillbase_mechanics::planar::unit;

impl Quadrilateral {
    /// Visits the poses of a point at B within the limits: the triangle of the arms and its mirror image.
    pub fn triangles(&self, mut visit: impl FnMut([f64; 2])) {
        if self.y == 0.0 || self.y > self.m + self.x || self.y < (self.m - self.x).abs() {
            return;
        }
        let alpha = bend(self.m, self.x, self.y);
        let beta = (-self.z(alpha).0).arg();
        let mirrored = alpha.sin().abs() > 1e-9 || beta.sin().abs() > 1e-9;
        for sign in [1.0, -1.0].into_iter().take(1 + usize::from(mirrored)) {
            self.within_limits(sign * alpha, sign * beta, &mut visit);
        }
    }

    /// Visits the flat poses of the point: all arms in one line. The curve is singular there.
    pub fn flat(&self, mut visit: impl FnMut([f64; 2])) {
        for [first, second] in [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]] {
            if self.is_level(self.m + first * self.x + second * self.y) {
                let angle = |sign: f64| if sign > 0.0 { 0.0 } else { PI };
                self.within_limits(angle(first), angle(second), &mut visit);
            }
        }
    }

    /// Visits the corners of the limits that are poses of the point. The curve may have no other pose within the
    /// limits.
    pub fn corners(&self, mut visit: impl FnMut([f64; 2])) {
        let [first, second] = self.limits.map(|l| [l.min, l.max]);
        let units = second.map(unit);
        for alpha in first {
            let z = self.z(alpha).0;
            for (beta, unit) in second.into_iter().zip(units) {
                if self.is_level((z + self.y * unit).norm()) {
                    visit(self.relative_angles(alpha, beta));
                }
            }
        }
    }
}
