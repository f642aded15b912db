//! Summaries of studies in Parquet files: tables that any engine adds up with one GROUP BY.
//!
//! | column | content |
//! |---|---|
//! | `study` | the study: number of machines, seed, and a hash of all else that they depend on |
//! | `outcome` | a number of an outcome, or that with `_sums`; or `machines`, or a limit |
//! | `bin` | upper 22 bits of the number as IEEE 754 stores it, with `_sums` the upper 12; of `machines` the first, else 0 |
//! | `count` | number of machines |
//! | `least`, `least_machine` | of sums the least number, and the first machine that has it; of a limit the limit; else 0 |
//! | `greatest`, `greatest_machine` | the same for the greatest |
//! | `sum_0` to `sum_2` | of sums Σ r, r the 52 bits of the mantissa, as digits to the base 2³¹, the lowest first; else 0 |
//! | `low_0`, `low_1` | of sums Σ l, l the lowest 10 bits of r |
//! | `square_0` to `square_3` | of sums Σ u², u the upper 42 bits of r |
//! | `control` | of all but bins a weighted sum of all that is counted, modulo a prime ([`ControlSum`]); of bins 0 |
//!
//! Rows of the same study, outcome and bin add up: `count`, `control` and all digits by SUM, `least` by MIN, `greatest` by
//! MAX, with their machines. Digits may then exceed 2³¹; up to four million parts they are whole even as floating point
//! numbers.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use parquet::file::reader::FileReader;

use super::checksum::{self, CheckedFile, ChecksumPlace};
use super::control_sum::ControlSum;
use super::error::{ShardError, shard_error};
use super::rows::{STUDY_KEY, StudyId, difference, opened_parquet, parquet_failure, plain_file};
use crate::parquet_rows::{ColumnKind, ParquetCell, ParquetHead, ParquetRows};
use crate::row_file::RowForm;
use crate::table::columns::{ColumnTable, ColumnValues};
use crate::table::parquet_columns;
use crate::{NewFile, WriteError};
use stillbase_session::scenario::MAX_SAMPLES;
use stillbase_settings::range::quote_clipped;
use stillbase_study::tolerance::{Extreme, Limits, OCTAVE_BINS, OCTAVES, Octave, SampleOutcome, Summary, Unmergeable};

const WORDS: [&str; 2] = ["study", "outcome"];

/// Names of the columns of numbers: the bin, its count and its extremes.
const PLACES: [&str; 6] = ["bin", "count", "least", "least_machine", "greatest", "greatest_machine"];

/// Names of the columns of digits of sums, and of the sum that controls them.
const DIGITS: [&str; 10] =
    ["sum_0", "sum_1", "sum_2", "low_0", "low_1", "square_0", "square_1", "square_2", "square_3", "control"];

/// Number of bits of a digit.
const DIGIT_BITS: usize = 31;

/// What the outcome of rows of sums has after the name of its number.
const SUMS: &str = "_sums";

/// The outcome of rows that say which machines a summary has.
const MACHINES: &str = "machines";

/// The outcomes of rows that count machines within limits: of the moment, of the force, both.
const LIMITS: [&str; 3] = ["within_moment_limit", "within_force_limit", "within_both_limits"];

/// Returns whether a file is a table of this kind, by its columns.
///
/// # Errors
/// If it cannot be read.
pub fn is_summary(file: &Path) -> Result<bool, ShardError> {
    if plain_file(file)?.0 != RowForm::Parquet {
        return Ok(false);
    }
    let reader = opened_parquet(file)?;
    let schema = reader.metadata().file_metadata().schema_descr();
    Ok(schema.columns().iter().any(|column| column.name() == "bin"))
}

/// A row of the table; that of a bin has only a count.
struct Row<'a> {
    outcome: &'a str,
    at: u64,
    octave: Octave,
    control: u64,
}

const NOTHING: Extreme = Extreme { value: 0.0, machine: 0 };

