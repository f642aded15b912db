//! [`AssemblyScenario`], as a file states it.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Matrix6, Vector3};
use serde::de::{Error as _, IgnoredAny};
use serde::{Deserialize, Deserializer};
use toml::{Table, Value};

use super::base::{AssemblyBase, FreeBase, SpringBase, inertia_of, six_by_six};
use super::keys::{USUAL_STEP, assembly_key_of};
use super::stated_base::StatedBase;
use super::tip::{TipChain, TipError, TipPath};
use super::words::AssemblyScenarioWords;
use crate::Run;
use crate::gentle_motion::gentle_motion;
use crate::scenario::{Scenario, ScenarioError, Task, TaskKind, read_of_machine};
use stillbase_mechanics::assembly::{Assembly, Compliance, ComplianceError, Momentum, SpatialBase, builtin_assemblies};
use stillbase_mechanics::machine::{KeyPath, KeyStep, Machine, Payload};
use stillbase_mechanics::planar::{DriveAngles, PerDrive};
use stillbase_planning::curves::Samples;
use stillbase_settings::change::{self, DEFAULT_WORD};
use stillbase_settings::key::{self, Key};
use stillbase_settings::mending::{Problem, Wrong, bare, faults_of};
use stillbase_settings::range::{MAX_SAID, RangeCheck, quote_clipped, range_error, shortened};
use stillbase_settings::spelling::nearest_words;
use stillbase_settings::stated::{MendValue, StatedFile};
use stillbase_settings::text::{control_character, plain};
use stillbase_simulation::plant::BaseKind;

/// A scenario of an assembly.
#[derive(Clone, Debug, PartialEq)]
pub struct AssemblyScenario {
    /// Its name.
    pub name: String,
    /// Its title.
    pub title: String,
    /// Description in one sentence.
    pub summary: String,
    /// The assembly.
    pub assembly: Assembly,
    /// What each block does, in the order of the blocks.
    pub tasks: Vec<BlockTask>,
    /// The base.
    pub base: AssemblyBase,
    /// Step, s.
    pub step: f64,
    /// Duration, s; `None` for the longest task.
    pub duration: Option<f64>,
    /// The block that the window leads first.
    pub lead: usize,
    /// A path of the end effector of a block, by which all blocks that carry it are led.
    pub tip: Option<TipTask>,
    /// Two blocks with parallel planes of which one changes its b against the other's, so that the base feels no moment.
    pub against: Option<[usize; 2]>,
    /// Keys of the base that the file states, and of which its kind has no use.
    pub idle: Table,
}

/// What a block does.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockTask {
    /// The scenario of its machine by itself, which holds what the block carries.
    pub scenario: Scenario,
    /// Whether the file states no task: the block rests in the pose of its machine.
    pub rests: bool,
}

/// A path of an end effector, with the blocks that it leads.
#[derive(Clone, Debug, PartialEq)]
pub struct TipTask {
    /// The path.
    pub path: TipPath,
    /// Places of the blocks in the assembly, the one on the base first. Their tasks are samples that the path gives.
    pub blocks: Vec<usize>,
    /// The points of the path in order, m, in axes of the base.
    pub points: Vec<[f64; 3]>,
}

/// A table whose keys are read later.
type AnyTable = BTreeMap<String, IgnoredAny>;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: Option<String>,
    #[serde(default)]
    title: String,
    #[serde(default)]
    summary: String,
    #[serde(rename = "machine")]
    _machine: IgnoredAny,
    lead: Option<String>,
    against: Option<BlockPair>,
    tip: Option<TipPath>,
    #[serde(default)]
    task: BTreeMap<String, AnyTable>,
    /// Other settings of the scenarios of blocks, and their edits.
    #[serde(default)]
    scenario: BTreeMap<String, AnyTable>,
    #[serde(default)]
    base: StatedBase,
    step: Option<f64>,
    duration: Option<f64>,
}

/// The names of two blocks: a list or, from the command line, words with a comma between them.
struct BlockPair([String; 2]);

impl<'de> Deserialize<'de> for BlockPair {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Stated {
            List(Vec<String>),
            Words(String),
        }
        let want = || D::Error::custom("want the names of two blocks, as [\"left\", \"right\"]");
        let names: Vec<String> = match Stated::deserialize(from).map_err(|_| want())? {
            Stated::List(list) => list,
            Stated::Words(words) => {
                words.trim_matches(['[', ']']).split(',').map(|word| word.trim().to_owned()).collect()
            }
        };
        names.try_into().map(Self).map_err(|_| want())
    }
}

