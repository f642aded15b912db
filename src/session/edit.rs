//! [`Edit`]: every change that the user can make, as data. Scenario and edits determine a session completely.

use std::collections::BTreeMap;

use serde::de::Error as _;
use serde::{Deserialize, Serialize};

use toml::{Table, Value};

use super::older;
use super::waypoints::{self, POINT_KEYS};
use crate::scenario::words::ScenarioWords;
use crate::scenario::{MAX_STEPS, POINT_RANGE, POSE_CONSTANT_RANGE, effect_in, effect_of, key_of, name_of};
use stillbase_mechanics::machine::{ANGLE, KeyPath, MACHINE_TABLES, is_of_machine};
use stillbase_mechanics::sketch::SketchStep;
use stillbase_settings::change;
use stillbase_settings::key::{Effect, Key};
use stillbase_settings::mending::{Problem, Wrong};
use stillbase_settings::number::{at_most_digits, counted};
use stillbase_settings::range::{RangeCheck, shortened};

/// One change. It can be saved, replayed and undone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Edit {
    /// Drags the target of the end effector to a point in space, m; the machine follows with b held, or at zero momentum
    /// if it has no b. With b held, on a base that
    /// [floats](stillbase_simulation::frame::Frame::floats), the target moves with the base from then on.
    DragTarget {
        /// m.
        x: f64,
        /// m.
        y: f64,
    },
    /// Drags the end effector of a block of an assembly in space: each block of its chain has its target there, as
    /// [`DragTarget`](Self::DragTarget), m, in its own plane.
    DragBlocks {
        /// Targets by the names of the blocks, m.
        targets: BTreeMap<String, [f64; 2]>,
    },
    /// Passes what the end effector of a block of an assembly holds to another block, whose own payload it takes; both
    /// have to meet, in parallel planes.
    HandOver {
        /// Name of the block that hands over.
        from: String,
        /// Name of the block that takes.
        to: String,
    },
    /// Drags the relative joint angles to (a₁, a₂), rad, by turning a link; b is held.
    DragAngles {
        /// rad.
        a1: f64,
        /// rad.
        a2: f64,
    },
    /// Pulls a point of a link to a place, m, while the end effector and b are held; needs four drives or more.
    PullLink {
        /// Name of the link.
        link: String,
        /// Distance of the point from the root of the link, m.
        along: f64,
        /// m.
        x: f64,
        /// m.
        y: f64,
    },
    /// Moves the pose constant to b, rad, while time passes: n_B = −D_1 b̈ acts on the base.
    SlideB {
        /// rad.
        b: f64,
    },
    /// Puts the machine on the plane b, rad, at once and without a motion.
    PoseB {
        /// rad.
        b: f64,
    },
    /// Applies a constant force to the end effector from this step on, N; zero removes it.
    Push {
        /// N.
        x: f64,
        /// N.
        y: f64,
    },
    /// Changes settings as a file states them: of task, plant, base, control, tolerance, design, machine and of the
    /// scenario itself. The value `default` removes a key.
    Set {
        /// Such as `{ task = { shape = "spline" }, link = { 5 = { com = -0.02 } } }`.
        change: Table,
    },
    /// A step of drawing the machine. A scenario without a drawing begins with that of its machine.
    Sketch(SketchStep),
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

/// Reads an edit without its step; the error is what the reader says.
fn edit_of(table: &Table) -> Result<Edit, String> {
    Edit::deserialize(table.clone()).map_err(|error| error.message().to_owned())
}

/// Keys that say which other keys an edit has.
const KINDS: [&str; 2] = ["do", "draw"];

