//! Triangulation of a plane area inside closed loops, with holes, by the even-odd rule. The area is divided into
//! horizontal bands between consecutive vertex heights; each band consists of trapezoids between pairs of edges.

use super::Mesh;

/// Returns the mesh inside closed loops, m; the last point of a loop connects to its first. The mesh is at z = 0 and
/// visible from both sides.
pub fn mesh(loops: &[Vec<[f64; 2]>]) -> Mesh {
    let mut mesh = Mesh { shell: true, ..Mesh::default() };
    // Edges directed upwards, without horizontal ones.
    let edges = loops.iter().flat_map(|line| (0..line.len()).map(|i| [line[i], line[(i + 1) % line.len()]]));
    let mut edges: Vec<[[f64; 2]; 2]> =
        edges.filter(|[a, b]| a[1] != b[1]).map(|[a, b]| if a[1] < b[1] { [a, b] } else { [b, a] }).collect();
    edges.sort_by(|a, b| a[0][1].total_cmp(&b[0][1]));
    let mut levels: Vec<f64> = edges.iter().flatten().map(|p| p[1]).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    let (mut next, mut active): (usize, Vec<[[f64; 2]; 2]>) = (0, Vec::new());
    for band in levels.windows(2) {
        let [low, high] = [band[0], band[1]];
        active.retain(|[_, b]| b[1] >= high);
        while let Some(edge) = edges.get(next).filter(|edge| edge[0][1] <= low) {
            active.push(*edge);
            next += 1;
        }
        active.sort_by(|a, b| at(a, 0.5 * (low + high)).total_cmp(&at(b, 0.5 * (low + high))));
        for pair in active.chunks_exact(2) {
            let corners = [(0, low), (1, low), (1, high), (0, high)].map(|(side, y)| [at(&pair[side], y), y]);
            let first = mesh.positions.len() as u32;
            mesh.positions.extend(corners.map(|[x, y]| [x as f32, y as f32, 0.0]));
            mesh.normals.extend([[0.0, 0.0, 1.0]; 4]);
            // Where two edges meet, the trapezoid is a triangle.
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| first + i);
            mesh.triangles.extend((corners[0] != corners[1]).then_some([a, b, c]));
            mesh.triangles.extend((corners[2] != corners[3]).then_some([a, c, d]));
        }
    }
    mesh
}

/// Returns x of an edge at height y; exact at its end points, so that bands meet without gaps.
fn at([from, to]: &[[f64; 2]; 2], y: f64) -> f64 {
    match y {
        y if y <= from[1] => from[0],
        y if y >= to[1] => to[0],
        y => from[0] + (y - from[1]) / (to[1] - from[1]) * (to[0] - from[0]),
    }
}
