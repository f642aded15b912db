//! All tests, one binary.

#[path = "suite/boundary.rs"]
mod boundary;
#[cfg(feature = "cli")]
#[path = "suite/cli.rs"]
mod cli;
#[cfg(feature = "render")]
#[path = "suite/gpu.rs"]
mod gpu;
#[path = "suite/machine_file.rs"]
mod machine_file;
#[path = "suite/mesh.rs"]
mod mesh;
#[path = "suite/nine_body.rs"]
mod nine_body;
#[path = "suite/reach.rs"]
mod reach;
#[cfg(feature = "record")]
#[path = "suite/recording.rs"]
mod recording;
#[cfg(feature = "render")]
#[path = "suite/render.rs"]
mod render;
#[cfg(feature = "render")]
#[path = "suite/shaders.rs"]
mod shaders;
#[cfg(feature = "window")]
#[path = "suite/window.rs"]
mod window;
#[path = "suite/support.rs"]
mod support;
#[path = "suite/dynamics.rs"]
mod dynamics;
#[path = "suite/balance.rs"]
mod balance;
#[path = "suite/cases.rs"]
mod cases;
#[path = "suite/convergence.rs"]
mod convergence;
#[path = "suite/session.rs"]
mod session;
#[path = "suite/layers.rs"]
mod layers;
#[path = "suite/signals.rs"]
mod signals;
#[path = "suite/scene.rs"]
mod scene;
