//! `stillbase headless` of a scenario of several machines on one base.

use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;
use stillbase_recording::{AssemblyRecordError, record_assembly};
use stillbase_session::assembly::{AssemblyRun, AssemblyScenario};

use super::exit::print_message;
use super::failure::Failure;
use super::output::{Format, say_written};
use super::progress::goes_on;
use super::simulate_assembly::{AssemblyOutcome, last_step, reactions, refused};
use super::strict::Strict;

/// Answer of a recording of an assembly.
#[derive(JsonSchema, Serialize)]
pub struct AssemblyRecorded {
    scenario: String,
    file: String,
    #[serde(flatten)]
    verdict: AssemblyOutcome,
}

/// Records a scenario of an assembly in a file.
pub fn record(
    scenario: &AssemblyScenario,
    (file, force): (&Path, bool),
    format: &Format,
    strict: &Strict,
) -> Result<(), Failure> {
    let run = AssemblyRun::new(scenario).map_err(|(block, why)| refused(scenario, block, why))?;
    last_step(&run)?;
    let seen = record_assembly(&run, (file, force), &goes_on).map_err(|error| match error {
        AssemblyRecordError::Stopped => Failure::Stopped,
        AssemblyRecordError::Write(error) => error.into(),
        other => Failure::wrong_input(other),
    })?;
    let outcome = AssemblyOutcome::of(scenario, &seen);
    say_written(file);
    let name = &scenario.name;
    let faults = reactions(scenario, &outcome);
    let answer = AssemblyRecorded { scenario: name.clone(), file: file.display().to_string(), verdict: outcome };
    print_message(format!("{name}: {}", answer.verdict.sentence));
    format.print(&answer, |_| String::new())?;
    strict.require(faults)
}
