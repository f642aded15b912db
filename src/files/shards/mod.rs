//! Tolerance studies in files: CSV or Parquet with one row for each machine, or Parquet with one for each bin. Each file is a
//! shard of the machines of one study; shards can be merged. A header identifies the study, and a checksum covers every byte.

mod checksum;
mod control_sum;
mod error;
mod hash;
mod merge;
mod rows;
mod summary_file;

pub use error::ShardError;
pub use merge::merge;
pub use rows::{ShardHeader, StudyId, StudyPart, Writer};
pub use summary_file::{is_summary, merge_summaries, read_summary, write_summary};
