//! From where a view opens.

use rerun::blueprint::components::Eye3DKind;
use rerun::external::re_sdk_types::blueprint::archetypes::EyeControls3D;

use crate::picture::scene::camera::{Camera, Orbit};

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
}

impl Eye {
    /// An eye in a space whose z points up.
    pub fn upright(orbit: Orbit) -> Self {
        Self { orbit, axes: [0, 1, 2] }
    }

    /// What looks at the scene from there.
    pub fn camera(&self) -> Camera {
        Camera::Orbit(self.orbit)
    }

    /// A pixel in the middle of the picture, m.
    pub fn pixel(&self) -> f32 {
        (self.orbit.distance * HALF_HEIGHT / HALF_PIXELS) as f32
    }

    /// From its own coordinates to those of the recording.
    pub fn place<T: Copy + Default>(&self, p: [T; 3]) -> [T; 3] {
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
        let at = |p: [f64; 3]| self.place(p).map(|x| x as f32);
        EyeControls3D::new()
            .with_kind(Eye3DKind::Orbital)
            .with_position(at([0, 1, 2].map(|i| centre[i] + distance * towards[i])))
            .with_look_target(at(centre))
            .with_eye_up(at([0.0, 0.0, 1.0]))
    }
}
