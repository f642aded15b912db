//! Machines for other programs. What those make of them is in `tests/outside/`.

pub mod arms;
mod assemblies;
mod drawing;
mod floating;
mod import;
mod mjcf;
pub mod ordinary;
mod parts;
mod solids;
mod urdf;
