//! Meshes of bodies that are given as triangles.

use std::collections::HashMap;

use crate::scene::Mesh;

/// Cosine of the largest angle, 30°, between two faces that are shaded as one curved face.
const SMOOTH: f64 = 0.866;
/// Faces whose normals differ by less than this lie in one plane.
const SAME: f64 = 1e-9;

/// Tilt of the normals of faces that look down, towards the sides that they meet. So the rim that sets a solid apart from
/// those below it is seen from straight above, too, where the sides are not.
const TILT: f64 = 0.05;

/// Returns the mesh of a body from its triangles, m, each counter-clockwise from outside. Faces that meet at a small angle
/// are shaded as one curved face. Triangles without area are left out.
pub fn closed(triangles: &[[[f64; 3]; 3]]) -> Mesh {
    let faces: Vec<(&[[f64; 3]; 3], [f64; 3])> =
        triangles.iter().filter_map(|corners| Some((corners, normal(corners)?))).collect();
    // The distinct normals of the faces that meet in each corner.
    let mut around: HashMap<[u64; 3], Vec<[f64; 3]>> = HashMap::with_capacity(faces.len());
    for (corners, normal) in &faces {
        for corner in *corners {
            let known = around.entry(key(corner)).or_default();
            if known.iter().all(|own| dot(own, normal) < 1.0 - SAME) {
                known.push(*normal);
            }
        }
    }
    let mut mesh = Mesh::default();
    let mut numbers: HashMap<([u64; 3], [u32; 3]), u32> = HashMap::with_capacity(faces.len());
    for (corners, normal) in &faces {
        mesh.triangles.push(corners.map(|corner| {
            let met = around.get(&key(&corner)).map_or(&[][..], Vec::as_slice);
            let smooth = met.iter().filter(|own| dot(own, normal) > SMOOTH);
            let mut sum = smooth.fold([0.0; 3], |sum, own| [0, 1, 2].map(|i| sum[i] + own[i]));
            if normal[2] < -SMOOTH {
                for side in met {
                    (sum[0], sum[1]) = (sum[0] + TILT * side[0], sum[1] + TILT * side[1]);
                }
            }
            let shaded = unit(sum).unwrap_or(*normal).map(|x| x as f32);
            *numbers.entry((key(&corner), shaded.map(f32::to_bits))).or_insert_with(|| {
                mesh.positions.push(corner.map(|x| x as f32));
                mesh.normals.push(shaded);
                mesh.positions.len() as u32 - 1
            })
        }));
    }
    mesh
}

/// Returns the bits of a place; 0 and −0 are one.
fn key(place: &[f64; 3]) -> [u64; 3] {
    place.map(|x| (x + 0.0).to_bits())
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(v: [f64; 3]) -> Option<[f64; 3]> {
    let length = dot(&v, &v).sqrt();
    (length > 0.0).then(|| v.map(|x| x / length))
}

/// Returns the unit normal of a triangle; `None` if it has no area.
fn normal([a, b, c]: &[[f64; 3]; 3]) -> Option<[f64; 3]> {
    let side = |to: &[f64; 3]| [0, 1, 2].map(|i| to[i] - a[i]);
    let ([u, v, w], [x, y, z]) = (side(b), side(c));
    unit([v * z - w * y, w * x - u * z, u * y - v * x])
}
