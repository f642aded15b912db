//! How a value is named, bounded and shown: keys with their fields, words of choices, changes by key, ranges, typed
//! numbers, and external text.

pub mod change;
pub mod key;
pub mod keyed;
pub mod number;
pub mod quantity;
pub mod range;
pub mod text;
pub mod word;
