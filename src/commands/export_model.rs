//! `stillbase export-model`

use std::path::PathBuf;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_exchange::drawing::Sheet;
use stillbase_exchange::form::{self, Exported, Form, FormContent, ModelContent};
use stillbase_exchange::mjcf::{qpos, usual_pose};
use stillbase_exchange::stl;
use stillbase_exchange::urdf::joint;
use stillbase_files::row_file::{RowForm, table_bytes};
use stillbase_files::{FoundMachine, floating_base, left_out_of_base};
use stillbase_mechanics::machine::Machine;
use stillbase_session::Run;
use stillbase_session::scenario::Scenario;
use stillbase_settings::number::{counted, fixed, fixed_or_scientific};

use super::dimensions::Dimensions;
use super::exit::print_message;
use super::export_model_assembly::FoundAssembly;
use super::failure::Failure;
use super::file_form::FileForm;
use super::import_model::OfBase;
use super::input::{MachineArgument, Settings, floating_scenario, no_use, say_base_is_held};
use super::output::{Format, TextTable, write_file};

/// Export a machine: a model for MuJoCo (.xml) or for ROS and Pinocchio (.urdf), drawings for cutting (.svg, .dxf),
/// solids (.stl), or a parts list (.csv, .parquet, .md)
///
/// MJCF: sensors at the base read the force and moment that hold the machine; the reaction has the opposite sign. The
/// pose is the keyframe "start". URDF: the joints drive_… are the motors, and all other joints follow them; the element
/// `<stillbase>` contains what URDF cannot express. Both: a base that floats comes along, with its mass and joints; data
/// that plane motion does not need, such as inertias about other axes, are made up. An assembly, or its scenario, becomes a
/// model of all blocks in space. Their names begin with that of the block, as wrist/drive_1; links have inertia about all axes. Solids:
/// bars, plates, counterweights, lumps, the payload, pins and spacers at their heights, in mm; `stillbase layers` finds
/// the heights.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase export-model nine-link -o nine-link.xml
  stillbase export-model nine-link -o nine-link.urdf
  stillbase export-model serial-3r --pose 1.2,0.1,-0.8 -o arm.xml
  stillbase export-model spot --base spot -o satellite.xml
  stillbase export-model wrist-across -o four.xml
  stillbase export-model carrier-and-wrist --block wrist -o wrist.svg
  stillbase export-model two-drive --bar-width 0.025 --pin-diameter 0.006 -o links.svg
  stillbase export-model scara --material 2700 -o parts.csv")]
pub struct ExportModelArguments {
    #[command(flatten)]
    pub(super) machine: MachineArgument,
    /// Angles of the drives in the keyframe of .xml and in .stl, rad; default: the start of the scenario, of a machine
    /// the pose that its file states, or else the middle of the limits. Of an assembly those of all blocks, in their order
    #[arg(long, value_name = "Q1,Q2,…", value_delimiter = ',', allow_hyphen_values = true)]
    pub(super) pose: Vec<f64>,
    /// Put a model on the base of this scenario, which floats; default: the base of MACHINE, if it is a scenario or a
    /// model whose base floats
    #[arg(long, value_name = "SCENARIO")]
    pub(super) base: Option<String>,
    /// Take the machine of this block of an assembly, by itself and without what it carries
    #[arg(long, value_name = "NAME")]
    pub(super) block: Option<String>,
    #[command(flatten)]
    pub(super) dimensions: Dimensions,
    #[arg(short, long, value_name = "FILE", help = format!("Write it to this file; its ending chooses what is written: {}; `-` is standard output", form::endings().join(", ")))]
    pub(super) output: PathBuf,
    /// Replace the file if it exists
    #[arg(long)]
    pub(super) force: bool,
    #[command(flatten)]
    pub(super) form: FileForm,
    #[command(flatten)]
    pub(super) format: Format,
}

/// Description of the written file.
#[derive(JsonSchema, Serialize)]
pub struct Answer {
    pub(super) file: String,
    #[serde(flatten)]
    pub(super) of: Written,
    /// What a model leaves out; absent for a model that leaves out nothing, and for what is no model.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) left_out: Vec<String>,
}

