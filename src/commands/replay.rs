//! `stillbase replay`

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_files::recorded::CaseName;

use super::diff::{Case, ToleranceOptions};
use super::failure::Failure;
use super::output::Format;
use super::progress::goes_on;

/// Simulate a recorded session again and compare every signal with the recording
///
/// Every recording contains its scenarios, machines and edits. The exit status is 0 if every signal is equal, and 1
/// otherwise. A recording of another version of the program may differ by 1e-9 (in SI units), and by 1e-9 of the largest
/// value of the signal.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase headless case-3 -o case-3.rrd
  stillbase replay case-3.rrd
  stillbase replay case-3.rrd --tolerance 1e-6 --json")]
pub struct ReplayArguments {
    /// The recording; FILE.rrd:CASE is one of its cases
    #[arg(value_name = "FILE.rrd")]
    file: String,
    #[command(flatten)]
    tolerance: ToleranceOptions,
    #[command(flatten)]
    format: Format,
}

#[derive(JsonSchema, Serialize)]
pub struct Answer {
    /// Whether every number is equal.
    equal: bool,
    /// Whether every signal stays within its tolerance.
    within: bool,
    cases: Vec<Replayed>,
}

#[derive(JsonSchema, Serialize)]
struct Replayed {
    /// Version of the program that recorded the case, and of the one that simulated it again.
    versions: [String; 2],
    #[serde(flatten)]
    case: Case,
}

impl ReplayArguments {
    /// Simulates each case again and prints the differences.
    pub fn run(&self) -> Result<(), Failure> {
        let Some(name) = CaseName::of(&self.file) else {
            return Err(Failure::wrong_input("want a recording, FILE.rrd").with_context(&self.file));
        };
        let recorded = name.cases().map_err(Failure::wrong_input)?;
        self.tolerance.check(recorded.iter().map(|case| &case.table))?;
        let own = env!("CARGO_PKG_VERSION");
        let mut cases = Vec::with_capacity(recorded.len());
        for case in recorded {
            let tolerances = self.tolerance.over(case.tolerances());
            let scenario = case.scenario()?;
            let difference = case.simulated_again(&scenario, &tolerances, goes_on);
            let difference = difference.map_err(|e| Failure::refused(&scenario, e))?;
            let versions = [case.version, own.to_owned()];
            cases.push(Replayed { versions, case: Case::of(&case.name, &difference) });
        }
        let all = |is: fn(&Case) -> bool| cases.iter().all(|replayed| is(&replayed.case));
        let (equal, within) = (all(|case| case.equal), all(|case| case.within));
        let answer = Answer { equal, within, cases };
        self.format.print(&answer, |answer| answer.cases.iter().map(Replayed::text).collect())?;
        if within { Ok(()) } else { Err(Failure::Told) }
    }
}

impl Replayed {
    fn text(&self) -> String {
        let [before, now] = &self.versions;
        match before == now {
            true => self.case.text(),
            false => format!("recorded by {before}, simulated again by {now}\n{}", self.case.text()),
        }
    }
}
