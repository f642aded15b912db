//! `stillbase design`

mod assembly;
mod brief;
mod fronts;
mod kept;
mod measures;
mod varied;
mod weighed;

use clap::Args;
use stillbase_mechanics::balance::Preset;
use stillbase_mechanics::machine::Machine;
use stillbase_study::centres::design_centres;

use super::check::balance_tables;
use super::failure::Failure;
use super::input::{MachineArgument, choice, task_run};
use super::new_machine::NewMachine;
use super::output::{Format, TextTable};
use super::strict::Strict;
use brief::report_brief;
pub use fronts::Answer as FrontsAnswer;
use kept::RebalanceArguments;
use stillbase_planning::Motion;
use stillbase_session::scenario::{DesignBrief, MachineFile};
use stillbase_settings::number::fixed;
use stillbase_settings::word::Choice;
pub use varied::Answer as VariedAnswer;
use varied::VaryArguments;
use weighed::WeightArguments;

/// Place the links' centres of mass so that the base feels no force and the mass matrix is invariant, Eq. (10)
///
/// The result is the balanced design with minimum Σ (p_j l_cj)². A link with a large penalty p_j keeps its centre of
/// mass near its attachment.
///
/// With --keep the machine changes as little as possible instead: only free parameters change, within their bounds. If
/// no balanced design lies within them, the answer names the bounds in conflict and a relaxation that suffices.
///
/// With --counterweights the links stay unchanged, and discs on them balance the machine. A cone program finds the
/// lightest discs, or those of least inertia. "gap" is the maximum amount by which the optimum may be lower.
///
/// What the file of the machine asks for in its table [design] applies, too. The options overrule it, and a note says so.
///
/// With --counterweights --front and several machines, the answer compares their Pareto fronts under the same bounds.
/// For a machine that no counterweights within the bounds balance, it gives the reason.
///
/// Of an assembly --counterweights balances all blocks together: what is minimised is that of the whole, and what a block
/// carries counts at its end effector. Links and drives are named with their block, as wrist.2.
///
/// With --counterweights --vary it finds them for many machines, writes a row for each to --table, and tells those that no
/// other is better than in both mass and inertia. Parts of a study (--shard) are tables that stand one below the other.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase design nine-link-table-1
  stillbase design nine-link-table-1 --preset minimum-norm -o light.toml
  stillbase design nine-link --set link.9.mass=0.4 --penalty 1,2,1,1,1,1,1,1,1
  stillbase design nine-link --set link.5.com=-0.05 --keep --fix 5.com --bound 2.com=-0.3,0.1
  stillbase design nine-link --set payload.mass=0.2 --keep --free 1.mass,2.mass,3.mass -o loaded.toml
  stillbase design nine-link --counterweights --objective torque --task case-3
  stillbase design two-drive --counterweights --objective inertia --thickness 0.02
  stillbase design nine-link-bare --counterweights --objective mass=1,inertia=5 --max-mass 1=8 --front 9
  stillbase design nine-link-bare two-drive my.toml --counterweights --front 9
  stillbase design nine-link-bare --counterweights --clearance 0.01 --max-radius 0.12
  stillbase design nine-link-bare --counterweights --payload 0,0.2
  stillbase design nine-link-bare --counterweights --vary length.l5=0.3:0.6:7 --vary material=steel,tungsten --table designs.csv
  stillbase design nine-link-bare --counterweights --length l5=0.3,0.6 --length l9=0.2,0.5 --min-reach 1.26
  stillbase design nine-link-bare --counterweights --bars 0.03,0.006 --thickness 0.02 -o cut.toml
  stillbase design carrier-and-wrist --counterweights --range carrier.1=-0.5,0.5 -o balanced.toml
  stillbase design counter-rotating --counterweights --rotor-ratio 1=-40,0 --objective momentum")]
pub struct DesignArguments {
    #[command(flatten)]
    machine: MachineArgument,
    /// More machines, to compare their Pareto fronts with that of the first under the same bounds and settings
    #[arg(value_name = "MACHINE", requires = "front", conflicts_with_all = ["objective", "length", "output"])]
    other_machines: Vec<String>,
    /// Penalty p_j on the centre of mass of each link, 1e-6 to 1e6
    #[arg(long, value_name = "P1,P2,…", value_delimiter = ',', value_parser = penalty)]
    penalty: Vec<f64>,
    /// Penalties by name; default: table-1 for nine links, minimum-norm for others
    #[arg(long, value_parser = choice(Preset::ALL.iter().copied()), conflicts_with = "penalty")]
    preset: Option<Preset>,
    #[command(flatten)]
    rebalance: RebalanceArguments,
    #[command(flatten)]
    weighing: Box<WeightArguments>,
    #[command(flatten)]
    varying: Box<VaryArguments>,
    /// A built-in scenario or a TOML file: its motion, planned for its own machine, determines the torque. Each β is
    /// the ratio of force, moment or torque (root mean squares along this motion) to its value before
    #[arg(long, value_name = "SCENARIO")]
    task: Option<String>,
    #[command(flatten)]
    new_machine: NewMachine,
    #[command(flatten)]
    strict: Strict,
    #[command(flatten)]
    format: Format,
}

