//! `stillbase design --keep`

use clap::Args;
use stillbase_mechanics::balance::{RebalanceError, RebalanceRequest};
use stillbase_mechanics::machine::Machine;
use stillbase_planning::Motion;
use stillbase_settings::number::{fixed, significant};
use stillbase_study::centres::{RebalanceChange, RebalanceReport, rebalance_report};

use super::super::check::balance_tables;
use super::super::failure::Failure;
use super::super::holds::{bound, hold};
use super::super::output::TextTable;
use super::measures;

/// What may change, and how far.
#[derive(Args)]
pub struct RebalanceArguments {
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

impl RebalanceArguments {
    /// Returns the machine with the least change, and the report on it.
    pub fn run(
        &self,
        machine: &Machine,
        motion: Option<&Motion>,
        penalty: &[f64],
    ) -> Result<(Machine, RebalanceReport), Failure> {
        let mut asked = RebalanceRequest::coms(machine, penalty);
        hold(&mut asked, machine, &self.fix, &self.free, &self.bound)?;
        rebalance_report(machine, &asked, motion).map_err(as_failure)
    }
}

/// Converts a refusal into a failure: wrong input, or no answer.
fn as_failure(why: RebalanceError) -> Failure {
    match why {
        RebalanceError::OutOfRange { .. } | RebalanceError::NoParameter(_) | RebalanceError::Twice(_) => {
            Failure::wrong_input(why)
        }
        why => Failure::no_answer(why),
    }
}

/// Formats the report as text.
pub fn text(report: &RebalanceReport, machine: &Machine, by: &str) -> String {
    let mut table = TextTable::new(["", "before", "now", "change Δ", "unit", "penalty p"]);
    for RebalanceChange { key, from, to, penalty, unit } in &report.changes {
        let [was, is, change, p] = [*from, *to, to - from, *penalty].map(|x| fixed(x, 9));
        table.row([key.clone(), was, is, change, (*unit).into(), p]);
    }
    let (name, cost) = (machine.name(), significant(report.cost));
    let sure = match report.certified {
        true => "",
        false => "not certified, the best of several searches: a mass and a place of one body may both change\n",
    };
    format!(
        "{name} · the least change, {by} · Σ (p Δ)² {cost}\n{sure}\n{table}\n{}\n{}",
        measures::text(&report.measures),
        balance_tables(&report.balance, machine)
    )
}
