//! Tables of numbers from other programs, as CSV: text in, motions out. Columns are found by name and unit, and whatever
//! is wrong is named with its file, line and column.
//!
//! | what | where |
//! |---|---|
//! | a motion given by samples of the drive angles or of the end effector | [`samples()`] |
//! | motions of a built machine, with what its base felt | [`motions`] |
//! | either, told apart by the columns | [`Table`] |

mod angle;
mod column;
mod error;
mod kind;
mod measured;
mod reader;
mod samples;

pub use error::TableError;
pub use kind::Table;
pub use measured::{MAX_ROWS, motions};
pub use samples::{SampleTable, samples};
