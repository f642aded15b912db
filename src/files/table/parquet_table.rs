//! Reads the columns of a Parquet file.

use std::fs::File;

use parquet::basic::{ConvertedType, LogicalType, Type as Physical};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, DataType};
use parquet::errors::ParquetError;
use parquet::file::metadata::ParquetMetaData;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;
use serde::Deserialize;

use super::columns::{ColumnTable, ColumnValues};
use super::error::TableError;
use super::reader::MAX_COLUMNS;
use super::signals::MAX_BYTES;
use crate::parquet_guard::guarded;
use crate::parquet_rows::GROUP_ROWS;
use stillbase_settings::range::quote_clipped;

/// Maximum number of values of a table. A file states how many it has, and packs equal ones into few bytes.
const MAX_VALUES: u64 = MAX_BYTES / 8;

/// Maximum length of all texts of a table together, bytes, for the same reason.
const MAX_TEXT: usize = 1 << 26;

/// Maximum number of texts of a column; no kind of table needs more.
const MAX_TEXTS: usize = 1 << 20;

/// What pandas calls an index without a name, which is no column of the table.
const NAMELESS_INDEX: &str = "__index_level_";

/// Reads the columns of a Parquet file; `name` is used in errors.
///
/// # Errors
/// If it cannot be read, or is larger than what is read.
pub(crate) fn parquet_columns(file: File, name: &str) -> Result<ColumnTable, TableError> {
    guarded(|| read(file, name), || TableError::of_file(name, "damaged: want a whole Parquet file"))
}

fn read(opened: File, name: &str) -> Result<ColumnTable, TableError> {
    let refused = |why: String| TableError::of_file(name, why);
    let reader = SerializedFileReader::new(opened).map_err(|e| refused(unreadable(&e)))?;
    let all = reader.metadata().file_metadata().schema_descr().columns();
    let read: Vec<(usize, &ColumnDescriptor)> = (0..)
        .zip(all.iter().map(AsRef::as_ref))
        .filter(|(_, column)| !column.name().starts_with(NAMELESS_INDEX))
        .collect();
    if read.len() > MAX_COLUMNS {
        return Err(refused(format!("{} columns: want at most {MAX_COLUMNS}", read.len())));
    }
    let rows = rows(reader.metadata(), read.len()).map_err(refused)?;
    let durations = durations(reader.metadata());
    let mut room = MAX_TEXT;
    let column = |(index, column): &(usize, &ColumnDescriptor)| {
        let called = || format!("column {}", quote_clipped(column.name()));
        if durations.iter().any(|name| name == column.name()) {
            return Ok(ColumnValues::Other("durations, whose unit only pandas knows"));
        }
        let values = values_of(column, &reader, *index, rows, &mut room);
        let values = values.map_err(|e| refused(format!("{}: {}", called(), unreadable(&e))))?;
        let count = match &values {
            ColumnValues::Numbers(values) => values.len(),
            ColumnValues::Texts(values) => values.len(),
            ColumnValues::Other(_) => rows,
        };
        match count == rows {
            true => Ok(values),
            false => Err(refused(format!("{}: {count} of {rows} rows: want a whole file", called()))),
        }
    };
    let columns = read.iter().map(column).collect::<Result<_, _>>()?;
    Ok(ColumnTable { heads: read.iter().map(|(_, column)| column.name().to_owned()).collect(), rows, columns })
}

/// Returns the names of the columns that pandas calls durations; Parquet itself has no such type.
fn durations(metadata: &ParquetMetaData) -> Vec<String> {
    let stated = metadata.file_metadata().key_value_metadata().into_iter().flatten();
    let pandas = stated.filter(|entry| entry.key == "pandas").filter_map(|entry| entry.value.as_deref());
    let columns = pandas.filter_map(|text| serde_json::from_str::<Pandas>(text).ok()).flat_map(|pandas| pandas.columns);
    let durations = columns.filter(|column| column.numpy_type.starts_with("timedelta"));
    durations.map(|column| column.field_name).collect()
}

/// What pandas states of a table in its file.
#[derive(Deserialize)]
struct Pandas {
    columns: Vec<PandasColumn>,
}

/// What pandas states of a column.
#[derive(Deserialize)]
struct PandasColumn {
    field_name: String,
    numpy_type: String,
}

