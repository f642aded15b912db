//! [`AssemblyScenario`], as a file states it.

use std::collections::BTreeMap;

use nalgebra::{Matrix6, Vector3};
use serde::Deserialize;
use toml::{Table, Value};

use super::base::{AssemblyBase, FreeBase, SpringBase, inertia_of, six_by_six};
use super::tip::{TipChain, TipError, TipPath};
use crate::Run;
use crate::gentle_motion::gentle_motion;
use crate::scenario::{Scenario, ScenarioError};
use stillbase_mechanics::assembly::{Assembly, Compliance, Momentum, SpatialBase, builtin_assemblies};
use stillbase_mechanics::machine::{KeyPath, Machine, Payload};
use stillbase_mechanics::planar::{DriveAngles, PerDrive};
use stillbase_planning::curves::Samples;
use stillbase_settings::change::{self, DEFAULT_WORD};
use stillbase_settings::fault::{Fault, Faults};
use stillbase_settings::range::{MAX_SAID, quote_clipped, shortened};
use stillbase_settings::stated::StatedFile;
use stillbase_settings::text::plain;

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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: Option<String>,
    #[serde(default)]
    title: String,
    #[serde(default)]
    summary: String,
    #[serde(rename = "machine")]
    _machine: Value,
    lead: Option<Value>,
    against: Option<Value>,
    tip: Option<TipPath>,
    #[serde(default)]
    task: BTreeMap<String, Table>,
    /// Other settings of the scenarios of blocks, and their edits.
    #[serde(default)]
    scenario: BTreeMap<String, Table>,
    #[serde(default)]
    base: BaseInFile,
    step: Option<f64>,
    duration: Option<f64>,
}

#[derive(Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum BaseKind {
    #[default]
    Fixed,
    Free,
    Compliant,
}

impl BaseKind {
    fn word(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Free => "free",
            Self::Compliant => "compliant",
        }
    }
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct BaseInFile {
    #[serde(default)]
    kind: BaseKind,
    mass: Option<f64>,
    inertia: Option<Vec<f64>>,
    #[serde(default)]
    com: [f64; 3],
    momentum: Option<[f64; 3]>,
    angular_momentum: Option<[f64; 3]>,
    stiffness: Option<Vec<f64>>,
    damping: Option<Vec<f64>>,
}

/// Largest number of a base, in SI units.
const MAX_NUMBER: f64 = 1e9;

/// Range of the step, s, and of the duration, s.
const STEP: [f64; 2] = [1e-5, 0.01];
const DURATION: [f64; 2] = [1e-3, 1e6];

/// Reads a scenario of an assembly.
struct Reading<'a> {
    file: StatedFile<'a>,
    label: &'a str,
}

