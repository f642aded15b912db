//! Solids of a machine as STL: bars and plates with holes, counterweights, lumps, the payload, pins and spacers, at their
//! heights in a pose.

use std::fmt::Write as _;

use super::cut::{Cut, CutError};
use super::mesh::circle;
use super::solids::{Axle, LinkSolid, Spacer, axles, link_solids};
use stillbase_mechanics::machine::{Machine, place_of};
use stillbase_mechanics::planar::{UnitVectors, unit};

pub use super::mesh::SolidMesh;

/// Error of links that make no solids.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolidsError {
    /// The parts cannot be cut with these dimensions.
    #[error(transparent)]
    Cut(#[from] CutError),
    /// The pose has the wrong number of angles.
    #[error("a pose of {given} angles: want {wanted}, one for each drive")]
    Pose {
        /// Number of angles given.
        given: usize,
        /// Number of drives.
        wanted: usize,
    },
    /// An angle of the pose is no number.
    #[error("an angle of {0} rad in the pose: want finite angles")]
    Angle(f64),
    /// Two links on one pin run through each other.
    #[error(
        "links {a:?} and {b:?} share a pin and a height: want heights that differ by a bar at least; \
         `stillbase layers` finds them"
    )]
    Height {
        /// The first link.
        a: String,
        /// The second link.
        b: String,
    },
}

/// Returns all solids of a machine in a pose, rad.
///
/// # Errors
/// If the parts cannot be cut, the pose has the wrong number of angles or one that is no number, or two links on one pin share a height.
pub fn solids(machine: &Machine, pose: &[f64], cut: &Cut) -> Result<Vec<SolidMesh>, SolidsError> {
    cut.check(machine)?;
    if pose.len() != machine.drives() {
        return Err(SolidsError::Pose { given: pose.len(), wanted: machine.drives() });
    }
    if let Some(bad) = pose.iter().find(|q| !q.is_finite()) {
        return Err(SolidsError::Angle(*bad));
    }
    let e: UnitVectors = std::array::from_fn(|k| unit(pose.get(k).copied().unwrap_or_default()));
    let (links, axles) = (link_solids(machine, cut), axles(machine));
    let mut solids: Vec<SolidMesh> = links.iter().map(|solid| link_mesh(machine, solid, &e)).collect();
    for axle in axles.iter().filter(|axle| axle.is_pin()) {
        pin_meshes(machine, cut, (axle, &links), &e, &mut solids)?;
    }
    Ok(solids)
}

/// Returns the text of the file, in mm: a solid of its own for each part.
///
/// # Errors
/// As [`solids`].
pub fn stl(machine: &Machine, pose: &[f64], cut: &Cut) -> Result<String, SolidsError> {
    let mut out = String::new();
    for solid in solids(machine, pose, cut)? {
        let name: String = solid.name.chars().map(|c| if c.is_ascii_graphic() { c } else { '_' }).collect();
        // Writing to a `String` never fails.
        let _ = writeln!(out, "solid {name}");
        for triangle in &solid.triangles {
            let [x, y, z] = normal(triangle);
            let _ = writeln!(out, "facet normal {x:.6} {y:.6} {z:.6}\nouter loop");
            for [x, y, z] in triangle {
                let _ = writeln!(out, "vertex {:.6} {:.6} {:.6}", 1e3 * x, 1e3 * y, 1e3 * z);
            }
            out.push_str("endloop\nendfacet\n");
        }
        let _ = writeln!(out, "endsolid {name}");
    }
    Ok(out)
}

fn normal([a, b, c]: &[[f64; 3]; 3]) -> [f64; 3] {
    let minus = |p: &[f64; 3]| [0, 1, 2].map(|i| p[i] - a[i]);
    let ([u, v, w], [x, y, z]) = (minus(b), minus(c));
    let n = [v * z - w * y, w * x - u * z, u * y - v * x];
    let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
    // Adding zero removes the sign of -0.
    n.map(|x| if length > 0.0 { x / length + 0.0 } else { 0.0 })
}

/// Returns a solid of a link in a pose.
fn link_mesh(machine: &Machine, solid: &LinkSolid, e: &UnitVectors) -> SolidMesh {
    let link = &machine.resolved_links()[solid.link];
    solid.mesh(machine).placed(place_of(&link.root, e), e[link.drive] * link.sign)
}

/// Adds a pin and the spacers around it, from one link to the next.
fn pin_meshes(
    machine: &Machine,
    cut: &Cut,
    (axle, links): (&Axle, &[LinkSolid]),
    e: &UnitVectors,
    solids: &mut Vec<SolidMesh>,
) -> Result<(), SolidsError> {
    let at = place_of(&axle.at, e);
    let height = |j: usize| machine.spec().links[j].axial;
    let joined = axle.upwards(machine);
    let name = |j: usize| machine.spec().links[j].name.clone();
    if let Some(pair) = joined.windows(2).find(|pair| height(pair[1]) - height(pair[0]) < cut.plate_thickness) {
        return Err(SolidsError::Height { a: name(pair[0]), b: name(pair[1]) });
    }
    let Some(faces) = axle.faces(machine, cut) else { return Ok(()) };
    let pin = circle(at, 0.5 * cut.pin_diameter);
    solids.push(SolidMesh::prism(axle.name(machine), &pin, &[], faces));
    for Spacer { number, faces } in axle.spacers(machine, cut, links) {
        let ring = circle(at, cut.spacer_radius());
        let called = format!("spacer {number} on the {}", axle.name(machine));
        solids.push(SolidMesh::prism(called, &ring, std::slice::from_ref(&pin), faces));
    }
    Ok(())
}
