//! Files of assemblies.

use serde::{Deserialize, Serialize};
use toml::Value;

use super::model::{Assembly, AssemblyError};
use super::words::AssemblyWords;
use crate::machine::{FileError, FirstProblem, KeyPath, Machine, MachineError, parse_with};
use stillbase_settings::mending::{Problem, Wrong, called};
use stillbase_settings::stated::StatedFile;

/// The content of an assembly file. [`Assembly::new`] checks it.
///
/// ```toml
/// kind = "assembly"
/// name = "two-arms"
///
/// [[block]]
/// name = "left"
/// machine = "nine-link"       # a built-in machine, or a file beside this one
///
/// [[block]]
/// name = "right"
/// machine = "nine-link"
/// at = [0.9, 0.0, 0.1]        # m, from what it sits on
/// x = [0, 0, 1]               # directions of its plane, from the base
/// y = [1, 0, 0]
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AssemblySpec {
    /// Always `"assembly"`.
    pub kind: AssemblyKind,
    /// Short name.
    pub name: String,
    /// Summary in one line.
    #[serde(default)]
    pub summary: String,
    /// Acceleration of gravity in axes of the base, m/s².
    #[serde(default)]
    pub gravity: [f64; 3],
    /// The machines.
    #[serde(default, rename = "block")]
    pub blocks: Vec<BlockSpec>,
}

/// The word by which a file is one of an assembly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AssemblyKind {
    /// Several machines.
    #[default]
    Assembly,
}

/// A machine of an assembly.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BlockSpec {
    /// Its name in the assembly.
    pub name: String,
    /// Name or file of the machine, or the whole machine as a table.
    pub machine: Value,
    /// Settings of the machine, as on the command line: `payload.mass=0.5`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub set: Vec<String>,
    /// `"base"`, or the block on whose platform it sits.
    #[serde(default = "base")]
    pub on: String,
    /// Its place from the origin of the base or from the end effector of the block below, m, in axes of the base.
    #[serde(default)]
    pub at: [f64; 3],
    /// Direction of the x axis of its plane, in axes of the base.
    #[serde(default = "first")]
    pub x: [f64; 3],
    /// Direction of the y axis of its plane, at a right angle to x.
    #[serde(default = "second")]
    pub y: [f64; 3],
}

fn base() -> String {
    "base".into()
}

fn first() -> [f64; 3] {
    [1.0, 0.0, 0.0]
}

fn second() -> [f64; 3] {
    [0.0, 1.0, 0.0]
}

/// Looks up a machine by name or file.
pub type FindMachine<'a> = &'a dyn Fn(&str) -> Result<Machine, FileError>;

/// Reads an assembly from text; `file` is the name used in errors.
///
/// # Errors
/// If the text describes no assembly; the error has all faults of the text.
pub fn parse(text: &str, file: &str, find: FindMachine<'_>) -> Result<Assembly, FileError> {
    parse_with(text, file, &AssemblyWords, &|stated| read(stated, find))
}

impl Assembly {
    /// Returns the assembly as TOML, with all machines written out, from which [`parse`] returns an equal one.
    ///
    /// # Panics
    /// Never: every assembly can be written.
    pub fn to_toml(&self) -> String {
        toml::to_string(&self.spec()).expect("an assembly is plain data")
    }
}

fn read(file: &StatedFile, find: FindMachine<'_>) -> Result<Assembly, FirstProblem> {
    let problem = |problem: Problem| {
        let text = problem.text(&AssemblyWords);
        Box::new((problem, MachineError::Syntax(text)))
    };
    let spec: AssemblySpec = file.read().map_err(|error| problem(Problem::of(file, &error)))?;
    Assembly::new(&spec, find).map_err(|AssemblyError { place, said, known }| {
        let wrong = match known.is_empty() {
            // A direction is at a wrong angle to the other one, which may have been left out as wrong itself.
            true if follows(file, &place) => {
                Wrong::Follows(format!("{} {said}", called(&place, &AssemblyWords)), String::new())
            }
            true => Wrong::Value(said),
            false => Wrong::Name(said, known),
        };
        problem(Problem { path: place, wrong })
    })
}

/// Whether a place is a direction y of a block that states no x.
fn follows(file: &StatedFile, place: &KeyPath) -> bool {
    let x = place.parent().unwrap_or_default().key("x");
    place.fits("block.*.y") && file.at(&x).is_none()
}
