//! [`Grid`]: a square grid under a machine, as a scale.

use super::linkage::LinkageModel;
use super::palette::{Palette, faded};
use super::{Polyline, Scene, Strips, point};
use crate::numbers::round_up;
use stillbase_mechanics::planar::Vector;

/// Maximum number of squares over the reach of a machine.
const MAX_SQUARES: f64 = 15.0;

/// A square grid under a machine.
#[derive(Clone, Debug)]
pub struct Grid {
    width: f64,
    lines: Strips,
    /// The lines through the origin.
    axes: Strips,
}

impl Grid {
    /// Returns the grid under a machine.
    pub fn of(linkage: &LinkageModel) -> Self {
        let z = linkage.floor() - 0.004 * linkage.reach();
        let width = round_up(linkage.reach() / MAX_SQUARES);
        let n = (1.7 * linkage.reach() / width).ceil() as i32;
        let far = f64::from(n) * width;
        let at = |i: i32| {
            let at = f64::from(i) * width;
            [[[at, -far], [at, far]], [[-far, at], [far, at]]]
                .map(|ends| ends.map(|[x, y]| point(Vector::new(x, y), z)).to_vec())
        };
        let lines = (-n..=n).filter(|i| *i != 0).flat_map(at).collect();
        Self { width, lines, axes: at(0).into() }
    }

    /// Width of a square, m.
    pub fn width(&self) -> f64 {
        self.width
    }

    /// Draws the grid.
    pub fn draw(&self, scene: &mut Scene, palette: &Palette) {
        let lines = Polyline::new("grid", self.lines.clone(), 1.0, faded(palette.line, 0.55));
        let axes = Polyline::new("grid/axes", self.axes.clone(), 1.0, palette.line);
        scene.lines.extend([lines.constant(), axes.constant()]);
    }
}
