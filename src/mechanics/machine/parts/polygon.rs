//! Plates with straight sides: area, centre and second moment by Green's formulas, and whether sides cross.

use super::body::PlaneBody;

type Point = [f64; 2];

/// Returns the sides, each from a corner to the next.
fn sides(corners: &[Point]) -> impl Iterator<Item = (Point, Point)> + Clone {
    corners.iter().copied().zip(corners.iter().copied().cycle().skip(1))
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Returns the polygon as a body of density 1, whichever way round its corners are listed.
pub(super) fn body(corners: &[Point]) -> PlaneBody {
    let Some(&first) = corners.first() else { return PlaneBody::default() };
    let about = |origin: Point| corners.iter().map(|corner| minus(*corner, origin)).collect::<Vec<_>>();
    // Sums about a corner, then about the centre, so that a plate far from the root loses no digits.
    let own = about(first);
    let twice: f64 = sides(&own).map(|(a, b)| cross(a, b)).sum();
    let centre = [0, 1].map(|i| sides(&own).map(|(a, b)| (a[i] + b[i]) * cross(a, b)).sum::<f64>() / (3.0 * twice));
    let own: Vec<Point> = own.into_iter().map(|corner| minus(corner, centre)).collect();
    let second: f64 = sides(&own).map(|(a, b)| cross(a, b) * (dot(a, a) + dot(a, b) + dot(b, b))).sum();
    PlaneBody {
        mass: 0.5 * twice.abs(),
        at: first[0] + centre[0],
        across: first[1] + centre[1],
        inertia: second.abs() / 12.0,
    }
}

/// Returns the numbers, from 1, of two sides that meet elsewhere than in a common corner.
pub(super) fn crossing(corners: &[Point]) -> Option<(usize, usize)> {
    let all: Vec<(Point, Point)> = sides(corners).collect();
    let n = all.len();
    for (i, &(a, b)) in all.iter().enumerate() {
        for (j, &(c, d)) in all.iter().enumerate().skip(i + 1) {
            let meets = if j == i + 1 {
                folds_back(a, b, d)
            } else if i == 0 && j == n - 1 {
                folds_back(c, d, b)
            } else {
                meet(a, b, c, d)
            };
            if meets {
                return Some((i + 1, j + 1));
            }
        }
    }
    None
}

/// Returns whether the side from b to c runs back along the side from a to b.
fn folds_back(a: Point, b: Point, c: Point) -> bool {
    let (on, next) = (minus(b, a), minus(c, b));
    cross(on, next) == 0.0 && dot(on, next) <= 0.0
}

/// Returns whether two sides have a point in common.
fn meet(a: Point, b: Point, c: Point, d: Point) -> bool {
    let [p, q] = [c, d].map(|end| cross(minus(b, a), minus(end, a)));
    let [r, s] = [a, b].map(|end| cross(minus(d, c), minus(end, c)));
    let within = |i: usize| a[i].min(b[i]) <= c[i].max(d[i]) && c[i].min(d[i]) <= a[i].max(b[i]);
    p * q <= 0.0 && r * s <= 0.0 && within(0) && within(1)
}

/// Returns how far inside the polygon a point lies, m: its distance from the nearest side; below 0 outside.
pub(super) fn depth(corners: &[Point], point: Point) -> f64 {
    let nearest = sides(corners).map(|(a, b)| distance(a, b, point)).fold(f64::INFINITY, f64::min);
    let crosses = |&(a, b): &(Point, Point)| {
        (a[1] > point[1]) != (b[1] > point[1]) && point[0] < a[0] + (point[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
    };
    if sides(corners).filter(crosses).count() % 2 == 1 { nearest } else { -nearest }
}

/// Returns the distance of a point from a side, m.
pub(super) fn distance(a: Point, b: Point, point: Point) -> f64 {
    let (along, from) = (minus(b, a), minus(point, a));
    let length = dot(along, along);
    let t = if length > 0.0 { (dot(from, along) / length).clamp(0.0, 1.0) } else { 0.0 };
    (from[0] - t * along[0]).hypot(from[1] - t * along[1])
}
