//! The shadows of the links on the floor.

use super::LinkageModel;
use crate::scene::Shadow;
use stillbase_mechanics::planar::{UnitVectors, Vector};

/// Horizontal shift of a shadow per height of the bar above the floor, and opacity of the shadow of a bar on the floor.
const SHADOW_SHIFT: Vector = Vector::new(0.45, -0.6);
const SHADOW_OPACITY: f64 = 0.5;

impl LinkageModel {
    /// Returns the shadows of the links on the floor, in light from the upper left; `base` is the position of the base,
    /// m.
    pub fn shadows(&self, e: &UnitVectors, base: Vector) -> impl Iterator<Item = Shadow> {
        let (e, floor) = (*e, self.floor());
        self.bars.iter().map(move |bar| {
            let (width, height) = (bar.radius, bar.height);
            let ends = bar.ends(&e).map(|[x, y, z]| {
                let away = base + Vector::new(x, y) + SHADOW_SHIFT * (z + 0.5 * height - floor);
                [away.re as f32, away.im as f32]
            });
            // Shadows of higher bars are softer and paler.
            let above = bar.z - floor;
            let soft = width + 0.8 * above;
            Shadow {
                ends,
                z: floor as f32,
                core: (0.5 * width) as f32,
                reach: (width + soft) as f32,
                strength: (SHADOW_OPACITY * width / (width + 0.5 * above)) as f32,
            }
        })
    }
}
