//! Limits of several turns: every winding counts, up to the number that is said, and is refused beyond it.
//!
//! The twin knows one turn at a time: turning a relative angle by a whole turn turns the workspace as a whole, so the
//! poses within wide limits are those of one-turn tiles, each at a b of its own.

use std::f64::consts::TAU;

use stillbase::mechanics::machine::builtin;
use stillbase::mechanics::planar::Vector;
use stillbase::planning::pose_space::plane_map;
use stillbase::planning::reactionless::{AngleDefinition, AngleLimit, Boundary, MAX_LIMIT_RANGE, PlaneMap};

use crate::support::Noise;

/// Any machine of three drives.
fn any_map(noise: &mut Noise) -> PlaneMap {
    let c = [0, 1, 2].map(|_| noise.sign() * noise.between(0.1, 1.0));
    let lambda = [1.0, noise.between(0.05, 1.5), noise.between(0.05, 1.5)];
    let hub = (noise.between(0.0, 3.0) as usize).min(2);
    let angles = [1, 2].map(|i| {
        let other = (hub + i) % 3;
        let [to, from] = if noise.sign() > 0.0 { [hub, other] } else { [other, hub] };
        AngleDefinition { to, from, offset: noise.between(-3.0, 3.0) }
    });
    PlaneMap::new(c, lambda, angles, [AngleLimit { min: 0.0, max: 1.0 }; 2]).expect("a map")
}

fn any_limits(noise: &mut Noise, turns: [f64; 2]) -> [AngleLimit; 2] {
    turns.map(|turns| {
        let width = (TAU * noise.between(0.1, turns)).min(MAX_LIMIT_RANGE);
        let min = noise.between(-0.5 * MAX_LIMIT_RANGE, 0.5 * MAX_LIMIT_RANGE - width);
        AngleLimit { min, max: min + width }
    })
}

/// Limits in pieces of a turn at most.
fn tiles(limit: AngleLimit) -> Vec<AngleLimit> {
    let n = ((limit.max - limit.min) / TAU).ceil() as usize;
    let ends = |i: usize| if i == n { limit.max } else { limit.min + TAU * i as f64 };
    (0..n).map(|i| AngleLimit { min: ends(i), max: ends(i + 1) }).collect()
}

/// All poses of a point, tile by tile.
fn by_tiles(map: &PlaneMap, p: Vector, b: f64) -> Vec<[f64; 2]> {
    let [first, second] = map.limits();
    let mut found: Vec<[f64; 2]> = Vec::new();
    for (i, s) in tiles(first).into_iter().enumerate() {
        for (j, t) in tiles(second).into_iter().enumerate() {
            let turn = [TAU * i as f64, TAU * j as f64];
            // The tile moved back to where the first one is; all drives then stand turned by the same angle.
            let back = |l: AngleLimit, turn: f64| AngleLimit { min: l.min - turn, max: l.max - turn };
            let tile = map.with_limits([back(s, turn[0]), back(t, turn[1])]).expect("one turn");
            let u = map.u();
            let turned = u[0][0] * turn[0] + u[0][1] * turn[1];
            for pose in tile.poses(p, b + map.lambda_sum() * turned).iter() {
                let a = [pose.a[0] + turn[0], pose.a[1] + turn[1]];
                // On the seam of two tiles a pose is found twice.
                if !found.iter().any(|f| (f[0] - a[0]).hypot(f[1] - a[1]) < 1e-6) {
                    found.push(a);
                }
            }
        }
    }
    found
}

/// The most poses that any of so many random points had.
fn every_pose(cases: usize, seed: u64) -> usize {
    let mut noise = Noise::of(seed);
    let mut most = 0;
    for case in 0..cases {
        let map = if case % 3 == 0 {
            plane_map(builtin("nine-link").expect("built in")).expect("a map")
        } else {
            any_map(&mut noise)
        };
        let map = map.with_limits(any_limits(&mut noise, [8.02; 2])).expect("up to eight turns");
        let share = |noise: &mut Noise, l: AngleLimit| l.min + noise.between(0.0, 1.0) * (l.max - l.min);
        let a = map.limits().map(|l| share(&mut noise, l));
        let b = noise.between(-20.0, 20.0);
        let p = map.forward(a, b);
        let poses = map.poses(p, b);
        assert!(poses.iter().any(|f| (f.a[0] - a[0]).hypot(f.a[1] - a[1]) < 1e-6), "case {case}: {a:?} is one of them");
        // Where two poses meet, at a fold or on a limit, rounding decides.
        let near = |l: AngleLimit, a: f64| (a - l.min).abs().min((l.max - a).abs()) < 1e-6;
        if poses.iter().any(|f| map.det(f.a).abs() < 1e-5 || (0..2).any(|i| near(map.limits()[i], f.a[i]))) {
            continue;
        }
        let want = by_tiles(&map, p, b);
        assert_eq!(poses.len(), want.len(), "case {case}: {map:?} {p} {b}");
        for a in &want {
            assert!(poses.iter().any(|f| (f.a[0] - a[0]).hypot(f.a[1] - a[1]) < 1e-6), "case {case}: {a:?}");
        }
        most = most.max(poses.len());
    }
    most
}

