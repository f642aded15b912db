//! `stillbase check`

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_exchange::cut::Cut;
use stillbase_exchange::solids::has_heights;
use stillbase_mechanics::machine::{Counterweight, Inertia, Machine};
use stillbase_planning::off_plane::momentum::MomentumModel;
use stillbase_planning::off_plane::null_space::{MomentumFreedom, is_integrable};
use stillbase_planning::pose_constant::PoseConstant;
use stillbase_session::verdict::Statement;
use stillbase_study::balance_constants::BalanceConstants;
use stillbase_study::counterweights::{CounterweightNumbers, all_numbers};
use stillbase_study::layers::{Clash, LayersRequest, NoLayers, find_contacts};
use stillbase_study::parts::{LinkParts, PartRow};

use super::check_assembly;
use super::failure::Failure;
use super::input::MachineArgument;
use super::output::{Format, TextTable, yes};
use super::strict::Strict;
use stillbase_settings::number::{fixed, fixed_or_finer};

/// Say whether a machine is force balanced and its mass matrix invariant, Eqs (7), (8)
///
/// Of an assembly it says which blocks react while they hold their b, and why.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase check nine-link
  stillbase check nine-link --set payload.mass=0.4     what 0.4 kg at the end effector does
  stillbase check arm.toml --json")]
pub struct CheckArguments {
    #[command(flatten)]
    machine: MachineArgument,
    #[command(flatten)]
    strict: Strict,
    #[command(flatten)]
    format: Format,
}

/// Formats the balance constants, with a row for each drive, then one for each pair of drives.
pub fn balance_tables(balance: &BalanceConstants, machine: &Machine) -> String {
    let drives = &machine.spec().drives;
    let mut by_drive = TextTable::new(["drive", "g kg m", "H kg m²", "D kg m²", "λ"]);
    for (k, drive) in drives.iter().enumerate() {
        let [h, d] = [&balance.h, &balance.d].map(|of| fixed_or_finer(of[k], 9));
        let row = [fixed(balance.gamma_coefficients[k], 9), h, d, fixed(balance.lambda[k], 9)];
        by_drive.row([drive.name.clone()].into_iter().chain(row));
    }
    if drives.len() < 2 {
        return by_drive.to_string();
    }
    let mut by_pair = TextTable::new(["pair", "C kg m²"]);
    for ((k, l), c) in Inertia::pairs(drives.len()).zip(&balance.coupling_coefficients) {
        by_pair.row([format!("{}, {}", drives[k].name, drives[l].name), fixed(*c, 9)]);
    }
    format!("{by_drive}\n{by_pair}")
}

/// Formats what the parts of each link bring, with a sum for each link, and which typed numbers overrule them.
fn parts_table(links: &[LinkParts]) -> String {
    if links.is_empty() {
        return String::new();
    }
    let mut table = TextTable::new(["link", "part", "kg", "at mm", "across mm", "inertia kg m²"]).with_words(1);
    for link in links {
        for row in link.parts.iter().map(|part| &part.row).chain([&link.sum]) {
            let [at, across] = [row.at, row.across].map(|metres| fixed(1e3 * metres, 3));
            let inertia = fixed(row.inertia, 9);
            table.row([row.link.clone(), row.name.clone(), fixed(row.mass, 6), at, across, inertia]);
        }
    }
    let overruled: String = links.iter().filter_map(LinkParts::overruled).map(|words| words + "\n").collect();
    format!("\n{table}{overruled}")
}

/// Formats the counterweights, one a row, with the sizes that some of them have.
fn counterweights_table(weights: &[Counterweight]) -> String {
    if weights.is_empty() {
        return String::new();
    }
    let sizes = Counterweight::sizes_of(weights);
    let heads = ["counterweight on link", "shape", "kg", "at mm", "across mm"].map(String::from);
    let mut table =
        TextTable::new(heads.into_iter().chain(sizes.iter().map(|size| format!("{size} mm")))).with_words(1);
    for weight in weights {
        let stays = if weight.fixed { ", stays" } else { "" };
        let shape = format!("{}{stays}", weight.shape().name());
        let [at, across] = [weight.at, weight.across].map(|metres| fixed(1e3 * metres, 3));
        let size = |name: &&str| weight.sizes().find(|(own, _)| own == name).map(|(_, metres)| fixed(1e3 * metres, 3));
        let sizes = sizes.iter().map(|name| size(name).unwrap_or_else(|| "–".into()));
        table.row([weight.link.clone(), shape, fixed(weight.mass, 6), at, across].into_iter().chain(sizes));
    }
    format!("\n{table}")
}

