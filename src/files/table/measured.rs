//! Measured motions of a built machine, with forces and moments on its base.

use super::angle::{GAP_FACTOR, continuous_angle};
use super::column::{ANGLE, DEGREE, TIME, TableColumn, UnitNames, angles, named, no_column, unit_in_brackets};
use super::error::TableError;
use super::opened::Table;
use super::reader::RowPlace;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::{PerDrive, Vector};
use stillbase_settings::number::{ShortNumber, counted};
use stillbase_settings::range::quote_clipped;
use stillbase_study::trim::MeasuredMotion;

/// Maximum number of rows of a table.
pub const MAX_ROWS: usize = 100_000;

const RATE: UnitNames = &[("rad/s", 1.0), ("deg/s", DEGREE), ("°/s", DEGREE)];
const ACCELERATION: UnitNames = &[
    ("rad/s²", 1.0),
    ("rad/s^2", 1.0),
    ("rad/s2", 1.0),
    ("deg/s²", DEGREE),
    ("deg/s^2", DEGREE),
    ("deg/s2", DEGREE),
    ("°/s²", DEGREE),
];
const FORCE: UnitNames = &[("n", 1.0), ("mn", 1e-3), ("kn", 1e3)];
const MOMENT: UnitNames = &[
    ("n m", 1.0),
    ("nm", 1.0),
    ("n·m", 1.0),
    ("n*m", 1.0),
    ("mn m", 1e-3),
    ("mnm", 1e-3),
    ("n mm", 1e-3),
    ("nmm", 1e-3),
    ("kn m", 1e3),
];
const LENGTH: UnitNames = &[("m", 1.0)];
// Names of the columns of forces and moments on the base.
const FORCE_X: &[&str] = &["fx", "f_x", "force/x", "force/dynamic_x"];
const FORCE_Y: &[&str] = &["fy", "f_y", "force/y", "force/dynamic_y"];
const MOMENT_Z: &[&str] = &["nz", "n_z", "mz", "m_z", "moment/total"];
/// Largest motion of a base that is treated as fixed, m or rad.
const MAX_BASE_MOTION: f64 = 1e-9;

/// The columns of a measurement.
struct Columns {
    time: TableColumn,
    q: Vec<TableColumn>,
    qd: Vec<TableColumn>,
    qdd: Vec<TableColumn>,
    force: [TableColumn; 2],
    moment: TableColumn,
    /// Columns for position and angle of the base; only those that the file has.
    base: Vec<TableColumn>,
    /// Index of the column with the name of the motion.
    motion: Option<usize>,
}

/// Reads motions from a table with a header: `t,q1,q2 …,fx,fy,nz`, in any order, optionally with units. Columns of rates
/// `qd1 …` and accelerations `qdd1 …` are read if present. A new motion begins where the column `motion` changes, after
/// a gap in time, and where time restarts.
///
/// # Errors
/// If the table is no such one; the error has its place and the expected content.
pub fn motions(table: &Table, machine: &Machine) -> Result<Vec<MeasuredMotion>, TableError> {
    motions_or(table, machine, &head_wanted(machine))
}

/// As [`motions`]; errors describe the expected header by `want`.
///
/// # Errors
/// As [`motions`].
pub(super) fn motions_or(table: &Table, machine: &Machine, want: &str) -> Result<Vec<MeasuredMotion>, TableError> {
    let (file, mut reader) = (&*table.name, table.reader(want)?);
    let columns = Columns::of(reader.head(), machine, want).map_err(|why| reader.head_error(why))?;
    let all = columns.all();
    let (mut read, mut last, mut count) = (Split::default(), None::<String>, 0);
    while let Some(row) = reader.row()? {
        let numbers = row.numbers(all.iter().copied())?;
        let name = columns.motion.and_then(|place| row.cell(place)).unwrap_or_default().into_owned();
        let fresh = last.is_some_and(|last| last != name);
        last = Some(name);
        count += 1;
        if count > MAX_ROWS {
            return Err(row.error(format!("more than {MAX_ROWS} rows: want fewer, such as every second one")));
        }
        let taken = read.take(numbers, row.place, fresh);
        taken.map_err(|why| row.error(format!("column {}: {why}", columns.time.name)))?;
    }
    let mut parts = read.parts();
    if let Some((column, place)) = columns.moving(&parts) {
        let why = format!(
            "column {column}: the base moves: want a measurement on a base that stands still, or a base that is free"
        );
        return Err(place.error(file, why));
    }
    for Part { rows, places } in &mut parts {
        for (k, column) in columns.q.iter().enumerate() {
            let turns = continuous_angle(rows, 1 + k, &column.name, column.has_unit);
            turns.map_err(|broken| places[broken.row].error(file, broken.why(places)))?;
        }
    }
    if parts.is_empty() {
        return Err(TableError::of_file(file, "no rows of numbers: want motions that were measured"));
    }
    Ok(parts.iter().map(|part| columns.motion_of(&part.rows)).collect())
}