/// Gives `see` the rows of a summary, in the order of the table, until it returns an error.
fn rows<E>(summary: &Summary, mut see: impl FnMut(Row<'_>) -> Result<(), E>) -> Result<(), E> {
    let counted = |count: u64| Octave { count, least: NOTHING, greatest: NOTHING, ..Octave::EMPTY };
    let machine = |i: u64| Extreme { value: i as f64, machine: i };
    for held in summary.machines() {
        let [least, greatest] = [held.start, held.end.saturating_sub(1)].map(machine);
        let octave = Octave { least, greatest, ..counted(held.end - held.start) };
        let control = ControlSum::of_machines(held.start, octave.count).total();
        see(Row { outcome: MACHINES, at: held.start, octave, control })?;
    }
    let limits = limits(summary.limits());
    for (i, count) in summary.kept().into_iter().enumerate() {
        let Some(limit) = limits[i].map(|value| Extreme { value, machine: 0 }) else { continue };
        let octave = Octave { least: limit, greatest: limit, ..counted(count) };
        see(Row { outcome: LIMITS[i], at: 0, octave, control: ControlSum::of_limit(i, limit.value, count).total() })?;
    }
    for (number, outcome) in SampleOutcome::NAMES.into_iter().enumerate() {
        let sums = format!("{outcome}{SUMS}");
        for (at, octave, bins) in summary.octaves_with_bins(number) {
            let control = ControlSum::of_octave(number, at, octave, bins).total();
            see(Row { outcome: &sums, at, octave: *octave, control })?;
        }
        for (at, count) in summary.bins(number) {
            see(Row { outcome, at, octave: counted(count), control: 0 })?;
        }
    }
    Ok(())
}

/// Returns the limits of the three outcomes of limits; that of both is 0.
fn limits(limits: Limits) -> [Option<f64>; 3] {
    [limits.moment, limits.force, limits.moment.and(limits.force).map(|_| 0.0)]
}

/// Returns the digits of a number, the lowest first.
fn digits<const N: usize>(number: u128) -> [u64; N] {
    std::array::from_fn(|i| (number >> (DIGIT_BITS * i)) as u64 & ((1 << DIGIT_BITS) - 1))
}

fn count<'c>(x: u64) -> ParquetCell<'c> {
    ParquetCell::Count(x as i64)
}

/// Writes a summary.
///
/// # Errors
/// If it cannot be written, or if the name does not end in `.parquet`.
pub fn write_summary(file: &Path, force: bool, study: &StudyId, summary: &Summary) -> Result<(), ShardError> {
    if RowForm::of(file).ok() != Some(RowForm::Parquet) {
        return Err(shard_error(file, "a summary is a Parquet file: want a name that ends in .parquet"));
    }
    let out = CheckedFile::new(NewFile::create(file, force)?);
    let failed = parquet_failure(file);
    let note = study.to_string();
    let kind = |name: &str| if ["least", "greatest"].contains(&name) { ColumnKind::Number } else { ColumnKind::Count };
    let texts = WORDS.iter().map(|name| (ColumnKind::Text, *name));
    let columns = texts.chain(PLACES.iter().chain(&DIGITS).map(|name| (kind(name), *name))).collect();
    // Names repeat, and numbers of neighbouring rows are alike.
    let head = ParquetHead { row: "bin", columns, note: Some([STUDY_KEY, &note]), is_compressed: true };
    let mut table = ParquetRows::begin(out, &head).map_err(&failed)?;
    let name = study.name();
    rows(summary, |Row { outcome, at, octave, control }| {
        let Octave { count: machines, least, greatest, sum, low, squares } = octave;
        let words = [&*name, outcome].map(ParquetCell::Text);
        let extremes = [least, greatest].map(|of| [ParquetCell::Number(of.value), count(of.machine)]);
        let places = [count(at), count(machines)].into_iter().chain(extremes.into_iter().flatten());
        let sums = digits::<3>(sum).into_iter().chain(digits::<2>(low)).chain(digits::<4>(squares)).chain([control]);
        table.row(words.into_iter().chain(places).chain(sums.map(count)))
    })
    .map_err(&failed)?;
    let mut out = table.finish().map_err(&failed)?;
    std::io::Write::flush(&mut out).map_err(|source| WriteError::Failed { file: file.into(), source })?;
    Ok(out.finish(ChecksumPlace::Tail)?)
}

/// Reads a summary: one that this program wrote, or a table of the same columns of another program. Rows of the same bin
/// are added up.
///
/// # Errors
/// If it cannot be read, was changed or damaged, or holds what no machines bring about.
pub fn read_summary(file: &Path) -> Result<(StudyId, Summary), ShardError> {
    let wrong = |why: String| shard_error(file, why);
    let (_, mut opened) = plain_file(file)?;
    // Other programs may keep the note with the checksum, but not the bytes.
    let is_own =
        opened_parquet(file)?.metadata().file_metadata().created_by().is_some_and(|by| by.starts_with("stillbase"));
    let checked = checksum::verify(&mut opened, ChecksumPlace::Tail).map_err(|e| wrong(e.to_string()))?;
    if is_own && checked == Some(false) {
        let why = "its checksum does not fit its bytes, so it was changed or damaged: want it written again";
        return Err(wrong(why.into()));
    }
    let name = file.display().to_string();
    let table = parquet_columns(opened, &name).map_err(|e| ShardError::Wrong(e.to_string()))?;
    let [studies, outcomes] = texts(&table).map_err(wrong)?;
    let (places, sums) = (numbers(&table, PLACES).map_err(wrong)?, numbers(&table, DIGITS).map_err(wrong)?);
    let first = studies.first().ok_or_else(|| wrong("no row: want a summary".into()))?;
    if let Some(other) = studies.iter().find(|other| *other != first) {
        return Err(wrong(format!("rows of {} and of {}: want one study", quote_clipped(first), quote_clipped(other))));
    }
    let possible = |study: &StudyId| (1..=MAX_SAMPLES).contains(&study.samples);
    let study = StudyId::of_name(first).filter(possible).ok_or_else(|| {
        wrong(format!("column study: {}: want what `stillbase tolerance --summary` wrote there", quote_clipped(first)))
    })?;
    let mut found = Found::default();
    for (i, outcome) in outcomes.iter().enumerate() {
        let at_row = |why: String| wrong(format!("row {}, {}: {why}", i + 1, quote_clipped(outcome)));
        let row = FoundRow { places: places.map(|column| column[i]), digits: sums.map(|column| column[i]) };
        found.add(&study, outcome, &row).map_err(at_row)?;
    }
    Ok((study, found.summary(&study).map_err(wrong)?))
}

fn texts(table: &ColumnTable) -> Result<[&[String]; 2], String> {
    let of = |name: &str| match column(table, name)? {
        ColumnValues::Texts(texts) => Ok(texts.as_slice()),
        _ => Err(format!("column {name}: want text")),
    };
    Ok([of(WORDS[0])?, of(WORDS[1])?])
}

fn numbers<'a, const N: usize>(table: &'a ColumnTable, names: [&str; N]) -> Result<[&'a [f64]; N], String> {
    let mut all = [&[][..]; N];
    for (to, name) in all.iter_mut().zip(names) {
        *to = match column(table, name)? {
            ColumnValues::Numbers(values) => values,
            ColumnValues::Texts(_) => return Err(format!("column {name}: text: want numbers")),
            ColumnValues::Other(what) => return Err(format!("column {name}: {what}: want whole numbers of 64 bits")),
        };
    }
    Ok(all)
}

