//! [`Forecast`]: torques, speeds and reactions of a motion that is followed exactly, computed before it is run.

use crate::timing::limits::{DriveLimit, DriveLimits, LimitedQuantity};
use crate::{Motion, Reference};
use stillbase_mechanics::arm_on_base::ArmOnBase;
use stillbase_mechanics::planar::PerDrive;
use stillbase_query::ProgressCallback;

/// Peaks and integrals over a motion, from the inverse dynamics of an arm on its base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// Duration T, s.
    pub time: f64,
    /// Largest |torque| of each motor, N m.
    pub torque: PerDrive,
    /// Largest |speed| of each motor, rad/s: |q̇_k| for motors on the base.
    pub speed: PerDrive,
    /// Largest base moment |n_B|, N m.
    pub moment: f64,
    /// Impulse of the base moment, ∫ |n_B| dt, N m s.
    pub impulse: f64,
    /// Root mean square of n_B, N m.
    pub moment_rms: f64,
    /// Largest dynamic base force |f_B|, N.
    pub force: f64,
    /// Root mean square of the dynamic |f_B|, N.
    pub force_rms: f64,
    /// The drive limit, other than jerk, exceeded by the largest factor, and that factor; `None` if all are kept.
    pub exceeded_limit: Option<(DriveLimit, f64)>,
    /// Least and greatest b during the motion, rad.
    pub b: [f64; 2],
    /// Mean of b over time, rad.
    pub b_mean: f64,
    /// b at the start, rad.
    pub b_start: f64,
    /// b at the end, rad.
    pub b_end: f64,
}

/// Minimum number of samples of a motion.
const MIN_SAMPLES: usize = 2000;
/// Minimum number of samples for each part of a path.
const SAMPLES_PER_PART: usize = 100;
/// Maximum number of samples of a motion.
const MAX_SAMPLES: usize = 100_000;

/// Change of the largest torque between two samples, as a share of its peak, from which peaks are sought between them.
const STEEP_SHARE: f64 = 0.05;
/// Number of parts into which such an interval is divided.
const FINE_SAMPLES: u32 = 32;
/// Number of samples between two progress reports.
const SAMPLES_PER_REPORT: usize = 1024;

/// Ratio of a quantity to its limit above which the limit is exceeded; a smaller excess is a rounding error.
const EXCEEDED_ABOVE: f64 = 1.0 + 1e-6;

impl Forecast {
    /// Returns the forecast of a motion of an arm on its base, with a number of samples that depends on the path. A base
    /// that floats has no momentum.
    pub fn of(motion: &Motion, arm: &ArmOnBase, limits: &DriveLimits) -> Self {
        let instants = (SAMPLES_PER_PART * motion.path.parts()).clamp(MIN_SAMPLES, MAX_SAMPLES);
        Self::at(motion, arm, limits, instants)
    }

    /// Returns the forecast from the given number of samples, at the midpoints of equal intervals of T.
    pub fn at(motion: &Motion, arm: &ArmOnBase, limits: &DriveLimits, instants: usize) -> Self {
        Self::at_while(motion, arm, limits, instants, &mut |_| true)
    }

