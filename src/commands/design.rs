//! `stillbase design`

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValue;
use serde::Serialize;
use stillbase::files::write_new;
use stillbase::mechanics::balance::{self, Preset};
use stillbase::mechanics::machine::{Inertia, Machine, to_toml};

use super::check::Balance;
use super::exit::say;
use super::failure::Failure;
use super::input::MachineArgument;
use super::output::{Format, Table, check_output};
use stillbase::settings::number::fixed;

/// Place the links' centres of mass so that the base feels no force and the mass matrix is invariant, Eq. (10)
///
/// Of all balanced designs, the one with the least Σ (p_j l_cj)² is taken: a link with a large penalty p_j keeps its
/// centre of mass near its attachment.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase design nine-link-table-1
  stillbase design nine-link-table-1 --preset minimum-norm -o light.toml
  stillbase design nine-link --set link.9.mass=0.4 --penalty 1,2,1,1,1,1,1,1,1")]
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
    balance: Balance,
}

impl Design {
    /// Prints the new centres of mass and what they achieve, and writes the machine.
    pub fn run(&self) -> Result<(), Failure> {
        let machine = self.machine.load()?;
        let (penalty, by) = self.penalty(machine.links().len())?;
        if let Some(file) = &self.output {
            check_output(file, self.force, &["toml"])?;
        }
        let designed = balance::design(&machine, &penalty)?;
        let answer = Answer {
            com: designed.links().iter().map(|l| l.com).collect(),
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
            format!("{} · {by}\n\n{table}\n{}", machine.name(), answer.balance.tables(&machine))
        })
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

/// Writes a machine under the name of its file: it is not the one that it was made from.
fn save(machine: &Machine, file: &Path, force: bool, summary: String) -> Result<(), Failure> {
    let mut spec = machine.spec().clone();
    spec.name = file.file_stem().unwrap_or(OsStr::new("machine")).to_string_lossy().into_owned();
    spec.summary = summary;
    write_new(file, to_toml(&Machine::new(spec)?).as_bytes(), force)?;
    say(format!("wrote {}", file.display()));
    Ok(())
}
