//! [`Alternative`]: other ways to do the same task.

use crate::planning::pose_space::PoseSpace;
use crate::planning::posed::serve;
use crate::planning::timing::TimeLaw;
use crate::session::scenario::{Change, Scenario, Shape, TaskKind, Value};
use crate::session::settled;
use crate::simulation::plant::Wheel;

/// A way to bring the end effector from A to B.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Alternative {
    /// As the scenario says.
    AsGiven,
    /// On one plane of joint space: the base feels nothing.
    Reactionless,
    /// The end effector on a straight line with minimum-norm rates, as in case 1.
    StraightLine,
    /// Another pose at the end, as in case 2.
    OtherPose,
    /// As the straight line, with a reaction wheel that takes up the moment while it can.
    Wheel,
    /// As the straight line, slower.
    Slowly,
}

/// How many times longer [`Alternative::Slowly`] takes: forces and moments fall with the square.
pub const SLOWER: f64 = 4.0;

/// The wheel of [`Alternative::Wheel`], if the base has none: of a size that a satellite of a few hundred kilograms
/// carries.
const WHEEL: Wheel = Wheel { inertia: 0.02, torque_limit: Some(2.0), speed_limit: Some(300.0) };

/// How far drive 1 ends from where the reactionless motion would have it, rad, if the task does not say; as in case 2.
const OTHER_POSE: f64 = -0.2375;

impl Alternative {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::AsGiven, Self::Reactionless, Self::StraightLine, Self::OtherPose, Self::Wheel, Self::Slowly];

    /// Whether a machine has such a way: without redundancy the end effector's motion leaves drive 1 none of its own.
    pub fn is_of(self, scenario: &Scenario) -> bool {
        self != Self::OtherPose || scenario.machine.is_redundant()
    }

    /// Short name, as in file names and on the command line.
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

    /// A few words.
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

    /// The scenario of this way: the same points, machine, plant, base and control.
    pub fn of(self, scenario: &Scenario) -> Scenario {
        if self == Self::AsGiven {
            return scenario.clone();
        }
        // Edits before the first step belong to the task; later ones would make it another run.
        let start = settled(scenario).map_or_else(|_| scenario.clone(), |(start, _)| start);
        let scenario = &start;
        let mut other = start.clone();
        other.name = format!("{}-{}", scenario.name, self.name());
        other.title = format!("{} · {}", scenario.title, self.title());
        other.edits.clear();
        let word = |word: &str| Value::from(word);
        let mut change = Change::new();
        let mut set = |key: &str, value: Value| change.insert(key.into(), value);
        match self {
            Self::AsGiven => {}
            Self::Reactionless => {
                set("kind", word("reactionless"));
                // The shape stays where this kind of task has it.
                if matches!(scenario.task.shape(), Shape::Line) && scenario.task.shape.is_none() {
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
                set("kind", word("minimum-norm"));
                if scenario.task.shape() == Shape::JointLine {
                    set("shape", word("line"));
                }
            }
        }
        if scenario.task.kind == TaskKind::ChangeB || scenario.task.kind == TaskKind::LeastReaction {
            set("b_to", word("default"));
        }
        if self == Self::Slowly {
            // The fastest has no time of its own to multiply.
            if scenario.task.law.is_fastest() {
                set("law", word("quintic"));
            }
            set("time", (SLOWER * scenario.task.time).into());
        }
        if let Ok(task) = scenario.task.with(&change, &scenario.machine) {
            other.task = task;
        }
        if self == Self::Slowly {
            other.duration = other.duration.map(|duration| SLOWER * duration);
        }
        if self == Self::OtherPose && other.task.first_drive_to.is_none() {
            other.task.first_drive_to = start_of_first_drive(scenario).map(|q| q + OTHER_POSE);
        }
        if self == Self::Wheel {
            other.base.wheel.get_or_insert(WHEEL);
        } else {
            other.base.wheel = None;
        }
        if other.task.law == TimeLaw::Fastest && self == Self::OtherPose {
            other.task.law = TimeLaw::Quintic;
        }
        other
    }
}

/// Where drive 1 is at A at the b of the task, rad, where that is on planes or leaves freedoms.
fn start_of_first_drive(scenario: &Scenario) -> Option<f64> {
    let points = scenario.task.points();
    let space = PoseSpace::of(&scenario.machine).ok()?;
    if space.planes().is_err() && !space.leaves_freedoms() {
        return None;
    }
    let ends = [*points.first()?, *points.last()?];
    let poses = serve(&space, &ends, scenario.task.b).or_else(|_| serve(&space, &ends[..1], scenario.task.b)).ok()?;
    Some(poses.first()?.q[0])
}
