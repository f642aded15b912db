//! [`OrbitMotion`] and [`OrbitBase`]: what is measured in orbit, and on which base.

use std::f64::consts::{PI, TAU};

use crate::trim::error::TrimError;
use crate::trim::next_excitation::Sines;
use stillbase_mechanics::arm_on_base::FloatingBase;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::PerDrive;
use stillbase_simulation::plant::Base;
use stillbase_simulation::signal_table::SignalTable;

pub(super) const DEGREE: f64 = PI / 180.0;
/// One turn in a minute, rad/s.
pub(super) const RPM: f64 = TAU / 60.0;
/// The signal that only a measurement in orbit has.
pub const BASE_RATE: &str = "attitude_rate/base";
/// Units of angles and of rates, the usual one first, with the factor to it.
const ANGLE: &[(&str, f64)] = &[("rad", 1.0), ("deg", DEGREE), ("°", DEGREE)];
const RATE: &[(&str, f64)] = &[("rad/s", 1.0), ("deg/s", DEGREE), ("°/s", DEGREE), ("rpm", RPM)];

/// Maximum number of rows by which explanations are compared: they need few.
const MAX_TRIED_ROWS: usize = 3000;

/// Samples of one motion in orbit. All lists have one entry per time.
#[derive(Clone, Debug, PartialEq)]
pub struct OrbitMotion {
    /// Time, s.
    pub t: Vec<f64>,
    /// Angle of the base, rad.
    pub attitude: Vec<f64>,
    /// Angles of the drives relative to the base, rad.
    pub angles: Vec<PerDrive>,
    /// Rates of the drives relative to the base, rad/s.
    pub rates: Vec<PerDrive>,
    /// Rate of the base, rad/s.
    pub base_rate: Vec<f64>,
    /// Absolute rate of the reaction wheel, rad/s; 0 without one.
    pub wheel_rate: Vec<f64>,
}

/// The known base of a machine in orbit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitBase {
    /// Mass, inertia and centre of mass.
    pub body: FloatingBase,
    /// Inertia of a reaction wheel, kg m²; 0 without one.
    pub wheel: f64,
}

/// Returns all values plus one number.
pub(super) fn raised(of: &PerDrive, by: f64) -> PerDrive {
    PerDrive::from_fn(of.len(), |k| of[k] + by)
}

impl OrbitBase {
    /// Returns the base of a scenario, which floats.
    pub fn of(base: &Base) -> Self {
        Self { body: base.body(), wheel: base.wheel.map_or(0.0, |wheel| wheel.inertia) }
    }
}

impl OrbitMotion {
    /// Returns the number of rows.
    pub fn rows(&self) -> usize {
        self.base_rate.len()
    }

    /// Returns the duration, s.
    pub fn duration(&self) -> f64 {
        self.t.first().zip(self.t.last()).map_or(0.0, |(first, last)| last - first)
    }

    /// Returns a motion from rest in which the joints swing, on a base whose rate is not yet known.
    pub(super) fn swung(sines: &Sines, duration: f64) -> Self {
        let t: Vec<f64> = Sines::instants(duration).collect();
        let states: Vec<[PerDrive; 3]> = t.iter().map(|t| sines.at(*t)).collect();
        let zeros = vec![0.0; t.len()];
        Self {
            angles: states.iter().map(|[q, ..]| *q).collect(),
            rates: states.iter().map(|[_, qd, _]| *qd).collect(),
            attitude: zeros.clone(),
            base_rate: zeros.clone(),
            wheel_rate: zeros,
            t,
        }
    }

    /// Returns motions with at most about [`MAX_TRIED_ROWS`] rows in all, evenly spaced.
    pub(super) fn thinned(motions: &[Self]) -> Vec<Self> {
        let stride = motions.iter().map(Self::rows).sum::<usize>().div_ceil(MAX_TRIED_ROWS);
        motions.iter().map(|motion| motion.every(stride)).collect()
    }

    /// Returns every `stride`-th row.
    fn every(&self, stride: usize) -> Self {
        fn thin<T: Clone>(all: &[T], stride: usize) -> Vec<T> {
            all.iter().step_by(stride.max(1)).cloned().collect()
        }
        Self {
            t: thin(&self.t, stride),
            attitude: thin(&self.attitude, stride),
            angles: thin(&self.angles, stride),
            rates: thin(&self.rates, stride),
            base_rate: thin(&self.base_rate, stride),
            wheel_rate: thin(&self.wheel_rate, stride),
        }
    }

    /// Returns an error if its lists have different lengths, are empty, or are of other drives.
    ///
    /// # Errors
    /// As said.
    pub(super) fn check(&self, motion: usize, drives: usize) -> Result<(), TrimError> {
        let n = self.base_rate.len();
        let lengths = [self.t.len(), self.attitude.len(), self.angles.len(), self.rates.len(), self.wheel_rate.len()];
        if n == 0 || lengths.iter().any(|own| *own != n) {
            let what = "lists of different lengths, or none: want one entry for each time";
            return Err(TrimError::Motion { motion, what });
        }
        match self.angles.iter().chain(&self.rates).map(|x| x.len()).find(|got| *got != drives) {
            Some(got) => Err(TrimError::Drives { got, want: drives }),
            None => Ok(()),
        }
    }

    /// Reads a motion from signals as a simulation records them: `angle/…` and `rate/…` of every drive,
    /// `attitude/base`, `attitude_rate/base`, and `wheel/rate` if there is a wheel. Units may be `deg`, `deg/s` and `rpm`, too.
    ///
    /// # Errors
    /// If a signal is missing, has another unit, or is not a number throughout.
    pub fn of(machine: &Machine, table: &SignalTable) -> Result<Self, TrimError> {
        machine.check_all_turn("trims")?;
        let column = |path: String, units: &'static [(&'static str, f64)]| -> Result<Vec<f64>, TrimError> {
            let Some(column) = table.column(&path) else { return Err(TrimError::Signal { path }) };
            let unit = Some(column.unit.as_str()).filter(|unit| !unit.is_empty()).unwrap_or(units[0].0);
            let Some((_, factor)) = units.iter().find(|(name, _)| *name == unit) else {
                return Err(TrimError::SignalUnit { path, unit: unit.to_owned(), want: units[0].0 });
            };
            match column.values.iter().position(|x| !x.is_finite()) {
                None => Ok(column.values.iter().map(|x| factor * x).collect()),
                Some(row) => Err(TrimError::SignalRow { path, row: row + 1 }),
            }
        };
        let drives = || machine.spec().drives.iter().map(|drive| drive.name.as_str());
        let each = |what: &str, units| {
            drives().map(|name| column(format!("{what}/{name}"), units)).collect::<Result<Vec<_>, _>>()
        };
        let (angles, rates) = (each("angle", ANGLE)?, each("rate", RATE)?);
        let (attitude, base_rate) = (column("attitude/base".into(), ANGLE)?, column(BASE_RATE.into(), RATE)?);
        let wheel = "wheel/rate";
        let wheel = table.column(wheel).map_or(Ok(None), |_| column(wheel.into(), RATE).map(Some))?;
        let less = |of: &[Vec<f64>], base: &[f64]| -> Vec<PerDrive> {
            base.iter().enumerate().map(|(i, base)| PerDrive::from_fn(of.len(), |k| of[k][i] - base)).collect()
        };
        Ok(Self {
            t: table.time.clone(),
            angles: less(&angles, &attitude),
            rates: less(&rates, &base_rate),
            wheel_rate: wheel.unwrap_or_else(|| vec![0.0; base_rate.len()]),
            attitude,
            base_rate,
        })
    }
}
