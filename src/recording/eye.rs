//! From where a view opens.

use std::f64::consts::FRAC_PI_2;

use rerun::blueprint::components::Eye3DKind;
use rerun::external::re_sdk_types::blueprint::archetypes::EyeControls3D;

use crate::picture::scene::camera::{Camera, Flat, Orbit};

/// Half the height of the picture at a distance of 1: the viewer looks through 55°.
const HALF_HEIGHT: f64 = 0.5206;

/// Pixels from the middle of the picture to its top, in a window of the usual size; fewer than there are, because the
/// viewer's words stand in boxes.
const HALF_PIXELS: f64 = 240.0;

/// An eye that looks at a point.
#[derive(Clone, Copy, Debug)]
pub struct Eye {
    /// Where it is, in coordinates whose last axis points up.
    pub orbit: Orbit,
    /// Which axis of the recording each of these is.
    pub axes: [usize; 3],
    /// How thick what it looks at is recorded, as a part of how thick it is.
    pub thickness: f32,
}

/// How thick a drawing is that is seen from straight above, where the viewer's perspective would shift what is higher.
const FLAT: f32 = 0.03;

impl Eye {
    /// An eye in a space whose z points up.
    pub fn upright(orbit: Orbit) -> Self {
        Self::along(orbit, [0, 1, 2])
    }

    /// An eye in a space with these axes.
    pub fn along(orbit: Orbit, axes: [usize; 3]) -> Self {
        Self { orbit, axes, thickness: 1.0 }
    }

    /// An eye straight above a drawing, so that a square with such sides is seen around a point, m.
    pub fn above([x, y]: [f64; 2], side: f64) -> Self {
        let distance = 0.5 * side / HALF_HEIGHT;
        let orbit = Orbit { centre: [x, y, 0.0], distance, yaw: 0.0, pitch: FRAC_PI_2 };
        Self { orbit, axes: [0, 1, 2], thickness: FLAT }
    }

    /// Where a camera is, in a space with these axes.
    pub fn of(camera: &Camera, axes: [usize; 3]) -> Self {
        match camera {
            Camera::Orbit(orbit) => Self::along(*orbit, axes),
            Camera::Flat(Flat { centre, half_height }) => Self::above(*centre, 2.0 * half_height),
        }
    }

    /// Whether it looks at a drawing from straight above.
    pub fn is_above(&self) -> bool {
        self.thickness != 1.0
    }

    /// What looks at the scene from there.
    pub fn camera(&self) -> Camera {
        Camera::Orbit(self.orbit)
    }

    /// A pixel in the middle of the picture, m.
    pub fn pixel(&self) -> f32 {
        (self.orbit.distance * HALF_HEIGHT / HALF_PIXELS) as f32
    }

    /// A point from its own coordinates to those of the recording, m.
    pub fn place(&self, [x, y, z]: [f32; 3]) -> [f32; 3] {
        self.turn([x, y, self.thickness * z])
    }

    /// A direction from its own coordinates to those of the recording.
    pub fn turn<T: Copy + Default>(&self, p: [T; 3]) -> [T; 3] {
        let mut placed = [T::default(); 3];
        for (axis, x) in self.axes.into_iter().zip(p) {
            placed[axis] = x;
        }
        placed
    }

    /// A shift on the screen, px, y down, as one in its own coordinates.
    pub fn shift(&self, [right, down]: [f32; 2]) -> [f32; 3] {
        let unit = self.pixel();
        let (yaw, pitch) = (self.orbit.yaw as f32, self.orbit.pitch as f32);
        let across = [yaw.cos(), yaw.sin(), 0.0];
        let up = [-yaw.sin() * pitch.sin(), yaw.cos() * pitch.sin(), pitch.cos()];
        [0, 1, 2].map(|i| unit * (right * across[i] - down * up[i]))
    }

    /// For the layout.
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
