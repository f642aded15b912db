//! What a motion will cost if it is followed exactly: known before anything moves.

use super::Motion;
use crate::dynamics::{Surroundings, inverse_with_wrench};
use crate::machine::Inertia;
use crate::planar::PerDrive;

/// Peaks and sums over a motion, from the model's own dynamics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// T, s.
    pub time: f64,
    /// Largest |τ_k|, N m.
    pub torque: PerDrive,
    /// Largest |q̇_k|, rad/s.
    pub speed: PerDrive,
    /// Largest |n_B|, N m.
    pub moment: f64,
    /// ∫ |n_B| dt, N m s.
    pub impulse: f64,
    /// Largest dynamic |f_B|, N.
    pub force: f64,
    /// Least and greatest b on the way, rad.
    pub b: [f64; 2],
    /// b at the end, rad.
    pub b_end: f64,
}

/// Instants that a motion is looked at.
const INSTANTS: usize = 2000;

impl Forecast {
    /// Of a motion of a model.
    pub fn of(motion: &Motion, model: &Inertia, around: &Surroundings) -> Self {
        let (time, lambda) = (motion.duration(), model.lambda());
        let n = model.drives();
        let mut sum = Self {
            time,
            torque: PerDrive::zeros(n),
            speed: PerDrive::zeros(n),
            moment: 0.0,
            impulse: 0.0,
            force: 0.0,
            b: [f64::INFINITY, f64::NEG_INFINITY],
            b_end: lambda.dot(&motion.at(time).q),
        };
        let dt = time / INSTANTS as f64;
        // Between the instants, so that no step of the acceleration is looked at from the wrong side.
        for i in 0..INSTANTS {
            let r = motion.at((i as f64 + 0.5) * dt);
            let (torque, wrench) = inverse_with_wrench(model, &r.q.units(), &r.qd, &r.qdd, around);
            let most = |most: &mut PerDrive, x: &PerDrive| {
                most.iter_mut().zip(x.iter()).for_each(|(m, x)| *m = m.max(x.abs()));
            };
            most(&mut sum.torque, &torque);
            most(&mut sum.speed, &r.qd);
            let moment = wrench.total().moment.abs();
            sum.moment = sum.moment.max(moment);
            sum.impulse += moment * dt;
            sum.force = sum.force.max(wrench.dynamic.force.norm());
            let b = lambda.dot(&r.q);
            sum.b = [sum.b[0].min(b), sum.b[1].max(b)];
        }
        sum
    }
}
