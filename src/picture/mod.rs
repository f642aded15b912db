//! What it looks like: plain data to draw, and what draws it.

#[cfg(feature = "ui")]
pub mod canvas;
pub mod charts;
#[cfg(feature = "ui")]
pub mod gui;
pub mod numbers;
#[cfg(feature = "ui")]
pub mod paint;
#[cfg(feature = "render")]
pub mod render;
pub mod scene;
