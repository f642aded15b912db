//! Sessions: a scenario, the user's edits and the run that results from them; undo, replay, the verdict on a run.
//!
//! Others reach this crate as `stillbase::session`; `stillbase` alone follows semantic versioning.

pub mod assembly;
mod base_forecast;
mod changes;
mod changes_made;
mod command_line;
pub mod design;
mod designs;
mod document;
mod edit;
mod edit_check;
pub mod events;
mod fork;
mod gentle_motion;
mod interactive;
mod machines;
mod older;
mod other_frames;
pub mod parts;
mod planner;
mod proposal;
mod refusal;
mod replay;
mod run;
mod run_ahead;
pub mod scenario;
mod script;
mod shared_task;
pub mod verdict;
mod waypoints;
mod whole_frame;

pub use base_forecast::base_forecast;
#[doc(hidden)]
pub use changes_made::ChangesMade;
pub use command_line::{row_options, session_command, simulate_command};
#[doc(hidden)]
pub use designs::{DesignVersion, designs};
pub use document::ProgressCallback;
pub use edit::{Edit, TimedEdit};
pub(crate) use edit_check::check_edits;
#[doc(hidden)]
pub use fork::Fork;
pub use gentle_motion::{for_machine, for_template, gentle_motion, gentle_motion_afloat, with_own_task};
pub use interactive::Session;
#[doc(hidden)]
pub use machines::Machines;
#[doc(hidden)]
pub use other_frames::OtherFrames;
pub use planner::{Plan, arm_on_base, curves};
#[doc(hidden)]
pub use proposal::{
    OutsideLimits, ProposalsQuery, ReachablePoints, RefusedChange, TargetProposals, is_improvable, proposals_while,
};
pub use proposal::{
    Proposal, WayOut, improvements, proposals, proposals_for_machine, proposals_for_settings, proposals_for_values,
};
pub use refusal::Refusal;
pub use replay::{base_loads, replay, replay_if, replay_while, signal_table, with_start_edits};
pub use run::{Run, WaitReason};
#[doc(hidden)]
pub use run_ahead::RunAhead;
pub use shared_task::{SharedTask, straight};
pub use whole_frame::{WholeFrame, signals_of_whole};
