//! All tests, one binary.

#[path = "suite/nine_body.rs"]
mod nine_body;
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
