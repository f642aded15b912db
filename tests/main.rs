//! All tests that need no GPU, one binary: the folders are those of the sources. Those that draw are in `drawn.rs`.

/// The program's own modules, so that what they read is tried in process.
#[cfg(feature = "cli")]
#[allow(dead_code, unused_imports, reason = "the tests use a few of them")]
#[path = "../src/commands/mod.rs"]
mod commands;
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
