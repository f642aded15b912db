//! Machines of any size: planes and workspaces scale with their lengths, or the machine is refused.

use std::f64::consts::TAU;

use stillbase::mechanics::machine::builtin;
use stillbase::mechanics::planar::Vector;
use stillbase::planning::pose_space::plane_map;
use stillbase::planning::reactionless::{AngleDefinition, AngleLimit, Boundary, NoReach, NotAPlaneMap, PlaneMap};

use crate::support::Noise;

fn map(c: [f64; 3], lambda: [f64; 3], limits: [AngleLimit; 2], offsets: [f64; 2]) -> Result<PlaneMap, NotAPlaneMap> {
    let angles =
        [(1, 0, offsets[0]), (2, 1, offsets[1])].map(|(to, from, offset)| AngleDefinition { to, from, offset });
    PlaneMap::new(c, lambda, angles, limits)
}

/// The same machine seen from below, and with its drives counted from the other end.
fn twins(c: [f64; 3], lambda: [f64; 3], limits: [AngleLimit; 2], offsets: [f64; 2]) -> [PlaneMap; 2] {
    let turned = limits.map(|l| AngleLimit { min: -l.max, max: -l.min });
    let below = map(c, lambda, turned, offsets.map(|x| -x)).expect("a map");
    let angles = [(0, 1, -offsets[1]), (1, 2, -offsets[0])];
    let angles = angles.map(|(from, to, offset)| AngleDefinition { to, from, offset });
    let weights = [1.0, lambda[1] / lambda[2], lambda[0] / lambda[2]];
    let backwards = PlaneMap::new([c[2], c[1], c[0]], weights, angles, [turned[1], turned[0]]).expect("a map");
    [below, backwards]
}

/// Areas go with the square of all lengths; b, poses and limits stay.
fn scale(cases: usize, seed: u64) {
    let mut noise = Noise::of(seed);
    for case in 0..cases {
        let c = [0, 1, 2].map(|_| noise.sign() * noise.between(0.1, 1.0));
        let lambda = [1.0, noise.between(0.05, 1.5), noise.between(0.05, 1.5)];
        let offsets = [noise.between(-3.0, 3.0), noise.between(-3.0, 3.0)];
        let limits = [0, 1].map(|_| {
            let min = noise.between(-3.0, 3.0);
            AngleLimit { min, max: min + noise.between(0.3, 0.9 * TAU) }
        });
        let size = 10f64.powf(noise.between(-6.0, 6.0));
        let one = map(c, lambda, limits, offsets).expect("a map");
        let other = map(c.map(|c| c * size), lambda, limits, offsets).expect("a map");
        let [x, y] = [&one, &other].map(Boundary::of);
        let reach: f64 = c.iter().map(|c| c.abs()).sum();
        for (what, a, b) in [("area", x.area(), y.area()), ("sheets", x.sheet_area(), y.sheet_area())] {
            let off = (a - b / (size * size)).abs();
            assert!(off < 1e-9 * reach * reach, "case {case}, {what} at {size:e}: {a} and {b:e}, {one:?}");
        }
        for twin in twins(c, lambda, limits, offsets) {
            let twin = Boundary::of(&twin);
            for (what, a, b) in [("area", x.area(), twin.area()), ("sheets", x.sheet_area(), twin.sheet_area())] {
                assert!((a - b).abs() < 1e-9 * reach * reach, "case {case}, {what}: {a} and {b}, {one:?}");
            }
        }
        assert!(x.area() <= x.sheet_area() + 1e-12 * reach * reach, "case {case}: {} {}", x.area(), x.sheet_area());
        let at = [0, 1].map(|i| limits[i].min + noise.between(0.01, 0.99) * (limits[i].max - limits[i].min));
        let b = noise.between(-9.0, 9.0);
        let p = one.forward(at, b);
        let [s, t] = [one.reach(p).expect("reached"), other.reach(p * size).expect("reached")];
        assert_eq!(s.intervals.len(), t.intervals.len(), "case {case} at {size:e}: {s:?} {t:?}");
        for (s, t) in s.intervals.iter().flatten().zip(t.intervals.iter().flatten()) {
            assert!((s - t).abs() < 1e-7, "case {case} at {size:e}: {s} {t}");
        }
        let [s, t] = [one.poses(p, b), other.poses(p * size, b)];
        if one.det(at).abs() > 1e-4 {
            let near =
                |f: &stillbase::planning::reactionless::PlanePoint| (f.a[0] - at[0]).hypot(f.a[1] - at[1]) < 1e-7;
            assert!(s.iter().any(near) && t.iter().any(near), "case {case} at {size:e}");
        }
        let beside = [at[0] + 0.02, at[1] - 0.02];
        let [s, t] = [one.follow(p, b, beside), other.follow(p * size, b, beside)];
        assert_eq!(s.is_some(), t.is_some(), "case {case} at {size:e}");
        // From outside, along and within.
        let out = Vector::new(noise.between(-reach, reach), noise.between(-reach, reach));
        let gap = (x.distance(out, b) - y.distance(out * size, b) / size).abs();
        assert!(gap < 1e-8 * reach, "case {case} at {size:e}: {gap:e}");
    }
}

