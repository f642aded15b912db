//! The boundary of a reactionless workspace against closed forms, rasters, quadrature and Newton from many starts.

use std::f64::consts::{PI, TAU};

use proptest::prelude::*;
use stillbase::mechanics::machine::{Inertia, builtin};
use stillbase::mechanics::planar::{Vector, cross, dot, unit};
use stillbase::planning::reactionless::{AngleDefinition, AngleLimit, Boundary, BoundaryCurve, PlaneMap};

use crate::support::{limits, machines};

const B: f64 = 2.4;

fn machine(name: &str) -> PlaneMap {
    let machine = builtin(name).unwrap();
    let lambda = Inertia::of(machine).lambda();
    let angle = |i: usize| &machine.angles()[i];
    PlaneMap::new(
        [0, 1, 2].map(|k| machine.end_effector()[k]),
        [0, 1, 2].map(|k| lambda[k]),
        [0, 1].map(|i| AngleDefinition { to: angle(i).to, from: angle(i).from, offset: angle(i).offset }),
        [0, 1].map(|i| AngleLimit { min: *angle(i).limits.start(), max: *angle(i).limits.end() }),
    )
    .unwrap()
}

fn within(limits: [[f64; 2]; 2]) -> PlaneMap {
    machine("nine-link-table-1").with_limits(limits.map(|[min, max]| AngleLimit { min, max })).unwrap()
}

/// Limits that make every kind of curve: none folded, folded once, overlapping, with holes.
const CASES: [[[f64; 2]; 2]; 7] = [
    [[0.0, PI], [0.0, PI]],
    [[0.3, 2.9], [0.2, 3.0]],
    [[-PI, PI], [-PI, PI]],
    [[0.0, TAU], [0.0, TAU]],
    [[-1.0, 4.0], [-2.0, 5.0]],
    [[-0.8, 1.1], [2.0, 5.5]],
    [[0.0, 1.5 * PI], [-0.5 * PI, PI]],
];

/// The point at shares (s, t) of the limits.
fn share(map: &PlaneMap, s: f64, t: f64) -> [f64; 2] {
    let [a1, a2] = map.limits();
    [a1.min + s * (a1.max - a1.min), a2.min + t * (a2.max - a2.min)]
}

/// A lattice of points: which of them a fine triangulation of the image covers.
struct Raster {
    h: f64,
    size: f64,
    width: usize,
    hit: Vec<bool>,
}

impl Raster {
    fn of(map: &PlaneMap, n: usize, width: usize) -> Self {
        let size = map.c().iter().map(|c| c.abs()).sum::<f64>() * 1.01;
        let h = 2.0 * size / width as f64;
        let mut raster = Self { h, size, width, hit: vec![false; width * width] };
        let rows: Vec<Vec<Vector>> = (0..=n)
            .map(|i| {
                (0..=n).map(|j| map.forward_unturned(share(map, i as f64 / n as f64, j as f64 / n as f64))).collect()
            })
            .collect();
        for i in 0..n {
            for j in 0..n {
                let [a, b, c, d] = [rows[i][j], rows[i + 1][j], rows[i + 1][j + 1], rows[i][j + 1]];
                raster.fill([a, b, c]);
                raster.fill([a, c, d]);
            }
        }
        raster
    }

    fn fill(&mut self, t: [Vector; 3]) {
        let bounds = |f: fn(&Vector) -> f64| {
            let [low, high] = [f64::min, f64::max].map(|pick| t.iter().map(f).reduce(pick).unwrap());
            let index = |x: f64| (x + self.size) / self.h - 0.5;
            (index(low).ceil() as usize, index(high).floor() as usize)
        };
        let (columns, rows) = (bounds(|p| p.re), bounds(|p| p.im));
        for i in columns.0..=columns.1 {
            for j in rows.0..=rows.1 {
                let p = self.point(i, j);
                let sides = [0, 1, 2].map(|k| cross(t[(k + 1) % 3] - t[k], p - t[k]));
                if sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0) {
                    self.hit[i * self.width + j] = true;
                }
            }
        }
    }

    fn point(&self, i: usize, j: usize) -> Vector {
        Vector::new((i as f64 + 0.5) * self.h - self.size, (j as f64 + 0.5) * self.h - self.size)
    }

    fn area(&self) -> f64 {
        self.hit.iter().filter(|&&hit| hit).count() as f64 * self.h * self.h
    }
}

