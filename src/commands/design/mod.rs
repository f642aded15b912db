//! `stillbase design`

mod kept;
mod measures;

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValue;
use serde::Serialize;
use stillbase::files::write_new;
use stillbase::mechanics::balance::{self, Preset};
use stillbase::mechanics::counterweights::{Disc, NoWeights, Objective, Placed, Sites, Weighing, front, place};
use stillbase::mechanics::machine::{Counterweight, Inertia, Machine, to_toml};

use stillbase::study::measures::{Measures, greatest_accelerations};

use super::check::Balance;
use super::exit::say;
use super::failure::Failure;
use super::input::{MachineArgument, Settings, scenario};
use super::output::{Format, Table, check_output};
use kept::KeepArguments;
use stillbase::planning::Motion;
use stillbase::session::{Run, settled};
use stillbase::settings::number::{counted, fixed};

/// Place the links' centres of mass so that the base feels no force and the mass matrix is invariant, Eq. (10)
///
/// Of all balanced designs, the one with the least Σ (p_j l_cj)² is taken: a link with a large penalty p_j keeps its
/// centre of mass near its attachment.
///
/// With --keep the machine changes as little as it can instead: only what may, within bounds. Where that is too little,
/// the answer names what stands in the way, and how far it would have to give.
///
/// With --counterweights the links stay as they are, and discs on them do it: the lightest, or those of the least
/// inertia, as a cone program proves. "gap" is the most by which the best may lie below what was found.
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
  stillbase design nine-link --set link.9.mass=0.5 --counterweights --range 1=-0.3,0.2 --range 2=-0.3,0 \\
    --range 3=-0.3,0 --front 9")]
pub struct Design {
    #[command(flatten)]
    machine: MachineArgument,
    /// Penalty p_j on the centre of mass of each link, 1e-6 to 1e6
    #[arg(long, value_name = "P1,P2,…", value_delimiter = ',', value_parser = penalty)]
    penalty: Vec<f64>,
    /// Penalties by name. table-1: those that give Table I (the default for nine links); as-printed: those printed
    /// beside Eq. (10); minimum-norm: 1 for every link (the default otherwise)
    #[arg(long, value_enum, conflicts_with = "penalty")]
    preset: Option<PresetName>,
    #[command(flatten)]
    kept: KeepArguments,
    /// Balance it by counterweights, discs on the axes of the links; those that it has are taken off first
    #[arg(long, conflicts_with_all = ["penalty", "preset", "keep"])]
    counterweights: bool,
    /// A link that may carry one, and where, m from its root towards its tip; every link, from its length behind the
    /// root to the tip, where none is given
    #[arg(long, value_name = "LINK=LO,HI", requires = "counterweights", value_parser = range, allow_hyphen_values = true)]
    range: Vec<(String, [f64; 2])>,
    /// Density of the discs, kg/m³; steel has 7850
    #[arg(long, value_name = "DENSITY", requires = "counterweights", default_value_t = Disc::STEEL.density)]
    material: f64,
    /// Thickness of the discs, m
    #[arg(long, value_name = "T", requires = "counterweights", default_value_t = Disc::STEEL.thickness)]
    thickness: f64,
    /// The most that a counterweight may weigh, kg: of every link, or LINK=M of one
    #[arg(long, value_name = "[LINK=]M", requires = "counterweights")]
    max_mass: Vec<String>,
    /// What is to be least: mass (added), inertia (Σ D_k), torque (the greatest of a --task), or a mixture as
    /// mass=1,inertia=5
    #[arg(long, value_name = "mass|inertia|torque|WEIGHTS", requires = "counterweights", value_parser = objective)]
    objective: Option<Objective>,
    /// A scenario or a TOML file of one: its motion, as planned for its own machine, counts for torque, and β says what
    /// is left of force, moment and torque on it
    #[arg(long, value_name = "SCENARIO")]
    task: Option<String>,
    /// The most that Σ D_k may be, kg m²
    #[arg(long, value_name = "D", requires = "counterweights")]
    max_inertia: Option<f64>,
    /// Show what less inertia costs in mass, in so many steps from the least mass to the least inertia
    #[arg(long, value_name = "N", requires = "counterweights", value_parser = clap::value_parser!(u16).range(2..=1000))]
    front: Option<u16>,
    /// Write the new machine to this file
    #[arg(short, long, value_name = "NEW.toml")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    format: Format,
}

/// Penalties further apart than these would drown in rounding.
fn penalty(text: &str) -> Result<f64, String> {
    let within = text.trim().parse().ok().filter(|p| (1e-6..=1e6).contains(p));
    within.ok_or_else(|| "want a number from 1e-6 to 1e6".into())
}

#[derive(Clone, Copy)]
struct PresetName(Preset);

impl clap::ValueEnum for PresetName {
    fn value_variants<'a>() -> &'a [Self] {
        &[Self(Preset::ALL[0].0), Self(Preset::ALL[1].0), Self(Preset::ALL[2].0)]
    }
    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(name_of(self.0)))
    }
}

fn name_of(preset: Preset) -> &'static str {
    Preset::ALL.iter().find(|(p, _)| *p == preset).map_or("", |(_, name)| name)
}

