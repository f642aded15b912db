//! [`PictureSize`]: the size of a picture, as on display or in pixels.

use crate::shot::Shot;
use stillbase_picture::render::offscreen::legible_scale;

/// Size of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureSize {
    /// That of the scene or the window on display.
    Display,
    /// Width and height, pixels.
    Pixels([u32; 2]),
}

impl PictureSize {
    /// Default size of a film.
    pub const FILM: Self = Self::Pixels([1280, 800]);
    /// Sizes to choose from.
    pub const KNOWN: [[u32; 2]; 3] = [[1280, 800], [1920, 1080], [3840, 2160]];
    /// Smallest and largest side, pixels.
    pub const SIDES: [u32; 2] = [16, 8192];

    /// Returns width and height, pixels, and pixels per point.
    pub fn of(self, shot: Shot, display: &DisplaySize) -> ([u32; 2], f32) {
        match self {
            Self::Pixels(size) => (size, legible_scale(size[1])),
            Self::Display => (display.pixels(shot), display.scale),
        }
    }
}

/// Size of the window and its scene on display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplaySize {
    /// Width and height of the window, points.
    pub window: [f32; 2],
    /// Width and height of the scene, points.
    pub scene: [f32; 2],
    /// Pixels per point.
    pub scale: f32,
}

impl DisplaySize {
    /// Returns width and height of what a picture shows, pixels.
    pub fn pixels(&self, shot: Shot) -> [u32; 2] {
        let points = if shot == Shot::Window { self.window } else { self.scene };
        let [least, most] = PictureSize::SIDES.map(|side| side as f32);
        points.map(|side| (side * self.scale).round().clamp(least, most) as u32)
    }
}

impl Default for DisplaySize {
    fn default() -> Self {
        Self { window: [1280.0, 800.0], scene: [1280.0, 800.0], scale: 1.0 }
    }
}
