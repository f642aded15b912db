//! Figures fit for print. A [`Page`] of figures becomes shapes, lettering included, from which SVG and PDF are written:
//! so both look the same, and neither needs a font.

pub(crate) mod glyphs;
mod numbers;
mod page;
pub mod paper;
mod pdf;
mod plot;
mod scene;
mod shape;
mod svg;

pub use numbers::curves_table;
pub use page::{PIXEL_MM, POINTS_PER_MM, Page};
pub use pdf::pdf;
pub use plot::{PrintCurve, PrintPlot, PrintWords, pen};
pub use scene::scene_figure;
pub use svg::{svg, svg_element};
