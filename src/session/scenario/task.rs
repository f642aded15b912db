//! A [`Task`]: which points to visit, along what, how the redundancy is resolved, and when.

use serde::{Deserialize, Serialize};

use crate::mechanics::kinematics::end_effector;
use crate::mechanics::machine::{Inertia, Machine};
use crate::mechanics::planar::{DriveAngles, PerDrive, Vector};
use crate::planning::curves::Samples;
use crate::planning::posture::Posture;
use crate::planning::timing::TimeLaw;
use crate::settings::change;
use crate::settings::key::{Holds, Key};
use crate::settings::number::{Short, counted};
use crate::settings::range::{Check, Range};

/// What the machine is to do.
pub type Task = Keys<[f64; 2], f64>;

/// A task as a file states it: points, b and time may be left out where samples have them.
pub(super) type StatedTask = Keys<Option<[f64; 2]>, Option<f64>>;

/// The keys of a task, with what stands for a point, m, and for a number that a file may leave out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Keys<P, X> {
    /// What becomes of the redundancy: three drives, two coordinates of the end effector.
    pub kind: TaskKind,
    /// What joins the points; by default what suits the kind.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
    /// The motion over time: rows of t, s, and all drive angles, rad, for `given`; or of t, x, y, m, for `given`,
    /// `reactionless` and `minimum-norm`. Points, shape and law have no say then. Of two drives `given` takes their
    /// angles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<Samples>,
    /// By how much samples of drive angles are turned as a whole, rad.
    #[serde(default, skip_serializing_if = "is_default")]
    pub turn: f64,
    /// A, m; by default where samples begin.
    #[serde(default)]
    pub from: P,
    /// Points between A and B, in order, m.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub via: Vec<[f64; 2]>,
    /// B, m; by default where samples end.
    #[serde(default)]
    pub to: P,
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
    #[serde(default)]
    pub b: X,
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
    /// How four drives and more use the freedoms that a point leaves.
    #[serde(default, skip_serializing_if = "is_default")]
    pub posture: Posture,
    /// Which way the last link points, rad; for the posture `orientation`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orientation: Option<f64>,
    /// Where drive 1 ends, rad; for `same-tip`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_drive_to: Option<f64>,
    /// T, s; for the laws that do not find it themselves. By default 1 s, or as long as samples take; another T
    /// stretches them.
    #[serde(default)]
    pub time: X,
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

const SAMPLED: &str = "no samples, which say where to go";
const CURVED: &str = "points, and the kind reactionless, minimum-norm, least-reaction or zero-momentum";
const FREE: &str =
    "four drives or more, and the kind reactionless in the shape line, arc, spline or freehand, or samples of x and y";
const CORNERED: &str =
    "three points or more, or a closed path, in the shape line or joint-line: others have no corners";
const BLENDED: &str = "corners = blend, and three points or more, or a closed path, in the shape line or joint-line: others have no corners";

