//! What a motion will cost if it is followed exactly: known before anything moves.

use crate::mechanics::dynamics::{Surroundings, inverse_with_wrench};
use crate::mechanics::machine::Inertia;
use crate::mechanics::planar::PerDrive;
use crate::planning::Motion;
use crate::planning::timing::limits::{DriveLimit, LimitedQuantity, Limits};
use crate::query::Watch;

/// Peaks and sums over a motion, from the model's own dynamics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// T, s.
    pub time: f64,
    /// Largest torque of each motor, either way, N m.
    pub torque: PerDrive,
    /// Largest rate of each motor, rad/s: |q̇_k| of those on the base.
    pub speed: PerDrive,
    /// Largest |n_B|, N m.
    pub moment: f64,
    /// ∫ |n_B| dt, N m s.
    pub impulse: f64,
    /// Root of the mean of n_B², N m.
    pub moment_rms: f64,
    /// Largest dynamic |f_B|, N.
    pub force: f64,
    /// Root of the mean of the dynamic |f_B|², N.
    pub force_rms: f64,
    /// The limit of a drive that is passed by most, and by what factor; none if all are kept.
    pub over: Option<(DriveLimit, f64)>,
    /// Least and greatest b on the way, rad.
    pub b: [f64; 2],
    /// Mean of b over time, rad.
    pub b_mean: f64,
    /// b at the start, rad.
    pub b_start: f64,
    /// b at the end, rad.
    pub b_end: f64,
}

/// Instants at which a motion is looked at, at least.
const MIN_INSTANTS: usize = 2000;
/// Those for each part of a path of many.
const INSTANTS_PER_PART: usize = 100;
/// Those at most.
const MAX_INSTANTS: usize = 100_000;

/// After so many instants it is told how much is done.
const INSTANTS_PER_WORD: usize = 1024;

/// A limit counts as passed from this factor on.
const PASSED_FACTOR: f64 = 1.0 + 1e-6;

impl Forecast {
    /// Of a motion of a model.
    pub fn of(motion: &Motion, model: &Inertia, around: &Surroundings, limits: &Limits) -> Self {
        let instants = (INSTANTS_PER_PART * motion.path.parts()).clamp(MIN_INSTANTS, MAX_INSTANTS);
        Self::at(motion, model, around, limits, instants)
    }

    /// The same by that many instants, evenly in the middles of as many parts of T.
    pub fn at(motion: &Motion, model: &Inertia, around: &Surroundings, limits: &Limits, instants: usize) -> Self {
        Self::at_while(motion, (model, around, limits), instants, &mut |_| true)
    }

    /// The same; once the rest is not wanted it is left out, and the answer is of no use.
    pub fn at_while(
        motion: &Motion,
        (model, around, limits): (&Inertia, &Surroundings, &Limits),
        instants: usize,
        goes_on: Watch<'_>,
    ) -> Self {
        let (time, lambda) = (motion.duration(), model.lambda());
        let n = model.drives();
        let mut sum = Self {
            time,
            torque: PerDrive::zeros(n),
            speed: PerDrive::zeros(n),
            moment: 0.0,
            impulse: 0.0,
            moment_rms: 0.0,
            force: 0.0,
            force_rms: 0.0,
            over: None,
            b: [f64::INFINITY, f64::NEG_INFINITY],
            b_mean: 0.0,
            b_start: lambda.dot(&motion.at(0.0).q),
            b_end: lambda.dot(&motion.at(time).q),
        };
        // The instants lie between: the ends belong to the range too.
        sum.b = [sum.b_start.min(sum.b_end), sum.b_start.max(sum.b_end)];
        let dt = time / instants as f64;
        // Between the instants, so that no step of the acceleration is looked at from the wrong side.
        for i in 0..instants {
            if i % INSTANTS_PER_WORD == 0 && !goes_on(i as f64 / instants as f64) {
                break;
            }
            let r = motion.at((i as f64 + 0.5) * dt);
            let (torque, wrench) = inverse_with_wrench(model, &r.q.units(), &r.qd, &r.qdd, around);
            let motors = model.motors();
            let (torque, rate, acceleration) = (motors.torques(&torque), motors.turns(&r.qd), motors.turns(&r.qdd));
            let most = |most: &mut PerDrive, x: &PerDrive| {
                most.iter_mut().zip(x.iter()).for_each(|(m, x)| *m = m.max(x.abs()));
            };
            most(&mut sum.torque, &torque);
            most(&mut sum.speed, &rate);
            for (quantity, values) in [
                (LimitedQuantity::Torque, &torque),
                (LimitedQuantity::Speed, &rate),
                (LimitedQuantity::Acceleration, &acceleration),
            ] {
                for (drive, (x, limit)) in values.iter().zip(limits.on(quantity).iter()).enumerate() {
                    let factor = x.abs() / limit;
                    // What rounding passes by is none.
                    if factor > PASSED_FACTOR && sum.over.is_none_or(|(_, most)| factor > most) {
                        sum.over = Some((DriveLimit { quantity, drive }, factor));
                    }
                }
            }
            let moment = wrench.total().moment.abs();
            sum.moment = sum.moment.max(moment);
            sum.impulse += moment * dt;
            sum.force = sum.force.max(wrench.dynamic.force.norm());
            sum.moment_rms += moment * moment / instants as f64;
            sum.force_rms += wrench.dynamic.force.norm_sqr() / instants as f64;
            let b = lambda.dot(&r.q);
            sum.b = [sum.b[0].min(b), sum.b[1].max(b)];
            sum.b_mean += (b - sum.b_start) / instants as f64;
        }
        sum.b_mean += sum.b_start;
        sum.moment_rms = sum.moment_rms.sqrt();
        sum.force_rms = sum.force_rms.sqrt();
        sum
    }
}