/// Reads a scenario of an assembly.
struct Reading<'a> {
    file: &'a StatedFile<'a>,
    label: &'a str,
    assembly: &'a Assembly,
    /// Names of the blocks.
    names: &'a [String],
}

/// The first thing that is wrong.
type First = Box<Problem>;

fn first<T>(keys: &[&str], wrong: Wrong) -> Result<T, First> {
    let path = KeyPath(keys.iter().map(|key| KeyStep::Key((*key).into())).collect());
    Err(Box::new(Problem { path, wrong }))
}

fn wrong<T>(keys: &[&str], said: impl Into<String>) -> Result<T, First> {
    first(keys, Wrong::Value(said.into()))
}

/// Tells why there is no such path of an end effector.
fn refused<T>(TipError { key, said }: TipError) -> Result<T, First> {
    first(&["tip", key], Wrong::Refused(said))
}

impl Reading<'_> {
    /// Returns the place of a block that a key names.
    fn place(&self, key: &str, name: &str) -> Result<usize, First> {
        match self.names.iter().position(|own| own == name) {
            Some(place) => Ok(place),
            None => {
                let nearest = nearest_words(name, self.names.iter().map(String::as_str));
                let nearest: String = nearest.iter().map(|name| format!("{name:?} (nearest), or ")).collect();
                let (name, all) = (quote_clipped(name), self.names.join(", "));
                wrong(&[key], format!("names no block {name:?}: want {nearest}a block of the assembly, one of {all}"))
            }
        }
    }

    /// Checks that the keys of a table are names of blocks.
    fn check_names<'n>(
        &self,
        table: &[&str],
        keys: impl IntoIterator<Item = &'n String>,
        known: &[String],
    ) -> Result<(), First> {
        match keys.into_iter().find(|key| !known.contains(key)) {
            Some(other) => first(&[table, &[other]].concat(), Wrong::UnknownKey(known.to_vec())),
            None => Ok(()),
        }
    }

    /// Checks that names are printable and numbers in their ranges.
    fn check_values(&self, file: &File) -> Result<(), First> {
        let name = file.name.as_deref().unwrap_or_default();
        for (key, text) in [("name", name), ("title", &file.title), ("summary", &file.summary)] {
            if let Some(c) = control_character(text) {
                let said = format!("holds the control character U+{:04X}: want printable characters", u32::from(c));
                return wrong(&[key], said);
            }
        }
        let stated: Table = self.file.read().unwrap_or_default();
        let own = |key: &&String| !["machine", "task", "scenario"].contains(&key.as_str());
        let stated: Table = stated.iter().filter(|(key, _)| own(key)).map(|(k, v)| (k.clone(), v.clone())).collect();
        match key::checks(assembly_key_of, &stated).into_iter().find(|check| !check.ok) {
            Some(RangeCheck { key, value, want, .. }) => {
                let said = range_error("", value, &want).trim_start().to_owned();
                Err(Box::new(Problem { path: KeyPath::of_key(&key), wrong: Wrong::Value(said) }))
            }
            None => Ok(()),
        }
    }

    fn scenario(&self) -> Result<AssemblyScenario, First> {
        let (assembly, names) = (self.assembly, self.names);
        let file: File = self.file.read().map_err(|error| Box::new(Problem::of(self.file, &error)))?;
        self.check_names(&["task"], file.task.keys(), names)?;
        self.check_names(&["scenario"], file.scenario.keys(), names)?;
        for (block, keys) in &file.scenario {
            self.check_names(&["scenario", block], keys.keys(), &BLOCK_KEYS.map(str::to_owned))?;
        }
        self.check_values(&file)?;
        let lead = file.lead.as_deref().map_or(Ok(0), |name| self.place("lead", name))?;
        let pair = file.against.as_ref().map(|BlockPair(pair)| self.pair(pair)).transpose()?;
        let base = self.base(&file.base)?;
        let chain = match &file.tip {
            Some(path) => self.chain(path)?,
            None => Vec::new(),
        };
        let step = file.step.unwrap_or(USUAL_STEP);
        let mut tasks: Vec<Option<BlockTask>> = vec![None; names.len()];
        for (i, block) in assembly.blocks().iter().enumerate() {
            let stated = file.task.contains_key(&block.name);
            if chain.contains(&i) {
                if stated {
                    let said = "is that of a block which [tip] leads: want no task of its own, or no [tip]";
                    return first(&["task", &block.name], Wrong::Refused(said.into()));
                }
                continue;
            }
            let task = match (stated, &block.machine.spec().pose) {
                (true, _) => None,
                (false, Some(pose)) => Some(self.sampled(i, resting(pose))?),
                (false, None) => continue,
            };
            let scenario = self.of_block(i, task.as_ref())?;
            tasks[i] = Some(BlockTask { rests: !stated && scenario.edits.is_empty(), scenario });
        }
        if let Some(i) = (0..tasks.len()).find(|i| tasks[*i].is_none() && !chain.contains(i)) {
            let name = &names[i];
            let said = format!("block {name} has no task, and its machine no pose to rest in: want [task.{name}]");
            return first(&["task", name], Wrong::Follows(said, self.some_task(i)));
        }
        let mut points = Vec::new();
        if let Some(path) = &file.tip {
            let rest: Vec<DriveAngles> = tasks.iter().map(rest_of).collect();
            let plan = path.plan(assembly, &rest).or_else(refused)?;
            points = plan.points;
            for (i, samples) in plan.blocks.iter().zip(plan.samples) {
                let task = self.sampled(*i, Some(samples))?;
                tasks[*i] = Some(BlockTask { rests: false, scenario: self.of_block(*i, Some(&task))? });
            }
        }
        let tasks: Vec<BlockTask> = tasks.into_iter().flatten().collect();
        let stem =
            std::path::Path::new(self.label).file_stem().map_or_else(|| self.label.into(), |s| s.to_string_lossy());
        let mut whole = AssemblyScenario {
            name: file.name.unwrap_or_else(|| plain(&stem).into_owned()),
            title: file.title,
            summary: file.summary,
            assembly: assembly.clone(),
            tasks,
            base,
            step,
            duration: file.duration,
            lead,
            tip: file.tip.map(|path| TipTask { path, blocks: chain, points }),
            against: None,
            idle: self.idle(&file.base),
        };
        if let Some(pair) = pair {
            whole.bind(pair).or_else(|said| first(&["against"], Wrong::Refused(said)))?;
        }
        Ok(whole)
    }

    /// Returns a task that a block can do, as lines of the file; empty if none is found.
    fn some_task(&self, i: usize) -> String {
        let made = holding(self.assembly, i).ok().and_then(|machine| gentle_motion(&machine).ok());
        let task = made.and_then(|made| toml::to_string(&made.task).ok());
        task.map_or_else(String::new, |task| format!("[task.{}]\n{}", bare(&self.names[i]), task.trim_end()))
    }

    /// Returns the places of two blocks.
    fn pair(&self, pair: &[String; 2]) -> Result<[usize; 2], First> {
        Ok([self.place("against", &pair[0])?, self.place("against", &pair[1])?])
    }

    /// Returns the places of the blocks that a path leads.
    fn chain(&self, path: &TipPath) -> Result<Vec<usize>, First> {
        let chain = path.chain(self.assembly).or_else(refused)?;
        let known: Vec<String> = chain.iter().map(|i| self.names[*i].clone()).collect();
        self.check_names(&["tip", "b"], path.b.keys(), &known)?;
        TipChain::of(self.assembly, &chain, &path.b).map_or_else(refused, |_| Ok(chain))
    }

    /// Returns the stated keys of the base of which its kind has no use.
    fn idle(&self, base: &StatedBase) -> Table {
        let stated: Table = self.file.inner("base").and_then(|inner| inner.read().ok()).unwrap_or_default();
        base.idle(&stated)
    }

    fn base(&self, stated: &StatedBase) -> Result<AssemblyBase, First> {
        let kind = stated.kind;
        if kind == BaseKind::Fixed {
            return Ok(AssemblyBase::Fixed);
        }
        let missing = |key: &str| first(&["base"], Wrong::Missing(key.into()));
        let Some(mass) = stated.mass else { return missing("mass") };
        let Some(inertia) = &stated.inertia else { return missing("inertia") };
        let body = SpatialBase { mass, com: stated.com.into(), inertia: sound_inertia(&inertia.0)? };
        if kind == BaseKind::Free {
            if self.assembly.gravity != Vector3::zeros() {
                let said =
                    "is free, but the assembly states gravity: want gravity = [0, 0, 0], as in orbit, or a fixed base";
                return first(&["base", "kind"], Wrong::Refused(said.into()));
            }
            let (linear, angular) = (stated.momentum.into(), stated.angular_momentum.into());
            return Ok(AssemblyBase::Free(FreeBase { body, kept: Momentum { linear, angular } }));
        }
        let Some(stiffness) = stated.stiffness.as_ref().and_then(|list| six_by_six(&list.0)) else {
            return missing("stiffness");
        };
        let damping = stated.damping.as_ref().and_then(|list| six_by_six(&list.0)).unwrap_or_else(Matrix6::zeros);
        Compliance::new(&stiffness, &damping).or_else(|why| {
            let (ComplianceError::NotFinite { what, .. }
            | ComplianceError::NotSymmetric { what, .. }
            | ComplianceError::Negative { what, .. }) = &why;
            first(&["base", *what], Wrong::Said(format!("base.{why}")))
        })?;
        Ok(AssemblyBase::Compliant(Box::new(SpringBase { body, stiffness, damping })))
    }

    /// Returns the task of a block that samples lead.
    fn sampled(&self, i: usize, samples: Option<Samples>) -> Result<Task, First> {
        let name = &self.names[i];
        let machine = holding(self.assembly, i).or_else(|why| wrong(&["task", name], why))?;
        let made = samples.and_then(|samples| Task::sampled(TaskKind::Given, samples, None, &machine).ok());
        made.map_or_else(|| wrong(&["task", name], "is missing, and cannot be made: want one"), Ok)
    }

    /// Returns what the file states of a block as a scenario of its machine, with what it carries as payload; the task is the
    /// given one, or that of the file.
    fn of_block(&self, i: usize, task: Option<&Task>) -> Result<Scenario, First> {
        let block = &self.assembly.blocks()[i];
        let machine = holding(self.assembly, i).or_else(|why| wrong(&["task", &block.name], why))?;
        let of_block = self.file.inner("scenario").and_then(|all| all.inner(&block.name));
        let mut own = of_block.unwrap_or_else(|| self.file.emptied());
        own.copy("step", self.file, &KeyPath::new(&[&"step"]));
        match task {
            Some(_) => drop(own.set(&KeyPath::new(&[&"task"]), &MendValue::Toml("{}"))),
            None => own.copy("task", self.file, &KeyPath::new(&[&"task", &block.name])),
        }
        for key in ["name", "machine"] {
            own.set(&KeyPath::new(&[&key]), &MendValue::Word(block.name.clone()));
        }
        read_of_machine(&own, self.label, &machine, task).map_err(|problem| Box::new(placed(&block.name, problem)))
    }
}

