//! [`AssemblyScenario`], as a file states it.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Vector3};
use serde::Deserialize;
use toml::{Table, Value};

use crate::scenario::{Scenario, ScenarioError};
use stillbase_mechanics::assembly::{Assembly, SpatialBase};
use stillbase_mechanics::machine::{KeyPath, Machine, Payload};
use stillbase_settings::fault::{Fault, Faults};
use stillbase_settings::range::{MAX_SAID, quote_clipped, shortened};
use stillbase_settings::stated::StatedFile;
use stillbase_settings::text::plain;

/// A scenario of an assembly.
#[derive(Clone, Debug)]
pub struct AssemblyScenario {
    /// Its name.
    pub name: String,
    /// Its title.
    pub title: String,
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
}

/// What a block does.
#[derive(Clone, Debug)]
pub enum BlockTask {
    /// The task of a machine by itself, which holds what the block carries.
    Moves(Box<Scenario>),
    /// It rests at these angles, rad.
    Rests(Vec<f64>),
}

/// The base of an assembly.
#[derive(Clone, Debug, PartialEq)]
pub enum AssemblyBase {
    /// It does not move.
    Fixed,
    /// It floats.
    Free(SpatialBase),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: Option<String>,
    #[serde(default)]
    title: String,
    #[serde(default, rename = "summary")]
    _summary: String,
    #[serde(rename = "machine")]
    _machine: String,
    #[serde(default)]
    task: BTreeMap<String, Table>,
    #[serde(default)]
    base: BaseInFile,
    step: Option<f64>,
    duration: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum BaseKind {
    #[default]
    Fixed,
    Free,
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
}

/// Largest number of a base, in SI units.
const MAX_NUMBER: f64 = 1e9;

/// Range of the step, s, and of the duration, s.
const STEP: [f64; 2] = [1e-6, 0.1];
const DURATION: [f64; 2] = [1e-3, 1e6];

/// Maximum number of steps.
const MAX_STEPS: f64 = 1e8;

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
        if let Some(other) = file.task.keys().find(|key| !names.contains(&key.as_str())) {
            let said = format!(
                "no block {:?}: want a block of the assembly, one of {}",
                quote_clipped(other),
                names.join(", ")
            );
            return Err(self.wrong(&["task", other], said));
        }
        let mut tasks = Vec::with_capacity(names.len());
        for (i, block) in assembly.blocks().iter().enumerate() {
            tasks.push(match file.task.get(&block.name) {
                Some(task) => BlockTask::Moves(Box::new(self.task(&assembly, i, task)?)),
                None => match &block.machine.spec().pose {
                    Some(pose) => BlockTask::Rests(pose.clone()),
                    None => {
                        let said = format!(
                            "block {} has no task, and its machine no pose to rest in: want [task.{}]",
                            block.name, block.name
                        );
                        return Err(self.wrong(&["task"], said));
                    }
                },
            });
        }
        let usual = tasks.iter().find_map(|task| match task {
            BlockTask::Moves(scenario) => Some(scenario.step),
            BlockTask::Rests(_) => None,
        });
        let stem =
            std::path::Path::new(self.label).file_stem().map_or_else(|| self.label.into(), |s| s.to_string_lossy());
        let base = self.base(&file.base)?;
        if base != AssemblyBase::Fixed && assembly.gravity != Vector3::zeros() {
            let said =
                "is free, but the assembly states gravity: want gravity = [0, 0, 0], as in orbit, or a fixed base";
            return Err(self.wrong(&["base", "kind"], said));
        }
        Ok(AssemblyScenario {
            name: file.name.unwrap_or_else(|| plain(&stem).into_owned()),
            title: file.title,
            assembly,
            tasks,
            base,
            step: step.or(usual).unwrap_or(1e-3),
            duration,
        })
    }

    fn base(&self, base: &BaseInFile) -> Result<AssemblyBase, ScenarioError> {
        if matches!(base.kind, BaseKind::Fixed) {
            return Ok(AssemblyBase::Fixed);
        }
        let wrong = |key: &str, said: &str| self.wrong(&["base", key], said);
        let mass = base.mass.filter(|mass| *mass > 0.0 && *mass <= MAX_NUMBER);
        let mass = mass.ok_or_else(|| wrong("mass", "want the mass of the free base above 0, kg"))?;
        let nine = |x: &[f64]| Matrix3::from_row_slice(x);
        let inertia = base.inertia.as_deref().and_then(|numbers| match numbers {
            [x, y, z] => Some(Matrix3::from_diagonal(&Vector3::new(*x, *y, *z))),
            numbers if numbers.len() == 9 => Some(nine(numbers)),
            _ => None,
        });
        let want =
            "want [x, y, z] about the centre of mass of the free base, kg m², or nine numbers row by row, symmetric";
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
        Ok(AssemblyBase::Free(SpatialBase { mass, com: base.com.into(), inertia }))
    }

    /// Returns the task of a block as a scenario of its machine, with what it carries as payload.
    fn task(&self, assembly: &Assembly, i: usize, task: &Table) -> Result<Scenario, ScenarioError> {
        let block = &assembly.blocks()[i];
        let machine = holding(assembly, i).map_err(|why| self.wrong(&["task", &block.name], why))?;
        let mut text = Table::new();
        let spec =
            Value::try_from(machine.spec()).map_err(|why| self.wrong(&["task", &block.name], why.to_string()))?;
        text.insert("name".into(), Value::String(block.name.clone()));
        text.insert("machine".into(), spec);
        text.insert("task".into(), Value::Table(task.clone()));
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
        let key = match fault.key.strip_prefix("task") {
            Some(rest) => format!("task.{block}{rest}"),
            None => format!("task.{block}"),
        };
        let path = KeyPath::of_key(&key);
        let place = (0..=path.0.len()).rev().find_map(|n| self.file.place(&KeyPath(path.0[..n].to_vec())));
        let text = format!("block {block}: {}", fault.text);
        Fault { line: place.map(|place| place.line), column: place.map(|place| place.column), key, text, ..fault }
    }
}

/// Returns the machine of a block with what it carries held at its end effector.
fn holding(assembly: &Assembly, i: usize) -> Result<Machine, String> {
    let block = &assembly.blocks()[i];
    let carried = assembly.mass_above(i) - block.inertia.mass();
    let mut spec = block.machine.spec().clone();
    if carried > 0.0 {
        spec.payload = spec.payload.and(Payload { mass: carried, axial: spec.payload.axial, ..Payload::default() });
    }
    Machine::new(spec).map_err(|why| why.to_string())
}

impl AssemblyScenario {
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

    /// Returns whether it has no more steps than are simulated, for a duration, s.
    pub(super) fn fits(&self, duration: f64) -> bool {
        duration / self.step <= MAX_STEPS
    }
}
