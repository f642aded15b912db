//! `stillbase machines`

use std::io::{self, Write};

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_mechanics::assembly::{Assembly, builtin_assemblies, builtin_text};
use stillbase_mechanics::machine::{Machine, builtins};
use stillbase_mechanics::sketch::Template;
use stillbase_session::scenario::MachineFile;

use super::failure::Failure;
use super::input::{Settings, machine};
use super::new_machine::NewMachine;
use super::output::{Format, TextTable};

/// List the built-in machines and the templates for drawings, or print one as TOML
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase machines
  stillbase machines pantograph -o my-arm.toml       a machine to begin with
  stillbase machines nine-link --set length.l1=0.6")]
pub struct MachinesArguments {
    /// Print this machine as TOML: a built-in one, a template for drawings, or a file
    #[arg(value_name = "MACHINE", conflicts_with = "json")]
    name: Option<String>,
    #[command(flatten)]
    new: NewMachine,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    format: Format,
}

#[derive(JsonSchema, Serialize)]
pub struct Answer {
    machines: Vec<Row>,
    /// Templates from which a person draws; each is a machine, too.
    templates: Vec<Row>,
    /// Assemblies of several machines.
    assemblies: Vec<AssemblyRow>,
}

#[derive(JsonSchema, Serialize)]
struct AssemblyRow {
    name: String,
    /// Names of the blocks.
    blocks: Vec<String>,
    summary: String,
}

#[derive(JsonSchema, Serialize)]
struct Row {
    name: String,
    drives: usize,
    links: usize,
    summary: String,
}

impl Row {
    fn of(name: &str, machine: &Machine, summary: &str) -> Self {
        let (drives, links) = (machine.drives(), machine.links().len());
        Self { name: name.into(), drives, links, summary: summary.into() }
    }
}

impl MachinesArguments {
    /// Prints the machines.
    pub fn run(&self) -> Result<(), Failure> {
        if let Some(name) = &self.name {
            if let Some(text) = builtin_text(name) {
                return self.print_assembly(name, text);
            }
            let MachineFile { machine, design } = machine(name)?;
            return self.print(&MachineFile { machine: self.settings.apply(machine)?, design });
        }
        if self.new.is_wanted() {
            return Err(Failure::wrong_input("--output: want the name of a machine to write"));
        }
        let mut machines = Vec::new();
        for machine in builtins() {
            let machine = self.settings.apply(machine.clone()).map_err(|e| e.with_context(machine.name()))?;
            machines.push(Row::of(machine.name(), &machine, &machine.spec().summary));
        }
        let row =
            |template: Template| Some(Row::of(template.word(), &template.sketch().machine()?, template.summary()));
        let templates = Template::ALL.into_iter().filter_map(row).collect();
        let names = |own: &Assembly| own.blocks().iter().map(|block| block.name.clone()).collect();
        let row = |own: &Assembly| {
            let (name, summary) = (own.name.clone(), own.summary.clone());
            AssemblyRow { name, blocks: names(own), summary }
        };
        let assemblies = builtin_assemblies().iter().map(row).collect();
        self.format.print(&Answer { machines, templates, assemblies }, |answer| {
            let list = |head: &str, rows: &[Row]| {
                let mut table = TextTable::new([head, "drives", "links", ""]).with_words(3);
                for m in rows {
                    table.row([m.name.clone(), m.drives.to_string(), m.links.to_string(), m.summary.clone()]);
                }
                table.to_string()
            };
            let mut several = TextTable::new(["assembly", "blocks", ""]).with_words(3);
            for own in &answer.assemblies {
                several.row([own.name.clone(), own.blocks.join(", "), own.summary.clone()]);
            }
            format!("{}\n{}\n{several}", list("machine", &answer.machines), list("template", &answer.templates))
        })
    }

    /// Prints the file of an assembly.
    fn print_assembly(&self, name: &str, text: &str) -> Result<(), Failure> {
        if self.new.is_wanted() || !self.settings.is_empty() {
            let why = format!("{name} is an assembly: want no -o and no --set, its text goes to standard output");
            return Err(Failure::wrong_input(why));
        }
        print_text(text)
    }

    /// Prints a machine as TOML, or writes it to a file.
    fn print(&self, file: &MachineFile) -> Result<(), Failure> {
        self.new.check(&self.format)?;
        if self.new.is_wanted() {
            return self.new.save(&file.machine, &file.design, file.machine.spec().summary.clone());
        }
        let text = file.to_toml();
        print_text(&text)
    }
}

fn print_text(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(|e| Failure::standard_output(&e))
}
