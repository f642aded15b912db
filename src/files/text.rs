//! Reads text from plain files of bounded size.

use std::cell::RefCell;
use std::fs::{self, File, Metadata};
use std::io::{self, ErrorKind, Read};
use std::path::Path;
use std::sync::OnceLock;

use stillbase_settings::text::MAX_TEXT_BYTES;

/// Name of standard input as a file.
pub const STANDARD_INPUT: &str = "-";

/// What standard input held, or why it could not be read.
static INPUT: OnceLock<Result<String, (ErrorKind, String)>> = OnceLock::new();

thread_local! {
    /// Text that takes the place of standard input on this thread.
    static GIVEN: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Calls a function for which a text takes the place of standard input on this thread.
pub fn with_standard_input<T>(text: String, call: impl FnOnce() -> T) -> T {
    let _given = Given(GIVEN.replace(Some(text)));
    call()
}

/// Puts back what stood in the place of standard input before, also after a panic.
struct Given(Option<String>);

impl Drop for Given {
    fn drop(&mut self) {
        GIVEN.set(self.0.take());
    }
}

/// Returns all of standard input, at most [`MAX_TEXT_BYTES`]; it is read once.
///
/// # Errors
/// If it is longer, or cannot be read.
fn standard_input() -> io::Result<String> {
    if let Some(given) = GIVEN.with_borrow(Clone::clone) {
        return Ok(given);
    }
    let read = || {
        let mut text = String::new();
        let read = io::stdin().lock().take(MAX_TEXT_BYTES + 1).read_to_string(&mut text);
        let length = text.len() as u64;
        match read {
            Ok(_) if length > MAX_TEXT_BYTES => Err(too_long(length, MAX_TEXT_BYTES)),
            read => read.map(|_| text),
        }
        .map_err(|e| (e.kind(), e.to_string()))
    };
    INPUT.get_or_init(read).clone().map_err(|(kind, why)| io::Error::new(kind, why))
}

/// Reads a plain text file of at most [`MAX_TEXT_BYTES`], or standard input as `-`.
///
/// # Errors
/// If it is not such a file, or cannot be read.
pub fn read(file: &Path) -> io::Result<String> {
    if file.as_os_str() == STANDARD_INPUT {
        return standard_input();
    }
    read_at_most(file, MAX_TEXT_BYTES)
}

/// Reads a plain text file of at most `most` bytes.
///
/// # Errors
/// If it is not such a file, or cannot be read.
pub fn read_at_most(file: &Path, most: u64) -> io::Result<String> {
    let opened = open(file, most)?;
    let mut text = String::new();
    // The length is limited again here, because the file may grow, and some files report no length.
    opened.take(most + 1).read_to_string(&mut text)?;
    let length = text.len() as u64;
    if length > most { Err(too_long(length, most)) } else { Ok(text) }
}

/// Opens a plain file of at most `most` bytes.
///
/// # Errors
/// If it is not such a file, or cannot be opened.
pub fn open(file: &Path, most: u64) -> io::Result<File> {
    // Opening a pipe would block until its other end is opened.
    check(&fs::metadata(file)?, most)?;
    let opened = File::open(file)?;
    check(&opened.metadata()?, most)?;
    Ok(opened)
}

/// Checks that a file is a plain file of at most `most` bytes.
///
/// # Errors
/// If it is not.
pub fn check(file: &Metadata, most: u64) -> io::Result<()> {
    match file.len() {
        _ if file.is_dir() => Err(io::Error::new(ErrorKind::IsADirectory, "a folder")),
        _ if !file.is_file() => Err(io::Error::new(ErrorKind::InvalidInput, "a device or a pipe")),
        length if length > most => Err(too_long(length, most)),
        _ => Ok(()),
    }
}

/// Maximum number of entries of a folder that are read.
const MAX_ENTRIES: usize = 10_000;

/// Returns the names in a folder in order, as far as they are text; none if it cannot be read.
pub fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().take(MAX_ENTRIES);
    let mut names: Vec<String> = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect();
    names.sort();
    names
}

fn too_long(length: u64, most: u64) -> io::Error {
    io::Error::new(ErrorKind::FileTooLarge, format!("{length} bytes or more, where {most} are the most"))
}
