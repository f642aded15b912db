//! Cameras: an orthographic view from above, or a perspective view that orbits a point. Plain values, independent of
//! any window.

use nalgebra::{Matrix4, Point3, Vector3};
use serde::{Deserialize, Serialize};

/// An orthographic or a perspective camera.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Camera {
    /// Orthographic, straight down on the plane of motion.
    Flat(FlatCamera),
    /// In perspective, orbiting a point.
    Orbit(Orbit),
    /// In perspective, for points in axes other than those of the world.
    #[serde(skip)]
    OfBlock(Orbit, BlockPlace),
}

/// Transformation from the axes of a block to the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockPlace(pub Matrix4<f64>);

/// Orthographic camera that looks straight down on the plane of motion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FlatCamera {
    /// Point at the centre of the picture, m.
    pub centre: [f64; 2],
    /// Half the height of the picture, m.
    pub half_height: f64,
}

/// Perspective camera that orbits a point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Orbit {
    /// Point at the centre of the picture, m.
    pub centre: [f64; 3],
    /// Distance of the eye from the centre, m.
    pub distance: f64,
    /// Azimuth of the eye about z, from −y, rad.
    pub yaw: f64,
    /// Elevation of the eye over the plane, rad; π/2 is straight above.
    pub pitch: f64,
}

/// Field of view over the shorter side of the picture, rad.
const FIELD_OF_VIEW_RAD: f64 = 0.6;

/// Limits of the size of a picture and of the distance of its centre from the base, m.
const MIN_SIZE_M: f64 = 1e-6;
const MAX_SIZE_M: f64 = 1e6;

/// A line of sight: a point and a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Point on the line, m.
    pub from: [f64; 3],
    /// Unit vector away from the eye.
    pub along: [f64; 3],
}

impl Ray {
    /// Returns the intersection (x, y) with the plane at height z, m; `None` if parallel or pointing away.
    pub fn at_height(&self, z: f64) -> Option<[f64; 2]> {
        let t = (z - self.from[2]) / self.along[2];
        (t.is_finite() && t > 0.0).then(|| [0, 1].map(|i| self.from[i] + t * self.along[i]))
    }
}

impl Camera {
    /// Returns a flat view of an arm with the given reach, m, shifted from the base towards the usual work area.
    pub fn flat(reach: f64) -> Self {
        Self::Flat(FlatCamera { centre: [0.12 * reach, 0.28 * reach], half_height: 0.82 * reach })
    }

    /// Returns a view of an arm with the given reach, m, from the front and above.
    pub fn orbit(reach: f64) -> Self {
        Self::Orbit(Orbit { centre: [0.1 * reach, 0.2 * reach, 0.0], distance: 2.3 * reach, yaw: 0.45, pitch: 0.75 })
    }

    /// Returns the camera for points in the axes of a block: it projects them, and gives lines of sight, in these axes.
    #[must_use]
    pub fn of_block(self, world_from_block: Matrix4<f64>) -> Self {
        match self {
            Self::Flat(_) => self,
            Self::Orbit(orbit) | Self::OfBlock(orbit, _) => Self::OfBlock(orbit, BlockPlace(world_from_block)),
        }
    }

    /// Whether the camera is orthographic from above.
    pub fn is_flat(&self) -> bool {
        matches!(self, Self::Flat(_))
    }

    /// Whether all values are finite and the picture has a size: a camera from a file may have neither.
    pub fn is_valid(&self) -> bool {
        let sizes = MIN_SIZE_M..=MAX_SIZE_M;
        let near = |x: &f64| x.abs() <= MAX_SIZE_M;
        match self {
            Self::Flat(f) => f.centre.iter().all(near) && sizes.contains(&f.half_height),
            Self::Orbit(o) | Self::OfBlock(o, _) => {
                o.centre.iter().chain([&o.yaw, &o.pitch]).all(near) && sizes.contains(&o.distance)
            }
        }
    }

    fn view(&self) -> Matrix4<f64> {
        match self {
            Self::Flat(f) => Matrix4::new_translation(&Vector3::new(-f.centre[0], -f.centre[1], 0.0)),
            Self::OfBlock(o, place) => Self::Orbit(*o).view() * place.0,
            Self::Orbit(o) => {
                let back = o.back();
                let centre = Point3::from(o.centre);
                let up = if o.pitch.cos() > 1e-6 { Vector3::z() } else { Vector3::new(-o.yaw.sin(), o.yaw.cos(), 0.0) };
                Matrix4::look_at_rh(&(centre + back * o.distance), &centre, &up)
            }
        }
    }

    /// Returns the transformation from world to clip space, depth 0..1; `aspect` is the ratio of width to height.
    pub fn clip_from_world(&self, aspect: f64) -> [[f32; 4]; 4] {
        self.matrix(aspect).map(|x| x as f32).into()
    }

