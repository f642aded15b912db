//! Samples read from a CSV file: columns are found by name and unit, and whatever is wrong is named with its file, line
//! and column.

use std::f64::consts::{PI, TAU};
use std::fmt::Display;

use clap::ValueEnum;
use stillbase::mechanics::machine::Machine;
use stillbase::planning::curves::Samples;
use stillbase::planning::curves::given::MAX_SAMPLES;
use stillbase::planning::curves::spline::FEWEST;
use stillbase::settings::number::{Short, counted};
use stillbase::settings::range::{clipped, shortened};

use super::failure::Failure;

/// What the columns are of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Content {
    /// Absolute drive angles q1, q2 …
    Drives,
    /// x and y of the end effector
    Tip,
}

/// A file read.
#[derive(Debug)]
pub struct Read {
    pub content: Content,
    pub samples: Samples,
    /// Names of the columns beside the time.
    pub names: Vec<String>,
    /// For each column how many whole turns were taken out.
    pub unwrapped: Vec<usize>,
}

/// An angle without unit beyond this, rad, is taken for one in degrees.
const TURNS: f64 = 2.0 * TAU;
/// From one sample to the next an angle may move by this much, rad.
const LARGEST_STEP: f64 = 0.5 * PI;
/// A step so many times as fast as both beside it is a jump, if it is also larger than this, rad or m.
const JUMP: f64 = 10.0;
const VISIBLE: [f64; 2] = [0.1, 0.02];
/// The largest number, in SI units.
pub(super) const MOST: f64 = 1e11;
/// The most columns of a file.
const MAX_COLUMNS: usize = 1000;
/// A time between samples so many times as long as the usual one is a gap.
pub(super) const GAP: f64 = 10.0;

/// Reads samples; gaps in time are let pass if asked to.
///
/// # Errors
/// Where what is wrong, and what was expected.
pub fn samples(
    text: &str,
    file: &str,
    machine: &Machine,
    wanted: Option<Content>,
    gaps: bool,
) -> Result<Read, Failure> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let at = |line: u64, why: &dyn Display| Failure::wrong_input(format!("{file}:{line}: {why}"));
    let mut lines = reader(text, file)?.into_records();
    let mut next =
        || lines.next().map(|r| r.map_err(|e| Failure::wrong_input(format!("{file}: {e}: want a CSV file"))));
    let want = head_wanted(machine);
    let Some(head) = next().transpose()? else {
        return Err(at(1, &format!("nothing here: want {want}")));
    };
    let line_of = |record: &csv::StringRecord| record.position().map_or(0, csv::Position::line);
    if head.iter().all(|cell| cell.parse::<f64>().is_ok()) {
        return Err(at(line_of(&head), &format!("no header: want {want}")));
    }
    let columns = Columns::of(&head, machine, wanted).map_err(|why| at(line_of(&head), &why))?;
    let (mut rows, mut places): (Vec<Vec<f64>>, Vec<u64>) = (Vec::new(), Vec::new());
    while let Some(record) = next().transpose()? {
        let line = line_of(&record);
        let number = |column: &Column| match record.get(column.place).filter(|cell| !cell.is_empty()) {
            None => Err(at(line, &format!("column {}: nothing there: want a number", column.name))),
            Some(cell) => {
                cell.parse().ok().map(|x: f64| x * column.scale).filter(|x| x.abs() <= MOST).ok_or_else(|| {
                    let (name, cell) = (&column.name, clipped(cell));
                    at(line, &format!("column {name}: {cell:?}: want a finite number, such as 0.25, of at most 1e11"))
                })
            }
        };
        let row: Vec<f64> = columns.all.iter().map(number).collect::<Result<_, _>>()?;
        if let Some(before) = rows.last().map(|row| row[0]).filter(|before| row[0] <= *before) {
            let (name, now, before) = (&columns.all[0].name, Short(row[0]), Short(before));
            let why = format!("column {name}: {now} s after {before} s: want times that rise");
            return Err(at(line, &why));
        }
        rows.push(row);
        places.push(line);
        if rows.len() > MAX_SAMPLES {
            return Err(at(line, &format!("more than {MAX_SAMPLES} rows: want fewer, such as every second one")));
        }
    }
    if rows.len() < FEWEST {
        return Err(Failure::wrong_input(format!(
            "{file}: {} of numbers: want at least {FEWEST}",
            counted(rows.len(), "row")
        )));
    }
    if let Some((i, step, usual)) = gap(&rows).filter(|_| !gaps) {
        let why = format!(
            "column {}: {step:.6} s after line {}, where {usual:.6} s is usual: a gap; want it filled, or --gaps to have it \
             bridged by the spline",
            columns.all[0].name,
            places[i - 1]
        );
        return Err(at(places[i], &why));
    }
    let mut unwrapped = vec![0; columns.all.len() - 1];
    for (k, column) in columns.all.iter().enumerate().skip(1) {
        let (name, drives) = (&column.name, columns.content == Content::Drives);
        let whole = match drives {
            true => continuous_angle(&mut rows, k, name, column.has_unit),
            false => jump(&rows, k, columns.content).map_or(Ok(0), |(i, step)| Err(Broken::jump(name, i, step, "m"))),
        };
        let broken = |broken: Broken| at(places[broken.row], &broken.why(|row| places[row]));
        unwrapped[k - 1] = whole.map_err(broken)?;
    }
    let names = columns.all[1..].iter().map(|c| c.name.clone()).collect();
    let samples = Samples::new(&rows).map_err(|e| Failure::wrong_input(e).of(file))?;
    Ok(Read { content: columns.content, samples, names, unwrapped })
}

