//! Text read from plain files of a bounded size.

use std::fs::{self, File, Metadata};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

use crate::settings::text::MOST_BYTES;

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
