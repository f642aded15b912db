//! Files of samples, CSV or Parquet: one row a machine, and a head by which shards know each other.

use std::fmt;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::basic::{Repetition, Type as Physical};
use parquet::column::reader::get_typed_column_reader;
use parquet::data_type::{DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use stillbase::files::{NewFile, WriteError};

use crate::commands::failure::Failure;

/// Which study rows belong to. Its text heads the column of samples in a CSV file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Study {
    /// Machines of the whole study.
    pub samples: u64,
    /// Which random machines.
    pub seed: u64,
    /// A number of everything else: scenario, spreads, instants, mode.
    pub problem: u64,
}

impl fmt::Display for Study {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "sample of {} seed {} problem {:016x}", self.samples, self.seed, self.problem)
    }
}

impl Study {
    fn parse(text: &str) -> Option<Self> {
        let ["sample", "of", samples, "seed", seed, "problem", problem] = *text.split(' ').collect::<Vec<_>>() else {
            return None;
        };
        Some(Self {
            samples: samples.parse().ok()?,
            seed: seed.parse().ok()?,
            problem: u64::from_str_radix(problem, 16).ok()?,
        })
    }
}

/// What a file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Head {
    /// Of which study.
    pub study: Study,
    /// Names of the columns after the sample's, with units.
    pub columns: Vec<String>,
}

/// The kinds of file.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Csv,
    Parquet,
}

fn kind_of(file: &Path) -> Result<Kind, Failure> {
    match file.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("csv") => Ok(Kind::Csv),
        Some("parquet") => Ok(Kind::Parquet),
        _ => Err(Failure::wrong_input(format!("{}: want a name that ends in .csv or .parquet", file.display()))),
    }
}

/// Whether rows can be written under such a name.
///
/// # Errors
/// If its ending is another.
pub fn check_name(file: &Path) -> Result<(), Failure> {
    kind_of(file).map(|_| ())
}

/// Rows of a Parquet row group.
const GROUP: usize = 65_536;

/// The key under which a Parquet file names its study.
const STUDY_KEY: &str = "stillbase.study";

/// Writes rows.
pub enum Writer {
    /// One line a row.
    Csv(Box<csv::Writer<NewFile>>),
    /// Columns, a group of rows at a time.
    Parquet(Box<Groups>),
}

/// A Parquet file in the making.
pub struct Groups {
    writer: SerializedFileWriter<NewFile>,
    file: PathBuf,
    samples: Vec<i64>,
    columns: Vec<Vec<f64>>,
}

impl Writer {
    /// Begins a file.
    ///
    /// # Errors
    /// If it cannot be made.
    pub fn create(file: &Path, force: bool, head: &Head) -> Result<Self, Failure> {
        let kind = kind_of(file)?;
        let out = NewFile::create(file, force)?;
        match kind {
            Kind::Csv => {
                let mut writer = csv::Writer::from_writer(out);
                let names = [head.study.to_string()].into_iter().chain(head.columns.iter().cloned());
                writer.write_record(names).map_err(|e| csv_failure(file, e))?;
                Ok(Self::Csv(Box::new(writer)))
            }
            Kind::Parquet => Ok(Self::Parquet(Box::new(Groups::create(out, head)?))),
        }
    }

    /// One more row.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn row(&mut self, sample: u64, values: &[f64]) -> Result<(), Failure> {
        match self {
            Self::Csv(writer) => {
                let done = writer.serialize((sample, values));
                done.map_err(|e| csv_failure(writer.get_ref().path(), e))
            }
            Self::Parquet(groups) => groups.row(sample, values),
        }
    }

    /// Puts the file under its name.
    ///
    /// # Errors
    /// If not everything could be written.
    pub fn finish(self) -> Result<(), Failure> {
        match self {
            Self::Csv(writer) => {
                let file = writer.get_ref().path().to_owned();
                let out = writer.into_inner().map_err(|e| csv_failure(&file, e.into_error().into()))?;
                Ok(out.finish()?)
            }
            Self::Parquet(groups) => groups.finish(),
        }
    }
}

