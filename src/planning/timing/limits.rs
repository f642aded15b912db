//! Limits of the drives, and the constraints on ṡ and s̈ that they give on a path.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | q′, q″ | dq/ds, d²q/ds² | rad |
//! | x, u | ṡ², s̈ | 1/s² |
//! | a, c, g | a limited quantity, divided by its limit, is a u + c x + g | s², s², 1 |
//!
//! All quantities are those of the motors' own angles; for motors on the base these are the drive angles.
//!
//! # Source
//! With q̇ = q′ ṡ and q̈ = q′ s̈ + q″ ṡ² in (4): τ = (H q′) s̈ + (H q″ + V(q, q′)) ṡ² − γᵀ g − Jᵀ F, since V is
//! quadratic in the rates. On a free base the torques are those of [`ArmOnBase`], without the last two terms.

use std::fmt;

use crate::curves::PathPoint;
use crate::curves::path::Path;
use crate::timing::law::PathProgress;
use stillbase_mechanics::arm_on_base::ArmOnBase;
use stillbase_mechanics::machine::{Machine, Motors};
use stillbase_mechanics::planar::{MAX_DRIVES, PerDrive};

/// A limited quantity of a drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitedQuantity {
    /// τ_k, N m.
    Torque,
    /// q̇_k, rad/s.
    Speed,
    /// q̈_k, rad/s².
    Acceleration,
    /// q⃛_k, rad/s³.
    Jerk,
}

impl LimitedQuantity {
    /// All quantities.
    pub const ALL: [Self; 4] = [Self::Torque, Self::Speed, Self::Acceleration, Self::Jerk];
}

/// A limit of a drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DriveLimit {
    /// The limited quantity.
    pub quantity: LimitedQuantity,
    /// Index of the drive, counted from 0.
    pub drive: usize,
}

impl fmt::Display for DriveLimit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self.quantity {
            LimitedQuantity::Torque => "torque",
            LimitedQuantity::Speed => "speed",
            LimitedQuantity::Acceleration => "acceleration",
            LimitedQuantity::Jerk => "jerk",
        };
        write!(f, "{what} of drive {}", self.drive + 1)
    }
}

/// Maximum magnitudes for each drive in either direction; infinite if there is no limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveLimits {
    /// Maximum |τ_k|, N m.
    pub torque: PerDrive,
    /// Maximum |q̇_k|, rad/s.
    pub speed: PerDrive,
    /// Maximum |q̈_k|, rad/s².
    pub acceleration: PerDrive,
    /// Maximum |q⃛_k|, rad/s³.
    pub jerk: PerDrive,
}

impl DriveLimits {
    /// Returns infinite limits for n drives.
    pub fn none(n: usize) -> Self {
        let free = PerDrive::from_fn(n.min(MAX_DRIVES), |_| f64::INFINITY);
        Self { torque: free, speed: free, acceleration: free, jerk: free }
    }

    /// Returns the limits of a machine's drives.
    pub fn of(machine: &Machine) -> Self {
        let drives = &machine.spec().drives;
        let each = |f: fn(&stillbase_mechanics::machine::Drive) -> Option<f64>| {
            PerDrive::from_fn(drives.len(), |k| f(&drives[k]).unwrap_or(f64::INFINITY))
        };
        Self {
            torque: each(|d| d.torque_limit),
            speed: each(|d| d.speed_limit),
            acceleration: each(|d| d.acceleration_limit),
            jerk: each(|d| d.jerk_limit),
        }
    }

    /// Returns the limits on one quantity.
    pub fn on(&self, quantity: LimitedQuantity) -> &PerDrive {
        match quantity {
            LimitedQuantity::Torque => &self.torque,
            LimitedQuantity::Speed => &self.speed,
            LimitedQuantity::Acceleration => &self.acceleration,
            LimitedQuantity::Jerk => &self.jerk,
        }
    }
}

/// A two-sided constraint at a point of a path: |a u + c x + g| ≤ 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConstraintRow {
    /// Coefficient of u = s̈, s².
    pub a: f64,
    /// Coefficient of x = ṡ², s².
    pub c: f64,
    /// Value at rest.
    pub g: f64,
}

