//! Errors of a study of tolerances.

use thiserror::Error;

use stillbase_mechanics::machine::MachineError;

/// Reason that a study of tolerances cannot be made.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ToleranceError {
    /// A key names no parameter of the machine.
    #[error(
        "no number {key:?} that could vary: want link.NAME.(com|com_normal|mass|inertia), length.NAME, payload.mass or \
         payload.inertia, with names of this machine or *"
    )]
    UnknownKey {
        /// The key.
        key: String,
    },
    /// A spread is stated in percent of a nominal value of zero.
    #[error("{key} is 0, and percent of 0 is nothing: want a spread in its own unit")]
    PercentOfZero {
        /// The key.
        key: String,
    },
    /// Every spread is zero.
    #[error("nothing varies: want a spread above 0")]
    NothingVaries,
    /// Too large a fraction of the distribution is physically impossible.
    #[error(
        "{:.0} % of {key} = {nominal} {unit} with this spread lie below 0: want 10 % at most, with a smaller spread or a \
         larger nominal value", 100.0 * cut
    )]
    Impossible {
        /// The key.
        key: String,
        /// Nominal value.
        nominal: f64,
        /// Unit of the value.
        unit: &'static str,
        /// Fraction of the distribution that is impossible.
        cut: f64,
    },
    /// The spread allows values beyond the range of a machine's numbers.
    #[error("{key} with a spread of {scale} {unit} could pass 1000000: want a smaller spread")]
    TooWide {
        /// The key.
        key: String,
        /// Standard deviation or half-width.
        scale: f64,
        /// Unit of the value.
        unit: &'static str,
    },
    /// A varied machine is not valid, for example because a loop closure fixes the varied length.
    #[error("a varied machine would not be valid: {0}")]
    Machine(#[source] MachineError),
}
