//! All tests, one binary.

#[path = "suite/boundary.rs"]
mod boundary;
#[path = "suite/nine_body.rs"]
mod nine_body;
#[path = "suite/reach.rs"]
mod reach;