fn column<'a>(table: &'a ColumnTable, name: &str) -> Result<&'a ColumnValues, String> {
    let at = table.heads.iter().position(|head| head == name);
    let at = at.ok_or_else(|| {
        format!("no column {name}: want all columns of `stillbase tolerance --summary`, written by this version")
    })?;
    Ok(&table.columns[at])
}

/// The numbers of a row of a file.
struct FoundRow {
    places: [f64; PLACES.len()],
    digits: [f64; DIGITS.len()],
}

/// Largest whole number that floating point numbers hold with all before it.
const MAX_WHOLE: f64 = (1_u64 << 53) as f64;

/// Returns a whole number, which is at most `most`.
fn whole(name: &str, x: f64, most: u64) -> Result<u64, String> {
    match x {
        x if x >= 0.0 && x <= MAX_WHOLE.min(most as f64) && x.fract() == 0.0 => Ok(x as u64),
        x => Err(format!("{name} is {x}: want a whole number from 0 to {most}")),
    }
}

impl FoundRow {
    /// Returns the place of the row, and its count and extremes. Machines are those of a study.
    fn place(&self, samples: u64) -> Result<(u64, Octave), String> {
        let place = |i: usize, most: u64| whole(PLACES[i], self.places[i], most);
        let last = samples.saturating_sub(1);
        let extreme = |i: usize| Ok::<_, String>(Extreme { value: self.places[i], machine: place(i + 1, last)? });
        let (at, count) = (place(0, last.max(OCTAVES * OCTAVE_BINS - 1))?, place(1, samples)?);
        Ok((at, Octave { count, least: extreme(2)?, greatest: extreme(4)?, ..Octave::EMPTY }))
    }