impl Reading<'_> {
    fn wrong(&self, keys: &[&str], said: impl Into<String>) -> ScenarioError {
        let path = KeyPath(keys.iter().map(|key| stillbase_mechanics::machine::KeyStep::Key((*key).into())).collect());
        let key = keys.join(".");
        // A key that is not stated is that of its table.
        let place = (0..=path.0.len()).rev().find_map(|n| self.file.place(&KeyPath(path.0[..n].to_vec())));
        let line = place.filter(|_| !keys.is_empty()).map(|place| place.line);
        let said: String = said.into();
        let text = if key.is_empty() { said } else { format!("{key}: {said}") };
        self.faulty(Faults::one(Fault { line, column: None, key, text, example: String::new() }))
    }

    fn faulty(&self, faults: Faults) -> ScenarioError {
        let (line, message) =
            faults.list.first().map_or((None, String::new()), |fault| (fault.line, shortened(&fault.text, MAX_SAID)));
        let first = Box::new(ScenarioError::Syntax { file: self.label.into(), line, message });
        ScenarioError::Faulty { file: self.label.into(), first, faults: Box::new(faults) }
    }

    fn scenario(&self, assembly: Assembly) -> Result<AssemblyScenario, ScenarioError> {
        let file: File = self.file.read().map_err(|error| {
            let line = error.span().and_then(|span| self.file.place(&self.file.path(&span))).map(|place| place.line);
            let text = shortened(error.message(), MAX_SAID);
            self.faulty(Faults::one(Fault { line, column: None, key: String::new(), text, example: String::new() }))
        })?;
        let within = |key: &str, x: Option<f64>, [least, most]: [f64; 2]| match x {
            Some(x) if !(least..=most).contains(&x) => {
                Err(self.wrong(&[key], format!("is {x}: want {least} to {most} s")))
            }
            x => Ok(x),
        };
        let step = within("step", file.step, STEP)?;
        let duration = within("duration", file.duration, DURATION)?;
        let names: Vec<&str> = assembly.blocks().iter().map(|block| block.name.as_str()).collect();
        let unknown = |name: &str| {
            format!("no block {:?}: want a block of the assembly, one of {}", quote_clipped(name), names.join(", "))
        };
        for (key, of) in [("task", &file.task), ("scenario", &file.scenario)] {
            if let Some(other) = of.keys().find(|key| !names.contains(&key.as_str())) {
                return Err(self.wrong(&[key, other], unknown(other)));
            }
        }
        let lead = match &file.lead {
            Some(name) => {
                let name =
                    name.as_str().ok_or_else(|| self.wrong(&["lead"], "want the name of a block, as \"arm\""))?;
                names.iter().position(|own| *own == name).ok_or_else(|| self.wrong(&["lead"], unknown(name)))?
            }
            None => 0,
        };
        let step = step.unwrap_or(USUAL_STEP);
        let chain = match &file.tip {
            Some(path) => {
                let tip_error = |TipError { key, said }| self.wrong(&["tip", key], said);
                let block = path.block(&assembly).map_err(tip_error)?;
                TipChain::of(&assembly, block, &path.b).map_err(tip_error)?.blocks().to_vec()
            }
            None => Vec::new(),
        };
        let mut tasks: Vec<Option<BlockTask>> = vec![None; names.len()];
        for (i, block) in assembly.blocks().iter().enumerate() {
            let (stated, other) = (file.task.get(&block.name), file.scenario.get(&block.name));
            if chain.contains(&i) {
                if stated.is_some() {
                    let said = format!("[tip] leads block {}: want no task of its own, or no [tip]", block.name);
                    return Err(self.wrong(&["task", &block.name], said));
                }
                continue;
            }
            let task = match (stated, &block.machine.spec().pose) {
                (Some(task), _) => task.clone(),
                (None, Some(pose)) => resting(pose),
                (None, None) => {
                    let said = format!(
                        "block {} has no task, and its machine no pose to rest in: want [task.{}]",
                        block.name, block.name
                    );
                    return Err(self.wrong(&["task"], said));
                }
            };
            let scenario = self.of_block(&assembly, i, (task, other), step)?;
            tasks[i] = Some(BlockTask { rests: stated.is_none() && scenario.edits.is_empty(), scenario });
        }
        let mut points = Vec::new();
        if let Some(path) = &file.tip {
            let rest: Vec<DriveAngles> = tasks.iter().map(rest_of).collect();
            let plan = path.plan(&assembly, &rest).map_err(|TipError { key, said }| self.wrong(&["tip", key], said))?;
            points = plan.points;
            for (i, samples) in plan.blocks.iter().zip(plan.samples) {
                let other = file.scenario.get(&assembly.blocks()[*i].name);
                let scenario = self.of_block(&assembly, *i, (given(&samples), other), step)?;
                tasks[*i] = Some(BlockTask { rests: false, scenario });
            }
        }
        let tasks: Vec<BlockTask> = tasks.into_iter().flatten().collect();
        let stem =
            std::path::Path::new(self.label).file_stem().map_or_else(|| self.label.into(), |s| s.to_string_lossy());
        let base = self.base(&file.base)?;
        if matches!(base, AssemblyBase::Free(_)) && assembly.gravity != Vector3::zeros() {
            let said =
                "is free, but the assembly states gravity: want gravity = [0, 0, 0], as in orbit, or a fixed base";
            return Err(self.wrong(&["base", "kind"], said));
        }
        let mut whole = AssemblyScenario {
            name: file.name.unwrap_or_else(|| plain(&stem).into_owned()),
            title: file.title,
            summary: file.summary,
            assembly: assembly.clone(),
            tasks,
            base,
            step,
            duration,
            lead,
            tip: file.tip.map(|path| TipTask { path, blocks: chain, points }),
            against: None,
        };
        if let Some(pair) = &file.against {
            let wrong = |said: String| self.wrong(&["against"], said);
            let place = |name: &str| names.iter().position(|own| *own == name).ok_or_else(|| wrong(unknown(name)));
            // On the command line a list is words with commas between them.
            let pair: Vec<&str> = match pair {
                Value::String(words) => words.split(',').map(str::trim).collect(),
                Value::Array(list) => list.iter().filter_map(Value::as_str).collect(),
                _ => Vec::new(),
            };
            let want = || wrong("want the names of two blocks, as [\"left\", \"right\"]".into());
            let [one, other] = pair[..] else { return Err(want()) };
            whole.bind([place(one)?, place(other)?]).map_err(wrong)?;
        }
        Ok(whole)
    }

    fn base(&self, base: &BaseInFile) -> Result<AssemblyBase, ScenarioError> {
        let wrong = |key: &str, said: &str| self.wrong(&["base", key], said);
        let BaseInFile { momentum, angular_momentum, stiffness, damping, .. } = base;
        let is_of = |kind: BaseKind, key: &str, is_stated: bool| match is_stated && base.kind != kind {
            true => Err(wrong(
                key,
                &format!("has no use there: want kind = \"{}\", or no {key} (--set base.{key}=default)", kind.word()),
            )),
            false => Ok(()),
        };
        is_of(BaseKind::Free, "momentum", momentum.is_some())?;
        is_of(BaseKind::Free, "angular_momentum", angular_momentum.is_some())?;
        is_of(BaseKind::Compliant, "stiffness", stiffness.is_some())?;
        is_of(BaseKind::Compliant, "damping", damping.is_some())?;
        if base.kind == BaseKind::Fixed {
            return Ok(AssemblyBase::Fixed);
        }
        let mass = base.mass.filter(|mass| *mass > 0.0 && *mass <= MAX_NUMBER);
        let mass = mass.ok_or_else(|| wrong("mass", "want the mass of the base above 0, kg"))?;
        let inertia = base.inertia.as_deref().and_then(inertia_of);
        let want = "want [x, y, z] about the centre of mass of the base, kg m², or nine numbers row by row, symmetric";
        let inertia = inertia.filter(|inertia| inertia.iter().all(|x| x.abs() <= MAX_NUMBER));
        let inertia = inertia.ok_or_else(|| wrong("inertia", want))?;
        let asymmetry = (inertia - inertia.transpose()).amax();
        if asymmetry > 1e-9 * inertia.amax() {
            return Err(wrong("inertia", want));
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
            return Err(wrong("inertia", &said));
        }
        if !base.com.iter().all(|x| x.abs() <= 1e6) {
            return Err(wrong("com", "want three numbers, m"));
        }
        let body = SpatialBase { mass, com: base.com.into(), inertia };
        if base.kind == BaseKind::Free {
            let kept = |key: &str, stated: &Option<[f64; 3]>, unit: &str| {
                let numbers = stated.unwrap_or_default();
                match numbers.iter().all(|x| x.abs() <= MAX_NUMBER) {
                    true => Ok(Vector3::from(numbers)),
                    false => Err(wrong(key, &format!("is {numbers:?}: want three numbers, {unit}"))),
                }
            };
            let linear = kept("momentum", momentum, "kg m/s")?;
            let angular = kept("angular_momentum", angular_momentum, "kg m²/s, about the common centre of mass")?;
            return Ok(AssemblyBase::Free(FreeBase { body, kept: Momentum { linear, angular } }));
        }
        let six = |key: &str, stated: &Option<Vec<f64>>, unit: &str| {
            let numbers = stated.as_deref().unwrap_or_default();
            if let Some(x) = numbers.iter().find(|x| x.is_nan() || x.abs() > MAX_NUMBER) {
                return Err(wrong(key, &format!("holds {x}: want numbers of at most {MAX_NUMBER}, {unit}")));
            }
            six_by_six(numbers).ok_or_else(|| {
                wrong(key, &format!("want six numbers, along and about x, y, z, {unit}, or all 36 row by row"))
            })
        };
        let stiffness = six("stiffness", stiffness, "N/m and N m/rad")?;
        let damping = match damping {
            Some(_) => six("damping", damping, "N s/m and N m s")?,
            None => Matrix6::zeros(),
        };
        Compliance::new(&stiffness, &damping).map_err(|why| self.wrong(&["base"], why.to_string()))?;
        Ok(AssemblyBase::Compliant(Box::new(SpringBase { body, stiffness, damping })))
    }

    /// Returns the task of a block, and its other settings, as a scenario of its machine with what it carries as payload.
    fn of_block(
        &self,
        assembly: &Assembly,
        i: usize,
        (task, other): (Table, Option<&Table>),
        step: f64,
    ) -> Result<Scenario, ScenarioError> {
        let block = &assembly.blocks()[i];
        let machine = holding(assembly, i).map_err(|why| self.wrong(&["task", &block.name], why))?;
        let mut text = other.cloned().unwrap_or_default();
        if let Some(key) = text.keys().find(|key| !BLOCK_KEYS.contains(&key.as_str())) {
            let said = format!("is no setting of a block: want one of {}", BLOCK_KEYS.join(", "));
            return Err(self.wrong(&["scenario", &block.name, key], said));
        }
        text.insert("step".into(), Value::Float(step));
        let spec =
            Value::try_from(machine.spec()).map_err(|why| self.wrong(&["task", &block.name], why.to_string()))?;
        text.insert("name".into(), Value::String(block.name.clone()));
        text.insert("machine".into(), spec);
        text.insert("task".into(), Value::Table(task));
        Scenario::parse(&text.to_string(), self.label, None).map_err(|error| {
            let ScenarioError::Faulty { faults, .. } = error else {
                return self.wrong(&["task", &block.name], error.to_string());
            };
            let placed = faults.list.into_iter().map(|fault| self.placed(&block.name, fault));
            self.faulty(Faults { list: placed.collect(), ..*faults })
        })
    }

    /// Gives a fault of a block's task its place in this file.
    fn placed(&self, block: &str, fault: Fault) -> Fault {
        let first = fault.key.split(['.', '[']).next().unwrap_or_default();
        let key = match fault.key.strip_prefix("task") {
            Some(rest) => format!("task.{block}{rest}"),
            None if BLOCK_KEYS.contains(&first) => format!("scenario.{block}.{}", fault.key),
            None => format!("task.{block}"),
        };
        let path = KeyPath::of_key(&key);
        let place = (0..=path.0.len()).rev().find_map(|n| self.file.place(&KeyPath(path.0[..n].to_vec())));
        let text = format!("block {block}: {}", fault.text);
        Fault { line: place.map(|place| place.line), column: place.map(|place| place.column), key, text, ..fault }
    }
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
const BLOCK_KEYS: [&str; 7] = ["control", "compare_b", "pose_acceleration", "edit", "bookmark", "note", "branch"];

