//! Export of machines to other programs and for construction, and import from other programs.

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
