//! Tolerance studies in files, CSV or Parquet: one row a machine, each file a shard of the machines of one study, and
//! the merging of shards. A header identifies the study, and a checksum covers every byte.

mod checksum;
mod error;
mod hash;
mod merge;
mod rows;

pub use error::ShardError;
pub use merge::merge;
pub use rows::{ShardHeader, StudyId, StudyPart, Writer};