/// Step where none is stated, s.
const USUAL_STEP: f64 = 1e-3;

/// Number and distance, s, of the samples of a block at rest.
const REST_SAMPLES: u32 = 7;
const REST_INTERVAL_S: f64 = 0.01;

/// Returns the keys of a file with some of them changed; the word `default` removes a key.
pub fn changed_keys(stated: Table, wanted: &Table) -> Table {
    fn without_defaults(table: &mut Table) {
        table.retain(|_, value| value.as_str() != Some(DEFAULT_WORD));
        table.iter_mut().filter_map(|(_, value)| value.as_table_mut()).for_each(without_defaults);
    }
    let mut all = change::join(stated, wanted);
    without_defaults(&mut all);
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

/// Returns the task of a block that samples lead.
fn given(samples: &Samples) -> Table {
    let row = |row: &[f64]| Value::Array(row.iter().map(|x| Value::Float(*x)).collect());
    let rows = Value::Array(samples.rows().map(row).collect());
    Table::from_iter([("kind".into(), Value::String("given".into())), ("samples".into(), rows)])
}

/// Returns the task of a block that rests in a pose, rad.
fn resting(pose: &[f64]) -> Table {
    let row = |i: u32| {
        let time = f64::from(i) * REST_INTERVAL_S;
        Value::Array([time].iter().chain(pose).map(|x| Value::Float(*x)).collect())
    };
    let samples = Value::Array((0..REST_SAMPLES).map(row).collect());
    Table::from_iter([("kind".into(), Value::String("given".into())), ("samples".into(), samples)])
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
        file.extend(base_to_table(&self.base).map(|base| ("base".to_owned(), Value::Table(base))));
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
        match StatedFile::parse(text) {
            Ok(file) => Reading { file, label }.scenario(assembly),
            Err(errors) => {
                let message = errors.first().map_or("this is not TOML", |error| error.message());
                Err(ScenarioError::Syntax { file: label.into(), line: None, message: shortened(message, MAX_SAID) })
            }
        }
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
        Self::parse(&changed_keys(stated, change).to_string(), label, self.assembly)
    }
}