#[derive(JsonSchema, Serialize)]
#[serde(untagged)]
pub(super) enum Written {
    Mjcf {
        /// Angles of the drives in the keyframe, rad.
        pose: Vec<f64>,
        /// Numbers of all joints in the keyframe, as in MuJoCo, rad: those of a base that floats, then all hinges.
        qpos: Vec<f64>,
        /// The base, if it floats.
        #[serde(skip_serializing_if = "Option::is_none")]
        base: Option<ModelBase>,
    },
    Urdf {
        /// The joint of each drive's motor.
        joints: Vec<String>,
        /// The base, if it floats.
        #[serde(skip_serializing_if = "Option::is_none")]
        base: Option<ModelBase>,
    },
    Drawing {
        /// Size of the sheet, m.
        size: [f64; 2],
        links: usize,
    },
    Solids {
        /// Angles of the drives, rad.
        pose: Vec<f64>,
        solids: usize,
        /// Their volumes together, m³.
        volume: f64,
    },
    List {
        links: usize,
        counterweights: usize,
        /// Mass of the machine, kg.
        mass: f64,
    },
}

/// The base of a model, which floats.
#[derive(JsonSchema, Serialize)]
#[serde(untagged)]
pub(super) enum ModelBase {
    /// That of a machine, in its plane.
    Planar(OfBase),
    /// That of an assembly.
    Spatial {
        /// Mass, kg.
        mass: f64,
        /// Inertia about its centre of mass, kg m².
        inertia: [[f64; 3]; 3],
        /// Centre of mass from its origin, m.
        com: [f64; 3],
        /// Whether the file lets it float.
        floats: bool,
    },
}

impl ExportModelArguments {
    /// Writes the file.
    pub fn run(&self) -> Result<(), Failure> {
        let FoundMachine { machine, base, scenario, .. } = match (FoundAssembly::of(&self.machine)?, &self.block) {
            (Some(found), None) => return self.run_assembly(found),
            (Some(found), Some(name)) => found.machine_of(name)?,
            (None, Some(name)) => return Err(no_use(&format!("--block {name}"), "it with an assembly")),
            (None, None) => self.machine.find()?,
        };
        let other = self.base.as_deref().map(|base| floating_scenario(base, &Settings::default())).transpose()?;
        let base = other.as_ref().map_or(base, |other| Some(other.base));
        let floating = base.as_ref().and_then(floating_base);
        let ending = self.form.check(&self.format, Some(&self.output), self.force, &form::endings())?;
        let form = Form::of(ending).map_err(Failure::wrong_input)?;
        self.check_options(form)?;
        let pose = match self.pose.is_empty() {
            true => {
                let of = other.or(scenario.map(|own| *own)).filter(|of| of.machine.name() == machine.name());
                of.and_then(|of| start_of(of, &machine)).unwrap_or_else(|| usual_pose(&machine))
            }
            false => self.pose.clone(),
        };
        if base.is_none() && form.is_model() {
            say_base_is_held(&machine);
        }
        let cut = self.dimensions.cut(&machine);
        let exported = Exported { machine: &machine, base: floating.as_ref(), pose: &pose, cut: &cut };
        let content = match (form.written(&exported), RowForm::of_ending(ending)) {
            (Ok(FormContent::Table(table)), Some(rows)) => table_bytes(&table, rows, &self.output)?,
            (content, _) => content.map_err(Failure::wrong_input)?.text().into_bytes(),
        };
        let of = described(&exported, form)?;
        write_file(&self.output, &content, self.force)?;
        let of_base = base.as_ref().filter(|_| form.is_model()).and_then(left_out_of_base);
        let left_out: Vec<String> = form.left_out(&machine).into_iter().chain(of_base).collect();
        let drives = machine.spec().drives.iter().map(|drive| drive.name.clone()).collect();
        self.answer(of, left_out, (machine.name(), drives))
    }

    /// Prints what was written and what was left out, of what has this name and these drives.
    pub(super) fn answer(
        &self,
        of: Written,
        left_out: Vec<String>,
        (name, drives): (&str, Vec<String>),
    ) -> Result<(), Failure> {
        for what in &left_out {
            print_message(format!("note: {}: left out: {what}", self.output.display()));
        }
        let answer = Answer { file: self.output.display().to_string(), of, left_out };
        self.format.print(&answer, |answer| answer.of.words(name, drives))
    }

    /// Refuses options that have no effect on the file, and a pose that is none.
    pub(super) fn check_options(&self, form: Form) -> Result<(), Failure> {
        let dimensions = &self.dimensions;
        let has_layers = |shows| matches!(shows, ModelContent::Links | ModelContent::Solids | ModelContent::Parts);
        let all: [OptionScope; 6] = [
            ("--pose", self.pose.is_empty(), |shows| matches!(shows, ModelContent::Pose | ModelContent::Solids)),
            ("--base", self.base.is_none(), |shows| matches!(shows, ModelContent::Pose | ModelContent::Joints)),
            ("--bar-width", dimensions.bar_width.is_none(), has_layers),
            ("--pin-diameter", dimensions.pin_diameter.is_none(), has_layers),
            ("--plate-thickness", dimensions.plate_thickness.is_none(), has_layers),
            ("--spacer", dimensions.spacer.is_none(), has_layers),
        ];
        match all.into_iter().find(|(_, is_left_out, counts)| !is_left_out && !counts(form.shows)) {
            Some((option, _, counts)) => {
                let endings = form::listed(counts);
                let what = format!("{option} has no effect on such a file: want one that ends in {endings}");
                Err(Failure::wrong_input(what).with_context(self.output.display()))
            }
            None => match self.pose.iter().find(|q| !q.is_finite()) {
                Some(bad) => Err(Failure::wrong_input(format!("--pose {bad}: want finite angles in rad"))),
                None => Ok(()),
            },
        }
    }
}

