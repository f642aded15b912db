//! [`Edit`]: every change a person can make, as data. A session is its scenario and its edits, nothing else.

use serde::de::Error as _;
use serde::{Deserialize, Serialize};

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
    /// Feedback gains.
    SetGains {
        /// s⁻².
        kp: f64,
        /// s⁻¹.
        kd: f64,
    },
    /// A payload that control does not know of.
    SetPayload {
        /// kg.
        mass: f64,
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
    /// What.
    #[serde(flatten)]
    pub edit: Edit,
}

impl<'de> Deserialize<'de> for TimedEdit {
    /// By hand, because a flattened enum would accept keys that it does not know.
    fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let mut table = toml::Table::deserialize(from)?;
        let step = table.remove("step").ok_or_else(|| D::Error::missing_field("step"))?;
        let step = step.as_integer().and_then(|n| u64::try_from(n).ok());
        let step = step.ok_or_else(|| D::Error::custom("step: want a whole number of steps, 0 or more"))?;
        let edit = Edit::deserialize(table).map_err(|e| D::Error::custom(e.message()))?;
        Ok(Self { step, edit })
    }
}

impl Edit {
    /// One key of the task.
    pub fn task(key: &str, value: impl Into<toml::Value>) -> Self {
        Self::SetTask { change: toml::Table::from_iter([(key.to_owned(), value.into())]) }
    }

    /// Whether a later edit makes this one void, so that a drag keeps only its last word.
    pub fn is_replaced_by(&self, later: &Self) -> bool {
        match (self, later) {
            (Self::SetMachine { key: a, .. }, Self::SetMachine { key: b, .. }) => a == b,
            (Self::SetTask { change: a }, Self::SetTask { change: b }) => a.keys().all(|key| b.contains_key(key)),
            _ => std::mem::discriminant(self) == std::mem::discriminant(later),
        }
    }

    /// Whether it sends the machine somewhere: the pointer or the slider.
    pub fn leads(&self) -> bool {
        matches!(self, Self::DragTarget { .. } | Self::SlideB { .. })
    }

    /// What it does, for menus and the event log.
    pub fn title(&self) -> String {
        match self {
            Self::DragTarget { x, y } => format!("drag target to {x:.3}, {y:.3} m"),
            Self::SlideB { b } => format!("slide b to {b:.3} rad"),
            Self::PoseB { b } => format!("pose at b = {b:.3} rad"),
            Self::SetGains { kp, kd } => format!("set gains to {kp:.0} s⁻², {kd:.0} s⁻¹"),
            Self::SetPayload { mass } => format!("set unknown payload to {mass:.3} kg"),
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
    let say = |(key, value): (&String, &toml::Value)| {
        let value = value.as_str().map_or_else(|| value.to_string(), Into::into);
        format!("{} to {value}", key.replace('_', " "))
    };
    format!("set {}", change.iter().map(say).collect::<Vec<_>>().join(", "))
}
