//! [`SolidMesh`]: a prism on an outline with holes, as triangles that close it.

use stillbase_mechanics::planar::{self, Vector, cross, dot, unit};

/// A closed surface of triangles, m, seen counter-clockwise from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidMesh {
    /// Its name.
    pub name: String,
    /// Its triangles.
    pub triangles: Vec<[[f64; 3]; 3]>,
}

/// Number of straight sides of a full circle.
const SIDES: usize = 64;

/// Returns a circle as a polygon, counter-clockwise, m. The area of the polygon is that of the circle.
pub(super) fn circle(centre: Vector, radius: f64) -> Vec<Vector> {
    planar::circle(centre, radius, SIDES)
}

/// Returns the outline of a bar with round ends, counter-clockwise, m: half a polygon at each end, with the area of half a
/// circle.
pub(super) fn bar([from, to]: [Vector; 2], radius: f64) -> Vec<Vector> {
    let along = to - from;
    let way = if along.norm_sqr() > 0.0 { along / along.norm() } else { Vector::new(1.0, 0.0) };
    let (count, bulged) = (SIDES / 2, equal_half_area());
    let half = |centre: Vector, first: usize| {
        let out = move |i: usize| if i == 0 || i == count { radius } else { bulged * radius };
        (0..=count).map(move |i| centre + way * turned(first + i) * out(i))
    };
    half(to, 3 * SIDES / 4).chain(half(from, SIDES / 4)).collect()
}

/// Returns the ratio of the radius of half a polygon to that of the half circle with its area, if its ends stay on the
/// circle: n sides have sin(step) (2 s + (n − 2) s²) = π.
fn equal_half_area() -> f64 {
    let (sides, step) = ((SIDES / 2) as f64, std::f64::consts::TAU / SIDES as f64);
    let n = sides - 2.0;
    ((1.0 + n * std::f64::consts::PI / step.sin()).sqrt() - 1.0) / n
}

fn turned(i: usize) -> Vector {
    unit(std::f64::consts::TAU * (i % SIDES) as f64 / SIDES as f64)
}

impl SolidMesh {
    /// Returns the prism between two heights, m, on an outline with holes, all counter-clockwise.
    pub(super) fn prism(name: String, outline: &[Vector], holes: &[Vec<Vector>], [low, high]: [f64; 2]) -> Self {
        let mut triangles = Vec::new();
        let (caps, drilled) = covered(outline, holes);
        for [a, b, c] in caps {
            let at = |p: Vector, z: f64| [p.re, p.im, z];
            triangles.push([at(a, high), at(b, high), at(c, high)]);
            triangles.push([at(a, low), at(c, low), at(b, low)]);
        }
        let mut wall = |ring: &[Vector], outward: bool| {
            for (i, &a) in ring.iter().enumerate() {
                let b = ring[(i + 1) % ring.len()];
                let (a, b) = if outward { (a, b) } else { (b, a) };
                let [p, q] = [a, b].map(|p| [p.re, p.im, low]);
                let [r, s] = [a, b].map(|p| [p.re, p.im, high]);
                triangles.extend([[p, q, s], [p, s, r]]);
            }
        };
        wall(outline, true);
        drilled.into_iter().for_each(|hole| wall(hole, false));
        Self { name, triangles }
    }

    /// Returns a bar along x from one place to another, m, for the outer and the inner outline of its section, across and
    /// up, both counter-clockwise, and the place of the middle of its section, m.
    pub(super) fn pipe(name: String, section: &[Vec<Vector>], along: [f64; 2], [across, up]: [f64; 2]) -> Self {
        let Some((outer, inner)) = section.split_first() else { return Self { name, triangles: Vec::new() } };
        let mut upright = Self::prism(name, outer, inner, along);
        for [x, y, z] in upright.triangles.iter_mut().flatten() {
            (*x, *y, *z) = (*z, *x + across, *y + up);
        }
        upright
    }

    /// Returns the solid with its origin at a point, m, and its x axis along a direction.
    #[must_use]
    pub(super) fn placed(mut self, origin: Vector, way: Vector) -> Self {
        for [x, y, _] in self.triangles.iter_mut().flatten() {
            let at = origin + way * Vector::new(*x, *y);
            [*x, *y] = [at.re, at.im];
        }
        self
    }

