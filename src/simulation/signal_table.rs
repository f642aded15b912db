//! [`SignalTable`]: signals over time, as a run gives them or as a file holds them.

use crate::signals::Signal;

/// Signals over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SignalTable {
    /// Time of each row, s, increasing.
    pub time: Vec<f64>,
    /// The signals.
    pub columns: Vec<SignalColumn>,
}

/// One signal over time.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalColumn {
    /// Path of the signal, such as `torque/1`.
    pub path: String,
    /// Its unit, `1` for none.
    pub unit: String,
    /// Its value in each row.
    pub values: Vec<f64>,
}

impl SignalTable {
    /// Returns a table of some signals without rows.
    pub fn of(signals: &[Signal]) -> Self {
        let column = |signal: &Signal| SignalColumn {
            path: signal.path.clone(),
            unit: signal.unit.to_owned(),
            values: Vec::new(),
        };
        Self { time: Vec::new(), columns: signals.iter().map(column).collect() }
    }

    /// Appends a row: a time, s, and the value of each signal.
    pub fn push(&mut self, time: f64, values: impl Iterator<Item = f64>) {
        self.time.push(time);
        self.columns.iter_mut().zip(values).for_each(|(column, value)| column.values.push(value));
    }

    /// Returns the signal with a path.
    pub fn column(&self, path: &str) -> Option<&SignalColumn> {
        self.columns.iter().find(|column| column.path == path)
    }

    /// Leaves the rows of some times, s.
    pub fn retain_times(&mut self, is_kept: impl Fn(f64) -> bool) {
        let kept: Vec<bool> = self.time.iter().map(|time| is_kept(*time)).collect();
        for values in self.columns.iter_mut().map(|column| &mut column.values).chain([&mut self.time]) {
            let mut kept = kept.iter();
            values.retain(|_| kept.next().is_some_and(|kept| *kept));
        }
    }

    /// Returns time and signals as heads of columns: the name and the unit of each.
    pub fn heads(&self) -> Vec<String> {
        let heads = self.columns.iter().map(|column| format!("{} {}", column.path, column.unit));
        ["time s".to_owned()].into_iter().chain(heads).collect()
    }

    /// Returns the numbers of a row: the time and the value of each signal.
    pub fn row(&self, row: usize) -> impl Iterator<Item = f64> + '_ {
        [self.time[row]].into_iter().chain(self.columns.iter().map(move |column| column.values[row]))
    }
}
