//! Values of signals over time, as CSV or Parquet.

use std::path::Path;

use super::ExportError;
use stillbase_files::row_file::RowFile;
use stillbase_query::Sequence;
use stillbase_simulation::frame::Frame;
use stillbase_simulation::signals::{Signal, row_heads};

/// Values to be written.
#[derive(Clone, Debug)]
pub struct ValuesOrder {
    /// The signals, in the order of the columns.
    pub signals: Vec<Signal>,
    /// First and last instant, s.
    pub times: [f64; 2],
}

/// Number of rows between two reports of progress.
const ROWS_PER_REPORT: usize = 1000;

/// Tolerance of the bounds of a time interval, s.
const TIME_TOLERANCE_S: f64 = 1e-9;

/// Writes a row for each step of a time interval, in the format of the file's ending; returns the number of rows.
/// `goes_on` gets the fraction done and says whether to continue.
///
/// # Errors
/// If the file cannot be written, or `goes_on` stops it; no file is left then.
pub fn write_values(
    frames: &Sequence<Frame>,
    order: &ValuesOrder,
    file: &Path,
    force: bool,
    goes_on: &mut dyn FnMut(f64) -> bool,
) -> Result<usize, ExportError> {
    let mut out = RowFile::create(file, force, "instant", &row_heads(&order.signals))?;
    let rows = write_rows(&mut out, frames, order, goes_on)?;
    out.finish()?;
    Ok(rows)
}

/// Returns the same rows as CSV.
///
/// # Errors
/// If they cannot be written.
pub fn values_text(frames: &Sequence<Frame>, order: &ValuesOrder) -> Result<String, ExportError> {
    let mut out = RowFile::in_memory(&row_heads(&order.signals))?;
    write_rows(&mut out, frames, order, &mut |_| true)?;
    Ok(out.into_text()?)
}

fn write_rows(
    out: &mut RowFile,
    frames: &Sequence<Frame>,
    order: &ValuesOrder,
    goes_on: &mut dyn FnMut(f64) -> bool,
) -> Result<usize, ExportError> {
    let [from, to] = order.times;
    let start = frames.partition_point(|frame| frame.time < from - TIME_TOLERANCE_S);
    let end = frames.partition_point(|frame| frame.time <= to + TIME_TOLERANCE_S).max(start);
    let mut row = Vec::with_capacity(order.signals.len() + 1);
    for i in start..end {
        let frame = &frames[i];
        row.clear();
        row.push(Some(frame.time));
        row.extend(order.signals.iter().map(|signal| Some(signal.value(frame))));
        out.row(&row)?;
        let done = i + 1 - start;
        if done.is_multiple_of(ROWS_PER_REPORT) && !goes_on(done as f64 / (end - start) as f64) {
            return Err(ExportError::Stopped);
        }
    }
    if !goes_on(1.0) {
        return Err(ExportError::Stopped);
    }
    Ok(end - start)
}