/// Returns the problem of an edit, without its step, of which the reader says `why`.
fn problem_of(mut table: Table, why: &str) -> Problem {
    let lacks = KINDS.into_iter().find(|kind| why == format!("missing field `{kind}`"));
    if let Some(kind) = lacks {
        // The reader lists the kinds where it is given none of them.
        table.insert(kind.into(), "".into());
        let known = edit_of(&table).err().unwrap_or_default();
        let known = known.split_once("one of ").map_or_else(String::new, |(_, known)| known.replace('`', ""));
        let wrong = Wrong::Kind(format!("is missing: want one of {known}"));
        return Problem { path: KeyPath::of(Some(kind)), wrong };
    }
    let key = wrong_key(&table, why);
    let is_kind = key.is_some_and(|key| KINDS.contains(&key));
    match Problem::said(KeyPath::of(key), why) {
        Problem { path, wrong: Wrong::Value(said) } if is_kind => Problem { path, wrong: Wrong::Kind(said) },
        problem => problem,
    }
}

/// Returns the key whose value the reader refuses, because it reads on without it. The reader itself names none.
fn wrong_key<'a>(table: &'a Table, why: &str) -> Option<&'a str> {
    if why.starts_with("missing field") || why.starts_with("unknown field") {
        return None;
    }
    let reads_on = |key: &&String| {
        let rest: Table = table.iter().filter(|(own, _)| own != key).map(|(k, v)| (k.clone(), v.clone())).collect();
        edit_of(&rest).err().is_none_or(|other| other != why)
    };
    // Without its kind, an edit is another one.
    let found = table.keys().filter(|key| !KINDS.contains(&key.as_str())).find(reads_on);
    found.map(String::as_str).or_else(|| KINDS.into_iter().rev().find(|kind| table.contains_key(*kind)))
}

impl<'de> Deserialize<'de> for TimedEdit {
    /// Written by hand, because a flattened enum would accept unknown keys.
    fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        Self::from_table(Table::deserialize(from)?).map_err(D::Error::custom)
    }
}

impl TimedEdit {
    /// Reads an `[[edit]]` entry of a file.
    ///
    /// # Errors
    /// If it is not a valid edit; the error states what is wrong, and what is valid.
    pub fn from_table(table: Table) -> Result<Self, String> {
        Self::read(table).map_err(|problem| problem.text(&ScenarioWords))
    }

    /// Reads an `[[edit]]` entry of a file.
    ///
    /// # Errors
    /// If it is not a valid edit; places are those within the entry.
    pub(crate) fn read(mut table: Table) -> Result<Self, Problem> {
        let whole = |said: &str| Problem::said(KeyPath::default(), said);
        let step = table.remove("step").ok_or_else(|| whole("missing field `step`"))?;
        let number = step.as_integer().and_then(|n| u64::try_from(n).ok()).filter(|n| *n <= MAX_STEPS);
        let step = number.ok_or_else(|| {
            let said = format!("is {step}: want a whole number of steps since the start, 0 to {MAX_STEPS}");
            Problem { path: KeyPath::new(&[&"step"]), wrong: Wrong::Value(said) }
        })?;
        let edit = match older::settings(&mut table).map_err(|why| whole(&why))? {
            Some(change) => Edit::Set { change },
            None => edit_of(&table).map_err(|why| problem_of(table, &why))?,
        };
        Ok(Self { step, edit })
    }

    /// Returns the edit as an `[[edit]]` entry of a file.
    ///
    /// # Panics
    /// Never: every edit can be written.
    pub fn to_table(&self) -> Table {
        Table::try_from(self).expect("an edit is plain data")
    }
}

impl Edit {
    /// Returns an edit of one setting by its path, such as `plant.payload.mass`.
    pub fn set(path: &str, value: impl Into<Value>) -> Self {
        Self::Set { change: change::single_change(path, value) }
    }

    /// Returns an edit of one setting by the parts of its path.
    pub fn at(path: &[&str], value: impl Into<Value>) -> Self {
        Self::Set { change: change::at(path, value) }
    }

    /// Returns an edit of settings of one part, such as `task`.
    pub fn of(part: &str, change: Table) -> Self {
        Self::Set { change: Table::from_iter([(part.to_owned(), change.into())]) }
    }

    /// Returns the settings that the edit changes, if it is a [`Set`](Self::Set).
    fn settings(&self) -> Option<&Table> {
        match self {
            Self::Set { change } => Some(change),
            _ => None,
        }
    }

