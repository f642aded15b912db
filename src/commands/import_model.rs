//! `stillbase import-model`

use std::path::PathBuf;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_exchange::base_body::BaseBody;
use stillbase_exchange::import::ImportedMachine;
use stillbase_files::{is_same_place, scenario_afloat};
use stillbase_mechanics::machine::{Inertia, to_toml};
use stillbase_session::gentle_motion;
use stillbase_settings::number::{counted, fixed, fixed_or_scientific};

use super::exit::print_message;
use super::failure::Failure;
use super::input::{Settings, read};
use super::output::{Format, TextTable, write_file, yes};

/// Read a machine from a model of another program: planar URDF or MJCF whose links each follow one drive
///
/// All axes must be parallel, and all links must be bars. Bodies that turn together are found from mimic joints (URDF),
/// or from parallelogram loops and equalities (MJCF). Motors, gears with their rotors, masses, limits and the end
/// effector are read, too. Other models are refused; the error names the element and its line. Mass, inertia and mount
/// of the base belong to a scenario: --scenario writes one for the machine, on a floating base.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase import-model arm.urdf -o arm.toml
  stillbase import-model arm.xml --json
  stillbase import-model arm.urdf --set gravity=0,-9.81 -o arm.toml --force
  stillbase import-model satellite.urdf --scenario satellite.toml

Keys of --json: file and scenario (where they are written), drives, links, mass, pose, base (mass, inertia, com; where the
file has one), notes, force_balanced, invariant")]
pub struct ImportModelArguments {
    /// A URDF or MJCF file
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    settings: Settings,
    /// Write the machine to this file
    #[arg(short, long, value_name = "MACHINE.toml")]
    output: Option<PathBuf>,
    /// Write a scenario to this file: a task for the machine, on the base of the file if it has one
    #[arg(long, value_name = "SCENARIO.toml")]
    scenario: Option<PathBuf>,
    /// Replace files that exist
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    format: Format,
}

#[derive(JsonSchema, Serialize)]
pub struct Answer {
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    scenario: Option<String>,
    drives: Vec<String>,
    links: usize,
    /// Mass of the machine, kg.
    mass: f64,
    /// Drive angles, rad, with all joints of the URDF at 0, or in the keyframe of the MJCF.
    pose: Vec<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    base: Option<OfBase>,
    notes: Vec<String>,
    force_balanced: bool,
    invariant: bool,
}

/// Base on which the machine stands.
#[derive(JsonSchema, Serialize)]
pub struct OfBase {
    /// Mass, kg.
    mass: f64,
    /// Moment of inertia about its centre of mass, kg m².
    inertia: f64,
    /// Centre of mass relative to the axis of the drives, m.
    com: [f64; 2],
    /// Whether the file lets it float.
    floats: bool,
}

impl OfBase {
    /// Describes a base.
    pub fn of(base: &BaseBody, floats: bool) -> Self {
        Self { mass: base.mass, inertia: base.inertia, com: [base.com.re, base.com.im], floats }
    }

    /// Returns its mass and inertia in words.
    pub fn words(&self) -> String {
        format!("{} kg and {} kg m²", fixed_or_scientific(self.mass, 6), fixed_or_scientific(self.inertia, 6))
    }
}

impl ImportModelArguments {
    /// Reads the model, prints a summary, and writes the machine and a scenario if requested.
    pub fn run(&self) -> Result<(), Failure> {
        for file in [&self.output, &self.scenario].into_iter().flatten() {
            self.format.check_output(file, self.force, &["toml"])?;
        }
        if self.output.as_deref().zip(self.scenario.as_deref()).is_some_and(|(a, b)| is_same_place(a, b)) {
            return Err(Failure::wrong_input("-o and --scenario name one file: want two"));
        }
        let name = self.file.display();
        let found = stillbase_files::model(&read(&self.file, &["urdf", "xml", "mjcf"])?, &name.to_string())?;
        let ImportedMachine { machine, pose, base, floats, mut notes } = found;
        let machine = self.settings.apply(machine)?;
        if let Some(base) = base.filter(|_| self.scenario.is_none()) {
            let base = OfBase::of(&base, floats).words();
            let is = if floats { "floats, and is" } else { "is" };
            notes.push(format!(
                "the base, {base}, {is} no part of a machine: --scenario FILE.toml writes it into \
                 [base] of a scenario"
            ));
        }
        let made = |_| base.map_or_else(|| gentle_motion(&machine), |base| scenario_afloat(&machine, &base));
        let scenario = self.scenario.as_ref().map(made).transpose()?;
        for note in &notes {
            print_message(format!("note: {name}: {note}"));
        }
        if let Some(file) = &self.output {
            write_file(file, to_toml(&machine).as_bytes(), self.force)?;
        }
        if let (Some(file), Some(scenario)) = (&self.scenario, &scenario) {
            write_file(file, scenario.to_toml().as_bytes(), self.force)?;
        }
        let inertia = Inertia::of(&machine);
        let answer = Answer {
            file: self.output.as_ref().map(|file| file.display().to_string()),
            scenario: self.scenario.as_ref().map(|file| file.display().to_string()),
            drives: machine.spec().drives.iter().map(|drive| drive.name.clone()).collect(),
            links: machine.links().len(),
            mass: machine.mass(),
            pose,
            base: base.map(|base| OfBase::of(&base, floats)),
            notes,
            force_balanced: inertia.is_force_balanced(),
            invariant: inertia.is_invariant(),
        };
        self.format.print(&answer, |answer| {
            let mut table = TextTable::new(["drive", "q rad in the file's pose", "H_kk kg m²"]);
            for (k, (drive, q)) in answer.drives.iter().zip(&answer.pose).enumerate() {
                table.row([drive.clone(), fixed(*q, 6), fixed_or_scientific(inertia.diagonal(k), 9)]);
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
