//! The plant: how the machine that moves differs from the one that control believes in, and what it stands on.
//!
//! A [`PlantDifferences`] says what differs, a [`Base`] what the machine stands on, a [`Wheel`] what else turns there:
//! plain data, as files and edits state it. A [`MovingBody`] is what all of it comes to: constants of everything that
//! moves.

mod base;
mod differences;
mod each;
mod friction;
mod load;
mod moving_body;
mod stage;
mod state;
mod wheel;

pub use base::{Base, BaseKind};
pub use differences::{LENGTH_KEYS, LinkDifference, PlantDifferences};
pub use each::Each;
pub use friction::{Contacts, Friction, MAX_CONTACTS, SlipDirections};
pub use load::{Load, MAX_PAYLOAD};
pub use moving_body::MovingBody;
pub(crate) use stage::{Command, Point, Rates, Stage};
pub use state::{Slope, State};
pub use wheel::{Wheel, WheelState};
