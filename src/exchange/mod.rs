//! Machines for other programs, and for the people who build them.

pub mod cut;
pub mod drawing;
pub mod form;
pub mod import;
mod look;
pub mod mjcf;
pub mod parts;
mod tree;
mod turn;
pub mod urdf;
mod xml;