    fn matrix(&self, aspect: f64) -> Matrix4<f64> {
        let aspect = valid_aspect(aspect);
        let projection = match self {
            Self::Flat(f) => {
                let (h, w) = (f.half_height, f.half_height * aspect);
                Matrix4::new_orthographic(-w, w, -h, h, -10.0 * h, 10.0 * h)
            }
            Self::Orbit(o) | Self::OfBlock(o, _) => {
                let field = 2.0 * ((0.5 * FIELD_OF_VIEW_RAD).tan() / aspect.min(1.0)).atan();
                Matrix4::new_perspective(aspect, field, 0.02 * o.distance, 20.0 * o.distance)
            }
        };
        // nalgebra's depth runs from −1 to 1, the GPU's from 0 to 1.
        let mut half = Matrix4::identity();
        half[(2, 2)] = 0.5;
        half[(2, 3)] = 0.5;
        half * projection * self.view()
    }

    /// Unit vector from the scene towards the eye.
    pub fn eye_direction(&self) -> [f32; 3] {
        match self {
            Self::Flat(_) => [0.0, 0.0, 1.0],
            Self::Orbit(o) => o.back().map(|x| x as f32).into(),
            Self::OfBlock(o, place) => place.0.transpose().transform_vector(&o.back()).map(|x| x as f32).into(),
        }
    }

    /// Projects a point, m, to the picture: 0..1 from the left and from the top; `None` behind the eye.
    pub fn project(&self, point: [f64; 3], aspect: f64) -> Option<[f64; 2]> {
        let clip = self.matrix(aspect) * Point3::from(point).to_homogeneous();
        (clip.w > 0.0).then(|| [0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w])
    }

    /// Returns the line of sight through a point of the picture, 0..1 from the left and from the top.
    pub fn ray(&self, place: [f64; 2], aspect: f64) -> Option<Ray> {
        let inverse = self.matrix(aspect).try_inverse()?;
        let unproject = |depth: f64| {
            let p = inverse * nalgebra::Vector4::new(2.0 * place[0] - 1.0, 1.0 - 2.0 * place[1], depth, 1.0);
            Point3::from_homogeneous(p)
        };
        let (near, far) = (unproject(0.0)?, unproject(1.0)?);
        let along = (far - near).try_normalize(0.0)?;
        Some(Ray { from: near.into(), along: along.into() })
    }

    /// Size of a metre at the centre of the picture, as a fraction of the height of the picture.
    pub fn scale(&self, aspect: f64) -> f64 {
        match self {
            Self::Flat(f) => 0.5 / f.half_height,
            Self::Orbit(o) | Self::OfBlock(o, _) => {
                0.5 * valid_aspect(aspect).min(1.0) / (o.distance * (0.5 * FIELD_OF_VIEW_RAD).tan())
            }
        }
    }

    /// Rotates about the centre by angles, rad; has no effect on a flat view.
    pub fn turn(&mut self, yaw: f64, pitch: f64) {
        if let Self::Orbit(o) | Self::OfBlock(o, _) = self {
            o.yaw = (o.yaw + yaw).rem_euclid(std::f64::consts::TAU);
            o.pitch = (o.pitch + pitch).clamp(-1.55, 1.55);
        }
    }

    /// Shifts the picture to the right and down, by fractions of its height.
    pub fn pan(&mut self, right: f64, down: f64, aspect: f64) {
        let metres = 1.0 / self.scale(aspect);
        match self {
            Self::Flat(f) => {
                f.centre[0] -= right * metres;
                f.centre[1] += down * metres;
            }
            Self::Orbit(o) | Self::OfBlock(o, _) => {
                let view = Self::Orbit(*o).view();
                for i in 0..3 {
                    o.centre[i] += (-right * view[(0, i)] + down * view[(1, i)]) * metres;
                }
            }
        }
    }

    /// Magnifies by a factor; the point `place` of the picture (0..1 from left and top) stays fixed.
    pub fn zoom(&mut self, factor: f64, place: [f64; 2], aspect: f64) {
        let (x, y) = ((place[0] - 0.5) * aspect, place[1] - 0.5);
        self.pan(-x, -y, aspect);
        match self {
            Self::Flat(f) => f.half_height = (f.half_height / factor).clamp(1e-3, 1e3),
            Self::Orbit(o) | Self::OfBlock(o, _) => o.distance = (o.distance / factor).clamp(1e-2, 1e3),
        }
        self.pan(x, y, aspect);
    }
}

/// Returns the aspect ratio, or 1 if it is not a positive finite number.
fn valid_aspect(aspect: f64) -> f64 {
    if aspect.is_finite() && aspect > 0.0 { aspect } else { 1.0 }
}

impl Orbit {
    /// Unit vector from the centre towards the eye.
    fn back(&self) -> Vector3<f64> {
        let (c, s) = (self.pitch.cos(), self.pitch.sin());
        Vector3::new(self.yaw.sin() * c, -self.yaw.cos() * c, s)
    }
}