/// ∫ |det| da by Gauss's two-point rule in n² cells.
fn quadrature(map: &PlaneMap, n: usize) -> f64 {
    let [a1, a2] = map.limits();
    let places: Vec<f64> =
        (0..n).flat_map(|i| [-1.0, 1.0].map(|s| (i as f64 + 0.5 + s * 0.5 / 3_f64.sqrt()) / n as f64)).collect();
    let sum: f64 = places
        .iter()
        .flat_map(|&s| places.iter().map(move |&t| (s, t)))
        .map(|(s, t)| map.det(share(map, s, t)).abs())
        .sum();
    sum * (a1.max - a1.min) * (a2.max - a2.min) / (4 * n * n) as f64
}

/// Whether Newton's iteration from any of n² starts ends on p within the limits.
fn reached(map: &PlaneMap, p: Vector, n: usize) -> bool {
    (0..=n).any(|i| {
        (0..=n).any(|j| {
            let start = share(map, i as f64 / n as f64, j as f64 / n as f64);
            // The arms swing by a cell at most; farther away another start is nearer.
            if (map.forward_unturned(start) - p).norm() > 0.4 {
                return false;
            }
            let mut a = start;
            for _ in 0..12 {
                let arms = map.arms(a);
                let gap = p - arms.iter().sum::<Vector>();
                if gap.norm() < 1e-11 {
                    return (0..2).all(|i| map.limits()[i].contains(a[i], 1e-9));
                }
                let [first, second] = map.columns(&arms);
                let det = cross(first, second);
                let step = [cross(gap, second) / det, cross(first, gap) / det];
                let scale = (0.3 / step[0].hypot(step[1])).min(1.0);
                a = [a[0] + scale * step[0], a[1] + scale * step[1]];
            }
            false
        })
    })
}

/// Distance of p from the nearest chord of the boundary.
fn from_boundary(boundary: &Boundary, p: Vector) -> f64 {
    let mut least = f64::INFINITY;
    for l in boundary.loops() {
        let v = l.vertices();
        for (i, a) in v.iter().enumerate() {
            let along = v[(i + 1) % v.len()].at - a.at;
            let t = (dot(p - a.at, along) / along.norm_sqr()).clamp(0.0, 1.0);
            least = least.min((a.at + t * along - p).norm());
        }
    }
    least
}

/// Vertices lie on their curves, chords near them, loops have the area they claim.
fn check_loops(map: &PlaneMap, boundary: &Boundary) {
    let scale = map.c().iter().map(|c| c * c).sum::<f64>();
    let mut polygons = 0.0;
    for l in boundary.loops() {
        let v = l.vertices();
        let mut polygon = 0.0;
        let mut perimeter = 0.0;
        for (i, vertex) in v.iter().enumerate() {
            let next = v[(i + 1) % v.len()];
            polygon += 0.5 * cross(vertex.at, next.at);
            perimeter += (next.at - vertex.at).norm();
            assert!((map.forward_unturned(vertex.a) - vertex.at).norm() < 1e-12);
            match vertex.curve {
                BoundaryCurve::Limit { angle, upper } => {
                    let limit = map.limits()[angle];
                    let at = if upper { limit.max } else { limit.min };
                    assert!((vertex.a[angle] - at).abs() < 1e-9, "{vertex:?}");
                }
                BoundaryCurve::Fold => assert!(map.det(vertex.a).abs() < 1e-9 * scale, "{vertex:?}"),
                BoundaryCurve::Change { .. } => panic!("the whole workspace ends at no change point: {vertex:?}"),
            }
            assert!((0..2).all(|i| map.limits()[i].contains(vertex.a[i], 1e-9)), "{vertex:?}");
        }
        // Chords cut off no more than 2/3 of 1e-5 m all along.
        assert!((polygon - l.area()).abs() < 0.7e-5 * perimeter + 1e-12, "{polygon} {} {perimeter}", l.area());
        polygons += l.area();
    }
    assert!((polygons - boundary.area()).abs() < 1e-12);
    // Counter-clockwise, the largest first.
    assert!(boundary.loops()[0].area() >= 0.0);
}

