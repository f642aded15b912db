//! Stillbase.
#[cfg(feature = "render")]
pub mod render;
pub mod scene;
