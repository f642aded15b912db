//! `stillbase table`

use std::path::PathBuf;

use clap::Args;
use stillbase_files::recorded::CaseName;
use stillbase_files::row_file::ROW_ENDINGS;

use super::failure::Failure;
use super::output::Format;
use super::rows::Rows;
use super::simulate::{is_name_of, unknown_signal};

/// Print the signals of a recording as CSV or Parquet
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase table case-3.rrd -o case-3.csv
  stillbase table cases.rrd:case-1 --signals torque,moment/total -o part.parquet")]
pub struct TableArguments {
    /// The recording; FILE.rrd:CASE is one of its cases
    #[arg(value_name = "FILE.rrd")]
    file: String,
    /// Write the rows to this file, .csv or .parquet; by default CSV goes to standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
    /// Print only these signals, by name, such as torque/1, or by its first part, such as torque; default: all
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    signals: Vec<String>,
}

impl TableArguments {
    /// Writes a row for each recorded step.
    pub fn run(&self) -> Result<(), Failure> {
        if let Some(file) = &self.output {
            Format { json: false }.check_output(file, self.force, &ROW_ENDINGS)?;
        }
        let Some(name) = CaseName::of(&self.file) else {
            return Err(Failure::wrong_input("want a recording, FILE.rrd").with_context(&self.file));
        };
        let mut table = name.only_case().map_err(Failure::wrong_input)?.table;
        if !self.signals.is_empty() {
            let has = |name: &&String| table.columns.iter().any(|column| is_name_of(name, &column.path));
            if let Some(unknown) = self.signals.iter().find(|name| !has(name)) {
                let paths = table.columns.iter().map(|column| column.path.as_str());
                return Err(unknown_signal(unknown, paths).with_context("--signals"));
            }
            table.columns.retain(|column| self.signals.iter().any(|name| is_name_of(name, &column.path)));
        }
        let mut rows = Rows::begin(self.output.as_deref(), self.force, &table.heads())?;
        for row in 0..table.time.len() {
            rows.row(table.row(row))?;
        }
        rows.finish()
    }
}
