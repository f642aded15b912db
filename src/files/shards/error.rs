//! [`ShardError`]: why a shard cannot be read or written.

use std::fmt::Display;
use std::path::Path;

use thiserror::Error;

use crate::files::WriteError;

/// Why a shard cannot be read or written, or shards are not one study.
#[derive(Debug, Error)]
pub enum ShardError {
    /// What is wrong, by file, and what was expected.
    #[error("{0}")]
    Wrong(String),
    /// It cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// That something is wrong with a file.
pub(super) fn wrong(file: &Path, why: impl Display) -> ShardError {
    ShardError::Wrong(format!("{}: {why}", file.display()))
}
