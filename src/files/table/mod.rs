//! Reads motions from CSV tables of other programs. Columns are found by name and unit, and errors name file, line and
//! column.
//!
//! | content | reader |
//! |---|---|
//! | a motion given by samples of the drive angles or of the end effector | [`samples()`] |
//! | measured motions of a built machine, with forces and moments on its base | [`motions`] |
//! | a motion or a measurement, distinguished by the columns | [`TableData`] |
//! | signals over time | [`signals()`] |

mod angle;
mod column;
mod error;
mod kind;
mod measured;
mod reader;
mod samples;
mod signals;

pub use error::TableError;
pub use kind::TableData;
pub use measured::{MAX_ROWS, motions};
pub use samples::{SampleTable, samples};
pub use signals::signals;
