//! Why measurements say nothing.

use thiserror::Error;

use crate::settings::number::{counted, fixed};

/// Why measurements say nothing of a machine.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TrimError {
    /// Angles are of another number of drives.
    #[error("angles of {}: want those of all {want} of the machine", counted(got, "drive"))]
    Drives {
        /// How many are measured.
        got: usize,
        /// How many the machine has.
        want: usize,
    },
    /// A motion has columns of different lengths, none at all, times that do not rise or what is no finite number.
    #[error("motion {}: {what}", motion + 1)]
    Motion {
        /// Which, counted from 0.
        motion: usize,
        /// What is wrong, and what would be right.
        what: &'static str,
    },
    /// Fewer rows than numbers to be found.
    #[error(
        "{} for {} that have to be found: want more, ten for each or better",
        counted(rows, "row"),
        counted(unknowns, "number")
    )]
    TooFew {
        /// Rows, less one for each motion.
        rows: usize,
        /// Unknowns.
        unknowns: usize,
    },
    /// A motion too short to be averaged over windows.
    #[error(
        "motion {} has {} in {} s: want at least {want} without measured rates and accelerations", motion + 1,
        counted(rows, "row"), fixed(*time, 6)
    )]
    Short {
        /// Which, counted from 0.
        motion: usize,
        /// Its rows.
        rows: usize,
        /// s.
        time: f64,
        /// How many would do.
        want: usize,
    },
    /// No drive moves.
    #[error("no drive moves in it: want motions in which each does")]
    Still,
    /// What the model leaves is so correlated that nothing can be said of it.
    #[error(
        "what the machine does not explain is as slow as the motions themselves: it counts as {} independent rows for {} \
         that have to be found; want more or longer motions", fixed(*effective, 1), counted(unknowns, "number")
    )]
    Correlated {
        /// Effective number of independent rows.
        effective: f64,
        /// Unknowns.
        unknowns: usize,
    },
    /// A result that is no number.
    #[error("numbers so large or so far apart that nothing can be computed with them: want SI units")]
    NotFinite,
}
