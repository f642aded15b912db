//! Inside a workspace: how many poses reach a point, folds, cusps, limits that run inside, distances: against brute
//! force.

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;
use stillbase::mechanics::machine::builtin;
use stillbase::mechanics::planar::{Vector, cross, dot, unit};
use stillbase::planning::pose_space::plane_map;
use stillbase::planning::reactionless::{
    AngleDefinition, AngleLimit, Boundary, BoundaryCurve, BoundaryLine, BoundaryVertex, PlaneMap,
};

use crate::support::{limits, machines};

use crate::planning::change_points::{change_curves_are_sound, parts_add_up, parts_hold_the_poses_on_their_side};

pub const B: f64 = 2.4;

pub fn within(limits: [[f64; 2]; 2]) -> PlaneMap {
    let map = plane_map(builtin("nine-link").unwrap()).unwrap();
    map.with_limits(limits.map(|[min, max]| AngleLimit { min, max })).unwrap()
}

/// Limits that make every kind of curve: none folded, folded once, overlapping, with holes, more than a turn.
pub const CASES: [[[f64; 2]; 2]; 7] = [
    [[0.0, PI], [0.0, PI]],
    [[-PI, PI], [-PI, PI]],
    [[0.0, TAU], [0.0, TAU]],
    [[-1.0, 4.0], [-2.0, 5.0]],
    [[-0.8, 1.1], [2.0, 5.5]],
    [[0.0, PI], [0.0, TAU]],
    [[0.3, 8.0], [-1.0, 6.5]],
];

pub fn size(map: &PlaneMap) -> f64 {
    map.c().iter().map(|c| c.abs()).sum()
}

/// The point at shares (s, t) of the limits.
pub fn share(map: &PlaneMap, s: f64, t: f64) -> [f64; 2] {
    let [a1, a2] = map.limits();
    [a1.min + s * (a1.max - a1.min), a2.min + t * (a2.max - a2.min)]
}

/// A sequence that fills the unit square evenly.
pub fn spread(i: usize) -> [f64; 2] {
    [0.754_877_666_246_692_8, 0.569_840_290_998_053_3].map(|g| (0.5 + i as f64 * g).fract())
}

/// A square net over the limits, mapped vertex by vertex: how many of its triangles cover each of many points. Wrong
/// only within some 1e-4 m of a curve across which the number of poses changes.
fn covered(map: &PlaneMap, cells: usize, points: &[Vector]) -> Vec<usize> {
    const N: usize = 160;
    let size = size(map) * 1.001;
    let index = |x: f64| (((x + size) * (0.5 * N as f64 / size)) as usize).min(N - 1);
    let mut buckets: Vec<Vec<usize>> = vec![Vec::new(); N * N];
    for (i, p) in points.iter().enumerate() {
        buckets[index(p.re) * N + index(p.im)].push(i);
    }
    let net: Vec<[f64; 2]> = (0..=cells)
        .flat_map(|i| (0..=cells).map(move |j| [i, j].map(|k| k as f64 / cells as f64)))
        .map(|[s, t]| map.forward_unturned(share(map, s, t)))
        .map(|p| [p.re, p.im])
        .collect();
    let mut counts = vec![0; points.len()];
    let mut cover = |t: [[f64; 2]; 3]| {
        let low = [0, 1].map(|k| index(t[0][k].min(t[1][k]).min(t[2][k])));
        let high = [0, 1].map(|k| index(t[0][k].max(t[1][k]).max(t[2][k])));
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for &i in &buckets[x * N + y] {
                    let (px, py) = (points[i].re, points[i].im);
                    let side =
                        |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0]) > 0.0;
                    let first = side(t[0], t[1]);
                    if side(t[1], t[2]) == first && side(t[2], t[0]) == first {
                        counts[i] += 1;
                    }
                }
            }
        }
    };
    for i in 0..cells {
        for j in 0..cells {
            let at = |i: usize, j: usize| net[i * (cells + 1) + j];
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            cover([a, b, c]);
            cover([a, c, d]);
        }
    }
    counts
}

