//! [`RunColumn`]: a column of the table of runs, as the window and a report show it.

use crate::notation::{NameOrder, Notation, NumberFormat};
use stillbase_study::comparison::{Comparison, ComparisonEntry, DESIGN_COLUMNS, SUMMARY_COLUMNS, SummaryColumn};

/// Keys of the columns that need a base that moves.
const OF_MOVING_BASE: [&str; 3] = ["base_shift", "base_angle", "base_angle_end"];

/// A column in the user's units and names.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunColumn {
    /// Its index among all columns.
    pub at: usize,
    /// Its title, without unit.
    pub head: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// How its values are written; the unit `1` marks a ratio.
    pub format: NumberFormat<'static>,
    /// Columns with lower priority give way first where space is short.
    pub priority: u8,
}

impl RunColumn {
    fn of<T>(at: usize, column: &SummaryColumn<T>, notation: Notation) -> Self {
        let SummaryColumn { term, head, meaning, unit, decimals, priority, .. } = *column;
        let head = if notation.names == NameOrder::Symbols { head } else { term };
        Self { at, head, meaning, format: notation.format(decimals, unit), priority }
    }

    /// Returns a column of runs; `has_wheel` says whether one of them has a reaction wheel.
    fn past_wheel(at: usize, column: &SummaryColumn, notation: Notation, has_wheel: bool) -> Self {
        let of = Self::of(at, column, notation);
        let [head, meaning] = match column.key {
            "peak_felt_moment" => {
                [["peak moment felt", "peak n felt"], ["largest moment on the base, past a wheel"; 2]]
            }
            "rms_felt_moment" => [["RMS moment felt", "rms n felt"], ["its root mean square"; 2]],
            "felt_moment_impulse" => [["moment felt, impulse", "∫|n felt|dt"], ["its impulse"; 2]],
            _ => return of,
        };
        let named = usize::from(notation.names == NameOrder::Symbols);
        if has_wheel { Self { head: head[named], meaning: meaning[named], ..of } } else { of }
    }

    /// Returns the columns that have a value in any row. Columns of base motion need a base that moves; columns of
    /// designs need different machines.
    pub fn all(comparison: &Comparison, notation: Notation) -> Vec<Self> {
        let runs = || comparison.entries().iter().filter_map(|entry| Some(&entry.outcome.as_ref().ok()?.summary));
        let moves = runs().any(|run| run.base_shift > 0.0 || run.base_tilt > 0.0);
        let has_value = |column: &SummaryColumn| runs().any(|run| (column.value)(run).is_some());
        // Beside the moment of the arm, that on the base is called what it is: what passes the wheel. Without a wheel both
        // are the same.
        let has_wheel = runs().any(|run| run.wheel_rate.is_some());
        let is_shown = |column: &SummaryColumn| {
            let is_of_these = moves || !OF_MOVING_BASE.contains(&column.key);
            has_value(column) && is_of_these && (has_wheel || column.key != "peak_base_moment")
        };
        let of_runs = SUMMARY_COLUMNS.iter().enumerate().filter(|(_, column)| is_shown(column));
        let of_runs = of_runs.map(|(at, column)| Self::past_wheel(at, column, notation, has_wheel));
        let designs = if comparison.has_designs() { &DESIGN_COLUMNS[..] } else { &[] };
        let of_designs = (SUMMARY_COLUMNS.len()..).zip(designs).map(|(at, column)| Self::of(at, column, notation));
        of_runs.chain(of_designs).collect()
    }

    /// Returns its unit as a title states it; empty for a ratio.
    pub fn unit(&self) -> &'static str {
        if self.format.unit == "1" { "" } else { self.format.unit }
    }

    /// Returns the value of a row in the unit on display, if it has one.
    pub fn value(&self, entry: &ComparisonEntry) -> Option<f64> {
        entry.value(self.at).map(|x| self.format.factor * x)
    }
}
