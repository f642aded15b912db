//! [`Alternative`]: alternative motions for the same task.

use stillbase_planning::pose_space::PoseSpace;
use stillbase_planning::posed::poses_of_points;
use stillbase_planning::timing::TimeLaw;
use stillbase_session::scenario::{PathShape, Scenario, TaskChange, TaskKind, Value};
use stillbase_session::{straight, with_start_edits};
use stillbase_simulation::plant::Wheel;

/// A method of moving the end effector from A to B.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Alternative {
    /// The scenario's own method.
    AsGiven,
    /// Motion on one plane of joint space, without reactions on the base.
    Reactionless,
    /// The end effector on a straight line with minimum-norm rates, as in case 1.
    StraightLine,
    /// Another pose at the end, as in case 2.
    OtherPose,
    /// As [`StraightLine`](Self::StraightLine), with a reaction wheel that takes up the moment within its limits.
    Wheel,
    /// As [`StraightLine`](Self::StraightLine), slower.
    Slowly,
}

/// Factor on the duration for [`Alternative::Slowly`]; forces and moments fall with its square.
pub const SLOW_FACTOR: f64 = 4.0;

/// Wheel of [`Alternative::Wheel`] if the base has none, of the size that a satellite of a few hundred kilograms
/// carries.
fn default_wheel() -> Wheel {
    Wheel { inertia: 0.02, torque_limit: Some(2.0), speed_limit: Some(300.0), ..Wheel::default() }
}

/// Offset of the final angle of drive 1 from its initial one, rad, if the task states no final angle; as in case 2.
const OTHER_POSE_OFFSET_RAD: f64 = -0.2375;

impl Alternative {
    /// All methods.
    pub const ALL: [Self; 6] =
        [Self::AsGiven, Self::Reactionless, Self::StraightLine, Self::OtherPose, Self::Wheel, Self::Slowly];

    /// Returns whether the scenario's machine can use this method: only a redundant machine can take another pose.
    pub fn is_of(self, scenario: &Scenario) -> bool {
        self != Self::OtherPose || scenario.machine.is_redundant()
    }

    /// Returns the short name, as in file names and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::AsGiven => "as-given",
            Self::Reactionless => "reactionless",
            Self::StraightLine => "straight-line",
            Self::OtherPose => "other-pose",
            Self::Wheel => "wheel",
            Self::Slowly => "slowly",
        }
    }

    /// Returns the title.
    pub fn title(self) -> &'static str {
        match self {
            Self::AsGiven => "As given",
            Self::Reactionless => "Reactionless",
            Self::StraightLine => "Straight line",
            Self::OtherPose => "Other pose",
            Self::Wheel => "Reaction wheel",
            Self::Slowly => "Slowly",
        }
    }

    /// Returns the scenario of this method, with the same points, machine, plant, base and control. Except for
    /// [`AsGiven`](Self::AsGiven), only [`Wheel`](Self::Wheel) has a reaction wheel.
    pub fn of(self, scenario: &Scenario) -> Scenario {
        if self == Self::AsGiven {
            return scenario.clone();
        }
        // Edits before the first step belong to the task; later ones would change the run.
        let start = with_start_edits(scenario).map_or_else(|_| scenario.clone(), |(start, _)| start);
        let scenario = &start;
        let mut other = start.clone();
        other.name = format!("{}-{}", scenario.name, self.name());
        other.title = format!("{} · {}", scenario.title, self.title());
        if !start.edits.is_empty() {
            // The duration of a run with later edits, as of a machine led by hand, is that of these edits.
            other.duration = None;
        }
        other.edits.clear();
        let word = |word: &str| Value::from(word);
        let mut change = TaskChange::new();
        let mut set = |key: &str, value: Value| change.insert(key.into(), value);
        match self {
            Self::AsGiven => {}
            Self::Reactionless => {
                set("kind", word("reactionless"));
                // Only a straight line that the scenario does not state becomes a joint line.
                if matches!(scenario.task.shape(), PathShape::Line) && scenario.task.shape.is_none() {
                    set("shape", word("joint-line"));
                }
            }
            Self::OtherPose => {
                set("kind", word("same-tip"));
                set("shape", word("default"));
                set("via", word("default"));
                set("closed", word("default"));
            }
            Self::StraightLine | Self::Wheel | Self::Slowly => {
                change = straight(&scenario.task);
            }
        }
        let mut set = |key: &str, value: Value| change.insert(key.into(), value);
        if scenario.task.kind == TaskKind::ChangeB || scenario.task.kind == TaskKind::LeastReaction {
            set("b_to", word("default"));
        }
        if self == Self::Slowly {
            // The fastest law ignores the time, so scaling it would have no effect.
            if scenario.task.law.is_fastest() {
                set("law", word("quintic"));
            }
            set("time", (SLOW_FACTOR * scenario.task.time).into());
        }
        if let Ok(task) = scenario.task.with_change(&change, &scenario.machine) {
            other.task = task;
        }
        if self == Self::Slowly {
            // A duration of the session's own run must not end the slow run before its plan.
            let whole = SLOW_FACTOR * scenario.task.time;
            other.duration = other.duration.map(|duration| (SLOW_FACTOR * duration).max(whole));
        }
        if self == Self::OtherPose && other.task.first_drive_to.is_none() {
            other.task.first_drive_to = start_of_first_drive(scenario).map(|q| q + OTHER_POSE_OFFSET_RAD);
        }
        if self == Self::Wheel {
            other.base.wheel.get_or_insert_with(default_wheel);
        } else {
            other.base.wheel = None;
        }
        if other.task.law == TimeLaw::Fastest && self == Self::OtherPose {
            other.task.law = TimeLaw::Quintic;
        }
        other
    }
}

/// Returns the angle of drive 1, rad, in a pose at A with the task's b. `None` if none is found or the machine has
/// neither planes nor more than three drives.
fn start_of_first_drive(scenario: &Scenario) -> Option<f64> {
    let points = scenario.task.points();
    let space = PoseSpace::of(&scenario.machine).ok()?;
    if space.planes().is_err() && !space.leaves_freedoms() {
        return None;
    }
    let ends = [*points.first()?, *points.last()?];
    let poses = poses_of_points(&space, &ends, scenario.task.b)
        .or_else(|_| poses_of_points(&space, &ends[..1], scenario.task.b))
        .ok()?;
    Some(poses.first()?.q[0])
}
