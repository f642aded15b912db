//! Drawings of links for cutting, flat and at scale 1 : 1: SVG to look at, DXF for cutting machines.

mod dxf;
mod layout;
mod lines;
mod outline;
mod piece;
mod sheet;
mod svg;

pub use dxf::dxf;
pub use outline::{Corner, PieceOutline, pieces_of};
pub use sheet::{Sheet, SheetShape, TextAlign, TextEmphasis};
pub use svg::svg;
