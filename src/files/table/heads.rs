//! [`SignalHeads`]: which column of a table is the time, and which signal each of the others holds.

use super::column::unit_in_brackets;
use stillbase_settings::range::{quote_clipped, shortened};
use stillbase_settings::results::newest_path;
use stillbase_simulation::signal_table::{SignalColumn, SignalTable};
use stillbase_simulation::signals::name_and_unit as simulation_head;

/// The heads that a table of signals needs, in words.
pub(super) const WANT: &str = "a column for the time, such as time s or t, and one for each signal with its unit, such \
                               as torque/1 N m";

/// Units that no simulation writes, but that a head may end with as those that one does.
const OTHER_UNITS: [&str; 8] = ["deg/s", "°/s", "rpm", "deg", "°", "ms", "µs", "us"];

/// Units of the time, with the factor to s.
const TIME_UNITS: [(&str, f64); 5] = [("", 1.0), ("s", 1.0), ("ms", 1e-3), ("µs", 1e-6), ("us", 1e-6)];

/// The heads of a table of signals.
pub(super) struct SignalHeads {
    /// Index of the column of the time.
    pub time: usize,
    /// Unit of the time, s.
    second: f64,
    /// Index, name and unit of each other column.
    columns: Vec<(usize, String, String)>,
}

impl SignalHeads {
    /// Finds the time among the heads of columns. It is called `t` or `time`, and counts seconds.
    ///
    /// # Errors
    /// If there is no time, or nothing else, or two columns have one name; the error says what would be right.
    pub fn of<'a>(heads: impl IntoIterator<Item = &'a str>) -> Result<Self, String> {
        let mut all: Vec<(String, String)> = heads.into_iter().map(name_and_unit).collect();
        let given: Vec<String> = all.iter().map(|(name, _)| name.clone()).collect();
        // An older name counts if the newer one does not stand beside it.
        let mut older = vec![false; all.len()];
        for (i, (name, _)) in all.iter_mut().enumerate() {
            let newest = newest_path(name).to_owned();
            older[i] = newest != *name && given.contains(&newest);
            *name = if older[i] { name.clone() } else { newest };
        }
        let names = || shortened(&all.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", "), 300);
        let is_time = |(name, _): &(String, String)| ["t", "time"].contains(&name.to_lowercase().as_str());
        let Some(time) = all.iter().position(is_time) else {
            return Err(format!("no column for the time among {}: want {WANT}", names()));
        };
        let Some((_, second)) = TIME_UNITS.into_iter().find(|(unit, _)| *unit == all[time].1) else {
            let unit = quote_clipped(&all[time].1).to_string();
            return Err(format!("column {}: unit {unit:?}: want the time in s, ms or µs", all[time].0));
        };
        if all.len() < 2 {
            return Err(format!("nothing but the time: want {WANT}"));
        }
        if let Some(i) = (1..all.len()).find(|i| all[..*i].iter().any(|(name, _)| *name == all[*i].0)) {
            return Err(format!("two columns {:?}: want different names", quote_clipped(&all[i].0)));
        }
        let columns = all.into_iter().enumerate().filter(|(place, _)| *place != time && !older[*place]);
        Ok(Self { time, second, columns: columns.map(|(place, (name, unit))| (place, name, unit)).collect() })
    }

    /// Returns the index and the name of each column besides the time.
    pub fn signals(&self) -> impl Iterator<Item = (usize, &str)> {
        self.columns.iter().map(|(place, name, _)| (*place, name.as_str()))
    }

    /// Returns a table of these signals with their values; `values` has a column for each of them.
    pub fn table(self, time: Vec<f64>, values: Vec<Vec<f64>>) -> SignalTable {
        let columns = self.columns.into_iter().zip(values);
        let columns = columns.map(|((_, path, unit), values)| SignalColumn { path, unit, values });
        let time = if self.second == 1.0 { time } else { time.iter().map(|t| self.second * t).collect() };
        SignalTable { time, columns: columns.collect() }
    }
}

/// Returns what is wrong with a time that follows others; `None` if it is a number and later than the last of them.
pub(super) fn wrong_time(time: f64, before: Option<f64>) -> Option<String> {
    match before {
        _ if !time.is_finite() => Some("column time: no number: want a finite time in s".into()),
        Some(before) if time <= before => {
            Some(format!("column time: {time} s after {before} s: want times that increase from row to row"))
        }
        _ => None,
    }
}

/// Splits the head of a column into the name and the unit of a signal.
fn name_and_unit(head: &str) -> (String, String) {
    let head = head.trim();
    if let Some((name, unit)) = unit_in_brackets(head) {
        return (name, unit.unwrap_or_default());
    }
    let other = |unit: &str| Some((head.strip_suffix(unit)?.strip_suffix(' ')?.to_owned(), unit.to_owned()));
    if let Some(split) = OTHER_UNITS.into_iter().find_map(other) {
        return split;
    }
    let (name, unit) = simulation_head(head);
    (name.into(), unit.into())
}