#[test]
fn areas_go_with_the_square_of_lengths_and_b_stays() {
    scale(120, 9);
}

#[test]
#[ignore = "long: a hundred thousand machines"]
fn areas_go_with_the_square_of_lengths_and_b_stays_often() {
    scale(100_000, 31);
}

/// A fold that cuts off a corner of the limits by 1e-5 rad leaves a sliver 1e-13 m wide and 1e-5 m long, whose sides
/// rounding hides: at any size the workspace is as large, reaches as far, and has its poses at as many points.
#[test]
fn slivers_change_neither_an_area_nor_a_distance() {
    let c = [0.531698363952129, -0.30915562106960787, 0.7541660374847151];
    let lambda = [1.0, 0.8040251462454151, 0.6688754843363212];
    let limits = [
        AngleLimit { min: 0.7217204116827065, max: 2.6388096340784077 },
        AngleLimit { min: 0.802195524572598, max: 3.391502698099948 },
    ];
    let offsets = [-1.00476023685831, -1.5905881217888227];
    // The corner is the tip of the sliver, and nearest to where the tip points.
    let corner = map(c, lambda, limits, offsets).expect("a map").forward_unturned([limits[0].min, limits[1].min]);
    let beyond = Vector::new(0.462_886_138_6, 1.742_615_586_5);
    for i in 0..60 {
        let size = 1.03_f64.powi(i - 30);
        let boundary = Boundary::of(&map(c.map(|c| c * size), lambda, limits, offsets).expect("a map"));
        let off = boundary.area() / (size * size) - 0.151_212_014_18;
        assert!(off.abs() < 1e-10, "{off:e} at {size}");
        let off = boundary.distance(beyond * size, 0.0) / size + (beyond - corner).norm();
        assert!(off.abs() < 1e-9, "{off:e} at {size}");
        let off = boundary.areas_by_poses().iter().sum::<f64>() - boundary.sheet_area();
        assert!(off.abs() < 1e-10 * size * size, "{off:e} at {size}");
    }
}

/// A machine of one long arm has the area of its sheets, or says that rounding would hide it.
#[test]
fn one_length_of_any_size_has_a_right_area_or_is_refused() {
    let (mut right, mut refused) = (0, 0);
    for name in ["l1", "l5", "l9", "l2"] {
        for power in -6..=6 {
            let set = builtin("nine-link").expect("built in").set(&format!("length.{name}"), &format!("1e{power}"));
            let machine = set.expect("a length");
            match plane_map(&machine) {
                Err(why) => {
                    let words = why.to_string();
                    assert!(words.contains("want arms of more equal length"), "{words}");
                    refused += 1;
                }
                Ok(map) => {
                    let boundary = Boundary::of(&map);
                    let want = sheets(&map);
                    let off = (boundary.sheet_area() - want).abs();
                    assert!(off < 1e-3 * want, "{name} = 1e{power}: {} for {want}", boundary.sheet_area());
                    let area = boundary.area();
                    assert!(area > 0.0 && area <= boundary.sheet_area() * (1.0 + 1e-6), "{name} = 1e{power}: {area}");
                    right += 1;
                }
            }
        }
    }
    assert!(right >= 26 && refused >= 1, "{right} right, {refused} refused");
}

/// ∫ |det| da, det as the limit of finite areas.
fn sheets(map: &PlaneMap) -> f64 {
    let [s, t] = map.limits();
    let n = 200;
    let at = |l: AngleLimit, i: usize| l.min + (l.max - l.min) * (i as f64 + 0.5) / f64::from(n);
    let sum: f64 = (0..n as usize)
        .flat_map(|i| (0..n as usize).map(move |j| (i, j)))
        .map(|(i, j)| map.det([at(s, i), at(t, j)]).abs())
        .sum();
    sum * (s.max - s.min) * (t.max - t.min) / f64::from(n * n)
}

/// Lengths that differ by little are said with digits that differ; none runs to hundreds of digits.
#[test]
fn lengths_are_said_with_enough_digits_and_not_more() {
    for (distance, farthest) in [(1.576_99, 1.576_961), (1.260_000_001, 1.26), (1e6, 1.26), (1.26e-6, 1.25e-6)] {
        let words = NoReach::TooFar { distance, farthest }.to_string();
        let numbers: Vec<&str> = words.split(' ').filter(|w| w.parse::<f64>().is_ok()).collect();
        assert_eq!(numbers.len(), 2, "{words}");
        let [x, y] = [numbers[0], numbers[1]].map(|w| w.parse::<f64>().expect("a number"));
        assert!(x > y && words.len() < 110, "{words}");
    }
    let long = builtin("nine-link").expect("built in").set("link.1.mass", "1e300").expect_err("refused").to_string();
    assert!(long.contains("1e300") && long.len() < 120, "{long}");
}
