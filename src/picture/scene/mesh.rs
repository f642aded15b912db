//! Meshes of bars, discs and rings, built once per machine.
//!
//! Every mesh is a profile in (offset, z) swept around a convex outline in the xy plane, so it is closed by
//! construction. It consists of strips and flat caps. Normals are constant across a strip and smooth along the outline.
//! Lengths are metres, z runs from 0 to the height. Computed in `f64`, stored in `f32`.
//!
//! Invalid sizes are corrected. Negative and non-finite ones are treated as zero, and a bevel is at most half of the
//! radius and a third of the height. A mesh without volume has no triangles.

mod closed;

use std::f64::consts::{PI, TAU};

use super::Mesh;
pub use closed::closed;

/// Number of chords of a circle; the vertices lie on the circle. A multiple of four.
pub const SEGMENTS: usize = 64;
/// Number of chords of a circle in a coarse mesh.
const COARSE_SEGMENTS: usize = 20;

/// Returns a mesh made with the usual number of chords, with its coarse counterpart.
fn with_coarse(mesh: impl Fn(usize) -> Mesh) -> Mesh {
    let fine = mesh(SEGMENTS);
    if fine.triangles.is_empty() {
        return fine;
    }
    Mesh { coarse: Some(Box::new(mesh(COARSE_SEGMENTS))), ..fine }
}

/// A bar with round ends: the points within `radius` of the segment from `(length_from, 0)` to `(length_to, 0)`,
/// from z = 0 to `height`. Its top and bottom edges are bevelled by `bevel`, so that shading shows them.
pub fn bar(length_from: f64, length_to: f64, radius: f64, height: f64, bevel: f64) -> Mesh {
    let [from, to] = [length_from, length_to].map(|x| if x.is_finite() { x } else { 0.0 });
    with_coarse(|segments| prism(&stadium(from.min(to), from.max(to), segments), radius, height, bevel))
}

/// A disc around the z axis with bevelled edges.
pub fn cylinder(radius: f64, height: f64, bevel: f64) -> Mesh {
    with_coarse(|segments| prism(&stadium(0.0, 0.0, segments), radius, height, bevel))
}

/// A flat ring around the z axis, of rectangular section.
pub fn ring(outer: f64, inner: f64, height: f64) -> Mesh {
    let [outer, inner, height] = [outer, inner, height].map(size);
    let (outer, inner) = (outer.max(inner), outer.min(inner));
    if inner == 0.0 {
        return with_coarse(|segments| prism(&stadium(0.0, 0.0, segments), outer, height, 0.0));
    }
    if outer == inner || height == 0.0 {
        return Mesh::default();
    }
    let corners = [[inner, 0.0], [outer, 0.0], [outer, height], [inner, height], [inner, 0.0]];
    with_coarse(|segments| {
        let mut mesh = Mesh::default();
        for side in corners.windows(2) {
            strip(&mut mesh, &stadium(0.0, 0.0, segments), side[0], side[1]);
        }
        mesh
    })
}

/// A plate with straight edges between two sides, given as pairs of opposite points from one end to the other; the first
/// side runs counter-clockwise.
pub fn ribbon(rails: &[[[f64; 2]; 2]], height: f64) -> Mesh {
    let height = size(height);
    let mut mesh = Mesh::default();
    if height == 0.0 || rails.len() < 2 {
        return mesh;
    }
    let at = |[x, y]: [f64; 2], z: f64| [x, y, z];
    for pair in rails.windows(2) {
        let [[a, d], [b, c]] = [pair[0], pair[1]];
        quad(&mut mesh, [at(a, height), at(b, height), at(c, height), at(d, height)]);
        quad(&mut mesh, [at(d, 0.0), at(c, 0.0), at(b, 0.0), at(a, 0.0)]);
        wall(&mut mesh, a, b, height);
        wall(&mut mesh, c, d, height);
    }
    let [first, last] = [rails[0], rails[rails.len() - 1]];
    wall(&mut mesh, first[1], first[0], height);
    wall(&mut mesh, last[0], last[1], height);
    mesh
}

/// Adds the wall over a side, from z = 0 to the height; outside is to the right of the way from a to b.
fn wall(mesh: &mut Mesh, [ax, ay]: [f64; 2], [bx, by]: [f64; 2], height: f64) {
    quad(mesh, [[ax, ay, 0.0], [bx, by, 0.0], [bx, by, height], [ax, ay, height]]);
}

