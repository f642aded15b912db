//! A [`Task`]: which points to visit, along what, how the redundancy is resolved, and when.

use serde::{Deserialize, Serialize};

use crate::keys;
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
    /// Pose constant at B, rad: for `change-b` by default the one that B allows with the least change, for
    /// `least-reaction` free.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub b_to: Option<f64>,
    /// Bound on |n_B| while b changes, N m; for `change-b`: the motion takes as long as it wants, T or longer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moment_limit: Option<f64>,
    /// How often a closed path is run through; for `zero-momentum`.
    #[serde(default = "once", skip_serializing_if = "is_once")]
    pub cycles: u32,
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

/// Some keys of a task, as they stand in a file.
pub type Change = toml::Table;

/// What a key of a task holds.
pub type Value = toml::Value;

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
    /// Any path of the end effector at zero momentum, on machines whose mass matrix changes with the pose too; a closed
    /// one again and again, with the drift of the joints.
    ZeroMomentum,
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

fn once() -> u32 {
    1
}

fn is_once(cycles: &u32) -> bool {
    *cycles == 1
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

    /// All keys, so that another task can be made this one.
    pub fn whole(&self) -> Change {
        let optional = ["shape", "via", "closed", "corners", "blend", "keep_off_change_points", "b_to", "moment_limit"];
        let others = ["cycles", "least", "first_drive_to"];
        let absent = optional.into_iter().chain(others).map(|key| (key.to_owned(), Value::from("default")));
        absent.chain(Change::try_from(self).unwrap_or_default()).collect()
    }

    /// The change that makes these the points; `None` for fewer than two.
    pub fn visiting(points: &[Vector]) -> Option<Change> {
        let [from, via @ .., to] = points else { return None };
        let pair = |p: &Vector| toml::Value::Array(vec![p.re.into(), p.im.into()]);
        let via = via.iter().map(pair).collect();
        Some(
            [("from", pair(from)), ("via", toml::Value::Array(via)), ("to", pair(to))].map(keyed).into_iter().collect(),
        )
    }

    /// The change that moves a point, m.
    pub fn moving(&self, point: usize, to: Vector) -> Option<Change> {
        let mut points = self.points();
        *points.get_mut(point)? = to;
        Self::visiting(&points)
    }

    /// The change that visits one more point, m, where the least way is added.
    pub fn adding(&self, p: Vector) -> Option<Change> {
        let mut points = self.points();
        let detour = |i: &usize| {
            let (a, b) = (points[*i], points[i + 1]);
            (p - a).norm() + (b - p).norm() - (b - a).norm()
        };
        let place = (0..points.len() - 1).min_by(|i, j| detour(i).total_cmp(&detour(j)))?;
        points.insert(place + 1, p);
        Self::visiting(&points)
    }

    /// The change that leaves a point out; `None` if only two are left.
    pub fn removing(&self, point: usize) -> Option<Change> {
        let mut points = self.points();
        if points.len() <= 2 || point >= points.len() {
            return None;
        }
        points.remove(point);
        Self::visiting(&points)
    }

    /// The change that visits a point one place earlier.
    pub fn advancing(&self, point: usize) -> Option<Change> {
        let mut points = self.points();
        if point == 0 || point >= points.len() {
            return None;
        }
        points.swap(point - 1, point);
        Self::visiting(&points)
    }

    /// The change that visits the points of a curve drawn by hand, m.
    pub fn drawing(points: &[Vector]) -> Option<Change> {
        // Few enough to be kept in a file; the shape of the hand's line is all that counts.
        let every = points.len().div_ceil(400).max(1);
        let mut thin: Vec<Vector> = points.iter().step_by(every).copied().collect();
        thin.extend(points.last().filter(|last| thin.last() != Some(last)));
        let mut change = Self::visiting(&thin)?;
        change.insert("shape".into(), "freehand".into());
        Some(change)
    }

    /// What joins the points.
    pub fn shape(&self) -> Shape {
        self.shape.unwrap_or(match self.kind {
            TaskKind::Reactionless | TaskKind::SameTip | TaskKind::ChangeB => Shape::JointLine,
            TaskKind::MinimumNorm | TaskKind::LeastReaction | TaskKind::ZeroMomentum => Shape::Line,
        })
    }

    /// Kind, shape, law and points in one line, in the words of a file.
    pub fn in_one_line(&self) -> String {
        let word = |value: Option<Value>| value.as_ref().and_then(Value::as_str).unwrap_or_default().to_owned();
        let [kind, shape, law] =
            [Value::try_from(self.kind).ok(), Value::try_from(self.shape()).ok(), Value::try_from(self.law).ok()]
                .map(word);
        let closed = if self.closed { ", closed" } else { "" };
        format!("{kind}, {shape}{closed}, {law}, {} points", self.via.len() + 2)
    }

    /// The task with some of its keys changed, as they stand in a file; the word `default` takes a key out.
    ///
    /// # Errors
    /// What key or value is wrong, and what would be right.
    pub fn with(&self, change: &Change) -> Result<Self, String> {
        keys::with(self, change)
    }

    /// What these keys hold now, so that [`with`](Self::with) brings it back.
    pub fn only(&self, change: &Change) -> Change {
        keys::only(self, change)
    }
}

fn keyed((key, value): (&str, toml::Value)) -> (String, toml::Value) {
    (key.into(), value)
}