/// Returns the number of rows.
fn rows(metadata: &ParquetMetaData, columns: usize) -> Result<usize, String> {
    let rows = metadata
        .row_groups()
        .iter()
        .map(|group| group.num_rows())
        .try_fold(0_u64, |all, own| all.checked_add(u64::try_from(own).ok()?));
    let most = MAX_VALUES / columns.max(1) as u64;
    match rows.filter(|rows| *rows <= most) {
        Some(rows) => Ok(rows as usize),
        None => Err(format!("more than {most} rows of {columns} columns: want fewer")),
    }
}

/// Reads a column; `room` is the number of bytes of text that may still be read.
fn values_of(
    column: &ColumnDescriptor,
    reader: &SerializedFileReader<File>,
    index: usize,
    rows: usize,
    room: &mut usize,
) -> Result<ColumnValues, ParquetError> {
    match no_number(column) {
        None => numbers_of(reader, index, rows).map(ColumnValues::Numbers),
        Some(TEXT) if rows > MAX_TEXTS => Ok(ColumnValues::Other("more texts than are read")),
        Some(TEXT) => texts_of(reader, index, rows, room).map(ColumnValues::Texts),
        Some(what) => Ok(ColumnValues::Other(what)),
    }
}

/// What a column of texts holds.
const TEXT: &str = "text";

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
            Some(TEXT)
        }
        (Physical::BYTE_ARRAY | Physical::FIXED_LEN_BYTE_ARRAY, ..) => Some("bytes"),
        (Physical::BOOLEAN | Physical::INT32 | Physical::INT64 | Physical::FLOAT | Physical::DOUBLE, ..) => None,
    }
}

/// Returns the values of a column, NaN for nulls.
fn numbers_of(reader: &SerializedFileReader<File>, index: usize, rows: usize) -> Result<Vec<f64>, ParquetError> {
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

/// Returns the texts of a column, empty for nulls.
fn texts_of(
    reader: &SerializedFileReader<File>,
    index: usize,
    rows: usize,
    room: &mut usize,
) -> Result<Vec<String>, ParquetError> {
    let mut all: Vec<ByteArray> = Vec::with_capacity(rows);
    for group in 0..reader.num_row_groups() {
        match reader.get_row_group(group)?.get_column_reader(index)? {
            ColumnReader::ByteArrayColumnReader(column) => append(column, &mut all, |bytes| bytes)?,
            _ => return Err(ParquetError::General("no text".into())),
        }
        if all.len() > rows {
            return Err(ParquetError::General("more values than rows".into()));
        }
    }
    let mut text = |bytes: ByteArray| {
        let fits = room.checked_sub(bytes.len());
        *room = fits.ok_or_else(|| ParquetError::General(format!("more than {MAX_TEXT} bytes of text")))?;
        Ok(String::from_utf8_lossy(bytes.data()).into_owned())
    };
    // A null has no bytes.
    all.into_iter().map(|bytes| if bytes.is_empty() { Ok(String::new()) } else { text(bytes) }).collect()
}

/// Value of a null.
trait Null {
    /// Returns it.
    fn null() -> Self;
}

impl Null for f64 {
    fn null() -> Self {
        Self::NAN
    }
}

impl Null for ByteArray {
    fn null() -> Self {
        Self::from(Vec::new())
    }
}

/// Appends the values of a column of one group of rows.
fn append<T: DataType, V: Null>(
    mut column: ColumnReaderImpl<T>,
    all: &mut Vec<V>,
    value: impl Fn(T::T) -> V,
) -> Result<(), ParquetError> {
    let (mut levels, mut values) = (Vec::new(), Vec::new());
    loop {
        levels.clear();
        values.clear();
        let (records, ..) = column.read_records(GROUP_ROWS, Some(&mut levels), None, &mut values)?;
        if records == 0 {
            return Ok(());
        }
        let mut read = values.drain(..).map(&value);
        match levels.is_empty() {
            true => all.extend(read),
            // A level of 0 marks a null, which has no value.
            false => all.extend(levels.iter().map(|level| match level {
                0 => V::null(),
                _ => read.next().unwrap_or_else(V::null),
            })),
        }
    }
}

/// Returns why a file is not read, in words.
fn unreadable(error: &ParquetError) -> String {
    match error {
        ParquetError::NYI(why) | ParquetError::General(why) if why.contains("compress") || why.contains("feature") => {
            "compressed by a method that is not read here: want Parquet without compression, or with Snappy, gzip, LZ4 or, in the program, Zstandard".into()
        }
        error => format!("{error}: want a whole Parquet file"),
    }
}
