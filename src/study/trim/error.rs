//! Errors in the evaluation of measurements.

use stillbase_mechanics::machine::MachineError;
use thiserror::Error;

use stillbase_settings::number::{counted, fixed, significant};

/// Reason that a measurement cannot be evaluated.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TrimError {
    /// The machine has links that keep their orientation.
    #[error(transparent)]
    Machine(#[from] MachineError),
    /// The number of measured drives differs from that of the machine.
    #[error("angles of {}: want those of all {want} of the machine", counted(got, "drive"))]
    Drives {
        /// Number of drives measured.
        got: usize,
        /// Number of drives of the machine.
        want: usize,
    },
    /// A motion has columns of different lengths, no rows, times that do not increase, or values that are not finite.
    #[error("motion {}: {what}", motion + 1)]
    Motion {
        /// Index of the motion, from 0.
        motion: usize,
        /// The error, and the accepted input.
        what: &'static str,
    },
    /// Too few rows for the unknowns.
    #[error(
        "{} for {} that have to be found: want more, ten for each or better",
        counted(rows, "row"),
        counted(unknowns, "number")
    )]
    TooFew {
        /// Number of rows.
        rows: usize,
        /// Number of unknowns.
        unknowns: usize,
    },
    /// A motion is too short for the windows over which rows are averaged.
    #[error(
        "motion {} has {} in {} s: want at least {want} without measured rates and accelerations", motion + 1,
        counted(rows, "row"), fixed(*time, 6)
    )]
    Short {
        /// Index of the motion, from 0.
        motion: usize,
        /// Number of rows.
        rows: usize,
        /// Duration, s.
        time: f64,
        /// Minimum number of rows.
        want: usize,
    },
    /// A value of a signal of a motion in orbit is not a number.
    #[error("{path}: no number in row {row} below the head: want numbers throughout")]
    SignalRow {
        /// Path of the signal.
        path: String,
        /// Row, from 1.
        row: usize,
    },
    /// A rate is the same in all rows, though its angle changes.
    #[error(
        "motion {}: {path} is {} rad/s in every row, but its angle changes by {} rad/s rms: want the measured rate",
        motion + 1, fixed(*value, 6), fixed(*by_angle, 6)
    )]
    DeadSignal {
        /// Index of the motion, from 0.
        motion: usize,
        /// Path of the rate.
        path: String,
        /// Its value, rad/s.
        value: f64,
        /// Root mean square rate by its angle, rad/s.
        by_angle: f64,
    },
    /// An angle is the same in all rows, though its rate is not zero.
    #[error(
        "motion {}: {angle} is the same in every row, but {rate} is {} rad/s rms: want the measured angle",
        motion + 1, fixed(*size, 6)
    )]
    DeadAngle {
        /// Index of the motion, from 0.
        motion: usize,
        /// Path of the angle.
        angle: String,
        /// Path of the rate.
        rate: String,
        /// Root mean square of the rate, rad/s.
        size: f64,
    },
    /// A rate is not that of its angle.
    #[error("motion {}: {rate} is not the rate of {angle}: {}; want the rate of this angle", motion + 1, rate_words(*factor, *off))]
    RateOfAngle {
        /// Index of the motion, from 0.
        motion: usize,
        /// Path of the angle.
        angle: String,
        /// Path of the rate.
        rate: String,
        /// The rate is as many times that of the angle, if a factor explains it.
        factor: Option<f64>,
        /// Root mean square difference between the angle and the integrated rate, rad.
        off: f64,
    },
    /// All rates are those of their angles times a factor.
    #[error(
        "motion {}: every rate is {} times that of its angle over the time: want {}", motion + 1, significant(*factor),
        time_words(*factor)
    )]
    WrongTime {
        /// Index of the motion, from 0.
        motion: usize,
        /// The factor.
        factor: f64,
    },
    /// The base does not turn, though the arm turns it.
    #[error(
        "motion {}: the base does not turn, but by the machine's file the arm turns it by {} rad/s rms: want the rate of a \
         base that floats, or `trim` with forces and moments if it is held", motion + 1, fixed(*by_file, 6)
    )]
    StillBase {
        /// Index of the motion, from 0.
        motion: usize,
        /// Root mean square rate by the machine's file, rad/s.
        by_file: f64,
    },
    /// A signal of a motion in orbit is missing.
    #[error(
        "no numbers of {path}: want angle and rate of every drive, attitude/base and attitude_rate/base, as simulate \
         writes them"
    )]
    Signal {
        /// Path of the signal.
        path: String,
    },
    /// A signal of a motion in orbit has another unit.
    #[error("{path}: unit {unit:?}: want {want}, or degrees for radians")]
    SignalUnit {
        /// Path of the signal.
        path: String,
        /// Its unit.
        unit: String,
        /// The expected unit.
        want: &'static str,
    },
    /// A reaction wheel turns that the base does not have.
    #[error(
        "a wheel turns by up to {} rad/s, but the base has none: want its inertia as base.wheel.inertia of the scenario",
        fixed(*rate, 3)
    )]
    NoWheel {
        /// Largest rate of the wheel, rad/s.
        rate: f64,
    },
    /// No drive moves.
    #[error("no drive moves in it: want motions in which each does")]
    Still,
    /// The residuals are so strongly correlated that no interval can be stated.
    #[error(
        "the residuals vary as slowly as the motions themselves: they count as {} independent rows for {} \
         that have to be found; want more or longer motions", fixed(*effective, 1), counted(unknowns, "number")
    )]
    Correlated {
        /// Effective number of independent rows.
        effective: f64,
        /// Number of parameters to fit.
        unknowns: usize,
    },
    /// A result is not finite.
    #[error("numbers so large or so far apart that nothing can be computed with them: want SI units")]
    NotFinite,
}

/// Returns in words what makes all rates too large or too small by a factor.
fn time_words(factor: f64) -> &'static str {
    let is_near = |other: f64| (factor / other - 1.0).abs() < 0.05;
    match () {
        () if is_near(1e3) => "the time in s, not in ms",
        () if is_near(1e6) => "the time in s, not in µs",
        () if is_near(180.0 / std::f64::consts::PI) => "rates in rad/s, not in deg/s, or this unit in their headers",
        () if is_near(std::f64::consts::PI / 180.0) => "angles in rad, not in deg, or this unit in their headers",
        () => "the time in s, angles in rad and rates in rad/s",
    }
}

/// Returns in words how a rate differs from that of its angle.
fn rate_words(factor: Option<f64>, off: f64) -> String {
    match factor {
        Some(factor) => format!("it is {} times that", significant(factor)),
        None => format!("integrated, it differs from the angle by {} rad rms", fixed(off, 4)),
    }
}
