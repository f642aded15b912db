//! [`NewMachine`]: the file for a machine that a command makes.

use std::ffi::OsStr;
use std::path::PathBuf;

use clap::Args;
use stillbase_files::write_new;
use stillbase_mechanics::machine::{Machine, to_toml};

use super::exit::print_message;
use super::failure::Failure;
use super::output::check_output;

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

    /// Checks, before any work is done, that the file may be written.
    pub fn check(&self) -> Result<(), Failure> {
        self.output.as_ref().map_or(Ok(()), |file| check_output(file, self.force, &["toml"]).map(|_| ()))
    }

    /// Writes a machine, if a file is asked for, named after its file because it differs from the original machine.
    pub fn save(&self, machine: &Machine, summary: String) -> Result<(), Failure> {
        let Some(file) = &self.output else { return Ok(()) };
        let mut spec = machine.spec().clone();
        spec.name = file.file_stem().unwrap_or(OsStr::new("machine")).to_string_lossy().into_owned();
        spec.summary = summary;
        write_new(file, to_toml(&Machine::new(spec)?).as_bytes(), self.force)?;
        print_message(format!("wrote {}", file.display()));
        Ok(())
    }
}
