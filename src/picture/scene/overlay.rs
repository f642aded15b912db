//! A scene to lay over a page or a slide of any colour.

use super::palette::{Palette, faded};
use super::{Marker, Polyline, Rgba, Scene};

/// Colour of the grid: as faint on white as on black.
const GRID: Rgba = [0.5, 0.5, 0.5, 0.32];
/// How much wider than a line or marker its border is at each side, px, and the opacity of borders.
const BORDER_PX: f32 = 1.4;
const BORDER_OPACITY: f32 = 0.75;
/// Opacity of what lies behind labels.
pub const PLATE_OPACITY: f32 = 0.85;

impl Scene {
    /// Makes the background transparent. Plates behind text, and borders of lines and markers in the colours of text, have
    /// the former colour of the background: so they stay legible on any other. Faint lines become grey.
    pub fn lay_over_any(&mut self, palette: &Palette) {
        let border = faded(palette.background, BORDER_OPACITY);
        self.background = faded(palette.background, 0.0);
        let is = |colour: Rgba, of: Rgba| colour[..3] == of[..3] && colour[3] > 0.0;
        let is_text = |colour: Rgba| is(colour, palette.ink) || is(colour, palette.dim);
        let lines = std::mem::take(&mut self.lines).into_iter();
        self.lines = lines
            .flat_map(|line| {
                let faint = is(line.colour, palette.line);
                let under = is_text(line.colour).then(|| Polyline {
                    width: line.width + 2.0 * BORDER_PX,
                    colour: faded(border, line.colour[3]),
                    ..line.clone()
                });
                let line = if faint { Polyline { colour: GRID, ..line } } else { line };
                under.into_iter().chain([line])
            })
            .collect();
        let markers = std::mem::take(&mut self.markers).into_iter();
        self.markers = markers
            .flat_map(|marker| {
                let under = (is_text(marker.stroke) || is_text(marker.fill)).then(|| Marker {
                    radius: marker.radius + BORDER_PX,
                    fill: if marker.fill[3] > 0.0 { border } else { marker.fill },
                    stroke: border,
                    stroke_width: marker.stroke_width + 2.0 * BORDER_PX,
                    ..marker.clone()
                });
                under.into_iter().chain([marker])
            })
            .collect();
    }
}