#[derive(Serialize)]
struct Answer {
    com: Vec<f64>,
    #[serde(flatten)]
    measures: Measures,
    #[serde(flatten)]
    balance: Balance,
}

impl Design {
    /// Prints the new centres of mass and what they achieve, and writes the machine.
    pub fn run(&self) -> Result<(), Failure> {
        let machine = self.machine.load()?;
        let task = self.task(&machine)?;
        let motion = task.as_ref().map(|run| &*run.plan().motion);
        if self.counterweights {
            return self.weigh(&machine, motion);
        }
        let (penalty, by) = self.penalty(machine.links().len())?;
        if self.kept.keep {
            return self.keep(&machine, motion, &penalty, &by);
        }
        if let Some(file) = &self.output {
            check_output(file, self.force, &["toml"])?;
        }
        let designed = balance::design(&machine, &penalty)?;
        let answer = Answer {
            com: designed.links().iter().map(|l| l.com).collect(),
            measures: Measures::of(&machine, &designed, motion),
            balance: Balance::of(&Inertia::of(&designed)),
        };
        if let Some(file) = &self.output {
            save(&designed, file, self.force, format!("{}, balanced with {by}", machine.name()))?;
        }
        self.format.print(&answer, |answer| {
            let mut table = Table::new(["link", "penalty", "l_c before m", "l_c m"]);
            for (j, link) in machine.links().iter().enumerate() {
                table.row([link.name.clone(), fixed(penalty[j], 6), fixed(link.com, 9), fixed(answer.com[j], 9)]);
            }
            let (measured, balance) = (measures::text(&answer.measures), answer.balance.tables(&machine));
            format!("{} · {by}\n\n{table}\n{measured}\n{balance}", machine.name())
        })
    }

    /// Prints the least change, and writes the machine.
    fn keep(&self, machine: &Machine, motion: Option<&Motion>, penalty: &[f64], by: &str) -> Result<(), Failure> {
        if let Some(file) = &self.output {
            check_output(file, self.force, &["toml"])?;
        }
        let (machine_now, answer) = self.kept.run(machine, motion, penalty)?;
        if let Some(file) = &self.output {
            save(&machine_now, file, self.force, format!("{}, kept balanced with {by}", machine.name()))?;
        }
        self.format.print(&answer, |answer| answer.text(machine, by))
    }

    /// The task whose motion counts.
    fn task(&self, machine: &Machine) -> Result<Option<Run>, Failure> {
        let Some(name) = &self.task else { return Ok(None) };
        let run = Run::new(&settled(&scenario(name, &Settings::default())?)?.0)?;
        let (has, want) = (run.scenario().machine.drives(), machine.drives());
        match has == want {
            true => Ok(Some(run)),
            false => Err(Failure::wrong_input(format!(
                "--task {name}: its machine has {}: want one of {want}",
                counted(has, "drive")
            ))),
        }
    }

    /// Prints counterweights and what they come to, and writes the machine that carries them.
    fn weigh(&self, machine: &Machine, motion: Option<&Motion>) -> Result<(), Failure> {
        if let Some(file) = &self.output {
            check_output(file, self.force, &["toml"])?;
        }
        let asked = self.asked(machine, motion)?;
        let placed = place(machine, &asked).map_err(unweighed)?;
        let front = match self.front {
            Some(count) => front(machine, &asked, count.into()).map_err(unweighed)?.measures(),
            None => Vec::new(),
        };
        let answer = Weighed::of(machine, &placed, front, motion)?;
        if let Some(file) = &self.output {
            save(&placed.machine, file, self.force, format!("{}, balanced by counterweights", machine.name()))?;
        }
        self.format.print(&answer, |answer| answer.text(machine))
    }

    fn asked(&self, machine: &Machine, motion: Option<&Motion>) -> Result<Weighing, Failure> {
        let links = machine.links();
        let find = |name: &str| {
            links.iter().position(|link| link.name == name).ok_or_else(|| {
                let known: Vec<_> = links.iter().map(|link| link.name.as_str()).collect();
                Failure::wrong_input(format!("no link {name}: want one of {}", known.join(", ")))
            })
        };
        let mut sites = Vec::new();
        for (name, [from, to]) in &self.range {
            sites.push(Sites { link: find(name)?, from: *from, to: *to, most: f64::INFINITY });
        }
        if sites.is_empty() {
            let all = machine.resolved_links().iter().enumerate();
            sites = all
                .map(|(link, part)| Sites { link, from: -part.length, to: part.length, most: f64::INFINITY })
                .collect();
        }
        for word in &self.max_mass {
            let (name, most) = word.split_once('=').map_or((None, word.as_str()), |(name, most)| (Some(name), most));
            let want = || Failure::wrong_input(format!("--max-mass {word}: want a mass above 0 in kg, or LINK=M"));
            let most: f64 = most.trim().parse().ok().filter(|most| *most > 0.0).ok_or_else(want)?;
            let only = name.map(|name| find(name.trim())).transpose()?;
            for site in sites.iter_mut().filter(|site| only.is_none_or(|only| only == site.link)) {
                site.most = site.most.min(most);
            }
        }
        let disc = Disc { density: self.material, thickness: self.thickness };
        let mut objective = self.objective.clone().unwrap_or_else(Objective::mass);
        match motion {
            Some(motion) => objective.accelerations = greatest_accelerations(motion).to_vec(),
            None if objective.torque > 0.0 => {
                let why =
                    "--objective torque: the torque depends on the motion: want --task SCENARIO, as --task case-3";
                return Err(Failure::wrong_input(why));
            }
            None => {}
        }
        Ok(Weighing { sites, disc, objective, most_inertia: self.max_inertia })
    }

