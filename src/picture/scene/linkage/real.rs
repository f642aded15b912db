//! A link as it is cut: the solids of which it is made, with their outlines, holes and heights.

use super::cover::Cover;
use super::shape::Shape;
use crate::scene::mesh::closed;
use stillbase_exchange::cut::bar_extent;
use stillbase_exchange::solids::{LinkSolid, Plan, SolidKind};
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::Vector;

/// Returns the shape of a link, counted from 0, from the solids of all links.
pub fn real(machine: &Machine, j: usize, solids: &[LinkSolid]) -> Shape {
    let own = || solids.iter().filter(|solid| solid.link == j);
    let main = own().next();
    let axial = machine.spec().links[j].axial;
    let [low, high] = main.map_or([axial; 2], |main| main.faces(machine));
    let is_bar = |solid: &LinkSolid| solid.kind == SolidKind::Bar;
    let mut triangles = Vec::new();
    let mut covers = Vec::new();
    for solid in own() {
        let mut body = solid.mesh(machine);
        body.triangles.iter_mut().flatten().for_each(|[_, _, z]| *z -= low);
        if !is_bar(solid) {
            let [from, to] = solid.faces(machine);
            covers.push(covered(&solid.plan, &body.triangles, [from - low, to - low]));
        }
        triangles.append(&mut body.triangles);
    }
    let span =
        covers.iter().fold(bar_extent(machine, j), |[from, to], cover| [from.min(cover.at.re), to.max(cover.at.re)]);
    let radius = main.filter(|main| is_bar(main)).map_or(0.0, |bar| half_width(&bar.plan));
    Shape { mesh: closed(&triangles), span, radius, height: high - low, rise: 0.5 * (low + high) - axial, covers }
}

/// Returns the area of a solid, from its triangles, between two heights above the bar, m.
fn covered(plan: &Plan, triangles: &[[[f64; 3]; 3]], [low, high]: [f64; 2]) -> Cover {
    let [x, y] = [plan.extent(|corner| corner), plan.extent(|corner| corner * Vector::new(0.0, -1.0))];
    let middle = |[low, high]: [f64; 2]| 0.5 * (low + high);
    let at = Vector::new(middle(x), middle(y));
    let (ends, radius) = match plan.corners[..] {
        [at] => ([at; 2], plan.radius),
        [from, to] => ([from, to], plan.radius),
        _ => {
            // The strip around a polygon.
            let [long, wide] = [x, y].map(|[low, high]| 0.5 * (high - low));
            let end = Vector::new((long - wide).max(0.0), (wide - long).max(0.0));
            ([at - end, at + end], std::f64::consts::SQRT_2 * long.min(wide))
        }
    };
    let is_top = |corners: &&[[f64; 3]; 3]| corners.iter().all(|[.., z]| (z - high).abs() <= 1e-9 * (high - low));
    let area = |corners: &[[f64; 3]; 3]| corners.map(|[x, y, _]| Vector::new(x, y)).to_vec();
    let areas = match plan.is_polygon() {
        true => triangles.iter().filter(is_top).map(area).collect(),
        false => Vec::new(),
    };
    Cover { at, ends, radius, areas, z: low, height: high - low }
}

/// Returns half the width of a bar across its link, m.
fn half_width(plan: &Plan) -> f64 {
    let [low, high] = plan.extent(|corner| corner * Vector::new(0.0, -1.0));
    0.5 * (high - low)
}
