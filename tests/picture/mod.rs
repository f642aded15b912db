//! Tests of `src/picture`: scenes, charts, meshes, and what the renderer draws.

mod cut;
#[cfg(feature = "render")]
mod film;
mod mesh;
mod notation;
mod palette;
mod plots;
#[cfg(feature = "ui")]
mod portrait;
mod reach;
mod report;
mod scene;
#[cfg(feature = "render")]
mod shaders;
mod views;
