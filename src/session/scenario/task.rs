//! A [`Task`]: which points to visit, along what, how the redundancy is resolved, and when.

use serde::{Deserialize, Serialize};

use crate::mechanics::kinematics::end_effector;
use crate::mechanics::machine::{Inertia, Machine};
use crate::mechanics::planar::{DriveAngles, PerDrive, Vector};
use crate::planning::curves::Samples;
use crate::planning::timing::TimeLaw;
use crate::settings::change;
use crate::settings::range::{Check, Range};

/// What the machine is to do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// What becomes of the redundancy: three drives, two coordinates of the end effector.
    pub kind: TaskKind,
    /// What joins the points; by default what suits the kind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
    /// The motion over time: rows of t, s, and all drive angles, rad, for `given`; or of t, x, y, m, for `given`,
    /// `reactionless` and `minimum-norm`. Points, shape and law have no say then.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<Samples>,
    /// By how much samples of drive angles are turned as a whole, rad.
    #[serde(default, skip_serializing_if = "is_default")]
    pub turn: f64,
    /// A, m; by default where samples begin.
    #[serde(default = "missing_point")]
    pub from: [f64; 2],
    /// Points between A and B, in order, m.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub via: Vec<[f64; 2]>,
    /// B, m; by default where samples end.
    #[serde(default = "missing_point")]
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
    /// Pose constant at A, rad; samples of drive angles have their own.
    #[serde(default = "missing")]
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
    /// T, s; for the laws that do not find it themselves. By default 1 s, or as long as samples take; another T
    /// stretches them.
    #[serde(default = "missing")]
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
    /// By samples over time: of the drives as they are, of the end effector on the plane b = const.
    Given,
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

/// What stands for a key that a file leaves out, until it is known; no file can hold it.
fn missing() -> f64 {
    f64::NAN
}

