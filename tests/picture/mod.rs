//! What it looks like.

mod mesh;
#[cfg(feature = "render")]
mod render;
mod scene;
#[cfg(feature = "render")]
mod shaders;
mod views;
