//! A table of a page.

use super::markup::escaped;

/// A table: the first column and columns of words to the left, numbers to the right.
pub struct PageTable {
    heads: Vec<String>,
    /// Number of columns of words at the left.
    words: usize,
    rows: Vec<Vec<String>>,
}

impl PageTable {
    /// Returns a table with its heads, the first `words` of which stand over words.
    pub fn new<S: Into<String>>(words: usize, heads: impl IntoIterator<Item = S>) -> Self {
        Self { heads: heads.into_iter().map(Into::into).collect(), words, rows: Vec::new() }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// Returns the element, or nothing if there is no row.
    pub fn html(&self) -> String {
        if self.rows.is_empty() {
            return String::new();
        }
        let class = |i: usize| if i < self.words { "" } else { " class=\"number\"" };
        let line = |tag: &str, cells: &[String]| {
            let cells = cells.iter().enumerate();
            let cells: String =
                cells.map(|(i, cell)| format!("<{tag}{}>{}</{tag}>", class(i), escaped(cell))).collect();
            format!("<tr>{cells}</tr>\n")
        };
        let head = if self.heads.iter().all(String::is_empty) { String::new() } else { line("th", &self.heads) };
        let rows: String = self.rows.iter().map(|row| line("td", row)).collect();
        format!("<table>\n<thead>{head}</thead>\n<tbody>\n{rows}</tbody>\n</table>\n")
    }
}
