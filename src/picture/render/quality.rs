//! How finely a scene is drawn.

/// How finely a scene is drawn. Where the processor draws, what moves is drawn in draft, and finely once it rests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// Four samples a pixel.
    #[default]
    Fine,
    /// One sample a pixel, and areas in larger cells.
    Draft,
}

impl Quality {
    /// Samples a pixel.
    pub(super) fn samples(self) -> u32 {
        match self {
            Self::Fine => 4,
            Self::Draft => 1,
        }
    }

    /// Cells a side of an area's grid: in draft an edge of half a turn is half a pixel off.
    pub(super) fn cells(self) -> u16 {
        match self {
            Self::Fine => 64,
            Self::Draft => 24,
        }
    }
}