fn missing_point() -> [f64; 2] {
    [f64::NAN; 2]
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

/// Where a point may lie, either coordinate.
pub const PLACE: Range = Range::either_way(1e6, "m");
/// Where a pose constant may lie: two hundred turns and more keep all its digits.
pub const POSE_CONSTANT: Range = Range::either_way(1e3, "rad");
/// How long a motion may take, whether it is told to or finds its time itself.
pub const TIME: Range = Range::new(1e-5, super::bounds::MAX_TIME, "s");
const ANGLE: Range = Range::either_way(1e3, "rad");
const BLEND: Range = Range::new(0.0, 1.0, "");
const CYCLES: Range = Range::new(1.0, 100.0, "");
const MOMENT_LIMIT: Range = Range::new(1e-9, 1e9, "N m");

impl Task {
    /// A task by samples, on the plane b, rad, where they are of the end effector; those of the drives have their own.
    ///
    /// # Errors
    /// Which key is missing: `b` for samples of the end effector without one.
    pub fn sampled(kind: TaskKind, samples: Samples, b: Option<f64>, machine: &Machine) -> Result<Self, &'static str> {
        let task = Self {
            kind,
            shape: None,
            samples: Some(samples),
            turn: 0.0,
            from: missing_point(),
            via: Vec::new(),
            to: missing_point(),
            closed: false,
            corners: Corners::default(),
            blend: default_blend(),
            keep_off_change_points: false,
            b: b.unwrap_or_else(missing),
            b_to: None,
            moment_limit: None,
            cycles: once(),
            least: Least::default(),
            first_drive_to: None,
            time: missing(),
            law: TimeLaw::default(),
        };
        task.completed(machine)
    }

    /// The task with what its file leaves out and what follows from its samples alone.
    fn settled(mut self) -> Self {
        let samples = self.samples.as_ref();
        if self.time.is_nan() {
            self.time = samples.map_or(1.0, Samples::duration);
        }
        if let Some(samples) = samples.filter(|samples| samples.columns() == 2) {
            let place = |i| [samples.point(i).re, samples.point(i).im];
            self.place_ends([place(0), place(samples.count() - 1)]);
        }
        self
    }

    fn place_ends(&mut self, ends: [[f64; 2]; 2]) {
        for (own, end) in [&mut self.from, &mut self.to].into_iter().zip(ends) {
            if own.iter().all(|x| x.is_nan()) {
                *own = end;
            }
        }
    }

    /// The task as a file means it for a machine: what it leaves out is filled in from its samples.
    ///
    /// # Errors
    /// Which key is missing.
    pub(super) fn completed(self, machine: &Machine) -> Result<Self, &'static str> {
        let mut task = self.settled();
        if let Some([first, last]) = task.end_poses(machine) {
            let place = |q: &DriveAngles| {
                let p = end_effector(machine.end_effector(), &q.units());
                [p.re, p.im]
            };
            task.place_ends([place(&first), place(&last)]);
            if task.b.is_nan() {
                task.b = Inertia::of(machine).lambda().dot(&first);
            }
        }
        let missing = [
            ("from", task.from.iter().all(|x| x.is_nan())),
            ("to", task.to.iter().all(|x| x.is_nan())),
            ("b", task.b.is_nan()),
        ];
        match missing.into_iter().find(|(_, is)| *is) {
            Some((key, _)) => Err(key),
            None => Ok(task),
        }
    }

    /// Where samples of the drive angles begin and end; `None` if there are none for this machine.
    fn end_poses(&self, machine: &Machine) -> Option<[DriveAngles; 2]> {
        let samples = self.samples.as_ref().filter(|samples| samples.columns() == machine.drives())?;
        let pose = |i: usize| DriveAngles(PerDrive::from_fn(samples.columns(), |k| samples.values(i)[k] + self.turn));
        Some([pose(0), pose(samples.count() - 1)])
    }

    /// Samples turned as a whole to begin on the plane b, rad, if they are of the drives of a machine; what else a task
    /// with samples has is left to its plan. `None` for a task without samples.
    pub(crate) fn posed(&self, machine: &Machine, b: f64) -> Option<Self> {
        self.samples.as_ref()?;
        let mut task = Self { b, ..self.clone() };
        if let Some([first, _]) = self.end_poses(machine) {
            let lambda = Inertia::of(machine).lambda();
            task.turn += (b - lambda.dot(&first)) / lambda.iter().sum::<f64>();
            (task.from, task.to) = (missing_point(), missing_point());
        }
        task.completed(machine).ok()
    }

    /// Every number with its key, and whether it may stand there, for a step, s.
    pub(super) fn checks(&self, step: f64) -> Vec<Check> {
        let place = |key: &'static str, [x, y]: [f64; 2]| [PLACE.check(key, x), PLACE.check(key, y)];
        let mut list = vec![
            TIME.check("task.time", self.time),
            Check::words("task.time", self.time, self.time >= step, "one step or more, s"),
            CYCLES.check("task.cycles", self.cycles.into()),
            BLEND.check("task.blend", self.blend),
            POSE_CONSTANT.check("task.b", self.b),
            ANGLE.check("task.turn", self.turn),
        ];
        list.extend(MOMENT_LIMIT.check_some("task.moment_limit", self.moment_limit));
        list.extend(POSE_CONSTANT.check_some("task.b_to", self.b_to));
        list.extend(ANGLE.check_some("task.first_drive_to", self.first_drive_to));
        list.extend(place("task.from", self.from));
        list.extend(place("task.to", self.to));
        let (count, enough) = (self.via.len(), self.via.len() <= MAX_POINTS);
        list.push(Check::words("task.via", count as f64, enough, "at most 2000 points between A and B"));
        let via = self.via.iter().enumerate().flat_map(|(i, p)| p.map(|x| (i, x))).find(|(_, x)| !PLACE.contains(*x));
        list.extend(via.map(|(i, x)| PLACE.check(format!("task.via[{}]", i + 1), x)));
        list
    }

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
        let others = ["cycles", "least", "first_drive_to", "samples", "turn"];
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

    /// The points, unless samples say where to go.
    fn movable(&self) -> Option<Vec<Vector>> {
        self.samples.is_none().then(|| self.points())
    }

    /// The change that moves a point, m; as all such changes, none where samples say where to go.
    pub fn moving(&self, point: usize, to: Vector) -> Option<Change> {
        let mut points = self.movable()?;
        *points.get_mut(point)? = to;
        Self::visiting(&points)
    }

    /// The change that visits one more point, m, where the least way is added.
    pub fn adding(&self, p: Vector) -> Option<Change> {
        let mut points = self.movable()?;
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
        let mut points = self.movable()?;
        if points.len() <= 2 || point >= points.len() {
            return None;
        }
        points.remove(point);
        Self::visiting(&points)
    }

    /// The change that visits a point one place earlier.
    pub fn advancing(&self, point: usize) -> Option<Change> {
        let mut points = self.movable()?;
        if point == 0 || point >= points.len() {
            return None;
        }
        points.swap(point - 1, point);
        Self::visiting(&points)
    }

    /// The change that visits the points of a curve drawn by hand, m.
    pub fn drawing(points: &[Vector]) -> Option<Change> {
        // Few enough to be kept in a file and to keep the shape of the line that was drawn.
        let every = points.len().div_ceil(400).max(1);
        let mut thin: Vec<Vector> = points.iter().step_by(every).copied().collect();
        thin.extend(points.last().filter(|last| thin.last() != Some(last)));
        let mut change = Self::visiting(&thin)?;
        change.insert("shape".into(), "freehand".into());
        change.insert("samples".into(), "default".into());
        Some(change)
    }

    /// What a key would want to have a say in this task, if it has none as things are.
    pub fn unused(&self, key: &str) -> Option<&'static str> {
        use TaskKind::{ChangeB, LeastReaction, MinimumNorm, Reactionless, SameTip, ZeroMomentum};
        let kind = |kinds: &[TaskKind]| kinds.contains(&self.kind);
        let samples = self.samples.as_ref().map(Samples::columns);
        let curved = kind(&[Reactionless, MinimumNorm, LeastReaction, ZeroMomentum]) && samples.is_none();
        let straight = curved && matches!(self.shape(), Shape::JointLine | Shape::Line);
        let (used, want) = match key {
            "from" | "to" => (samples.is_none(), "no samples, which say where to go"),
            "shape" => (curved, "points, and the kind reactionless, minimum-norm, least-reaction or zero-momentum"),
            "corners" => (straight, "the shape line or joint-line: others have no corners"),
            "blend" if straight => (self.corners == Corners::Blend, "corners = blend"),
            "blend" => (false, "the shape line or joint-line: others have no corners"),
            "b" => (samples.is_none_or(|n| n == 2), "task.turn, for samples of drive angles have their own b"),
            "b_to" => (kind(&[ChangeB, LeastReaction]), "the kind change-b or least-reaction"),
            "moment_limit" => (kind(&[ChangeB]), "the kind change-b"),
            "cycles" => (kind(&[ZeroMomentum]), "the kind zero-momentum"),
            "least" => (kind(&[LeastReaction]), "the kind least-reaction"),
            "first_drive_to" => (kind(&[SameTip]), "the kind same-tip"),
            "turn" => (samples.is_some_and(|n| n != 2), "samples of drive angles"),
            "law" => (samples.is_none(), "no samples, which say when to be where"),
            "time" => (!self.law.is_fastest(), "another law: the fastest ones find the time"),
            _ => return None,
        };
        (!used).then_some(want)
    }

    /// What joins the points.
    pub fn shape(&self) -> Shape {
        self.shape.unwrap_or(match self.kind {
            TaskKind::Reactionless | TaskKind::SameTip | TaskKind::ChangeB => Shape::JointLine,
            TaskKind::MinimumNorm | TaskKind::LeastReaction | TaskKind::ZeroMomentum | TaskKind::Given => Shape::Line,
        })
    }

    /// Kind, shape, law and points in one line, in the words of a file.
    pub fn in_one_line(&self) -> String {
        let word = |value: Option<Value>| value.as_ref().and_then(Value::as_str).unwrap_or_default().to_owned();
        let [kind, shape, law] =
            [Value::try_from(self.kind).ok(), Value::try_from(self.shape()).ok(), Value::try_from(self.law).ok()]
                .map(word);
        if let Some(samples) = &self.samples {
            return format!("{kind}, {} samples", samples.count());
        }
        let closed = if self.closed { ", closed" } else { "" };
        format!("{kind}, {shape}{closed}, {law}, {} points", self.via.len() + 2)
    }

    /// The task with some of its keys changed, as they stand in a file; the word `default` takes a key out.
    ///
    /// # Errors
    /// What key or value is wrong, and what would be right.
    pub fn with(&self, change: &Change) -> Result<Self, String> {
        change::with(self, change).map(Self::settled)
    }

    /// What these keys hold now, so that [`with`](Self::with) brings it back.
    pub fn only(&self, change: &Change) -> Change {
        change::only(self, change)
    }
}

fn keyed((key, value): (&str, toml::Value)) -> (String, toml::Value) {
    (key.into(), value)
}