/// Gives a problem of a block its place in this file.
fn placed(block: &str, Problem { path, wrong }: Problem) -> Problem {
    let part = path.0.first().map_or("task", |step| match step {
        KeyStep::Key(key) if BLOCK_KEYS.contains(&key.as_str()) => "scenario",
        _ => "task",
    });
    let rest = match path.0.split_first() {
        Some((KeyStep::Key(key), rest)) if key == "task" => rest.to_vec(),
        _ if part == "scenario" => path.0,
        _ => Vec::new(),
    };
    let head = [part, block].map(|key| KeyStep::Key(key.into()));
    let said = |text: String| format!("block {block}: {text}");
    let wrong = match wrong {
        Wrong::Said(text) => Wrong::Said(said(text)),
        Wrong::Name(text, known) => Wrong::Name(said(text), known),
        Wrong::Follows(text, example) => Wrong::Follows(said(text), example),
        Wrong::Last(text) => Wrong::Last(said(text)),
        other => other,
    };
    Problem { path: KeyPath(head.into_iter().chain(rest).collect()), wrong }
}

/// Returns an inertia that a body can have.
fn sound_inertia(numbers: &[f64]) -> Result<Matrix3<f64>, First> {
    let key = ["base", "inertia"];
    let Some(inertia) = inertia_of(numbers) else { return wrong(&key, "is no inertia") };
    if (inertia - inertia.transpose()).amax() > 1e-9 * inertia.amax() {
        return wrong(&key, "is not symmetric");
    }
    let moments = inertia.symmetric_eigenvalues();
    // Of a body no principal moment exceeds the sum of the two others.
    let (sum, most) = (moments.sum(), moments.max());
    if !(moments.min() > 0.0 && 2.0 * most <= sum * (1.0 + 1e-9)) {
        let [a, b, c] = moments.into();
        let said = format!(
            "has the principal moments {a:.6}, {b:.6}, {c:.6} kg m²: want three above 0, none more than the two others \
             together"
        );
        return wrong(&key, said);
    }
    Ok(inertia)
}

