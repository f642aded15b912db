//! `stillbase layers`

use clap::Args;
use stillbase_exchange::cut::Cut;
use stillbase_exchange::thin::too_thin;
use stillbase_mechanics::machine::Machine;
use stillbase_query::ByIdentity;
use stillbase_session::scenario::MachineFile;
use stillbase_settings::number::{counted, fixed, fixed_or_scientific};
use stillbase_study::layers::{Between, Clash, Contact, LayersReport, LayersRequest, find_layers};

use super::dimensions::Dimensions;
use super::failure::Failure;
use super::input::{MachineArgument, task_run};
use super::new_machine::NewMachine;
use super::output::{Format, TextTable};
use super::strict::Strict;

/// Stack the links of a machine in layers so that it turns without running into itself
///
/// Bars, plates, counterweights with their arms, lumps, the payload and pins that overlap in plan in some pose within
/// the joint limits lie in different layers. Nothing passes between the links of a pin over which it sweeps. The answer
/// has the fewest layers; of several such orders it is the one with the least tilting moment. Without any order, the
/// answer names the fewest links that have none, and where they meet.
///
/// A lump and the payload are cylinders of the material of the discs: as wide as gives them their inertia, and without
/// inertia as high as wide. A motor has a shape if it is a lump.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase layers nine-link
  stillbase layers nine-link --task case-3 -o stacked.toml
  stillbase layers two-drive --bar-width 0.025 --plate-thickness 0.008 --spacer 0.002
  stillbase layers scara --json")]
pub struct LayersArguments {
    #[command(flatten)]
    machine: MachineArgument,
    /// A built-in scenario or a TOML file: of orders with as few layers, the one whose largest tilting moment along its
    /// motion is least
    #[arg(long, value_name = "SCENARIO")]
    task: Option<String>,
    /// Let nothing meet along the motion of --task alone, instead of everywhere within the joint limits
    #[arg(long, requires = "task")]
    along_task: bool,
    #[command(flatten)]
    dimensions: Dimensions,
    #[command(flatten)]
    new_machine: NewMachine,
    #[command(flatten)]
    strict: Strict,
    #[command(flatten)]
    format: Format,
}

impl LayersArguments {
    /// Prints the layers, and writes the machine.
    pub fn run(&self) -> Result<(), Failure> {
        let MachineFile { machine, design } = self.machine.load_file()?;
        self.new_machine.check(&self.format)?;
        let task = self.task.as_ref().map(|name| task_run(name, &[&machine])).transpose()?;
        let motion = task.as_ref().map(|run| ByIdentity(run.plan().motion.clone()));
        let cut = self.dimensions.cut(&machine);
        let request = LayersRequest { machine: machine.clone(), cut, motion, along_task: self.along_task };
        let report = find_layers(&request).map_err(|why| Failure::from(why).with_context(machine.name()))?;
        self.new_machine.save(&report.machine, &design, format!("{}, stacked in layers", machine.name()))?;
        self.format.print(&report, |report| text(report, &machine) + &remarks(&machine, &cut))?;
        let clashes = (!report.clashes.is_empty()).then(|| "links that run into each other".to_owned());
        let open = report.meetings.iter().any(|contact| !contact.decided);
        self.strict
            .require(clashes.into_iter().chain(open.then(|| "meetings of links that are not decided".to_owned())))
    }
}

fn text(report: &LayersReport, machine: &Machine) -> String {
    let mut table = TextTable::new(["link", "drive", "layer", "height mm", "meets in plan"]).with_words(4);
    for (j, (own, link)) in report.layers.iter().zip(&machine.spec().links).enumerate() {
        let met = others(&report.meetings, j);
        let (layer, height) = (own.layer.to_string(), fixed(1e3 * own.height, 3));
        table.row([own.link.clone(), link.drive.clone(), layer, height, met]);
    }
    let fewest = if report.minimal { "no order has fewer" } else { "not proven to be the fewest" };
    let mut text = format!(
        "{} · {} · {} mm high · {fewest}\n\n{table}\n",
        machine.name(),
        counted(report.count, "layer"),
        fixed(1e3 * report.height, 3)
    );
    let least = match report.least_tilt {
        true => "no order with as many layers has less",
        false => "not proven to be the least",
    };
    if let Some(tilt) = &report.tilt {
        let [before, after] = [tilt.before, tilt.after].map(|moment| fixed_or_scientific(moment, 6));
        text += &format!("greatest tilting moment   {after} N m, was {before} N m; {least}\n");
    }
    let [before, after] =
        [report.tilt_coefficient.before, report.tilt_coefficient.after].map(|sum| fixed_or_scientific(sum, 6));
    let of_motion = if report.tilt.is_none() { format!("; {least}") } else { String::new() };
    text += &format!("Σ |Σ m (z − z_CM) a|      {after} kg m², was {before} kg m²{of_motion}\n");
    for words in Clash::lines(&report.clashes, |metres| format!("{} mm", fixed(1e3 * metres, 1))) {
        text += &format!("does not fit as it is     {words}\n");
    }
    let undecided = report.meetings.iter().filter(|contact| !contact.decided).count();
    if undecided > 0 {
        text += &format!("not decided               {}: they count as meeting\n", counted(undecided, "pair"));
    }
    if let Some(near) = &report.clearance {
        let (distance, time) = (fixed(1e3 * near.distance, 2), fixed(near.time, 3));
        text += &format!("least clearance           {distance} mm at {time} s: {}, {}\n", near.a, near.b);
    } else if report.tilt.is_some() {
        text += "least clearance           none: no two solids of different links share a height\n";
    }
    text
}

/// Returns lines on counterweights that are too thin to be made.
fn remarks(machine: &Machine, cut: &Cut) -> String {
    too_thin(&machine.spec().counterweights, cut).iter().map(|remark| format!("note: {remark}\n")).collect()
}

/// Returns the names of what the solids of a link meet, each once.
fn others(meetings: &[Contact], link: usize) -> String {
    let met = meetings.iter().filter_map(|contact| match contact.between {
        Between::Links(a, _) | Between::Pin(a, _) if a == link => Some(contact.b.as_str()),
        Between::Links(_, b) if b == link => Some(contact.a.as_str()),
        _ => None,
    });
    let mut names: Vec<&str> = Vec::new();
    for name in met {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names.join(", ")
}
