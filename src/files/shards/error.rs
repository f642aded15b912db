//! [`ShardError`]: the reason why a shard cannot be read or written.

use std::fmt::Display;
use std::path::Path;

use thiserror::Error;

use crate::WriteError;

/// The reason why a shard cannot be read or written, or why shards do not form one study.
#[derive(Debug, Error)]
pub enum ShardError {
    /// A file has unexpected content; the text says what was expected.
    #[error("{0}")]
    Wrong(String),
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// Makes the error for a file; its message begins with the path.
pub(super) fn shard_error(file: &Path, why: impl Display) -> ShardError {
    ShardError::Wrong(format!("{}: {why}", file.display()))
}
