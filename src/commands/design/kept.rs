//! `stillbase design --keep`

use clap::Args;
use serde::Serialize;
use stillbase::mechanics::balance::{Adjusted, Keep, NotKept, Quantity, keep};
use stillbase::mechanics::machine::{Inertia, Machine};
use stillbase::planning::Motion;
use stillbase::settings::number::{fixed, significant};
use stillbase::study::balance_constants::BalanceConstants;
use stillbase::study::measures::Measures;

use super::super::check::balance_tables;
use super::super::failure::Failure;
use super::super::holds::{bound, hold};
use super::super::output::Table;
use super::measures;

/// What may change, and how far.
#[derive(Args)]
pub struct KeepArguments {
    /// Change as little as possible instead: the least Σ (p Δ)², Δ in m or kg. Centres of mass along the links are free,
    /// from where they are; everything else stays
    #[arg(long)]
    pub keep: bool,
    /// Leave these where they are: 3.com is link.3.com
    #[arg(long, value_name = "KEY,…", requires = "keep", value_delimiter = ',')]
    fix: Vec<String>,
    /// Change these, too: 4.mass, 4.com_normal, counterweight.1.mass, counterweight.1.at, each with penalty 1 on a
    /// kilogram or a metre; a mass goes from a tenth to ten times of what it is unless --bound says otherwise
    #[arg(long, value_name = "KEY,…", requires = "keep", value_delimiter = ',')]
    free: Vec<String>,
    /// Change this one only from one value to another, m or kg
    #[arg(long, value_name = "KEY=LO,HI", requires = "keep", value_parser = bound, allow_hyphen_values = true)]
    bound: Vec<(String, [f64; 2])>,
}

impl KeepArguments {
    /// The machine with the least change, and what has changed.
    pub fn run(
        &self,
        machine: &Machine,
        motion: Option<&Motion>,
        penalty: &[f64],
    ) -> Result<(Machine, Answer), Failure> {
        let mut asked = Keep::coms(machine, penalty);
        hold(&mut asked, machine, &self.fix, &self.free, &self.bound)?;
        let kept = keep(machine, &asked).map_err(unkept)?;
        let change = |(one, value): (&Adjusted, &f64)| Change {
            key: one.parameter.key(machine),
            from: one.parameter.value(machine.spec()).unwrap_or_default(),
            to: *value,
            penalty: one.penalty,
            unit: if one.parameter.quantity == Quantity::Mass { "kg" } else { "m" },
        };
        let changes = asked.parameters.iter().zip(&kept.values).map(change).collect();
        let answer = Answer {
            changes,
            cost: kept.cost,
            certified: kept.certified,
            measures: Measures::of(machine, &kept.machine, motion),
            balance: BalanceConstants::of(&Inertia::of(&kept.machine)),
        };
        Ok((kept.machine, answer))
    }
}

/// What is asked for is wrong, or has no answer.
fn unkept(why: NotKept) -> Failure {
    match why {
        NotKept::OutOfRange { .. } | NotKept::NoParameter(_) | NotKept::Twice(_) => Failure::wrong_input(why),
        why => Failure::no_answer(why),
    }
}

/// What has changed, and what it achieves.
#[derive(Serialize)]
pub struct Answer {
    changes: Vec<Change>,
    /// Σ (p Δ)² over the changes.
    cost: f64,
    /// Whether nothing else within the limits has less.
    certified: bool,
    #[serde(flatten)]
    measures: Measures,
    #[serde(flatten)]
    balance: BalanceConstants,
}

#[derive(Serialize)]
struct Change {
    key: String,
    from: f64,
    to: f64,
    /// p, 1/m or 1/kg.
    penalty: f64,
    unit: &'static str,
}

impl Answer {
    /// As a person reads it.
    pub fn text(&self, machine: &Machine, by: &str) -> String {
        let mut table = Table::new(["", "before", "now", "change Δ", "unit", "penalty p"]);
        for Change { key, from, to, penalty, unit } in &self.changes {
            let [was, is, change, p] = [*from, *to, to - from, *penalty].map(|x| fixed(x, 9));
            table.row([key.clone(), was, is, change, (*unit).into(), p]);
        }
        let (name, cost) = (machine.name(), significant(self.cost));
        let sure = match self.certified {
            true => "",
            false => "not certified, the best of several searches: a mass and a place of one body may both change\n",
        };
        format!(
            "{name} · the least change, {by} · Σ (p Δ)² {cost}\n{sure}\n{table}\n{}\n{}",
            measures::text(&self.measures),
            balance_tables(&self.balance, machine)
        )
    }
}