/// All poses that Newton's iteration finds from n² starts, however many lead to the same.
fn found(map: &PlaneMap, p: Vector, n: usize) -> usize {
    let mut poses: Vec<[f64; 2]> = Vec::new();
    for i in 0..=n {
        for j in 0..=n {
            let mut a = share(map, i as f64 / n as f64, j as f64 / n as f64);
            for _ in 0..60 {
                let arms = map.arms(a);
                let gap = p - arms.iter().sum::<Vector>();
                if gap.norm() < 1e-13 {
                    break;
                }
                let [first, second] = map.columns(&arms);
                let det = cross(first, second);
                let step = [cross(gap, second) / det, cross(first, gap) / det];
                let scale = (0.2 / step[0].hypot(step[1])).min(1.0);
                a = [a[0] + scale * step[0], a[1] + scale * step[1]];
            }
            let reached = (map.forward_unturned(a) - p).norm() < 1e-11;
            let inside = (0..2).all(|i| map.limits()[i].contains(a[i], 0.0));
            if reached && inside && poses.iter().all(|b| (b[0] - a[0]).abs().max((b[1] - a[1]).abs()) > 1e-7) {
                poses.push(a);
            }
        }
    }
    poses.len()
}

fn from_chord(a: Vector, b: Vector, p: Vector) -> f64 {
    let along = b - a;
    let t = (dot(p - a, along) / along.norm_sqr()).clamp(0.0, 1.0);
    (a + if t.is_nan() { 0.0 } else { t } * along - p).norm()
}

/// Distance of p from all curves across which the number of poses changes: from the true curve where it is near.
pub fn from_curves(map: &PlaneMap, boundary: &Boundary, p: Vector) -> f64 {
    let lines = boundary.fold_curves().into_iter().chain(boundary.inner_limits());
    let mut all: Vec<Vec<BoundaryVertex>> = lines.map(|l| l.vertices().to_vec()).collect();
    for l in boundary.loops() {
        all.push(l.vertices().iter().chain(&l.vertices()[..1]).copied().collect());
    }
    let near = |w: &[BoundaryVertex]| {
        let coarse = from_chord(w[0].at, w[1].at, p);
        if coarse > 2e-5 {
            return coarse;
        }
        let at = |t: f64| (map.forward_unturned(between(map, [w[0], w[1]], t)) - p).norm();
        let mut range = [0.0, 1.0];
        for _ in 0..50 {
            let [low, high] = range;
            let [a, b] = [0.381_966, 0.618_034].map(|g| low + g * (high - low));
            range = if at(a) < at(b) { [low, b] } else { [a, high] };
        }
        at(range[0]).min((w[0].at - p).norm()).min((w[1].at - p).norm())
    };
    all.iter().flat_map(|line| line.windows(2)).map(near).fold(f64::INFINITY, f64::min)
}

/// Counts agree at many points: winding number, poses solved for, triangles of a net; where the net is too coarse,
/// Newton's iteration from many starts decides. Returns how often it had to.
fn counts_agree(map: &PlaneMap, n: usize, cells: usize) -> usize {
    let boundary = Boundary::of(map);
    let reach = 1.02 * size(map);
    let points: Vec<Vector> =
        (0..n).map(spread).map(|[s, t]| Vector::new((2.0 * s - 1.0) * reach, (2.0 * t - 1.0) * reach)).collect();
    let covered = covered(map, cells, &points);
    let turn = unit(map.turn(B));
    // The net's chords stand off its curves by about the square of a cell's width; along a cusp that is less than the
    // width itself, but more than its square.
    let cell = map.limits().iter().map(|limit| (limit.max - limit.min) / cells as f64).fold(0.0, f64::max);
    let off = cell * reach;
    let mut close = 0;
    for (&p, covered) in points.iter().zip(covered) {
        let (count, solved) = (boundary.pose_count(p * turn, B), map.poses(p * turn, B).len());
        if count == solved && count == covered {
            continue;
        }
        let gap = from_curves(map, &boundary, p);
        if gap < 1e-6 {
            continue;
        }
        assert_eq!(count, solved, "{:?} {p}, {gap:e} m from a curve", map.limits());
        assert!(gap < off, "{:?} {p}: {count} by winding, {covered} by the net, {gap:e} m", map.limits());
        assert_eq!(count, found(map, p, 24), "{:?} {p}, {gap:e} m from a curve", map.limits());
        close += 1;
    }
    close
}

