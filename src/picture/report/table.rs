//! A table of a page.

use super::markup::escaped;

/// Tables of at most this many columns are narrow.
const MAX_NARROW_COLUMNS: usize = 6;

/// What stands where there is no value.
pub const NO_VALUE: &str = "–";

/// A table: names and words to the left, numbers to the right.
pub struct PageTable {
    heads: Vec<String>,
    /// Number of columns of names at the left, which may be numbers.
    names: usize,
    rows: Vec<Vec<String>>,
}

impl PageTable {
    /// Returns a table with these heads; the first `names` columns hold names.
    pub fn new<S: Into<String>>(names: usize, heads: impl IntoIterator<Item = S>) -> Self {
        Self { heads: heads.into_iter().map(Into::into).collect(), names, rows: Vec::new() }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// Returns the HTML element, or an empty string if there is no row.
    pub fn html(&self) -> String {
        if self.rows.is_empty() {
            return String::new();
        }
        let column = |i: usize| self.rows.iter().filter_map(move |row| row.get(i).map(String::as_str));
        let is_number = |cell: &str| cell.parse::<f64>().is_ok();
        let has_numbers = |i: usize| {
            i >= self.names
                && column(i).any(is_number)
                && column(i).all(|cell| is_number(cell) || ["", NO_VALUE].contains(&cell))
        };
        let classes: Vec<&str> =
            (0..self.heads.len()).map(|i| if has_numbers(i) { " class=\"number\"" } else { "" }).collect();
        let line = |tag: &str, cells: &[String]| {
            let cells = cells.iter().zip(&classes);
            let cells: String = cells.map(|(cell, class)| format!("<{tag}{class}>{}</{tag}>", escaped(cell))).collect();
            format!("<tr>{cells}</tr>\n")
        };
        let head = if self.heads.iter().all(String::is_empty) { String::new() } else { line("th", &self.heads) };
        let rows: String = self.rows.iter().map(|row| line("td", row)).collect();
        // Narrow tables stand beside each other.
        let class = if self.heads.len() <= MAX_NARROW_COLUMNS { " class=\"side\"" } else { "" };
        format!("<table{class}>\n<thead>{head}</thead>\n<tbody>\n{rows}</tbody>\n</table>\n")
    }
}