    /// Returns its volume, m³.
    pub fn volume(&self) -> f64 {
        // About a corner of its own, so that no digits are lost far from the origin.
        let Some(&[origin, ..]) = self.triangles.first() else { return 0.0 };
        let from = |p: [f64; 3]| [0, 1, 2].map(|i| p[i] - origin[i]);
        let six = |&[a, b, c]: &[[f64; 3]; 3]| {
            let [a, b, c] = [from(a), from(b), from(c)];
            a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        self.triangles.iter().map(six).sum::<f64>() / 6.0
    }
}

/// Divides an outline with holes into triangles, counter-clockwise. Returns the holes, too, without those that do not
/// lie within the outline.
fn covered<'a>(outline: &[Vector], holes: &'a [Vec<Vector>]) -> (Vec<[Vector; 3]>, Vec<&'a [Vector]>) {
    let (mut ring, mut drilled) = (outline.to_vec(), Vec::new());
    // Each hole is joined to the ring by a cut, that with the rightmost corner first, so that no later hole is in the way.
    let rightmost = |hole: &[Vector]| (0..hole.len()).max_by(|i, j| hole[*i].re.total_cmp(&hole[*j].re));
    let mut open: Vec<(usize, &'a Vec<Vector>)> =
        holes.iter().filter_map(|hole| Some((rightmost(hole)?, hole))).collect();
    open.sort_by(|(i, a), (j, b)| b[*j].re.total_cmp(&a[*i].re));
    for (start, hole) in open {
        let from = hole[start];
        let Some(at) = (0..ring.len())
            .filter(|&i| sees(&ring, i, from))
            .min_by(|&i, &j| (ring[i] - from).norm_sqr().total_cmp(&(ring[j] - from).norm_sqr()))
        else {
            continue;
        };
        // Around the hole clockwise, and back along the cut.
        let around = (0..=hole.len()).map(|i| hole[(start + hole.len() - i % hole.len()) % hole.len()]);
        let cut: Vec<Vector> = around.chain([ring[at]]).collect();
        ring.splice(at + 1..at + 1, cut);
        drilled.push(hole.as_slice());
    }
    (clipped(ring), drilled)
}

/// Returns whether the straight way from a point to a corner of a ring lies within the ring, right of the point.
fn sees(ring: &[Vector], corner: usize, from: Vector) -> bool {
    let (n, to) = (ring.len(), ring[corner]);
    let (before, after) = (ring[(corner + n - 1) % n], ring[(corner + 1) % n]);
    to.re >= from.re
        && is_inside(before, to, after, from)
        && (0..n).all(|i| {
            let (a, b) = (ring[i], ring[(i + 1) % n]);
            a == to || b == to || !crosses(from, to, a, b)
        })
}

/// Returns whether a point lies in the angle of a corner.
fn is_inside(before: Vector, corner: Vector, after: Vector, p: Vector) -> bool {
    let (left_of_in, left_of_out) = (cross(corner - before, p - corner) > 0.0, cross(after - corner, p - corner) > 0.0);
    match cross(corner - before, after - corner) >= 0.0 {
        true => left_of_in && left_of_out,
        false => left_of_in || left_of_out,
    }
}

fn crosses(p: Vector, q: Vector, a: Vector, b: Vector) -> bool {
    let (along, side) = (q - p, b - a);
    let ends = [cross(along, a - p), cross(along, b - p), cross(side, p - a), cross(side, q - a)];
    ends[0] * ends[1] <= 0.0 && ends[2] * ends[3] <= 0.0
}

/// Cuts off one corner after the other; of those that can be, the one whose triangle is widest.
fn clipped(mut ring: Vec<Vector>) -> Vec<[Vector; 3]> {
    let mut triangles = Vec::with_capacity(ring.len());
    while ring.len() > 3 {
        let n = ring.len();
        let corner = |i: usize| [ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]];
        let ear =
            (0..n).filter(|&i| is_ear(&ring, corner(i))).max_by(|&i, &j| width(corner(i)).total_cmp(&width(corner(j))));
        let Some(i) = ear else { break };
        triangles.push(corner(i));
        ring.remove(i);
    }
    if let [a, b, c] = ring[..] {
        triangles.push([a, b, c]);
    }
    triangles
}

/// Returns whether a corner of a ring can be cut off.
fn is_ear(ring: &[Vector], [a, b, c]: [Vector; 3]) -> bool {
    let within = |p: Vector| cross(b - a, p - a) >= 0.0 && cross(c - b, p - b) >= 0.0 && cross(a - c, p - c) >= 0.0;
    cross(b - a, c - b) > 0.0 && ring.iter().all(|&p| p == a || p == b || p == c || !within(p))
}

/// Returns the width of a triangle relative to its length.
fn width([a, b, c]: [Vector; 3]) -> f64 {
    let longest = [b - a, c - b, a - c].into_iter().map(|side| dot(side, side)).fold(0.0, f64::max);
    cross(b - a, c - a) / longest.max(f64::MIN_POSITIVE)
}
