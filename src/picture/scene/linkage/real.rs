//! A link as it is cut: the solids of which it is made, with their outlines, holes and heights.

use super::cover::Cover;
use super::shape::Shape;
use crate::scene::mesh::closed;
use stillbase_exchange::cut::bar_extent;
use stillbase_exchange::solids::{LinkSolid, Plan, SolidKind, foot};
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
    // A counterweight that no part reaches hangs on a tail, which is drawn only.
    let bars: Vec<&LinkSolid> = own().filter(|solid| !matches!(solid.kind, SolidKind::Disc(_))).collect();
    for solid in own().filter(|solid| matches!(solid.kind, SolidKind::Disc(_))) {
        let Some(tail) = tail(solid, &bars) else { continue };
        let mut body = tail.mesh(machine);
        body.triangles.iter_mut().flatten().for_each(|[_, _, z]| *z -= low);
        let [from, to] = tail.faces(machine);
        covers.push(covered(&tail.plan, &body.triangles, [from - low, to - low]));
        triangles.append(&mut body.triangles);
    }
    let span =
        covers.iter().fold(bar_extent(machine, j), |[from, to], cover| [from.min(cover.at.re), to.max(cover.at.re)]);
    let radius = main.filter(|main| is_bar(main)).map_or(0.0, |bar| half_width(&bar.plan));
    Shape { mesh: closed(&triangles), span, radius, height: high - low, rise: 0.5 * (low + high) - axial, covers }
}

/// Returns a bar from the nearest of the solids of a link to a counterweight that none of them reaches.
fn tail(weight: &LinkSolid, others: &[&LinkSolid]) -> Option<LinkSolid> {
    let [x, y] = [weight.plan.extent(|corner| corner), weight.plan.extent(|corner| corner * Vector::new(0.0, -1.0))];
    let middle = Vector::new(0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]));
    let nearest = others.iter().min_by(|a, b| a.plan.distance(middle).total_cmp(&b.plan.distance(middle)))?;
    if nearest.plan.distance(middle) <= 0.0 {
        return None;
    }
    let feet = nearest.plan.sides(|corner| corner).map(|side| foot(side, middle));
    let from = feet.min_by(|a, b| (a - middle).norm().total_cmp(&(b - middle).norm()))?;
    let narrow = 0.5 * half_width(&nearest.plan).min(half_width(&weight.plan));
    Some(LinkSolid { part: None, plan: Plan::bar([from, middle], narrow), holes: Vec::new(), ..(*nearest).clone() })
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