    /// Returns an octave with the sums of the row.
    fn with_sums(&self, octave: Octave) -> Result<Octave, String> {
        let mut totals = [0_u128; 3];
        for (total, places) in totals.iter_mut().zip([0..3, 3..5, 5..9]) {
            for (digit, place) in places.enumerate() {
                let x = u128::from(whole(DIGITS[place], self.digits[place], MAX_WHOLE as u64)?);
                let sum = x.checked_mul(1 << (DIGIT_BITS * digit)).and_then(|x| total.checked_add(x));
                *total = sum.ok_or_else(|| format!("{}: too large", DIGITS[place]))?;
            }
        }
        let [sum, low, squares] = totals;
        Ok(Octave { sum, low, squares, ..octave })
    }

    fn control(&self) -> Result<ControlSum, String> {
        whole(DIGITS[9], self.digits[9], MAX_WHOLE as u64).map(ControlSum::of_column)
    }
}

/// What the rows read so far hold.
#[derive(Default)]
struct Found {
    machines: Vec<Range<u64>>,
    limits: [Option<f64>; 3],
    kept: [u64; 3],
    kept_controls: [ControlSum; 3],
    bins: Vec<(usize, u64, u64)>,
    octaves: BTreeMap<(usize, u64), (Octave, ControlSum)>,
}

/// Returns the place of a number of an outcome by its name.
fn place_of(name: &str) -> Option<usize> {
    SampleOutcome::NAMES.iter().position(|own| *own == name)
}

impl Found {
    fn add(&mut self, study: &StudyId, outcome: &str, row: &FoundRow) -> Result<(), String> {
        let (at, octave) = row.place(study.samples)?;
        let Octave { count, least, greatest, .. } = octave;
        if outcome == MACHINES {
            let (from, to) = (least.machine, greatest.machine + 1);
            if to <= from || at != from {
                return Err(format!("machines {from} to {}: want the first before the last", greatest.machine));
            }
            // A table that was added up from the same part twice counts its machines twice.
            if count != to - from {
                let why = "they are counted twice, or not all: want every part once";
                return Err(format!("{count} machines from {from} to {}: {why}", to - 1));
            }
            if row.control()? != ControlSum::of_machines(from, count) {
                return Err(changed("they"));
            }
            self.machines.push(from..to);
        } else if let Some(i) = LIMITS.iter().position(|name| *name == outcome) {
            let limit = least.value;
            if limit != greatest.value || self.limits[i].is_some_and(|own| own != limit) {
                let own = self.limits[i].unwrap_or(limit);
                return Err(format!("limits {own} and {}: want parts with the same limit", greatest.value));
            }
            if i < 2 && !(limit.is_finite() && limit > 0.0) {
                return Err(format!("the limit is {limit}: want a number above 0"));
            }
            self.limits[i] = Some(limit);
            self.kept[i] = self.kept[i].saturating_add(count);
            self.kept_controls[i].add(row.control()?);
        } else if let Some(number) = outcome.strip_suffix(SUMS).and_then(place_of) {
            if at >= OCTAVES {
                return Err(format!("bin is {at}: want at most {}", OCTAVES - 1));
            }
            let (own, control) =
                self.octaves.entry((number, at)).or_insert_with(|| (Octave::EMPTY, ControlSum::default()));
            own.merge(&row.with_sums(octave)?);
            control.add(row.control()?);
        } else if let Some(number) = place_of(outcome) {
            if at >= OCTAVES * OCTAVE_BINS {
                return Err(format!("bin is {at}: want at most {}", OCTAVES * OCTAVE_BINS - 1));
            }
            self.bins.push((number, at, count));
        } else {
            let (limits, names) = (LIMITS.join(", "), SampleOutcome::NAMES.join(", "));
            return Err(format!(
                "no such outcome: want {MACHINES}, {limits}, {names}, or one of the last four with {SUMS}"
            ));
        }
        Ok(())
    }

