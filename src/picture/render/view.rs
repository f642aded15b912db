//! Projection and size of a picture.

/// Projection and size of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Transformation from world space to clip space, column-major, with depth 0 to 1.
    pub clip_from_world: [[f32; 4]; 4],
    /// Unit vector from the scene towards the eye, in the world.
    pub eye_direction: [f32; 3],
    /// Width and height, physical pixels.
    pub size_px: [u32; 2],
    /// Physical pixels per logical pixel; widths and radii of the scene are in logical pixels.
    pub pixels_per_point: f32,
}

impl View {
    /// Projects a world point to the screen, physical pixels, y down; `None` at or behind the eye.
    pub fn project(&self, [x, y, z]: [f32; 3]) -> Option<[f32; 2]> {
        let m = &self.clip_from_world;
        let clip = |row: usize| m[0][row] * x + m[1][row] * y + m[2][row] * z + m[3][row];
        let [width, height] = self.size_px.map(|n| n as f32);
        let w = clip(3);
        (w > 0.0).then(|| [(0.5 + 0.5 * clip(0) / w) * width, (0.5 - 0.5 * clip(1) / w) * height])
    }

    /// Distance between two points on the screen, physical pixels; 0 if one is behind the eye.
    pub(super) fn pixels_between(&self, a: [f32; 3], b: [f32; 3]) -> f32 {
        match (self.project(a), self.project(b)) {
            (Some(a), Some(b)) => (b[0] - a[0]).hypot(b[1] - a[1]),
            _ => 0.0,
        }
    }
}
