//! The lateral surface of a twisted tower: an outline that rotates with height, as a mesh, and its contours.
//!
//! At height z, a point p of the outline is rotated by τ = twist · z: P(p, z) = (p e^{iτ}, z).

use super::Mesh;
use stillbase_mechanics::planar::{Vector, cross, dot, unit};

/// Maximum change of direction of an outline between two vertices of the wall, rad.
const MAX_TURN_RAD: f64 = 0.045;
/// Minimum change of direction of an outline at a corner, rad.
const MIN_CORNER_RAD: f64 = 0.35;
/// Maximum distance of two vertices of the wall along the outline, as a fraction of the radius of the outline.
const MAX_SIDE: f64 = 0.07;
/// Maximum rotation of the wall between two rows of vertices, rad.
const MAX_ROW_TURN_RAD: f64 = 0.07;

/// A smooth part of an outline: its points at z = 0, and the outward normals of the wall there.
#[derive(Clone, Debug)]
struct Stretch {
    points: Vec<Vector>,
    /// Components in the plane and along z.
    normals: Vec<(Vector, f64)>,
}

/// The wall above outlines that rotate with height.
#[derive(Clone, Debug)]
pub struct Wall {
    stretches: Vec<Stretch>,
    twist: f64,
    /// Factor of the mesh size, 1 for the finest.
    grain: f64,
}

impl Wall {
    /// Returns the wall above closed outlines, m, with the inside on their left; `twist` in rad/m.
    pub fn of(outlines: &[Vec<Vector>], twist: f64) -> Self {
        Self::with_grain(outlines, twist, 1.0)
    }

    /// Returns the wall with the spacing of vertices, along the outline and in height, multiplied by `grain`.
    pub fn with_grain(outlines: &[Vec<Vector>], twist: f64, grain: f64) -> Self {
        let radius = outlines.iter().flatten().fold(0.0_f64, |m, p| m.max(p.norm()));
        let stretches = outlines
            .iter()
            .flat_map(|outline| smooth_parts(outline))
            .map(|part| Stretch::of(&thinned(&part, MAX_SIDE * radius * grain, MAX_TURN_RAD * grain), twist))
            .filter(|s| s.points.len() > 1)
            .collect();
        Self { stretches, twist, grain }
    }

    /// Returns the wall from z = 0 to a height, m, as an open shell.
    pub fn mesh(&self, height: f64) -> Mesh {
        let rows = ((self.twist * height / (MAX_ROW_TURN_RAD * self.grain)).abs().ceil() as u32).clamp(1, 400);
        let mut mesh = Mesh { shell: true, ..Mesh::default() };
        for stretch in &self.stretches {
            let (first, n) = (mesh.positions.len() as u32, stretch.points.len() as u32);
            for row in 0..=rows {
                let z = height * f64::from(row) / f64::from(rows);
                let turn = unit(self.twist * z);
                for (p, (across, up)) in stretch.points.iter().zip(&stretch.normals) {
                    let (p, across) = (p * turn, across * turn);
                    mesh.positions.push([p.re as f32, p.im as f32, z as f32]);
                    mesh.normals.push([across.re as f32, across.im as f32, *up as f32]);
                }
            }
            for row in 0..rows {
                for i in 0..n - 1 {
                    let [a, b] = [first + row * n + i, first + row * n + i + 1];
                    mesh.triangles.extend([[a, b, b + n], [a, b + n, a + n]]);
                }
            }
        }
        mesh
    }

    /// Returns the outlines rotated by an angle, rad, and split at their corners.
    pub fn level(&self, turn: f64) -> Vec<Vec<Vector>> {
        let turn = unit(turn);
        self.stretches.iter().map(|s| s.points.iter().map(|p| p * turn).collect()).collect()
    }

    /// Returns the outlines rotated by an angle, rad, and split at their corners and where the wall turns away from the
    /// eye. `eye` is the unit vector towards it. Each piece has a flag that is true if the eye is on its outer side.
    pub fn contour(&self, turn: f64, eye: [f64; 3]) -> Vec<(Vec<Vector>, bool)> {
        let turn = unit(turn);
        let level = Vector::new(eye[0], eye[1]) * turn.conj();
        let mut pieces: Vec<(Vec<Vector>, bool)> = Vec::new();
        for stretch in &self.stretches {
            let mut open = false;
            for (i, p) in stretch.points.iter().enumerate() {
                let (across, up) = stretch.normals[i];
                let faces = dot(across, level) + up * eye[2] >= 0.0;
                let at = p * turn;
                match pieces.last_mut().filter(|_| open) {
                    Some((points, side)) => {
                        points.push(at);
                        // The next piece begins where this one ends.
                        if *side != faces {
                            pieces.push((vec![at], faces));
                        }
                    }
                    None => pieces.push((vec![at], faces)),
                }
                open = true;
            }
        }
        pieces.retain(|(points, _)| points.len() > 1);
        pieces
    }
}

impl Stretch {
    fn of(points: &[Vector], twist: f64) -> Self {
        let last = points.len().saturating_sub(1);
        let normals = (0..points.len())
            .map(|i| {
                let along = points[(i + 1).min(last)] - points[i.saturating_sub(1)];
                let t = along / along.norm().max(1e-300);
                // ∂P/∂p × ∂P/∂z, with ∂P/∂z = (i twist p, 1).
                let up = cross(t, Vector::new(0.0, twist) * points[i]);
                let length = 1.0_f64.hypot(up);
                (t * Vector::new(0.0, -1.0) / length, up / length)
            })
            .collect();
        Self { points: points.to_vec(), normals }
    }
}

/// Splits a closed outline at its corners; without corners, returns one piece that ends at its start.
fn smooth_parts(outline: &[Vector]) -> Vec<Vec<Vector>> {
    let mut points: Vec<Vector> = outline.to_vec();
    points.dedup_by(|a, b| (*a - *b).norm() < 1e-12);
    while points.len() > 1 && (points[0] - points[points.len() - 1]).norm() < 1e-12 {
        points.pop();
    }
    let n = points.len();
    if n < 3 {
        return Vec::new();
    }
    let is_corner = |i: usize| turning(points[(i + n - 1) % n], points[i], points[(i + 1) % n]).abs() > MIN_CORNER_RAD;
    let corners: Vec<usize> = (0..n).filter(|i| is_corner(*i)).collect();
    let Some(&first) = corners.first() else {
        return vec![points.iter().chain(&points[..1]).copied().collect()];
    };
    let ends = corners.iter().skip(1).copied().chain([first + n]);
    corners.iter().zip(ends).map(|(&from, to)| (from..=to).map(|i| points[i % n]).collect()).collect()
}

/// Change of direction of the path a, b, c at b, rad.
fn turning(a: Vector, b: Vector, c: Vector) -> f64 {
    let (u, v) = (b - a, c - b);
    cross(u, v).atan2(dot(u, v))
}

/// Thins a path but keeps its ends. Another point is kept when, since the last kept point, the direction has changed
/// by more than `turn`, rad, or the length exceeds `side`, m.
fn thinned(path: &[Vector], side: f64, turn: f64) -> Vec<Vector> {
    let mut kept: Vec<Vector> = path.first().copied().into_iter().collect();
    let (mut turned, mut gone) = (0.0, 0.0);
    for w in path.windows(3) {
        turned += turning(w[0], w[1], w[2]).abs();
        gone += (w[1] - w[0]).norm();
        if turned > turn || gone > side {
            kept.push(w[1]);
            (turned, gone) = (0.0, 0.0);
        }
    }
    kept.extend(path.last().filter(|_| path.len() > 1));
    kept
}