/// Returns whether a table has a column of a force or a moment on the base.
pub(super) fn has_base_reaction(head: &csv::StringRecord) -> bool {
    let is = |cell: &str, names: &[&str], units: UnitNames| names.contains(&name_and_unit(cell, units).0.as_str());
    head.iter().any(|cell| is(cell, FORCE_X, FORCE) || is(cell, FORCE_Y, FORCE) || is(cell, MOMENT_Z, MOMENT))
}

fn head_wanted(machine: &Machine) -> String {
    format!("a header t,{},fx,fy,nz (s, rad, N, N m)", angles(machine))
}

/// Rows of one motion, with their places in the file.
#[derive(Default)]
struct Part {
    rows: Vec<Vec<f64>>,
    places: Vec<RowPlace>,
}

/// Splits rows into motions while they are read.
#[derive(Default)]
struct Split {
    named: Vec<Part>,
}

impl Split {
    /// Adds a row. A new motion begins if `fresh`, or if the time goes back to the start of the present motion or
    /// before.
    ///
    /// # Errors
    /// If the time does not increase within a motion.
    fn take(&mut self, row: Vec<f64>, place: RowPlace, fresh: bool) -> Result<(), String> {
        let now = self.named.last().filter(|_| !fresh);
        let (first, last) = (now.and_then(|part| part.rows.first()), now.and_then(|part| part.rows.last()));
        let again = first.zip(last).is_some_and(|(first, last)| row[0] <= first[0] && row[0] < last[0]);
        if let Some(last) = last.filter(|last| !again && row[0] <= last[0]) {
            let (now, before) = (ShortNumber(row[0]), ShortNumber(last[0]));
            return Err(format!("{now} s after {before} s: want times that rise, or begin anew with each motion"));
        }
        if fresh || again || self.named.is_empty() {
            self.named.push(Part::default());
        }
        if let Some(part) = self.named.last_mut() {
            part.rows.push(row);
            part.places.push(place);
        }
        Ok(())
    }

    /// Returns the motions, split further at time steps that are long compared with the median time step.
    fn parts(self) -> Vec<Part> {
        let mut parts = Vec::new();
        for part in self.named {
            let mut steps: Vec<f64> = part.rows.windows(2).map(|w| w[1][0] - w[0][0]).collect();
            steps.sort_by(f64::total_cmp);
            let median = steps.get(steps.len() / 2).copied().unwrap_or(f64::INFINITY);
            let mut own = Part::default();
            for (row, place) in part.rows.into_iter().zip(part.places) {
                if own.rows.last().is_some_and(|last| row[0] - last[0] > GAP_FACTOR * median) {
                    parts.push(std::mem::take(&mut own));
                }
                own.rows.push(row);
                own.places.push(place);
            }
            parts.push(own);
        }
        parts
    }
}

