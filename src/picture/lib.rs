//! Scenes and charts as plain data, and the code that draws them.

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
