//! Faults of machine files: what [`MachineError`] means for the text that states the machine.

use super::Machine;
use super::error::{KeyPath, MachineError};
use super::spec::MachineSpec;
use super::words::SMALLEST;
use stillbase_settings::mending::{Problem, Wrong};
use stillbase_settings::stated::StatedFile;

/// Keys of which a machine has at least one.
const OWN: [&str; 3] = ["drive", "link", "end_effector"];

/// The first problem of a text, with the error that it comes from.
pub type FirstProblem = Box<(Problem, MachineError)>;

/// Reads a machine from what a file, or a table of it, states.
///
/// # Errors
/// The first problem, with the error that it comes from.
pub fn read(file: &StatedFile) -> Result<Machine, FirstProblem> {
    if !file.keys().any(|key| OWN.contains(&key) || super::words::is_meant(key)) {
        return Err(nothing_of_a_machine(file));
    }
    let end = KeyPath::new(&[&"end_effector"]);
    if let Some(several) = file.at(&end).and_then(|ends| ends.as_array()) {
        let error = MachineError::SeveralEndEffectors { count: several.len() };
        return Err(Box::new((Problem { path: end, wrong: Wrong::Said(error.to_string()) }, error)));
    }
    let spec: MachineSpec = file.read().map_err(|error| {
        let problem = match Problem::of(file, &error) {
            // Without its shape, a part has no keys that can be judged.
            Problem { path, wrong: Wrong::Value(said) } if path.fits("part.*.shape") => {
                Problem { path, wrong: Wrong::Kind(said) }
            }
            other => other,
        };
        let text = problem.text(&super::words::MachineWords);
        Box::new((problem, MachineError::Syntax(text)))
    })?;
    Machine::new(spec).map_err(|error| Box::new((problem(file, &error), error)))
}

/// Whether a part states its shape by a key.
fn is_length_of_part(key: &str) -> bool {
    ["width", "thickness", "diameter", "height", "wall", "polygon"].contains(&key)
}

/// Returns the problem of a file without a single part of a machine.
fn nothing_of_a_machine(file: &StatedFile) -> FirstProblem {
    let what = if file.keys().next().is_none() { "the file states nothing" } else { "the file states no machine" };
    let said = format!("{what}: want [[drive]], [[link]] and [end_effector]");
    let wrong = Wrong::Whole(said.clone(), SMALLEST.into());
    Box::new((Problem { path: KeyPath::default(), wrong }, MachineError::Syntax(said)))
}

/// Returns what an error means for a file.
fn problem(file: &StatedFile, error: &MachineError) -> Problem {
    let said = error.to_string();
    let path = error.place().cloned().unwrap_or_default();
    let missing = |key: &str| Problem { path: KeyPath::default(), wrong: Wrong::Missing(key.into()) };
    match error {
        MachineError::NoEndEffector => missing("end_effector"),
        MachineError::Count { what: "drives", count: 0, .. } => missing("drive"),
        MachineError::Count { what: "links", count: 0, .. } => missing("link"),
        MachineError::NoParts { .. } => match (path.parent(), path.last_key()) {
            (Some(table), Some(key)) => Problem { path: table, wrong: Wrong::Missing(key.into()) },
            _ => Problem { path, wrong: Wrong::Said(said) },
        },
        MachineError::Unknown { known, .. } => {
            // The name may be stated by the place itself, as in `end_effector = { link = … }`.
            Problem { path, wrong: Wrong::Name(said, known.clone()) }
        }
        MachineError::Cycle { .. } => Problem { path, wrong: Wrong::Said(said) },
        MachineError::OpenLoop { .. } | MachineError::Massless { .. } => {
            Problem { path, wrong: Wrong::Follows(said, String::new()) }
        }
        _ if path.0.is_empty() => Problem { path, wrong: Wrong::Whole(said, String::new()) },
        // A length that the shape of a part has, and the file does not state.
        MachineError::Part { .. } if file.at(&path).is_none() && path.last_key().is_some_and(is_length_of_part) => {
            match (path.parent(), path.last_key()) {
                (Some(table), Some(key)) => Problem { path: table, wrong: Wrong::Missing(key.into()) },
                _ => Problem { path, wrong: Wrong::Said(said) },
            }
        }
        MachineError::HalfLimited { .. } => {
            let lacks = ["min", "max"].into_iter().find(|key| file.at(&path.key(key)).is_none());
            Problem { wrong: Wrong::Missing(lacks.unwrap_or("max").into()), path }
        }
        _ => Problem { path, wrong: Wrong::Said(said) },
    }
}
