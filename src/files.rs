//! Writing files so that nothing is lost: never over another without being told to, and never half.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use thiserror::Error;

/// Why a file was not written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// It is there already.
    #[error("{} exists: want another name, or --force to replace it", .0.display())]
    Exists(PathBuf),
    /// The file system.
    #[error("{}: {source}", file.display())]
    Failed {
        /// The file.
        file: PathBuf,
        /// Why.
        source: io::Error,
    },
}

/// Refuses a file that exists, unless forced.
///
/// # Errors
/// If it exists.
pub fn check_new(file: &Path, force: bool) -> Result<(), WriteError> {
    if !force && file.exists() { Err(WriteError::Exists(file.into())) } else { Ok(()) }
}

/// Where a file is written before it takes its name.
pub fn beside(file: &Path) -> PathBuf {
    let mut name = file.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.part", std::process::id()));
    file.with_file_name(name)
}

/// Writes a whole file, or leaves everything as it was.
///
/// # Errors
/// If it exists and is not to be replaced, or cannot be written.
pub fn write_new(file: &Path, bytes: &[u8], force: bool) -> Result<(), WriteError> {
    check_new(file, force)?;
    let part = beside(file);
    let written = std::fs::File::create(&part)
        .and_then(|mut f| f.write_all(bytes).and_then(|()| f.sync_all()))
        .and_then(|()| std::fs::rename(&part, file));
    written.map_err(|source| {
        // What could not be finished is not left behind; that it could not is what matters.
        let _ = std::fs::remove_file(&part);
        WriteError::Failed { file: file.into(), source }
    })
}

/// `name.ending`, or `name-1.ending` and so on, whichever is free in the current folder.
pub fn free_name(name: &str, ending: &str) -> PathBuf {
    let numbered = (1..1000).map(|i| PathBuf::from(format!("{name}-{i}.{ending}")));
    std::iter::once(PathBuf::from(format!("{name}.{ending}")))
        .chain(numbered)
        .find(|p| !p.exists())
        .unwrap_or_else(|| PathBuf::from(format!("{name}-{}.{ending}", std::process::id())))
}
