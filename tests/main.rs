//! All tests, one binary.

#[path = "suite/balance.rs"]
mod balance;
#[path = "suite/boundary.rs"]
mod boundary;
#[path = "suite/cases.rs"]
mod cases;
#[cfg(feature = "cli")]
#[path = "suite/cli.rs"]
mod cli;
#[path = "suite/convergence.rs"]
mod convergence;
#[path = "suite/dynamics.rs"]
mod dynamics;
#[cfg(feature = "render")]
#[path = "suite/gpu.rs"]
mod gpu;
#[path = "suite/layers.rs"]
mod layers;
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
#[path = "suite/scene.rs"]
mod scene;
#[path = "suite/session.rs"]
mod session;
#[cfg(feature = "render")]
#[path = "suite/shaders.rs"]
mod shaders;
#[path = "suite/signals.rs"]
mod signals;
#[path = "suite/sincos.rs"]
mod sincos;
#[path = "suite/support.rs"]
mod support;
#[path = "suite/views.rs"]
mod views;
#[cfg(feature = "window")]
#[path = "suite/window.rs"]
mod window;
