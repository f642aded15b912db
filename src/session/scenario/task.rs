//! A [`Task`]: points to visit, curves between them, how the redundancy is resolved, and the timing.

use thiserror::Error;
use toml::Table;

use super::bounds::MAX_TIME;
use super::choices::{Corners, PathShape, ReactionObjective, TaskKind};
use stillbase_mechanics::kinematics::end_effector;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::{DriveAngles, PerDrive};
use stillbase_planning::curves::Samples;
use stillbase_planning::off_plane::momentum::TipFrame;
use stillbase_planning::pose_constant::PoseConstant;
use stillbase_planning::posture::Posture;
use stillbase_planning::timing::TimeLaw;
use stillbase_settings::change::{self, DEFAULT_WORD};
use stillbase_settings::key::Key;
use stillbase_settings::keyed::keyed;
use stillbase_settings::number::{ShortNumber, counted};
use stillbase_settings::range::{Range, RangeCheck};
use stillbase_settings::word::Choice;
use stillbase_simulation::plant::DriveValues;

/// Some keys of a task, as a file states them.
pub type TaskChange = Table;

/// Value of a key of a task.
pub type Value = toml::Value;

/// Maximum number of points between A and B.
pub const MAX_POINTS: usize = 2000;

/// Range of either coordinate of a point.
pub const POINT_RANGE: Range = Range::either_way(1e6, "m");
/// Range of a pose constant, more than a hundred turns either way.
pub const POSE_CONSTANT_RANGE: Range = Range::either_way(1e3, "rad");
/// Maximum number of times that a closed path is followed.
pub const MAX_CYCLES: u32 = 100;
/// Range of the duration of a motion, whether it is given or found.
pub const MOTION_TIME_RANGE: Range = Range::new(1e-5, MAX_TIME, "s");

const ANGLE: Range = Range::either_way(1e3, "rad");

const SAMPLED: &str = "no samples, which say where to go";
const UNSAMPLED_ANGLES: &str = "no samples of drive angles, which begin at a pose of their own";
const CURVED: &str = "points, and the kind reactionless, minimum-norm, least-reaction or zero-momentum";
const GOING: &str = "no samples, which say where to go, and another kind than turn-base, which returns to A";
const VISITING: &str = "another kind than turn-base, which returns to A";
const FREE: &str =
    "four drives or more, and the kind reactionless in the shape line, arc, spline or freehand, or samples of x and y";
const FLOATING: &str =
    "the kind zero-momentum, two or three drives, points, and base.kind = free without a wheel: no other base turns";
const CORNERED: &str =
    "three points or more, or a closed path, in the shape line or joint-line: others have no corners";
const BLENDED: &str = "corners = blend, and three points or more, or a closed path, in the shape line or joint-line: others have no corners";
const TURNED: &str = "four drives or more, the kind reactionless, and the posture orientation or the shape joint-line";

