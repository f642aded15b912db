//! Links as parts to cut, flat and in real size: SVG to look at, DXF for the machine that cuts.

mod dxf;
mod sheet;
mod svg;

pub use dxf::dxf;
pub use sheet::{Anchor, Paint, Shape, Sheet};
pub use svg::svg;
