//! Standard output: one JSON object, or a table. Standard error: messages.

use std::borrow::Cow;
use std::fmt::{self, Display};
use std::io::{self, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::Serialize;
use serde_json::ser::Formatter;
use stillbase_files::{check_new, is_standard, write_new};
use stillbase_session::Refusal;
use stillbase_settings::text::plain;

use super::exit::{is_quiet, print_message};
use super::failure::Failure;
use super::file_form::FileForm;
use super::in_process::{is_in_process, take};

/// Whether a file takes standard output.
static IS_TAKEN: AtomicBool = AtomicBool::new(false);

/// Whether an answer was printed as JSON.
static HAS_ANSWERED: AtomicBool = AtomicBool::new(false);

/// Returns whether an answer was printed as JSON; a failure after it prints no second object.
pub fn has_answered() -> bool {
    HAS_ANSWERED.load(Ordering::Relaxed)
}

/// Forgets what an earlier command of this process has printed.
pub(super) fn begin() {
    [&IS_TAKEN, &HAS_ANSWERED].into_iter().for_each(|flag| flag.store(false, Ordering::Relaxed));
}

/// Output format of a command.
#[derive(clap::Args)]
pub struct Format {
    /// Print one JSON object, in SI units and radians, instead of a table
    #[arg(long)]
    pub json: bool,
}

impl Format {
    /// Does the same as [`check_output`], but also takes `-` for standard output, which gets the first of the formats.
    /// What the command has to say besides then goes to standard error.
    ///
    /// # Errors
    /// As [`check_output`], and if JSON is to go there, too.
    pub fn check_output(&self, file: &Path, force: bool, endings: &[&'static str]) -> Result<&'static str, Failure> {
        FileForm::default().check(self, Some(file), force, endings)
    }

    /// Prints an answer as JSON, or as the text that `human` returns for it.
    ///
    /// # Errors
    /// If the answer cannot be written, or contains a number that is not finite.
    pub fn print<T: Serialize>(&self, answer: &T, human: impl FnOnce(&T) -> String) -> Result<(), Failure> {
        // The JSON is made in both cases, because that detects numbers that are not finite.
        let json = json(answer)?;
        let is_taken = IS_TAKEN.load(Ordering::Relaxed);
        // Another program takes only what it can read.
        if take(|said| said.json = Some(json.clone()).filter(|_| self.json)).is_some() {
            return Ok(());
        }
        let text = if self.json { json } else { plain(&human(answer)).into_owned() };
        if is_taken {
            if !is_quiet() {
                // When standard error is closed, there is no place for the answer.
                let _ = io::stderr().write_all(text.as_bytes());
            }
            return Ok(());
        }
        HAS_ANSWERED.fetch_or(self.json, Ordering::Relaxed);
        let mut out = io::stdout().lock();
        out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(|e| Failure::standard_output(&e))
    }
}

/// A formatter that refuses infinity and NaN, which JSON cannot state. Written as `null` they would go unnoticed.
struct FiniteOnly;

impl Formatter for FiniteOnly {
    fn write_null<W: ?Sized + Write>(&mut self, _: &mut W) -> io::Result<()> {
        Err(io::Error::other("a result is not a finite number: want smaller input"))
    }
}

fn json(answer: &impl Serialize) -> Result<String, Failure> {
    let mut text = Vec::new();
    let mut serializer = serde_json::Serializer::with_formatter(&mut text, FiniteOnly);
    answer.serialize(&mut serializer).map_err(Failure::wrong_input)?;
    let mut text = String::from_utf8(text).map_err(Failure::wrong_input)?;
    text.push('\n');
    // JSON escapes most characters that control a terminal; the others can only be in strings.
    Ok(match plain(&text) {
        Cow::Borrowed(_) => text,
        Cow::Owned(_) => text.chars().map(spelled).collect(),
    })
}

/// Escapes a character for JSON if it controls a terminal.
fn spelled(c: char) -> String {
    let mut own = [0; 4];
    match plain(c.encode_utf8(&mut own)) {
        Cow::Borrowed(same) => same.into(),
        Cow::Owned(_) => format!("\\u{:04x}", u32::from(c)),
    }
}

/// Returns `yes` or `no`.
pub fn yes(is_so: bool) -> &'static str {
    if is_so { "yes" } else { "no" }
}

/// A table with aligned columns: the first to the left, numbers to the right.
pub struct TextTable {
    rows: Vec<Vec<String>>,
    /// Index of a further column that is aligned to the left.
    words: Option<usize>,
}

impl TextTable {
    /// Returns a table with a head; the unit of each column follows its name.
    pub fn new<S: Into<String>>(head: impl IntoIterator<Item = S>) -> Self {
        Self { rows: vec![head.into_iter().map(Into::into).collect()], words: None }
    }

    /// Aligns a column of words to the left.
    #[must_use]
    pub fn with_words(self, column: usize) -> Self {
        Self { words: Some(column), ..self }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        // A name may contain line breaks, but a row is one line.
        let line = |cell: String| if cell.contains('\n') { cell.replace('\n', "\\n") } else { cell };
        self.rows.push(cells.into_iter().map(line).map(|cell| plain(&cell).into_owned()).collect());
    }
}

impl Display for TextTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let width = |c: usize| self.rows.iter().filter_map(|r| r.get(c)).map(|s| s.chars().count()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..self.rows.iter().map(Vec::len).max().unwrap_or(0)).map(width).collect();
        for row in &self.rows {
            let mut line = String::new();
            for (c, (cell, &width)) in row.iter().zip(&widths).enumerate() {
                match c {
                    0 => line.push_str(&format!("{cell:<width$}")),
                    _ if self.words == Some(c) => line.push_str(&format!("   {cell:<width$}")),
                    _ => line.push_str(&format!("   {cell:>width$}")),
                }
            }
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }
}

/// Checks the name of an output file as [`check_new`] does, and its ending. Returns the ending.
///
/// # Errors
/// If [`check_new`] refuses the file, or its ending is not allowed; the error names the allowed endings.
pub fn check_output(file: &Path, force: bool, endings: &[&'static str]) -> Result<&'static str, Failure> {
    check_new(file, force)?;
    let own = file.extension().unwrap_or_default();
    endings.iter().copied().find(|ending| own.eq_ignore_ascii_case(ending)).ok_or_else(|| {
        let endings: Vec<String> = endings.iter().map(|ending| format!(".{ending}")).collect();
        Failure::wrong_input(format!("want a name that ends in {}", endings.join(" or "))).with_context(file.display())
    })
}

/// Sends what the command has to say besides a file on standard output to standard error.
pub fn take_standard_output() {
    IS_TAKEN.store(true, Ordering::Relaxed);
}

/// Writes the content of a new file, and says so, or writes it to standard output.
///
/// # Errors
/// If it cannot be written.
pub fn write_file(file: &Path, content: &[u8], force: bool) -> Result<(), Failure> {
    if is_standard(file) && take(|said| said.file = Some(content.to_vec())).is_some() {
        return Ok(());
    }
    write_new(file, content, force)?;
    say_written(file);
    Ok(())
}

/// Returns what a file is called in an answer.
#[cfg(feature = "ui")]
pub fn file_words(file: &Path) -> String {
    if is_standard(file) { "standard output".into() } else { file.display().to_string() }
}

/// Says that a file is written, unless it is standard output, or another program asks, which names the file itself.
pub fn say_written(file: &Path) {
    if !is_standard(file) && !is_in_process() {
        print_message(format!("wrote {}", file.display()));
    }
}

/// Maximum size of an output, bytes; a request for a larger one is probably a mistake.
const MAX_BYTES: f64 = 4e9;
/// Maximum size of an output that is held in memory as a whole, bytes.
const MAX_HELD_BYTES: f64 = 1e9;
/// Maximum size of a number, bytes.
const MAX_BYTES_PER_NUMBER: f64 = 20.0;

/// Refuses a table of numbers that would be too large. `held` says whether the whole table is held in memory.
///
/// # Errors
/// If the table would be too large.
pub fn check_size(rows: u64, columns: usize, held: bool) -> Result<(), Refusal> {
    let bytes = rows as f64 * columns as f64 * MAX_BYTES_PER_NUMBER;
    let most = if held { MAX_HELD_BYTES } else { MAX_BYTES };
    if bytes <= most { Ok(()) } else { Err(Refusal::TooLarge { rows, columns, bytes, most }) }
}
