//! Outlines of the parts of links, as they are cut.

use stillbase_mechanics::machine::{Counterweight, CounterweightShape, Ends, Machine, Part, PartSource, Shape};

/// A corner of an outline, and the curve to the next: bulge 0 for a straight side, 1 for a half circle to the right of
/// the way round, −1 for one to the left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Position.
    pub at: [f64; 2],
    /// tan of a quarter of the angle of the arc.
    pub bulge: f64,
}

impl Corner {
    fn straight(x: f64, y: f64) -> Self {
        Self { at: [x, y], bulge: 0.0 }
    }
}

/// A piece to be cut, in the axes of its link, m.
#[derive(Clone, Debug, PartialEq)]
pub struct PieceOutline {
    /// The part, counted from 0.
    pub part: usize,
    /// Its closed outline, counter-clockwise.
    pub corners: Vec<Corner>,
    /// Centre and diameter of each hole.
    pub holes: Vec<([f64; 2], f64)>,
    /// Arms of the same plate that are cut with it, counted from 0.
    pub arms: Vec<usize>,
}

/// Returns the pieces of which a link is made, in the order of its parts; arms are cut with the bar that they stand on.
/// A tube or a profile has the outline of its side.
pub fn pieces_of(machine: &Machine, link: usize) -> Vec<PieceOutline> {
    let spec = machine.spec();
    let own = machine.part_bodies().iter().filter(|body| body.link == link).filter_map(|body| match body.source {
        PartSource::Part(i) => Some(i),
        PartSource::Lump(_) => None,
    });
    let spine = machine.spine(link);
    let mut arms: Vec<usize> = own.clone().filter(|i| spine.is_some() && spec.parts[*i].is_arm()).collect();
    arms.sort_by(|a, b| left_of(&spec.parts[*a]).total_cmp(&left_of(&spec.parts[*b])));
    // Arms that overlap are cut by themselves.
    let overlaps = |a: usize, b: usize| {
        let [a, b] = [&spec.parts[a], &spec.parts[b]];
        is_above(a) == is_above(b) && left_of(a) < right_of(b) && left_of(b) < right_of(a)
    };
    let joined: Vec<usize> =
        arms.iter().copied().filter(|a| arms.iter().all(|b| a == b || !overlaps(*a, *b))).collect();
    own.filter(|i| !joined.contains(i))
        .map(|i| {
            let with = if Some(i) == spine { joined.as_slice() } else { &[] };
            let along = spec.parts[i].across;
            let holes = machine.part_holes(i).into_iter().map(|([x, y], diameter)| ([x, y + along], diameter));
            PieceOutline {
                part: i,
                corners: corners(&spec.parts[i], machine.part_ends(i).unwrap_or_default(), with, &spec.parts),
                holes: holes.collect(),
                arms: with.to_vec(),
            }
        })
        .collect()
}

/// Returns the corners of a counterweight that is half a ring or a box, counter-clockwise in the axes of its link, m;
/// none for other shapes.
pub fn weight_corners(weight: &Counterweight) -> Vec<Corner> {
    let across = weight.across;
    match weight.shape() {
        CounterweightShape::HalfRing { radius, inner_radius } => {
            let (x, turn) = (weight.circle_at(), weight.outward());
            let mut corners = vec![
                Corner { at: [x, across - turn * radius], bulge: 1.0 },
                Corner::straight(x, across + turn * radius),
            ];
            if inner_radius > 0.0 {
                corners.push(Corner { at: [x, across + turn * inner_radius], bulge: -1.0 });
                corners.push(Corner::straight(x, across - turn * inner_radius));
            }
            corners
        }
        CounterweightShape::Box { length, width } => {
            let [x, y] = [0.5 * length, 0.5 * width];
            let corner = |[along, left]: [f64; 2]| Corner::straight(weight.at + along, across + left);
            [[-x, -y], [x, -y], [x, y], [-x, y]].map(corner).into()
        }
        _ => Vec::new(),
    }
}

fn xs(part: &Part) -> impl Iterator<Item = f64> {
    part.polygon.iter().map(|corner| corner[0])
}

fn left_of(part: &Part) -> f64 {
    xs(part).fold(f64::INFINITY, f64::min)
}

fn right_of(part: &Part) -> f64 {
    xs(part).fold(f64::NEG_INFINITY, f64::max)
}

fn is_above(part: &Part) -> bool {
    part.polygon.iter().map(|corner| corner[1]).sum::<f64>() > 0.0
}

/// Returns the outer end of an arm.
fn far_end(part: &Part) -> f64 {
    let ys = part.polygon.iter().map(|corner| corner[1]);
    ys.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or_default()
}

fn corners(part: &Part, [from, to]: [f64; 2], arms: &[usize], parts: &[Part]) -> Vec<Corner> {
    if part.shape == Shape::Plate {
        let turns = part.polygon.iter().zip(part.polygon.iter().cycle().skip(1));
        let twice_area: f64 = turns.map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum();
        let corner = |[x, y]: &[f64; 2]| Corner::straight(*x, y + part.across);
        return match twice_area >= 0.0 {
            true => part.polygon.iter().map(corner).collect(),
            false => part.polygon.iter().rev().map(corner).collect(),
        };
    }
    let half = 0.5 * part.breadth().unwrap_or_default();
    let (low, high) = (part.across - half, part.across + half);
    let is_round = part.shape == Shape::Flat && part.ends.unwrap_or_default() == Ends::Round;
    let bulge = if is_round { 1.0 } else { 0.0 };
    let of = |above: bool| arms.iter().map(|i| &parts[*i]).filter(move |arm| is_above(arm) == above);
    let mut all = vec![Corner::straight(from, low)];
    for arm in of(false) {
        let (left, right, far) = (left_of(arm), right_of(arm), far_end(arm));
        all.extend([[left, low], [left, far], [right, far], [right, low]].map(|[x, y]| Corner::straight(x, y)));
    }
    all.extend([Corner { at: [to, low], bulge }, Corner::straight(to, high)]);
    for arm in of(true).collect::<Vec<_>>().into_iter().rev() {
        let (left, right, far) = (left_of(arm), right_of(arm), far_end(arm));
        all.extend([[right, high], [right, far], [left, far], [left, high]].map(|[x, y]| Corner::straight(x, y)));
    }
    all.push(Corner { at: [from, high], bulge });
    // Where an arm stands at the end of the bar, two corners are one; the later one begins the curve.
    let near = |a: &Corner, b: &Corner| (a.at[0] - b.at[0]).abs() + (a.at[1] - b.at[1]).abs() <= 1e-9;
    let mut outline: Vec<Corner> = Vec::with_capacity(all.len());
    for corner in all {
        match outline.last_mut() {
            Some(last) if near(last, &corner) => *last = corner,
            _ => outline.push(corner),
        }
    }
    outline
}