keyed! {
    /// The task of the machine. A task read from a file has to be completed with the keys that the file omits.
    #[derive(Clone, Debug, PartialEq)]
    pub struct Task at "task" {
        /// How the redundancy of three drives or more over two coordinates of the end effector is resolved.
        kind: TaskKind = Key::REQUIRED, saved: always;
        /// Shape of the path between the points.
        shape: Option<PathShape> = Key::NONE, instead: "joint-line for reactionless, line for the other kinds",
            when: CURVED => Task::is_curved;
        // Samples contain all drive angles for `given`, or x and y for `given`, `reactionless`, `minimum-norm` and
        // `zero-momentum`. With two drives, `given` reads two values as drive angles. Samples take the place of points,
        // shape and law.
        /// The motion over time: rows of t, s, and all drive angles, rad, or of t, x, y, m.
        samples: Option<Samples> = Key::NONE, instead: "points and a law say where to be when";
        /// Angle by which samples of drive angles are turned as a whole.
        turn: f64 = "0", range: ANGLE, when: "samples of drive angles" => |task| task.columns().is_some_and(|n| n != 2);
        /// Pose of A: the absolute angle of each drive. The point A and b are then those of this pose, whatever else is stated.
        start: Option<DriveValues> = Key::NONE, range: ANGLE, instead: "a pose of A at the b of the task",
            when: UNSAMPLED_ANGLES => |task| task.columns().is_none_or(|n| n == 2);
        /// The point A; by default where samples begin, or the end effector at the pose `start`.
        from: [f64; 2] = Key::REQUIRED, range: POINT_RANGE, when: SAMPLED => |task| task.samples.is_none(), saved: always;
        /// Points between A and B, in order, at most 2000.
        via: Vec<[f64; 2]> = "[]", range: POINT_RANGE, when: VISITING => |task| task.kind != TaskKind::TurnBase;
        /// The point B; by default where samples end.
        to: [f64; 2] = Key::REQUIRED, range: POINT_RANGE, when: GOING
            => |task| task.samples.is_none() && task.kind != TaskKind::TurnBase, saved: always;
        /// Where the points after A are meant: seen from the base pin, or in space.
        frame: Option<TipFrame> = Key::NONE, instead: "space if the base is free, otherwise base",
            when: "the kind zero-momentum" => |task| task.kind == TaskKind::ZeroMomentum;
        /// Angle by which a free base may turn where zero momentum leads no farther: least momentum then leads on. Two
        /// drives, which turn it all along a line, have no limit at 0.
        turn_limit: f64 = "0", range: Range::new(0.0, 180.0, "°"),
            when: FLOATING => |task| task.kind == TaskKind::ZeroMomentum && task.samples.is_none();
        /// Angle by which closed motions of the arm turn a free base, all cycles together, counterclockwise.
        base_turn: f64 = "1", range: Range::either_way(360.0, "°"),
            when: "the kind turn-base" => |task| task.kind == TaskKind::TurnBase;
        /// Whether the path returns from B to A.
        closed: bool = "false", when: VISITING => |task| task.kind != TaskKind::TurnBase;
        /// Whether the motion rests at corners or rounds them off.
        corners: Corners = "stop", when: CORNERED => Task::has_corners;
        /// Distance from a corner at which its blend begins: in m, for joint lines in rad.
        blend: f64 = "0.03", range: Range::new(0.0, 1.0, "m, rad"),
            when: BLENDED => |task| task.has_corners() && task.corners == Corners::Blend;
        /// Keeps to one side of every change point, where two drives are parallel and pin forces grow without bound.
        keep_off_change_points: bool = "false";
        /// Pose constant b at A: which reactionless plane.
        b: f64 = Key::REQUIRED, range: POSE_CONSTANT_RANGE,
            when: "no samples of drive angles, which have their own b: task.turn turns them; and no start"
                => |task| task.columns().is_none_or(|n| n == 2) && task.start.is_none(),
            saved: always;
        /// Pose constant b at B.
        b_to: Option<f64> = Key::NONE, range: POSE_CONSTANT_RANGE,
            instead: "for change-b the one that B allows with the least change, for least-reaction free",
            when: "the kind change-b or least-reaction"
                => |task| matches!(task.kind, TaskKind::ChangeB | TaskKind::LeastReaction);
        /// Bound on |n_B| while b changes; the motion takes T, or longer if the bound requires it.
        moment_limit: Option<f64> = Key::NONE, range: Range::new(1e-9, 1e9, "N m"), instead: "no bound",
            when: "the kind change-b" => |task| task.kind == TaskKind::ChangeB;
        /// Number of times that a closed path is followed.
        cycles: u32 = "1", range: Range::new(1.0, MAX_CYCLES as f64, ""),
            when: "the kind zero-momentum or turn-base"
                => |task| matches!(task.kind, TaskKind::ZeroMomentum | TaskKind::TurnBase);
        /// Quantity to minimise: the root of the mean square of n_B, or its peak.
        least: ReactionObjective = "mean-square", when: "the kind least-reaction" => |task| task.kind == TaskKind::LeastReaction;
        /// Use of the freedoms of four drives and more while b is held: least rates, constant orientation of the last
        /// link, least torques, or joints near the middle of their ranges.
        posture: Posture = "least-rates", when: FREE => Task::has_freedoms;
        /// Angle of the last link along the whole path, from root to tip, counted from the x axis.
        orientation: Option<f64> = Key::NONE, range: ANGLE, instead: "with the posture orientation as it does at A",
            when: TURNED => Task::keeps_orientation;
        /// Final angle of drive 1.
        first_drive_to: Option<f64> = Key::NONE, range: ANGLE, instead: "where it began",
            when: "the kind same-tip" => |task| task.kind == TaskKind::SameTip;
        /// Duration T from A to B; by default 1 s, or as long as samples take, and another T stretches them.
        time: f64 = "1", range: MOTION_TIME_RANGE,
            when: "another law: the fastest ones find the time" => |task| !task.law.is_fastest(), saved: always;
        /// Time law: how the motion goes from A to B.
        law: TimeLaw = "quintic",
            when: "no samples, which say when to be where" => |task| task.samples.is_none(), saved: always;
    }
}

