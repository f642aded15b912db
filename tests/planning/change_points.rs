//! Change points and the parts of the workspace on either side of them; dexterity: against sampling, sums over parts
//! and singular values.

use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix2, Matrix2x3};
use stillbase::mechanics::planar::{Vector, unit};
use stillbase::planning::reactionless::{Boundary, BoundaryCurve, DRIVE_PAIRS, PlaneMap, PlanePoint};

use crate::mechanics::inside::{B, CASES, check_line, from_curves, share, size, spread, within};

/// q_3 = q_1 runs through the middle of [0, π]²; case 3 stays where a_1 + a_2 > π.
#[test]
fn parts_of_the_default_workspace_on_either_side() {
    let map = within(CASES[0]);
    let whole = Boundary::of(&map);
    assert_eq!([0, 1, 2].map(|pair| whole.sides(pair)), [0..=0, -1..=-1, -1..=0]);
    let curves = whole.change_curves();
    let [curve] = &curves[..] else { panic!("{} curves", curves.len()) };
    assert_eq!((DRIVE_PAIRS[curve.pair], curve.half_turns), ([0, 2], 0));
    let [near, far] = [-1, 0].map(|m| Boundary::on_sides(&map, [None, None, Some(m)]).unwrap());
    assert!((near.area() + far.area() - whole.area()).abs() < 1e-13, "one sheet, cut in two");
    let parts = [near.area(), far.area()].map(|a| (a * 1000.0).round() / 1000.0);
    assert!(parts == [0.378, 0.467] || parts == [0.467, 0.378], "{parts:?}");
    for b in [&near, &far] {
        assert!((b.area() - b.sheet_area()).abs() < 1e-13);
        assert_eq!((b.loops().len(), b.max_pose_count()), (1, 1));
        assert!(b.loops()[0].vertices().iter().any(|v| v.curve == BoundaryCurve::Change { pair: 2 }));
    }
    for (x, y) in [(0.5, 0.5), (0.55, 0.9)] {
        let p = Vector::new(x, y);
        let pose = map.poses(p, B)[0];
        assert_eq!(map.sides(pose.a)[2], 0);
        assert!(far.contains(p, B) && !near.contains(p, B) && pose.a[0] + pose.a[1] > PI);
    }
}

/// Along a straight line in (a_1, a_2) the side of a pair changes where its sine does, and by one.
#[test]
fn sides_change_where_the_sine_changes_sign() {
    let map = within([[-5.0, 5.0], [-5.0, 5.0]]);
    let mut met = 0;
    for i in 1..400 {
        let [from, to] = [spread(2 * i), spread(2 * i + 1)].map(|[s, t]| share(&map, s, t));
        let at = |t: f64| [0, 1].map(|j| from[j] + t * (to[j] - from[j]));
        for n in 1..=500 {
            let [before, after] = [at(f64::from(n - 1) / 500.0), at(f64::from(n) / 500.0)];
            let (sines, sides) = ([before, after].map(|a| map.sines(a)), [before, after].map(|a| map.sides(a)));
            for pair in 0..3 {
                let crossed = sines[0][pair] * sines[1][pair] < 0.0;
                assert_eq!((sides[1][pair] - sides[0][pair]).abs(), i32::from(crossed), "{before:?} {after:?}");
                met += usize::from(crossed);
            }
        }
    }
    assert!(met > 300, "{met}");
}

pub fn change_curves_are_sound(map: &PlaneMap) {
    let boundary = Boundary::of(map);
    let n = 40;
    for pair in 0..3 {
        // Every side that a pose is on is listed, and no other.
        let mut seen: Vec<i32> = (0..n * n)
            .map(|i| share(map, ((i / n) as f64 + 0.5) / n as f64, ((i % n) as f64 + 0.5) / n as f64))
            .map(|a| map.sides(a)[pair])
            .collect();
        seen.sort_unstable();
        seen.dedup();
        let sides = boundary.sides(pair);
        assert!(seen.iter().all(|m| sides.contains(m)), "{seen:?} {sides:?}");
        // A corner that reaches beyond a line by less than a cell of the samples may be missed by them.
        assert!(sides.clone().count() <= seen.len() + 2);
    }
    for curve in boundary.change_curves() {
        check_line(map, &curve.line);
        let v = curve.line.vertices();
        assert_eq!([v[0].a, v[v.len() - 1].a], curve.ends);
        for v in v {
            assert_eq!(v.curve, BoundaryCurve::Change { pair: curve.pair });
            assert!(map.sines(v.a)[curve.pair].abs() < 1e-12);
            assert!((0..2).all(|i| map.limits()[i].contains(v.a[i], 1e-9)));
        }
        let on_edge = |a: [f64; 2]| {
            (0..2).any(|j| (a[j] - map.limits()[j].min).abs().min((a[j] - map.limits()[j].max).abs()) < 1e-8)
        };
        assert!(curve.ends.into_iter().all(on_edge), "{curve:?}");
    }
}

