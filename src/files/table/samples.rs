//! A motion given by samples of the drive angles or of the end effector over time.

use super::angle::{GAP_FACTOR, continuous_angle, continuous_length};
use super::column::{ANGLE, TIME, TableColumn, UnitNames, angles, lacking, named, no_column, unit_in_brackets};
use super::error::TableError;
use super::opened::Table;
use super::reader::RowPlace;
use stillbase_mechanics::machine::Machine;
use stillbase_planning::curves::given::MAX_SAMPLES;
use stillbase_planning::curves::spline::MIN_SPLINE_SAMPLES;
use stillbase_planning::curves::{Coordinates, Samples};
use stillbase_settings::number::{ShortNumber, counted};
use stillbase_study::advice::{Advice, Remedy};

const LENGTH: UnitNames = &[("m", 1.0), ("cm", 1e-2), ("mm", 1e-3)];

/// Samples that were read.
#[derive(Debug)]
pub struct SampleTable {
    /// Kind of the coordinates: drive angles or positions of the end effector.
    pub coordinates: Coordinates,
    /// Times, s, and angles, rad, or coordinates, m.
    pub samples: Samples,
    /// Names of the columns other than the time.
    pub names: Vec<String>,
    /// For each of these columns, the number of steps from which whole turns were removed.
    pub unwrapped: Vec<usize>,
}

/// Reads samples from a table with a header: `t,q1,q2 …` or `t,x,y`, in any order, optionally with units, as `q1 (deg)`.
/// Other columns are ignored. If the table has both, `wanted` selects the coordinates, by default the drives. `gaps`
/// allows gaps in time.
///
/// # Errors
/// If the table is no such one; the error has its place and the expected content.
pub fn samples(
    table: &Table,
    machine: &Machine,
    wanted: Option<Coordinates>,
    gaps: bool,
) -> Result<SampleTable, TableError> {
    samples_or(table, machine, wanted, gaps, &head_wanted(machine))
}

/// As [`samples`]; errors describe the expected header by `want`.
///
/// # Errors
/// As [`samples`].
pub(super) fn samples_or(
    table: &Table,
    machine: &Machine,
    wanted: Option<Coordinates>,
    gaps: bool,
    want: &str,
) -> Result<SampleTable, TableError> {
    let (file, mut reader) = (&*table.name, table.reader(want)?);
    let columns = Columns::of(reader.head(), machine, wanted, want).map_err(|why| reader.head_error(why))?;
    let time = &columns.all[0].name;
    let (mut rows, mut places): (Vec<Vec<f64>>, Vec<RowPlace>) = (Vec::new(), Vec::new());
    while let Some(read) = reader.row()? {
        let row = read.numbers(&columns.all)?;
        if let Some(before) = rows.last().map(|row| row[0]).filter(|before| row[0] <= *before) {
            let (now, before) = (ShortNumber(row[0]), ShortNumber(before));
            return Err(read.error(format!("column {time}: {now} s after {before} s: want times that rise")));
        }
        rows.push(row);
        places.push(read.place);
        if rows.len() > MAX_SAMPLES {
            return Err(read.error(format!("more than {MAX_SAMPLES} rows: want fewer, such as every second one")));
        }
    }
    if rows.len() < MIN_SPLINE_SAMPLES {
        let why = format!("{} of numbers: want at least {MIN_SPLINE_SAMPLES}", counted(rows.len(), "row"));
        return Err(TableError::of_file(file, why));
    }
    if let Some((i, step, usual)) = gap(&rows).filter(|_| !gaps) {
        let what = format!(
            "column {time}: {step:.6} s after {}, where {usual:.6} s is usual: a gap; want it filled, or ",
            places[i - 1]
        );
        let why = Advice::from(what).name(Remedy::Gaps).then(" to have it bridged by the spline");
        return Err(places[i].advise(file, why));
    }
    let mut unwrapped = vec![0; columns.all.len() - 1];
    for (k, TableColumn { name, has_unit, .. }) in columns.all.iter().enumerate().skip(1) {
        let turns = match columns.coordinates {
            Coordinates::Drives => continuous_angle(&mut rows, k, name, *has_unit),
            Coordinates::EndEffector => continuous_length(&rows, k, name).map(|()| 0),
        };
        unwrapped[k - 1] = turns.map_err(|broken| places[broken.row].error(file, broken.why(&places)))?;
    }
    let names = columns.all[1..].iter().map(|c| c.name.clone()).collect();
    let samples = Samples::new(&rows).map_err(|why| TableError::of_file(file, why))?;
    Ok(SampleTable { coordinates: columns.coordinates, samples, names, unwrapped })
}

