//! The pointer over a picture: its line of sight, and its distances from items in pixels.

use super::camera::{Camera, Ray};

/// A point in a picture, and the camera of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pointer {
    /// The camera.
    pub camera: Camera,
    /// Width and height of the picture, px.
    pub size: [f64; 2],
    /// Coordinates from the left and from the top, px.
    pub at: [f64; 2],
}

impl Pointer {
    /// Ratio of width to height of the picture.
    pub fn aspect(&self) -> f64 {
        self.size[0] / self.size[1].max(1.0)
    }

    /// The line of sight through the pointer.
    pub fn ray(&self) -> Option<Ray> {
        self.camera.ray([0, 1].map(|i| self.at[i] / self.size[i].max(1.0)), self.aspect())
    }

    /// Returns the point under the pointer in the plane through a point, m, that faces the eye.
    pub fn beside(&self, point: [f64; 3]) -> Option<[f64; 3]> {
        let (ray, facing) = (self.ray()?, self.camera.eye_direction().map(f64::from));
        let way = [0, 1, 2].map(|i| point[i] - ray.from[i]);
        let t = dot(way, facing) / dot(ray.along, facing);
        (t.is_finite() && t > 0.0).then(|| [0, 1, 2].map(|i| ray.from[i] + t * ray.along[i]))
    }

    /// Projects a point, m, to the picture, px; `None` behind the eye.
    pub fn project(&self, point: [f64; 3]) -> Option<[f64; 2]> {
        let place = self.camera.project(point, self.aspect())?;
        Some([0, 1].map(|i| place[i] * self.size[i]))
    }

    /// Distance in the picture from the pointer to a point, px; `None` behind the eye.
    pub fn distance(&self, point: [f64; 3]) -> Option<f64> {
        let [x, y] = self.project(point)?;
        Some((x - self.at[0]).hypot(y - self.at[1]))
    }

    /// Distance in the picture from the pointer to a segment, px; `None` if an end is behind the eye.
    pub fn distance_to_segment(&self, ends: [[f64; 3]; 2]) -> Option<f64> {
        let ([ax, ay], [bx, by]) = (self.project(ends[0])?, self.project(ends[1])?);
        let (ux, uy, px, py) = (bx - ax, by - ay, self.at[0] - ax, self.at[1] - ay);
        let length = (ux * ux + uy * uy).max(1e-12);
        let t = ((px * ux + py * uy) / length).clamp(0.0, 1.0);
        Some((px - t * ux).hypot(py - t * uy))
    }
}

/// Minimum sine of the angle between a line and the line of sight for which the point on the line is determined.
const MIN_SINE: f64 = 0.1;

impl Ray {
    /// Returns the intersection with the plane n · x = d in front of the eye; `None` if parallel or pointing away.
    pub fn at_plane(&self, n: [f64; 3], d: f64) -> Option<[f64; 3]> {
        let t = (d - dot(n, self.from)) / dot(n, self.along);
        (t.is_finite() && t > 0.0).then(|| [0, 1, 2].map(|i| self.from[i] + t * self.along[i]))
    }

    /// Returns the parameter s of the point of the line `from` + s `along` that is nearest to the ray. `None` if the
    /// line is nearly parallel to the ray.
    pub fn along_line(&self, from: [f64; 3], along: [f64; 3]) -> Option<f64> {
        let w = [0, 1, 2].map(|i| from[i] - self.from[i]);
        let (b, c) = (dot(along, self.along), dot(along, along));
        let room = c - b * b;
        let s = (b * dot(w, self.along) - dot(w, along)) / room;
        (room > MIN_SINE * MIN_SINE * c && s.is_finite()).then_some(s)
    }
}

/// Dot product a · b.
pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
