//! `stillbase export-model`

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use stillbase::exchange::mjcf::{hinges, middle, mjcf};
use stillbase::files::write_new;
use stillbase::settings::number::fixed;

use super::exit::say;
use super::failure::Failure;
use super::input::MachineArgument;
use super::output::{Format, Table, check_output};

/// Write a machine as a model for MuJoCo: links, pins, loops, motors with their gears and rotors
///
/// Sensors at the base read the force and moment that hold the machine: the reaction is the opposite. The pose is the
/// keyframe "start". What a plane motion does not ask, as inertias about other axes, is made up.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase export-model nine-link -o nine-link.xml
  stillbase export-model serial-3r --pose 1.2,0.1,-0.8 -o arm.xml")]
pub struct ExportModel {
    #[command(flatten)]
    machine: MachineArgument,
    /// Angles of the drives in the keyframe, rad; amid the limits where it is left out
    #[arg(long, value_name = "Q1,Q2,…", value_delimiter = ',', allow_hyphen_values = true)]
    pose: Vec<f64>,
    /// Write the model to this file
    #[arg(short, long, value_name = "FILE.xml")]
    output: PathBuf,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    format: Format,
}

#[derive(Serialize)]
struct Answer {
    file: String,
    /// Angles of the drives in the keyframe, rad.
    pose: Vec<f64>,
    /// The same as MuJoCo has it: of each hinge, rad.
    qpos: Vec<f64>,
}

impl ExportModel {
    /// Writes the model.
    pub fn run(&self) -> Result<(), Failure> {
        let machine = self.machine.load()?;
        check_output(&self.output, self.force, &["xml"])?;
        if let Some(bad) = self.pose.iter().find(|q| !q.is_finite()) {
            return Err(Failure::wrong_input(format!("--pose {bad}: want finite angles in rad")));
        }
        let pose = if self.pose.is_empty() { middle(&machine) } else { self.pose.clone() };
        let model = mjcf(&machine, &pose).map_err(Failure::wrong_input)?;
        write_new(&self.output, model.as_bytes(), self.force)?;
        say(format!("wrote {}", self.output.display()));
        let qpos = hinges(&machine, &pose).map_err(Failure::wrong_input)?;
        let answer = Answer { file: self.output.display().to_string(), pose, qpos };
        self.format.print(&answer, |answer| {
            let mut table = Table::new(["drive", "q rad at the start"]);
            for (drive, q) in machine.spec().drives.iter().zip(&answer.pose) {
                table.row([drive.name.clone(), fixed(*q, 6)]);
            }
            format!("{} · {} hinges\n\n{table}", machine.name(), answer.qpos.len())
        })
    }
}
