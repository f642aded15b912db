//! Files of samples, CSV or Parquet, with one row for each machine and a header that identifies the study.

use std::fmt;
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::basic::{Compression, Type as Physical};
use parquet::column::reader::get_typed_column_reader;
use parquet::data_type::{DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::RowGroupMetaData;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::Type;

use super::checksum::{self, CHECKSUM_BLANK, CHECKSUM_PREFIX, CheckedFile, ChecksumPlace};
use super::error::{ShardError, shard_error};
use super::hash::fnv_1a;
use crate::parquet_guard::guarded;
use crate::parquet_rows::{ColumnKind, GROUP_ROWS, ParquetCell, ParquetHead, ParquetRows};
use crate::row_file::RowForm;
use crate::{NewFile, WriteError};
use stillbase_session::scenario::{Scenario, Tolerance};
use stillbase_study::tolerance::SampleOutcome;

/// Identifier of a study. In a CSV file, its text is the header of the column of sample numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StudyId {
    /// Number of machines of the whole study.
    pub samples: u64,
    /// Seed of the random machines.
    pub seed: u64,
    /// Hash of all other inputs: scenario, spreads, instants, mode, and version of the program.
    pub problem: u64,
}

/// The name of the study, and room for a checksum.
impl fmt::Display for StudyId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{CHECKSUM_PREFIX}{CHECKSUM_BLANK}", self.name())
    }
}

impl StudyId {
    /// Makes the identifier from everything on which a machine's row depends: scenario, tolerances, samples, seed,
    /// instants, mode, and version of the program. `simulated` is the mode: whether the machines are simulated.
    pub fn of(
        scenario: &Scenario,
        tolerance: &Tolerance,
        [samples, seed]: [u64; 2],
        instants: u32,
        simulated: bool,
    ) -> Self {
        let bare = Scenario { tolerance: Tolerance::default(), edits: Vec::new(), ..scenario.clone() };
        let spreads: Vec<String> = tolerance.spreads.iter().map(|(key, spread)| format!("{key}={spread}")).collect();
        let parts = [
            env!("CARGO_PKG_VERSION").to_owned(),
            bare.to_toml(),
            spreads.join("\n"),
            format!("{instants} {simulated}"),
        ];
        let problem = fnv_1a(parts.join("\n").as_bytes());
        Self { samples, seed, problem }
    }

    /// Returns the name of the study.
    pub fn name(&self) -> String {
        let Self { samples, seed, problem } = self;
        format!("sample of {samples} seed {seed} problem {problem:016x}")
    }

    fn parse(text: &str) -> Option<Self> {
        Self::of_name(text.rsplit_once(CHECKSUM_PREFIX)?.0)
    }

    /// Returns the study of a name.
    pub(super) fn of_name(name: &str) -> Option<Self> {
        let ["sample", "of", samples, "seed", seed, "problem", problem] = *name.splitn(8, ' ').collect::<Vec<_>>()
        else {
            return None;
        };
        Some(Self {
            samples: samples.parse().ok()?,
            seed: seed.parse().ok()?,
            problem: u64::from_str_radix(problem, 16).ok()?,
        })
    }
}

/// Header of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct ShardHeader {
    /// The study to which the file belongs.
    pub study: StudyId,
    /// Names of all columns except that of the sample numbers, with units.
    pub columns: Vec<String>,
}

impl ShardHeader {
    /// Makes the header for machines in which the numbers named in `numbers`, with units, vary.
    pub fn new(study: StudyId, numbers: impl IntoIterator<Item = String>) -> Self {
        Self { study, columns: numbers.into_iter().chain(OUTCOME_COLUMNS.map(str::to_owned)).collect() }
    }
}

/// Returns the outcome of a machine from the last numbers of its row.
pub fn outcome_of(row: &[f64]) -> SampleOutcome {
    SampleOutcome::of_numbers(row.last_chunk().copied().unwrap_or([f64::NAN; OUTCOME_COUNT]))
}

/// Number of columns of the outcome of a machine.
pub const OUTCOME_COUNT: usize = SampleOutcome::NUMBERS;

