//! Signals over time from a Parquet file.

use std::fs::File;
use std::path::Path;

use parquet::basic::{ConvertedType, LogicalType, Type as Physical};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::errors::ParquetError;
use parquet::file::metadata::ParquetMetaData;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;

use super::error::TableError;
use super::heads::{SignalHeads, wrong_time};
use super::reader::MAX_COLUMNS;
use super::signals::MAX_BYTES;
use crate::parquet_guard::guarded;
use crate::parquet_rows::GROUP_ROWS;
use stillbase_settings::range::quote_clipped;
use stillbase_simulation::signal_table::SignalTable;

/// Maximum number of values of a table. A file states how many it has, and packs equal ones into few bytes.
const MAX_VALUES: u64 = MAX_BYTES / 8;

/// What pandas calls an index without a name, which holds no signal.
const NAMELESS_INDEX: &str = "__index_level_";

/// Reads signals over time from a Parquet file with a column for each; a null is no number.
///
/// # Errors
/// If the file cannot be read or is no such table, or if its time does not increase.
pub(super) fn parquet_signals(file: &Path) -> Result<SignalTable, TableError> {
    let damaged = || TableError::of_file(&file.display().to_string(), "damaged: want a whole Parquet file");
    guarded(|| read_signals(file), damaged)
}

fn read_signals(file: &Path) -> Result<SignalTable, TableError> {
    let name = file.display().to_string();
    let refused = |why: String| TableError::of_file(&name, why);
    let opened =
        crate::text::open(file, MAX_BYTES).map_err(|e| refused(format!("{e}: want a plain file that can be read")))?;
    let reader = SerializedFileReader::new(opened).map_err(|e| refused(unreadable(&e)))?;
    let metadata = reader.metadata();
    let all = metadata.file_metadata().schema_descr().columns();
    let heads_of: Vec<(usize, &ColumnDescriptor)> =
        (0..).zip(all.iter().map(AsRef::as_ref)).filter(|(_, c)| !c.name().starts_with(NAMELESS_INDEX)).collect();
    if heads_of.len() > MAX_COLUMNS {
        return Err(refused(format!("{} columns: want at most {MAX_COLUMNS}", heads_of.len())));
    }
    let heads = SignalHeads::of(heads_of.iter().map(|(_, column)| column.name())).map_err(refused)?;
    let rows = rows(metadata, heads_of.len()).map_err(refused)?;
    if rows == 0 {
        return Err(refused("no row: want at least one".into()));
    }
    let values = |place: usize| {
        let (index, column) = heads_of[place];
        let called = || format!("column {}", quote_clipped(column.name()));
        if let Some(what) = no_number(column) {
            return Err(refused(format!("{}: {what}: want numbers", called())));
        }
        let values =
            column_values(&reader, index, rows).map_err(|e| refused(format!("{}: {}", called(), unreadable(&e))))?;
        match values.len() == rows {
            true => Ok(values),
            false => Err(refused(format!("{}: {} of {rows} rows: want a whole file", called(), values.len()))),
        }
    };
    let time = values(heads.time)?;
    let before = [None].into_iter().chain(time.iter().copied().map(Some));
    if let Some((row, why)) =
        (1..).zip(time.iter().zip(before)).find_map(|(row, (time, before))| Some((row, wrong_time(*time, before)?)))
    {
        return Err(refused(format!("row {row}: {why}")));
    }
    let columns = heads.signals().map(|(place, _)| values(place)).collect::<Result<_, _>>()?;
    Ok(heads.table(time, columns))
}

/// Returns the number of rows.
fn rows(metadata: &ParquetMetaData, columns: usize) -> Result<usize, String> {
    let rows = metadata
        .row_groups()
        .iter()
        .map(|group| group.num_rows())
        .try_fold(0_u64, |all, own| all.checked_add(u64::try_from(own).ok()?));
    let most = MAX_VALUES / columns as u64;
    match rows.filter(|rows| *rows <= most) {
        Some(rows) => Ok(rows as usize),
        None => Err(format!("more than {most} rows of {columns} columns: want fewer")),
    }
}

