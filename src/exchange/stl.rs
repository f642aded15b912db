//! Solids of a machine as STL: bars and plates with holes, counterweights, lumps, the payload, pins and spacers, at their
//! heights in a pose.

use std::fmt::Write as _;

use super::cut::{Cut, CutError, SAME_PIN_DISTANCE};
use super::mesh::{bar, circle};
use super::solids::{Axle, LinkSolid, Plan, axles, link_solids};
use stillbase_mechanics::machine::{Machine, Part, Shape, place_of};
use stillbase_mechanics::planar::{UnitVectors, Vector, cross, unit};

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
    let name = solid.name(machine);
    let [low, high] = solid.faces(machine);
    let mesh = match solid.part.map(|i| (i, &machine.spec().parts[i])) {
        Some((i, part)) if matches!(part.shape, Shape::Tube | Shape::Profile) => {
            let along = machine.part_ends(i).unwrap_or_default();
            SolidMesh::pipe(name, &section(part), along, [part.across, 0.5 * (low + high)])
        }
        _ => {
            let holes: Vec<Vec<Vector>> =
                solid.holes.iter().map(|(at, diameter)| circle(*at, 0.5 * diameter)).collect();
            SolidMesh::prism(name, &outline(&solid.plan), &holes, [low, high])
        }
    };
    mesh.placed(place_of(&link.root, e), e[link.drive] * link.sign)
}

/// Returns the outline of an area, counter-clockwise, m.
fn outline(plan: &Plan) -> Vec<Vector> {
    match plan.corners[..] {
        [at] => circle(at, plan.radius),
        [from, to] if from == to => circle(from, plan.radius),
        [from, to] => bar([from, to], plan.radius),
        _ => {
            let twice_area: f64 = plan.sides(|corner| corner).map(|[a, b]| cross(a, b)).sum();
            let mut corners = plan.corners.clone();
            if twice_area < 0.0 {
                corners.reverse();
            }
            corners
        }
    }
}

/// Returns the outer and the inner outline of the section of a tube or a profile about its middle, across and up, m; no
/// inner one if it is not hollow.
fn section(part: &Part) -> Vec<Vec<Vector>> {
    let [width, _, diameter, height, wall] = part.lengths().map(|(_, given)| given.unwrap_or_default());
    let rings = [0.0, 2.0 * wall].into_iter().filter_map(|less| match part.shape {
        Shape::Tube => (diameter > less).then(|| circle(Vector::default(), 0.5 * (diameter - less))),
        _ => {
            let (x, y) = (0.5 * (width - less), 0.5 * (height - less));
            let corners = [[-x, -y], [x, -y], [x, y], [-x, y]].map(|[x, y]| Vector::new(x, y));
            (x > 0.0 && y > 0.0).then(|| corners.to_vec())
        }
    });
    rings.collect()
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
    // A disc or a lump around the pin is thicker than its bar.
    let around = |j: usize| {
        let along = axle.links.iter().find(|(own, _)| *own == j).map_or(0.0, |(_, along)| *along);
        let own = links.iter().filter(|solid| solid.link == j);
        let covering = own.filter(|solid| solid.plan.distance(Vector::new(along, 0.0)) < 0.0);
        let height = machine.spec().links[j].axial;
        covering
            .map(|solid| solid.faces(machine))
            .fold([height; 2], |[low, high], own| [low.min(own[0]), high.max(own[1])])
    };
    let mut below = axle.is_on_base().then_some(low);
    for (i, j) in joined.into_iter().enumerate() {
        let [bottom, top] = around(j);
        if let Some(below) = below.filter(|below| bottom - below > SAME_PIN_DISTANCE) {
            let ring = circle(at, cut.spacer_radius());
            let called = format!("spacer {} on the {}", i + 1, axle.name(machine));
            solids.push(SolidMesh::prism(called, &ring, std::slice::from_ref(&pin), [below, bottom]));
        }
        below = Some(top);
    }
    Ok(())
}
