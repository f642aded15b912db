//! [`PictureForm`]: the formats of a picture.

use std::path::Path;

use super::ExportError;

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

    /// Returns the format of a file by its extension.
    ///
    /// # Errors
    /// If no picture has this extension.
    pub fn of(file: &Path) -> Result<Self, ExportError> {
        let own = file.extension().unwrap_or_default();
        let known = Self::ALL.into_iter().find(|form| own.eq_ignore_ascii_case(form.ending()));
        known.ok_or_else(|| ExportError::PictureEnding(file.into()))
    }
}
