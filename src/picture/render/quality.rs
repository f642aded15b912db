//! Quality of drawing.

/// Quality of drawing. In software rendering, scenes are drawn in draft quality while they change, and in fine quality
/// once they rest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// Four samples per pixel.
    #[default]
    Fine,
    /// One sample per pixel, and a coarser grid for areas.
    Draft,
}

impl Quality {
    /// Samples per pixel.
    pub(super) fn samples(self) -> u32 {
        match self {
            Self::Fine => 4,
            Self::Draft => 1,
        }
    }

    /// Cells per side of the grid of an area. In draft quality, a boundary arc of half a turn deviates by half a pixel.
    pub(super) fn cells(self) -> u16 {
        match self {
            Self::Fine => 64,
            Self::Draft => 24,
        }
    }
}
