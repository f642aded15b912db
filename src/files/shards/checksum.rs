//! The checksum of a file of samples, over all its bytes. It is part of the text that identifies the study. While it is
//! computed, zeros replace its digits.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

use super::hash::Checksum;
use crate::{NewFile, WriteError};

/// The text before the checksum.
pub const CHECKSUM_PREFIX: &str = " check ";

/// Placeholder of the checksum.
pub const CHECKSUM_BLANK: &str = "0000000000000000";

const DIGITS: u64 = CHECKSUM_BLANK.len() as u64;

/// The end of a file at which its checksum is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChecksumPlace {
    /// The first bytes.
    Head,
    /// The last bytes.
    Tail,
}

/// The checksum is within this number of bytes from the start (head) or the end (tail) of the file.
const SEARCHED_BYTES: u64 = 1 << 16;

/// Finds the checksum among the bytes at an end, and returns the offset of its digits and its value. Names of columns
/// may look like a checksum, but are further from that end.
fn find(bytes: &[u8], end: ChecksumPlace) -> Option<(u64, u64)> {
    let before = CHECKSUM_PREFIX.as_bytes();
    let digits = |at: usize| {
        let text = bytes.get(at..at + CHECKSUM_BLANK.len())?;
        // Only lower-case digits are accepted, so that each value has one spelling and every changed bit is noticed.
        let spelled = text.iter().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'));
        u64::from_str_radix(std::str::from_utf8(text).ok().filter(|_| spelled)?, 16).ok()
    };
    let found = |(i, window): (usize, &[u8])| {
        let at = i + before.len();
        (window == before).then(|| Some((at as u64, digits(at)?)))?
    };
    let mut windows = bytes.windows(before.len()).enumerate();
    if end == ChecksumPlace::Head { windows.find_map(found) } else { windows.rev().find_map(found) }
}

/// A file that is being written; its checksum is filled in when it is finished.
pub struct CheckedFile {
    out: NewFile,
    sum: Checksum,
    /// The first bytes written.
    head: Vec<u8>,
}

impl CheckedFile {
    /// Starts with a file to which nothing has been written.
    pub fn new(out: NewFile) -> Self {
        Self { out, sum: Checksum::new(), head: Vec::new() }
    }

    /// Returns the requested path.
    pub fn path(&self) -> &Path {
        self.out.path()
    }

    /// Writes the checksum and gives the file its final name.
    ///
    /// # Errors
    /// If not everything could be written.
    pub fn finish(mut self, end: ChecksumPlace) -> Result<(), WriteError> {
        if let Err(source) = self.write_checksum(end) {
            return Err(WriteError::Failed { file: self.out.path().into(), source });
        }
        self.out.finish()
    }

    fn write_checksum(&mut self, end: ChecksumPlace) -> io::Result<()> {
        let (from, bytes) = match end {
            ChecksumPlace::Head => (0, std::mem::take(&mut self.head)),
            ChecksumPlace::Tail => self.out.tail(SEARCHED_BYTES)?,
        };
        let (place, _) = find(&bytes, end).ok_or_else(|| io::Error::other("no place for its checksum"))?;
        self.out.replace(from + place, format!("{:016x}", self.sum.total()).as_bytes())
    }
}

impl Write for CheckedFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.out.write(bytes)?;
        self.sum.add(&bytes[..count]);
        let room = (SEARCHED_BYTES as usize).saturating_sub(self.head.len()).min(count);
        self.head.extend_from_slice(&bytes[..room]);
        Ok(count)
    }
    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// Returns whether the checksum at an end of a file matches its bytes; `None` if there is no checksum.
///
/// # Errors
/// If the file cannot be read.
pub fn verify(file: &mut File, end: ChecksumPlace) -> io::Result<Option<bool>> {
    let length = file.metadata()?.len();
    let from = if end == ChecksumPlace::Head { 0 } else { length.saturating_sub(SEARCHED_BYTES) };
    file.seek(SeekFrom::Start(from))?;
    let mut near = Vec::new();
    file.take(SEARCHED_BYTES).read_to_end(&mut near)?;
    let Some((place, stored)) = find(&near, end) else { return Ok(None) };
    let place = from + place;
    file.seek(SeekFrom::Start(0))?;
    let (mut sum, mut block, mut at) = (Checksum::new(), vec![0; 1 << 18], 0_u64);
    loop {
        let count = match file.read(&mut block) {
            Ok(0) => return Ok(Some(sum.total() == stored)),
            Ok(count) => count,
            Err(e) if e.kind() == io::ErrorKind::Interrupted => continue,
            Err(e) => return Err(e),
        };
        for i in place.max(at)..(place + DIGITS).min(at + count as u64) {
            block[(i - at) as usize] = b'0';
        }
        sum.add(&block[..count]);
        at += count as u64;
    }
}
