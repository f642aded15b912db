//! The plant: how the machine that moves differs from the one that control believes in, and what it stands on.
//!
//! A [`Plant`] says what differs, a [`Base`] what the machine stands on, a [`Wheel`] what else turns there: plain data,
//! as files and edits state it. A [`Body`] is what all of it comes to: constants of everything that moves.

mod base;
mod body;
mod differences;
mod each;
mod friction;
mod load;
mod state;
mod wheel;

pub use base::{Base, BaseKind};
pub use body::Body;
pub use differences::{Deviation, MAX_PAYLOAD, Plant};
pub use each::Each;
pub(crate) use each::is_default;
pub use friction::{Contacts, Friction, Grip, MAX_CONTACTS};
pub use load::Load;
pub use state::{Command, Slope, State};
pub use wheel::{Spin, Wheel};
