//! `stillbase table`

use std::path::PathBuf;

use clap::Args;

use super::failure::Failure;
use super::file_form::FileForm;
use super::output::Format;
use super::rows::{RowTarget, Rows};
use super::signal_choice::SignalChoice;
use super::signal_source::SignalSource;

/// Print the signals of a recording or a table as CSV or Parquet
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase table case-3.rrd -o case-3.csv
  stillbase table cases.rrd:case-1 --signals torque,moment/total --to 0.5 -o part.parquet
  stillbase table part.parquet")]
pub struct TableArguments {
    /// A recording (.rrd; FILE.rrd:CASE is one of its cases) or a table of signals over time (.csv, .parquet); `-` is
    /// CSV from standard input
    #[arg(value_name = "FILE")]
    file: String,
    /// Write the rows to this file, .csv or .parquet; by default CSV goes to standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    choice: SignalChoice,
    #[command(flatten)]
    form: FileForm,
}

impl TableArguments {
    /// Writes a row for each step.
    pub fn run(&self) -> Result<(), Failure> {
        let format = Format { json: false };
        let to = RowTarget::of(&format, &self.form, self.output.as_deref(), self.force)?;
        let source = SignalSource::of_file(&self.file).unwrap_or_else(|| {
            let why = "want a recording or a table, FILE.rrd, FILE.csv or FILE.parquet; `stillbase simulate` has the \
                       signals of a scenario";
            Err(Failure::wrong_input(why).with_context(&self.file))
        });
        let source = source?;
        let mut table = source.only_case()?.clone();
        self.choice.check(table.columns.iter().map(|column| column.path.as_str()))?;
        self.choice.apply(&mut table).map_err(|why| why.with_context(&self.file))?;
        let mut rows = Rows::begin(&to, &table.heads())?;
        for row in 0..table.time.len() {
            rows.row(table.row(row))?;
        }
        rows.finish()
    }
}
