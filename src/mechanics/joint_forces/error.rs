//! Why the forces of pins cannot be computed.

use thiserror::Error;

use super::pins::MAX_PINS;
use crate::settings::number::counted;

/// Why statics does not determine the forces in a machine.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum JointsError {
    /// More pins than there is room for.
    #[error("{count} pins: want at most {MAX_PINS}")]
    TooMany {
        /// Pins of the machine.
        count: usize,
    },
    /// A drive without a link at B, and several that follow it.
    #[error(
        "drive {drive} has no link at the base, and links {links} follow it: want one link on \"base\", or one link only, so \
         that it is known which one it turns"
    )]
    Unattached {
        /// The drive.
        drive: String,
        /// Who follows it.
        links: String,
    },
    /// A motor on a link of a loop turns links of a loop.
    #[error(
        "the motor of drive {drive} sits on a link of a loop and turns another loop: want it on a link that a drive \
         turns, for forces of pins to be computed one loop after another"
    )]
    MotorInLoop {
        /// The drive.
        drive: String,
    },
    /// Links whose orientation nothing holds.
    #[error(
        "{} that no drive turns, and {}, which hold the orientation of two each; nothing holds {loose}: want {}",
        counted(links, "link"),
        counted(closures, "closure"),
        counted(wanted, "closure")
    )]
    Missing {
        /// How many links no drive turns.
        links: usize,
        /// How many closures there are.
        closures: usize,
        /// The links that are in no loop, or among which one too few is.
        loose: String,
        /// How many closures there should be.
        wanted: String,
    },
    /// More closures than hold links.
    #[error(
        "{}, which hold the orientation of two links each, and {} that no drive turns: want {}, as redundant ones \
         share their force in a way that only the links' elasticity decides",
        counted(closures, "closure"),
        counted(links, "link"),
        counted(wanted, "closure")
    )]
    Redundant {
        /// How many closures there are.
        closures: usize,
        /// How many links no drive turns.
        links: usize,
        /// How many closures there should be.
        wanted: String,
    },
    /// Closures redundant in one place and missing in another.
    #[error(
        "closures {closures} do not hold the orientation of links {links} in any pose: want one for each parallelogram, \
         where now one has too many and another none"
    )]
    Misplaced {
        /// Names of the pins.
        closures: String,
        /// Names of links.
        links: String,
    },
}