/// Ends of a path that samples give.
#[derive(Clone, Copy)]
struct Ends {
    /// A and B, m.
    places: [[f64; 2]; 2],
    /// Pose constant at A, rad, if the samples determine it.
    b: Option<f64>,
}

/// Returns the ends of samples of the end effector, or of drive angles turned as a whole by `turn`, rad. Returns `None`
/// if the samples do not fit the machine.
fn ends_of(kind: TaskKind, samples: &Samples, turn: f64, machine: &Machine) -> Option<Ends> {
    let last = samples.count() - 1;
    if samples.columns() == 2 && !(machine.drives() == samples.columns() && kind == TaskKind::Given) {
        return Some(Ends { places: [0, last].map(|i| [samples.point(i).re, samples.point(i).im]), b: None });
    }
    let pose = |i: usize| DriveAngles(PerDrive::from_fn(samples.columns(), |k| samples.values(i)[k] + turn));
    (samples.columns() == machine.drives()).then(|| {
        let [(from, b), (to, _)] = [pose(0), pose(last)].map(|q| place_and_b(machine, &q));
        Ends { places: [from, to], b: Some(b) }
    })
}

/// Why a task cannot be completed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum IncompleteTask {
    /// A key is missing.
    #[error("missing field `{0}`")]
    Missing(&'static str),
    /// The samples are those of another number of drives.
    #[error("{}", samples_of_others(*got, *want))]
    Samples {
        /// Number of values of a sample beside the time.
        got: usize,
        /// Number of drives.
        want: usize,
    },
    /// The start has not one angle for each drive.
    #[error("{}: want {want}, one for each drive", counted(*got, "angle"))]
    Angles {
        /// Number of angles.
        got: usize,
        /// Number of drives.
        want: usize,
    },
}

/// Says that samples of so many values beside the time do not fit a machine of `drives` drives.
pub(crate) fn samples_of_others(values: usize, drives: usize) -> String {
    format!(
        "the samples are angles of {}, and the machine has {drives}: want rows of t, q1 … q{drives} or of t, x, y, or a \
         machine of as many drives",
        counted(values, "drive")
    )
}

/// Returns where a pose has the end effector, m, and its b, rad.
fn place_and_b(machine: &Machine, q: &DriveAngles) -> ([f64; 2], f64) {
    let p = end_effector(machine.end_effector(), &q.units());
    ([p.re, p.im], Inertia::of(machine).lambda().dot(q))
}

impl Task {
    /// Returns the pose of A that the task states for a machine of a number of drives; `None` if it states none.
    pub fn start_pose(&self, drives: usize) -> Option<DriveAngles> {
        let start = self.start.filter(|start| start.fits(drives))?;
        Some(DriveAngles(start.of(drives)))
    }

    /// Returns whether the motion returns to A, and no other B is stated, which would have no effect.
    pub(super) fn returns_to_a(&self) -> bool {
        self.kind == TaskKind::TurnBase && self.to == self.from
    }

    /// Returns the task with A and b of its start, if it has one: they may be those of a machine that has changed.
    pub fn at_its_start(&self, machine: &Machine) -> Option<Self> {
        // Samples of drive angles begin at a pose of their own.
        let samples = self.samples.as_ref().and_then(|samples| ends_of(self.kind, samples, self.turn, machine));
        if samples.is_some_and(|ends| ends.b.is_some()) {
            return None;
        }
        let (from, b) = place_and_b(machine, &self.start_pose(machine.drives())?);
        let to = if self.returns_to_a() { from } else { self.to };
        ((from, b) != (self.from, self.b)).then(|| Self { from, to, b, ..self.clone() })
    }

    /// Returns a task given by samples. Samples of the end effector are followed at `b`, rad; samples of drive angles
    /// determine b.
    ///
    /// # Errors
    /// If a key is missing: `b`, or `from` if the samples do not fit the machine.
    pub fn sampled(
        kind: TaskKind,
        samples: Samples,
        b: Option<f64>,
        machine: &Machine,
    ) -> Result<Self, IncompleteTask> {
        let stated = |key: &str| key == "kind" || (key == "b" && b.is_some());
        let task = Self { kind, samples: Some(samples), b: b.unwrap_or_default(), ..Self::default() };
        task.completed(stated, machine)
    }

