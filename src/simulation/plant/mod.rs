//! The plant: its differences from the model of control, and its base.
//!
//! [`PlantDifferences`], [`Base`] and [`Wheel`] (a reaction wheel) are plain data, as in files and edits. A
//! [`MovingBody`] contains the constants of all moving parts, computed from these data.

mod base;
mod differences;
mod each;
mod friction;
mod held_torque;
mod load;
mod moving_body;
mod stage;
mod state;
mod wheel;

pub use base::{Base, BaseKind};
pub use differences::{LENGTH_KEYS, LinkDifference, PlantDifferences};
pub use each::DriveValues;
pub use friction::{Contacts, Friction, FrictionTorques, MAX_CONTACTS, SlipDirections};
pub use held_torque::EqualSteps;
pub use load::{Load, MAX_PAYLOAD};
pub use moving_body::MovingBody;
pub(crate) use stage::{Actuation, ReducedState, RungeKuttaStage, StateRates};
pub use state::{Slope, State};
pub use wheel::{Wheel, WheelState};