/// What keeps a column from being a continuous motion.
pub(super) struct Broken {
    /// At which row.
    pub row: usize,
    what: String,
    /// Whether it is a jump from the row before.
    jump: Option<String>,
}

impl Broken {
    fn jump(name: &str, row: usize, step: f64, unit: &str) -> Self {
        let turns = if unit == "rad" { ", which no whole turn explains" } else { "" };
        let rest = format!("{turns}: want a continuous motion, sampled more often if it is that fast");
        Self { row, what: format!("column {name}: a jump of {step:.3} {unit} from line "), jump: Some(rest) }
    }

    /// In words, by the lines of rows.
    pub fn why(&self, line: impl Fn(usize) -> u64) -> String {
        match &self.jump {
            Some(rest) => format!("{}{}{rest}", self.what, line(self.row - 1)),
            None => self.what.clone(),
        }
    }
}

/// Takes whole turns out of the steps of a column of angles, rad; how many there were.
///
/// # Errors
/// If these are no angles in rad, or jump.
pub(super) fn continuous_angle(rows: &mut [Vec<f64>], k: usize, name: &str, has_unit: bool) -> Result<usize, Broken> {
    if let Some(row) = rows.iter().position(|row| !has_unit && row[k].abs() > TURNS) {
        let what = format!(
            "column {name}: {} rad is more than two turns: want radians; if these are degrees, name the column \
             \"{name} (deg)\", if they are radians, \"{name} (rad)\"",
            Short(rows[row][k])
        );
        return Err(Broken { row, what, jump: None });
    }
    let turns = unwrap(rows, k);
    match jump(rows, k, Content::Drives) {
        Some((row, step)) => Err(Broken::jump(name, row, step, "rad")),
        None => Ok(turns),
    }
}

/// By the first line that tells: semicolons, tabs or commas.
///
/// # Errors
/// If a row has too many columns, before any of them takes memory.
pub(super) fn reader<'a>(text: &'a str, file: &str) -> Result<csv::Reader<&'a [u8]>, Failure> {
    let head = text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#')).unwrap_or_default();
    let delimiter = [b';', b'\t'].into_iter().find(|d| head.bytes().any(|b| b == *d)).unwrap_or(b',');
    if let Some(line) = too_wide(text, delimiter) {
        let what = format!("{file}:{line}: more than {MAX_COLUMNS} columns: want at most {MAX_COLUMNS}");
        return Err(Failure::wrong_input(what));
    }
    Ok(csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .delimiter(delimiter)
        .from_reader(text.as_bytes()))
}

/// Where a cell is while it is read.
#[derive(Clone, Copy, PartialEq)]
enum Cell {
    /// At its first byte, that of a row too or not.
    Fresh {
        of_row: bool,
    },
    Bare,
    Quoted,
    /// After a quote in quotes: two are one, one ends them.
    Closed,
    Comment,
}