#[test]
fn answers_known_from_independent_software() {
    let text = include_str!("../reference/planning.json");
    let reference: serde_json::Value = serde_json::from_str(text).unwrap();
    let cases = reference["workspace"].as_array().unwrap();
    assert!(!cases.is_empty());
    for case in cases {
        let number = |key: &str| case[key].as_f64().unwrap();
        let limit = |i: usize| case["limits_a1_a2"][i].as_f64().unwrap();
        let boundary = Boundary::of(&within([[limit(0), limit(1)], [limit(2), limit(3)]]));
        let extent = boundary.extent(number("b"));
        assert!((boundary.sheet_area() - number("sheet_area")).abs() < 1e-12);
        assert!((extent.x_min - number("x_min")).abs() < 1e-12, "{extent:?}");
        assert!((extent.x_max - number("x_max")).abs() < 1e-12, "{extent:?}");
        assert!((extent.y_min - number("y_min")).abs() < 1e-12, "{extent:?}");
        assert!((extent.y_max - number("y_max")).abs() < 1e-12, "{extent:?}");
        assert_eq!(boundary.interior_singularity(), case["interior_singularity"].as_bool().unwrap());
    }
}

/// 2π l_5 (l_9 + λ_3 l_1)/Σλ, and on [0, π]² each point has one pose: one simple loop, four limits, no fold.
#[test]
fn half_turns_have_the_area_of_the_closed_form() {
    for (name, printed) in [("nine-link-table-1", 0.845_159_087_8), ("nine-link", 0.845_144_847_1)] {
        let map = machine(name);
        let (c, lambda) = (map.c(), map.lambda());
        let closed = TAU * -c[1] * (-c[2] + lambda[2] * c[0]) / map.lambda_sum();
        let boundary = Boundary::of(&map);
        assert!((boundary.area() - closed).abs() < 1e-13, "{} {closed}", boundary.area());
        assert!((boundary.sheet_area() - closed).abs() < 1e-13);
        assert!((boundary.area() - printed).abs() < 2e-10, "{name} {}", boundary.area());
        assert!(!boundary.interior_singularity());
        let [outline] = boundary.loops() else { panic!("{} loops", boundary.loops().len()) };
        let mut changes = 0;
        for (i, v) in outline.vertices().iter().enumerate() {
            assert!(v.curve != BoundaryCurve::Fold);
            changes += usize::from(v.curve != outline.vertices()[(i + 1) % outline.vertices().len()].curve);
        }
        assert_eq!(changes, 4);
    }
}

#[test]
fn loops_are_sound_and_match_a_raster() {
    for limits in CASES {
        let map = within(limits);
        let boundary = Boundary::of(&map);
        check_loops(&map, &boundary);
        let raster = Raster::of(&map, 200, 200);
        assert!((raster.area() - boundary.area()).abs() < 4e-3, "{limits:?}: {} {}", raster.area(), boundary.area());
        assert!((quadrature(&map, 100) - boundary.sheet_area()).abs() < 1e-4, "{limits:?}");
    }
}

#[test]
fn holes_run_clockwise() {
    let boundary = Boundary::of(&within([[-1.0, 4.0], [-2.0, 5.0]]));
    let areas: Vec<f64> = boundary.loops().iter().map(|l| l.area()).collect();
    assert_eq!(areas.len(), 2);
    assert!(areas[0] > 1.0 && areas[1] < 0.0, "{areas:?}");
    // The middle of the hole cannot be reached.
    let hole = boundary.loops()[1].vertices();
    let middle = hole.iter().map(|v| v.at).sum::<Vector>() / hole.len() as f64;
    assert!(!boundary.contains(middle, 0.0));
    assert!(!reached(&within([[-1.0, 4.0], [-2.0, 5.0]]), middle, 60));
}

#[test]
fn chords_keep_within_1e_5_of_the_curve() {
    for limits in CASES {
        let map = within(limits);
        let boundary = Boundary::of(&map);
        for l in boundary.loops() {
            let v = l.vertices();
            for (i, from) in v.iter().enumerate() {
                let to = v[(i + 1) % v.len()];
                // A limit is straight in (a_1, a_2), so points between two of its vertices are known.
                if from.curve != to.curve || from.curve == BoundaryCurve::Fold {
                    continue;
                }
                for t in [0.25, 0.5, 0.75] {
                    let a = [0, 1].map(|j| from.a[j] + t * (to.a[j] - from.a[j]));
                    let along = to.at - from.at;
                    let off = cross(along, map.forward_unturned(a) - from.at).abs() / along.norm();
                    assert!(off < 1e-5, "{off:e} {from:?}");
                }
            }
        }
    }
}

