//! How entities are named and how they look: the palette's colours with their meanings, as the viewer wants them.

use rerun::external::re_log_types::EntityPathPart;
use rerun::{
    AsComponents, Color, EntityPath, LineStrips3D, Mesh3D, Points3D, Quaternion, Radius, SerializedComponentBatch,
};

use crate::mechanics::planar::Vector;
use crate::picture::scene::linkage::mix;
use crate::picture::scene::palette::Palette;
use crate::picture::scene::{Mesh, Rgba};
use crate::simulation::signals::Signal;

/// The path of an entity under another, part by part.
pub fn under(root: &EntityPath, path: &str) -> EntityPath {
    let parts = path.split('/').map(EntityPathPart::new);
    EntityPath::new(root.iter().cloned().chain(parts).collect())
}

/// The same with a name at its end, which may hold anything.
pub fn named(root: &EntityPath, path: &str, name: &str) -> EntityPath {
    let parts = path.split('/').chain([name]).map(EntityPathPart::new);
    EntityPath::new(root.iter().cloned().chain(parts).collect())
}

/// A colour of the palette.
pub fn colour(rgba: Rgba) -> Color {
    let [r, g, b, a] = rgba.map(|x| (255.0 * x.clamp(0.0, 1.0)).round() as u8);
    Color::from_unmultiplied_rgba(r, g, b, a)
}

/// The colour that a signal has in every plot.
pub fn signal_colour(signal: &Signal, palette: &Palette) -> Rgba {
    let paler = |rgba| mix(rgba, palette.dim, 0.6);
    match (signal.drive, signal.path.as_str()) {
        (Some(k), path) if path.starts_with("reference/") => paler(palette.drive(k)),
        (Some(k), _) => palette.drive(k),
        (None, "pose/b") => palette.amber,
        (None, "pose/b_reference") => paler(palette.amber),
        (None, "moment/total" | "force/dynamic") => palette.reaction,
        (None, path) if path.starts_with("moment/") || path.starts_with("force/") => paler(palette.reaction),
        (None, "reactionless/now") => palette.zero,
        (None, _) => palette.ink,
    }
}

/// `τ₁ N m`: Rerun has no label on the axis.
pub fn series_name(signal: &Signal) -> String {
    match signal.unit {
        "1" => signal.symbol.clone(),
        unit => format!("{} {unit}", signal.symbol),
    }
}

/// A number with the digits that matter: tiny ones in powers of ten.
pub fn brief(x: f64) -> String {
    match x.abs() {
        0.0 => "0".into(),
        a if a < 1e-3 => format!("{x:.1e}"),
        _ => format!("{x:.4}"),
    }
}

/// A point of the scene, m, where `f64` turns into `f32`.
pub fn point(p: Vector, z: f64) -> [f32; 3] {
    [p.re as f32, p.im as f32, z as f32]
}

/// A turn about z by the angle of a unit vector.
pub fn turned(along: Vector) -> Quaternion {
    let half = 0.5 * along.arg();
    Quaternion::from_xyzw([0.0, 0.0, half.sin() as f32, half.cos() as f32])
}

/// A mesh in one colour.
pub fn solid(mesh: &Mesh, rgba: Rgba) -> Mesh3D {
    Mesh3D::new(mesh.positions.iter().copied())
        .with_vertex_normals(mesh.normals.iter().copied())
        .with_triangle_indices(mesh.triangles.iter().copied())
        .with_albedo_factor(colour(rgba).0)
}

/// Lines of a width, points on the screen.
pub fn lines(strips: impl IntoIterator<Item = Vec<[f32; 3]>>, width: f32, rgba: Rgba) -> LineStrips3D {
    LineStrips3D::new(strips).with_radii([Radius::new_ui_points(0.5 * width)]).with_colors([colour(rgba)])
}

/// How dots look whose places come later; their radius in points on the screen.
pub fn dots(radius: f32, rgba: Rgba) -> Points3D {
    Points3D::update_fields().with_radii([Radius::new_ui_points(radius)]).with_colors([colour(rgba)])
}

/// Two archetypes in one row.
pub struct Both<'a>(pub &'a dyn AsComponents, pub &'a dyn AsComponents);

impl AsComponents for Both<'_> {
    fn as_serialized_batches(&self) -> Vec<SerializedComponentBatch> {
        [self.0, self.1].map(|a| a.as_serialized_batches()).concat()
    }
}