impl Columns {
    fn of(head: &csv::StringRecord, machine: &Machine, wanted: &str) -> Result<Self, String> {
        let find = |names: &[String], units: UnitNames| {
            let cells: Vec<_> = head.iter().map(|cell| name_and_unit(cell, units)).collect();
            TableColumn::find(&cells, names, units)
        };
        let missing = |name: &str| no_column(name, head, wanted);
        let drives = machine.drives();
        let each = |short: [&str; 2], long: &str, units: UnitNames| -> Result<Vec<Option<TableColumn>>, String> {
            let of = |k: usize| {
                let own = machine.spec().drives[k].name.to_lowercase();
                let [a, b] = short.map(|word| format!("{word}{}", k + 1));
                find(&[a, b, format!("{}_{}", short[0], k + 1), format!("{long}/{own}")], units)
            };
            (0..drives).map(of).collect()
        };
        // Rates and accelerations are used only if all drives have them.
        let all =
            |of: Vec<Option<TableColumn>>| of.into_iter().collect::<Option<Vec<TableColumn>>>().unwrap_or_default();
        let want = |found: Option<TableColumn>, name: &str| found.ok_or_else(|| missing(name));
        // A file with more drives belongs to another machine.
        let number = |cell: &str| {
            cell.to_lowercase().strip_prefix('q').and_then(|rest| rest.trim_start_matches('_').parse::<usize>().ok())
        };
        if let Some(other) = head.iter().find(|cell| number(cell).is_some_and(|k| k > drives)) {
            let has = counted(drives, "drive");
            return Err(format!("column {} is of no drive: {} has {has}", quote_clipped(other), machine.name()));
        }
        let q = each(["q", "q"], "angle", ANGLE)?.into_iter().enumerate();
        Ok(Self {
            time: want(find(&named(&["t", "time"]), TIME)?, "t")?,
            q: q.map(|(k, column)| want(column, &format!("q{}", k + 1))).collect::<Result<_, _>>()?,
            qd: all(each(["qd", "dq"], "rate", RATE)?),
            qdd: all(each(["qdd", "ddq"], "acceleration", ACCELERATION)?),
            force: [want(find(&named(FORCE_X), FORCE)?, "fx")?, want(find(&named(FORCE_Y), FORCE)?, "fy")?],
            moment: want(find(&named(MOMENT_Z), MOMENT)?, "nz")?,
            base: [
                find(&named(&["base_x", "base/x"]), LENGTH)?,
                find(&named(&["base_y", "base/y"]), LENGTH)?,
                find(&named(&["theta", "attitude/base"]), ANGLE)?,
            ]
            .into_iter()
            .flatten()
            .collect(),
            motion: head.iter().position(|cell| cell.eq_ignore_ascii_case("motion")),
        })
    }

    /// Returns every column of numbers, in the order of the numbers of a row.
    fn all(&self) -> Vec<&TableColumn> {
        let angles = self.q.iter().chain(&self.qd).chain(&self.qdd);
        [&self.time].into_iter().chain(angles).chain(&self.force).chain([&self.moment]).chain(&self.base).collect()
    }

    /// Returns the name of a column in which the base moves, and the place of the first row that differs from the
    /// initial row.
    fn moving(&self, parts: &[Part]) -> Option<(String, RowPlace)> {
        let from = self.all().len() - self.base.len();
        let rows = || parts.iter().flat_map(|part| part.rows.iter().zip(&part.places));
        let (first, _) = rows().next()?;
        self.base.iter().enumerate().find_map(|(i, column)| {
            let (_, place) = rows().find(|(row, _)| (row[from + i] - first[from + i]).abs() > MAX_BASE_MOTION)?;
            Some((column.name.clone(), *place))
        })
    }

    fn motion_of(&self, rows: &[Vec<f64>]) -> MeasuredMotion {
        let n = self.q.len();
        let list = |from: usize, columns: &[TableColumn]| match columns.is_empty() {
            true => Vec::new(),
            false => rows.iter().map(|row| PerDrive::from_fn(n, |k| row[from + k])).collect(),
        };
        let force = 1 + n + self.qd.len() + self.qdd.len();
        MeasuredMotion {
            t: rows.iter().map(|row| row[0]).collect(),
            q: list(1, &self.q),
            qd: list(1 + n, &self.qd),
            qdd: list(1 + n + self.qd.len(), &self.qdd),
            force: rows.iter().map(|row| Vector::new(row[force], row[force + 1])).collect(),
            moment: rows.iter().map(|row| row[force + 2]).collect(),
        }
    }
}

/// Splits a header cell into name and unit: `fx (N)`, `fx [N]`, `force/dynamic_x N`, `q1_deg` or a name alone. Without
/// brackets, only `units` are recognised as units.
fn name_and_unit(cell: &str, units: UnitNames) -> (String, Option<String>) {
    let cell = cell.trim().to_lowercase();
    if let Some(both) = unit_in_brackets(&cell) {
        return both;
    }
    let ends = units.iter().filter_map(|(unit, _)| {
        let name = cell.strip_suffix(unit)?.strip_suffix([' ', '_', '/'])?;
        Some((name.trim().to_owned(), (*unit).to_owned()))
    });
    // The longest matching unit is taken, so that `n m` is not read as `m`.
    ends.max_by_key(|(_, unit)| unit.len()).map_or((cell.clone(), None), |(name, unit)| (name, Some(unit)))
}