#[test]
fn a_hundred_thousand_points_are_counted_in_three_ways() {
    for limits in CASES {
        let close = counts_agree(&within(limits), 14_300, 360);
        assert!(close < 60, "{limits:?}: {close}");
    }
}

/// Exactly n poses: areas by Green's theorem along the strands against lattice points counted by a net.
#[test]
fn areas_by_poses_match_a_raster() {
    for limits in CASES {
        let map = within(limits);
        let boundary = Boundary::of(&map);
        let areas = boundary.areas_by_poses();
        assert_eq!(areas.len(), boundary.max_pose_count());
        assert!((areas[0] - boundary.area()).abs() < 1e-12, "{areas:?} {}", boundary.area());
        assert!((areas.iter().sum::<f64>() - boundary.sheet_area()).abs() < 1e-10, "{limits:?} {areas:?}");
        assert!(areas.windows(2).all(|w| w[0] > w[1] && w[1] > 0.0), "{areas:?}");
        const N: usize = 150;
        let h = 2.0 * size(&map) / N as f64;
        let at = |i: usize| (i as f64 + 0.5) * h - size(&map);
        let points: Vec<Vector> = (0..N * N).map(|i| Vector::new(at(i / N), at(i % N))).collect();
        let counts = covered(&map, 200, &points);
        // The net may err next to a fold.
        assert!(counts.iter().filter(|&&c| c > boundary.max_pose_count()).count() <= 3, "{limits:?}");
        for (n, area) in areas.iter().enumerate() {
            let raster = counts.iter().filter(|&&c| c > n).count() as f64 * h * h;
            assert!((raster - area).abs() < 0.01, "{limits:?}, {n}: {raster} {area}");
        }
    }
}

/// A point of a curve between two of its vertices: on folds brought back to det = 0 across the fold.
fn between(map: &PlaneMap, [from, to]: [BoundaryVertex; 2], t: f64) -> [f64; 2] {
    let mut a = [0, 1].map(|j| from.a[j] + t * (to.a[j] - from.a[j]));
    if from.curve == BoundaryCurve::Fold {
        for _ in 0..6 {
            let (g, det) = (slopes(map, a), map.det(a));
            let norm = g[0] * g[0] + g[1] * g[1];
            a = [a[0] - det * g[0] / norm, a[1] - det * g[1] / norm];
        }
        assert!(map.det(a).abs() < 1e-12);
    }
    a
}

/// The gradient of det, by differences.
fn slopes(map: &PlaneMap, a: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|j| {
        let at = |h: f64| map.det(std::array::from_fn(|k| a[k] + if k == j { h } else { 0.0 }));
        (at(1e-5) - at(-1e-5)) / 2e-5
    })
}

pub fn check_line(map: &PlaneMap, line: &BoundaryLine) {
    for w in line.vertices().windows(2) {
        assert!((map.forward_unturned(w[0].a) - w[0].at).norm() < 1e-12);
        assert!((w[1].a[0] - w[0].a[0]).hypot(w[1].a[1] - w[0].a[1]) < 0.36);
        for t in [0.25, 0.5, 0.75] {
            let a = between(map, [w[0], w[1]], t);
            let off = from_chord(w[0].at, w[1].at, map.forward_unturned(a));
            assert!(off < 1e-5, "{off:e} {:?}", w[0]);
        }
    }
}

