//! `stillbase export-model` of an assembly of several machines.

use stillbase_exchange::form::{ExchangeError, ExportedAssembly, Form, ModelContent, endings};
use stillbase_exchange::mjcf::{MjcfError, qpos_of_assembly, usual_pose};
use stillbase_exchange::urdf::joint;
use stillbase_files::FoundMachine;
use stillbase_mechanics::assembly::{Assembly, SpatialBase};
use stillbase_mechanics::machine::Machine;
use stillbase_session::assembly::{AssemblyBase, AssemblyScenario};
use stillbase_settings::range::quote_clipped;
use stillbase_settings::text::shell_word;

use super::exit::print_message;
use super::export_model::{ExportModelArguments, ModelBase, Written};
use super::failure::Failure;
use super::input::{MachineArgument, Settings, assembly_scenario};
use super::output::write_file;

/// An assembly, and its scenario if the argument is one.
pub(super) struct FoundAssembly {
    assembly: Assembly,
    scenario: Option<AssemblyScenario>,
}

impl FoundAssembly {
    /// Returns the assembly of an argument; `None` if it is a machine.
    pub(super) fn of(argument: &MachineArgument) -> Result<Option<Self>, Failure> {
        if let Some(assembly) = argument.assembly_file()? {
            return Ok(Some(Self { assembly, scenario: None }));
        }
        let scenario = argument.assembly_scenario()?;
        Ok(scenario.map(|scenario| Self { assembly: scenario.assembly.clone(), scenario: Some(scenario) }))
    }

    /// Returns the machine of a block, with what of gravity is in its plane.
    pub(super) fn machine_of(&self, name: &str) -> Result<FoundMachine, Failure> {
        let blocks = self.assembly.blocks();
        let block = blocks.iter().find(|block| block.name == name).ok_or_else(|| {
            let known: Vec<&str> = blocks.iter().map(|block| block.name.as_str()).collect();
            let (own, known) = (quote_clipped(name), known.join(", "));
            Failure::wrong_input(format!(
                "--block {own:?}: {} has no such block: want one of {known}",
                self.assembly.name
            ))
        })?;
        let mut spec = block.machine.spec().clone();
        let pull = block.mount.in_plane(&self.assembly.gravity);
        spec.gravity = [pull.re, pull.im];
        let machine =
            Machine::new(spec).map_err(|why| Failure::wrong_input(why).with_context(format!("block {name}")))?;
        Ok(FoundMachine { machine, design: Default::default(), base: None, scenario: None, left_out: Vec::new() })
    }
}

impl ExportModelArguments {
    /// Writes the file of an assembly.
    pub(super) fn run_assembly(&self, found: FoundAssembly) -> Result<(), Failure> {
        let FoundAssembly { assembly, scenario } = found;
        let blocks = assembly.blocks();
        let scenario = self.base.as_deref().map(floating).transpose()?.or(scenario);
        let base = scenario.as_ref().and_then(|scenario| match &scenario.base {
            AssemblyBase::Free(base) => Some(&base.body),
            AssemblyBase::Fixed => None,
            AssemblyBase::Compliant(_) => {
                print_message("note: the model holds the base: springs and dampers under it are left out");
                None
            }
        });
        let ending = self.form.check(&self.format, Some(&self.output), self.force, &endings())?;
        let form = Form::of(ending).map_err(Failure::wrong_input)?;
        if !form.shows.is_model() {
            let first = blocks.first().map_or("NAME", |block| &block.name);
            let why = ExchangeError::OneMachine { ending: form.ending };
            let why = Failure::wrong_input(format!("{why}, as --block {}", shell_word(first)));
            return Err(why.with_context(self.output.display()));
        }
        self.check_options(form)?;
        let poses = match self.pose.is_empty() {
            true => {
                let own = scenario.as_ref().filter(|of| of.assembly.name == assembly.name).and_then(start_of);
                let fits = |poses: &Vec<Vec<f64>>| drives(&assembly).eq(poses.iter().map(Vec::len));
                own.filter(fits).unwrap_or_else(|| blocks.iter().map(|block| usual_pose(&block.machine)).collect())
            }
            false => self.poses(&assembly)?,
        };
        let poses: Vec<&[f64]> = poses.iter().map(Vec::as_slice).collect();
        // Of the dimensions only the thickness of counterweights counts, which is the same for all.
        let cut = self.dimensions.cut(&blocks[0].machine);
        let exported = ExportedAssembly { assembly: &assembly, base, poses: &poses, cut: &cut };
        let content = form.written_assembly(&exported).map_err(Failure::wrong_input)?;
        let of = described(&exported, form)?;
        write_file(&self.output, content.as_bytes(), self.force)?;
        let names = blocks.iter().flat_map(|block| {
            block.machine.spec().drives.iter().map(move |drive| format!("{}.{}", block.name, drive.name))
        });
        self.answer(of, form.left_out_of_assembly(&exported), (&assembly.name, names.collect()))
    }

    /// Returns the angles of `--pose`, block by block.
    fn poses(&self, assembly: &Assembly) -> Result<Vec<Vec<f64>>, Failure> {
        let [given, wanted] = [self.pose.len(), drives(assembly).sum()];
        if given != wanted {
            return Err(Failure::wrong_input(MjcfError::Pose { given, wanted }));
        }
        let mut rest = self.pose.iter().copied();
        Ok(drives(assembly).map(|count| rest.by_ref().take(count).collect()).collect())
    }
}

/// Returns the scenario of an assembly whose base floats.
fn floating(name: &str) -> Result<AssemblyScenario, Failure> {
    let found = assembly_scenario(name, &Settings::default())?;
    found.filter(|found| matches!(found.base, AssemblyBase::Free(_))).ok_or_else(|| {
        Failure::wrong_input(format!(
            "--base {name}: it is no scenario of an assembly whose base floats: want one with [base] kind = \"free\""
        ))
    })
}

/// Returns the number of drives of each block.
fn drives(assembly: &Assembly) -> impl Iterator<Item = usize> {
    assembly.blocks().iter().map(|block| block.machine.drives())
}

/// Returns the drive angles of each block at the start of a scenario, rad; `None` if it has no plan.
fn start_of(scenario: &AssemblyScenario) -> Option<Vec<Vec<f64>>> {
    let mut start = None;
    let run = scenario.run(|frame| {
        start = Some(frame.states[..scenario.tasks.len()].iter().map(|state| state.q.0.to_vec()).collect());
        false
    });
    run.ok().and(start)
}

/// Describes the written file.
fn described(of: &ExportedAssembly, form: Form) -> Result<Written, Failure> {
    let base = of.base.map(|SpatialBase { mass, com, inertia }| ModelBase::Spatial {
        mass: *mass,
        inertia: inertia.transpose().into(),
        com: (*com).into(),
        floats: true,
    });
    Ok(match form.shows {
        ModelContent::Pose => {
            let qpos = qpos_of_assembly(of.assembly, of.base, of.poses).map_err(Failure::wrong_input)?;
            Written::Mjcf { pose: of.poses.concat(), qpos, base }
        }
        _ => {
            let blocks = of.assembly.blocks().iter();
            let joints = blocks.flat_map(|block| {
                let machine = &block.machine;
                (0..machine.drives()).map(move |k| format!("{}/{}", block.name, joint(machine, k)))
            });
            Written::Urdf { joints: joints.collect(), base }
        }
    })
}
