//! Poses on planes and the planes of a point, against independent software and against brute force that knows only the
//! forward map.

use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix2, Vector2};
use proptest::prelude::*;
use serde_json::Value;
use stillbase::mechanics::machine::{Inertia, builtin};
use stillbase::mechanics::planar::Vector;
use stillbase::planning::reactionless::{
    AngleDefinition, AngleLimit, BSet, LIMIT_SLACK, NoReach, PlaneMap, PlanePoint,
};

fn planning() -> Value {
    serde_json::from_str(include_str!("../reference/planning.json")).unwrap()
}

fn numbers(v: &Value) -> Vec<f64> {
    v.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

fn limits(bounds: [f64; 4]) -> [AngleLimit; 2] {
    [AngleLimit { min: bounds[0], max: bounds[1] }, AngleLimit { min: bounds[2], max: bounds[3] }]
}

fn builtin_map(name: &str, bounds: [f64; 4]) -> PlaneMap {
    let machine = builtin(name).unwrap();
    let lambda = Inertia::of(machine).lambda();
    let angles: Vec<_> =
        machine.angles().iter().map(|a| AngleDefinition { to: a.to, from: a.from, offset: a.offset }).collect();
    let tip = [0, 1, 2].map(|k| machine.end_effector()[k]);
    PlaneMap::new(tip, [lambda[0], lambda[1], lambda[2]], [angles[0], angles[1]], limits(bounds)).unwrap()
}

fn nine_link() -> PlaneMap {
    builtin_map("nine-link", [0.0, PI, 0.0, PI])
}

fn case_of(case: &Value) -> (PlaneMap, Vector) {
    let bounds = numbers(&case["limits_a1_a2"]).try_into().unwrap();
    let point = numbers(&case["point"]);
    (builtin_map(case["machine"].as_str().unwrap(), bounds), Vector::new(point[0], point[1]))
}

fn is_near(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance
}

#[test]
fn reach_agrees_with_independent_software() {
    for case in planning()["reach"].as_array().unwrap() {
        let (map, p) = case_of(case);
        assert!(is_near(map.period(), case["period"].as_f64().unwrap(), 1e-9));
        let set = map.reach(p).unwrap();
        let expected: Vec<_> = case["intervals"].as_array().unwrap().iter().map(numbers).collect();
        assert_eq!(set.intervals.len(), expected.len(), "{set:?}");
        for (interval, expected) in set.intervals.iter().zip(&expected) {
            assert!((0..2).all(|i| is_near(interval[i], expected[i], 1e-9)), "{set:?}, expected {expected:?}");
        }
    }
}

#[test]
fn poses_agree_with_independent_software() {
    for case in planning()["plane_ik"].as_array().unwrap() {
        let (map, p) = case_of(case);
        let b = case["b"].as_f64().unwrap();
        let poses = map.poses(p, b);
        let expected: Vec<_> = case["solutions_q1_q2_q3_a1_a2"].as_array().unwrap().iter().map(numbers).collect();
        assert_eq!(poses.len(), expected.len(), "{poses:?}");
        for (pose, expected) in poses.iter().zip(&expected) {
            let q = map.lift(*pose);
            let found = [q[0], q[1], q[2], pose.a[0], pose.a[1]];
            assert!(found.iter().zip(expected).all(|(f, e)| is_near(*f, *e, 1e-9)), "{found:?}, expected {expected:?}");
        }
    }
}

#[test]
fn figure_3_overlaps() {
    let map = nine_link();
    let [from, to] = [Vector::new(0.50, 0.50), Vector::new(0.55, 0.90)];
    let overlap = BSet::overlap(&[map.reach(from).unwrap(), map.reach(to).unwrap()]);
    assert_eq!(overlap, map.reach(to).unwrap());
    // "if the initial angle q_1 is between 1.6 and 1.9 rad"
    let q_1 = overlap.intervals[0].map(|b| map.lift(map.poses(from, b)[0])[0]);
    assert!(is_near(q_1[0].min(q_1[1]), 1.52, 0.005) && is_near(q_1[0].max(q_1[1]), 1.92, 0.005), "{q_1:?}");
}

/// Solutions of forward(a, b) = p within the limits, by Newton's iteration from everywhere.
fn brute_force_poses(map: &PlaneMap, p: Vector, b: f64) -> Vec<[f64; 2]> {
    let [first, second] = map.limits();
    let mut found: Vec<[f64; 2]> = Vec::new();
    let n = 24;
    let start = |l: AngleLimit, i: usize| l.min + (l.max - l.min) * (i as f64 + 0.5) / f64::from(n);
    for i in 0..n as usize {
        for j in 0..n as usize {
            let mut a = [start(first, i), start(second, j)];
            let mut last = f64::INFINITY;
            for _ in 0..30 {
                let gap = p - map.forward(a, b);
                let h = 1e-6;
                let slope = |d: [f64; 2]| {
                    let ahead = map.forward([a[0] + h * d[0], a[1] + h * d[1]], b);
                    let behind = map.forward([a[0] - h * d[0], a[1] - h * d[1]], b);
                    (ahead - behind) / (2.0 * h)
                };
                let [s, t] = [slope([1.0, 0.0]), slope([0.0, 1.0])];
                let Some(inverse) = Matrix2::new(s.re, t.re, s.im, t.im).try_inverse() else { break };
                let step = inverse * Vector2::new(gap.re, gap.im);
                last = step.norm();
                let scale = (0.3 / last).min(1.0);
                a = [a[0] + scale * step[0], a[1] + scale * step[1]];
                if last < 1e-12 {
                    break;
                }
            }
            let inside = first.contains(a[0], 0.0) && second.contains(a[1], 0.0);
            let known = found.iter().any(|f| (f[0] - a[0]).hypot(f[1] - a[1]) < 1e-6);
            if last < 1e-9 && inside && !known {
                found.push(a);
            }
        }
    }
    found
}

/// b of poses that hold p: the crossings of |forward| = |p| with the lines of a grid, by bisection.
fn brute_force_b(map: &PlaneMap, p: Vector, n: usize) -> Vec<f64> {
    let mut found = Vec::new();
    let l = map.limits();
    let at = |axis: usize, i: usize| l[axis].min + (l[axis].max - l[axis].min) * i as f64 / n as f64;
    for axis in 0..2 {
        for i in 0..=n {
            let fixed = at(1 - axis, i);
            let pose = |free: f64| if axis == 0 { [free, fixed] } else { [fixed, free] };
            let excess = |free: f64| map.forward(pose(free), 0.0).norm() - p.norm();
            let values: Vec<f64> = (0..=n).map(|j| excess(at(axis, j))).collect();
            for j in 0..n {
                if (values[j] > 0.0) == (values[j + 1] > 0.0) {
                    continue;
                }
                let [mut low, mut high] = [at(axis, j), at(axis, j + 1)];
                for _ in 0..50 {
                    let mid = 0.5 * (low + high);
                    if (excess(mid) > 0.0) == (values[j] > 0.0) { low = mid } else { high = mid }
                }
                let w = map.forward(pose(low), 0.0);
                found.push(map.lambda_sum() * (p.arg() - w.arg()));
            }
        }
    }
    found
}

prop_compose! {
    /// Lengths of any sign, any tree of two relative angles, limits of up to one turn.
    fn any_map()(
        c in prop::array::uniform3((0.1..1.0f64, any::<bool>())),
        lambda in prop::array::uniform3(0.05..1.5f64),
        tree in 0..3usize,
        senses in any::<[bool; 2]>(),
        offsets in prop::array::uniform2(-4.0..4.0f64),
        from in prop::array::uniform2(-3.0..3.0f64),
        width in prop::array::uniform2(0.3..TAU),
    ) -> PlaneMap {
        let angles = [0, 1].map(|i| {
            let (to, from) = (tree, (tree + 1 + i) % 3);
            let [to, from] = if senses[i] { [to, from] } else { [from, to] };
            AngleDefinition { to, from, offset: offsets[i] }
        });
        let c = c.map(|(c, negative)| if negative { -c } else { c });
        let limits = [0, 1].map(|i| AngleLimit { min: from[i], max: from[i] + width[i] });
        PlaneMap::new(c, lambda, angles, limits).unwrap()
    }
}

prop_compose! {
    /// A map and a pose of it.
    fn any_pose()(map in any_map(), share in prop::array::uniform2(0.0..1.0f64), b in -20.0..20.0f64)
        -> (PlaneMap, PlanePoint) {
        let l = map.limits();
        (map, PlanePoint { a: [0, 1].map(|i| l[i].min + share[i] * (l[i].max - l[i].min)), b })
    }
}

fn holds(map: &PlaneMap, pose: PlanePoint, p: Vector) -> bool {
    let q = map.lift(pose);
    let tip: Vector = (0..3).map(|k| Vector::from_polar(map.c()[k], q[k])).sum();
    (tip - p).norm() < 1e-11
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn the_pose_that_made_a_point_is_found((map, pose) in any_pose()) {
        let p = map.forward(pose.a, pose.b);
        let poses = map.poses(p, pose.b);
        let l = map.limits();
        for found in poses.iter() {
            prop_assert_eq!(found.b, pose.b);
            prop_assert!(holds(&map, *found, p), "{found:?}");
            prop_assert!((0..2).all(|i| l[i].contains(found.a[i], 0.0)));
            let q = map.lift(*found);
            prop_assert!(is_near((0..3).map(|k| map.lambda()[k] * q[k]).sum(), pose.b, 1e-11));
        }
        let near = poses.iter().any(|f| (f.a[0] - pose.a[0]).hypot(f.a[1] - pose.a[1]) < 1e-7);
        prop_assert!(near, "{poses:?}");
        let set = map.reach(p).unwrap();
        prop_assert!(set.contains(pose.b), "{set:?}");
        prop_assert!(is_near(set.nearest(pose.b).unwrap(), pose.b, 1e-9));
    }

    #[test]
    fn poses_on_the_limits_are_found((map, pose) in any_pose(), edge in 0..4usize, corner in any::<bool>()) {
        let l = map.limits();
        let mut a = pose.a;
        a[edge / 2] = [l[edge / 2].min, l[edge / 2].max][edge % 2];
        if corner {
            a[1 - edge / 2] = l[1 - edge / 2].max;
        }
        let p = map.forward(a, pose.b);
        let poses = map.poses(p, pose.b);
        prop_assert!(poses.iter().all(|f| holds(&map, *f, p)));
        prop_assert!(poses.iter().any(|f| (f.a[0] - a[0]).hypot(f.a[1] - a[1]) < 1e-7), "{a:?} {poses:?}");
        prop_assert!(map.reach(p).unwrap().contains(pose.b));
    }

    #[test]
    fn a_point_has_poses_exactly_on_the_planes_it_reaches((map, pose) in any_pose(), other in -20.0..20.0f64) {
        let p = map.forward(pose.a, pose.b);
        let set = map.reach(p).unwrap();
        let margin = set.intervals.iter().flatten().map(|e| {
            let d = (other - e).rem_euclid(map.period());
            d.min(map.period() - d)
        }).fold(f64::INFINITY, f64::min);
        prop_assume!(margin > 1e-9);
        prop_assert_eq!(set.contains(other), !map.poses(p, other).is_empty());
        let nearest = set.nearest(other).unwrap();
        prop_assert!(set.contains(nearest) && !map.poses(p, nearest).is_empty());
    }

    #[test]
    fn b_turns_back_at_limits_and_folds_only((map, pose) in any_pose()) {
        let p = map.forward(pose.a, pose.b);
        let set = map.reach(p).unwrap();
        prop_assume!(set.intervals != [[0.0, map.period()]]);
        let l = map.limits();
        for end in set.intervals.iter().flatten() {
            let at_end = |f: &PlanePoint| {
                let room = (0..2).map(|i| (f.a[i] - l[i].min).min(l[i].max - f.a[i])).fold(f64::INFINITY, f64::min);
                room < 1e-10 || map.det(f.a).abs() < 1e-6
            };
            prop_assert!(map.poses(p, *end).iter().any(at_end), "{end} {set:?}");
        }
    }

    #[test]
    fn self_motion_holds_the_point((map, pose) in any_pose()) {
        let p = map.forward(pose.a, pose.b);
        let set = map.reach(p).unwrap();
        let branches = map.self_motion(p, 40);
        let period = map.period();
        let mut parts = Vec::new();
        for branch in &branches {
            prop_assert!(branch.len() >= 40, "{}", branch.len());
            prop_assert!((0.0..period).contains(&branch[0].b));
            for at in branch {
                prop_assert!(holds(&map, *at, p), "{at:?}");
                prop_assert!(set.contains(at.b));
            }
            for pair in branch.windows(2) {
                let step = (pair[0].b - pair[1].b).abs();
                prop_assert!(step < 0.5 * period, "{pair:?}");
            }
            let bs = branch.iter().map(|at| at.b);
            parts.push([bs.clone().fold(f64::INFINITY, f64::min), bs.fold(f64::NEG_INFINITY, f64::max)]);
        }
        // The branches span the set: its ends are among theirs.
        for end in set.intervals.iter().flatten().filter(|_| set.intervals != [[0.0, period]]) {
            let meets = |b: f64| { let d = (b - end).rem_euclid(period); d.min(period - d) < 1e-10 };
            prop_assert!(parts.iter().flatten().any(|b| meets(*b)), "{set:?} {parts:?}");
        }
        // And run through every pose.
        let near = |at: &PlanePoint, a: [f64; 2]| (at.a[0] - a[0]).hypot(at.a[1] - a[1]);
        let gap = branches.iter().flatten().map(|at| near(at, pose.a)).fold(f64::INFINITY, f64::min);
        prop_assert!(gap < 1.0, "{gap}");
    }

    #[test]
    fn overlap_is_what_all_sets_contain(
        sets in prop::collection::vec(prop::collection::vec((0.0..9.0f64, 0.0..4.0f64), 0..4), 1..4),
        b in -20.0..20.0f64,
    ) {
        let period = 7.0;
        let sets: Vec<BSet> = sets.iter().map(|parts| {
            // Disjoint by construction: each in its own slice of the circle.
            let n = parts.len().max(1) as f64;
            let intervals = parts.iter().enumerate().map(|(i, (at, width))| {
                let [low, high] = [period * (i as f64 + at / 20.0) / n, period * (i as f64 + at / 20.0 + width / 9.0) / n];
                [low, high]
            }).collect();
            BSet { intervals, period }
        }).collect();
        let all = BSet::overlap(&sets);
        let margin = sets.iter().flat_map(|s| s.intervals.iter().flatten()).map(|e| {
            let d = (b - e).rem_euclid(period);
            d.min(period - d)
        }).fold(f64::INFINITY, f64::min);
        prop_assume!(margin > 1e-8);
        prop_assert_eq!(all.contains(b), sets.iter().all(|s| s.contains(b)));
        prop_assert!(all.intervals.windows(2).all(|w| w[0][1] < w[1][0]));
        prop_assert!(all.intervals.iter().all(|i| (0.0..period).contains(&i[0]) && i[1] >= i[0]));
        if let Some(nearest) = all.nearest(b) {
            prop_assert!(all.contains(nearest));
            // Nothing of the set lies nearer.
            let gap = (nearest - b).abs();
            let misses = |d: f64| d <= 0.0 || (!all.contains(b + d) && !all.contains(b - d));
            prop_assert!((1..200).all(|i| misses(gap * (f64::from(i) / 200.0) - 1e-8)));
        }
    }

    #[test]
    fn nine_link_poses_are_unique(a in prop::array::uniform2(0.001..PI - 0.001), b in -30.0..30.0f64) {
        let map = nine_link();
        let poses = map.poses(map.forward(a, b), b);
        prop_assert_eq!(poses.len(), 1);
        prop_assert!((poses[0].a[0] - a[0]).hypot(poses[0].a[1] - a[1]) < 1e-9);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn poses_are_those_of_brute_force((map, pose) in any_pose()) {
        let p = map.forward(pose.a, pose.b);
        let poses = map.poses(p, pose.b);
        let l = map.limits();
        let clear = |a: [f64; 2]| {
            (0..2).all(|i| (a[i] - l[i].min).min(l[i].max - a[i]) > 1e-6) && map.det(a).abs() > 1e-4
        };
        prop_assume!(poses.iter().all(|f| clear(f.a)));
        // None is missing, none is false, and none is there twice.
        for a in brute_force_poses(&map, p, pose.b) {
            let near = poses.iter().filter(|f| (f.a[0] - a[0]).hypot(f.a[1] - a[1]) < 1e-6).count();
            prop_assert_eq!(near, 1, "{:?} {:?}", a, poses);
        }
        prop_assert!(poses.iter().all(|f| holds(&map, *f, p)));
        prop_assert!(poses.windows(2).all(|w| (w[0].a[0] - w[1].a[0]).hypot(w[0].a[1] - w[1].a[1]) > 1e-6));
    }

    #[test]
    fn reach_is_that_of_brute_force((map, pose) in any_pose()) {
        let p = map.forward(pose.a, pose.b);
        let set = map.reach(p).unwrap();
        let n = 200;
        let found = brute_force_b(&map, p, n);
        for b in &found {
            prop_assert!(is_near(set.nearest(*b).unwrap(), *b, 1e-9), "{b} {set:?}");
        }
        // No stretch of the set is without one, but for what the grid is too coarse to see.
        let coarse = 40.0 * map.lambda_sum() * TAU / n as f64 / p.norm().min(1.0);
        for [low, high] in &set.intervals {
            let mut inside: Vec<f64> = found.iter().map(|b| low + (b - low).rem_euclid(map.period())).filter(|b| b <= high).collect();
            inside.extend([*low, *high]);
            inside.sort_unstable_by(f64::total_cmp);
            prop_assert!(inside.windows(2).all(|w| w[1] - w[0] < coarse), "{set:?} {inside:?}");
        }
    }
}

/// Lengths in equal steps and points at such distances: rhombi, kites and flat quadrilaterals among them.
fn even_map(c: [i32; 3], template: PlaneMap, narrow: [bool; 2]) -> PlaneMap {
    let l = template.limits();
    let limits = [0, 1].map(|i| if narrow[i] { l[i] } else { AngleLimit { min: l[i].min, max: l[i].min + TAU } });
    PlaneMap::new(c.map(|c| 0.25 * f64::from(c)), template.lambda(), template.angles(), limits).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn reach_of_degenerate_quadrilaterals_is_that_of_brute_force(
        template in any_map(),
        c in prop::array::uniform3(1..4i32),
        r in 1..9i32,
        turn in -3.0..3.0f64,
        narrow in any::<[bool; 2]>(),
        rhombus in 0..4usize,
    ) {
        let map = if rhombus == 0 { even_map([r; 3], template, narrow) } else { even_map(c, template, narrow) };
        let p = Vector::from_polar(0.25 * f64::from(r), turn);
        let found = brute_force_b(&map, p, 150);
        let Ok(set) = map.reach(p) else {
            prop_assert!(found.is_empty());
            return Ok(());
        };
        for b in &found {
            // Flat quadrilaterals amplify rounding to its root.
            let nearest = set.nearest(*b).unwrap();
            prop_assert!(is_near(nearest, *b, 1e-6), "{b} {set:?}");
            let poses = map.poses(p, nearest);
            prop_assert!(!poses.is_empty(), "{b} {set:?}");
            prop_assert!(poses.iter().all(|f| (map.forward(f.a, nearest) - p).norm() < 1e-8));
        }
        for end in set.intervals.iter().flatten() {
            prop_assert!(found.is_empty() || !map.poses(p, *end).is_empty(), "{end} {set:?}");
        }
        for at in map.self_motion(p, 30).iter().flatten() {
            prop_assert!((map.forward(at.a, at.b) - p).norm() < 1e-7, "{at:?}");
        }
    }
}

#[test]
fn unreachable_points_say_why() {
    let map = nine_link();
    assert!(matches!(map.reach(Vector::new(1.3, 0.0)), Err(NoReach::TooFar { .. })));
    assert!(map.poses(Vector::new(1.3, 0.0), 0.0).is_empty() && map.self_motion(Vector::new(1.3, 0.0), 9).is_empty());
    let long = PlaneMap::new([2.0, -0.5, -0.5], map.lambda(), map.angles(), map.limits()).unwrap();
    assert_eq!(long.reach(Vector::new(0.5, 0.0)), Err(NoReach::TooNear { distance: 0.5, nearest: 1.0 }));
    let stiff = map.with_limits(limits([0.1, 0.2, 0.1, 0.2])).unwrap();
    assert_eq!(stiff.reach(Vector::new(0.5, 0.5)), Err(NoReach::Limits));
    let text = map.reach(Vector::new(1.3, 0.0)).unwrap_err().to_string();
    assert_eq!(text, "the point is 1.3000 m from the base, but the arms reach only 1.2600 m");
    for p in [Vector::new(f64::NAN, 0.0), Vector::new(f64::INFINITY, 1.0)] {
        assert!(map.reach(p).is_err() && map.poses(p, 1.0).is_empty() && map.self_motion(p, 5).is_empty());
    }
    assert!(map.poses(Vector::new(0.5, 0.5), f64::NAN).is_empty());
}

#[test]
fn the_origin_is_reached_at_every_b_or_none() {
    let map = nine_link();
    let origin = Vector::new(0.0, 0.0);
    let set = map.reach(origin).unwrap();
    assert_eq!(set.intervals, [[0.0, map.period()]]);
    for b in [-3.0, 0.0, 2.4] {
        let poses = map.poses(origin, b);
        assert_eq!(poses.len(), 1);
        assert!(holds(&map, poses[0], origin));
    }
    let branches = map.self_motion(origin, 12);
    assert_eq!((branches.len(), branches[0].len()), (1, 12));
    // Beside it, the curve is a small loop.
    let beside = Vector::new(1e-9, 2e-9);
    assert_eq!(map.reach(beside).unwrap().intervals, [[0.0, map.period()]]);
    assert!(holds(&map, map.poses(beside, 2.4)[0], beside));
    let stiff = map.with_limits(limits([0.1, 0.2, 0.1, 0.2])).unwrap();
    assert_eq!(stiff.reach(origin), Err(NoReach::Limits));
}

#[test]
fn flat_poses_are_found() {
    for bounds in [[0.0, PI, 0.0, PI], [-PI, PI, -PI, PI], [0.0, TAU, 0.0, TAU], [-1.0, 4.0, -1.0, 4.0]] {
        let map = builtin_map("nine-link", bounds);
        for a in [[0.0, 0.0], [0.0, PI], [PI, 0.0], [PI, PI]] {
            for b in [0.0, 1.0, 2.4, -7.0, 100.0] {
                let p = map.forward(a, b);
                let poses = map.poses(p, b);
                let near = poses.iter().any(|f| (f.a[0] - a[0]).hypot(f.a[1] - a[1]) < 1e-6);
                assert!(near, "{bounds:?} {a:?} {b} {poses:?}");
                assert!(poses.iter().all(|f| holds(&map, *f, p)), "{bounds:?} {a:?} {b} {poses:?}");
                let set = map.reach(p).unwrap();
                let miss = (set.nearest(b).unwrap() - b).abs();
                assert!(miss < 1e-6, "{bounds:?} {a:?} {b} {set:?}");
                assert!(!map.self_motion(p, 20).is_empty());
            }
        }
    }
}

#[test]
fn limits_without_room_leave_points() {
    let map = nine_link();
    let a = [1.1, 2.0];
    let p = map.forward(a, 2.4);
    for bounds in [[1.1, 1.1, 0.0, PI], [0.0, PI, 2.0, 2.0], [1.1, 1.1, 2.0, 2.0]] {
        let fixed = map.with_limits(limits(bounds)).unwrap();
        let set = fixed.reach(p).unwrap();
        assert!(set.intervals.iter().all(|[low, high]| high - low < 10.0 * LIMIT_SLACK), "{set:?}");
        assert!(set.contains(2.4), "{set:?}");
        let poses = fixed.poses(p, 2.4);
        assert_eq!(poses.len(), 1);
        assert!((poses[0].a[0] - a[0]).hypot(poses[0].a[1] - a[1]) < 1e-8);
        let branches = fixed.self_motion(p, 5);
        assert!(branches.iter().flatten().all(|at| (map.forward(at.a, at.b) - p).norm() < 1e-8));
        assert!(branches.iter().flatten().any(|at| is_near(at.a[0], a[0], 1e-8) && is_near(at.a[1], a[1], 1e-8)));
    }
}

#[test]
fn odd_lengths_and_wide_limits_do_no_harm() {
    let map = nine_link();
    for c in [
        [1.0, 1.0, 1.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 1.0],
        [1.0, 0.0, 0.5],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0; 3],
        [2.0, -1.0, 1.0],
    ] {
        for half in [0.0, 1.0, PI, 10.0, 25.2, 1e3, 1e300] {
            let m = PlaneMap::new(c, map.lambda(), map.angles(), limits([-half, half, -half, half]));
            assert_eq!(m.is_err(), half > 25.2, "{half}: more turns than are counted");
            let Ok(m) = m else { continue };
            for p in [[0.0, 0.0], [1.0, 0.0], [0.0, -2.0], [0.3, 0.4], [3.0, 0.0]].map(|[x, y]| Vector::new(x, y)) {
                let poses = m.poses(p, 1.0);
                assert!(poses.iter().all(|f| (m.forward(f.a, 1.0) - p).norm() < 1e-8), "{c:?} {half} {p} {poses:?}");
                match m.reach(p) {
                    Ok(set) => assert!(!set.is_empty()),
                    Err(_) => assert!(poses.is_empty()),
                }
                for at in m.self_motion(p, 7).iter().flatten() {
                    assert!((m.forward(at.a, at.b) - p).norm() < 1e-7, "{c:?} {half} {p} {at:?}");
                }
            }
        }
    }
}

#[test]
fn windings_count_as_sheets() {
    let narrow = builtin_map("nine-link", [0.0, TAU, 0.0, TAU]);
    let wide = narrow.with_limits(limits([0.0, 2.0 * TAU, 0.0, TAU])).unwrap();
    let p = Vector::new(0.5, 0.5);
    let (few, many) = (narrow.poses(p, 2.4), wide.poses(p, 2.4));
    let within = many.iter().filter(|f| f.a[0] <= TAU).count();
    assert_eq!(within, few.len());
    assert!(many.len() > few.len());
    assert!(many.iter().all(|f| holds(&wide, *f, p)));
}

proptest! {
    /// Of all poses of a plane with a drive at an angle, the one that is found is within the limits, has that angle or
    /// comes as near as the limits let it, and moves the least by kinetic energy.
    #[test]
    fn a_drive_is_turned_on_its_plane(
        (k, share, b) in (0..3usize, -0.3..1.3_f64, -7.0..7.0_f64),
        from in [0.0..PI, 0.0..PI],
    ) {
        let map = nine_link();
        let [low, high] = map.range_of(k, b);
        let angle = low + share * (high - low);
        let a = map.with_drive_at(k, angle, b, from);
        let limits = map.limits();
        prop_assert!((0..2).all(|i| limits[i].contains(a[i], 0.0)), "{a:?}");
        let of = |a: [f64; 2]| map.lift(PlanePoint { a, b });
        prop_assert!((of(a)[k] - angle.clamp(low, high)).abs() < 1e-9, "{} for {angle}", of(a)[k]);
        let energy = |a: [f64; 2]| -> f64 {
            let (to, from, lambda) = (of(a), of(from), map.lambda());
            (0..3).map(|l| lambda[l] * (to[l] - from[l]).powi(2)).sum()
        };
        // Along the line of equal angle nothing within the limits is nearer.
        let w = map.u()[k];
        for s in [-0.3, -0.01, 0.01, 0.3] {
            let other = [a[0] - s * w[1], a[1] + s * w[0]];
            if (0..2).all(|i| limits[i].contains(other[i], 0.0)) {
                prop_assert!(energy(other) >= energy(a) - 1e-9, "{other:?} is nearer than {a:?}");
            }
        }
        prop_assert!(map.lambda().iter().zip(of(a)).map(|(l, q)| l * q).sum::<f64>() - b < 1e-9, "b stays");
    }
}
