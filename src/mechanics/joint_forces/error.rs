//! [`JointsError`]: the reason why the forces of pins cannot be computed.

use thiserror::Error;

use super::pins::MAX_PINS;
use stillbase_settings::number::counted;

/// Reason why the forces of a machine's pins cannot be computed.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum JointsError {
    /// More than [`MAX_PINS`] pins.
    #[error("{count} pins: want at most {MAX_PINS}")]
    TooMany {
        /// Pins of the machine.
        count: usize,
    },
    /// A drive has no link at the base, and it is not clear which of several links it turns.
    #[error(
        "drive {drive} has no link at the base, and links {links} follow it: want one link on \"base\", or one link only, so \
         that it is known which one it turns"
    )]
    Unattached {
        /// The drive.
        drive: String,
        /// The links that follow it.
        links: String,
    },
    /// A motor on an undriven link of a loop turns a link of another loop.
    #[error(
        "the motor of drive {drive} sits on a link of a loop and turns another loop: want it on a link that a drive \
         turns, for forces of pins to be computed one loop after another"
    )]
    MotorInLoop {
        /// The drive.
        drive: String,
    },
    /// Too few closures to determine the orientation of all links.
    #[error(
        "{} that no drive turns, and {}, which hold the orientation of two each; nothing holds {loose}: want {}",
        counted(links, "link"),
        counted(closures, "closure"),
        counted(wanted, "closure")
    )]
    Missing {
        /// Number of links that no drive turns.
        links: usize,
        /// Number of closures.
        closures: usize,
        /// The links that are in no loop; if all are in loops, the links among which a closure is missing.
        loose: String,
        /// Required number of closures, in words.
        wanted: String,
    },
    /// There are more closures than are needed to determine the orientation of all links.
    #[error(
        "{}, which hold the orientation of two links each, and {} that no drive turns: want {}, as redundant ones \
         share their force in a way that only the links' elasticity decides",
        counted(closures, "closure"),
        counted(links, "link"),
        counted(wanted, "closure")
    )]
    Redundant {
        /// Number of closures.
        closures: usize,
        /// Number of links that no drive turns.
        links: usize,
        /// Required number of closures, in words.
        wanted: String,
    },
    /// Closures are redundant in one place and missing in another.
    #[error(
        "closures {closures} do not hold the orientation of links {links} in any pose: want one for each parallelogram, \
         where now one has too many and another none"
    )]
    Misplaced {
        /// Names of the pins that close the loops.
        closures: String,
        /// Names of the links.
        links: String,
    },
}