/// Along a fold, the sense in which its image is passed changes at cusps and only there.
#[test]
fn folds_turn_back_at_their_cusps() {
    for limits in CASES {
        let map = within(limits);
        let boundary = Boundary::of(&map);
        let folds = boundary.fold_curves();
        assert_eq!(folds.is_empty(), !boundary.interior_singularity());
        let mut turns = 0;
        for fold in &folds {
            check_line(&map, fold);
            let v = fold.vertices();
            assert!(v.iter().all(|v| v.curve == BoundaryCurve::Fold && map.det(v.a).abs() < 1e-12));
            let ends = [v[0].a, v[v.len() - 1].a];
            if fold.is_closed() {
                assert_eq!(ends[0], ends[1]);
            } else {
                // An open fold ends at a limit.
                let at_limit = |a: [f64; 2]| {
                    (0..2).any(|j| (a[j] - map.limits()[j].min).abs().min((a[j] - map.limits()[j].max).abs()) < 2e-9)
                };
                assert!(ends.into_iter().all(at_limit), "{ends:?}");
            }
            for w in v.windows(3) {
                let [before, after] = [w[1].at - w[0].at, w[2].at - w[1].at];
                if dot(before, after) < 0.0 {
                    turns += 1;
                    assert!(boundary.cusps().iter().any(|c| c.a == w[1].a), "{:?}", w[1]);
                }
            }
            let closing = fold.is_closed() && dot(v[1].at - v[0].at, v[v.len() - 1].at - v[v.len() - 2].at) < 0.0;
            turns += usize::from(closing);
        }
        assert_eq!(turns, boundary.cusps().len(), "{limits:?}");
        for cusp in boundary.cusps() {
            // What the map loses there lies along the fold.
            let [first, second] = map.columns(&map.arms(cusp.a));
            let g = slopes(&map, cusp.a);
            let along = [-g[1], g[0]];
            let rate = (first * along[0] + second * along[1]).norm() / along[0].hypot(along[1]);
            assert!(rate < 1e-7, "{rate:e} {cusp:?}");
        }
    }
}

/// Across a limit one pose, across a fold two: counted a hair to the left and to the right of every curve.
#[test]
fn lines_have_more_poses_on_their_left() {
    for limits in CASES {
        let map = within(limits);
        let boundary = Boundary::of(&map);
        let inner = boundary.inner_limits();
        for (line, step) in boundary.fold_curves().iter().map(|l| (l, 2)).chain(inner.iter().map(|l| (l, 1))) {
            if step == 1 {
                check_line(&map, line);
            }
            for w in line.vertices().windows(2).step_by(7) {
                let along = w[1].at - w[0].at;
                if along.norm() < 1e-3 {
                    continue;
                }
                let aside = Vector::new(-along.im, along.re) * (3e-5 / along.norm());
                let middle = 0.5 * (w[0].at + w[1].at);
                // Elsewhere, unless another curve passes by.
                let crossed = |p: Vector| {
                    let lines = boundary.fold_curves().into_iter().chain(boundary.inner_limits());
                    lines
                        .flat_map(|l| l.vertices().windows(2).map(|w| [w[0].at, w[1].at]).collect::<Vec<_>>())
                        .filter(|c| from_chord(c[0], c[1], p) < 1e-4)
                        .count()
                        > 1
                };
                let counts = [middle + aside, middle - aside].map(|p| boundary.pose_count(p, 0.0));
                if counts[0] != counts[1] + step {
                    assert!(crossed(middle), "{limits:?} {counts:?} {:?}", w[0]);
                }
                if step == 1 {
                    assert!(counts[1] > 0 || crossed(middle), "{limits:?} {:?}", w[0]);
                }
            }
        }
    }
}

#[test]
fn poses_outside_of_everything_are_none() {
    let boundary = Boundary::of(&within(CASES[2]));
    assert_eq!(boundary.pose_count(Vector::new(3.0, 0.0), B), 0);
    for (p, b) in
        [(Vector::new(f64::NAN, 0.0), B), (Vector::new(0.0, f64::INFINITY), B), (Vector::new(0.1, 0.1), f64::NAN)]
    {
        assert_eq!(boundary.pose_count(p, b), 0);
        assert_eq!(boundary.distance(p, b), f64::NEG_INFINITY);
    }
}

