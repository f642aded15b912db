//! All tests, one binary.

#[path = "suite/balance.rs"]
mod balance;
#[path = "suite/bases.rs"]
mod bases;
#[path = "suite/boundary.rs"]
mod boundary;
#[path = "suite/bounds.rs"]
mod bounds;
#[path = "suite/cases.rs"]
mod cases;
#[path = "suite/change_points.rs"]
mod change_points;
#[cfg(feature = "cli")]
#[path = "suite/cli.rs"]
mod cli;
/// The program's own modules, so that what they read is tried in process.
#[cfg(feature = "cli")]
#[allow(dead_code, unused_imports, reason = "the tests use a few of them")]
#[path = "../src/commands/mod.rs"]
mod commands;
#[path = "suite/compare.rs"]
mod compare;
#[path = "suite/contacts.rs"]
mod contacts;
#[path = "suite/convergence.rs"]
mod convergence;
#[path = "suite/curve.rs"]
mod curve;
#[path = "suite/dynamics.rs"]
mod dynamics;
#[cfg(feature = "cli")]
#[path = "suite/files.rs"]
mod files;
#[path = "suite/fuzz.rs"]
mod fuzz;
#[cfg(feature = "cli")]
#[path = "suite/fuzz_commands.rs"]
mod fuzz_commands;
#[path = "suite/given.rs"]
mod given;
#[cfg(feature = "render")]
#[path = "suite/gpu.rs"]
mod gpu;
#[path = "suite/inside.rs"]
mod inside;
#[path = "suite/joint_forces.rs"]
mod joint_forces;
#[path = "suite/layers.rs"]
mod layers;
#[path = "suite/least_reaction.rs"]
mod least_reaction;
#[path = "suite/machine_file.rs"]
mod machine_file;
#[path = "suite/mesh.rs"]
mod mesh;
#[path = "suite/mutation.rs"]
mod mutation;
#[path = "suite/nine_body.rs"]
mod nine_body;
#[path = "suite/null_space.rs"]
mod null_space;
#[path = "suite/pin_friction.rs"]
mod pin_friction;
#[path = "suite/planning.rs"]
mod planning;
#[path = "suite/plants.rs"]
mod plants;
#[path = "suite/price.rs"]
mod price;
#[path = "suite/proposals.rs"]
mod proposals;
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
#[path = "suite/sizes.rs"]
mod sizes;
#[path = "suite/spectrum.rs"]
mod spectrum;
#[path = "suite/support.rs"]
mod support;
#[path = "suite/timing.rs"]
mod timing;
#[path = "suite/tolerance.rs"]
mod tolerance;
#[path = "suite/trace.rs"]
mod trace;
#[path = "suite/verdict.rs"]
mod verdict;
#[path = "suite/views.rs"]
mod views;
#[path = "suite/windings.rs"]
mod windings;
#[cfg(feature = "window")]
#[path = "suite/window.rs"]
mod window;
