//! How a value is named, bounded and shown: changes by key, ranges, typed numbers, text from outside.

pub mod change;
pub mod key;
pub mod number;
pub mod quantity;
pub mod range;
pub mod text;
