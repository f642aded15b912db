//! [`FileStamp`]: tells whether a file has changed without reading it.

use std::path::Path;
use std::time::SystemTime;

/// Time of the last change of a file, and its size, bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileStamp(SystemTime, u64);

impl FileStamp {
    /// Returns the stamp of a file; `None` if the file cannot be found, or if its system keeps no times.
    pub fn of(path: &Path) -> Option<Self> {
        let found = std::fs::metadata(path).ok()?;
        Some(Self(found.modified().ok()?, found.len()))
    }
}