#[test]
fn b_only_turns_it() {
    let map = within(CASES[4]);
    let boundary = Boundary::of(&map);
    for (turned, l) in boundary.turned(B).iter().zip(boundary.loops()) {
        for (p, v) in turned.iter().zip(l.vertices()) {
            let at = map.forward(v.a, B);
            assert!((at - Vector::new(p[0], p[1])).norm() < 1e-12);
        }
    }
}

#[test]
fn extents_match_dense_samples_of_the_boundary() {
    for limits in CASES {
        let map = within(limits);
        let boundary = Boundary::of(&map);
        for b in [0.0, B, -7.3] {
            let extent = boundary.extent(b);
            let turned = boundary.turned(b);
            let points = || turned.iter().flatten();
            let most = |j: usize| points().map(|p| p[j]).fold(f64::NEG_INFINITY, f64::max);
            let least = |j: usize| points().map(|p| p[j]).fold(f64::INFINITY, f64::min);
            for (exact, sampled) in [(extent.x_max, most(0)), (extent.y_max, most(1))] {
                assert!(exact >= sampled && exact - sampled < 1e-5, "{exact} {sampled}");
            }
            for (exact, sampled) in [(extent.x_min, least(0)), (extent.y_min, least(1))] {
                assert!(exact <= sampled && sampled - exact < 1e-5, "{exact} {sampled}");
            }
            // No pose goes farther, and one comes within the sampling's own error of it.
            let n = 300;
            let furthest = (0..=n)
                .flat_map(|i| (0..=n).map(move |j| (i as f64 / n as f64, j as f64 / n as f64)))
                .map(|(s, t)| map.forward(share(&map, s, t), b).re)
                .fold(f64::NEG_INFINITY, f64::max);
            assert!(extent.x_max >= furthest - 1e-12 && extent.x_max - furthest < 1e-3);
        }
    }
}

#[test]
fn limits_without_area_leave_a_line_or_a_point() {
    for (limits, length) in [
        ([[1.0, 1.0], [0.5, 2.0]], true),
        ([[0.0, 0.0], [0.0, PI]], true),
        ([[0.0, TAU], [PI, PI]], true),
        ([[PI, PI], [PI, PI]], false),
        ([[2.0, 2.0], [-1.0, -1.0]], false),
    ] {
        let map = within(limits);
        let boundary = Boundary::of(&map);
        assert_eq!((boundary.area(), boundary.sheet_area()), (0.0, 0.0));
        assert_eq!(boundary.loops().len(), 1);
        let extent = boundary.extent(B);
        let span = (extent.x_max - extent.x_min).hypot(extent.y_max - extent.y_min);
        assert_eq!(span > 1e-9, length, "{extent:?}");
        let nearest = boundary.nearest(Vector::new(2.0, 0.0), B, map.forward(share(&map, 0.5, 0.5), B));
        assert!((map.forward(nearest.a, B) - nearest.at).norm() < 1e-12);
        assert!(!boundary.contains(Vector::new(2.0, 0.0), B));
        assert!(boundary.contains(map.forward_unturned(share(&map, 0.0, 0.0)), 0.0));
    }
}

/// All multiples of a quarter turn: corners on folds, folds through corners, limits on nodes.
#[test]
fn special_limits_are_sound() {
    let quarter = 0.5 * PI;
    for i in -2..3 {
        for j in -2..3 {
            for (w, v) in [(1, 2), (2, 2), (4, 3), (4, 4)] {
                let at = |k: i32| f64::from(k) * quarter;
                let map = within([[at(i), at(i + w)], [at(j), at(j + v)]]);
                let boundary = Boundary::of(&map);
                check_loops(&map, &boundary);
                let sheets = quadrature(&map, 24);
                assert!((boundary.sheet_area() - sheets).abs() < 3e-3 * sheets.max(0.1), "{:?}", map.limits());
                assert!(boundary.area() > 0.0 && boundary.area() < boundary.sheet_area() + 1e-12);
            }
        }
    }
}

