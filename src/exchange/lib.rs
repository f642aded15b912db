//! Export of machines to other programs and for construction, and import from other programs.
//!
//! Others reach this crate as `stillbase::exchange`; `stillbase` alone follows semantic versioning.

pub mod base_body;
pub mod cut;
#[doc(hidden)]
pub mod drawing;
pub mod form;
pub mod import;
mod left_out;
mod look;
mod mesh;
pub mod mjcf;
pub mod parts;
mod placed;
pub mod solids;
pub mod stl;
pub mod thin;
mod tree;
mod turn;
pub mod urdf;
#[doc(hidden)]
pub mod xml;