fn csv_failure(file: &Path, error: csv::Error) -> Failure {
    match error.into_kind() {
        csv::ErrorKind::Io(source) => WriteError::Failed { file: file.into(), source }.into(),
        other => Failure::wrong_input(format!("{}: {other:?}", file.display())),
    }
}

fn parquet_failure(file: &Path) -> impl Fn(ParquetError) -> Failure + use<> {
    let file = file.display().to_string();
    move |e| Failure::wrong_input(format!("{file}: {e}: want a Parquet file that can be read, or a place to write one"))
}

impl Groups {
    fn create(out: NewFile, head: &Head) -> Result<Self, Failure> {
        let file = out.path().to_owned();
        let failed = parquet_failure(&file);
        let column = |name: &str, physical| {
            Type::primitive_type_builder(name, physical).with_repetition(Repetition::REQUIRED).build().map(Arc::new)
        };
        let sample = std::iter::once(column("sample", Physical::INT64));
        let others = head.columns.iter().map(|name| column(name, Physical::DOUBLE));
        let fields = sample.chain(others).collect::<Result<Vec<_>, _>>().map_err(&failed)?;
        let schema = Type::group_type_builder("machine").with_fields(fields).build().map_err(&failed)?;
        // Random numbers gain nothing by a dictionary.
        let properties = WriterProperties::builder()
            .set_dictionary_enabled(false)
            .set_created_by(format!("stillbase {}", env!("CARGO_PKG_VERSION")))
            .set_key_value_metadata(Some(vec![KeyValue::new(STUDY_KEY.into(), head.study.to_string())]))
            .build();
        let writer = SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties)).map_err(&failed)?;
        Ok(Self { writer, file, samples: Vec::new(), columns: vec![Vec::new(); head.columns.len()] })
    }

    fn row(&mut self, sample: u64, values: &[f64]) -> Result<(), Failure> {
        self.samples.push(i64::try_from(sample).unwrap_or(i64::MAX));
        self.columns.iter_mut().zip(values).for_each(|(column, value)| column.push(*value));
        if self.samples.len() < GROUP {
            return Ok(());
        }
        self.write_group().map_err(parquet_failure(&self.file))
    }

    fn write_group(&mut self) -> Result<(), ParquetError> {
        let mut group = self.writer.next_row_group()?;
        if let Some(mut column) = group.next_column()? {
            column.typed::<Int64Type>().write_batch(&self.samples, None, None)?;
            column.close()?;
        }
        for values in &mut self.columns {
            if let Some(mut column) = group.next_column()? {
                column.typed::<DoubleType>().write_batch(values, None, None)?;
                column.close()?;
            }
            values.clear();
        }
        self.samples.clear();
        group.close().map(|_| ())
    }

    fn finish(mut self) -> Result<(), Failure> {
        let failed = parquet_failure(&self.file);
        if !self.samples.is_empty() {
            self.write_group().map_err(&failed)?;
        }
        let mut out = self.writer.into_inner().map_err(&failed)?;
        out.flush().map_err(|source| WriteError::Failed { file: self.file.clone(), source })?;
        Ok(out.finish()?)
    }
}

/// A file of rows, opened.
pub struct Part {
    /// Its name.
    pub file: PathBuf,
    /// What it holds.
    pub head: Head,
    reader: Reader,
}

enum Reader {
    Csv(Box<csv::Reader<File>>),
    Parquet(Box<SerializedFileReader<File>>),
}

