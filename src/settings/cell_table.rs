//! [`CellTable`]: a small table of words and numbers, which becomes a file of its own.

use super::text::sheet_cell;

/// A table of words and numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CellTable {
    /// What a row is, in one word.
    pub row: &'static str,
    /// Lines about the table, without line breaks.
    pub about: Vec<String>,
    /// Names of the columns, with units.
    pub head: Vec<String>,
    /// Cells, row by row, as many as the head has.
    pub rows: Vec<Vec<Cell>>,
}

/// A cell of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A text.
    Words(String),
    /// A number.
    Number(f64),
    /// Nothing.
    Empty,
}

impl Cell {
    /// Returns the cell of a text.
    pub fn words(text: impl Into<String>) -> Self {
        Self::Words(text.into())
    }
}

impl CellTable {
    /// Returns whether a column holds words, rather than numbers alone.
    pub fn has_words(&self, column: usize) -> bool {
        self.rows.iter().any(|row| matches!(row.get(column), Some(Cell::Words(_))))
    }

    /// Returns the table as CSV below its lines, each of which begins with `#`. Numbers have all digits and zero has no
    /// sign. No text is one that a spreadsheet takes for a formula.
    pub fn csv(&self) -> String {
        let mut text = String::new();
        for line in &self.about {
            text += &format!("# {}\n", line.replace(['\n', '\r'], " "));
        }
        let head = self.head.iter().map(|name| quoted(name));
        let rows = self.rows.iter().map(|row| row.iter().map(csv_cell).collect::<Vec<_>>().join(","));
        for line in [head.collect::<Vec<_>>().join(",")].into_iter().chain(rows) {
            text += &line;
            text.push('\n');
        }
        text
    }
}

fn csv_cell(cell: &Cell) -> String {
    match cell {
        Cell::Words(text) => quoted(text),
        Cell::Number(x) => (x + 0.0).to_string(),
        Cell::Empty => String::new(),
    }
}

/// Returns a text as a cell, quoted if it contains what separates cells.
fn quoted(text: &str) -> String {
    let cell = sheet_cell(text);
    match cell.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", cell.replace('"', "\"\"")),
        false => cell.into_owned(),
    }
}