#[test]
fn degenerate_machines_do_no_harm() {
    let angles = [AngleDefinition { to: 1, from: 0, offset: 0.0 }, AngleDefinition { to: 2, from: 1, offset: PI }];
    for c in [[0.0; 3], [0.5, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5; 3], [1.0, -0.5, -0.5]] {
        for lambda in [[1.0, 0.0, 0.0], [1.0; 3], [1.0, 0.0, 1.0], [1.0, 2.0, 2.0]] {
            for w in [PI, TAU] {
                let map = PlaneMap::new(c, lambda, angles, [AngleLimit { min: 0.0, max: w }; 2]).unwrap();
                let boundary = Boundary::of(&map);
                assert!(boundary.area().is_finite() && boundary.sheet_area().is_finite());
                assert!(!boundary.loops().is_empty() && boundary.loops().iter().all(|l| !l.vertices().is_empty()));
                let nearest = boundary.nearest(Vector::new(3.0, 1.0), 0.3, Vector::new(0.0, 0.0));
                assert!(nearest.distance.is_finite());
            }
        }
    }
    // A thousand turns are refused, with how many would do.
    let wide = [AngleLimit { min: -3000.0, max: 4000.0 }, AngleLimit { min: 0.0, max: 1.0 }];
    let refused = within(CASES[0]).with_limits(wide).expect_err("too wide").to_string();
    assert!(refused.contains("a1 may turn by 7000.00 rad") && refused.contains("eight turns"), "{refused}");
    let boundary = Boundary::of(&within(CASES[0]));
    let nan = Vector::new(f64::NAN, 0.0);
    assert!(!boundary.contains(nan, 0.0));
    let _ = boundary.nearest(nan, f64::INFINITY, nan);
}

#[test]
fn what_it_contains_newton_finds() {
    for limits in CASES {
        let map = within(limits);
        let boundary = Boundary::of(&map);
        for i in 0..400 {
            // A sequence that fills the square.
            let [s, t] = [0.754_877_666, 0.569_840_291].map(|g| (f64::from(i) * g).fract() * 2.6 - 1.3);
            let p = Vector::new(s, t);
            if from_boundary(&boundary, p) > 2e-3 {
                assert_eq!(boundary.contains(p * unit(map.turn(B)), B), reached(&map, p, 40), "{limits:?} {p}");
            }
        }
        for i in 0..50 {
            let a = share(&map, f64::from(i) / 50.0, (f64::from(i) * 0.618_034).fract());
            assert!(boundary.contains(map.forward(a, B), B), "{limits:?} {a:?}");
        }
        // Just inside and just outside of the middle of every tenth chord, below the chord's own error.
        for l in boundary.loops() {
            let v = l.vertices();
            for (i, from) in v.iter().enumerate().step_by(10) {
                let to = v[(i + 1) % v.len()];
                if from.curve != to.curve || from.curve == BoundaryCurve::Fold {
                    continue;
                }
                let on = map.forward_unturned([0, 1].map(|j| 0.5 * (from.a[j] + to.a[j])));
                let left = Vector::new(0.0, 1.0) * (to.at - from.at) / (to.at - from.at).norm();
                assert!(boundary.contains(on + 1e-9 * left, 0.0));
                assert!(!boundary.contains(on - 1e-9 * left, 0.0));
            }
        }
    }
}

