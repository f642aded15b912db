//! [`Refusal`]: the reason why a scenario cannot start, or an edit cannot apply.

use thiserror::Error;

use crate::scenario::{MAX_FRAMES, MAX_STEPS, MAX_TIME, SettingError, UnfinishedDrawing, ordinal, with_name};
use stillbase_mechanics::machine::MachineError;
use stillbase_mechanics::sketch::SketchRefusal;
use stillbase_planning::curves::{CurveError, PathError};
use stillbase_planning::following::Blocked;
use stillbase_planning::off_plane::drift::DriftError;
use stillbase_planning::off_plane::least_reaction::LeastReactionError;
use stillbase_planning::off_plane::price::PriceError;
use stillbase_planning::off_plane::turning_loop::NoLoop;
use stillbase_planning::pose_constant::{NoCommonB, Unreachable};
use stillbase_planning::pose_space::{NoPoseSpace, PlaneError};
use stillbase_planning::reactionless::Decimal;
use stillbase_planning::timing::TimeError;
use stillbase_settings::number::ShortNumber;
use stillbase_settings::range::{RangeCheck, Requirement, range_error};

/// Reason why a scenario cannot start or an edit cannot apply; in either case nothing has changed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Refusal {
    /// The machine has no reactionless planes of the kind the task needs.
    #[error(transparent)]
    NoPlanes(#[from] PlaneError),
    /// The machine has no b at all.
    #[error(transparent)]
    NoPoseConstant(#[from] NoPoseSpace),
    /// A point cannot be reached at its b, or at any b.
    #[error("{point} {unreachable}")]
    Unreachable {
        /// `A`, `1`, `2` … `B`.
        point: String,
        /// Reason, and values of b that reach the point.
        #[source]
        unreachable: Unreachable,
    },
    /// No b reaches all points.
    #[error("{message}")]
    NoCommonPlane {
        /// Message with the names of the points.
        message: String,
        /// Reason, and the change that would help.
        why: NoCommonB,
    },
    /// The task of another block of the assembly is refused.
    #[error("block {block}: {why}")]
    OfBlock {
        /// Name of the block.
        block: String,
        /// Reason.
        #[source]
        why: Box<Refusal>,
    },
    /// What all blocks of an assembly share does not serve.
    #[error("{0}")]
    OfAssembly(String),
    /// The path cannot be made.
    #[error(transparent)]
    Path(#[from] PathError),
    /// The points give no curve.
    #[error(transparent)]
    Curve(#[from] CurveError),
    /// The curve cannot be followed on the plane.
    #[error(transparent)]
    Blocked(#[from] Box<Blocked>),
    /// Settings of the task contradict each other or do not fit the machine.
    #[error("{0}")]
    Task(String),
    /// The settings are consistent, but no motion satisfies them.
    #[error("{0}")]
    NoWay(String),
    /// The reaction of a change of b is not defined.
    #[error(transparent)]
    Price(#[from] PriceError),
    /// The redundancy cannot be resolved with the least reaction.
    #[error(transparent)]
    LeastReaction(#[from] LeastReactionError),
    /// The end effector's curve cannot be followed at zero momentum.
    #[error(transparent)]
    Drift(#[from] DriftError),
    /// The curve can be followed if a free base may turn farther.
    #[error("{}, or task.turn_limit = {}, in degrees: with least momentum the base turns by that much", stop_in_words(stopped.as_ref()), ShortNumber(*turn_limit))]
    Turns {
        /// Where zero momentum leads no farther; `None` for two drives, which turn the base all along.
        #[source]
        stopped: Option<DriftError>,
        /// The turn limit that would do, °.
        turn_limit: f64,
    },
    /// No closed motion of the arm turns the base as wanted.
    #[error("{why}{}", cycles.map_or_else(String::new, |cycles| format!(": want task.cycles = {cycles}, or a smaller task.base_turn")))]
    Loop {
        /// Why not.
        #[source]
        why: NoLoop,
        /// Number of loops that together do.
        cycles: Option<u32>,
    },
    /// The fastest motion cannot be found.
    #[error(transparent)]
    Time(#[from] TimeError),
    /// The machine would not be valid.
    #[error(transparent)]
    Machine(#[from] MachineError),
    /// A step of drawing does not fit the drawing.
    #[error(transparent)]
    Sketch(#[from] SketchRefusal),
    /// The drawing is no machine yet.
    #[error(transparent)]
    Unfinished(#[from] UnfinishedDrawing),
    /// The simulation diverges.
    #[error(
        "the simulation diverges at {time:.3} s: want smaller gains, a smaller step, a lighter payload, or softer springs, dampers and \
             friction"
    )]
    Diverged {
        /// Time of divergence, s.
        time: f64,
    },
    /// An audit of the run has failed.
    #[error("audit failed: {why}; want a smaller step")]
    Untrusted {
        /// Audit that failed, and by how much.
        why: String,
    },
    /// The motion in progress does not fit into new limits.
    #[error("the motion in progress would leave {key} = {value}: want wider limits, or set them at its start")]
    LeavesLimits {
        /// Key of the limit.
        key: String,
        /// The value that was given.
        value: String,
    },
    /// A number out of range.
    #[error("{}", range_error(&with_name(what), *value, want))]
    OutOfRange {
        /// Key of the number.
        what: String,
        /// The value that was given.
        value: f64,
        /// Allowed values.
        want: Requirement,
    },
    /// The motion takes longer than the maximum.
    #[error("the motion would take {}: want at most {MAX_TIME} s, with higher limits or a shorter way", seconds(*time))]
    TooLong {
        /// Duration of the motion, s.
        time: f64,
    },
    /// The run has more steps than the maximum.
    #[error("{} s in steps of {} s are {steps} steps: want at most {MAX_STEPS}, with longer steps or a shorter duration", ShortNumber(*time), ShortNumber(*step))]
    TooManySteps {
        /// Duration of the run, s.
        time: f64,
        /// Step size, s.
        step: f64,
        /// Steps of the run.
        steps: u64,
    },
    /// The session contains the maximum number of frames, or has reached the maximum time.
    #[error(
        "a session keeps {MAX_FRAMES} frames and an hour at most, and this one is full at {time:.3} s: want to go on \
         from an earlier instant or from the start; `simulate` and `headless` run longer"
    )]
    Full {
        /// Time of the newest frame, s.
        time: f64,
    },
    /// The output would be too large.
    #[error(
        "{rows} rows of {columns} numbers are up to {:.1} GB: want at most {:.0} GB, with fewer rows or a shorter duration",
        bytes / 1e9, most / 1e9
    )]
    TooLarge {
        /// Rows that would be written.
        rows: u64,
        /// Numbers in each row.
        columns: usize,
        /// Upper bound of the size, bytes.
        bytes: f64,
        /// Maximum size, bytes.
        most: f64,
    },
    /// The caller has cancelled the work.
    #[error("stopped before its end: nothing has changed")]
    Stopped,
    /// An edit of a scenario cannot apply.
    #[error("the {} [[edit]], {title} at step {step}: {refusal}", ordinal(*entry))]
    Edit {
        /// Number of the edit, counted from 1 in the order of the file.
        entry: usize,
        /// The step at which it applies.
        step: u64,
        /// Description of the edit.
        title: String,
        /// Reason why the edit cannot apply.
        #[source]
        refusal: Box<Refusal>,
    },
}

/// Formats a time, s, for a message.
fn seconds(time: f64) -> String {
    if time < 1e9 { format!("{time:.0} s") } else { "more than 1e9 s".into() }
}

/// Checks a duration, s, that the planner has found against the maximum duration of a run.
///
/// # Errors
/// If it is longer than [`MAX_TIME`], or not a number.
pub(super) fn check_time(time: f64) -> Result<(), Refusal> {
    if time <= MAX_TIME { Ok(()) } else { Err(Refusal::TooLong { time }) }
}

impl From<RangeCheck> for Refusal {
    fn from(RangeCheck { key, value, want, .. }: RangeCheck) -> Self {
        Self::OutOfRange { what: key.into(), value, want }
    }
}

impl Refusal {
    /// Returns the feasible pose constant nearest to the present one, rad, if a change of b alone would help.
    pub fn feasible_b(&self) -> Option<f64> {
        match self {
            Self::Edit { refusal, .. } => refusal.feasible_b(),
            Self::Blocked(blocked) => blocked.nearest_b,
            Self::Unreachable { unreachable: Unreachable::OnThisPlane { nearest_b, .. }, .. } => *nearest_b,
            _ => None,
        }
    }

    /// Returns the b of [`feasible_b`](Self::feasible_b), rounded for display so that it is still feasible.
    pub fn displayed_b(&self) -> Option<Decimal> {
        match self {
            Self::Edit { refusal, .. } => refusal.displayed_b(),
            Self::Blocked(blocked) => blocked.displayed_b,
            Self::Unreachable { unreachable: Unreachable::OnThisPlane { displayed_b, .. }, .. } => *displayed_b,
            _ => None,
        }
    }
}

impl From<SettingError> for Refusal {
    fn from(error: SettingError) -> Self {
        match error {
            SettingError::Machine(error) => error.into(),
            other => Self::Task(other.to_string()),
        }
    }
}

/// Says why a free base has to turn.
fn stop_in_words(stopped: Option<&DriftError>) -> String {
    let only =
        || "two drives follow this path in one way, which turns the base farther: want another path or start".into();
    stopped.map_or_else(only, ToString::to_string)
}
