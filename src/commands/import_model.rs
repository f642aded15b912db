//! `stillbase import-model`

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use stillbase::exchange::import::{Imported, import};
use stillbase::files::write_new;
use stillbase::mechanics::machine::{Inertia, to_toml};
use stillbase::settings::number::{counted, fixed, shown};

use super::exit::say;
use super::failure::Failure;
use super::input::{Settings, read};
use super::output::{Format, Table, check_output, yes};

/// Read a machine from a model of another program: planar URDF or MJCF whose links each follow one drive
///
/// All axes have to be parallel and all links bars. What turns together is read from mimic joints (URDF), from loops that
/// are parallelograms and from equalities (MJCF); motors, gears with their rotors, masses, limits and the end effector
/// come along. What lies outside of the family is refused with its element and line.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase import-model arm.urdf -o arm.toml
  stillbase import-model arm.xml --json
  stillbase import-model arm.urdf --set gravity=0,-9.81 -o arm.toml --force

Keys of --json: file (where one is written), drives, links, mass, pose, notes, force_balanced, invariant")]
pub struct ImportModel {
    /// A URDF or MJCF file
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    settings: Settings,
    /// Write the machine to this file
    #[arg(short, long, value_name = "MACHINE.toml")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    format: Format,
}

#[derive(Serialize)]
struct Answer {
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    drives: Vec<String>,
    links: usize,
    /// kg.
    mass: f64,
    /// Of the drives, where all joints of URDF are at 0, or in the keyframe of MJCF, rad.
    pose: Vec<f64>,
    notes: Vec<String>,
    force_balanced: bool,
    invariant: bool,
}

impl ImportModel {
    /// Reads the model, says what it is, and writes the machine if asked.
    pub fn run(&self) -> Result<(), Failure> {
        if let Some(file) = &self.output {
            check_output(file, self.force, &["toml"])?;
        }
        let name = self.file.display();
        let found = import(&read(&self.file)?).map_err(|e| Failure::wrong_input(e).of(&name))?;
        let Imported { machine, pose, notes } = found;
        let machine = self.settings.apply(machine)?;
        for note in &notes {
            say(format!("note: {name}: {note}"));
        }
        if let Some(file) = &self.output {
            write_new(file, to_toml(&machine).as_bytes(), self.force)?;
            say(format!("wrote {}", file.display()));
        }
        let inertia = Inertia::of(&machine);
        let answer = Answer {
            file: self.output.as_ref().map(|file| file.display().to_string()),
            drives: machine.spec().drives.iter().map(|drive| drive.name.clone()).collect(),
            links: machine.links().len(),
            mass: machine.mass(),
            pose,
            notes,
            force_balanced: inertia.is_force_balanced(),
            invariant: inertia.is_invariant(),
        };
        self.format.print(&answer, |answer| {
            let mut table = Table::new(["drive", "q rad in the file's pose", "H_kk kg m²"]);
            for (k, (drive, q)) in answer.drives.iter().zip(&answer.pose).enumerate() {
                table.row([drive.clone(), fixed(*q, 6), shown(inertia.diagonal(k), 9)]);
            }
            let [links, drives] = [counted(answer.links, "link"), counted(answer.drives.len(), "drive")];
            let (balanced, invariant) = (yes(answer.force_balanced), yes(answer.invariant));
            format!(
                "{} · {drives} · {links} · {} kg · force balanced: {balanced} · invariant: {invariant}\n\n{table}",
                machine.name(),
                fixed(answer.mass, 3)
            )
        })
    }
}
