//! [`ParquetRows`]: rows of cells as a Parquet file, one column for each name.

use std::io::Write;
use std::sync::Arc;

use parquet::basic::{Compression, Encoding, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{ColumnPath, Type};

/// Maximum number of rows of a row group.
pub const GROUP_ROWS: usize = 65_536;

/// Description of a file.
pub struct ParquetHead<'a> {
    /// Name of the schema: what a row is.
    pub row: &'a str,
    /// Kind and name, with the unit, of each column.
    pub columns: Vec<(ColumnKind, &'a str)>,
    /// Key and value of a note in the file's metadata, if there is one.
    pub note: Option<[&'a str; 2]>,
    /// Whether columns are compressed, with Snappy, and encoded for that.
    pub is_compressed: bool,
}

/// What the cells of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// Whole numbers.
    #[cfg_attr(not(feature = "cli"), expect(dead_code, reason = "only studies of tolerances count"))]
    Count,
    /// Texts.
    Text,
    /// Numbers.
    Number,
}

/// A cell of a row, of the kind of its column.
pub enum ParquetCell<'a> {
    /// A whole number.
    #[cfg_attr(not(feature = "cli"), expect(dead_code, reason = "only studies of tolerances count"))]
    Count(i64),
    /// A text.
    Text(&'a str),
    /// A number.
    Number(f64),
}

/// The cells of a column that wait for their row group.
enum Waiting {
    Counts(Vec<i64>),
    Texts(Vec<ByteArray>),
    Numbers(Vec<f64>),
}

/// A Parquet file that is being written, one row group at a time.
pub struct ParquetRows<W: Write + Send> {
    writer: SerializedFileWriter<W>,
    columns: Vec<Waiting>,
    /// Number of rows that wait for their group.
    waiting: usize,
}

impl<W: Write + Send> ParquetRows<W> {
    /// Begins a file.
    ///
    /// # Errors
    /// If the head cannot be written.
    pub fn begin(to: W, head: &ParquetHead<'_>) -> Result<Self, ParquetError> {
        let column = |(kind, name): &(ColumnKind, &str)| {
            let (physical, logical) = match kind {
                ColumnKind::Count => (Physical::INT64, None),
                ColumnKind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
                ColumnKind::Number => (Physical::DOUBLE, None),
            };
            let of = Type::primitive_type_builder(name, physical).with_repetition(Repetition::REQUIRED);
            of.with_logical_type(logical).build().map(Arc::new)
        };
        let fields = head.columns.iter().map(column).collect::<Result<Vec<_>, _>>()?;
        let schema = Type::group_type_builder(head.row).with_fields(fields).build()?;
        // Numbers that hardly repeat do not compress with a dictionary.
        let mut properties = WriterProperties::builder().set_dictionary_enabled(false);
        if head.is_compressed {
            properties = properties.set_compression(Compression::SNAPPY);
            for (kind, name) in &head.columns {
                let column = ColumnPath::from(*name);
                properties = match kind {
                    ColumnKind::Count => properties.set_column_encoding(column, Encoding::DELTA_BINARY_PACKED),
                    ColumnKind::Text => properties.set_column_dictionary_enabled(column, true),
                    ColumnKind::Number => properties.set_column_encoding(column, Encoding::BYTE_STREAM_SPLIT),
                };
            }
        }
        let properties = properties
            .set_created_by(format!("stillbase {}", env!("CARGO_PKG_VERSION")))
            .set_key_value_metadata(head.note.map(|[key, value]| vec![KeyValue::new(key.into(), value.to_owned())]))
            .build();
        let writer = SerializedFileWriter::new(to, Arc::new(schema), Arc::new(properties))?;
        let columns = head.columns.iter().map(|(kind, _)| match kind {
            ColumnKind::Count => Waiting::Counts(Vec::new()),
            ColumnKind::Text => Waiting::Texts(Vec::new()),
            ColumnKind::Number => Waiting::Numbers(Vec::new()),
        });
        Ok(Self { writer, columns: columns.collect(), waiting: 0 })
    }

    /// Adds a row, with a cell for each column.
    ///
    /// # Errors
    /// If a cell is not of the kind of its column, or a row group cannot be written.
    pub fn row<'c>(&mut self, cells: impl IntoIterator<Item = ParquetCell<'c>>) -> Result<(), ParquetError> {
        for (column, cell) in self.columns.iter_mut().zip(cells) {
            match (column, cell) {
                (Waiting::Counts(all), ParquetCell::Count(count)) => all.push(count),
                (Waiting::Texts(all), ParquetCell::Text(text)) => all.push(ByteArray::from(text)),
                (Waiting::Numbers(all), ParquetCell::Number(number)) => all.push(number),
                _ => return Err(ParquetError::General("a cell of another kind than its column".into())),
            }
        }
        self.waiting += 1;
        if self.waiting < GROUP_ROWS { Ok(()) } else { self.write_group() }
    }

    fn write_group(&mut self) -> Result<(), ParquetError> {
        let mut group = self.writer.next_row_group()?;
        for waiting in &mut self.columns {
            let Some(mut column) = group.next_column()? else { break };
            match waiting {
                Waiting::Counts(all) => {
                    column.typed::<Int64Type>().write_batch(all, None, None)?;
                    all.clear();
                }
                Waiting::Texts(all) => {
                    column.typed::<ByteArrayType>().write_batch(all, None, None)?;
                    all.clear();
                }
                Waiting::Numbers(all) => {
                    column.typed::<DoubleType>().write_batch(all, None, None)?;
                    all.clear();
                }
            }
            column.close()?;
        }
        self.waiting = 0;
        group.close().map(|_| ())
    }

    /// Writes the end of the file, and gives back what it was written to.
    ///
    /// # Errors
    /// If the end cannot be written.
    pub fn finish(mut self) -> Result<W, ParquetError> {
        if self.waiting > 0 {
            self.write_group()?;
        }
        self.writer.into_inner()
    }
}
