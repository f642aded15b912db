//! Dragging one drive on a plane b = const: the other drives turn as little as possible.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | q_k = b* + u_k · a + v_k | angle of drive k on the plane, (15) | rad |
//! | M = Σ λ_l u_l u_lᵀ | metric of kinetic energy on the plane, as D_l = D_1 λ_l | |
//!
//! Of all poses of the plane with a given q_k, a + M⁻¹u_k Δq_k / (u_kᵀ M⁻¹ u_k) is nearest to a pose a in the metric M.
//! If it violates a joint limit, the pose moves along the line of equal q_k to the limits. If q_k is infeasible, the
//! pose is at the corner of the limits whose q_k is nearest.

use super::plane::{PlaneMap, PlanePoint};

impl PlaneMap {
    /// Returns the least and greatest angle of a drive on the plane b within the joint limits, rad.
    pub fn range_of(&self, drive: usize, b: f64) -> [f64; 2] {
        let (w, limits) = (self.u()[drive], self.limits());
        let middle = self.turn(b) + self.v()[drive];
        let ends = [0, 1].map(|i| [w[i] * limits[i].min, w[i] * limits[i].max]);
        [0, 1].map(|side| {
            let pick = |[x, y]: [f64; 2]| if side == 0 { f64::min(x, y) } else { f64::max(x, y) };
            middle + pick(ends[0]) + pick(ends[1])
        })
    }

    /// Returns the pose (a_1, a_2) of the plane b with a drive at a given angle, rad, that is nearest to another pose.
    /// Within the limits the drive comes as near to that angle as feasible.
    pub fn with_drive_at(&self, drive: usize, angle: f64, b: f64, from: [f64; 2]) -> [f64; 2] {
        let (w, limits) = (self.u()[drive], self.limits());
        let along = self.along(w);
        let [low, high] = self.range_of(drive, b);
        let at = |a: [f64; 2]| self.lift(PlanePoint { a, b })[drive];
        let share = w[0] * along[0] + w[1] * along[1];
        if share == 0.0 {
            // The drive does not move on the plane.
            return self.clamp(from);
        }
        let step = (angle.clamp(low, high) - at(from)) / share;
        let nearest = [0, 1].map(|i| from[i] + step * along[i]);
        // Bounds of the step along the line of equal q_k that keep the limits.
        let line = [-w[1], w[0]];
        let mut room = [f64::NEG_INFINITY, f64::INFINITY];
        for i in 0..2 {
            if line[i] != 0.0 {
                let ends = [limits[i].min, limits[i].max].map(|end| (end - nearest[i]) / line[i]);
                room = [room[0].max(ends[0].min(ends[1])), room[1].min(ends[0].max(ends[1]))];
            }
        }
        // At a corner the interval may be empty by rounding: its midpoint is the corner.
        let s = if room[0] <= room[1] { 0.0_f64.clamp(room[0], room[1]) } else { 0.5 * (room[0] + room[1]) };
        self.clamp([0, 1].map(|i| nearest[i] + s * line[i]))
    }

    /// Returns M⁻¹ w up to a factor; w itself if M is not positive definite.
    fn along(&self, w: [f64; 2]) -> [f64; 2] {
        let (u, lambda) = (self.u(), self.lambda());
        let m = |i: usize, j: usize| (0..3).map(|l| lambda[l] * u[l][i] * u[l][j]).sum::<f64>();
        let (m11, m12, m22) = (m(0, 0), m(0, 1), m(1, 1));
        if m11 > 0.0 && m11 * m22 - m12 * m12 > 0.0 { [m22 * w[0] - m12 * w[1], m11 * w[1] - m12 * w[0]] } else { w }
    }
}