#[test]
fn every_pose_of_every_winding_is_found() {
    let most = every_pose(150, 3);
    assert!(most > 64, "{most}: more than once fitted");
}

#[test]
#[ignore = "long: a hundred thousand wide limits"]
fn every_pose_of_every_winding_is_found_often() {
    println!("up to {} poses", every_pose(100_000, 17));
}

/// ∫ |det| da by Gauss's two-point rule.
fn quadrature(map: &PlaneMap) -> f64 {
    let [a1, a2] = map.limits();
    let places = |l: AngleLimit| -> Vec<f64> {
        let n = (40.0 * (l.max - l.min) / TAU).ceil().max(20.0) as usize;
        let place = |i: usize, s: f64| l.min + (l.max - l.min) * (i as f64 + 0.5 + s * 0.5 / 3f64.sqrt()) / n as f64;
        (0..n).flat_map(|i| [place(i, -1.0), place(i, 1.0)]).collect()
    };
    let [s, t] = [places(a1), places(a2)];
    let sum: f64 = s.iter().flat_map(|x| t.iter().map(move |y| map.det([*x, *y]).abs())).sum();
    sum * (a1.max - a1.min) * (a2.max - a2.min) / (s.len() * t.len()) as f64
}

/// Area, sheets and counts of the boundary within wide limits.
fn boundaries(cases: usize, seed: u64, turns: f64) {
    let mut noise = Noise::of(seed);
    for case in 0..cases {
        let map = if case % 2 == 0 {
            plane_map(builtin("nine-link").expect("built in")).expect("a map")
        } else {
            any_map(&mut noise)
        };
        let first = noise.between(0.5, 8.02);
        let mut wide = [first, (turns / first).clamp(0.3, 8.02)];
        if noise.sign() > 0.0 {
            wide.reverse();
        }
        let map = map.with_limits(any_limits(&mut noise, wide)).expect("up to eight turns");
        let boundary = Boundary::of(&map);
        let size: f64 = map.c().iter().map(|c| c.abs()).sum();
        let want = quadrature(&map);
        let off = (boundary.sheet_area() - want).abs();
        assert!(off < 2e-3 * want + 1e-6 * size * size, "case {case}: {} for {want}, {map:?}", boundary.sheet_area());
        assert!(boundary.area() <= boundary.sheet_area() + 1e-9 * size * size);
        for _ in 0..12 {
            let b = noise.between(-9.0, 9.0);
            let p = Vector::new(noise.between(-size, size), noise.between(-size, size));
            let poses = map.poses(p, b);
            // On a curve the count is that of a side.
            let near = |l: AngleLimit, a: f64| (a - l.min).abs().min((l.max - a).abs()) < 1e-6;
            if poses.iter().any(|f| map.det(f.a).abs() < 1e-5 || (0..2).any(|i| near(map.limits()[i], f.a[i]))) {
                continue;
            }
            assert_eq!(boundary.pose_count(p, b), poses.len(), "case {case}: {map:?} {p} {b}");
            assert_eq!(boundary.contains(p, b), !poses.is_empty(), "case {case}: {map:?} {p} {b}");
            assert_eq!(boundary.distance(p, b) >= 0.0, !poses.is_empty(), "case {case}: {map:?} {p} {b}");
        }
    }
}

#[test]
fn areas_and_counts_hold_for_many_turns() {
    boundaries(20, 5, 2.0);
}

#[test]
#[ignore = "long: a thousand boundaries of up to eight turns"]
fn areas_and_counts_hold_for_many_turns_often() {
    boundaries(1000, 23, 8.0);
}

/// The case that a breaker found: eight turns of a_1 have the sheets of eight turns.
#[test]
fn eight_turns_are_not_cut_to_five() {
    let map = plane_map(builtin("nine-link").expect("built in")).expect("a map");
    let [_, second] = map.limits();
    let wide = map.with_limits([AngleLimit { min: -25.0, max: 25.0 }, second]).expect("eight turns");
    let boundary = Boundary::of(&wide);
    assert!((boundary.sheet_area() - 11.251_772).abs() < 1e-5, "{}", boundary.sheet_area());
}