/// Every key of `[task]`.
pub const KEYS: [Key; 21] = [
    Key::new(
        "task.kind",
        Holds::Choice(&[
            "reactionless",
            "minimum-norm",
            "same-tip",
            "least-reaction",
            "change-b",
            "zero-momentum",
            "given",
        ]),
        Key::REQUIRED,
        "What becomes of the redundancy of three drives over two coordinates of the end effector.",
    ),
    Key::new(
        "task.shape",
        Holds::Choice(&["joint-line", "line", "arc", "spline", "freehand"]),
        Key::NONE,
        "What joins the points.",
    )
    .when(CURVED)
    .instead("joint-line for reactionless, line for the other kinds"),
    Key::new(
        "task.samples",
        Holds::Rows,
        Key::NONE,
        "The motion over time: rows of t, s, and all drive angles, rad, or of t, x, y, m.",
    )
    .instead("points and a law say where to be when"),
    Key::number("task.turn", ANGLE, "0", "By how much samples of drive angles are turned as a whole.")
        .when("samples of drive angles"),
    Key::new("task.from", Holds::List(2, PLACE), Key::REQUIRED, "The point A; by default where samples begin.")
        .when(SAMPLED),
    Key::new("task.via", Holds::Points(PLACE), "[]", "Points between A and B, in order, at most 2000."),
    Key::new("task.to", Holds::List(2, PLACE), Key::REQUIRED, "The point B; by default where samples end.")
        .when(SAMPLED),
    Key::new("task.closed", Holds::Switch, "false", "Whether the path returns from B to A."),
    Key::new(
        "task.corners",
        Holds::Choice(&["stop", "blend"]),
        "stop",
        "Whether the motion rests at corners or rounds them off.",
    )
    .when(CORNERED),
    Key::number(
        "task.blend",
        Range::new(0.0, 1.0, "m, rad"),
        "0.03",
        "How far from a corner its blend begins: in m, for joint lines in rad.",
    )
    .when(BLENDED),
    Key::new(
        "task.keep_off_change_points",
        Holds::Switch,
        "false",
        "Keeps to one side of every change point, where two drives are parallel and pin forces grow without bound.",
    ),
    Key::number("task.b", POSE_CONSTANT, Key::REQUIRED, "Pose constant b at A: which reactionless plane.")
        .when("no samples of drive angles, which have their own b: task.turn turns them"),
    Key::number("task.b_to", POSE_CONSTANT, Key::NONE, "Pose constant b at B.")
        .when("the kind change-b or least-reaction")
        .instead("for change-b the one that B allows with the least change, for least-reaction free"),
    Key::number(
        "task.moment_limit",
        Range::new(1e-9, 1e9, "N m"),
        Key::NONE,
        "Bound on |n_B| while b changes; the motion takes as long as that wants, T or longer.",
    )
    .when("the kind change-b")
    .instead("no bound"),
    Key::new("task.cycles", Holds::Whole(Range::new(1.0, 100.0, "")), "1", "How often a closed path is run through.")
        .when("the kind zero-momentum"),
    Key::new(
        "task.least",
        Holds::Choice(&["mean-square", "peak"]),
        "mean-square",
        "What to keep small: the root of the mean square of n_B, or its peak.",
    )
    .when("the kind least-reaction"),
    Key::new(
        "task.posture",
        Holds::Choice(&["least-rates", "orientation", "least-torque", "mid-range"]),
        "least-rates",
        "How four drives and more use the freedoms that a point leaves while b is held: they turn least, the last link keeps \
         its orientation, the motors need the least torques, or joints stay near the middle of their ranges.",
    )
    .when(FREE),
    Key::number(
        "task.orientation",
        ANGLE,
        Key::NONE,
        "Which way the last link points all along the path, from root to tip, counted from the x axis.",
    )
    .when("four drives or more, the kind reactionless, and the posture orientation or the shape joint-line")
    .instead("with the posture orientation as it does at A"),
    Key::number("task.first_drive_to", ANGLE, Key::NONE, "Where drive 1 ends.")
        .when("the kind same-tip")
        .instead("where it began"),
    Key::number(
        "task.time",
        TIME,
        "1",
        "Duration T from A to B; by default 1 s, or as long as samples take, and another T stretches them.",
    )
    .when("another law: the fastest ones find the time"),
    Key::new(
        "task.law",
        Holds::Choice(&["quintic", "septic", "trapezoidal", "fastest", "fastest-smooth"]),
        "quintic",
        "Time law: how the motion goes from A to B.",
    )
    .when("no samples, which say when to be where"),
];

const ANGLE: Range = Range::either_way(1e3, "rad");

