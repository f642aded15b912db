//! [`NewMachine`]: the file for a machine that a command makes.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use clap::Args;
use stillbase_files::is_standard;
use stillbase_mechanics::assembly::{Assembly, parse};
use stillbase_mechanics::machine::{Machine, named as known};
use stillbase_session::scenario::{DesignBrief, MachineFile};

use super::failure::Failure;
use super::output::{Format, write_file};

/// Where the new machine is written.
#[derive(Args)]
pub struct NewMachine {
    /// Write the new machine to this file
    #[arg(short, long, value_name = "NEW.toml")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

impl NewMachine {
    /// Whether a file is asked for.
    pub fn is_wanted(&self) -> bool {
        self.output.is_some()
    }

    /// Whether a file that exists is replaced.
    pub fn replaces(&self) -> bool {
        self.force
    }

    /// Checks, before any work is done, that the file may be written.
    pub fn check(&self, format: &Format) -> Result<(), Failure> {
        self.output.as_ref().map_or(Ok(()), |file| format.check_output(file, self.force, &["toml"]).map(|_| ()))
    }

    /// Writes a machine with its brief, if a file is asked for.
    pub fn save(&self, machine: &Machine, design: &DesignBrief, summary: String) -> Result<(), Failure> {
        let Some(file) = &self.output else { return Ok(()) };
        write_file(file, named_after(file, machine, design, summary)?.as_bytes(), self.force)
    }

    /// Writes an assembly, if a file is asked for.
    pub fn save_assembly(&self, assembly: &Assembly, summary: String) -> Result<(), Failure> {
        let Some(file) = &self.output else { return Ok(()) };
        let mut named = assembly.clone();
        (named.name, named.summary) = (stem(file, "assembly"), summary);
        // A name that no file of an assembly may have is told now.
        parse(&named.to_toml(), &named.name, &known)?;
        write_file(file, named.to_toml().as_bytes(), self.force)
    }
}

/// Returns the name of a file without its ending, or a usual one for standard output.
fn stem(file: &Path, usual: &str) -> String {
    let name = file.file_stem().filter(|_| !is_standard(file)).unwrap_or(OsStr::new(usual));
    name.to_string_lossy().into_owned()
}

/// Returns a machine with its brief as TOML, named after its file because it differs from the original machine.
///
/// # Errors
/// If the name of the file cannot be the name of a machine.
pub fn named_after(file: &Path, machine: &Machine, design: &DesignBrief, summary: String) -> Result<String, Failure> {
    let mut spec = machine.spec().clone();
    spec.name = stem(file, "machine");
    spec.summary = summary;
    Ok(MachineFile { machine: Machine::new(spec)?, design: design.clone() }.to_toml())
}