/// Names of the last columns, which hold the outcome of each machine.
pub const OUTCOME_COLUMNS: [&str; OUTCOME_COUNT] = ["peak moment N m", "peak force N", "rms moment N m", "rms force N"];

/// Returns whether the first or the last bytes of a file identify the study and contain the checksum.
fn checksum_place(form: RowForm) -> ChecksumPlace {
    if form == RowForm::Csv { ChecksumPlace::Head } else { ChecksumPlace::Tail }
}

fn form_of(file: &Path) -> Result<RowForm, ShardError> {
    RowForm::of(file).map_err(|why| ShardError::Wrong(why.to_string()))
}

/// Maximum number of columns of a file: far more than any machine has parameters.
const MAX_COLUMNS: usize = 1000;

/// Maximum length of a line of a CSV file, bytes.
const MAX_LINE_BYTES: u64 = 1 << 18;

/// Maximum size of the footer of a Parquet file, bytes: enough for the maximum number of machines.
const MAX_CONTENTS_BYTES: u64 = 1 << 27;

/// The metadata key under which a Parquet file identifies its study.
pub(super) const STUDY_KEY: &str = "stillbase.study";

/// Writes rows.
pub enum Writer {
    /// Writes one line for each row.
    Csv(Box<csv::Writer<CheckedFile>>),
    /// Writes columns, one row group at a time.
    Parquet(Box<Groups>),
}

/// A Parquet file that is being written.
pub struct Groups {
    rows: ParquetRows<CheckedFile>,
    file: PathBuf,
}

impl Writer {
    /// Creates a file of a format, or standard output (`-`), with its header.
    ///
    /// # Errors
    /// If it cannot be created.
    pub fn create((file, form): (&Path, RowForm), force: bool, head: &ShardHeader) -> Result<Self, ShardError> {
        let out = CheckedFile::new(NewFile::create(file, force)?);
        match form {
            RowForm::Csv => {
                let mut writer = csv::Writer::from_writer(out);
                let names = [head.study.to_string()].into_iter().chain(head.columns.iter().cloned());
                writer.write_record(names).map_err(|e| csv_failure(file, e))?;
                Ok(Self::Csv(Box::new(writer)))
            }
            RowForm::Parquet => Ok(Self::Parquet(Box::new(Groups::create(out, head)?))),
        }
    }

    /// Writes a machine: the numbers that vary, and its outcome.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn machine(&mut self, sample: u64, numbers: &[f64], outcome: &SampleOutcome) -> Result<(), ShardError> {
        self.row(sample, &[numbers, &outcome.numbers()].concat())
    }

    /// Writes a row.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn row(&mut self, sample: u64, values: &[f64]) -> Result<(), ShardError> {
        match self {
            Self::Csv(writer) => {
                let done = writer.serialize((sample, values));
                done.map_err(|e| csv_failure(writer.get_ref().path(), e))
            }
            Self::Parquet(groups) => groups.row(sample, values),
        }
    }

    /// Gives the file its final name.
    ///
    /// # Errors
    /// If not everything could be written.
    pub fn finish(self) -> Result<(), ShardError> {
        match self {
            Self::Csv(writer) => {
                let file = writer.get_ref().path().to_owned();
                let out = writer.into_inner().map_err(|e| csv_failure(&file, e.into_error().into()))?;
                Ok(out.finish(ChecksumPlace::Head)?)
            }
            Self::Parquet(groups) => groups.finish(),
        }
    }
}

fn csv_failure(file: &Path, error: csv::Error) -> ShardError {
    match error.into_kind() {
        csv::ErrorKind::Io(source) => WriteError::Failed { file: file.into(), source }.into(),
        other => shard_error(file, format!("{other:?}")),
    }
}

pub(super) fn parquet_failure(file: &Path) -> impl Fn(ParquetError) -> ShardError + use<> {
    let file = file.to_owned();
    move |e| shard_error(&file, format!("{e}: want a Parquet file that can be read, or a place to write one"))
}

impl Groups {
    fn create(out: CheckedFile, head: &ShardHeader) -> Result<Self, ShardError> {
        let file = out.path().to_owned();
        let study = head.study.to_string();
        let note = Some([STUDY_KEY, &study]);
        let numbers = head.columns.iter().map(|name| (ColumnKind::Number, name.as_str()));
        let columns = [(ColumnKind::Count, "sample")].into_iter().chain(numbers).collect();
        let named = ParquetHead { row: "machine", columns, note, is_compressed: false };
        let rows = ParquetRows::begin(out, &named).map_err(parquet_failure(&file))?;
        Ok(Self { rows, file })
    }

