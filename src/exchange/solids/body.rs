//! The body of a [`LinkSolid`]: triangles that close it.

use super::LinkSolid;
use crate::mesh::{SolidMesh, circle};
use stillbase_mechanics::machine::{Machine, Part, Shape};
use stillbase_mechanics::planar::Vector;

impl LinkSolid {
    /// Returns its body in the axes of its link, at its height: a prism on its outline with its holes, or a tube or a
    /// profile along the link.
    pub fn mesh(&self, machine: &Machine) -> SolidMesh {
        let name = self.name(machine);
        let [low, high] = self.faces(machine);
        match self.part.map(|i| (i, &machine.spec().parts[i])) {
            Some((i, part)) if matches!(part.shape, Shape::Tube | Shape::Profile) => {
                let along = machine.part_ends(i).unwrap_or_default();
                SolidMesh::pipe(name, &section(part), along, [part.across, 0.5 * (low + high)])
            }
            _ => {
                let holes: Vec<Vec<Vector>> =
                    self.holes.iter().map(|(at, diameter)| circle(*at, 0.5 * diameter)).collect();
                SolidMesh::prism(name, &self.plan.outline(), &holes, [low, high])
            }
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
