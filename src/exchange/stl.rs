//! Solids of a machine as STL: bars with round ends and holes, discs, pins and spacers, at their heights in a pose.

use std::fmt::Write as _;

use super::cut::{Cut, CutError, SAME_PIN_DISTANCE};
use super::mesh::{bar, circle};
use super::solids::{Axle, LinkSolid, SolidKind, axles, link_solids};
use stillbase_mechanics::machine::{Machine, place_of};
use stillbase_mechanics::planar::{UnitVectors, Vector, unit};

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
    cut.check_stack(machine)?;
    if pose.len() != machine.drives() {
        return Err(SolidsError::Pose { given: pose.len(), wanted: machine.drives() });
    }
    if let Some(bad) = pose.iter().find(|q| !q.is_finite()) {
        return Err(SolidsError::Angle(*bad));
    }
    let e: UnitVectors = std::array::from_fn(|k| unit(pose.get(k).copied().unwrap_or_default()));
    let (links, axles) = (link_solids(machine, cut), axles(machine));
    let mut solids: Vec<SolidMesh> = links.iter().map(|solid| link_mesh(machine, cut, solid, &e)).collect();
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

/// Returns a bar, an arm or a disc.
fn link_mesh(machine: &Machine, cut: &Cut, solid: &LinkSolid, e: &UnitVectors) -> SolidMesh {
    let part = &machine.resolved_links()[solid.link];
    let is_disc = matches!(solid.kind, SolidKind::Disc(_));
    let drilled = |along: &f64| {
        let p = Vector::new(*along, 0.0);
        match solid.kind {
            SolidKind::Bar => true,
            // An edge that a hole would cut through stays whole.
            SolidKind::Disc(_) => (p - solid.ends[0]).norm() + 0.5 * cut.pin_diameter < 0.98 * solid.radius,
            SolidKind::Arm(_) => false,
        }
    };
    let mut pins = part.pins.clone();
    pins.dedup_by(|b, a| *b - *a <= SAME_PIN_DISTANCE);
    let holes = pins.iter().filter(|along| drilled(along));
    let holes: Vec<Vec<Vector>> = holes.map(|along| circle(Vector::new(*along, 0.0), 0.5 * cut.pin_diameter)).collect();
    let outline = if is_disc { circle(solid.ends[0], solid.radius) } else { bar(solid.ends, solid.radius) };
    let (middle, half) = (machine.spec().links[solid.link].axial, 0.5 * solid.thickness);
    SolidMesh::prism(solid.name(machine), &outline, &holes, [middle - half, middle + half])
        .placed(place_of(&part.root, e), e[part.drive] * part.sign)
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
    let mut joined: Vec<usize> = axle.links.iter().map(|(j, _)| *j).collect();
    joined.sort_by(|i, j| height(*i).total_cmp(&height(*j)));
    let name = |j: usize| machine.spec().links[j].name.clone();
    if let Some(pair) = joined.windows(2).find(|pair| height(pair[1]) - height(pair[0]) < cut.plate_thickness) {
        return Err(SolidsError::Height { a: name(pair[0]), b: name(pair[1]) });
    }
    let Some([low, high]) = axle.faces(machine, cut) else { return Ok(()) };
    let pin = circle(at, 0.5 * cut.pin_diameter);
    solids.push(SolidMesh::prism(axle.name(machine), &pin, &[], [low, high]));
    // A disc around the pin is thicker than its bar.
    let half = |j: usize| {
        let around = links.iter().filter(|solid| solid.link == j).filter(|solid| {
            let along = axle.links.iter().find(|(own, _)| *own == j).map_or(0.0, |(_, along)| *along);
            let apart = (Vector::new(along, 0.0) - solid.ends[0]).norm();
            matches!(solid.kind, SolidKind::Bar) || solid.ends[0] == solid.ends[1] && apart < solid.radius
        });
        0.5 * around.map(|solid| solid.thickness).fold(0.0, f64::max)
    };
    let mut below = axle.is_on_base().then_some(low);
    for (i, j) in joined.into_iter().enumerate() {
        let (bottom, top) = (height(j) - half(j), height(j) + half(j));
        if let Some(below) = below.filter(|below| bottom - below > SAME_PIN_DISTANCE) {
            let ring = circle(at, cut.spacer_radius());
            let called = format!("spacer {} on the {}", i + 1, axle.name(machine));
            solids.push(SolidMesh::prism(called, &ring, std::slice::from_ref(&pin), [below, bottom]));
        }
        below = Some(top);
    }
    Ok(())
}
