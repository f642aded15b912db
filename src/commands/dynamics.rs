//! `stillbase dynamics`

use std::path::{Path, PathBuf};

use clap::Args;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use stillbase_mechanics::dynamics::ExternalLoads;
use stillbase_mechanics::loads::Loads;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::PerDrive;
use stillbase_settings::range::shortened;

use super::failure::Failure;
use super::input::{MachineArgument, read};
use super::output::{Format, TextTable};
use stillbase_settings::number::{counted, fixed};

/// Compute the motor torques and the base reactions of given states of motion, Eqs (1) to (6)
///
/// Force and moment are those that the manipulator transmits to its base, weight included; the moment is about B,
/// positive counter-clockwise.
#[derive(Args)]
#[command(after_help = "\
Example:
  echo '[{\"q\": [0.1, 0.2, 0.3], \"qd\": [0, 0, 1], \"qdd\": [0, 1, 0]}]' > states.json
  stillbase dynamics nine-link --states states.json --set gravity=0,-9.81")]
pub struct DynamicsArguments {
    #[command(flatten)]
    machine: MachineArgument,
    /// JSON: a list of states {"q": [rad], "qd": [rad/s], "qdd": [rad/s²]}, absolute angles, one number a drive
    #[arg(long, value_name = "FILE.json")]
    states: PathBuf,
    #[command(flatten)]
    format: Format,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct State {
    q: Vec<f64>,
    qd: Vec<f64>,
    qdd: Vec<f64>,
}

#[derive(JsonSchema, Serialize)]
pub(crate) struct Answer {
    results: Vec<Loads>,
}

impl DynamicsArguments {
    /// Prints one result for each state.
    pub fn run(&self) -> Result<(), Failure> {
        let machine = self.machine.load()?;
        let inertia = Inertia::of(&machine);
        let around = ExternalLoads { gravity: machine.gravity(), ..ExternalLoads::default() };
        let states = states(&self.states, &machine)?;
        let results = states.iter().map(|[q, qd, qdd]| Loads::of(&inertia, &around, q, qd, qdd)).collect();
        self.format.print(&Answer { results }, |answer| tables(answer, inertia.drives()))
    }
}

/// Reads states, each as q, q̇, q̈ in rad, rad/s, rad/s².
fn states(file: &Path, machine: &Machine) -> Result<Vec<[PerDrive; 3]>, Failure> {
    states_in(&read(file, &["json"])?, &file.display().to_string(), machine)
}

/// Reads states from text; errors name `file`.
pub fn states_in(text: &str, file: &str, machine: &Machine) -> Result<Vec<[PerDrive; 3]>, Failure> {
    let wrong = |line: usize, what: String| Failure::WrongInput(format!("{file}:{line}: {what}"));
    let states: Vec<State> = serde_json::from_str(text).map_err(|e| {
        let said = e.to_string();
        let what = said.rsplit_once(" at line ").map_or(said.as_str(), |(what, _)| what);
        let what = shortened(what, 300);
        wrong(e.line(), format!(r#"{what}: want [{{"q": [rad], "qd": [rad/s], "qdd": [rad/s²]}}, …]"#))
    })?;
    let n = machine.drives();
    // States contain no string values or nested objects, so the i-th brace opens the i-th state.
    let mut line = 1;
    let starts = text.bytes().filter_map(|byte| {
        line += usize::from(byte == b'\n');
        (byte == b'{').then_some(line)
    });
    states
        .iter()
        .zip(starts)
        .enumerate()
        .map(|(i, (state, line))| {
            let take = |name: &str, values: &[f64]| {
                PerDrive::from_slice(values).filter(|v| v.len() == n).ok_or_else(|| {
                    let count = counted(values.len(), "number");
                    wrong(line, format!("state {}: {name} has {count}: want {n}, one a drive", i + 1))
                })
            };
            Ok([take("q", &state.q)?, take("qd", &state.qd)?, take("qdd", &state.qdd)?])
        })
        .collect()
}

fn tables(answer: &Answer, n: usize) -> String {
    let torques = (1..=n).map(|k| format!("τ_{k} N m"));
    let rest = ["f_Bx N", "f_By N", "n_B N m", "x_CM m", "y_CM m", "h_B kg m²/s"].map(String::from);
    let mut motion = TextTable::new(["state".to_string()].into_iter().chain(torques).chain(rest));
    let upper = || (0..n).flat_map(|k| (k..n).map(move |l| (k, l)));
    let entries = upper().map(|(k, l)| format!("H_{}{} kg m²", k + 1, l + 1));
    let mut matrix = TextTable::new(["state".to_string()].into_iter().chain(entries));
    for (i, r) in answer.results.iter().enumerate() {
        let name = || [(i + 1).to_string()].into_iter();
        let after =
            [r.base_force[0], r.base_force[1], r.base_moment, r.com[0], r.com[1], r.angular_momentum_about_base];
        motion.row(name().chain(r.torque.iter().chain(&after).map(|x| fixed(*x, 6))));
        matrix.row(name().chain(upper().map(|(k, l)| fixed(r.mass_matrix[k][l], 6))));
    }
    format!("{motion}\n{matrix}")
}