    /// Returns the settings of one part that the edit changes.
    pub fn part(&self, part: &str) -> Option<&Table> {
        self.settings()?.get(part)?.as_table()
    }

    /// Returns the number that the edit gives to a key of the scenario itself, such as `step`.
    pub(super) fn own_number(&self, key: &str) -> Option<f64> {
        change::number(self.settings()?.get(key)?)
    }

    /// Removes a key of the scenario itself from the edit. Returns the key with its value as a change, if it was there.
    pub(super) fn take_key(&mut self, key: &str) -> Option<Table> {
        let Self::Set { change } = self else { return None };
        Some(Table::from_iter([(key.to_owned(), change.remove(key)?)]))
    }

    /// Returns whether the edit is a [`Set`](Self::Set) without settings.
    pub(super) fn sets_nothing(&self) -> bool {
        self.settings().is_some_and(Table::is_empty)
    }

    /// Returns whether the edit changes a setting of one of these parts.
    pub fn sets(&self, parts: &[&str]) -> bool {
        self.settings().is_some_and(|change| change.keys().any(|key| parts.contains(&key.as_str())))
    }

    /// Returns whether the edit changes any setting of the task except its time, or the drawing. Such an edit changes
    /// the path, or sends a dragged machine back to it.
    pub fn sets_path(&self) -> bool {
        let of_task = |task: &Table| task.is_empty() || task.keys().any(|key| key != "time");
        matches!(self, Self::Sketch(_)) || self.part("task").is_some_and(of_task)
    }

    /// Returns the largest effect of the edit's keys, `Plan` for a step of drawing, or `Motion` for any other edit.
    pub fn effect(&self) -> Effect {
        match self {
            Self::Set { change } => effect_of(change),
            Self::Sketch(_) => Effect::Plan,
            _ => Effect::Motion,
        }
    }

    /// Returns whether no frame depends on the edit's settings, so that they apply to the whole run.
    pub fn affects_no_frame(&self) -> bool {
        self.effect() == Effect::NoFrame
    }

    /// Returns the edit with only those settings on which no frame depends, if there are any.
    pub(super) fn frameless_settings(&self) -> Option<Self> {
        let change = self.settings()?;
        let aside = |(part, value): &(&String, &Value)| effect_in(part, value) == Effect::NoFrame;
        let change: Table = change.iter().filter(aside).map(|(part, value)| (part.clone(), value.clone())).collect();
        (!change.is_empty()).then_some(Self::Set { change })
    }

    /// Returns whether the edit changes the machine.
    pub fn sets_machine(&self) -> bool {
        self.sets(&MACHINE_TABLES) || matches!(self, Self::Sketch(_))
    }

    /// Returns whether the edit changes the bounds on the design.
    pub(super) fn sets_design(&self) -> bool {
        self.sets(&["design"])
    }

    /// Checks the range of the numbers of a drag or pose. Settings are checked together with the rest of the scenario.
    ///
    /// # Errors
    /// The first number that is out of range.
    pub fn check(&self) -> Result<(), RangeCheck> {
        let found: Vec<RangeCheck> = match self {
            Self::DragTarget { x, y } => vec![POINT_RANGE.check("x", *x), POINT_RANGE.check("y", *y)],
            Self::DragBlocks { targets } => {
                targets.values().flatten().map(|x| POINT_RANGE.check("targets", *x)).collect()
            }
            Self::DragAngles { a1, a2 } => vec![ANGLE.check("a1", *a1), ANGLE.check("a2", *a2)],
            Self::PullLink { along, x, y, .. } => {
                vec![POINT_RANGE.check("along", *along), POINT_RANGE.check("x", *x), POINT_RANGE.check("y", *y)]
            }
            Self::SlideB { b } | Self::PoseB { b } => vec![POSE_CONSTANT_RANGE.check("b", *b)],
            _ => Vec::new(),
        };
        found.into_iter().find(|check| !check.ok).map_or(Ok(()), Err)
    }

    /// Returns whether the edit's settings apply to the whole run: those of the plan, and those on which no frame
    /// depends.
    pub fn applies_to_whole_run(&self) -> bool {
        self.changes_plan() || self.affects_no_frame()
    }

