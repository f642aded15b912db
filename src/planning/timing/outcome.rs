//! Result of a search for the fastest motion.

use thiserror::Error;

use super::limits::DriveLimit;
use super::profile::Profile;

/// The fastest motion on a path.
#[derive(Clone, Debug, PartialEq)]
pub struct FastestMotion {
    /// Timing of the motion.
    pub profile: Profile,
    /// T/T* − 1, where T* is the least time without limits on jerk: an upper bound of the relative gain of a better
    /// motion. `None` unless jerk is limited and other limits act as well.
    pub gap: Option<f64>,
    /// Each limit with the fraction of T during which its utilisation is the highest of all, the greatest fraction
    /// first.
    pub active_limits: Vec<(DriveLimit, f64)>,
}

/// Why no fastest motion exists.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TimeError {
    /// No limit acts on the motion.
    #[error(
        "no limit acts on the motion at s = {s:.3}: want torque, speed or acceleration limits of the drives that move"
    )]
    Unlimited {
        /// s on the path, 0 to 1.
        s: f64,
    },
    /// Only speeds are limited.
    #[error("only speeds are limited, and the motion would jump to them: want torque or acceleration limits too")]
    SpeedOnly,
    /// Jerk should be limited, but no drive that moves has a limit on it.
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
        /// Number of the drive, counted from 1.
        drive: usize,
        /// s on the path, 0 to 1.
        s: f64,
        /// Torque needed at rest, N m.
        torque: f64,
        /// Torque limit, N m.
        limit: f64,
    },
    /// No rate keeps the limits.
    #[error("the limits leave no way past s = {s:.3}: want higher limits, or a path elsewhere")]
    Stuck {
        /// s on the path, 0 to 1.
        s: f64,
    },
    /// The stations do not rise from 0 to 1.
    #[error("the stations do not rise from 0 to 1: want two or more that do")]
    Stations,
    /// Different numbers of drives.
    #[error("a path of {path} drives, a model of {model} and limits of {limits}: want one number of drives")]
    Drives {
        /// Number of drives of the path.
        path: usize,
        /// Number of drives of the model.
        model: usize,
        /// Number of drives of the limits.
        limits: usize,
    },
}
