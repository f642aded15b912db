//! [`TableColumn`]: a column of a table, found by its name, with its unit.

use std::f64::consts::PI;

use stillbase_mechanics::machine::Machine;
use stillbase_settings::range::{quote_clipped, shortened};

/// Names of units, each with its value in SI units.
pub(super) type UnitNames = &'static [(&'static str, f64)];

pub(super) const DEGREE: f64 = PI / 180.0;
pub(super) const TIME: UnitNames = &[("s", 1.0), ("sec", 1.0), ("ms", 1e-3), ("us", 1e-6), ("µs", 1e-6)];
pub(super) const ANGLE: UnitNames =
    &[("rad", 1.0), ("radians", 1.0), ("deg", DEGREE), ("degrees", DEGREE), ("°", DEGREE)];

/// A column of a table.
pub(super) struct TableColumn {
    /// Index of the column, from 0.
    pub place: usize,
    pub name: String,
    /// Factor that converts its numbers to SI units.
    pub scale: f64,
    /// Whether its header states the unit.
    pub has_unit: bool,
}

impl TableColumn {
    /// Finds the column with one of these names among header cells, given as names with units; `None` if there is none.
    ///
    /// # Errors
    /// If there are two such columns, or if the unit is unknown.
    pub fn find(
        cells: &[(String, Option<String>)],
        names: &[String],
        units: UnitNames,
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
                    format!("column {name}: unit {:?}: want one of {}", quote_clipped(unit), all.join(", "))
                })?
            }
        };
        Ok(Some(Self { place, name: name.clone(), scale, has_unit: unit.is_some() }))
    }
}

/// Returns the message that a column is missing in a table.
pub(super) fn no_column(name: &str, head: &csv::StringRecord, want: &str) -> String {
    format!("{}: want {want}", lacking(name, head))
}

/// Says that a header lacks a column.
pub(super) fn lacking(name: &str, head: &csv::StringRecord) -> String {
    let have: Vec<String> = head.iter().map(|word| format!("{:?}", quote_clipped(word))).collect();
    format!("no column {name} among {}", shortened(&have.join(", "), 300))
}

/// Splits a lower-case header cell such as `q1 (deg)` or `q1 [deg]` into name and unit; `None` without brackets.
pub(super) fn unit_in_brackets(cell: &str) -> Option<(String, Option<String>)> {
    let bracketed = |open: char, close: char| {
        let (name, rest) = cell.split_once(open)?;
        Some((name.trim().to_owned(), rest.trim().strip_suffix(close)?.trim().to_owned()))
    };
    let (name, unit) = bracketed('(', ')').or_else(|| bracketed('[', ']'))?;
    Some((name, Some(unit).filter(|unit| !unit.is_empty())))
}

/// Returns the header cells of a machine's drive angles, joined by commas.
pub(super) fn angles(machine: &Machine) -> String {
    (1..=machine.drives()).map(|k| format!("q{k}")).collect::<Vec<_>>().join(",")
}

/// Copies names into a vector.
pub(super) fn named(all: &[&str]) -> Vec<String> {
    all.iter().map(|name| (*name).to_owned()).collect()
}
