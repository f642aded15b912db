//! What it looks like.

mod mesh;
mod scene;
#[cfg(feature = "render")]
mod shaders;
mod views;