    fn row(&mut self, sample: u64, values: &[f64]) -> Result<(), ShardError> {
        let sample = i64::try_from(sample).unwrap_or(i64::MAX);
        let numbers = values.iter().map(|x| ParquetCell::Number(*x));
        let done = self.rows.row([ParquetCell::Count(sample)].into_iter().chain(numbers));
        done.map_err(parquet_failure(&self.file))
    }

    fn finish(self) -> Result<(), ShardError> {
        let Self { rows, file } = self;
        let mut out = rows.finish().map_err(parquet_failure(&file))?;
        out.flush().map_err(|source| WriteError::Failed { file, source })?;
        Ok(out.finish(ChecksumPlace::Tail)?)
    }
}

/// An opened file of rows.
pub struct StudyPart {
    /// Path of the file.
    pub file: PathBuf,
    /// Its header.
    pub head: ShardHeader,
    reader: Reader,
}

enum Reader {
    Csv(BufReader<File>),
    Parquet(Box<SerializedFileReader<File>>),
}

impl StudyPart {
    /// Opens a file, verifies its checksum, and reads its header.
    ///
    /// # Errors
    /// If the file cannot be read, this program did not write it, or it has changed since.
    pub fn open(file: &Path) -> Result<Self, ShardError> {
        let (form, mut opened) = plain_file(file)?;
        let unreadable = |e| shard_error(file, e);
        match checksum::verify(&mut opened, checksum_place(form)).map_err(unreadable)? {
            Some(true) => Self::load(file),
            Some(false) => {
                let why = "its checksum does not fit its bytes, so it was changed or damaged: want it written again";
                Err(shard_error(file, why))
            }
            None => Err(foreign(file)),
        }
    }