/// Returns what a column holds that cannot be read as numbers; `None` if it holds numbers.
fn no_number(column: &ColumnDescriptor) -> Option<&'static str> {
    if column.max_rep_level() > 0 || column.path().parts().len() > 1 {
        return Some("lists or groups of values");
    }
    match (column.physical_type(), column.logical_type_ref(), column.converted_type()) {
        (_, Some(LogicalType::Timestamp { .. } | LogicalType::Date | LogicalType::Time { .. }), _)
        | (Physical::INT96, ..)
        | (
            _,
            _,
            ConvertedType::TIMESTAMP_MILLIS
            | ConvertedType::TIMESTAMP_MICROS
            | ConvertedType::DATE
            | ConvertedType::TIME_MILLIS
            | ConvertedType::TIME_MICROS,
        ) => Some("dates or times of day"),
        (_, Some(LogicalType::Decimal { .. }), _) | (_, _, ConvertedType::DECIMAL) => Some("decimal fractions"),
        (Physical::BYTE_ARRAY, Some(LogicalType::String), _) | (Physical::BYTE_ARRAY, _, ConvertedType::UTF8) => {
            Some("text")
        }
        (Physical::BYTE_ARRAY | Physical::FIXED_LEN_BYTE_ARRAY, ..) => Some("bytes"),
        (Physical::BOOLEAN | Physical::INT32 | Physical::INT64 | Physical::FLOAT | Physical::DOUBLE, ..) => None,
    }
}

/// Returns the values of a column, NaN for nulls.
fn column_values(reader: &SerializedFileReader<File>, index: usize, rows: usize) -> Result<Vec<f64>, ParquetError> {
    let mut all = Vec::with_capacity(rows);
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group)?;
        let unsigned = {
            let column = group.metadata().column(index).column_descr();
            let is_so = matches!(column.logical_type_ref(), Some(LogicalType::Integer { is_signed: false, .. }));
            is_so || [ConvertedType::UINT_32, ConvertedType::UINT_64].contains(&column.converted_type())
        };
        match group.get_column_reader(index)? {
            ColumnReader::DoubleColumnReader(column) => append(column, &mut all, |x| x)?,
            ColumnReader::FloatColumnReader(column) => append(column, &mut all, f64::from)?,
            ColumnReader::BoolColumnReader(column) => append(column, &mut all, |x| f64::from(u8::from(x)))?,
            ColumnReader::Int32ColumnReader(column) if unsigned => append(column, &mut all, |x| f64::from(x as u32))?,
            ColumnReader::Int32ColumnReader(column) => append(column, &mut all, f64::from)?,
            ColumnReader::Int64ColumnReader(column) if unsigned => append(column, &mut all, |x| x as u64 as f64)?,
            ColumnReader::Int64ColumnReader(column) => append(column, &mut all, |x| x as f64)?,
            _ => return Err(ParquetError::General("no numbers".into())),
        }
        if all.len() > rows {
            return Err(ParquetError::General("more values than rows".into()));
        }
    }
    Ok(all)
}

/// Appends the values of a column of one group of rows.
fn append<T: DataType>(
    mut column: ColumnReaderImpl<T>,
    all: &mut Vec<f64>,
    number: impl Fn(T::T) -> f64,
) -> Result<(), ParquetError> {
    let (mut levels, mut values) = (Vec::new(), Vec::new());
    loop {
        levels.clear();
        values.clear();
        let (records, ..) = column.read_records(GROUP_ROWS, Some(&mut levels), None, &mut values)?;
        if records == 0 {
            return Ok(());
        }
        let mut read = values.drain(..).map(&number);
        match levels.is_empty() {
            true => all.extend(read),
            // A level of 0 marks a null, which has no value.
            false => all.extend(
                levels.iter().map(|level| if *level == 0 { f64::NAN } else { read.next().unwrap_or(f64::NAN) }),
            ),
        }
    }
}

/// Returns why a file is not read, in words.
fn unreadable(error: &ParquetError) -> String {
    match error {
        ParquetError::NYI(why) | ParquetError::General(why) if why.contains("compress") || why.contains("feature") => {
            format!("{why}: want Parquet without compression, or with Snappy")
        }
        error => format!("{error}: want a whole Parquet file"),
    }
}