    /// Reason for refusing, after the first step, an edit that [changes the plan](Self::changes_plan).
    pub(super) const START_ONLY_REASON: &str =
        "task, time, base, step and drawing can change only before the first step: want step = 0";

    /// Returns whether the edit changes the plan of the motion, so that it is allowed only before the first step.
    pub(super) fn changes_plan(&self) -> bool {
        self.effect() == Effect::Plan
    }

    /// Returns whether a later edit overwrites everything that this one sets, so that only the last edit of a drag is
    /// kept.
    pub fn is_replaced_by(&self, later: &Self) -> bool {
        match (self, later) {
            (Self::Set { change: earlier }, Self::Set { change: later }) => change::covers(later, earlier),
            // Each step of a drawing builds on those before.
            (Self::Sketch(_), Self::Sketch(_)) => false,
            // Each passes on what the one before has passed.
            (Self::HandOver { .. }, Self::HandOver { .. }) => false,
            _ => std::mem::discriminant(self) == std::mem::discriminant(later),
        }
    }

    /// Returns the name of the part of the scenario that the edit changes, for messages.
    pub(super) fn name(&self) -> &str {
        match self {
            Self::DragTarget { .. } | Self::DragBlocks { .. } => "target",
            Self::DragAngles { .. } => "angles",
            Self::PullLink { .. } => "link",
            Self::SlideB { .. } | Self::PoseB { .. } => "b",
            Self::Push { .. } => "push",
            Self::HandOver { .. } => "payload",
            Self::Set { change } => match change.keys().next() {
                Some(part) if is_of_machine(part) => "machine",
                Some(part) => part,
                None => "settings",
            },
            Self::Sketch(_) => "drawing",
        }
    }

    /// Returns whether the edit drags the machine: by the target, the angles, a link, or the slider of b.
    pub fn is_drag(&self) -> bool {
        matches!(
            self,
            Self::DragTarget { .. }
                | Self::DragBlocks { .. }
                | Self::DragAngles { .. }
                | Self::PullLink { .. }
                | Self::SlideB { .. }
        )
    }

    /// Returns whether the edit acts on the machine in motion, and changes nothing in its scenario: a drag, or a hand-over.
    pub fn acts_in_motion(&self) -> bool {
        self.is_drag() || matches!(self, Self::HandOver { .. })
    }

    /// Returns whether the edit changes joint limits.
    pub fn sets_limits(&self) -> bool {
        self.sets(&["limits"])
    }

    /// Returns key and value of the first joint limit that the edit changes, as the user would type them.
    pub(super) fn limits(&self) -> Option<(String, String)> {
        let (name, value) = self.part("limits")?.iter().next()?;
        Some((format!("limits.{name}"), change::typed(value)))
    }

    /// Returns whether the edit changes the force at the end effector.
    pub fn pushes(&self) -> bool {
        match self {
            Self::Push { .. } => true,
            edit => edit.part("plant").is_some_and(|change| change.contains_key("force")),
        }
    }

    /// Describes the edit, for menus and the event log.
    pub fn title(&self) -> String {
        self.title_after(None)
    }

    /// Whether it changes what a machine file holds, and nothing else: the machine and the brief of its design.
    pub(super) fn is_of_machine(&self) -> bool {
        match self {
            Self::Sketch(_) => true,
            Self::Set { change } => change.keys().all(|key| is_of_machine(key) || key == "design"),
            _ => false,
        }
    }

