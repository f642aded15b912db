//! What the drives can do, and what that leaves of ṡ and s̈ on a path.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | q′, q″ | dq/ds, d²q/ds² | rad |
//! | x, u | ṡ², s̈ | 1/s² |
//! | a, c, g | a limited quantity, as a part of its limit, is a u + c x + g | s², s², 1 |
//!
//! All are of the motors' own angles, which for motors on the base are those of the drives.
//!
//! # Source
//! With q̇ = q′ ṡ and q̈ = q′ s̈ + q″ ṡ² in (4): τ = (H q′) s̈ + (H q″ + V(q, q′)) ṡ² − γᵀ g − Jᵀ F, since V is of
//! second degree in the rates.

use std::fmt;

use crate::mechanics::dynamics::{Surroundings, holding_torque, inverse, mass_matrix};
use crate::mechanics::machine::{Inertia, Machine, Motors};
use crate::mechanics::planar::{MAX_DRIVES, PerDrive};
use crate::planning::curves::PathPoint;
use crate::planning::curves::path::Path;
use crate::planning::timing::law::Progress;

/// What of a drive is limited.
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
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Torque, Self::Speed, Self::Acceleration, Self::Jerk];
}

/// A limit of a drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DriveLimit {
    /// What is limited.
    pub quantity: LimitedQuantity,
    /// Of which drive, counted from 0.
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

/// The greatest magnitudes for each drive, either way; infinite where there is no limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// |τ_k|, N m.
    pub torque: PerDrive,
    /// |q̇_k|, rad/s.
    pub speed: PerDrive,
    /// |q̈_k|, rad/s².
    pub acceleration: PerDrive,
    /// |q⃛_k|, rad/s³.
    pub jerk: PerDrive,
}

impl Limits {
    /// No limits on n drives.
    pub fn none(n: usize) -> Self {
        let free = PerDrive::from_fn(n.min(MAX_DRIVES), |_| f64::INFINITY);
        Self { torque: free, speed: free, acceleration: free, jerk: free }
    }

    /// Those of a machine's drives.
    pub fn of(machine: &Machine) -> Self {
        let drives = &machine.spec().drives;
        let each = |f: fn(&crate::mechanics::machine::Drive) -> Option<f64>| {
            PerDrive::from_fn(drives.len(), |k| f(&drives[k]).unwrap_or(f64::INFINITY))
        };
        Self {
            torque: each(|d| d.torque_limit),
            speed: each(|d| d.speed_limit),
            acceleration: each(|d| d.acceleration_limit),
            jerk: each(|d| d.jerk_limit),
        }
    }

    /// The limits on one quantity.
    pub fn on(&self, quantity: LimitedQuantity) -> &PerDrive {
        match quantity {
            LimitedQuantity::Torque => &self.torque,
            LimitedQuantity::Speed => &self.speed,
            LimitedQuantity::Acceleration => &self.acceleration,
            LimitedQuantity::Jerk => &self.jerk,
        }
    }
}

/// One two-sided constraint at a place of a path: |a u + c x + g| ≤ 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConstraintRow {
    /// Of u = s̈, s².
    pub a: f64,
    /// Of x = ṡ², s².
    pub c: f64,
    /// What is there at rest.
    pub g: f64,
}

impl ConstraintRow {
    /// The quantity as a part of its limit.
    #[inline]
    pub fn value(&self, u: f64, x: f64) -> f64 {
        self.a * u + self.c * x + self.g
    }
}

impl ConstraintRow {
    /// The factor on time with which the limit is just kept: all but what is there at rest falls with its square.
    /// Infinite where no time is enough.
    #[inline]
    pub(super) fn stretch(&self, u: f64, x: f64) -> f64 {
        let moving = self.a * u + self.c * x;
        // Room on the side to which the motion pushes.
        let room = 1.0 - if moving < 0.0 { -self.g } else { self.g };
        match (moving == 0.0, room > 0.0) {
            (true, _) => 0.0,
            (false, true) => (moving.abs() / room).sqrt(),
            (false, false) => f64::INFINITY,
        }
    }
}

/// The most rows there can be: torque and acceleration of every drive.
pub const MAX_ROWS: usize = 2 * MAX_DRIVES;

/// A factor on time for each row and each speed; 0 where there is none.
pub(super) type Stretches = [f64; MAX_ROWS + MAX_DRIVES];

/// The factors on time with which a place that is passed so just keeps its rows and speeds.
#[inline]
pub(super) fn stretches(rows: &[ConstraintRow], speeds: &[f64], at: &Progress) -> Stretches {
    let mut factors = [0.0; MAX_ROWS + MAX_DRIVES];
    let (by_row, by_speed) = factors.split_at_mut(rows.len());
    let square = at.rate * at.rate;
    by_row.iter_mut().zip(rows).for_each(|(factor, row)| *factor = row.stretch(at.acceleration, square));
    by_speed.iter_mut().zip(speeds).for_each(|(factor, speed)| *factor = (speed * at.rate).abs());
    factors
}