#[derive(JsonSchema, Serialize)]
pub struct Answer {
    mass: f64,
    #[serde(flatten)]
    balance: BalanceConstants,
    force_balanced: bool,
    invariant: bool,
    /// Statement on the machine, as in window and recordings.
    machine: Statement,
    /// Whether some function b(q) is constant along all motions of zero angular momentum.
    integrable: bool,
    /// How well a constant b = Σ λ_k q_k keeps moments from the base: `exact`, `nearly`, `unneeded` or `none`.
    pose_constant: &'static str,
    /// Parts that meet within the joint limits at the heights of their links; absent if the machine states no heights.
    #[serde(skip_serializing_if = "Option::is_none")]
    clashes: Option<Vec<Clash>>,
    /// What each part and lump of the links brings.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    parts: Vec<PartRow>,
    /// The counterweights.
    #[serde(skip_serializing_if = "Vec::is_empty", serialize_with = "all_numbers")]
    #[schemars(with = "Vec<CounterweightNumbers>")]
    counterweights: Vec<Counterweight>,
}

/// Returns which parts meet within the joint limits at the heights that a machine states; `None` if it states none.
fn clashes(machine: &Machine) -> Option<Result<Vec<Clash>, NoLayers>> {
    let cut = Cut::default().fitting(machine);
    let request = LayersRequest { machine: machine.clone(), cut, motion: None, along_task: false };
    has_heights(machine).then(|| Ok(Clash::all(machine, &find_contacts(&request)?)))
}

/// Says in lines whether the heights of a machine fit.
fn heights_lines(clashes: Option<&Result<Vec<Clash>, NoLayers>>) -> String {
    match clashes {
        None => String::new(),
        Some(Err(why)) => format!("heights          not checked: {why}\n"),
        Some(Ok(clashes)) if clashes.is_empty() => {
            "heights          fit: no two parts meet within the joint limits\n".into()
        }
        Some(Ok(clashes)) => {
            let lines = Clash::lines(clashes, |metres| format!("{} mm", fixed(1e3 * metres, 1)));
            let all = lines.join("\n                 ");
            format!(
                "heights          do not fit everywhere within the joint limits; `stillbase layers` finds others:\n                 {all}\n"
            )
        }
    }
}

/// Says how far links that keep their orientation are from balance; nothing if there are none.
fn ground_line(inertia: &Inertia) -> String {
    match inertia.grounded {
        true => format!("kept orientation largest |C_0k| {:.1e} kg m²\n", inertia.ground_residual()),
        false => String::new(),
    }
}

impl CheckArguments {
    /// Prints the verdict; a machine that is not balanced is no failure.
    pub fn run(&self) -> Result<(), Failure> {
        if let Some(assembly) = self.machine.assembly()? {
            return check_assembly::check(&assembly, &self.format, &self.strict);
        }
        let found = self.machine.find().map_err(|why| self.machine.incomplete_drawing().unwrap_or(why))?;
        let (machine, floats) = (found.machine, found.base.is_some());
        let (inertia, constant) = (Inertia::of(&machine), PoseConstant::of(&machine));
        let (parts, clashes) = (LinkParts::all(&machine), clashes(&machine));
        let answer = Answer {
            mass: inertia.mass(),
            balance: BalanceConstants::of(&inertia),
            force_balanced: inertia.is_force_balanced(),
            invariant: inertia.is_invariant(),
            machine: Statement::of_machine(&inertia),
            integrable: is_integrable(&inertia),
            pose_constant: constant.word(),
            clashes: clashes.as_ref().and_then(|clashes| clashes.as_ref().ok()).cloned(),
            parts: parts.iter().flat_map(|link| &link.parts).map(|part| part.row.clone()).collect(),
            counterweights: machine.spec().counterweights.clone(),
        };
        let fits = clashes.as_ref().is_none_or(|clashes| clashes.as_ref().is_ok_and(Vec::is_empty));
        // On a base that floats zero momentum needs no balance, but drives enough to follow a path.
        let follows = MomentumFreedom::of(&MomentumModel::from(&inertia)) == MomentumFreedom::AnyCurve;
        let found = [
            (floats || answer.force_balanced, "not force balanced"),
            (floats || answer.invariant, "not invariant"),
            (!floats || follows, "too few drives to follow a path without momentum"),
            (fits, "its links run into each other"),
        ];
        let base_line = match (floats, follows) {
            (false, _) => "",
            (true, true) => "base             floats: paths at zero momentum keep its attitude, and need no balance\n",
            (true, false) => {
                "base             floats, and turns along most paths: want three drives to keep its attitude\n"
            }
        };
        self.format.print(&answer, |answer| {
            let (force, coupling) = (inertia.force_residual(), inertia.invariance_residual());
            format!(
                "{} · {}\n\nmachine          {}\nmass             {} kg\nforce balanced   {}, largest |g_k| {force:.1e} kg m\n\
                 invariant        {}, largest |C_kl| {coupling:.1e} kg m²\n\
                 {}pose constant    {}\n{base_line}{}\n{}{}{}",
                machine.name(),
                machine.spec().summary,
                answer.machine.words,
                fixed(answer.mass, 3),
                yes(answer.force_balanced),
                yes(answer.invariant),
                ground_line(&inertia),
                constant,
                heights_lines(clashes.as_ref()),
                balance_tables(&answer.balance, &machine),
                parts_table(&parts),
                counterweights_table(&answer.counterweights),
            )
        })?;
        let faults = found.into_iter().filter(|(is_good, _)| !is_good);
        self.strict.require(faults.map(|(_, what)| format!("{}: {what}", machine.name())))
    }
}
