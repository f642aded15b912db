//! Utilisation of the drives' limits by a motion.

use crate::Motion;
use crate::curves::path::Path;
use crate::timing::law::PathProgress;
use crate::timing::limits::{DriveLimit, DriveLimits, LimitedQuantity};
use stillbase_mechanics::arm_on_base::ArmOnBase;
use stillbase_mechanics::planar::{MAX_DRIVES, PerDrive};

/// A limit is active if at least this fraction of it is used.
pub const ACTIVE_SHARE: f64 = 1.0 - 1e-3;

/// Utilisation of the limits by a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Usage {
    /// Fraction of T during which some limit is active, see [`ACTIVE_SHARE`].
    pub active: f64,
    /// Maximum utilisation of a limit: 1 is the limit, more is a violation.
    pub max_utilisation: f64,
    /// Time of the maximum, s.
    pub time_of_max_s: f64,
    /// Limit of the maximum; `None` without limits.
    pub limit: Option<DriveLimit>,
    /// Each limit with the fraction of T during which its utilisation is the highest of all, the greatest fraction
    /// first.
    pub active_limits: Vec<(DriveLimit, f64)>,
}

impl Usage {
    /// Computes the utilisation of a motion of an arm on its base at the midpoints of `samples` equal parts of
    /// T.
    ///
    /// Torques come from the inverse dynamics (4) along the motion, independently of its planning.
    pub fn of(motion: &Motion, arm: &ArmOnBase, limits: &DriveLimits, samples: usize) -> Self {
        let mut usage =
            Self { active: 0.0, max_utilisation: 0.0, time_of_max_s: 0.0, limit: None, active_limits: Vec::new() };
        let mut shares = TimeShares::default();
        for i in 0..samples {
            let t = (i as f64 + 0.5) / samples as f64 * motion.duration();
            let demand = Demand::of(&motion.path, arm, limits, &motion.profile.at(t));
            let Some((part, limit)) = demand.furthest(limits) else { break };
            if part > usage.max_utilisation || usage.limit.is_none() {
                (usage.max_utilisation, usage.time_of_max_s, usage.limit) = (part, t, Some(limit));
            }
            usage.active += if part >= ACTIVE_SHARE { 1.0 / samples as f64 } else { 0.0 };
            shares.add(limit, 1.0 / samples as f64);
        }
        usage.active_limits = shares.sorted();
        usage
    }
}

/// Time, or fraction of it, for each limit.
#[derive(Clone, Debug, Default)]
pub(super) struct TimeShares([PerLimit; 4]);

type PerLimit = [f64; MAX_DRIVES];

impl TimeShares {
    #[inline]
    pub(super) fn add(&mut self, limit: DriveLimit, share: f64) {
        self.0[limit.quantity as usize][limit.drive] += share;
    }

    /// Returns the entries above 0 as fractions of their sum, the greatest first.
    pub(super) fn sorted(&self) -> Vec<(DriveLimit, f64)> {
        let whole: f64 = self.0.iter().flatten().sum();
        let each = LimitedQuantity::ALL.into_iter().flat_map(|quantity| {
            let of = self.0[quantity as usize];
            (0..of.len()).map(move |drive| (DriveLimit { quantity, drive }, of[drive] / whole))
        });
        let mut found: Vec<_> = each.filter(|(_, share)| *share > 0.0).collect();
        found.sort_by(|a, b| b.1.total_cmp(&a.1));
        found
    }
}

/// Torques and motion of the motors at an instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Demand {
    /// Torque to hold still, N m.
    holding: PerDrive,
    /// Torque of the motion, N m.
    moving: PerDrive,
    /// rad/s.
    speed: PerDrive,
    /// rad/s².
    acceleration: PerDrive,
    /// rad/s³; zero without limits on jerk.
    jerk: PerDrive,
}

impl Demand {
    /// Computes the demand at an instant. Jerk is evaluated only if it is limited.
    pub(super) fn of(path: &Path, arm: &ArmOnBase, limits: &DriveLimits, at: &PathProgress) -> Self {
        let point = path.at(at.s);
        let reference = point.timed(at);
        let e = point.q.units();
        let moving = arm.moving_torque(&e, &reference.qd, &reference.qdd);
        let jerk = match limits.jerk.iter().any(|j| j.is_finite()) {
            true => point
                .first
                .scaled(at.jerk)
                .plus(3.0 * at.rate * at.acceleration, &point.second)
                .plus(at.rate.powi(3), &path.third(at.s)),
            false => PerDrive::zeros(reference.qd.len()),
        };
        let holding = arm.holding_torque(&e);
        let motors = arm.arm().motors();
        let [holding, moving] = [holding, moving].map(|torque| motors.motor_torques(&torque));
        let [speed, acceleration, jerk] = [reference.qd, reference.qdd, jerk].map(|x| motors.to_motors(&x));
        Self { holding, moving, speed, acceleration, jerk }
    }

    /// Returns the maximum utilisation and its limit; `None` without limits.
    pub(super) fn furthest(&self, limits: &DriveLimits) -> Option<(f64, DriveLimit)> {
        let mut furthest: Option<(f64, DriveLimit)> = None;
        for quantity in LimitedQuantity::ALL {
            let used = match quantity {
                LimitedQuantity::Torque => self.holding.plus(1.0, &self.moving),
                LimitedQuantity::Speed => self.speed,
                LimitedQuantity::Acceleration => self.acceleration,
                LimitedQuantity::Jerk => self.jerk,
            };
            for (drive, (used, limit)) in used.iter().zip(limits.on(quantity).iter()).enumerate() {
                let part = used.abs() / limit;
                if limit.is_finite() && furthest.is_none_or(|(largest, _)| part > largest) {
                    furthest = Some((part, DriveLimit { quantity, drive }));
                }
            }
        }
        furthest
    }

    /// Returns for each limit the factor of time stretch that just keeps it. Rates are inversely proportional to a
    /// factor, accelerations and the torque of motion to its square, jerks to its cube. A factor is infinite if holding
    /// still already requires the whole torque.
    pub(super) fn stretches(&self, limits: &DriveLimits) -> [f64; 4 * MAX_DRIVES] {
        let mut factors = [0.0; 4 * MAX_DRIVES];
        for (k, of) in factors.chunks_exact_mut(4).enumerate().take(self.speed.len()) {
            let (hold, moving, limit) = (self.holding[k], self.moving[k], limits.torque[k]);
            // Distance of the holding torque to the limit in the direction of the moving torque.
            let margin = limit - hold * moving.signum();
            let torque = if moving == 0.0 {
                0.0
            } else if margin > 0.0 {
                (moving.abs() / margin).sqrt()
            } else {
                f64::INFINITY
            };
            of[0] = if hold.abs() > limit { f64::INFINITY } else { torque };
            of[1] = self.speed[k].abs() / limits.speed[k];
            of[2] = (self.acceleration[k].abs() / limits.acceleration[k]).sqrt();
            of[3] = (self.jerk[k].abs() / limits.jerk[k]).cbrt();
        }
        factors
    }
}