    /// Describes the edit; `inverse` undoes it, and tells from where points are moved.
    pub(super) fn title_after(&self, inverse: Option<&Self>) -> String {
        match self {
            Self::DragTarget { x, y } => format!("drag target to {x:.3}, {y:.3} m"),
            Self::DragBlocks { targets } => {
                let names: Vec<&str> = targets.keys().map(String::as_str).collect();
                format!("drag in space with {}", names.join(", "))
            }
            Self::DragAngles { a1, a2 } => {
                format!("turn links to a₁ {:.1}°, a₂ {:.1}°", a1.to_degrees(), a2.to_degrees())
            }
            Self::PullLink { link, x, y, .. } => format!("pull link {link} to {x:.3}, {y:.3} m, the tip held"),
            Self::SlideB { b } => format!("slide b to {b:.3} rad"),
            Self::PoseB { b } => format!("pose at b = {b:.3} rad"),
            Self::HandOver { from, to } => format!("{from} hands its payload to {to}"),
            Self::Push { x: 0.0, y: 0.0 } => "let go".into(),
            Self::Push { x, y } => format!("push with {x:.2}, {y:.2} N"),
            Self::Set { change } => title_of(change, inverse.and_then(|inverse| inverse.part("task"))),
            Self::Sketch(step) => step.title(),
        }
    }
}

/// Describes a change of the whole list of counterweights.
fn counterweights(value: &Value) -> String {
    let mass = |weight: &Value| weight.get("mass").and_then(change::number).unwrap_or_default();
    match value.as_array() {
        Some(all) => {
            format!("counterweights to {:.2} kg on {}", all.iter().map(mass).sum::<f64>(), counted(all.len(), "link"))
        }
        None => "counterweights to none".into(),
    }
}

/// Describes a change of the whole list of parts, lumps or materials.
fn list_of(kind: &str, value: &Value) -> String {
    match value.as_array().map_or(0, Vec::len) {
        0 => format!("no {kind}s"),
        1 => format!("one {kind}"),
        many => format!("{many} {kind}s"),
    }
}

/// Maximum number of significant digits of a number in the description of a change.
const TITLE_DIGITS: usize = 5;

/// Maximum number of settings in the description of a change.
const MOST_IN_TITLE: usize = 4;

/// Describes a change of settings; `before` is the task before it, if it is known.
fn title_of(change: &Table, before: Option<&Table>) -> String {
    let task = change.get("task").and_then(Value::as_table).filter(|_| change.len() == 1);
    match task {
        Some(task) if task.get("samples").is_some_and(Value::is_array) => return "take a given motion".into(),
        Some(task) if POINT_KEYS.iter().any(|key| task.contains_key(*key)) => {
            return waypoints::title(task, before);
        }
        Some(task) if task.is_empty() => return "go back to the path".into(),
        _ => {}
    }
    if let Some(b) = change.get("compare_b").filter(|_| change.len() == 1) {
        let with = |b: f64| format!("compare with b = {b:.3} rad");
        return change::number(b).map_or_else(|| "stop comparing".into(), with);
    }
    let one = |(path, value): (String, &Value)| {
        if path == "counterweight" {
            return counterweights(value);
        }
        if ["part", "lump", "material"].contains(&path.as_str()) {
            return list_of(&path, value);
        }
        let words = name_of(&path);
        if value.as_str() == Some(change::DEFAULT_WORD) {
            return format!("{words} back to normal");
        }
        if let Some(is_so) = value.as_bool() {
            return format!("{words}: {}", if is_so { "yes" } else { "no" });
        }
        let typed = match change::number(value) {
            Some(x) => at_most_digits(x, TITLE_DIGITS),
            None => shortened(&change::typed(value), 60),
        };
        let has_numbers = typed.starts_with(|c: char| c.is_ascii_digit() || c == '-');
        let unit = key_of(&path).map(Key::unit_of_each).filter(|unit| !unit.is_empty() && has_numbers);
        let unit = unit.map(|unit| format!(" {unit}")).unwrap_or_default();
        format!("{words} to {typed}{unit}")
    };
    // The lists of parts and counterweights say most about a change of many settings.
    let mut all = change::leaves(change);
    if all.len() > MOST_IN_TITLE {
        all.sort_by_key(|(path, _)| path.contains('.'));
    }
    let rest = match all.len() {
        n if n > MOST_IN_TITLE => format!(" and {} more", n - MOST_IN_TITLE + 1),
        _ => String::new(),
    };
    let shown = if rest.is_empty() { all.len() } else { MOST_IN_TITLE - 1 };
    format!("set {}{rest}", all.into_iter().take(shown).map(one).collect::<Vec<_>>().join(", "))
}
