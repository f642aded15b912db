//! [`PictureForm`]: the formats of a picture.

use std::io;
use std::path::Path;

use super::ExportError;
use stillbase_picture::canvas::Canvas;
use stillbase_picture::charts::figure::Figure;
use stillbase_picture::print::{Page, pdf, svg};
use stillbase_picture::render::offscreen::Picture;
use stillbase_picture::webp;

/// Format of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureForm {
    /// PNG.
    Png,
    /// WebP without loss.
    Webp,
    /// SVG: outlines.
    Svg,
    /// PDF: outlines.
    Pdf,
}

impl PictureForm {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Png, Self::Webp, Self::Svg, Self::Pdf];

    /// Returns the file name extension.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Webp => "webp",
            Self::Svg => "svg",
            Self::Pdf => "pdf",
        }
    }

    /// Returns the name, and what it is good for.
    pub fn words(self) -> [&'static str; 2] {
        match self {
            Self::Png => ["PNG", "pixels; every program reads it"],
            Self::Webp => ["WebP", "pixels without loss; smaller than PNG, for browsers"],
            Self::Svg => ["SVG", "outlines, sharp at any size; the view from above only"],
            Self::Pdf => ["PDF", "outlines for print and LaTeX; the view from above only"],
        }
    }

    /// Whether it consists of outlines, not of pixels.
    pub fn has_outlines(self) -> bool {
        matches!(self, Self::Svg | Self::Pdf)
    }

    /// Returns the file of outlines.
    pub(super) fn of_page(self, page: &Page) -> Vec<u8> {
        if self == Self::Pdf { pdf(page) } else { svg(page).into_bytes() }
    }

    /// Returns the file of pixels.
    ///
    /// # Errors
    /// If the format cannot hold the picture.
    pub(super) fn of_pixels(self, picture: &Picture) -> io::Result<Vec<u8>> {
        if self == Self::Webp { webp::still(picture) } else { picture.to_png() }
    }

    /// Returns the file of a figure, in pixels at twice its points.
    ///
    /// # Errors
    /// If it cannot be drawn; the text says why.
    pub(crate) fn of_figure(self, figure: Figure) -> Result<Vec<u8>, String> {
        if self.has_outlines() {
            return Ok(self.of_page(&Page::of_web(figure)));
        }
        let size = figure.size.map(|side| 2 * side.ceil() as u32);
        let mut canvas = Canvas::new(size, 2.0).map_err(|why| why.to_string())?;
        let picture = canvas.figures(&[([0.0; 2], figure)]).map_err(|why| why.to_string())?;
        self.of_pixels(&picture).map_err(|why| format!("no picture: {why}"))
    }

    /// Returns the format of an extension, in upper or lower case; `None` if there is none.
    pub fn of_ending(ending: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|form| form.ending().eq_ignore_ascii_case(ending))
    }

    /// Returns the format of a file by its extension.
    ///
    /// # Errors
    /// If no picture has this extension.
    pub fn of(file: &Path) -> Result<Self, ExportError> {
        let own = file.extension().unwrap_or_default();
        own.to_str().and_then(Self::of_ending).ok_or_else(|| ExportError::PictureEnding(file.into()))
    }
}
