//! How far a motion uses its drives: what it asks of them at each instant, beside their limits.

use crate::mechanics::dynamics::{Surroundings, holding_torque, inverse};
use crate::mechanics::machine::Inertia;
use crate::mechanics::planar::{MAX_DRIVES, PerDrive};
use crate::planning::Motion;
use crate::planning::curves::path::Path;
use crate::planning::timing::law::Progress;
use crate::planning::timing::limits::{DriveLimit, LimitedQuantity, Limits};

/// A limit counts as active when this much of it, or more, is used.
pub const ACTIVE: f64 = 1.0 - 1e-3;

/// How far a motion uses its limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Usage {
    /// Share of T at which some limit is used to within [`ACTIVE`] or beyond.
    pub active: f64,
    /// The greatest part of a limit that is ever used: 1 is the limit, more is a violation.
    pub most: f64,
    /// When, s.
    pub when: f64,
    /// Of which limit; none where there are no limits.
    pub limit: Option<DriveLimit>,
    /// Which limit is used furthest, for what share of T, the greatest share first.
    pub leading: Vec<(DriveLimit, f64)>,
}

impl Usage {
    /// Of a motion of a model in its surroundings, at as many instants, evenly in the middles of as many parts of T.
    ///
    /// Torques come from the inverse dynamics (4) along the motion, not from what planned it.
    pub fn of(motion: &Motion, model: &Inertia, around: &Surroundings, limits: &Limits, samples: usize) -> Self {
        let mut usage = Self { active: 0.0, most: 0.0, when: 0.0, limit: None, leading: Vec::new() };
        let mut shares = TimeShares::default();
        for i in 0..samples {
            let t = (i as f64 + 0.5) / samples as f64 * motion.duration();
            let demand = Demand::of(&motion.path, model, around, limits, &motion.profile.at(t));
            let Some((part, limit)) = demand.furthest(limits) else { break };
            if part > usage.most || usage.limit.is_none() {
                (usage.most, usage.when, usage.limit) = (part, t, Some(limit));
            }
            usage.active += if part >= ACTIVE { 1.0 / samples as f64 } else { 0.0 };
            shares.add(limit, 1.0 / samples as f64);
        }
        usage.leading = shares.sorted();
        usage
    }
}

/// Time, or shares of it, for each limit.
#[derive(Clone, Debug, Default)]
pub(super) struct TimeShares([PerLimit; 4]);

type PerLimit = [f64; MAX_DRIVES];

impl TimeShares {
    #[inline]
    pub(super) fn add(&mut self, limit: DriveLimit, share: f64) {
        self.0[limit.quantity as usize][limit.drive] += share;
    }

    /// Those above 0, of a whole, the greatest first.
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

/// What an instant of a motion asks of the drives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Demand {
    /// Torque to hold still, N m.
    holding: PerDrive,
    /// Torque of the motion, N m.
    moving: PerDrive,
    speed: PerDrive,
    acceleration: PerDrive,
    jerk: PerDrive,
}

impl Demand {
    /// Jerk is evaluated only where it is limited.
    pub(super) fn of(path: &Path, model: &Inertia, around: &Surroundings, limits: &Limits, at: &Progress) -> Self {
        let point = path.at(at.s);
        let reference = point.timed(at);
        let e = point.q.units();
        let moving = inverse(model, &e, &reference.qd, &reference.qdd, &Surroundings::default());
        let jerk = match limits.jerk.iter().any(|j| j.is_finite()) {
            true => point
                .first
                .scaled(at.jerk)
                .plus(3.0 * at.rate * at.acceleration, &point.second)
                .plus(at.rate.powi(3), &path.third(at.s)),
            false => PerDrive::zeros(reference.qd.len()),
        };
        let holding = holding_torque(model, &e, around);
        let motors = model.motors();
        let [holding, moving] = [holding, moving].map(|torque| motors.torques(&torque));
        let [speed, acceleration, jerk] = [reference.qd, reference.qdd, jerk].map(|x| motors.turns(&x));
        Self { holding, moving, speed, acceleration, jerk }
    }

    /// The limit that is used furthest and the part of it that is used; `None` without limits.
    pub(super) fn furthest(&self, limits: &Limits) -> Option<(f64, DriveLimit)> {
        let mut furthest: Option<(f64, DriveLimit)> = None;
        for quantity in LimitedQuantity::ALL {
            let asked = match quantity {
                LimitedQuantity::Torque => self.holding.plus(1.0, &self.moving),
                LimitedQuantity::Speed => self.speed,
                LimitedQuantity::Acceleration => self.acceleration,
                LimitedQuantity::Jerk => self.jerk,
            };
            for (drive, (asked, limit)) in asked.iter().zip(limits.on(quantity).iter()).enumerate() {
                let part = asked.abs() / limit;
                if limit.is_finite() && furthest.is_none_or(|(most, _)| part > most) {
                    furthest = Some((part, DriveLimit { quantity, drive }));
                }
            }
        }
        furthest
    }

    /// The factors on time with which the instant just keeps each limit: rates fall with their first, accelerations and
    /// the torque of motion with their second, jerks with their third power. Infinite where no time is enough, because
    /// holding still already takes all of a torque.
    pub(super) fn stretches(&self, limits: &Limits) -> [f64; 4 * MAX_DRIVES] {
        let mut factors = [0.0; 4 * MAX_DRIVES];
        for (k, of) in factors.chunks_exact_mut(4).enumerate().take(self.speed.len()) {
            let (hold, moving, limit) = (self.holding[k], self.moving[k], limits.torque[k]);
            // Room on the side to which the motion pushes.
            let room = limit - hold * moving.signum();
            let torque = if moving == 0.0 {
                0.0
            } else if room > 0.0 {
                (moving.abs() / room).sqrt()
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
