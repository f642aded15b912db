//! `stillbase machines`

use clap::Args;
use serde::Serialize;
use stillbase_mechanics::machine::builtins;

use super::failure::Failure;
use super::input::Settings;
use super::output::{Format, TextTable};

/// List the built-in machines
#[derive(Args)]
pub struct MachinesArguments {
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    format: Format,
}

#[derive(Serialize)]
struct Answer {
    machines: Vec<Row>,
}

#[derive(Serialize)]
struct Row {
    name: String,
    drives: usize,
    links: usize,
    summary: String,
}

impl MachinesArguments {
    /// Prints the machines.
    pub fn run(&self) -> Result<(), Failure> {
        let mut machines = Vec::new();
        for machine in builtins() {
            let machine = self.settings.apply(machine.clone()).map_err(|e| e.with_context(machine.name()))?;
            machines.push(Row {
                name: machine.name().into(),
                drives: machine.drives(),
                links: machine.links().len(),
                summary: machine.spec().summary.clone(),
            });
        }
        self.format.print(&Answer { machines }, |answer| {
            let mut table = TextTable::new(["machine", "drives", "links", ""]).with_words(3);
            for m in &answer.machines {
                table.row([m.name.clone(), m.drives.to_string(), m.links.to_string(), m.summary.clone()]);
            }
            table.to_string()
        })
    }
}
