//! Initial position of the eye of a view.

use std::f64::consts::FRAC_PI_2;

use crate::rerun::blueprint::archetypes::EyeControls3D;
use crate::rerun::blueprint::components::Eye3DKind;

use stillbase_picture::scene::camera::{Camera, FlatCamera, Orbit};

/// Half the height of the picture, as a fraction of the eye's distance, for the viewer's field of view of 55°.
const HALF_HEIGHT: f64 = 0.5206;

/// Assumed number of pixels from the centre of the picture to its top. It is smaller than in a usual window: this
/// shifts labels farther from their points, because the viewer draws them in boxes.
const HALF_PIXELS: f64 = 240.0;

/// Fraction of the picture that points fill.
const FILL_FRACTION: f64 = 0.7;
/// Height of the points' middle above that of the picture, as a fraction of its height: labels stand below.
const RISE_FRACTION: f64 = 0.05;

fn wider([low, high]: [f64; 2], x: f64) -> [f64; 2] {
    [low.min(x), high.max(x)]
}

/// An eye that looks at a point.
#[derive(Clone, Copy, Debug)]
pub struct Eye {
    /// Position, in coordinates whose third axis points up.
    pub orbit: Orbit,
    /// For each axis of `orbit`: index of the axis of the recording onto which it falls.
    pub axes: [usize; 3],
    /// Scale factor of recorded heights.
    pub thickness: f32,
}

/// Scale factor of heights in drawings seen from straight above, so that perspective hardly shifts higher parts.
const FLAT_THICKNESS: f32 = 0.03;

impl Eye {
    /// Returns an eye in a space whose z axis points up.
    pub fn upright(orbit: Orbit) -> Self {
        Self::along(orbit, [0, 1, 2])
    }

    /// Returns an eye in a space with the given axes.
    pub fn along(orbit: Orbit, axes: [usize; 3]) -> Self {
        Self { orbit, axes, thickness: 1.0 }
    }

    /// Returns an eye straight above a drawing that shows a square around a point; `side` is the length of its sides,
    /// m.
    pub fn above([x, y]: [f64; 2], side: f64) -> Self {
        let distance = 0.5 * side / HALF_HEIGHT;
        let orbit = Orbit { centre: [x, y, 0.0], distance, yaw: 0.0, pitch: FRAC_PI_2 };
        Self { orbit, axes: [0, 1, 2], thickness: FLAT_THICKNESS }
    }

    /// Converts a camera to an eye in a space with the given axes.
    pub fn of(camera: &Camera, axes: [usize; 3]) -> Self {
        match camera {
            Camera::Orbit(orbit) | Camera::OfBlock(orbit, _) => Self::along(*orbit, axes),
            Camera::Flat(FlatCamera { centre, half_height }) => Self::above(*centre, 2.0 * half_height),
        }
    }

    /// Returns the eye in the same direction from which points, m, fill a picture; `aspect` is its width as a fraction of
    /// its height. Without points, the eye stays.
    pub fn filled(&self, points: &[[f64; 3]], aspect: f64) -> Self {
        let (yaw, pitch) = (self.orbit.yaw, self.orbit.pitch);
        let across = [yaw.cos(), yaw.sin(), 0.0];
        let up = [-yaw.sin() * pitch.sin(), yaw.cos() * pitch.sin(), pitch.cos()];
        let towards = self.camera().eye_direction().map(f64::from);
        let along = |axis: [f64; 3], p: &[f64; 3]| (0..3).map(|i| axis[i] * p[i]).sum::<f64>();
        let middle = |axis: [f64; 3]| {
            let [low, high] = points.iter().map(|p| along(axis, p)).fold([f64::INFINITY, f64::NEG_INFINITY], wider);
            0.5 * (low + high)
        };
        let [a, u] = [across, up].map(middle);
        if !(a.is_finite() && u.is_finite()) {
            return *self;
        }
        let half_height = FILL_FRACTION * HALF_HEIGHT;
        let distance = points.iter().map(|p| {
            let beside = ((along(across, p) - a).abs() / aspect).max((along(up, p) - u).abs());
            along(towards, p) + beside / half_height
        });
        // The centre has no part along the line of sight.
        let distance = distance.fold(f64::MIN_POSITIVE, f64::max);
        let u = u - 2.0 * RISE_FRACTION * HALF_HEIGHT * distance;
        let centre = [0, 1, 2].map(|i| a * across[i] + u * up[i]);
        Self { orbit: Orbit { centre, distance, ..self.orbit }, ..*self }
    }

    /// Returns whether the eye looks at a drawing from straight above.
    pub fn is_above(&self) -> bool {
        self.thickness != 1.0
    }

    /// Returns the camera at this position.
    pub fn camera(&self) -> Camera {
        Camera::Orbit(self.orbit)
    }

    /// Returns the size of a pixel at the centre of the picture, m.
    pub fn pixel(&self) -> f32 {
        (self.orbit.distance * HALF_HEIGHT / HALF_PIXELS) as f32
    }

    /// Transforms a point, m, to the coordinates of the recording.
    pub fn place(&self, [x, y, z]: [f32; 3]) -> [f32; 3] {
        self.turn([x, y, self.thickness * z])
    }

    /// Transforms a direction to the coordinates of the recording.
    pub fn turn<T: Copy + Default>(&self, p: [T; 3]) -> [T; 3] {
        let mut placed = [T::default(); 3];
        for (axis, x) in self.axes.into_iter().zip(p) {
            placed[axis] = x;
        }
        placed
    }

    /// Converts a shift on the screen, px, y down, to a shift in the scene, m.
    pub fn shift(&self, [right, down]: [f32; 2]) -> [f32; 3] {
        let unit = self.pixel();
        let (yaw, pitch) = (self.orbit.yaw as f32, self.orbit.pitch as f32);
        let across = [yaw.cos(), yaw.sin(), 0.0];
        let up = [-yaw.sin() * pitch.sin(), yaw.cos() * pitch.sin(), pitch.cos()];
        [0, 1, 2].map(|i| unit * (right * across[i] - down * up[i]))
    }

    /// Returns the eye controls of the layout.
    pub fn controls(&self) -> EyeControls3D {
        let Orbit { centre, distance, .. } = self.orbit;
        let towards = self.camera().eye_direction().map(f64::from);
        let at = |p: [f64; 3]| self.turn(p).map(|x| x as f32);
        let up = if self.is_above() { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] };
        EyeControls3D::new()
            .with_kind(Eye3DKind::Orbital)
            .with_position(at([0, 1, 2].map(|i| centre[i] + distance * towards[i])))
            .with_look_target(at(centre))
            .with_eye_up(at(up))
    }
}