impl StatedTask {
    /// The task as a file means it for a machine: what it leaves out is filled in from its samples.
    ///
    /// # Errors
    /// Which key is missing.
    pub(super) fn completed(self, machine: &Machine) -> Result<Task, &'static str> {
        let Self { kind, shape, samples, turn, from, via, to, closed, corners, blend, .. } = self;
        let Self {
            keep_off_change_points,
            b,
            b_to,
            moment_limit,
            cycles,
            least,
            posture,
            orientation,
            first_drive_to,
            time,
            law,
            ..
        } = self;
        let ends = samples.as_ref().and_then(|samples| ends_of((kind, samples), turn, machine));
        let [first, last] = ends.map_or([None; 2], |ends| ends.places.map(Some));
        Ok(Task {
            from: from.or(first).ok_or("from")?,
            to: to.or(last).ok_or("to")?,
            // Without redundancy a point says enough.
            b: b.or(ends.and_then(|ends| ends.b)).or((!machine.is_redundant()).then_some(0.0)).ok_or("b")?,
            time: time.or(samples.as_ref().map(Samples::duration)).unwrap_or(1.0),
            kind,
            shape,
            samples,
            turn,
            via,
            closed,
            corners,
            blend,
            keep_off_change_points,
            b_to,
            moment_limit,
            cycles,
            least,
            posture,
            orientation,
            first_drive_to,
            law,
        })
    }
}

/// What samples say of the ends of a path.
#[derive(Clone, Copy)]
struct Ends {
    /// A and B, m.
    places: [[f64; 2]; 2],
    /// Pose constant at A, rad, where samples have their own.
    b: Option<f64>,
}

/// The ends of samples of the end effector, or of the drives, turned as a whole, rad; `None` if there are none for this
/// machine.
fn ends_of((kind, samples): (TaskKind, &Samples), turn: f64, machine: &Machine) -> Option<Ends> {
    let last = samples.count() - 1;
    if samples.columns() == 2 && !(machine.drives() == samples.columns() && kind == TaskKind::Given) {
        return Some(Ends { places: [0, last].map(|i| [samples.point(i).re, samples.point(i).im]), b: None });
    }
    let pose = |i: usize| DriveAngles(PerDrive::from_fn(samples.columns(), |k| samples.values(i)[k] + turn));
    let place = |q: &DriveAngles| {
        let p = end_effector(machine.end_effector(), &q.units());
        [p.re, p.im]
    };
    (samples.columns() == machine.drives()).then(|| {
        let [first, last] = [pose(0), pose(last)];
        Ends { places: [place(&first), place(&last)], b: Some(Inertia::of(machine).lambda().dot(&first)) }
    })
}