impl Part {
    /// Opens a file and reads its head.
    ///
    /// # Errors
    /// If it is none that this program wrote.
    pub fn open(file: &Path) -> Result<Self, Failure> {
        let kind = kind_of(file)?;
        let foreign =
            || Failure::wrong_input(format!("{}: want a file that `stillbase tolerance -o` wrote", file.display()));
        let opened = File::open(file).map_err(|e| Failure::wrong_input(e).of(file.display()))?;
        let (study, columns, reader) = match kind {
            Kind::Csv => {
                let mut reader = csv::Reader::from_reader(opened);
                let names = reader.headers().map_err(|_| foreign())?;
                let study = names.get(0).and_then(Study::parse);
                let columns = names.iter().skip(1).map(str::to_owned).collect();
                (study, columns, Reader::Csv(Box::new(reader)))
            }
            Kind::Parquet => {
                let reader = SerializedFileReader::new(opened).map_err(parquet_failure(file))?;
                let about = reader.metadata().file_metadata();
                let entries = about.key_value_metadata().map_or(&[][..], Vec::as_slice);
                let text = entries.iter().find(|e| e.key == STUDY_KEY).and_then(|e| e.value.as_deref());
                let study = text.and_then(Study::parse);
                let fields = about.schema().get_fields();
                let is = |field: &Type, physical| {
                    let required = field.is_primitive() && !field.is_optional();
                    required && !field.is_schema() && field.get_physical_type() == physical
                };
                let ours = |(i, field): (usize, &Arc<Type>)| {
                    is(field, if i == 0 { Physical::INT64 } else { Physical::DOUBLE })
                };
                if fields.is_empty() || !fields.iter().enumerate().all(ours) {
                    return Err(foreign());
                }
                let columns = fields.iter().skip(1).map(|f| f.name().to_owned()).collect();
                (study, columns, Reader::Parquet(Box::new(reader)))
            }
        };
        let head = Head { study: study.ok_or_else(foreign)?, columns };
        Ok(Self { file: file.into(), head, reader })
    }

    /// Shows every row.
    ///
    /// # Errors
    /// If one cannot be read, or what `see` says.
    pub fn rows(self, mut see: impl FnMut(u64, &[f64]) -> Result<(), Failure>) -> Result<(), Failure> {
        let mut row = vec![0.0; self.head.columns.len()];
        match self.reader {
            Reader::Csv(mut reader) => {
                let mut record = csv::StringRecord::new();
                let broken = |line: u64| {
                    let at = format!("{}:{line}", self.file.display());
                    Failure::wrong_input(format!("{at}: want the number of a sample and {} numbers", row.len()))
                };
                let broken = &broken;
                let mut values = row.clone();
                loop {
                    let line = reader.position().line();
                    match reader.read_record(&mut record) {
                        Ok(true) => {}
                        Ok(false) => return Ok(()),
                        Err(_) => return Err(broken(line)),
                    }
                    let sample = record.get(0).and_then(|x| x.parse().ok()).ok_or_else(|| broken(line))?;
                    for (value, text) in values.iter_mut().zip(record.iter().skip(1)) {
                        *value = text.parse().map_err(|_| broken(line))?;
                    }
                    see(sample, &values)?;
                }
            }
            Reader::Parquet(reader) => {
                let failed = parquet_failure(&self.file);
                for group in 0..reader.num_row_groups() {
                    let group = reader.get_row_group(group).map_err(&failed)?;
                    let count = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
                    let (mut samples, mut columns) = (Vec::with_capacity(count), Vec::new());
                    let mut column = get_typed_column_reader::<Int64Type>(group.get_column_reader(0).map_err(&failed)?);
                    column.read_records(count, None, None, &mut samples).map_err(&failed)?;
                    for c in 0..row.len() {
                        let reader = group.get_column_reader(c + 1).map_err(&failed)?;
                        let mut values = Vec::with_capacity(count);
                        let mut column = get_typed_column_reader::<DoubleType>(reader);
                        column.read_records(count, None, None, &mut values).map_err(&failed)?;
                        columns.push(values);
                    }
                    for (i, sample) in samples.iter().enumerate() {
                        for (value, column) in row.iter_mut().zip(&columns) {
                            *value = column.get(i).copied().unwrap_or(f64::NAN);
                        }
                        see(u64::try_from(*sample).unwrap_or(u64::MAX), &row)?;
                    }
                }
                Ok(())
            }
        }
    }
}
