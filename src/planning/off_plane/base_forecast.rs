//! [`BaseForecast`]: how a motion of the drives turns and shifts a free base, and what a wheel needs that keeps its
//! attitude, before anything is run.
//!
//! # Source
//! With the angles q_k of the drives relative to the base and H formed from C' (see [`ArmOnBase`]), the angular momentum
//! about the common centre of mass is Σ_kl H_kl (q̇_l + θ̇) = 0, θ included. H depends on relative angles only. So θ̇ =
//! −Σ_kl H_kl q̇_l/Σ_kl H_kl is a quadrature. A wheel that holds the base takes up Σ_kl H_kl q̇_l.

use crate::Motion;
use stillbase_mechanics::arm_on_base::{ArmOnBase, FreeBody, RestingBase};
use stillbase_mechanics::planar::unit;

/// Motion of a free base under a motion of the drives, with all momentum zero.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BaseForecast {
    /// Largest |θ| without a wheel, rad.
    pub angle: f64,
    /// θ at the end without a wheel, rad.
    pub angle_end: f64,
    /// Largest |p_B| without a wheel, m.
    pub shift: f64,
    /// Largest momentum of a wheel that holds the base, N m s.
    pub wheel_momentum: f64,
    /// Largest torque of this wheel, N m.
    pub wheel_torque: f64,
    /// s of the path, 0 to 1, and θ there without a wheel, rad.
    course: Vec<[f64; 2]>,
}

/// Number of intervals of a motion, each with three Gauss points.
const INTERVALS: usize = 2000;
/// Number of intervals for each part of a path.
const INTERVALS_PER_PART: usize = 100;
/// Maximum number of intervals.
const MAX_INTERVALS: usize = 50_000;
/// Gauss points of an interval from 0 to 1.
const GAUSS: [f64; 3] = [0.112_701_665_379_258_3, 0.5, 0.887_298_334_620_741_7];
/// Weights of these points.
const WEIGHTS: [f64; 3] = [5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0];

impl BaseForecast {
    /// Returns the forecast of a motion; `None` unless the base is free.
    pub fn of(arm: &ArmOnBase, motion: &Motion) -> Option<Self> {
        let body = arm.free_body()?;
        let time = motion.duration();
        let intervals = (INTERVALS_PER_PART * motion.path.parts()).clamp(INTERVALS, MAX_INTERVALS);
        let h = time / intervals as f64;
        let start = beside_rest(body, motion, 0.0);
        let mut most = Self { course: Vec::with_capacity(intervals + 1), ..Self::default() };
        most.course.push([motion.profile.at(0.0).s, 0.0]);
        let mut angle = 0.0;
        for i in 0..intervals {
            let mut next = angle;
            for (x, weight) in GAUSS.into_iter().zip(WEIGHTS) {
                let t = (i as f64 + x) * h;
                let now = beside_rest(body, motion, t);
                let turned = -now.momentum;
                let turning = turned / now.inertia;
                next += weight * h * turning;
                let place = now.pin * unit(angle + x * h * turning) - start.pin;
                most.shift = most.shift.max(place.norm());
                most.wheel_momentum = most.wheel_momentum.max(turned.abs());
                most.wheel_torque = most.wheel_torque.max(now.moment.abs());
            }
            angle = next;
            most.angle = most.angle.max(angle.abs());
            most.course.push([motion.profile.at((i + 1) as f64 * h).s, angle]);
        }
        let end = beside_rest(body, motion, time).pin * unit(angle) - start.pin;
        Some(Self { angle_end: angle, shift: most.shift.max(end.norm()), ..most })
    }

    /// Returns θ without a wheel at s of the path, 0 to 1, rad; linear between samples.
    pub fn angle_at(&self, s: f64) -> f64 {
        let i = self.course.partition_point(|sample| sample[0] < s).clamp(1, self.course.len() - 1);
        let [from, to] = [self.course[i - 1], self.course[i]];
        let share = if to[0] > from[0] { ((s - from[0]) / (to[0] - from[0])).clamp(0.0, 1.0) } else { 1.0 };
        from[1] + share * (to[1] - from[1])
    }
}

/// Returns the drives at a time of a motion, s, beside a base at rest.
fn beside_rest(body: &FreeBody, motion: &Motion, t: f64) -> RestingBase {
    let r = motion.at(t);
    body.beside_rest(&r.q.units(), &r.qd, &r.qdd)
}