    /// Returns the task with missing keys filled in from its samples, and with A and b of its start. `stated` returns
    /// whether a key is given.
    ///
    /// # Errors
    /// If a key is missing, or the start has another number of angles.
    pub(super) fn completed(self, stated: impl Fn(&str) -> bool, machine: &Machine) -> Result<Self, IncompleteTask> {
        if !stated("kind") {
            return Err(IncompleteTask::Missing("kind"));
        }
        let ends = self.samples.as_ref().and_then(|samples| ends_of(self.kind, samples, self.turn, machine));
        let start = self.start_pose(machine.drives()).filter(|_| ends.is_none_or(|ends| ends.b.is_none()));
        let drives = machine.drives();
        if let Some(wrong) = self.start.filter(|start| !start.fits(drives)) {
            return Err(IncompleteTask::Angles { got: wrong.values().len(), want: drives });
        }
        let place = |key: &'static str, own: [f64; 2], end: Option<[f64; 2]>| match end {
            _ if stated(key) => Ok(own),
            Some(end) => Ok(end),
            // Where the samples begin and end is then unknown.
            None if self.samples.is_some() => {
                Err(IncompleteTask::Samples { got: self.columns().unwrap_or_default(), want: drives })
            }
            None => Err(IncompleteTask::Missing(key)),
        };
        let at_start = start.map(|q| place_and_b(machine, &q));
        let from = match at_start {
            Some((tip, _)) => tip,
            None => place("from", self.from, ends.map(|ends| ends.places[0]))?,
        };
        let returns = (self.kind == TaskKind::TurnBase).then_some(from);
        let to = place("to", self.to, ends.map(|ends| ends.places[1]).or(returns))?;
        let b = match ends.and_then(|ends| ends.b) {
            _ if let Some((_, b)) = at_start => b,
            _ if stated("b") => self.b,
            Some(b) => b,
            // Without redundancy a point determines b; other machines may have none.
            None if !machine.is_redundant() || matches!(PoseConstant::of(machine), PoseConstant::None(_)) => 0.0,
            None => return Err(IncompleteTask::Missing("b")),
        };
        let time = self.samples.as_ref().map(Samples::duration).filter(|_| !stated("time")).unwrap_or(self.time);
        Ok(Self { from, to, b, time, ..self })
    }

    /// Returns a task with samples at another b, rad. Samples of drive angles are turned as a whole to begin at b; with
    /// other samples only b is set. Returns `None` for a task without samples.
    pub(crate) fn posed(&self, machine: &Machine, b: f64) -> Option<Self> {
        let samples = self.samples.as_ref()?;
        let mut task = Self { b, start: None, ..self.clone() };
        if let Some(Ends { b: Some(own), .. }) = ends_of(self.kind, samples, self.turn, machine) {
            task.turn += (b - own) / Inertia::of(machine).lambda().iter().sum::<f64>();
            [task.from, task.to] = ends_of(self.kind, samples, task.turn, machine)?.places;
        }
        Some(task)
    }

    /// Checks the time against the step size, s, the number of points against its maximum, and the start against the
    /// number of drives.
    pub(super) fn range_checks(&self, step: f64, drives: usize) -> Vec<RangeCheck> {
        let (count, enough) = (self.via.len(), self.via.len() <= MAX_POINTS);
        let want = || format!("one step or more, {} to {} s", ShortNumber(step), ShortNumber(MOTION_TIME_RANGE.high()));
        let time = RangeCheck::depending("task.time", self.time, self.time >= step, want);
        let many = || RangeCheck::count("task.via", count, "point", format!("at most {MAX_POINTS} between A and B"));
        let pose = self.start.and_then(|start| start.misfit(drives, "task.start"));
        std::iter::once(time).chain((!enough).then(many)).chain(pose).collect()
    }

    /// Returns all keys, as a change that turns any other task into this one.
    pub fn whole(&self) -> TaskChange {
        let absent = Self::KEYS.iter().filter_map(|key| key.path.strip_prefix("task."));
        let absent = absent.map(|key| (key.to_owned(), Value::from(DEFAULT_WORD)));
        absent.chain(TaskChange::try_from(self).unwrap_or_default()).collect()
    }

    /// Returns the number of values in each sample.
    fn columns(&self) -> Option<usize> {
        self.samples.as_ref().map(Samples::columns)
    }

    /// Returns the frame of the points after A.
    pub fn frame(&self) -> TipFrame {
        self.frame.unwrap_or(TipFrame::Space)
    }

    fn is_curved(&self) -> bool {
        use TaskKind::{LeastReaction, MinimumNorm, Reactionless, ZeroMomentum};
        self.samples.is_none() && matches!(self.kind, Reactionless | MinimumNorm | LeastReaction | ZeroMomentum)
    }

    fn has_corners(&self) -> bool {
        let is_straight = matches!(self.shape(), PathShape::JointLine | PathShape::Line);
        self.is_curved() && is_straight && (self.closed || !self.via.is_empty())
    }

    /// Returns whether this task would leave freedoms to machines of more than three drives.
    fn has_freedoms(&self) -> bool {
        match self.columns() {
            None => self.kind == TaskKind::Reactionless && self.shape() != PathShape::JointLine,
            Some(columns) => matches!(self.kind, TaskKind::Reactionless | TaskKind::Given) && columns == 2,
        }
    }

    fn keeps_orientation(&self) -> bool {
        let is_asked = self.posture == Posture::Orientation || self.shape() == PathShape::JointLine;
        self.kind == TaskKind::Reactionless && self.samples.is_none() && is_asked
    }

    /// Returns the shape of the path between the points.
    pub fn shape(&self) -> PathShape {
        self.shape.unwrap_or(match self.kind {
            TaskKind::Reactionless | TaskKind::SameTip | TaskKind::ChangeB | TaskKind::TurnBase => PathShape::JointLine,
            TaskKind::MinimumNorm | TaskKind::LeastReaction | TaskKind::ZeroMomentum | TaskKind::Given => {
                PathShape::Line
            }
        })
    }

    /// Returns kind, shape, law and number of points in one line, in the words of a file.
    pub fn in_one_line(&self) -> String {
        let (kind, shape, law) = (self.kind.words().file, self.shape().words().file, self.law.words().file);
        if let Some(samples) = &self.samples {
            return format!("{kind}, {}", counted(samples.count(), "sample"));
        }
        let closed = if self.closed { ", closed" } else { "" };
        if self.kind == TaskKind::TurnBase {
            return format!("{kind} by {}°, {law}", ShortNumber(self.base_turn));
        }
        format!("{kind}, {shape}{closed}, {law}, {} points", self.via.len() + 2)
    }

    /// Returns the task with some of its keys changed, as a file states them, for a machine. The word `default` removes
    /// a key.
    ///
    /// # Errors
    /// If a key or value is wrong; the error names it and states what is valid.
    pub fn with_change(&self, change: &TaskChange, machine: &Machine) -> Result<Self, String> {
        // There may be many samples, so they are serialised only if they change.
        let kept = if change.contains_key("samples") { None } else { self.samples.clone() };
        let plain = if kept.is_some() { &Self { samples: None, ..self.clone() } } else { self };
        let stated = change::merged_keys(plain, change)?;
        let mut task: Self = change::read(&stated)?;
        task.samples = kept.or(task.samples);
        // Another start brings its own A and b, and another A or b has no start but one that is stated with it.
        let begins = change.contains_key("start") && task.start.is_some();
        if !begins && (task.from, task.b) != (self.from, self.b) {
            task.start = None;
        }
        // Where the motion returns, B goes with A.
        let follows = self.returns_to_a() && task.kind == self.kind && !change.contains_key("to");
        let is_stated = |key: &str| stated.contains_key(key) && !(follows && key == "to");
        task.completed(is_stated, machine).map_err(|why| why.to_string())
    }

    /// Names in a change all of start, A and b if it sets one of them and there is a start, or comes to be one.
    pub(super) fn name_linked_keys(&self, change: &mut TaskChange) {
        let is_linked = ["from", "b"].iter().any(|key| change.contains_key(*key)) && self.start.is_some();
        if is_linked || change.contains_key("start") {
            for key in ["start", "from", "b"] {
                change.entry(key).or_insert_with(|| DEFAULT_WORD.into());
            }
        }
    }

    /// Returns the present values of the keys of a change, with which [`with_change`](Self::with_change) undoes it.
    pub fn present_values(&self, change: &TaskChange) -> TaskChange {
        let mut all = change.clone();
        self.name_linked_keys(&mut all);
        change::present_values(self, &all)
    }
}
