//! Scenarios: a machine, its task, and the edits made while it runs; as TOML files.
//!
//! A saved session is a scenario with `[[edit]]` entries, each with the step at which it applies, with bookmarks and
//! with branches.

mod bounds;
mod catalog;
mod choices;
mod definition;
mod design;
mod error;
mod file;
mod kept;
mod keys;
mod own;
mod points;
mod settings;
mod task;
mod tolerance;

pub(crate) use bounds::{MAX_FRAMES, ordinal};
pub use bounds::{MAX_STEPS, MAX_TIME, STEP};
pub use choices::{Corners, Least, Shape, TaskKind};
pub use definition::Scenario;
pub use design::{Brief, to_value};
pub use error::ScenarioError;
pub use file::{Content, FindMachine, content};
pub use kept::{Bookmark, Branch, MAX_BOOKMARKS, MAX_BRANCHES, MAX_NAME};
pub use keys::{KEYS, key_of, keys, part_of};
pub(crate) use keys::{effect_in, effect_of};
pub use settings::SettingError;
pub use task::{Change, MAX_POINTS, PLACE, POSE_CONSTANT, TIME, Task, Value};
pub use tolerance::{Amount, MAX_SAMPLES, Spread, Tolerance, default_spreads};
