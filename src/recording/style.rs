//! Names and styles of entities: the colours of the palette in the types of the viewer.

use crate::rerun::EntityPathPart;
use crate::rerun::{AsComponents, Color, EntityPath, LineStrips3D, Mesh3D, Radius, SerializedComponentBatch};

use super::eye::Eye;
use stillbase_picture::scene::{Mesh, Rgba};
use stillbase_simulation::signals::Signal;

/// Returns the path of an entity under another, part by part.
pub fn under(root: &EntityPath, path: &str) -> EntityPath {
    let parts = path.split('/').map(EntityPathPart::new);
    EntityPath::new(root.iter().cloned().chain(parts).collect())
}

/// Converts a colour of the palette.
pub fn colour(rgba: Rgba) -> Color {
    let [r, g, b, a] = rgba.map(|x| (255.0 * x.clamp(0.0, 1.0)).round() as u8);
    Color::from_unmultiplied_rgba(r, g, b, a)
}

/// Returns symbol and unit, like `τ₁ N m`, because axes of Rerun have no labels.
pub fn series_name(signal: &Signal) -> String {
    match signal.unit {
        "1" => signal.symbol.clone(),
        unit => format!("{} {unit}", signal.symbol),
    }
}

/// Formats a number with four decimals, or with a power of ten below 1e-3.
pub fn brief(x: f64) -> String {
    match x.abs() {
        0.0 => "0".into(),
        a if a < 1e-3 => format!("{x:.1e}"),
        _ => format!("{x:.4}"),
    }
}

/// Returns a mesh in one colour, in the axes of an eye. For a drawing seen from above, only faces that point up are
/// included, without shading.
pub fn solid(mesh: &Mesh, rgba: Rgba, eye: &Eye) -> Mesh3D {
    if eye.is_above() {
        return drawn(mesh, rgba, eye);
    }
    Mesh3D::new(mesh.positions.iter().map(|p| eye.place(*p)))
        .with_vertex_normals(mesh.normals.iter().map(|n| eye.turn(*n)))
        .with_triangle_indices(mesh.triangles.iter().copied())
        .with_albedo_factor(colour(rgba).0)
}

/// Returns the faces of a mesh that point up, without normals.
fn drawn(mesh: &Mesh, rgba: Rgba, eye: &Eye) -> Mesh3D {
    let is_up = |triangle: &&[u32; 3]| triangle.iter().all(|v| mesh.normals[*v as usize][2] > 0.05);
    let mut places = vec![None; mesh.positions.len()];
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for triangle in mesh.triangles.iter().filter(is_up) {
        triangles.push(triangle.map(|v| {
            *places[v as usize].get_or_insert_with(|| {
                positions.push(eye.place(mesh.positions[v as usize]));
                positions.len() as u32 - 1
            })
        }));
    }
    Mesh3D::new(positions).with_triangle_indices(triangles).with_albedo_factor(colour(rgba).0)
}

/// Returns lines; `width` in points on the screen.
pub fn lines(strips: impl IntoIterator<Item = Vec<[f32; 3]>>, width: f32, rgba: Rgba) -> LineStrips3D {
    LineStrips3D::new(strips).with_radii([Radius::new_ui_points(0.5 * width)]).with_colors([colour(rgba)])
}

/// Several archetypes as one row of an entity.
pub struct CombinedArchetypes<'a>(pub &'a [&'a dyn AsComponents]);

impl AsComponents for CombinedArchetypes<'_> {
    fn as_serialized_batches(&self) -> Vec<SerializedComponentBatch> {
        self.0.iter().flat_map(|archetype| archetype.as_serialized_batches()).collect()
    }
}