impl ConstraintRow {
    /// Returns the quantity divided by its limit.
    #[inline]
    pub fn value(&self, u: f64, x: f64) -> f64 {
        self.a * u + self.c * x + self.g
    }
}

impl ConstraintRow {
    /// Returns the factor on the duration with which the limit is just met; a u + c x is inversely proportional to its
    /// square. The factor is infinite if g alone reaches the limit on the side of a u + c x, and 0 if a u + c x = 0.
    #[inline]
    pub(super) fn stretch(&self, u: f64, x: f64) -> f64 {
        let moving = self.a * u + self.c * x;
        // Distance of g from the limit on the side of the sign of a u + c x.
        let margin = 1.0 - if moving < 0.0 { -self.g } else { self.g };
        match (moving == 0.0, margin > 0.0) {
            (true, _) => 0.0,
            (false, true) => (moving.abs() / margin).sqrt(),
            (false, false) => f64::INFINITY,
        }
    }
}

/// Maximum number of rows: torque and acceleration of every drive.
pub const MAX_ROWS: usize = 2 * MAX_DRIVES;

/// A factor on the duration for each row and each limit on speed; 0 for unused entries.
pub(super) type Stretches = [f64; MAX_ROWS + MAX_DRIVES];

/// Returns the factors on the duration with which each row and speed limit at a point is just met; `at` is its timing.
#[inline]
pub(super) fn stretches(rows: &[ConstraintRow], speeds: &[f64], at: &PathProgress) -> Stretches {
    let mut factors = [0.0; MAX_ROWS + MAX_DRIVES];
    let (by_row, by_speed) = factors.split_at_mut(rows.len());
    let square = at.rate * at.rate;
    by_row.iter_mut().zip(rows).for_each(|(factor, row)| *factor = row.stretch(at.acceleration, square));
    by_speed.iter_mut().zip(speeds).for_each(|(factor, speed)| *factor = (speed * at.rate).abs());
    factors
}

/// Limits along a path: two-sided constraints that are linear in u and x, and largest rates.
pub trait LimitsOnPath {
    /// Returns the number of rows at each s, and that of limited rates.
    fn counts(&self) -> [usize; 2];

    /// Writes the rows at s, and to `speeds` each limited rate at ṡ = 1, divided by its limit. Returns the maximum x that
    /// limits on rates allow, 1/s².
    fn at(&self, s: f64, rows: &mut [ConstraintRow], speeds: &mut [f64]) -> f64;
}

/// The limits of an arm along one path.
pub(super) struct ArmOnPath<'a> {
    pub path: &'a Path,
    pub constraints: &'a Constraints<'a>,
}

impl LimitsOnPath for ArmOnPath<'_> {
    fn counts(&self) -> [usize; 2] {
        [self.constraints.rows().len(), self.constraints.speeds()]
    }

    #[inline]
    fn at(&self, s: f64, rows: &mut [ConstraintRow], speeds: &mut [f64]) -> f64 {
        self.constraints.at(&self.path.at(s), rows, speeds)
    }
}

/// The limits of an arm on its base as constraints along a path.
#[derive(Clone, Debug)]
pub struct Constraints<'a> {
    arm: &'a ArmOnBase,
    limits: &'a DriveLimits,
    /// 1/limit of each q̈_k, from the limits on torque and acceleration; only if torque is H_kk q̈_k in every pose.
    constant: Option<PerDrive>,
    rows: Vec<DriveLimit>,
    /// Drives with a limit on speed.
    speed_limited: Vec<usize>,
}

impl<'a> Constraints<'a> {
    /// Builds the constraints; infinite limits give no row.
    pub fn new(arm: &'a ArmOnBase, limits: &'a DriveLimits) -> Self {
        let model = arm.arm();
        let n = model.drives();
        let constant = arm.is_decoupled();
        let by_torque = |k: usize| limits.torque[k] / model.diagonal(k);
        let limited = |quantity| move |drive: &usize| limits.on(quantity)[*drive].is_finite();
        let of = |quantity| move |drive| DriveLimit { quantity, drive };
        let (torque, acceleration) = (LimitedQuantity::Torque, LimitedQuantity::Acceleration);
        let rows = if constant {
            // Both limits bound q̈_k; only the lower one is needed.
            let lower = |k| if by_torque(k) <= limits.acceleration[k] { torque } else { acceleration };
            let finite = (0..n).filter(|k| by_torque(*k).min(limits.acceleration[*k]).is_finite());
            finite.map(|k| of(lower(k))(k)).collect()
        } else {
            let torques = (0..n).filter(limited(torque)).map(of(torque));
            torques.chain((0..n).filter(limited(acceleration)).map(of(acceleration))).collect()
        };
        let constant = constant.then(|| PerDrive::from_fn(n, |k| 1.0 / by_torque(k).min(limits.acceleration[k])));
        let speed_limited = (0..n).filter(limited(LimitedQuantity::Speed)).collect();
        Self { arm, limits, constant, rows, speed_limited }
    }

