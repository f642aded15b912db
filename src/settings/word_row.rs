//! [`WordRow`]: a key of a file in words; [`WordTable`]: all keys of a kind of file.

use super::key_path::{KeyPath, KeyStep};
use super::mending::Meant;
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

/// Words that people write in a table instead of its keys: the path of the table, empty for the whole file, the words, and
/// what they mean.
pub type MeantRow = (&'static str, &'static [&'static str], Meant);

/// The keys of a kind of file in words.
#[derive(Clone, Copy, Debug)]
pub struct WordTable {
    /// The keys.
    pub rows: &'static [WordRow],
    /// What people write instead.
    pub meant: &'static [MeantRow],
}

impl WordTable {
    /// Returns the row of a place.
    pub fn row(&self, path: &KeyPath) -> Option<&'static WordRow> {
        WordRow::of(self.rows, path)
    }

    /// Returns the plain name of a place.
    pub fn name(&self, path: &KeyPath) -> Option<String> {
        self.row(path).map(|row| row.name_at(path))
    }

    /// Returns what would be right at a place; `None` if its row does not say so.
    pub fn want(&self, path: &KeyPath) -> Option<String> {
        self.row(path).map(|row| row.want.to_owned()).filter(|want| !want.is_empty())
    }

    /// Returns a value that would be right at a place, in TOML; `None` if its row has none.
    pub fn example(&self, path: &KeyPath) -> Option<&'static str> {
        self.row(path).map(|row| row.example).filter(|example| !example.is_empty())
    }

    /// Returns what people mean by a word that is no key of its table.
    pub fn meant(&self, path: &KeyPath) -> Option<Meant> {
        let (word, table) = (path.last_key()?.to_lowercase(), path.parent()?);
        let is_of = |pattern: &str| if pattern.is_empty() { table.0.is_empty() } else { table.fits(pattern) };
        let found = self.meant.iter().find(|(pattern, words, _)| is_of(pattern) && words.contains(&word.as_str()));
        found.map(|(.., meant)| *meant)
    }
}
