//! [`SignalChoice`]: which signals are taken, and at which times.

use clap::Args;
use stillbase_settings::number::fixed;
use stillbase_settings::range::quote_clipped;
use stillbase_simulation::signal_table::SignalTable;
use stillbase_simulation::signals::{group_of, is_name_of};

use super::failure::Failure;

/// Tolerance of the bounds of a time interval, s.
const TIME_TOLERANCE_S: f64 = 1e-9;

/// Options that choose signals and times; by default all.
#[derive(Args)]
pub struct SignalChoice {
    /// Only these signals, by name, such as torque/1, or by its first part, such as torque; default: all
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    signals: Vec<String>,
    /// Only rows from this time on, s
    #[arg(long, value_name = "T", value_parser = instant)]
    from: Option<f64>,
    /// Only rows up to this time, s
    #[arg(long, value_name = "T", value_parser = instant)]
    to: Option<f64>,
}

fn instant(text: &str) -> Result<f64, String> {
    let time = text.trim().parse().ok().filter(|time: &f64| time.is_finite() && *time >= 0.0);
    time.ok_or_else(|| "want a time in s, 0 or later".into())
}

impl SignalChoice {
    /// Refuses names that none of some signals has, and an interval that ends before it starts.
    ///
    /// # Errors
    /// If there is such a name, or if the interval is empty.
    pub fn check<'a>(&self, paths: impl Iterator<Item = &'a str> + Clone) -> Result<(), Failure> {
        require_known(&self.signals, paths).map_err(|why| why.with_context("--signals"))?;
        match (self.from, self.to) {
            (Some(from), Some(to)) if from > to => {
                Err(Failure::wrong_input(format!("--from {from} --to {to}: want the first before the second")))
            }
            _ => Ok(()),
        }
    }

    /// Returns whether a signal is taken.
    pub fn has_signal(&self, path: &str) -> bool {
        self.signals.is_empty() || self.signals.iter().any(|name| is_name_of(name, path))
    }

    /// Returns whether rows of a time, s, are taken.
    pub fn has_time(&self, time: f64) -> bool {
        let [from, to] = self.times();
        (from - TIME_TOLERANCE_S..=to + TIME_TOLERANCE_S).contains(&time)
    }

    /// Leaves in a table what is taken.
    ///
    /// # Errors
    /// If no row is left.
    pub fn apply(&self, table: &mut SignalTable) -> Result<(), Failure> {
        table.columns.retain(|column| self.has_signal(&column.path));
        let end = table.time.last().copied().unwrap_or_default();
        table.retain_times(|time| self.has_time(time));
        if table.time.is_empty() { Err(self.no_row(end)) } else { Ok(()) }
    }

    /// Returns the failure that no row of a run or a table that ends at a time, s, is taken.
    pub fn no_row(&self, end: f64) -> Failure {
        let ([from, to], end) = (self.times(), fixed(end, 3));
        Failure::wrong_input(format!("no step from {from} to {to} s: want an interval with one, within 0 to {end} s"))
    }

    /// Returns the first and the last time, s.
    fn times(&self) -> [f64; 2] {
        [self.from.unwrap_or(0.0), self.to.unwrap_or(f64::INFINITY)]
    }
}

/// Refuses names that none of some signals has.
///
/// # Errors
/// If there is such a name; the error lists the groups of the signals.
pub fn require_known<'a, 'n>(
    names: impl IntoIterator<Item = &'n String>,
    paths: impl Iterator<Item = &'a str> + Clone,
) -> Result<(), Failure> {
    let is_unknown = |name: &&String| !paths.clone().any(|path| is_name_of(name, path));
    let Some(name) = names.into_iter().find(is_unknown) else { return Ok(()) };
    let mut known: Vec<&str> = Vec::new();
    for group in paths.map(group_of) {
        if !known.contains(&group) {
            known.push(group);
        }
    }
    let (name, known) = (quote_clipped(name), known.join(", "));
    Err(Failure::wrong_input(format!("no signal {name:?}: want one of {known}, or one of their parts")))
}
