//! Text from outside: read from plain files of a bounded size, and shown so that it does nothing to a terminal.

use std::borrow::Cow;
use std::fs::{self, File, Metadata};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// The largest text that is read, bytes: a session of 100,000 edits has half of it.
pub const MOST_BYTES: u64 = 16 << 20;

/// Reads a text file: a plain one, of at most [`MOST_BYTES`].
///
/// # Errors
/// If it is none.
pub fn read(file: &Path) -> io::Result<String> {
    // To open a pipe would already wait for its other end.
    check(&fs::metadata(file)?, MOST_BYTES)?;
    let opened = File::open(file)?;
    check(&opened.metadata()?, MOST_BYTES)?;
    let mut text = String::new();
    // It may grow, and some files do not say how long they are.
    opened.take(MOST_BYTES + 1).read_to_string(&mut text)?;
    let length = text.len() as u64;
    if length > MOST_BYTES { Err(too_long(length)) } else { Ok(text) }
}

/// Refuses what is no plain file or too long.
///
/// # Errors
/// If it is refused.
pub fn check(file: &Metadata, most: u64) -> io::Result<()> {
    match file.len() {
        _ if file.is_dir() => Err(io::Error::new(ErrorKind::IsADirectory, "a folder")),
        _ if !file.is_file() => Err(io::Error::new(ErrorKind::InvalidInput, "a device or a pipe")),
        length if length > most => Err(too_long(length)),
        _ => Ok(()),
    }
}

fn too_long(length: u64) -> io::Error {
    io::Error::new(ErrorKind::FileTooLarge, format!("{length} bytes or more, where {MOST_BYTES} are the most"))
}

/// Text for a terminal: what would steer one, or turn the order of its letters, is spelled out.
pub fn plain(text: &str) -> Cow<'_, str> {
    if !text.contains(steers) {
        return text.into();
    }
    let mut plain = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if steers(c) { plain.extend(c.escape_default()) } else { plain.push(c) }
    }
    plain.into()
}

fn steers(c: char) -> bool {
    let turns = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    turns || c == '\u{feff}' || (c.is_control() && c != '\n')
}

/// Characters of a message, and of its end, that are kept of a long one.
const MOST_SAID: usize = 1600;
const END_SAID: usize = 400;

/// A message that is not too long to be read: of a longer one the middle is left out.
pub fn brief(text: &str) -> Cow<'_, str> {
    // No text has more characters than bytes.
    if text.len() <= MOST_SAID {
        return text.into();
    }
    let count = text.chars().count();
    if count <= MOST_SAID {
        return text.into();
    }
    let begin: String = text.chars().take(MOST_SAID - END_SAID).collect();
    let end: String = text.chars().skip(count - END_SAID).collect();
    format!("{begin} … ({} characters left out) … {end}", count - MOST_SAID).into()
}
