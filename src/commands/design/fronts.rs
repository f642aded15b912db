//! `stillbase design A B --counterweights --front N`: the Pareto fronts of several machines.

use std::fmt::Write as _;

use schemars::JsonSchema;
use serde::Serialize;
use stillbase_mechanics::machine::Machine;
use stillbase_study::fronts::{FrontCase, Fronts, FrontsRequest, MachineFront};

use super::super::failure::Failure;
use super::super::input::task_run;
use super::super::output::TextTable;
use super::super::progress::answered;
use super::DesignArguments;
use super::brief::report_brief;
use super::weighed::{FRONT_HEADINGS, cut_failure, front_cells, report_removed};

#[derive(JsonSchema, Serialize)]
pub struct Answer {
    fronts: Vec<MachineFront>,
}

impl DesignArguments {
    /// Prints the Pareto front of each machine, or the reason why it has none.
    pub fn fronts(&self) -> Result<(), Failure> {
        let (machines, design) = self.machine.load_with(&self.other_machines)?;
        let all: Vec<&Machine> = machines.iter().map(|(_, machine)| machine).collect();
        let task = self.task.as_ref().map(|name| task_run(name, &all)).transpose()?;
        let brief = self.weighing.brief(all[0], &design);
        report_brief(self.machine.name(), &design, &brief, |key| self.weighing.asks_for(key));
        let of = |(name, machine)| {
            // The Pareto front trades mass against inertia, neither of which depends on a motion.
            let spec = self.weighing.spec(&machine, &brief, None).map_err(|why| why.with_context(&name))?;
            report_removed(&machine, &format!("{name}: "));
            let (machine, bars) = self.weighing.bars(&machine, &brief).map_err(|why| why.with_context(&name))?;
            Ok(FrontCase { name, machine, spec, bars })
        };
        let machines = machines.into_iter().map(of).collect::<Result<_, Failure>>()?;
        let motion = task.as_ref().and_then(|run| run.shared_motion());
        let request = FrontsRequest { machines, count: self.weighing.front_count(), motion, workspace: true };
        let answer = Answer { fronts: answered::<Fronts>(request)? };
        let mut refused = answer.fronts.iter().filter_map(|of| Some((of, of.outcome.as_ref().err()?)));
        let mut refusals = refused.clone().map(|(of, why)| cut_failure(why.clone()).with_context(&of.name));
        if let Some(wrong) = refusals.find(|why| matches!(why, Failure::WrongInput(_))) {
            return Err(wrong);
        }
        if let (true, Some((of, why))) = (answer.fronts.iter().all(|of| of.outcome.is_err()), refused.next()) {
            return Err(Failure::no_answer(format!("none of these can be balanced: {}: {why}", of.name)));
        }
        self.format.print(&answer, text)
    }
}

/// Formats the fronts as a table, each from minimum mass to minimum inertia; machines without a front follow below.
fn text(answer: &Answer) -> String {
    let mut table = TextTable::new(["machine"].into_iter().chain(FRONT_HEADINGS));
    let mut refused = String::new();
    for MachineFront { name, outcome } in &answer.fronts {
        match outcome {
            Ok(front) => {
                front.points.iter().for_each(|point| table.row([name.clone()].into_iter().chain(front_cells(point))));
            }
            Err(why) => {
                let _ = writeln!(refused, "{name}: {why}");
            }
        }
    }
    format!("{table}{refused}")
}