/// The least distance of p from the images of the four limits, by sampling and golden sections.
fn from_limits(map: &PlaneMap, p: Vector) -> f64 {
    let mut least = f64::INFINITY;
    for edge in 0..4 {
        let at = |t: f64| {
            let a = match edge {
                0 => share(map, t, 0.0),
                1 => share(map, 1.0, t),
                2 => share(map, t, 1.0),
                _ => share(map, 0.0, t),
            };
            (map.forward_unturned(a) - p).norm()
        };
        const N: usize = 400;
        let samples: Vec<f64> = (0..=N).map(|i| at(i as f64 / N as f64)).collect();
        for i in 0..=N {
            let neighbour = |j: usize| samples.get(j).copied().unwrap_or(f64::INFINITY);
            if samples[i] <= neighbour(i + 1) && samples[i] <= neighbour(i.wrapping_sub(1)) {
                let mut range = [i.saturating_sub(1), (i + 1).min(N)].map(|i| i as f64 / N as f64);
                for _ in 0..60 {
                    let [low, high] = range;
                    let [a, b] = [0.381_966, 0.618_034].map(|g| low + g * (high - low));
                    range = if at(a) < at(b) { [low, b] } else { [a, high] };
                }
                least = least.min(at(0.5 * (range[0] + range[1])));
            }
        }
    }
    least
}

#[test]
fn distances_are_those_of_the_true_curves() {
    for limits in [CASES[0], [[0.4, 2.7], [0.3, 2.0]]] {
        let map = within(limits);
        let boundary = Boundary::of(&map);
        let turn = unit(map.turn(B));
        for i in 0..60 {
            let [s, t] = spread(i).map(|x| 2.4 * x - 1.2);
            let p = Vector::new(s, t);
            let distance = boundary.distance(p * turn, B);
            assert!((distance.abs() - from_limits(&map, p)).abs() < 1e-9, "{p} {distance}");
            assert_eq!(distance > 0.0, boundary.contains(p, 0.0));
        }
    }
    for limits in CASES {
        let map = within(limits);
        let boundary = Boundary::of(&map);
        let (mut beside, mut tight) = (0, 0);
        for l in boundary.loops() {
            let v = l.vertices();
            for (i, from) in v.iter().enumerate().step_by(17) {
                assert!(boundary.distance(from.at, 0.0).abs() < 1e-9);
                // Between vertices, below the chord's own error.
                let to = v[(i + 1) % v.len()];
                if from.curve == to.curve && (to.at - from.at).norm() > 1e-3 {
                    let on = map.forward_unturned(between(&map, [*from, to], 0.5));
                    assert!(boundary.distance(on, 0.0).abs() < 1e-9);
                    let left = Vector::new(0.0, 1.0) * (to.at - from.at) / (to.at - from.at).norm();
                    for h in [1e-6, -1e-6, 1e-4, -1e-4] {
                        let distance = boundary.distance(on + h * left, 0.0);
                        assert!(distance.abs() < h.abs() + 1e-9, "{distance:e} {from:?}");
                        beside += 1;
                        // All but next to a horn, where the other side is as near.
                        tight += usize::from((distance - h).abs() < 1e-4 * h.abs());
                    }
                }
            }
        }
        assert!(beside > 100 && beside - tight < beside / 25, "{limits:?}: {tight} of {beside}");
        // It never changes faster than the point moves.
        let mut last: Option<(Vector, f64)> = None;
        for i in 0..200 {
            let p = unit(0.1 * f64::from(i)) * (0.006 * f64::from(i));
            let distance = boundary.distance(p, 0.0);
            if let Some((q, before)) = last {
                assert!((distance - before).abs() <= (p - q).norm() + 1e-9);
            }
            last = Some((p, distance));
        }
    }
}

