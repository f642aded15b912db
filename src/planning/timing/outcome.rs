//! What a search for the fastest motion comes to.

use thiserror::Error;

use super::limits::DriveLimit;
use super::profile::Profile;

/// The fastest motion on a path.
#[derive(Clone, Debug, PartialEq)]
pub struct Fastest {
    /// When it is where.
    pub profile: Profile,
    /// T/T* − 1, T* the least time without limits on jerk: a bound on what a better motion with them could gain. Only
    /// where jerk was to be limited, and something besides it limits.
    pub gap: Option<f64>,
    /// Which limits lead, for what share of T, the greatest share first.
    pub limiting: Vec<(DriveLimit, f64)>,
}

/// Why there is no fastest motion.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TimeError {
    /// Nothing limits.
    #[error(
        "no limit acts on the motion at s = {s:.3}: want torque, speed or acceleration limits of the drives that move"
    )]
    Unlimited {
        /// How far along.
        s: f64,
    },
    /// Only speeds are limited.
    #[error("only speeds are limited, and the motion would jump to them: want torque or acceleration limits too")]
    SpeedOnly,
    /// Jerk was to be limited.
    #[error(
        "no drive that moves has a limit on its jerk: want jerk_limit of a drive, such as drive.1.jerk_limit=900, or the law without it"
    )]
    NoJerkLimit,
    /// A drive cannot hold the machine up.
    #[error(
        "drive {drive} needs {torque:.3} N m to hold still at s = {s:.3} and has {limit}: want a higher torque limit, \
         or a path elsewhere"
    )]
    Static {
        /// Counted from 1.
        drive: usize,
        /// How far along.
        s: f64,
        /// N m.
        torque: f64,
        /// N m.
        limit: f64,
    },
    /// No rate is right.
    #[error("the limits leave no way past s = {s:.3}: want higher limits, or a path elsewhere")]
    Stuck {
        /// How far along.
        s: f64,
    },
    /// The stations do not rise from 0 to 1.
    #[error("the stations do not rise from 0 to 1: want two or more that do")]
    Stations,
    /// Unlike numbers of drives.
    #[error("a path of {path} drives, a model of {model} and limits of {limits}: want one number of drives")]
    Drives {
        /// Of the path.
        path: usize,
        /// Of the model.
        model: usize,
        /// Of the limits.
        limits: usize,
    },
}