/// Parses a penalty; beyond these limits, rounding would hide the smallest penalties.
fn penalty(text: &str) -> Result<f64, String> {
    let within = text.trim().parse().ok().filter(|p| (1e-6..=1e6).contains(p));
    within.ok_or_else(|| "want a number from 1e-6 to 1e6".into())
}

impl DesignArguments {
    /// Prints the new centres of mass and the balance that they achieve, and writes the machine.
    pub fn run(&self) -> Result<(), Failure> {
        if let (true, Some(assembly)) = (self.other_machines.is_empty(), self.machine.assembly_file()?) {
            return self.assembly(&assembly);
        }
        if self.weighing.in_plane {
            return Err(Failure::wrong_input("--in-plane: a machine by itself is: want it with an assembly"));
        }
        if !self.other_machines.is_empty() {
            return self.fronts();
        }
        let MachineFile { machine, design } = self.machine.load_file()?;
        let task = self.task.as_ref().map(|name| task_run(name, &[&machine])).transpose()?;
        let motion = task.as_ref().map(|run| &*run.plan().motion);
        if self.varying.is_asked() {
            return self.vary(&machine, &design, motion);
        }
        if self.weighing.counterweights {
            return self.weigh(&machine, &design, motion);
        }
        let (penalty, by) = self.penalty(&machine, &design)?;
        if self.rebalance.keep {
            return self.keep(&machine, &design, motion, (&penalty, &by));
        }
        self.new_machine.check(&self.format)?;
        let (designed, answer) = design_centres(&machine, &penalty, motion)?;
        self.new_machine.save(&designed, &design, format!("{}, balanced with {by}", machine.name()))?;
        self.format.print(&answer, |answer| {
            let mut table = TextTable::new(["link", "penalty", "l_c before m", "l_c m"]);
            for (j, link) in machine.links().iter().enumerate() {
                table.row([link.name.clone(), fixed(penalty[j], 6), fixed(link.com, 9), fixed(answer.com[j], 9)]);
            }
            let (measured, balance) = (measures::text(&answer.measures), balance_tables(&answer.balance, &machine));
            format!("{} · {by}\n\n{table}\n{measured}\n{balance}", machine.name())
        })
    }

    /// Prints the least change, and writes the machine.
    fn keep(
        &self,
        machine: &Machine,
        design: &DesignBrief,
        motion: Option<&Motion>,
        (penalty, by): (&[f64], &str),
    ) -> Result<(), Failure> {
        self.new_machine.check(&self.format)?;
        let brief = self.rebalance.brief(machine, design)?;
        let concerns = |key: &str| key.starts_with("fixed.") || key.starts_with("hold.");
        report_brief(self.machine.name(), design, &brief, concerns);
        let (machine_now, answer) = self.rebalance.run(machine, &brief, motion, penalty)?;
        self.new_machine.save(&machine_now, design, format!("{}, kept balanced with {by}", machine.name()))?;
        self.format.print(&answer, |answer| kept::text(answer, machine, by))
    }

    /// Prints counterweights and their measures, and writes the machine that carries them.
    fn weigh(&self, machine: &Machine, design: &DesignBrief, motion: Option<&Motion>) -> Result<(), Failure> {
        self.new_machine.check(&self.format)?;
        let brief = self.weighing.brief(machine, design);
        report_brief(self.machine.name(), design, &brief, |key| self.weighing.asks_for(key));
        let (weighed, answer) = self.weighing.run(machine, &brief, motion)?;
        let how = if answer.is_balanced { "balanced by" } else { "with" };
        self.new_machine.save(&weighed, &brief, format!("{}, {how} counterweights", machine.name()))?;
        self.format.print(&answer, |answer| weighed::text(answer, machine))
    }

    /// Returns the penalties, and by which words they are named: those of the arguments, else of the brief, else the
    /// usual ones.
    fn penalty(&self, machine: &Machine, design: &DesignBrief) -> Result<(Vec<f64>, String), Failure> {
        let links = machine.links().len();
        if !self.penalty.is_empty() {
            return Ok((self.penalty.clone(), "the given penalties".into()));
        }
        let usual = if links == 9 { Preset::Table1 } else { Preset::MinimumNorm };
        let asked = Some(design.penalties).filter(|asked| links == 9 && *asked != DesignBrief::default().penalties);
        if let Some(asked) = asked {
            let now = DesignBrief { penalties: self.preset.unwrap_or(asked), ..design.clone() };
            report_brief(self.machine.name(), design, &now, |key| key == "penalties");
        }
        let preset = self.preset.or(asked).unwrap_or(usual);
        Ok((preset.penalty(links)?, format!("preset {}", preset.name())))
    }
}