    fn penalty(&self, links: usize) -> Result<(Vec<f64>, String), Failure> {
        if !self.penalty.is_empty() {
            return Ok((self.penalty.clone(), "the given penalties".into()));
        }
        let usual = if links == 9 { Preset::Table1 } else { Preset::MinimumNorm };
        let preset = self.preset.map_or(usual, |p| p.0);
        Ok((preset.penalty(links)?, format!("preset {}", name_of(preset))))
    }
}

/// What is asked for is wrong, or has no answer.
fn unweighed(why: NoWeights) -> Failure {
    match why {
        NoWeights::OutOfRange { .. } | NoWeights::Twice(_) => Failure::wrong_input(why),
        why => Failure::no_answer(why),
    }
}

fn range(text: &str) -> Result<(String, [f64; 2]), String> {
    let want = || "want LINK=LO,HI in m, as 1=-0.3,0.5".to_owned();
    let (link, places) = text.split_once('=').ok_or_else(want)?;
    let (from, to) = places.split_once(',').ok_or_else(want)?;
    let place = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(want);
    Ok((link.trim().into(), [place(from)?, place(to)?]))
}

fn objective(text: &str) -> Result<Objective, String> {
    let want = || "want mass, inertia, torque, or several with their weights, as mass=1,inertia=5".to_owned();
    let mut objective = Objective { mass: 0.0, ..Objective::mass() };
    for part in text.split(',') {
        let (word, weight) = part.split_once('=').map_or((part, "1"), |(word, weight)| (word, weight));
        let weight: f64 = weight.trim().parse().ok().filter(|w| (0.0..=1e6).contains(w)).ok_or_else(want)?;
        match word.trim() {
            "mass" => objective.mass = weight,
            "inertia" => objective.inertia = weight,
            "torque" => objective.torque = weight,
            _ => return Err(want()),
        }
    }
    match objective.mass + objective.inertia + objective.torque > 0.0 {
        true => Ok(objective),
        false => Err(want()),
    }
}

/// What counterweights come to.
#[derive(Serialize)]
struct Weighed {
    /// Beside the machine without counterweights.
    #[serde(flatten)]
    measures: Measures,
    weights: Vec<Counterweight>,
    /// The most by which the best may lie below what was found.
    gap: f64,
    /// Added mass, kg, and Σ D_k, kg m².
    #[serde(skip_serializing_if = "Vec::is_empty")]
    front: Vec<[f64; 2]>,
    #[serde(flatten)]
    balance: Balance,
}

impl Weighed {
    fn of(machine: &Machine, placed: &Placed, front: Vec<[f64; 2]>, motion: Option<&Motion>) -> Result<Self, Failure> {
        let mut bare = machine.spec().clone();
        bare.counterweights.clear();
        let bare = Machine::new(bare)?;
        let (machine, inertia) = (&placed.machine, Inertia::of(&placed.machine));
        Ok(Self {
            measures: Measures::of(&bare, machine, motion),
            weights: machine.spec().counterweights.clone(),
            gap: placed.gap,
            front,
            balance: Balance::of(&inertia),
        })
    }

    fn text(&self, machine: &Machine) -> String {
        let mut table = Table::new(["counterweight on link", "kg", "at m", "radius m"]);
        for w in &self.weights {
            table.row([w.link.clone(), fixed(w.mass, 6), fixed(w.at, 6), fixed(w.radius, 6)]);
        }
        let mut text = format!(
            "{} · {} kg added · within {:.1e} of the best\n\n{table}\n{}\n{}",
            machine.name(),
            fixed(self.measures.added_mass, 6),
            self.gap,
            measures::text(&self.measures),
            self.balance.tables(machine)
        );
        if !self.front.is_empty() {
            let mut table = Table::new(["added kg", "Σ D_k kg m²"]);
            self.front.iter().for_each(|[mass, inertia]| table.row([fixed(*mass, 6), fixed(*inertia, 6)]));
            text.push_str(&format!("\n{table}"));
        }
        text
    }
}

/// Writes a machine under the name of its file: it is not the one that it was made from.
fn save(machine: &Machine, file: &Path, force: bool, summary: String) -> Result<(), Failure> {
    let mut spec = machine.spec().clone();
    spec.name = file.file_stem().unwrap_or(OsStr::new("machine")).to_string_lossy().into_owned();
    spec.summary = summary;
    write_new(file, to_toml(&Machine::new(spec)?).as_bytes(), force)?;
    say(format!("wrote {}", file.display()));
    Ok(())
}