/// The parts on the sides of one pair cover the workspace: their sheets add up, no part exceeds the whole.
pub fn parts_add_up(map: &PlaneMap) {
    let boundary = Boundary::of(map);
    let scale = size(map) * size(map);
    for pair in 0..3 {
        let (mut sheets, mut covered, mut largest) = (0.0, 0.0, 0.0_f64);
        for m in boundary.sides(pair) {
            let mut sides = [None; 3];
            sides[pair] = Some(m);
            let Some(part) = Boundary::on_sides(map, sides) else { continue };
            sheets += part.sheet_area();
            covered += part.area();
            largest = largest.max(part.area());
            assert!(part.max_pose_count() <= boundary.max_pose_count());
        }
        let (all, area) = (boundary.sheet_area(), boundary.area());
        assert!((sheets - all).abs() < 1e-9 * scale, "{:?} pair {pair}: {sheets} {all}", map.limits());
        assert!(covered >= area - 1e-7 * scale && largest <= area + 1e-7 * scale, "{covered} {largest} {area}");
    }
}

/// What a part contains is what some pose on its side reaches.
pub fn parts_hold_the_poses_on_their_side(map: &PlaneMap, n: usize) {
    let reach = size(map);
    for pair in 0..3 {
        for m in Boundary::of(map).sides(pair) {
            let mut sides = [None; 3];
            sides[pair] = Some(m);
            let Some(part) = Boundary::on_sides(map, sides) else { continue };
            for i in 0..n {
                let p = Vector::from(unit(TAU * spread(i)[0])) * (reach * spread(i)[1].sqrt());
                let poses = map.poses(p, 0.0);
                let there = poses.iter().filter(|pose| map.sides(pose.a)[pair] == m).count();
                if from_curves(map, &part, p) > 1e-6 * reach {
                    assert_eq!(part.pose_count(p, 0.0), there, "{:?} pair {pair} side {m}: {p}", map.limits());
                    assert_eq!(part.contains(p, 0.0), there > 0);
                }
            }
        }
    }
}

#[test]
fn change_points_within_many_limits() {
    for limits in CASES {
        let map = within(limits);
        change_curves_are_sound(&map);
        parts_add_up(&map);
        parts_hold_the_poses_on_their_side(&map, 20);
    }
    // All three pairs at once: the parts without any change point inside.
    let map = within([[-PI, PI], [-PI, PI]]);
    let (mut parts, mut sheets) = (0, 0.0);
    for i in -3..3 {
        for j in -3..3 {
            for k in -3..3 {
                if let Some(part) = Boundary::on_sides(&map, [Some(i), Some(j), Some(k)]) {
                    parts += 1;
                    sheets += part.sheet_area();
                }
            }
        }
    }
    assert_eq!(parts, 8);
    assert!((sheets - Boundary::of(&map).sheet_area()).abs() < 1e-12);
    assert!(Boundary::on_sides(&map, [Some(7), None, None]).is_none());
    assert!(Boundary::on_sides(&map, [Some(i32::MAX), Some(i32::MIN), None]).is_none());
}

/// Singular values of J, numerically; det of (16) by differences.
#[test]
fn dexterity_is_that_of_the_jacobians() {
    for i in 0..200 {
        let map = within([[-4.0, 4.0], [-4.0, 4.0]]);
        let [s, t] = spread(i);
        let a = share(&map, s, t);
        let dexterity = map.dexterity(a);
        let q = map.lift(PlanePoint { a, b: B });
        let columns = [0, 1, 2].map(|k| Vector::new(0.0, map.c()[k]) * unit(q[k]));
        let jacobian = Matrix2x3::from_fn(|row, k| if row == 0 { columns[k].re } else { columns[k].im });
        let singular = jacobian.svd(false, false).singular_values;
        assert!((dexterity.worst_torque_per_force - singular[0]).abs() < 1e-12);
        assert!((dexterity.manipulability - singular[0] * singular[1]).abs() < 1e-12);
        let gram = jacobian * jacobian.transpose();
        assert!((dexterity.manipulability - gram.determinant().max(0.0).sqrt()).abs() < 1e-7);
        // No direction of a unit force asks for more, and one for as much.
        let torque = |n: i32| {
            (jacobian.transpose()
                * nalgebra::Vector2::new((PI * f64::from(n) / 720.0).cos(), (PI * f64::from(n) / 720.0).sin()))
            .norm()
        };
        let worst = (0..720).map(torque).fold(0.0, f64::max);
        assert!(
            worst <= dexterity.worst_torque_per_force + 1e-12
                && worst > dexterity.worst_torque_per_force * (1.0 - 1e-5)
        );
        let slope = |j: usize| {
            let at = |h: f64| map.forward(std::array::from_fn(|k| a[k] + if k == j { h } else { 0.0 }), B);
            (at(1e-5) - at(-1e-5)) / 2e-5
        };
        let det = Matrix2::new(slope(0).re, slope(1).re, slope(0).im, slope(1).im).determinant();
        assert!((dexterity.det - det.abs()).abs() < 1e-9);
        // On one sheet it is the price of staying on the plane: never above what b free allows by its own measure.
        assert!(dexterity.det >= 0.0 && dexterity.manipulability >= 0.0);
    }
}
