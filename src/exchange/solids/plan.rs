//! [`Plan`]: the area that a solid covers, seen from above.

use crate::mesh::{bar, circle};
use stillbase_mechanics::planar::{Vector, cross, dot};

/// An area: all points within a radius of a corner, of the line between two corners, or of the polygon of more.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Its corners, m, in order around it.
    pub corners: Vec<Vector>,
    /// Its radius, m.
    pub radius: f64,
}

impl Plan {
    /// Returns a disc.
    pub fn disc(at: Vector, radius: f64) -> Self {
        Self { corners: vec![at], radius }
    }

    /// Returns a bar with round ends about two points.
    pub fn bar(ends: [Vector; 2], radius: f64) -> Self {
        Self { corners: ends.to_vec(), radius }
    }

    /// Returns a polygon.
    pub fn polygon(corners: impl IntoIterator<Item = Vector>) -> Self {
        Self { corners: corners.into_iter().collect(), radius: 0.0 }
    }

    /// Returns its corners turned and moved, in the order around it, with the line from each to the next.
    pub fn sides(&self, moved: impl Fn(Vector) -> Vector) -> impl Iterator<Item = [Vector; 2]> {
        let count = self.corners.len();
        let sides = if count == 2 { 1 } else { count };
        (0..sides).map(move |i| [self.corners[i], self.corners[(i + 1) % count]].map(&moved))
    }

    /// Returns whether it is a polygon, which has an inside apart from its radius.
    pub fn is_polygon(&self) -> bool {
        self.corners.len() > 2
    }

    /// Returns its outline, counter-clockwise, m. Round ends and discs are polygons with the area of their circles.
    pub fn outline(&self) -> Vec<Vector> {
        match self.corners[..] {
            [at] => circle(at, self.radius),
            [from, to] if from == to => circle(from, self.radius),
            [from, to] => bar([from, to], self.radius),
            _ => {
                let twice_area: f64 = self.sides(|corner| corner).map(|[a, b]| cross(a, b)).sum();
                let mut corners = self.corners.clone();
                if twice_area < 0.0 {
                    corners.reverse();
                }
                corners
            }
        }
    }

    /// Returns the distance of a point from it, m; below 0 inside.
    pub fn distance(&self, p: Vector) -> f64 {
        let to_side = self.sides(|x| x).map(|side| (p - foot(side, p)).norm()).fold(f64::INFINITY, f64::min);
        let is_inside = self.is_polygon() && encloses(self.sides(|x| x), p);
        if is_inside { -to_side - self.radius } else { to_side - self.radius }
    }

    /// Returns the interval that it covers along x, m, for a placement of its corners.
    pub fn extent(&self, moved: impl Fn(Vector) -> Vector) -> [f64; 2] {
        let xs = self.corners.iter().map(|corner| moved(*corner).re);
        let ends = xs.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
        [ends[0] - self.radius, ends[1] + self.radius]
    }
}

/// Returns the point of a segment that is nearest to a point.
pub fn foot([from, to]: [Vector; 2], p: Vector) -> Vector {
    let along = to - from;
    let whole = along.norm_sqr();
    let share = if whole > 0.0 { (dot(p - from, along) / whole).clamp(0.0, 1.0) } else { 0.0 };
    from + along * share
}

/// Returns whether closed sides enclose a point: an odd number of them cross the ray to its right.
pub fn encloses(sides: impl Iterator<Item = [Vector; 2]>, p: Vector) -> bool {
    let crosses = |[a, b]: &[Vector; 2]| {
        (a.im > p.im) != (b.im > p.im) && p.re < a.re + (p.im - a.im) / (b.im - a.im) * (b.re - a.re)
    };
    sides.filter(crosses).count() % 2 == 1
}