    /// Returns the same forecast, with progress reported to `goes_on`. If `goes_on` returns false, the computation
    /// stops and the result is to be discarded.
    pub fn at_while(
        motion: &Motion,
        arm: &ArmOnBase,
        limits: &DriveLimits,
        instants: usize,
        goes_on: ProgressCallback<'_>,
    ) -> Self {
        let (time, lambda) = (motion.duration(), arm.arm().lambda());
        let n = arm.arm().drives();
        let start = motion.at(0.0);
        let mut sum = Self {
            time,
            torque: PerDrive::zeros(n),
            speed: PerDrive::zeros(n),
            moment: 0.0,
            impulse: 0.0,
            moment_rms: 0.0,
            force: 0.0,
            force_rms: 0.0,
            exceeded_limit: None,
            b: [f64::INFINITY, f64::NEG_INFINITY],
            b_mean: 0.0,
            b_start: lambda.dot(&start.q),
            b_end: lambda.dot(&motion.at(time).q),
        };
        // The samples are midpoints, but the range of b includes both ends of the motion.
        sum.b = [sum.b_start.min(sum.b_end), sum.b_start.max(sum.b_end)];
        let dt = time / instants as f64;
        let mut torques = Vec::with_capacity(instants);
        // At midpoints, so that a jump of the acceleration is not sampled on the wrong side.
        for i in 0..instants {
            if i % SAMPLES_PER_REPORT == 0 && !goes_on(i as f64 / instants as f64) {
                break;
            }
            let r = motion.at((i as f64 + 0.5) * dt);
            let Loads { moment, force, torque } = sum.include(arm, limits, &r);
            torques.push(torque);
            sum.impulse += moment * dt;
            sum.moment_rms += moment * moment / instants as f64;
            sum.force_rms += force * force / instants as f64;
            let b = lambda.dot(&r.q);
            sum.b = [sum.b[0].min(b), sum.b[1].max(b)];
            sum.b_mean += (b - sum.b_start) / instants as f64;
        }
        // Peaks between samples, as where a path crosses a singularity.
        let most = torques.iter().copied().fold(0.0, f64::max);
        let last = torques.len().saturating_sub(1);
        let is_steep = |i: usize| (torques[i + 1] - torques[i]).abs() > STEEP_SHARE * most;
        // A peak may lie between two equal samples, beside steep ones.
        let is_by_steep = |i: &usize| (i.saturating_sub(1)..(i + 2).min(last)).any(is_steep);
        for i in (0..last).filter(is_by_steep) {
            (1..FINE_SAMPLES).for_each(|k| {
                let share = f64::from(k) / f64::from(FINE_SAMPLES);
                sum.include(arm, limits, &motion.at((i as f64 + 0.5 + share) * dt));
            });
        }
        sum.b_mean += sum.b_start;
        sum.moment_rms = sum.moment_rms.sqrt();
        sum.force_rms = sum.force_rms.sqrt();
        sum
    }

    /// Includes an instant of a motion in the peaks.
    fn include(&mut self, arm: &ArmOnBase, limits: &DriveLimits, r: &Reference) -> Loads {
        let (torque, wrench) = arm.dynamics(&r.q.units(), &r.qd, &r.qdd);
        let motors = arm.arm().motors();
        let (torque, rate, acceleration) =
            (motors.motor_torques(&torque), motors.to_motors(&r.qd), motors.to_motors(&r.qdd));
        let most = |most: &mut PerDrive, x: &PerDrive| {
            most.iter_mut().zip(x.iter()).for_each(|(m, x)| *m = m.max(x.abs()));
        };
        most(&mut self.torque, &torque);
        most(&mut self.speed, &rate);
        for (quantity, values) in [
            (LimitedQuantity::Torque, &torque),
            (LimitedQuantity::Speed, &rate),
            (LimitedQuantity::Acceleration, &acceleration),
        ] {
            for (drive, (x, limit)) in values.iter().zip(limits.on(quantity).iter()).enumerate() {
                let factor = x.abs() / limit;
                // Excess within rounding is ignored.
                if factor > EXCEEDED_ABOVE && self.exceeded_limit.is_none_or(|(_, most)| factor > most) {
                    self.exceeded_limit = Some((DriveLimit { quantity, drive }, factor));
                }
            }
        }
        let (moment, force) = (wrench.total().moment.abs(), wrench.dynamic.force.norm());
        self.moment = self.moment.max(moment);
        self.force = self.force.max(force);
        Loads { moment, force, torque: torque.max_abs() }
    }
}

/// Sizes of the loads at an instant.
struct Loads {
    /// |n_B|, N m.
    moment: f64,
    /// Dynamic |f_B|, N.
    force: f64,
    /// Largest |torque|, N m.
    torque: f64,
}
