//! Names, bounds and formats of values: keys with their fields, words of choices, changes by key, ranges, typed
//! numbers, and external text.
//!
//! Others reach this crate as `stillbase::settings`; `stillbase` alone follows semantic versioning.

pub mod cell_table;
#[doc(hidden)]
pub mod change;
pub mod fault;
pub mod key;
pub mod key_path;
#[doc(hidden)]
pub mod keyed;
#[doc(hidden)]
pub mod mending;
#[doc(hidden)]
pub mod number;
#[doc(hidden)]
pub mod quantity;
pub mod range;
pub mod results;
pub mod spelling;
#[doc(hidden)]
pub mod stated;
#[doc(hidden)]
pub mod text;
pub mod word;
pub mod word_row;