#[test]
fn nearest_waits_on_the_boundary_and_does_not_jump() {
    for limits in CASES {
        let map = within(limits);
        let boundary = Boundary::of(&map);
        let turn = unit(map.turn(B));
        let path = |i: usize| Vector::new(0.1, 0.1) + 2.0 * unit(TAU * i as f64 / 1000.0);
        let start = boundary.loops()[0].vertices()[0].at * turn;
        let mut at = boundary.nearest(path(0), B, start).at;
        let (mut jumps, mut largest) = (0, 0.0_f64);
        for i in 1..=1500 {
            let p = path(i);
            let nearest = boundary.nearest(p, B, at);
            assert!((map.forward(nearest.a, B) - nearest.at).norm() < 1e-11);
            assert!(from_boundary(&boundary, nearest.at * turn.conj()) < 1e-5);
            assert!((nearest.distance - (p - nearest.at).norm()).abs() < 1e-12);
            // Within and without are next to it; the very tip of a horn, as at (π, π), has room for itself only.
            let beside = |k: i32| boundary.contains(nearest.at + 1e-9 * unit(f64::from(k) * TAU / 90.0), B);
            if i % 25 == 0 {
                assert!((0..90).any(beside) || boundary.contains(nearest.at, B), "{limits:?} {nearest:?}");
                assert!(!(0..90).all(beside), "{limits:?} {nearest:?}");
            }
            // Nothing nearer next to it along its loop.
            let touches = |from: Vector, to: Vector| {
                let along = to - from;
                let t = (dot(nearest.at - from, along) / along.norm_sqr()).clamp(0.0, 1.0);
                (from + t * along - nearest.at).norm() < 1e-5
            };
            let downhill = boundary.loops().iter().any(|l| {
                let v = l.vertices();
                (0..v.len()).any(|i| {
                    let [from, to] = [v[i].at * turn, v[(i + 1) % v.len()].at * turn];
                    let lowest = (from - p).norm().min((to - p).norm());
                    touches(from, to) && lowest >= nearest.distance - 1e-9
                })
            });
            assert!(downhill, "{limits:?} {p} {nearest:?}");
            // The pointer moves by 13 mm. Only where a local minimum ends does the point slide farther at once.
            let moved = (nearest.at - at).norm();
            jumps += usize::from(moved > 0.05);
            largest = largest.max(moved);
            at = nearest.at;
        }
        assert!(jumps <= 12, "{limits:?}: {jumps} slides, largest {largest}");
    }
}

/// A target outside, between two sides of a concavity: it waits on the side where it stands.
#[test]
fn nearest_does_not_jump_across_a_concavity() {
    let boundary = Boundary::of(&within(CASES[0]));
    let vertices = boundary.loops()[0].vertices();
    let mut apart = 0;
    for from in vertices.iter().step_by(20) {
        for over in vertices.iter().step_by(20) {
            let p = 0.5 * (from.at + over.at);
            if boundary.contains(p, 0.0) {
                continue;
            }
            let [here, there] = [from, over].map(|v| boundary.nearest(p, 0.0, v.at));
            // Downhill: never farther than where it stood.
            assert!(here.distance <= (p - from.at).norm() + 1e-12);
            // Left alone it stays.
            assert!((boundary.nearest(p, 0.0, here.at).at - here.at).norm() < 1e-9);
            apart += usize::from((here.at - there.at).norm() > 0.05);
        }
    }
    assert!(apart > 10, "{apart}");
}

/// det = 0 at all four corners of [0, π]²: the images of adjacent limits touch there. Where a_1 = 0 the outline is
/// smooth; where a_1 = π they leave in the same direction, so that the workspace ends in a horn.
#[test]
fn limits_of_half_turns_touch_at_the_corners() {
    let map = within(CASES[0]);
    for (corner, horn) in [([0.0, 0.0], false), ([PI, 0.0], true), ([PI, PI], true), ([0.0, PI], false)] {
        let columns = map.columns(&map.arms(corner));
        // Towards the inside along both limits.
        let [first, second] = [0, 1].map(|j| columns[j] * if corner[j] > 0.0 { -1.0 } else { 1.0 });
        assert!(cross(first, second).abs() < 1e-15);
        assert_eq!(dot(first, second) > 0.0, horn, "{corner:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn random_limits_match_raster_and_quadrature(limits in limits()) {
        let map = within(limits);
        let boundary = Boundary::of(&map);
        check_loops(&map, &boundary);
        let raster = Raster::of(&map, 120, 150);
        prop_assert!((raster.area() - boundary.area()).abs() < 8e-3, "{} {}", raster.area(), boundary.area());
        let sheets = quadrature(&map, 60);
        prop_assert!((sheets - boundary.sheet_area()).abs() < 4e-4, "{sheets} {}", boundary.sheet_area());
        prop_assert!(boundary.area() <= boundary.sheet_area() + 1e-11);
    }

    #[test]
    fn random_machines_match_raster_and_quadrature(map in machines()) {
        let boundary = Boundary::of(&map);
        check_loops(&map, &boundary);
        let size: f64 = map.c().iter().map(|c| c.abs()).sum();
        let raster = Raster::of(&map, 120, 150);
        prop_assert!((raster.area() - boundary.area()).abs() < 8e-3 * size * size, "{} {}", raster.area(), boundary.area());
        let sheets = quadrature(&map, 60);
        prop_assert!((sheets - boundary.sheet_area()).abs() < 1e-3 * size * size, "{sheets} {}", boundary.sheet_area());
    }
}