    /// Returns the number of its first sample; `None` if it has no rows.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn first_sample(&self) -> Result<Option<u64>, ShardError> {
        let mut first = None;
        Self::load(&self.file)?.rows(|sample, _| {
            first = Some(sample);
            Ok(ControlFlow::Break(()))
        })?;
        Ok(first)
    }

    /// Reads the header.
    fn load(file: &Path) -> Result<Self, ShardError> {
        let (form, opened) = plain_file(file)?;
        let (study, columns, reader) = match form {
            RowForm::Csv => {
                let mut reader = BufReader::new(opened);
                let line = line(&mut reader).filter(|line| !line.is_empty()).ok_or_else(|| foreign(file))?;
                let mut head = csv::ReaderBuilder::new().has_headers(false).from_reader(&line[..]);
                let names = head.records().next().and_then(Result::ok).ok_or_else(|| foreign(file))?;
                let study = names.get(0).and_then(StudyId::parse);
                (study, names.iter().skip(1).map(str::to_owned).collect::<Vec<_>>(), Reader::Csv(reader))
            }
            RowForm::Parquet => {
                let reader = parquet_reader(file, opened)?;
                let about = reader.metadata().file_metadata();
                let entries = about.key_value_metadata().map_or(&[][..], Vec::as_slice);
                let text = entries.iter().find(|e| e.key == STUDY_KEY).and_then(|e| e.value.as_deref());
                let study = text.and_then(StudyId::parse);
                let fields = about.schema().get_fields();
                let is = |field: &Type, physical| {
                    let required = field.is_primitive() && !field.is_optional();
                    required && !field.is_schema() && field.get_physical_type() == physical
                };
                let ours = |(i, field): (usize, &Arc<Type>)| {
                    is(field, if i == 0 { Physical::INT64 } else { Physical::DOUBLE })
                };
                if fields.is_empty() || !fields.iter().enumerate().all(ours) {
                    return Err(foreign(file));
                }
                let columns = fields.iter().skip(1).map(|f| f.name().to_owned()).collect();
                (study, columns, Reader::Parquet(Box::new(reader)))
            }
        };
        if columns.len() > MAX_COLUMNS || !columns.ends_with(&OUTCOME_COLUMNS.map(str::to_owned)) {
            return Err(foreign(file));
        }
        let head = ShardHeader { study: study.ok_or_else(|| foreign(file))?, columns };
        Ok(Self { file: file.into(), head, reader })
    }

    /// Calls `see` with the sample number and the other numbers of each row, all finite, until `see` returns a break.
    ///
    /// # Errors
    /// If a row cannot be read or is not plausible, or if `see` fails.
    pub fn rows(
        self,
        mut see: impl FnMut(u64, &[f64]) -> Result<ControlFlow<()>, ShardError>,
    ) -> Result<(), ShardError> {
        let Self { file, head: ShardHeader { study, columns: names }, reader } = self;
        let mut see = |sample: u64, row: &[f64]| {
            plausible(&study, &names, sample, row).map_err(|why| shard_error(&file, why))?;
            see(sample, row)
        };
        let mut row = vec![0.0; names.len()];
        match reader {
            Reader::Csv(mut reader) => {
                for number in 2_u64.. {
                    let broken = || {
                        let want = format!("want the number of a sample and {} numbers", names.len());
                        ShardError::Wrong(format!("{}:{number}: {want}", file.display()))
                    };
                    let line = line(&mut reader).ok_or_else(broken)?;
                    if line.is_empty() {
                        break;
                    }
                    let text = std::str::from_utf8(&line).map_err(|_| broken())?;
                    let mut cells = text.trim_end_matches(['\r', '\n']).split(',');
                    let sample = cells.next().and_then(|x| x.parse().ok()).ok_or_else(broken)?;
                    for value in &mut row {
                        *value = cells.next().and_then(|x| x.parse().ok()).ok_or_else(broken)?;
                    }
                    if cells.next().is_some() {
                        return Err(broken());
                    }
                    if see(sample, &row)?.is_break() {
                        break;
                    }
                }
                Ok(())
            }
            Reader::Parquet(reader) => {
                for group in 0..reader.num_row_groups() {
                    let (samples, columns) = guarded(|| group_of(&file, &reader, group, row.len()), || foreign(&file))?;
                    for (i, sample) in samples.iter().enumerate() {
                        row.iter_mut().zip(&columns).for_each(|(value, column)| *value = column[i]);
                        if see(u64::try_from(*sample).unwrap_or(u64::MAX), &row)?.is_break() {
                            return Ok(());
                        }
                    }
                }
                Ok(())
            }
        }
    }
}

/// Returns how two studies differ, in words; `None` if they do not.
pub(super) fn difference(one: &StudyId, two: &StudyId) -> Option<String> {
    if one.samples != two.samples {
        return Some(format!("of {} and of {} samples", one.samples, two.samples));
    }
    if one.seed != two.seed {
        return Some(format!("seeds {} and {}", one.seed, two.seed));
    }
    let why = "the scenario, a spread, the instants, the mode or the program's version differ";
    (one.problem != two.problem).then(|| why.into())
}

fn foreign(file: &Path) -> ShardError {
    let why = "want a file that this version's `stillbase tolerance -o` wrote";
    shard_error(file, why)
}

/// Opens a plain file.
pub(super) fn plain_file(file: &Path) -> Result<(RowForm, File), ShardError> {
    let form = form_of(file)?;
    let unreadable = |e| shard_error(file, format!("{e}: want a plain file that can be read"));
    // Opening a pipe would block until its other end is opened.
    let there = std::fs::metadata(file).and_then(|there| crate::text::check(&there, u64::MAX));
    there.map_err(unreadable)?;
    Ok((form, File::open(file).map_err(unreadable)?))
}

/// Returns the next line with its line ending, empty after the last line; `None` if it cannot be read or is too long.
fn line(reader: &mut BufReader<File>) -> Option<Vec<u8>> {
    let mut line = Vec::new();
    reader.by_ref().take(MAX_LINE_BYTES).read_until(b'\n', &mut line).ok()?;
    ((line.len() as u64) < MAX_LINE_BYTES).then_some(line)
}