/// Returns the machine of a block with what it carries held at its end effector.
pub(super) fn holding(assembly: &Assembly, i: usize) -> Result<Machine, String> {
    let block = &assembly.blocks()[i];
    let carried = assembly.mass_above(i) - block.inertia.mass();
    let mut spec = block.machine.spec().clone();
    if carried > 0.0 {
        spec.payload = spec.payload.and(Payload { mass: carried, axial: spec.payload.axial, ..Payload::default() });
    }
    Machine::new(spec).map_err(|why| why.to_string())
}

/// Keys of a scenario that a block may state for itself, beside its task.
pub(super) const BLOCK_KEYS: [&str; 7] =
    ["control", "compare_b", "pose_acceleration", "edit", "bookmark", "note", "branch"];

/// Number and distance, s, of the samples of a block at rest.
const REST_SAMPLES: u32 = 7;
const REST_INTERVAL_S: f64 = 0.01;

/// Returns the keys of a file with some of them changed; the word `default` removes a key, and so does `none` if that is its
/// default.
pub fn changed_keys(stated: Table, wanted: &Table) -> Table {
    fn without_defaults(at: &str, table: &mut Table) {
        let path = |key: &str| if at.is_empty() { key.to_owned() } else { format!("{at}.{key}") };
        table.retain(|key, value| match value.as_str() {
            Some(DEFAULT_WORD) => false,
            Some(Key::NONE) => assembly_key_of(&path(key)).is_none_or(|key| key.default != Key::NONE),
            _ => true,
        });
        table
            .iter_mut()
            .filter_map(|(key, value)| Some((path(key), value.as_table_mut()?)))
            .for_each(|(path, table)| without_defaults(&path, table));
    }
    let mut all = change::join(stated, wanted);
    without_defaults("", &mut all);
    all
}