/// Returns the drive angles at the start of a scenario, rad, with a machine as it was changed; `None` if it has no plan.
fn start_of(scenario: Scenario, machine: &Machine) -> Option<Vec<f64>> {
    let scenario = Scenario { machine: machine.clone(), ..scenario };
    let stated = scenario.task.start_pose(machine.drives()).map(|q| q.to_vec());
    stated.or_else(|| Some(Run::new(&scenario).ok()?.plan().motion.at(0.0).q.to_vec()))
}

/// An option, whether it is left out, and for which files it has an effect.
type OptionScope = (&'static str, bool, fn(ModelContent) -> bool);

/// Describes the written file.
fn described(of: &Exported, form: Form) -> Result<Written, Failure> {
    let Exported { machine, base, cut, .. } = *of;
    let (links, pose) = (machine.links().len(), of.pose.to_vec());
    let floating = base.map(|base| ModelBase::Planar(OfBase::of(base, true)));
    Ok(match form.shows {
        ModelContent::Pose => {
            let qpos = qpos(machine, base, &pose).map_err(Failure::wrong_input)?;
            Written::Mjcf { pose, qpos, base: floating }
        }
        ModelContent::Joints => {
            let joints = (0..machine.drives()).map(|k| joint(machine, k)).collect();
            Written::Urdf { joints, base: floating }
        }
        ModelContent::Links => {
            let size = Sheet::of(machine, cut).map_err(Failure::wrong_input)?.size;
            Written::Drawing { size: size.map(|mm| 1e-3 * mm), links }
        }
        ModelContent::Solids => {
            let solids = stl::solids(machine, &pose, cut).map_err(Failure::wrong_input)?;
            let volume = solids.iter().map(|solid| solid.volume()).sum();
            Written::Solids { pose, solids: solids.len(), volume }
        }
        ModelContent::Parts => {
            Written::List { links, counterweights: machine.spec().counterweights.len(), mass: machine.mass() }
        }
    })
}

/// Returns words about a base that floats.
fn afloat(base: Option<&ModelBase>) -> String {
    let words = match base {
        None => return String::new(),
        Some(ModelBase::Planar(base)) => base.words(),
        Some(ModelBase::Spatial { mass, .. }) => format!("{} kg", fixed_or_scientific(*mass, 6)),
    };
    format!(" · on a base that floats, {words}")
}

impl Written {
    fn words(&self, name: &str, drives: Vec<String>) -> String {
        match self {
            Self::Mjcf { pose, qpos, base } => {
                let mut table = TextTable::new(["drive", "q rad at the start"]);
                for (drive, q) in drives.into_iter().zip(pose) {
                    table.row([drive, fixed(*q, 6)]);
                }
                let joints = if base.is_some() { "joints" } else { "hinges" };
                format!("{name} · {} {joints}{}\n\n{table}", qpos.len(), afloat(base.as_ref()))
            }
            Self::Urdf { joints, base } => {
                let mut table = TextTable::new(["drive", "joint of its motor"]);
                for (drive, joint) in drives.into_iter().zip(joints) {
                    table.row([drive, joint.clone()]);
                }
                format!("{name} · {}{}\n\n{table}", counted(joints.len(), "motor"), afloat(base.as_ref()))
            }
            Self::Drawing { size: [width, height], links } => {
                let [width, height] = [width, height].map(|x| fixed(1e3 * x, 0));
                format!("{name} · {} on a sheet of {width} x {height} mm, scale 1 : 1\n", counted(links, "link"))
            }
            Self::Solids { solids, volume, .. } => {
                format!("{name} · {} · {} cm³ in all\n", counted(solids, "solid"), fixed(1e6 * volume, 1))
            }
            Self::List { links, counterweights, mass } => {
                let [links, discs] = [counted(links, "link"), counted(counterweights, "counterweight")];
                format!("{name} · {links} · {discs} · {} kg in all\n", fixed(*mass, 3))
            }
        }
    }
}
