//! All tests, one binary.

#[cfg(feature = "render")]
#[path = "suite/gpu.rs"]
mod gpu;
#[path = "suite/mesh.rs"]
mod mesh;
#[cfg(feature = "render")]
#[path = "suite/render.rs"]
mod render;
#[cfg(feature = "render")]
#[path = "suite/shaders.rs"]
mod shaders;