/// The limits of a machine in its surroundings as constraints along a path.
#[derive(Clone, Debug)]
pub struct Constraints<'a> {
    model: &'a Inertia,
    around: Surroundings,
    limits: &'a Limits,
    /// Where torque is D_k q̈_k in every pose: 1/limit of q̈_k from both.
    constant: Option<PerDrive>,
    rows: Vec<DriveLimit>,
    /// Drives with a limit on speed.
    quick: Vec<usize>,
}

impl<'a> Constraints<'a> {
    /// Of a model; limits that are infinite make no row.
    pub fn new(model: &'a Inertia, around: &Surroundings, limits: &'a Limits) -> Self {
        let n = model.drives();
        let weightless = around.gravity.norm_sqr() == 0.0 || model.is_force_balanced();
        let constant = model.is_invariant() && weightless && around.force.norm_sqr() == 0.0 && model.is_decoupled();
        let by_torque = |k: usize| limits.torque[k] / model.diagonal(k);
        let limited = |quantity| move |drive: &usize| limits.on(quantity)[*drive].is_finite();
        let of = |quantity| move |drive| DriveLimit { quantity, drive };
        let (torque, acceleration) = (LimitedQuantity::Torque, LimitedQuantity::Acceleration);
        let rows = if constant {
            // Both limit q̈_k; the lower one is enough.
            let lower = |k| if by_torque(k) <= limits.acceleration[k] { torque } else { acceleration };
            let finite = (0..n).filter(|k| by_torque(*k).min(limits.acceleration[*k]).is_finite());
            finite.map(|k| of(lower(k))(k)).collect()
        } else {
            let torques = (0..n).filter(limited(torque)).map(of(torque));
            torques.chain((0..n).filter(limited(acceleration)).map(of(acceleration))).collect()
        };
        let constant = constant.then(|| PerDrive::from_fn(n, |k| 1.0 / by_torque(k).min(limits.acceleration[k])));
        let quick = (0..n).filter(limited(LimitedQuantity::Speed)).collect();
        Self { model, around: *around, limits, constant, rows, quick }
    }

    /// What each row limits, in the order of `at`.
    pub fn rows(&self) -> &[DriveLimit] {
        &self.rows
    }

    /// How many drives have a limit on speed.
    pub(super) fn speeds(&self) -> usize {
        self.quick.len()
    }

    /// The limits they come from.
    pub fn limits(&self) -> &Limits {
        self.limits
    }

    /// Where the motors sit whose limits these are.
    pub fn motors(&self) -> &Motors {
        self.model.motors()
    }

    /// Whether the rows on a straight joint line are the same all along.
    pub fn is_constant(&self) -> bool {
        self.constant.is_some()
    }

    /// The rows at a point of a path, as many as [`rows`](Self::rows), the speeds of drives at ṡ = 1 as parts of their
    /// limits, as many as [`speeds`](Self::speeds), and the greatest x that speeds allow, 1/s².
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
            let (h, _) = mass_matrix(self.model, &e, first);
            let motors = self.model.motors();
            let a = motors.torques(&h.times(first));
            let c = motors.torques(&inverse(self.model, &e, first, second, &Surroundings::default()));
            let g = motors.torques(&holding_torque(self.model, &e, &self.around));
            let (first, second) = (motors.turns(first), motors.turns(second));
            for (row, limit) in rows.iter_mut().zip(&self.rows) {
                let k = limit.drive;
                let per = 1.0 / self.limits.on(limit.quantity)[k];
                *row = match limit.quantity {
                    LimitedQuantity::Torque => ConstraintRow { a: per * a[k], c: per * c[k], g: per * g[k] },
                    _ => ConstraintRow { a: per * first[k], c: per * second[k], g: 0.0 },
                };
            }
        }
        if self.quick.is_empty() {
            return f64::INFINITY;
        }
        let first = self.model.motors().turns(first);
        speeds.iter_mut().zip(&self.quick).for_each(|(speed, k)| *speed = first[*k].abs() / self.limits.speed[*k]);
        let slow = speeds.iter().copied().fold(0.0, f64::max);
        1.0 / (slow * slow)
    }

    /// The factors on time with which a place on a path, passed so, just keeps each limit but those on jerk.
    pub(super) fn stretches(&self, path: &Path, at: &Progress) -> Stretches {
        let (mut rows, mut speeds) = ([ConstraintRow::default(); MAX_ROWS], [0.0; MAX_DRIVES]);
        let (rows, speeds) = (&mut rows[..self.rows.len()], &mut speeds[..self.quick.len()]);
        self.at(&path.at(at.s), rows, speeds);
        stretches(rows, speeds, at)
    }

    /// The drive whose limit on speed is nearest, whatever ṡ.
    pub(super) fn fastest_drive(&self, point: &PathPoint) -> usize {
        let first = self.model.motors().turns(&point.first);
        let part = |k: usize| first[k].abs() / self.limits.speed[k];
        (0..first.len()).max_by(|k, l| part(*k).total_cmp(&part(*l))).unwrap_or(0)
    }
}
