//! Tests of `src/files`: tables of numbers that others wrote, and shards of studies. What the program writes is tried in `program`.

#[cfg(feature = "cli")]
mod shards;
#[cfg(feature = "cli")]
mod signals;
#[cfg(feature = "cli")]
mod summaries;
mod table;
