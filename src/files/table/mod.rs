//! Reads tables of other programs, CSV or Parquet: a [`Table`]. Columns are found by name and unit, and errors name file,
//! line or row, and column.
//!
//! | content | reader |
//! |---|---|
//! | a motion given by samples of the drive angles or of the end effector | [`samples()`] |
//! | measured motions of a built machine, with forces and moments on its base | [`motions`] |
//! | a motion or a measurement, distinguished by the columns | [`TableData`] |
//! | signals over time | [`signals()`] |

mod angle;
mod column;
pub(crate) mod columns;
mod error;
mod heads;
mod kind;
mod measured;
mod opened;
#[cfg(feature = "rows")]
mod parquet_table;
mod reader;
mod samples;
mod signals;

pub use error::TableError;
pub use kind::{TableData, orbit_motion};
pub use measured::{MAX_ROWS, motions};
pub use opened::{NoTable, TABLE_ENDINGS, Table, is_table};
#[cfg(feature = "rows")]
pub(crate) use parquet_table::parquet_columns;
pub use samples::{SampleTable, samples};
pub use signals::{has_signal_head, signals, signals_of};
