//! Scenarios: a machine, its task, and the edits made while it runs; as TOML files.
//!
//! A saved session is a scenario with `[[edit]]` entries, each with the step at which it applies, with bookmarks,
//! notes and branches.

mod bounds;
mod catalog;
mod choices;
mod definition;
mod design;
mod error;
mod file;
mod kept;
mod keys;
mod machine_file;
mod names;
mod note;
mod own;
mod points;
mod settings;
mod sketched;
mod snap_point;
mod task;
mod tolerance;
pub(crate) mod words;

pub(crate) use bounds::{MAX_FRAMES, ordinal};
pub use bounds::{MAX_STEPS, MAX_TIME, STEP_RANGE};
pub use choices::{Corners, PathShape, ReactionObjective, TaskKind};
pub use definition::Scenario;
pub use design::{DesignBrief, NameSet, to_value};
pub use error::ScenarioError;
pub(crate) use file::read_of_machine;
pub use file::{FileContent, FindMachine, content};
pub use kept::{Bookmark, Branch, MAX_BOOKMARKS, MAX_BRANCHES, MAX_NAME};
pub use keys::{KEYS, key_of, keys, part_of};
pub(crate) use keys::{effect_in, effect_of};
pub use machine_file::MachineFile;
pub(crate) use names::with_name;
pub use names::{name_of, search_words};
pub use note::{MAX_NOTE, MAX_NOTES, Note, NoteTime};
pub(crate) use points::name_of_point;
pub use settings::SettingError;
pub use sketched::UnfinishedDrawing;
pub use snap_point::{PathPoint, SnapPoint};
pub(crate) use task::samples_of_others;
pub use task::{MAX_CYCLES, MAX_POINTS, MOTION_TIME_RANGE, POINT_RANGE, POSE_CONSTANT_RANGE, Task, TaskChange, Value};
pub use tolerance::{Amount, MAX_SAMPLES, Spread, Tolerance, default_spreads};
