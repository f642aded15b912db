//! A [`Task`]: which points to visit, along what, how the redundancy is resolved, and when.

use serde::{Deserialize, Serialize};

use crate::plan::TimeLaw;
use crate::planar::Vector;

/// What the machine is to do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// What becomes of the redundancy: three drives, two coordinates of the end effector.
    pub kind: TaskKind,
    /// What joins the points; by default what suits the kind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
    /// A, m.
    pub from: [f64; 2],
    /// Points between A and B, in order, m.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub via: Vec<[f64; 2]>,
    /// B, m.
    pub to: [f64; 2],
    /// Returns from B to A.
    #[serde(default, skip_serializing_if = "is_false")]
    pub closed: bool,
    /// What happens at corners.
    #[serde(default, skip_serializing_if = "is_default")]
    pub corners: Corners,
    /// How far from a corner its blend begins: m, for joint lines rad.
    #[serde(default = "default_blend", skip_serializing_if = "is_default_blend")]
    pub blend: f64,
    /// Keeps to one side of every change point, where two drives are parallel and pin forces grow without bound.
    #[serde(default, skip_serializing_if = "is_false")]
    pub keep_off_change_points: bool,
    /// Pose constant at A, rad.
    pub b: f64,
    /// Pose constant at B, rad; for `change-b`. By default the one that B allows with the least change.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub b_to: Option<f64>,
    /// Bound on |n_B| while b changes, N m; for `change-b`: the time follows from it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moment_limit: Option<f64>,
    /// What to keep small; for `least-reaction`.
    #[serde(default, skip_serializing_if = "is_default")]
    pub least: Least,
    /// Where drive 1 ends, rad; for `same-tip`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_drive_to: Option<f64>,
    /// T, s; for the laws that do not find it themselves.
    #[serde(default = "one_second")]
    pub time: f64,
    /// Time law.
    #[serde(default)]
    pub law: TimeLaw,
}

/// How the redundancy of three drives over two coordinates is resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum TaskKind {
    /// On the plane b = const: nothing reaches the base (case 3).
    Reactionless,
    /// Minimum-norm joint rates along the end effector's path (case 1).
    #[serde(rename = "minimum-norm", alias = "tip-line")]
    MinimumNorm,
    /// The end effector as on the joint line of case 3, drive 1 on a course of its own (case 2).
    SameTip,
    /// Any path of the end effector, with b changing as little as its corridor allows.
    LeastReaction,
    /// From A on one plane to B on another: the price of b.
    ChangeB,
}

/// What joins the points of a task.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// Straight lines in joint space.
    JointLine,
    /// Straight lines of the end effector.
    Line,
    /// One arc through three points.
    Arc,
    /// A cubic spline through all points.
    Spline,
    /// Drawn by hand: smoothed.
    Freehand,
}

/// What happens where straight lines meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Corners {
    /// The motion comes to rest.
    #[default]
    Stop,
    /// The corner is rounded off.
    Blend,
}

/// What a redundant motion keeps small.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Least {
    /// The root of the mean square of n_B.
    #[default]
    MeanSquare,
    /// The peak of |n_B|.
    Peak,
}

fn one_second() -> f64 {
    1.0
}

fn default_blend() -> f64 {
    0.03
}

fn is_default_blend(blend: &f64) -> bool {
    *blend == default_blend()
}

fn is_false(flag: &bool) -> bool {
    !flag
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// The most points a task may visit.
pub const MAX_POINTS: usize = 2000;

impl Task {
    /// All points in order, A first and B last, m.
    pub fn points(&self) -> Vec<Vector> {
        let all = std::iter::once(&self.from).chain(&self.via).chain(std::iter::once(&self.to));
        all.map(|p| Vector::new(p[0], p[1])).collect()
    }

    /// What a point is called: A, 1, 2 … B.
    pub fn name_of(&self, point: usize) -> String {
        match point {
            0 => "A".into(),
            i if i > self.via.len() => "B".into(),
            i => i.to_string(),
        }
    }

    /// What joins the points.
    pub fn shape(&self) -> Shape {
        self.shape.unwrap_or(match self.kind {
            TaskKind::Reactionless | TaskKind::SameTip | TaskKind::ChangeB => Shape::JointLine,
            TaskKind::MinimumNorm | TaskKind::LeastReaction => Shape::Line,
        })
    }

    /// The task with some of its keys changed, as they stand in a file; the word `default` takes a key out.
    ///
    /// # Errors
    /// What key or value is wrong, and what would be right.
    pub fn with(&self, change: &toml::Table) -> Result<Self, String> {
        let mut table = toml::Table::try_from(self).map_err(|e| e.to_string())?;
        for (key, value) in change {
            if value.as_str() == Some("default") {
                table.remove(key);
            } else {
                table.insert(key.clone(), value.clone());
            }
        }
        table.try_into().map_err(|e: toml::de::Error| e.message().to_owned())
    }

    /// What these keys hold now, so that [`with`](Self::with) brings it back.
    pub fn only(&self, change: &toml::Table) -> toml::Table {
        let table = toml::Table::try_from(self).unwrap_or_default();
        let absent = || toml::Value::String("default".into());
        change.keys().map(|key| (key.clone(), table.get(key).cloned().unwrap_or_else(absent))).collect()
    }
}