/// The line in which a row ends that has too many columns, by the rules of the reader.
fn too_wide(text: &str, delimiter: u8) -> Option<usize> {
    let (mut cell, mut columns, mut line) = (Cell::Fresh { of_row: true }, 1, 1);
    for byte in text.bytes() {
        line += usize::from(byte == b'\n');
        cell = match (cell, byte) {
            (Cell::Quoted, b'"') => Cell::Closed,
            (Cell::Quoted, _) | (Cell::Closed, b'"') => Cell::Quoted,
            (_, b'\n' | b'\r') => {
                columns = 1;
                Cell::Fresh { of_row: true }
            }
            (Cell::Comment, _) | (Cell::Fresh { of_row: true }, b'#') => Cell::Comment,
            (Cell::Fresh { .. }, b'"') => Cell::Quoted,
            (_, byte) if byte == delimiter => {
                columns += 1;
                if columns > MAX_COLUMNS {
                    return Some(line);
                }
                Cell::Fresh { of_row: false }
            }
            _ => Cell::Bare,
        };
    }
    None
}

fn head_wanted(machine: &Machine) -> String {
    let drives: Vec<String> = (1..=machine.drives()).map(|k| format!("q{k}")).collect();
    format!("a header t,{} (rad) or t,x,y (m)", drives.join(","))
}

/// A column of a file.
pub(super) struct Column {
    pub place: usize,
    pub name: String,
    /// What a number of it is in SI units.
    pub scale: f64,
    /// Whether its head says its unit.
    pub has_unit: bool,
}

impl Column {
    /// The one of these names among heads with their units; none if there is none.
    ///
    /// # Errors
    /// If there are two, or its unit is none of those known.
    pub fn find(
        cells: &[(String, Option<String>)],
        names: &[String],
        units: &[(&str, f64)],
    ) -> Result<Option<Self>, String> {
        let mut found = cells.iter().enumerate().filter(|(_, (name, _))| names.contains(name));
        let Some((place, (name, unit))) = found.next() else { return Ok(None) };
        if let Some((other, _)) = found.next() {
            return Err(format!("columns {} and {} are both {name}: want one", place + 1, other + 1));
        }
        let scale = match unit {
            None => 1.0,
            Some(unit) => {
                let known = units.iter().find(|(known, _)| known == unit);
                known.map(|known| known.1).ok_or_else(|| {
                    let all: Vec<&str> = units.iter().map(|u| u.0).collect();
                    format!("column {name}: unit {:?}: want one of {}", clipped(unit), all.join(", "))
                })?
            }
        };
        Ok(Some(Self { place, name: name.clone(), scale, has_unit: unit.is_some() }))
    }
}

/// That a column is missing among those of a file.
pub(super) fn no_column(name: &str, head: &csv::StringRecord, want: &str) -> String {
    let have: Vec<String> = head.iter().map(|word| format!("{:?}", clipped(word))).collect();
    format!("no column {name} among {}: want {want}", shortened(&have.join(", "), 300))
}

struct Columns {
    content: Content,
    /// The time first.
    all: Vec<Column>,
}

pub(super) const TIME: &[(&str, f64)] = &[("s", 1.0), ("sec", 1.0), ("ms", 1e-3), ("us", 1e-6), ("µs", 1e-6)];
pub(super) const ANGLE: &[(&str, f64)] =
    &[("rad", 1.0), ("radians", 1.0), ("deg", PI / 180.0), ("degrees", PI / 180.0), ("°", PI / 180.0)];
const LENGTH: &[(&str, f64)] = &[("m", 1.0), ("cm", 1e-2), ("mm", 1e-3)];

