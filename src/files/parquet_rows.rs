//! [`ParquetRows`]: rows of numbers as a Parquet file, one column for each name.

use std::io::Write;
use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

/// Maximum number of rows of a row group.
pub const GROUP_ROWS: usize = 65_536;

/// Description of a file.
pub struct ParquetHead<'a> {
    /// Name of the schema: what a row is.
    pub row: &'a str,
    /// Name of a first column of whole numbers, if there is one.
    pub count: Option<&'a str>,
    /// Names of columns of text, before those of numbers.
    pub texts: &'a [&'a str],
    /// Names of the other columns, with units.
    pub columns: &'a [String],
    /// Key and value of a note in the file's metadata, if there is one.
    pub note: Option<[&'a str; 2]>,
}

/// A Parquet file that is being written, one row group at a time.
pub struct ParquetRows<W: Write + Send> {
    writer: SerializedFileWriter<W>,
    counts: Option<Vec<i64>>,
    texts: Vec<Vec<ByteArray>>,
    columns: Vec<Vec<f64>>,
    /// Number of rows that wait for their group.
    waiting: usize,
}

impl<W: Write + Send> ParquetRows<W> {
    /// Begins a file.
    ///
    /// # Errors
    /// If the head cannot be written.
    pub fn begin(to: W, head: &ParquetHead<'_>) -> Result<Self, ParquetError> {
        let column = |name: &str, physical| {
            Type::primitive_type_builder(name, physical).with_repetition(Repetition::REQUIRED).build().map(Arc::new)
        };
        let count = head.count.map(|name| column(name, Physical::INT64));
        let others = head.columns.iter().map(|name| column(name, Physical::DOUBLE));
        let text = |name: &&str| {
            let of = Type::primitive_type_builder(name, Physical::BYTE_ARRAY).with_repetition(Repetition::REQUIRED);
            of.with_logical_type(Some(LogicalType::String)).build().map(Arc::new)
        };
        let texts = head.texts.iter().map(text);
        let fields = count.into_iter().chain(texts).chain(others).collect::<Result<Vec<_>, _>>()?;
        let schema = Type::group_type_builder(head.row).with_fields(fields).build()?;
        // Numbers that hardly repeat do not compress with a dictionary.
        let properties = WriterProperties::builder()
            .set_dictionary_enabled(false)
            .set_created_by(format!("stillbase {}", env!("CARGO_PKG_VERSION")))
            .set_key_value_metadata(head.note.map(|[key, value]| vec![KeyValue::new(key.into(), value.to_owned())]))
            .build();
        let writer = SerializedFileWriter::new(to, Arc::new(schema), Arc::new(properties))?;
        let counts = head.count.map(|_| Vec::new());
        let texts = vec![Vec::new(); head.texts.len()];
        Ok(Self { writer, counts, texts, columns: vec![Vec::new(); head.columns.len()], waiting: 0 })
    }

    /// Adds a row; `count` is ignored if there is no column for it.
    ///
    /// # Errors
    /// If a row group cannot be written.
    pub fn row(&mut self, count: i64, values: impl IntoIterator<Item = f64>) -> Result<(), ParquetError> {
        self.named_row(count, &[], values)
    }

    /// Adds a row as [`row`](Self::row) does, with a cell for each column of text.
    ///
    /// # Errors
    /// If a row group cannot be written.
    pub fn named_row(
        &mut self,
        count: i64,
        texts: &[&str],
        values: impl IntoIterator<Item = f64>,
    ) -> Result<(), ParquetError> {
        self.texts.iter_mut().zip(texts).for_each(|(column, text)| column.push(ByteArray::from(*text)));
        if let Some(counts) = &mut self.counts {
            counts.push(count);
        }
        self.columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
        self.waiting += 1;
        if self.waiting < GROUP_ROWS { Ok(()) } else { self.write_group() }
    }

    fn write_group(&mut self) -> Result<(), ParquetError> {
        let mut group = self.writer.next_row_group()?;
        if let Some(counts) = &mut self.counts
            && let Some(mut column) = group.next_column()?
        {
            column.typed::<Int64Type>().write_batch(counts, None, None)?;
            column.close()?;
            counts.clear();
        }
        for texts in &mut self.texts {
            if let Some(mut column) = group.next_column()? {
                column.typed::<ByteArrayType>().write_batch(texts, None, None)?;
                column.close()?;
            }
            texts.clear();
        }
        for values in &mut self.columns {
            if let Some(mut column) = group.next_column()? {
                column.typed::<DoubleType>().write_batch(values, None, None)?;
                column.close()?;
            }
            values.clear();
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