/// Limits that leave nothing, a line, a whole turn, more than a turn: nothing panics, and everything agrees.
#[test]
fn degenerate_limits_are_sound() {
    let zero = [0.0, 0.0];
    for limits in [[zero, zero], [zero, [0.0, PI]], [[0.0, PI], zero], [[1.0, 1.0], [2.0, 2.0]], [[PI, PI], [0.0, TAU]]]
    {
        let map = within(limits);
        let boundary = Boundary::of(&map);
        assert_eq!((boundary.area(), boundary.max_pose_count()), (0.0, 1));
        assert!(boundary.fold_curves().is_empty() && boundary.inner_limits().is_empty() && boundary.cusps().is_empty());
        assert_eq!(boundary.areas_by_poses(), [0.0]);
        let on = map.forward(share(&map, 0.3, 0.6), B);
        assert!(boundary.pose_count(on, B) >= 1);
        assert!(boundary.distance(on, B).abs() < 1e-9);
        assert!((boundary.distance(on + 3.0, B) + 3.0).abs() < 2.0);
        assert!(Boundary::on_sides(&map, [None; 3]).is_none());
        (0..3).for_each(|pair| assert!(boundary.sides(pair).count() <= 3));
        for curve in boundary.change_curves() {
            check_line(&map, &curve.line);
        }
    }
    for limits in
        [[[0.0, 1e-8], [0.0, PI]], [[0.0, 4.0 * PI], [1.0, 2.0]], [[-TAU, TAU], [0.0, TAU]], [[-7.0, 8.0], [0.1, 1.0]]]
    {
        let map = within(limits);
        counts_agree(&map, 500, 200);
        parts_add_up(&map);
        let boundary = Boundary::of(&map);
        let areas = boundary.areas_by_poses();
        assert!((areas.iter().sum::<f64>() - boundary.sheet_area()).abs() < 1e-9, "{limits:?}");
        boundary.fold_curves().iter().for_each(|l| check_line(&map, l));
    }
}

#[test]
fn other_proportions_and_special_ones() {
    for (key, value) in [("length.l1", "0.9"), ("length.l5", "0.2"), ("length.l9", "1.1"), ("length.l3", "0.7")] {
        let machine = builtin("nine-link").unwrap().set_all([(key, value)]).unwrap();
        for limits in [CASES[0], CASES[3]] {
            let map =
                plane_map(&machine).unwrap().with_limits(limits.map(|[min, max]| AngleLimit { min, max })).unwrap();
            counts_agree(&map, 600, 200);
            parts_add_up(&map);
        }
    }
    // Equal arms, arms without length, λ that make curves coincide: no panic, finite figures.
    let angles = [AngleDefinition { to: 1, from: 0, offset: 0.0 }, AngleDefinition { to: 2, from: 1, offset: PI }];
    for c in [[0.0; 3], [0.5, 0.5, 0.0], [0.5; 3]] {
        for lambda in [[1.0; 3], [1.0, 0.0, 1.0]] {
            for w in [PI, TAU] {
                let map = PlaneMap::new(c, lambda, angles, [AngleLimit { min: 0.0, max: w }; 2]).unwrap();
                let boundary = Boundary::of(&map);
                assert!(boundary.areas_by_poses().iter().all(|a| a.is_finite()));
                assert!(boundary.distance(Vector::new(0.2, 0.3), 0.4).is_finite());
                let part = Boundary::on_sides(&map, [None, None, Some(*boundary.sides(2).start())]);
                assert!(part.is_none_or(|part| part.area().is_finite()));
                let _ = (
                    boundary.fold_curves(),
                    boundary.inner_limits(),
                    boundary.change_curves(),
                    boundary.pose_count(Vector::new(0.2, 0.3), 0.4),
                );
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn random_machines_agree(map in machines()) {
        counts_agree(&map, 400, 120);
        let boundary = Boundary::of(&map);
        let scale = size(&map) * size(&map);
        let areas = boundary.areas_by_poses();
        prop_assert!((areas.iter().sum::<f64>() - boundary.sheet_area()).abs() < 1e-6 * scale, "{areas:?} {}", boundary.sheet_area());
        prop_assert!((areas[0] - boundary.area()).abs() < 1e-9 * scale);
        change_curves_are_sound(&map);
        parts_add_up(&map);
        parts_hold_the_poses_on_their_side(&map, 5);
    }

    #[test]
    fn random_limits_agree(limits in limits()) {
        let map = within(limits);
        counts_agree(&map, 400, 120);
        change_curves_are_sound(&map);
        parts_add_up(&map);
    }
}
