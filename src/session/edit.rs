//! [`Edit`]: every change a person can make, as data. A session is its scenario and its edits, nothing else.

use serde::de::Error as _;
use serde::{Deserialize, Serialize};

use crate::session::scenario::{MAX_STEPS, PLACE, POSE_CONSTANT, TIME};
use crate::settings::change;
use crate::settings::range::Check;

/// One change. It can be saved, replayed and undone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Edit {
    /// Sends the end effector to a point, m; the machine follows on its plane.
    DragTarget {
        /// m.
        x: f64,
        /// m.
        y: f64,
    },
    /// Sends the pose constant to b, rad, in motion: the base feels n_B = −D_1 b̈.
    SlideB {
        /// rad.
        b: f64,
    },
    /// Puts the machine on the plane b, rad, without a motion between.
    PoseB {
        /// rad.
        b: f64,
    },
    /// A force held at the end effector from now on, N: a hand that pushes; zero lets go.
    Push {
        /// N.
        x: f64,
        /// N.
        y: f64,
    },
    /// Keys of the plant, as in a scenario file: payload, friction, links that differ; `default` takes a key out.
    SetPlant {
        /// Such as `{ payload = { mass = 0.3 } }`.
        change: toml::Table,
    },
    /// Keys of what the machine stands on, during the whole run.
    SetBase {
        /// Such as `{ kind = "free" }`.
        change: toml::Table,
    },
    /// Keys of control: law, gains, rate, delay.
    SetControl {
        /// Such as `{ kp = 400.0 }`.
        change: toml::Table,
    },
    /// Keys of the tolerances, as in a scenario file: spreads, seed, limits; they change no run.
    SetTolerance {
        /// Such as `{ moment_limit = 0.01, "link.*.com" = { normal = 0.0005 } }`.
        change: toml::Table,
    },
    /// One setting of the machine, by the keys of `--set`.
    SetMachine {
        /// Such as `limits.a1`.
        key: String,
        /// Such as `0,3.14`.
        value: String,
    },
    /// Duration T of the planned motion, s.
    SetTime {
        /// s.
        time: f64,
    },
    /// Keys of the task, as in a scenario file: points, shape, law and so on; `default` takes a key out.
    SetTask {
        /// Such as `{ shape = "spline", via = [[0.6, 0.7]] }`.
        change: toml::Table,
    },
    /// The workspace to compare with; none hides it.
    CompareB {
        /// rad.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        b: Option<f64>,
    },
}

/// An edit and the step at which it applies.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TimedEdit {
    /// Steps since the start.
    pub step: u64,
    /// The edit.
    #[serde(flatten)]
    pub edit: Edit,
}

impl<'de> Deserialize<'de> for TimedEdit {
    /// By hand, because a flattened enum would accept keys that it does not know.
    fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        Self::from_table(toml::Table::deserialize(from)?).map_err(D::Error::custom)
    }
}

impl TimedEdit {
    /// An entry of a file.
    ///
    /// # Errors
    /// What is wrong with it, and what would be right.
    pub fn from_table(mut table: toml::Table) -> Result<Self, String> {
        let step = table.remove("step").ok_or("missing field `step`")?;
        let step = step.as_integer().and_then(|n| u64::try_from(n).ok()).filter(|n| *n <= MAX_STEPS);
        let step = step.ok_or_else(|| format!("step: want a whole number of steps, 0 to {MAX_STEPS}"))?;
        let edit = Edit::deserialize(table).map_err(|e| e.message().to_owned())?;
        Ok(Self { step, edit })
    }

    /// As an entry of a file.
    ///
    /// # Panics
    /// Never: every edit can be written.
    pub fn to_table(&self) -> toml::Table {
        toml::Table::try_from(self).expect("an edit is plain data")
    }
}

impl Edit {
    /// One key of the task.
    pub fn task(key: &str, value: impl Into<toml::Value>) -> Self {
        Self::SetTask { change: change::one(key, value) }
    }

    /// One key of the plant, its parts joined by dots.
    pub fn plant(key: &str, value: impl Into<toml::Value>) -> Self {
        Self::SetPlant { change: change::one(key, value) }
    }

    /// One key of what the machine stands on.
    pub fn base(key: &str, value: impl Into<toml::Value>) -> Self {
        Self::SetBase { change: change::one(key, value) }
    }

    /// One key of control.
    pub fn control(key: &str, value: impl Into<toml::Value>) -> Self {
        Self::SetControl { change: change::one(key, value) }
    }

    /// Whether its own numbers may stand there, for a step, s; what it changes is checked where that is known.
    ///
    /// # Errors
    /// The first that may not.
    pub fn check(&self, step: f64) -> Result<(), Check> {
        let found: Vec<Check> = match self {
            Self::DragTarget { x, y } => vec![PLACE.check("x", *x), PLACE.check("y", *y)],
            Self::SlideB { b } | Self::PoseB { b } | Self::CompareB { b: Some(b) } => {
                vec![POSE_CONSTANT.check("b", *b)]
            }
            Self::SetTime { time } => {
                let enough = Check::words("time", *time, *time >= step, "one step or more, s");
                vec![TIME.check("time", *time), enough]
            }
            _ => Vec::new(),
        };
        found.into_iter().find(|check| !check.ok).map_or(Ok(()), Err)
    }