/// Opens a Parquet file of any program.
pub(super) fn opened_parquet(file: &Path) -> Result<SerializedFileReader<File>, ShardError> {
    let (_, opened) = plain_file(file)?;
    let damaged = || shard_error(file, "damaged: want a whole Parquet file");
    guarded(|| SerializedFileReader::new(opened).map_err(parquet_failure(file)), damaged)
}

/// Opens a Parquet file, and checks that its footer and its row groups are plausible.
fn parquet_reader(file: &Path, mut opened: File) -> Result<SerializedFileReader<File>, ShardError> {
    let mut contents = || {
        let length = opened.metadata().ok()?.len();
        opened.seek(SeekFrom::End(-8)).ok()?;
        let mut last = [0; 8];
        opened.read_exact(&mut last).ok()?;
        let [a, b, c, d, magic @ ..] = last;
        let contents = u64::from(u32::from_le_bytes([a, b, c, d]));
        (magic == *b"PAR1" && contents <= MAX_CONTENTS_BYTES && contents + 12 <= length).then_some(length)
    };
    let length = contents().ok_or_else(|| foreign(file))?;
    let reader = guarded(|| SerializedFileReader::new(opened).map_err(parquet_failure(file)), || foreign(file))?;
    let contents = reader.metadata();
    let columns = contents.file_metadata().schema().get_fields().len();
    let within = |group: &RowGroupMetaData| {
        let columns_match = group.columns().len() == columns;
        let plain = group.columns().iter().all(|column| {
            let (from, size) = (column.data_page_offset(), column.compressed_size());
            let inside = from >= 4 && size >= 0 && from.checked_add(size).is_some_and(|end| end as u64 <= length);
            let whole = column.num_values() == group.num_rows() && size >= group.num_rows().saturating_mul(8);
            inside
                && whole
                && column.dictionary_page_offset().is_none()
                && column.compression() == Compression::UNCOMPRESSED
        });
        columns_match && plain && rows_of(group).is_some()
    };
    if contents.row_groups().iter().all(within) { Ok(reader) } else { Err(foreign(file)) }
}

/// Reads the columns of a row group: the sample numbers, and all others.
fn group_of(
    file: &Path,
    reader: &SerializedFileReader<File>,
    group: usize,
    width: usize,
) -> Result<(Vec<i64>, Vec<Vec<f64>>), ShardError> {
    let failed = parquet_failure(file);
    let group = reader.get_row_group(group).map_err(&failed)?;
    let count = rows_of(group.metadata()).ok_or_else(|| foreign(file))?;
    let mut samples = Vec::with_capacity(count);
    let mut column = get_typed_column_reader::<Int64Type>(group.get_column_reader(0).map_err(&failed)?);
    column.read_records(count, None, None, &mut samples).map_err(&failed)?;
    let mut columns = Vec::with_capacity(width);
    for c in 0..width {
        let mut values = Vec::with_capacity(count);
        let mut column = get_typed_column_reader::<DoubleType>(group.get_column_reader(c + 1).map_err(&failed)?);
        column.read_records(count, None, None, &mut values).map_err(&failed)?;
        columns.push(values);
    }
    let whole = samples.len() == count && columns.iter().all(|column| column.len() == count);
    if whole { Ok((samples, columns)) } else { Err(foreign(file)) }
}

/// Returns the number of rows of a row group; `None` if this program could not have written the group.
fn rows_of(group: &RowGroupMetaData) -> Option<usize> {
    usize::try_from(group.num_rows()).ok().filter(|rows| (1..=GROUP_ROWS).contains(rows))
}

/// Checks that a row is possible for a machine of the study.
fn plausible(study: &StudyId, names: &[String], sample: u64, row: &[f64]) -> Result<(), String> {
    if sample >= study.samples {
        return Err(format!("sample {sample}: want sample numbers below {}", study.samples));
    }
    let first_outcome = row.len().saturating_sub(OUTCOME_COUNT);
    let wrong = |(i, x): (usize, &f64)| !x.is_finite() || (i >= first_outcome && *x < 0.0);
    match row.iter().enumerate().position(wrong) {
        None => Ok(()),
        Some(i) => {
            let want = if i >= first_outcome { "a finite number, 0 or more" } else { "a finite number" };
            Err(format!("sample {sample}: {} is {}: want {want}", names[i], row[i]))
        }
    }
}