/// Returns a base as its file states it; `None` for one that does not move.
fn base_to_table(base: &AssemblyBase) -> Option<Table> {
    let list = |numbers: &[f64]| Value::Array(numbers.iter().map(|x| Value::Float(*x)).collect());
    let SpatialBase { mass, com, inertia } = base.body()?;
    let rows = |matrix: &Matrix6<f64>| list(matrix.transpose().as_slice());
    let own = match base {
        AssemblyBase::Fixed => return None,
        AssemblyBase::Free(FreeBase { kept: Momentum { linear, angular }, .. }) => [
            ("kind", Value::String("free".into())),
            ("momentum", list(linear.as_slice())),
            ("angular_momentum", list(angular.as_slice())),
        ],
        AssemblyBase::Compliant(of) => [
            ("kind", Value::String("compliant".into())),
            ("stiffness", rows(&of.stiffness)),
            ("damping", rows(&of.damping)),
        ],
    };
    let body = [
        ("mass", Value::Float(*mass)),
        ("com", list(com.as_slice())),
        ("inertia", list(inertia.transpose().as_slice())),
    ];
    Some(own.into_iter().chain(body).map(|(key, value)| (key.to_owned(), value)).collect())
}

/// Returns where a block is at the start, rad; of a block without a task, nowhere.
fn rest_of(task: &Option<BlockTask>) -> DriveAngles {
    let run = task.as_ref().and_then(|task| Run::or_waiting(&task.scenario).ok());
    run.map_or_else(|| DriveAngles(PerDrive::zeros(0)), |run| run.plan().motion.at(0.0).q)
}

/// Returns samples of a block that rests in a pose, rad.
fn resting(pose: &[f64]) -> Option<Samples> {
    let row = |i: u32| [&[f64::from(i) * REST_INTERVAL_S], pose].concat();
    Samples::new(&(0..REST_SAMPLES).map(row).collect::<Vec<_>>()).ok()
}