    /// Whether it sets the task, its time, the base or the tolerances: these hold for the whole run, from its first
    /// step.
    pub fn is_of_the_whole(&self) -> bool {
        matches!(self, Self::SetTask { .. } | Self::SetTime { .. } | Self::SetBase { .. } | Self::SetTolerance { .. })
    }

    /// Why an edit [of the start](Self::is_of_the_start) is refused later.
    pub(super) const AT_START: &str = "task, time and base can change only before the first step: want step = 0";

    /// Whether it changes what a motion is planned from, so that it can stand only before the first step.
    pub(super) fn is_of_the_start(&self) -> bool {
        self.is_of_the_whole() && !matches!(self, Self::SetTolerance { .. })
    }

    /// Whether a later edit sets all that this one sets, so that only the last edit of a drag is kept.
    pub fn is_replaced_by(&self, later: &Self) -> bool {
        match (self, later) {
            (Self::SetMachine { key: a, .. }, Self::SetMachine { key: b, .. }) => a == b,
            (Self::SetTask { change: a }, Self::SetTask { change: b })
            | (Self::SetPlant { change: a }, Self::SetPlant { change: b })
            | (Self::SetBase { change: a }, Self::SetBase { change: b })
            | (Self::SetControl { change: a }, Self::SetControl { change: b })
            | (Self::SetTolerance { change: a }, Self::SetTolerance { change: b }) => change::covers(b, a),
            _ => std::mem::discriminant(self) == std::mem::discriminant(later),
        }
    }

    /// Which part of a scenario it changes, for messages.
    pub(super) fn part(&self) -> &'static str {
        match self {
            Self::DragTarget { .. } => "target",
            Self::SlideB { .. } | Self::PoseB { .. } => "b",
            Self::Push { .. } => "push",
            Self::SetPlant { .. } => "plant",
            Self::SetBase { .. } => "base",
            Self::SetControl { .. } => "control",
            Self::SetTolerance { .. } => "tolerance",
            Self::SetMachine { .. } => "machine",
            Self::SetTime { .. } => "time",
            Self::SetTask { .. } => "task",
            Self::CompareB { .. } => "compare b",
        }
    }

    /// Whether it sends the machine somewhere: the pointer or the slider.
    pub fn leads(&self) -> bool {
        matches!(self, Self::DragTarget { .. } | Self::SlideB { .. })
    }

    /// Whether it sets limits of joints.
    pub fn sets_limits(&self) -> bool {
        matches!(self, Self::SetMachine { key, .. } if key.starts_with("limits."))
    }

    /// Whether it changes the force at the end effector.
    pub fn pushes(&self) -> bool {
        match self {
            Self::Push { .. } => true,
            Self::SetPlant { change } => change.contains_key("force"),
            _ => false,
        }
    }

    /// What it does, for menus and the event log.
    pub fn title(&self) -> String {
        match self {
            Self::DragTarget { x, y } => format!("drag target to {x:.3}, {y:.3} m"),
            Self::SlideB { b } => format!("slide b to {b:.3} rad"),
            Self::PoseB { b } => format!("pose at b = {b:.3} rad"),
            Self::Push { x: 0.0, y: 0.0 } => "let go".into(),
            Self::Push { x, y } => format!("push with {x:.2}, {y:.2} N"),
            Self::SetPlant { change } => listed("plant", change),
            Self::SetBase { change } => listed("base", change),
            Self::SetControl { change } => listed("control", change),
            Self::SetTolerance { change } => listed("tolerance", change),
            Self::SetMachine { key, value } => format!("set {key} to {value}"),
            Self::SetTime { time } => format!("set motion time to {time:.3} s"),
            Self::SetTask { change } => task_title(change),
            Self::CompareB { b: Some(b) } => format!("compare with b = {b:.3} rad"),
            Self::CompareB { b: None } => "stop comparing".into(),
        }
    }
}

/// What a change of the task does.
fn task_title(change: &toml::Table) -> String {
    if ["from", "via", "to"].iter().any(|key| change.contains_key(*key)) {
        return "move waypoints".into();
    }
    if change.is_empty() {
        return "go back to the path".into();
    }
    let say = |(key, value): (&String, &toml::Value)| {
        let value = value.as_str().map_or_else(|| value.to_string(), Into::into);
        format!("{} to {value}", key.replace('_', " "))
    };
    format!("set {}", change.iter().map(say).collect::<Vec<_>>().join(", "))
}

/// What a change of keys does.
fn listed(of: &str, change: &toml::Table) -> String {
    let say = |(key, value): (String, String)| match value.as_str() {
        "default" => format!("{} back to normal", key.replace(['_', '.'], " ")),
        _ => {
            let short = value.parse().map_or(value.clone(), |x: f64| format!("{}", (x * 1e6).round() / 1e6));
            format!("{} to {short}", key.replace(['_', '.'], " "))
        }
    };
    format!("set {of} {}", change::listed(change).into_iter().map(say).collect::<Vec<_>>().join(", "))
}