impl Task {
    /// A task by samples, on the plane b, rad, where they are of the end effector; those of the drives have their own.
    ///
    /// # Errors
    /// Which key is missing: `b` for samples of the end effector without one.
    pub fn sampled(kind: TaskKind, samples: Samples, b: Option<f64>, machine: &Machine) -> Result<Self, &'static str> {
        let task = StatedTask {
            kind,
            shape: None,
            samples: Some(samples),
            turn: 0.0,
            from: None,
            via: Vec::new(),
            to: None,
            closed: false,
            corners: Corners::default(),
            blend: default_blend(),
            keep_off_change_points: false,
            b,
            b_to: None,
            moment_limit: None,
            cycles: once(),
            least: Least::default(),
            posture: Posture::default(),
            orientation: None,
            first_drive_to: None,
            time: None,
            law: TimeLaw::default(),
        };
        task.completed(machine)
    }

    /// Samples turned as a whole to begin on the plane b, rad, if they are of the drives of a machine; what else a task
    /// with samples has is left to its plan. `None` for a task without samples.
    pub(crate) fn posed(&self, machine: &Machine, b: f64) -> Option<Self> {
        let samples = self.samples.as_ref()?;
        let mut task = Self { b, ..self.clone() };
        if let Some(Ends { b: Some(own), .. }) = ends_of((self.kind, samples), self.turn, machine) {
            task.turn += (b - own) / Inertia::of(machine).lambda().iter().sum::<f64>();
            [task.from, task.to] = ends_of((self.kind, samples), task.turn, machine)?.places;
        }
        Some(task)
    }

    /// What no range says: how its numbers fit together, and a step, s.
    pub(super) fn fits(&self, step: f64) -> Vec<Check> {
        let (count, enough) = (self.via.len(), self.via.len() <= MAX_POINTS);
        let want = || format!("one step or more, {} to {} s", Short(step), Short(TIME.high()));
        let time = Check::said("task.time", self.time, self.time >= step, want);
        let many = || Check::count("task.via", count, "point", format!("at most {MAX_POINTS} between A and B"));
        std::iter::once(time).chain((!enough).then(many)).collect()
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
        let others = ["cycles", "least", "posture", "orientation", "first_drive_to", "samples", "turn"];
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

    /// The task with a point elsewhere, m; `None` where samples say where to go, or for no such point.
    pub fn moved(&self, point: usize, to: Vector) -> Option<Self> {
        let mut points = self.movable()?;
        *points.get_mut(point)? = to;
        let mut places = points.iter().map(|p| [p.re, p.im]);
        let (from, to) = (places.next()?, places.next_back()?);
        Some(Self { from, via: places.collect(), to, ..self.clone() })
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

    /// Whether a key of this part has an effect as things are.
    pub fn uses(&self, key: &str) -> bool {
        use TaskKind::{ChangeB, Given, LeastReaction, MinimumNorm, Reactionless, SameTip, ZeroMomentum};
        let kind = |kinds: &[TaskKind]| kinds.contains(&self.kind);
        let samples = self.samples.as_ref().map(Samples::columns);
        let curved = kind(&[Reactionless, MinimumNorm, LeastReaction, ZeroMomentum]) && samples.is_none();
        let straight = curved && matches!(self.shape(), Shape::JointLine | Shape::Line);
        let cornered = straight && (self.closed || !self.via.is_empty());
        match key {
            "from" | "to" | "law" => samples.is_none(),
            "shape" => curved,
            "corners" => cornered,
            "blend" => cornered && self.corners == Corners::Blend,
            "b" => samples.is_none_or(|columns| columns == 2),
            "b_to" => kind(&[ChangeB, LeastReaction]),
            "moment_limit" => kind(&[ChangeB]),
            "cycles" => kind(&[ZeroMomentum]),
            "least" => kind(&[LeastReaction]),
            "posture" => match samples {
                None => kind(&[Reactionless]) && self.shape() != Shape::JointLine,
                Some(columns) => kind(&[Reactionless, Given]) && columns == 2,
            },
            "orientation" => {
                kind(&[Reactionless])
                    && samples.is_none()
                    && (self.posture == Posture::Orientation || self.shape() == Shape::JointLine)
            }
            "first_drive_to" => kind(&[SameTip]),
            "turn" => samples.is_some_and(|columns| columns != 2),
            "time" => !self.law.is_fastest(),
            _ => true,
        }
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
            return format!("{kind}, {}", counted(samples.count(), "sample"));
        }
        let closed = if self.closed { ", closed" } else { "" };
        format!("{kind}, {shape}{closed}, {law}, {} points", self.via.len() + 2)
    }

    /// The task with some of its keys changed, as they stand in a file, for a machine; the word `default` takes a key
    /// out.
    ///
    /// # Errors
    /// What key or value is wrong, and what would be right.
    pub fn with(&self, change: &Change, machine: &Machine) -> Result<Self, String> {
        // Samples may be many: they are written out only where the change is of them.
        let kept = if change.contains_key("samples") { None } else { self.samples.clone() };
        let plain = if kept.is_some() { &Self { samples: None, ..self.clone() } } else { self };
        let mut stated: StatedTask = change::with_as(plain, change)?;
        stated.samples = kept.or(stated.samples);
        stated.completed(machine).map_err(|key| format!("missing field `{key}`"))
    }

    /// What these keys hold now, so that [`with`](Self::with) brings it back.
    pub fn only(&self, change: &Change) -> Change {
        change::only(self, change)
    }
}

fn keyed((key, value): (&str, toml::Value)) -> (String, toml::Value) {
    (key.into(), value)
}