impl AssemblyScenario {
    /// Returns the scenario as TOML, from which [`parse`](Self::parse) gives an equal one. A built-in assembly is named,
    /// any other is written out.
    ///
    /// # Panics
    /// Never: every scenario can be written.
    pub fn to_toml(&self) -> String {
        let known = builtin_assemblies().contains(&self.assembly);
        let machine = match known {
            true => Value::String(self.assembly.name.clone()),
            false => Value::try_from(self.assembly.spec()).expect("an assembly is plain data"),
        };
        let mut file = Table::new();
        for (key, text) in [("name", &self.name), ("title", &self.title), ("summary", &self.summary)] {
            file.insert(key.into(), Value::String(text.clone()));
        }
        file.insert("machine".into(), machine);
        file.insert("lead".into(), Value::String(self.assembly.blocks()[self.lead].name.clone()));
        file.extend(self.against.map(|pair| {
            let name = |i: usize| Value::String(self.assembly.blocks()[i].name.clone());
            ("against".to_owned(), Value::Array(pair.map(name).into()))
        }));
        file.extend(self.tip.iter().map(|tip| {
            let path = Value::try_from(&tip.path).expect("a path is plain data");
            ("tip".to_owned(), path)
        }));
        let is_led = |i: usize| self.tip.as_ref().is_some_and(|tip| tip.blocks.contains(&i));
        file.insert("step".into(), Value::Float(self.step));
        file.extend(self.duration.map(|duration| ("duration".to_owned(), Value::Float(duration))));
        let base: Table = base_to_table(&self.base).into_iter().flatten().chain(self.idle.clone()).collect();
        file.insert("base".into(), Value::Table(base));
        let (mut tasks, mut others) = (Table::new(), Table::new());
        for (i, (block, task)) in self.assembly.blocks().iter().zip(&self.tasks).enumerate() {
            let mut own: Table = task.scenario.to_toml().parse().expect("a scenario is written as TOML");
            let stated = own.remove("task").filter(|_| !task.rests && !is_led(i));
            tasks.extend(stated.map(|stated| (block.name.clone(), stated)));
            own.retain(|key, _| BLOCK_KEYS.contains(&key));
            others.insert(block.name.clone(), Value::Table(own));
        }
        file.insert("task".into(), Value::Table(tasks));
        file.insert("scenario".into(), Value::Table(others));
        toml::to_string(&file).expect("a table is plain data")
    }

    /// Reads a scenario of an assembly from text; errors name `label`.
    ///
    /// # Errors
    /// If the text is no such scenario; the error names the line.
    pub fn parse(text: &str, label: &str, assembly: Assembly) -> Result<Self, ScenarioError> {
        let names: Vec<String> = assembly.blocks().iter().map(|block| block.name.clone()).collect();
        let read = |file: &StatedFile| Reading { file, label, assembly: &assembly, names: &names }.scenario();
        let words = AssemblyScenarioWords { blocks: &names };
        let first = match StatedFile::parse(text).map(|file| (read(&file), file)) {
            Ok((Ok(scenario), _)) => return Ok(scenario),
            Ok((Err(problem), file)) => Some((file.place(&problem.path).map(|place| place.line), problem.text(&words))),
            Err(_) => None,
        };
        let faults = faults_of(text, &words, &|file| read(file).map(|_| ()).map_err(|problem| *problem));
        let of_list = || faults.list.first().map(|fault| (fault.line, fault.text.clone())).unwrap_or_default();
        let (line, message) = first.unwrap_or_else(of_list);
        let message = shortened(&message, MAX_SAID);
        let first = Box::new(ScenarioError::Syntax { file: label.into(), line, message });
        Err(ScenarioError::Faulty { file: label.into(), first, faults: Box::new(faults) })
    }

    /// Returns a scenario in which each block does a small motion of its own.
    ///
    /// # Errors
    /// If no task can be stated for the machine of a block.
    pub fn for_assembly(assembly: Assembly) -> Result<Self, ScenarioError> {
        let mut tasks = Vec::with_capacity(assembly.blocks().len());
        for (i, block) in assembly.blocks().iter().enumerate() {
            let wrong = |message| ScenarioError::Syntax { file: block.name.clone(), line: None, message };
            let made = gentle_motion(&holding(&assembly, i).map_err(wrong)?)?;
            let scenario = Scenario { name: block.name.clone(), title: String::new(), step: USUAL_STEP, ..made };
            tasks.push(BlockTask { scenario, rests: false });
        }
        let (name, summary) = (assembly.name.clone(), assembly.summary.clone());
        let (title, base, step) = (name.clone(), AssemblyBase::Fixed, USUAL_STEP);
        Ok(Self {
            name,
            title,
            summary,
            assembly,
            tasks,
            base,
            step,
            duration: None,
            lead: 0,
            tip: None,
            against: None,
            idle: Table::new(),
        })
    }

    /// Returns the scenario with keys of its file changed; the word `default` removes one. Errors name `label`.
    ///
    /// # Errors
    /// If a key or value is wrong.
    pub fn with_changes(self, change: &Table, label: &str) -> Result<Self, ScenarioError> {
        if change.is_empty() {
            return Ok(self);
        }
        let stated: Table = self.to_toml().parse().unwrap_or_default();
        let changed = changed_keys(stated, change).to_string();
        Self::parse(&changed, label, self.assembly).map_err(|why| why.without_lines(label))
    }
}
