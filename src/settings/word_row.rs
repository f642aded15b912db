//! [`WordRow`]: a key of a file in words.

use super::key_path::{KeyPath, KeyStep};
use super::range::quote_clipped;

/// A key of a file in words; `*` stands for the name or number of one of several.
#[derive(Clone, Copy, Debug)]
pub struct WordRow {
    /// Its path, as in `link.*.mass`.
    pub path: &'static str,
    /// Plain name, with `*` for the name or number.
    pub name: &'static str,
    /// What would be right; empty for a key whose range says so.
    pub want: &'static str,
    /// A value that would be right, in TOML; empty if there is none in general.
    pub example: &'static str,
}

/// Makes a row of a table, in which it is one line.
pub const fn row(path: &'static str, name: &'static str, want: &'static str, example: &'static str) -> WordRow {
    WordRow { path, name, want, example }
}

impl WordRow {
    /// Returns the row of a place.
    pub fn of<'a>(rows: &'a [Self], path: &KeyPath) -> Option<&'a Self> {
        rows.iter().find(|row| path.fits(row.path))
    }

    /// Returns the plain name of a place that fits its path.
    pub fn name_at(&self, path: &KeyPath) -> String {
        let at = self.path.split('.').position(|word| word == "*");
        match at.and_then(|at| path.0.get(at)) {
            Some(KeyStep::Key(name) | KeyStep::Named(_, name)) => self.name.replacen('*', &quote_clipped(name), 1),
            Some(KeyStep::At(i)) => self.name.replacen('*', &(i + 1).to_string(), 1),
            None => self.name.to_owned(),
        }
    }
}
