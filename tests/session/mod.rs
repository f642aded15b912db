//! What a person did.

mod bounds;
mod cases;
mod edits;
mod verdict;
