//! What it looks like: plain data to draw, and what draws it.

#[cfg(feature = "render")]
pub mod render;
pub mod scene;