/// Adds a flat face with corners counter-clockwise; a face without area is left out.
fn quad(mesh: &mut Mesh, corners: [[f64; 3]; 4]) {
    let side = |i: usize, j: usize| [0, 1, 2].map(|k| corners[j][k] - corners[i][k]);
    let ([u, v, w], [x, y, z]) = (side(0, 2), side(1, 3));
    let normal = [v * z - w * y, w * x - u * z, u * y - v * x];
    let length = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length == 0.0 {
        return;
    }
    let first = mesh.positions.len() as u32;
    for corner in corners {
        mesh.positions.push(corner.map(|x| x as f32));
        mesh.normals.push(normal.map(|x| (x / length) as f32));
    }
    mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
}

/// A vertex of an outline: x of the centre that it is offset from, and the outward unit vector.
struct Spoke {
    centre: f64,
    out: [f64; 2],
}

/// Returns the outline of a stadium with centres at x = `from` and x = `to`, counter-clockwise from (0, -1). This is
/// a circle if they are equal. `segments` is the number of chords of a circle, a multiple of four.
fn stadium(from: f64, to: f64, segments: usize) -> Vec<Spoke> {
    let half = segments / 2;
    let spoke = |centre, k: usize| {
        // Exact at the quarter turns, so that straight sides are parallel to x and join the round ends exactly.
        let out = match 4 * k {
            0 => [0.0, -1.0],
            x if x == segments => [1.0, 0.0],
            x if x == 2 * segments => [0.0, 1.0],
            x if x == 3 * segments => [-1.0, 0.0],
            _ => {
                let angle = TAU * k as f64 / segments as f64 - 0.5 * PI;
                [angle.cos(), angle.sin()]
            }
        };
        Spoke { centre, out }
    };
    if from == to {
        return (0..segments).map(|k| spoke(from, k)).collect();
    }
    let right = (0..=half).map(|k| spoke(to, k));
    let left = (half..=segments).map(|k| spoke(from, k % segments));
    right.chain(left).collect()
}

fn size(x: f64) -> f64 {
    if x.is_finite() { x.max(0.0) } else { 0.0 }
}

fn prism(outline: &[Spoke], radius: f64, height: f64, bevel: f64) -> Mesh {
    let (radius, height) = (size(radius), size(height));
    if radius == 0.0 || height == 0.0 {
        return Mesh::default();
    }
    let bevel = size(bevel).min(radius / 2.0).min(height / 3.0);
    let profile = [[radius - bevel, 0.0], [radius, bevel], [radius, height - bevel], [radius - bevel, height]];
    let mut mesh = Mesh::default();
    for side in profile.windows(2) {
        strip(&mut mesh, outline, side[0], side[1]);
    }
    cap(&mut mesh, outline, profile[0], -1.0);
    cap(&mut mesh, outline, profile[3], 1.0);
    mesh
}

/// Sweeps the side from `a` to `b`, each (offset, z), around the outline; outside is to the right of a → b.
fn strip(mesh: &mut Mesh, outline: &[Spoke], a: [f64; 2], b: [f64; 2]) {
    let (along, up) = (b[0] - a[0], b[1] - a[1]);
    let length = along.hypot(up);
    if length == 0.0 {
        return;
    }
    let (out, z) = (up / length, -along / length);
    let first = mesh.positions.len() as u32;
    for spoke in outline {
        let normal = [spoke.out[0] * out, spoke.out[1] * out, z];
        push(mesh, spoke, a, normal);
        push(mesh, spoke, b, normal);
    }
    let n = outline.len() as u32;
    for k in 0..n {
        let [a0, b0] = [first + 2 * k, first + 2 * k + 1];
        let [a1, b1] = [first + 2 * ((k + 1) % n), first + 2 * ((k + 1) % n) + 1];
        mesh.triangles.extend([[a0, a1, b1], [a0, b1, b0]]);
    }
}

/// Closes the outline at (offset, z) with a flat fan that faces up (`up` = 1) or down (-1).
fn cap(mesh: &mut Mesh, outline: &[Spoke], at: [f64; 2], up: f64) {
    let first = mesh.positions.len() as u32;
    for spoke in outline {
        push(mesh, spoke, at, [0.0, 0.0, up]);
    }
    for k in 1..outline.len() as u32 - 1 {
        let (b, c) = if up > 0.0 { (k, k + 1) } else { (k + 1, k) };
        mesh.triangles.push([first, first + b, first + c]);
    }
}

fn push(mesh: &mut Mesh, spoke: &Spoke, [offset, z]: [f64; 2], normal: [f64; 3]) {
    let position = [spoke.centre + offset * spoke.out[0], offset * spoke.out[1], z];
    mesh.positions.push(position.map(|x| x as f32));
    mesh.normals.push(normal.map(|x| x as f32));
}
