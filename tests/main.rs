//! All tests, one binary: the folders are those of the sources.

#[cfg(feature = "window")]
mod app;
/// The program's own modules, so that what they read is tried in process.
#[cfg(feature = "cli")]
#[allow(dead_code, unused_imports, reason = "the tests use a few of them")]
#[path = "../src/commands/mod.rs"]
mod commands;
mod fuzz;
#[cfg(feature = "render")]
mod gpu;
mod layers;
mod mechanics;
mod picture;
mod planning;
#[cfg(feature = "cli")]
mod program;
#[cfg(feature = "record")]
mod recording;
mod session;
mod simulation;
mod study;
mod support;