impl Columns {
    fn of(head: &csv::StringRecord, machine: &Machine, wanted: Option<Content>) -> Result<Self, String> {
        let cells: Vec<(String, Option<String>)> = head.iter().map(name_and_unit).collect();
        let find = |names: &[String], units: &[(&str, f64)]| Column::find(&cells, names, units);
        let named = |all: &[&str]| all.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let want = head_wanted(machine);
        let missing = |name: &str| no_column(name, head, &want);
        let time = find(&named(&["t", "time"]), TIME)?.ok_or_else(|| missing("t"))?;
        let drive = |k: usize| {
            let own = &machine.spec().drives[k].name;
            find(&[format!("q{}", k + 1), format!("q_{}", k + 1), format!("angle/{}", own.to_lowercase())], ANGLE)
        };
        let drives: Vec<Option<Column>> = (0..machine.drives()).map(drive).collect::<Result<_, _>>()?;
        let tip = [find(&named(&["x", "tip/x"]), LENGTH)?, find(&named(&["y", "tip/y"]), LENGTH)?];
        let content = wanted.unwrap_or(match drives.iter().any(Option::is_some) || tip.iter().all(Option::is_none) {
            true => Content::Drives,
            false => Content::Tip,
        });
        let mut all = vec![time];
        match content {
            Content::Drives => {
                for (k, column) in drives.into_iter().enumerate() {
                    all.push(column.ok_or_else(|| missing(&format!("q{}", k + 1)))?);
                }
            }
            Content::Tip => {
                for (name, column) in ["x", "y"].into_iter().zip(tip) {
                    all.push(column.ok_or_else(|| missing(name))?);
                }
            }
        }
        Ok(Self { content, all })
    }
}

/// `q1 (deg)` or `q1 [deg]`, trimmed and in small letters.
pub(super) fn unit_in_brackets(cell: &str) -> Option<(String, Option<String>)> {
    let bracketed = |open: char, close: char| {
        let (name, rest) = cell.split_once(open)?;
        Some((name.trim().to_owned(), rest.trim().strip_suffix(close)?.trim().to_owned()))
    };
    let (name, unit) = bracketed('(', ')').or_else(|| bracketed('[', ']'))?;
    Some((name, Some(unit).filter(|unit| !unit.is_empty())))
}

/// `q1 (deg)`, `q1 [deg]`, `time s`, `q1_deg` or a name alone.
fn name_and_unit(cell: &str) -> (String, Option<String>) {
    let cell = cell.trim().to_lowercase();
    if let Some(both) = unit_in_brackets(&cell) {
        return both;
    }
    let known = |unit: &str| [TIME, ANGLE, LENGTH].iter().any(|units| units.iter().any(|(known, _)| *known == unit));
    for separator in [' ', '_', '/'] {
        if let Some((name, unit)) = cell.rsplit_once(separator).filter(|(_, unit)| known(unit)) {
            return (name.trim().to_owned(), Some(unit.to_owned()));
        }
    }
    (cell, None)
}

/// Takes whole turns out of the steps of a column; how many there were.
fn unwrap(rows: &mut [Vec<f64>], k: usize) -> usize {
    let (mut turns, mut count) = (0.0, 0);
    let mut before = rows[0][k];
    for row in rows.iter_mut().skip(1) {
        let step = ((row[k] - before) / TAU).round();
        before = row[k];
        count += usize::from(step != 0.0);
        turns -= step;
        if turns != 0.0 {
            row[k] += TAU * turns;
        }
    }
    count
}

/// The first step of a column that no smooth motion makes: at which row, and how large.
fn jump(rows: &[Vec<f64>], k: usize, content: Content) -> Option<(usize, f64)> {
    let step = |i: usize| rows[i][k] - rows[i - 1][k];
    let speed = |i: usize| (step(i) / (rows[i][0] - rows[i - 1][0])).abs();
    let visible = VISIBLE[usize::from(content == Content::Tip)];
    (1..rows.len()).map(|i| (i, step(i))).find(|(i, size)| {
        let beside = [i.checked_sub(1).filter(|i| *i > 0), Some(i + 1).filter(|i| *i < rows.len())];
        let most = beside.into_iter().flatten().map(speed).fold(0.0, f64::max);
        let lone = size.abs() > visible && speed(*i) > JUMP * most;
        lone || (content == Content::Drives && size.abs() > LARGEST_STEP)
    })
}

/// The first time between samples that is far longer than the usual one: at which row, how long, and the usual one, s.
fn gap(rows: &[Vec<f64>]) -> Option<(usize, f64, f64)> {
    let steps: Vec<f64> = rows.windows(2).map(|w| w[1][0] - w[0][0]).collect();
    let mut sorted = steps.clone();
    sorted.sort_by(f64::total_cmp);
    let usual = sorted[sorted.len() / 2];
    steps.iter().position(|step| *step > GAP * usual).map(|i| (i + 1, steps[i], usual))
}
