//! All tests, one binary.

#[path = "suite/nine_body.rs"]
mod nine_body;
#[path = "suite/reach.rs"]
mod reach;
