//! `stillbase design --keep`

use clap::Args;
use stillbase_mechanics::balance::{Body, Parameter, ParameterBounds, RebalanceError, RebalanceRequest};
use stillbase_mechanics::machine::Machine;
use stillbase_planning::Motion;
use stillbase_session::scenario::DesignBrief;
use stillbase_settings::number::{fixed, significant};
use stillbase_study::centres::{RebalanceChange, RebalanceReport, rebalance_report};

use super::super::check::balance_tables;
use super::super::failure::Failure;
use super::super::holds::{apply_bounds, bound};
use super::super::output::TextTable;
use super::measures;

/// Parameters that may change, and their bounds.
#[derive(Args)]
pub struct RebalanceArguments {
    /// Change the machine as little as possible: minimise Σ (p Δ)², with the changes Δ in m or kg. Centres of mass may
    /// move along their links; everything else stays fixed
    #[arg(long)]
    pub keep: bool,
    /// Keep these parameters fixed; 3.com is short for link.3.com
    #[arg(long, value_name = "KEY,…", requires = "keep", value_delimiter = ',')]
    fix: Vec<String>,
    /// Let these change, too: 4.mass, 4.com_normal, counterweight.1.mass, counterweight.1.at, with a penalty of 1 per
    /// kilogram or metre. A mass stays between 0.1 and 10 times its original value unless --bound sets other bounds
    #[arg(long, value_name = "KEY,…", requires = "keep", value_delimiter = ',')]
    free: Vec<String>,
    /// Let this parameter change within these bounds only, m or kg
    #[arg(long, value_name = "KEY=LO,HI", requires = "keep", value_parser = bound, allow_hyphen_values = true)]
    bound: Vec<(String, [f64; 2])>,
}

impl RebalanceArguments {
    /// Returns the brief of a file with the bounds that the arguments state in place of its own.
    pub fn brief(&self, machine: &Machine, own: &DesignBrief) -> Result<DesignBrief, Failure> {
        let mut stated = RebalanceRequest::default();
        apply_bounds(&mut stated, machine, &self.fix, &self.free, &self.bound)?;
        let mut brief = own.clone();
        let held = stated.parameters.iter().map(|one| (one.parameter.key(machine), one.bounds));
        brief.hold.0.extend(held);
        Ok(brief)
    }

    /// Returns the machine with the least change within the bounds of a brief, and the report on it.
    pub fn run(
        &self,
        machine: &Machine,
        brief: &DesignBrief,
        motion: Option<&Motion>,
        penalty: &[f64],
    ) -> Result<(Machine, RebalanceReport), Failure> {
        let mut request = RebalanceRequest::coms(machine, penalty);
        for parameter in Parameter::all(machine) {
            let stays = matches!(parameter.body, Body::Link(j) if brief.fixed.contains(&machine.links()[j].name));
            let listed = request.parameters.iter().any(|one| one.parameter == parameter);
            match brief.hold.get(&parameter.key(machine)) {
                Some(bounds) => request.set_bounds(machine, parameter, *bounds),
                None if stays && listed => request.set_bounds(machine, parameter, ParameterBounds::Fixed),
                None => {}
            }
        }
        rebalance_report(machine, &request, motion).map_err(as_failure)
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
