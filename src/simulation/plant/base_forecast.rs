//! [`BaseForecast`]: how a motion of the drives turns and shifts a free base, and what a wheel needs that keeps its
//! attitude, before anything is run.
//!
//! # Source
//! With the angles q_k of the drives relative to the base and H formed from C' (see [`MovingBody`]), the angular momentum
//! about the common centre of mass is L = Σ_kl H_kl (q̇_l + θ̇), θ included. H depends on relative angles only. So θ̇ =
//! (L − Σ_kl H_kl q̇_l)/Σ_kl H_kl is a quadrature. A wheel that holds the base takes up Σ_kl H_kl q̇_l − L.

use super::MovingBody;
use stillbase_mechanics::dynamics::mass_matrix;
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector, unit};
use stillbase_planning::Motion;

/// Motion of a free base under a motion of the drives that starts with the base at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
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
}

/// Number of intervals of a motion, each with two Gauss points.
const INTERVALS: usize = 1000;
/// Number of intervals for each part of a path.
const INTERVALS_PER_PART: usize = 100;
/// Maximum number of intervals.
const MAX_INTERVALS: usize = 50_000;
/// Gauss points of an interval from 0 to 1.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// Sums over all rotational coordinates at an instant, with the base at rest.
struct Sums {
    /// Σ_kl H_kl, kg m².
    inertia: f64,
    /// Σ_kl H_kl q̇_l, kg m²/s.
    momentum: f64,
    /// Its time derivative, N m.
    moment: f64,
    /// B relative to the common centre of mass, m.
    pin: Vector,
    /// Its rate, m/s.
    pin_rate: Vector,
}

impl BaseForecast {
    /// Returns the forecast of a motion; `None` unless the base of the body is free.
    pub fn of(body: &MovingBody, motion: &Motion) -> Option<Self> {
        if !body.is_free() {
            return None;
        }
        let time = motion.duration();
        let intervals = (INTERVALS_PER_PART * motion.path.parts()).clamp(INTERVALS, MAX_INTERVALS);
        let h = time / intervals as f64;
        let start = body.sums(motion, 0.0);
        let drift = -start.pin_rate;
        let (mut most, mut angle) = (Self::default(), 0.0);
        for i in 0..intervals {
            let mut next = angle;
            for x in GAUSS {
                let t = (i as f64 + x) * h;
                let now = body.sums(motion, t);
                let turned = start.momentum - now.momentum;
                next += 0.5 * h * turned / now.inertia;
                let place = now.pin * unit(angle + x * (next - angle)) - start.pin + drift * t;
                most.shift = most.shift.max(place.norm());
                most.wheel_momentum = most.wheel_momentum.max(turned.abs());
                most.wheel_torque = most.wheel_torque.max(now.moment.abs());
            }
            angle = next;
            most.angle = most.angle.max(angle.abs());
        }
        let end = body.sums(motion, time).pin * unit(angle) - start.pin + drift * time;
        Some(Self { angle_end: angle, shift: most.shift.max(end.norm()), ..most })
    }
}

impl MovingBody {
    /// Returns the sums at a time of a motion, s.
    fn sums(&self, motion: &Motion, t: f64) -> Sums {
        let (r, n) = (motion.at(t), self.arm.drives);
        let of = |x: &PerDrive| PerDrive::from_fn(n + 1, |k| if k < n { x[k] } else { 0.0 });
        let (q, qd, qdd) = (of(&r.q.0), of(&r.qd), of(&r.qdd));
        let e = DriveAngles(q).units();
        let (h, v) = mass_matrix(&self.rotating, &e, &qd);
        let all = PerDrive::from_fn(n + 1, |_| 1.0);
        let sum = |x: &PerDrive| x.iter().sum::<f64>();
        let (pin, pin_rate) = self.seen(&self.base_chain, &e, &qd);
        Sums {
            inertia: sum(&h.times(&all)),
            momentum: sum(&h.times(&qd)),
            moment: sum(&h.times(&qdd)) + sum(&v),
            pin,
            pin_rate,
        }
    }
}