fn head_wanted(machine: &Machine) -> String {
    format!("a header t,{} (rad) or t,x,y (m)", angles(machine))
}

struct Columns {
    coordinates: Coordinates,
    /// All columns, the time first.
    all: Vec<TableColumn>,
}

impl Columns {
    fn of(
        head: &csv::StringRecord,
        machine: &Machine,
        wanted: Option<Coordinates>,
        want: &str,
    ) -> Result<Self, String> {
        let cells: Vec<(String, Option<String>)> = head.iter().map(name_and_unit).collect();
        let find = |names: &[String], units: UnitNames| TableColumn::find(&cells, names, units);
        let missing = |name: &str| no_column(name, head, want);
        let time = find(&named(&["t", "time"]), TIME)?.ok_or_else(|| missing("t"))?;
        let drive = |k: usize| {
            let own = &machine.spec().drives[k].name;
            find(&[format!("q{}", k + 1), format!("q_{}", k + 1), format!("angle/{}", own.to_lowercase())], ANGLE)
        };
        let drives: Vec<Option<TableColumn>> = (0..machine.drives()).map(drive).collect::<Result<_, _>>()?;
        let tip = [find(&named(&["x", "tip/x"]), LENGTH)?, find(&named(&["y", "tip/y"]), LENGTH)?];
        let has_drives = drives.iter().any(Option::is_some) || tip.iter().all(Option::is_none);
        let usual = if has_drives { Coordinates::Drives } else { Coordinates::EndEffector };
        let coordinates = wanted.unwrap_or(usual);
        let mut all = vec![time];
        match coordinates {
            Coordinates::Drives => {
                let is_of = |cell: &str, k: usize| [format!("q{k}"), format!("q_{k}")].contains(&cell.to_owned());
                let known = (1..).take_while(|k| cells.iter().any(|(name, _)| is_of(name, *k))).count();
                if (1..machine.drives()).contains(&known) && drives.iter().flatten().count() == known {
                    let (lacks, own, has) =
                        (lacking(&format!("q{}", known + 1), head), machine.name(), machine.drives());
                    return Err(format!(
                        "{lacks}: these are angles of {}, and {own} has {has}; want {want}",
                        counted(known, "drive")
                    ));
                }
                for (k, column) in drives.into_iter().enumerate() {
                    all.push(column.ok_or_else(|| missing(&format!("q{}", k + 1)))?);
                }
            }
            Coordinates::EndEffector => {
                for (name, column) in ["x", "y"].into_iter().zip(tip) {
                    all.push(column.ok_or_else(|| missing(name))?);
                }
            }
        }
        Ok(Self { coordinates, all })
    }
}

/// Splits a header cell into name and unit: `q1 (deg)`, `q1 [deg]`, `time s`, `q1_deg` or a name alone.
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

/// Finds the first gap: the row after it, its duration, s, and the median time step, s.
fn gap(rows: &[Vec<f64>]) -> Option<(usize, f64, f64)> {
    let steps: Vec<f64> = rows.windows(2).map(|w| w[1][0] - w[0][0]).collect();
    let mut sorted = steps.clone();
    sorted.sort_by(f64::total_cmp);
    let usual = sorted[sorted.len() / 2];
    steps.iter().position(|step| *step > GAP_FACTOR * usual).map(|i| (i + 1, steps[i], usual))
}
