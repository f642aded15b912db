//! All tests that need no GPU, one binary: the folders are those of the sources. Those that draw are in `drawn.rs`.

mod exchange;
#[cfg(feature = "tables")]
mod files;
#[cfg(any(feature = "cli", feature = "record"))]
mod folder;
mod fuzz;
mod guide;
mod layers;
mod mechanics;
mod picture;
mod planning;
#[cfg(feature = "cli")]
mod program;
mod query;
#[cfg(feature = "record")]
mod recording;
mod session;
mod settings;
mod simulation;
mod study;
mod support;
