//! The inverse of (16) along a curve: the pose, its rates and its accelerations for a given end effector and b.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | w | p e^{−i b*}: the end effector rotated back by b* = b/Σλ | m |
//! | F(a) | Σ_k c_k e^{i (u_k · a + v_k)} = w, (16) | m |
//!
//! w′ = F_1 a_1′ + F_2 a_2′ and w″ = F_1 a_1″ + F_2 a_2″ − Σ_k c_k e^{i (u_k · a + v_k)} (u_k · a′)².

use crate::curves::PathPoint;
use crate::curves::curve::CurvePoint;
use crate::reactionless::{PlaneMap, PlanePoint};
use stillbase_mechanics::planar::{DriveAngles, PerDrive, Vector, cross, unit};

/// Returns (a_1′, a_2′) and (a_1″, a_2″) at a pose for given w′ and w″; not finite where det ∂(x, y)/∂(a_1, a_2) = 0.
pub(crate) fn rates(map: &PlaneMap, a: [f64; 2], first: Vector, second: Vector) -> [[f64; 2]; 2] {
    let arms = map.arms(a);
    let [c1, c2] = map.columns(&arms);
    let det = cross(c1, c2);
    let solve = |w: Vector| [cross(w, c2) / det, cross(c1, w) / det];
    let (ad, u) = (solve(first), map.u());
    let inward: Vector = (0..3).map(|k| arms[k] * (u[k][0] * ad[0] + u[k][1] * ad[1]).powi(2)).sum();
    [ad, solve(second + inward)]
}

/// Finds the pose on the sheet of `from` that puts the end effector on a point of a curve at b = `[b, b′, b″]`. Also
/// returns its derivatives with respect to the curve parameter.
///
/// Returns `None` where [`PlaneMap::follow`] finds no such pose, or where det ∂(x, y)/∂(a_1, a_2) = 0.
pub fn pose_along(map: &PlaneMap, point: &CurvePoint, b: [f64; 3], from: [f64; 2]) -> Option<(PlanePoint, PathPoint)> {
    let a = map.follow(point.p, b[0], from)?;
    let turn = b.map(|b| map.turn(b));
    let back = unit(-turn[0]);
    let i = Vector::new(0.0, 1.0);
    let first = (point.first - i * turn[1] * point.p) * back;
    let second =
        (point.second - 2.0 * turn[1] * i * point.first - i * turn[2] * point.p - turn[1] * turn[1] * point.p) * back;
    let [ad, add] = rates(map, a, first, second);
    let at = PlanePoint { a, b: b[0] };
    ad.iter().chain(&add).all(|x| x.is_finite()).then(|| {
        let q = DriveAngles::from(map.lift(at));
        let point = PathPoint {
            q,
            first: PerDrive::from(map.lift_rates(ad, b[1])),
            second: PerDrive::from(map.lift_rates(add, b[2])),
        };
        (at, point)
    })
}