    fn summary(self, study: &StudyId) -> Result<Summary, String> {
        let [moment, force, both] = self.limits;
        if both.is_some() != (moment.is_some() && force.is_some()) {
            return Err("rows of limits are missing: want all rows".into());
        }
        let mut summary = Summary::new(Limits { moment, force });
        for machines in self.machines {
            if let Some(twice) = summary.hold(machines) {
                return Err(counted_twice(&twice));
            }
        }
        for (number, at, count) in self.bins {
            summary.add_bin(number, at, count);
        }
        for ((number, at), (octave, _)) in &self.octaves {
            summary.add_octave(*number, *at, octave);
        }
        summary.add_kept(self.kept);
        let machines = summary.count();
        for (number, name) in SampleOutcome::NAMES.iter().enumerate() {
            let count = summary.bins(number).fold(0, |sum: u64, (_, count)| sum.saturating_add(count));
            if count != machines {
                let why = "want every row of every part once";
                return Err(format!(
                    "{name} counts {count} machines, but there are {machines} of {}: {why}",
                    study.samples
                ));
            }
        }
        if let Some((number, at)) = summary.implausible() {
            let name = SampleOutcome::NAMES[number];
            return Err(format!(
                "{name}{SUMS} of bin {at} do not fit the bins of {name}: want every row of every part once"
            ));
        }
        // A table of another program has no checksum of its bytes.
        for (number, name) in SampleOutcome::NAMES.iter().enumerate() {
            for (at, octave, bins) in summary.octaves_with_bins(number) {
                let told = self.octaves.get(&(number, at)).map(|(_, control)| *control);
                if told != Some(ControlSum::of_octave(number, at, octave, bins)) {
                    return Err(changed(&format!("{name}{SUMS} of bin {at}")));
                }
            }
        }
        for (i, name) in LIMITS.iter().enumerate() {
            let limit = self.limits[i].unwrap_or_default();
            if self.kept_controls[i] != ControlSum::of_limit(i, limit, self.kept[i]) {
                return Err(changed(name));
            }
        }
        let kept = summary.kept();
        for (number, limit) in [moment, force].into_iter().enumerate() {
            let Some(limit) = limit else { continue };
            let [least, most] = summary.within(number, limit);
            if !(least..=most).contains(&kept[number]) {
                return Err(format!(
                    "{} counts {}, but by its bins {least} to {most} machines are within {limit}: want every part with \
                     this limit, once",
                    LIMITS[number], kept[number]
                ));
            }
        }
        match both.is_none() || kept[2] <= kept[0].min(kept[1]) && kept[2] + machines >= kept[0] + kept[1] {
            true => Ok(summary),
            false => Err(format!("{} counts {}: want every row of every part once", LIMITS[2], kept[2])),
        }
    }
}

/// Says that counts do not fit the control sum.
fn changed(what: &str) -> String {
    format!("{what} and the column control differ: want the rows as they were written")
}

fn counted_twice(machines: &Range<u64>) -> String {
    format!("machines {} to {} are counted twice: want every part once", machines.start, machines.end - 1)
}

/// Adds up summaries of one study, given in any order.
///
/// # Errors
/// If one cannot be read, belongs to another study, or holds machines that another one holds, too.
pub fn merge_summaries(parts: &[PathBuf]) -> Result<(StudyId, Summary), ShardError> {
    let mut whole: Option<(StudyId, Summary, &Path)> = None;
    for file in parts {
        let (study, summary) = read_summary(file)?;
        let Some((first, sum, before)) = &mut whole else {
            whole = Some((study, summary, file));
            continue;
        };
        let names = || format!("{} and {}", before.display(), file.display());
        if *first != study {
            let why = difference(first, &study).unwrap_or_else(|| "they vary otherwise".into());
            return Err(ShardError::Wrong(format!("{} are parts of different studies: {why}", names())));
        }
        sum.merge(&summary).map_err(|why| match why {
            Unmergeable::Twice(machines) => shard_error(file, counted_twice(&machines)),
            Unmergeable::Limits(..) => {
                let why = "have different limits: want the same --limit-moment and --limit-force for every part";
                ShardError::Wrong(format!("{} {why}", names()))
            }
        })?;
    }
    whole.map(|(study, sum, _)| (study, sum)).ok_or_else(|| ShardError::Wrong("--merge: want parts".into()))
}

const _: () = assert!(MAX_SAMPLES <= 1 << 40, "sums of squares have 128 bits");
