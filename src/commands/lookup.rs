//! [`Lookup`]: rows of a dictionary, found by words, as a list, a page of the guide or JSON.

use std::fmt::Write as _;

use clap::Args;
use serde::Serialize;
use stillbase_settings::range::quote_clipped;

use super::failure::Failure;
use super::output::Format;

/// Options of a search.
#[derive(Args)]
pub struct Lookup {
    /// Only what has all of these words in its name, such as link.5.com, or in its description, such as Hz
    #[arg(value_name = "WORD")]
    words: Vec<String>,
    /// Print a page of documentation in Markdown
    #[arg(long, conflicts_with = "json")]
    markdown: bool,
    #[command(flatten)]
    format: Format,
}

/// A row of a dictionary.
pub trait DictionaryRow {
    /// Returns the part of the dictionary to which it belongs.
    fn part(&self) -> &'static str;
    /// Returns whether it has a word, in lower case, in its name or its description.
    fn matches(&self, word: &str) -> bool;
    /// Returns it as lines of a list: the first one, and those below it.
    fn lines(&self) -> Vec<String>;
    /// Returns it as cells of a table.
    fn cells(&self) -> Vec<String>;
}

/// A page of documentation.
pub struct Page {
    /// Title and text above the tables.
    pub text: String,
    /// Heads of the columns.
    pub heads: &'static [&'static str],
}

impl Lookup {
    /// Returns the rows that have all of the words; `what` and `command` name them and what lists all.
    ///
    /// # Errors
    /// If there are none.
    pub fn found<R: DictionaryRow>(
        &self,
        all: impl Iterator<Item = R>,
        (what, command): (&str, &str),
    ) -> Result<Vec<R>, Failure> {
        let sought: Vec<String> = self.words.iter().flat_map(|w| w.split_whitespace()).map(str::to_lowercase).collect();
        let rows: Vec<R> = all.filter(|row| sought.iter().all(|word| row.matches(word))).collect();
        match rows.is_empty() {
            false => Ok(rows),
            true => {
                let words = quote_clipped(&sought.join(" "));
                let why = format!("no {what} has {words:?} in name or description: `stillbase {command}` prints all");
                Err(Failure::no_answer(why))
            }
        }
    }

    /// Prints an answer; `rows` returns its rows.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn print<A: Serialize, R: DictionaryRow>(
        &self,
        answer: &A,
        rows: impl Fn(&A) -> &[R],
        page: &Page,
    ) -> Result<(), Failure> {
        self.format
            .print(answer, |answer| if self.markdown { markdown(rows(answer), page) } else { list(rows(answer)) })
    }
}

/// Formats rows part by part, each with its meaning below.
fn list<R: DictionaryRow>(rows: &[R]) -> String {
    let mut text = String::new();
    for rows in parts(rows) {
        let _ = writeln!(text, "{}{}\n", if text.is_empty() { "" } else { "\n" }, rows[0].part());
        for row in rows {
            for (i, line) in row.lines().iter().enumerate() {
                let _ = writeln!(text, "{}{line}", if i == 0 { "  " } else { "      " });
            }
        }
    }
    text
}

/// Formats the page of the guide.
fn markdown<R: DictionaryRow>(rows: &[R], page: &Page) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let heads: Vec<String> = page.heads.iter().map(|head| (*head).to_owned()).collect();
    let mut text = page.text.clone();
    for rows in parts(rows) {
        let _ = write!(text, "\n## {}\n\n{}|{}\n", rows[0].part(), line(&heads), "---|".repeat(heads.len()));
        rows.iter().for_each(|row| text += &line(&row.cells()));
    }
    text
}

/// Returns the rows of each part; none is empty.
fn parts<R: DictionaryRow>(rows: &[R]) -> impl Iterator<Item = &[R]> {
    rows.chunk_by(|a, b| a.part() == b.part())
}

/// Returns words that separate no cells of a table.
pub fn cell(words: &str) -> String {
    words.replace('|', "\\|")
}
