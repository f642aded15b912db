//! [`FileForm`]: the format of what goes to standard output, where no ending of a name chooses it.

use std::io::{self, IsTerminal};
use std::path::Path;

use clap::Args;
use stillbase_files::is_standard;

use super::failure::Failure;
use super::input::no_use;
use super::output::{Format, check_output, take_standard_output};

/// Format of what goes to standard output.
#[derive(Args, Default)]
pub struct FileForm {
    /// Format of standard output (-o -), by the ending that such a file has; default: the first that -o names
    #[arg(long = "format", value_name = "ENDING")]
    ending: Option<String>,
}

/// Formats that are no text, by their endings.
const BINARY: [&str; 7] = ["parquet", "png", "webp", "pdf", "gif", "mp4", "rrd"];

impl FileForm {
    /// Returns whether a format is asked for.
    pub fn is_given(&self) -> bool {
        self.ending.is_some()
    }

    /// Checks an output file as [`check`](Self::check) does, if one is asked for.
    ///
    /// # Errors
    /// As [`check`](Self::check), and if a format is asked for, but no file.
    pub fn check_wanted(
        &self,
        format: &Format,
        file: Option<&Path>,
        force: bool,
        endings: &[&'static str],
    ) -> Result<Option<&'static str>, Failure> {
        match file {
            Some(_) => self.check(format, file, force, endings).map(Some),
            None if self.is_given() => Err(no_use("--format", "-o - as well")),
            None => Ok(None),
        }
    }

    /// Checks an output file as [`check_output`] does. Standard output, `-` or no file, gets the format that is asked for,
    /// or the first of those allowed. Returns the ending of the format.
    ///
    /// # Errors
    /// As [`check_output`], and if the format is not allowed or has no use. Standard output is refused if JSON goes there,
    /// too, or if it is a terminal and the format is no text.
    pub fn check(
        &self,
        format: &Format,
        file: Option<&Path>,
        force: bool,
        endings: &[&'static str],
    ) -> Result<&'static str, Failure> {
        if let Some(file) = file.filter(|file| !is_standard(file)) {
            return match &self.ending {
                None => check_output(file, force, endings),
                Some(_) => Err(Failure::wrong_input(format!(
                    "--format has no use here: the ending of {} chooses; want -o - for standard output",
                    file.display()
                ))),
            };
        }
        if format.json && (file.is_some() || self.is_given()) {
            return Err(Failure::wrong_input("--json and -o - both want standard output: want one of them"));
        }
        let ending = match &self.ending {
            None => endings.first(),
            Some(own) => endings.iter().find(|ending| own.trim_start_matches('.').eq_ignore_ascii_case(ending)),
        };
        let ending = ending.copied().ok_or_else(|| {
            let own = self.ending.as_deref().unwrap_or_default();
            Failure::wrong_input(format!("--format {own}: want {}", endings.join(" or ")))
        })?;
        if BINARY.contains(&ending) && io::stdout().is_terminal() {
            let why = format!("a terminal shows no {ending}: want a file, as -o FILE.{ending}, or a pipe");
            return Err(Failure::wrong_input(why).with_context("standard output"));
        }
        if file.is_some() {
            take_standard_output();
        }
        Ok(ending)
    }
}