    /// Returns the limit of each row, in the order of `at`.
    pub fn rows(&self) -> &[DriveLimit] {
        &self.rows
    }

    /// Returns the number of drives with a limit on speed.
    pub(super) fn speeds(&self) -> usize {
        self.speed_limited.len()
    }

    /// Returns the limits of the drives.
    pub fn limits(&self) -> &DriveLimits {
        self.limits
    }

    /// Returns the placement of the motors that have these limits.
    pub fn motors(&self) -> &Motors {
        self.arm.arm().motors()
    }

    /// Writes the [`rows`](Self::rows) at a point of a path, and to `speeds` each limited speed at ṡ = 1, divided by
    /// its limit. Returns the maximum x that limits on speed allow, 1/s².
    #[inline]
    pub(super) fn at(&self, point: &PathPoint, rows: &mut [ConstraintRow], speeds: &mut [f64]) -> f64 {
        let PathPoint { q, first, second } = point;
        if let Some(per) = &self.constant {
            for (row, limit) in rows.iter_mut().zip(&self.rows) {
                let (k, per) = (limit.drive, per[limit.drive]);
                *row = ConstraintRow { a: per * first[k], c: per * second[k], g: 0.0 };
            }
        } else {
            let e = q.units();
            let motors = self.motors();
            let at_rest = PerDrive::zeros(first.len());
            let a = motors.motor_torques(&self.arm.moving_torque(&e, &at_rest, first));
            let c = motors.motor_torques(&self.arm.moving_torque(&e, first, second));
            let g = motors.motor_torques(&self.arm.holding_torque(&e));
            let (first, second) = (motors.to_motors(first), motors.to_motors(second));
            for (row, limit) in rows.iter_mut().zip(&self.rows) {
                let k = limit.drive;
                let per = 1.0 / self.limits.on(limit.quantity)[k];
                *row = match limit.quantity {
                    LimitedQuantity::Torque => ConstraintRow { a: per * a[k], c: per * c[k], g: per * g[k] },
                    _ => ConstraintRow { a: per * first[k], c: per * second[k], g: 0.0 },
                };
            }
        }
        if self.speed_limited.is_empty() {
            return f64::INFINITY;
        }
        let first = self.motors().to_motors(first);
        speeds
            .iter_mut()
            .zip(&self.speed_limited)
            .for_each(|(speed, k)| *speed = first[*k].abs() / self.limits.speed[*k]);
        let largest = speeds.iter().copied().fold(0.0, f64::max);
        1.0 / (largest * largest)
    }

    /// Returns the factors on the duration with which each limit except jerk is just met at a point of a path.
    /// `at` is the timing there.
    pub(super) fn stretches(&self, path: &Path, at: &PathProgress) -> Stretches {
        let (mut rows, mut speeds) = ([ConstraintRow::default(); MAX_ROWS], [0.0; MAX_DRIVES]);
        let (rows, speeds) = (&mut rows[..self.rows.len()], &mut speeds[..self.speed_limited.len()]);
        self.at(&path.at(at.s), rows, speeds);
        stretches(rows, speeds, at)
    }

    /// Returns the drive that reaches its limit on speed first as ṡ grows.
    pub(super) fn fastest_drive(&self, point: &PathPoint) -> usize {
        let first = self.motors().to_motors(&point.first);
        let part = |k: usize| first[k].abs() / self.limits.speed[k];
        (0..first.len()).max_by(|k, l| part(*k).total_cmp(&part(*l))).unwrap_or(0)
    }
}
