//! Poses of four drives and more: none is denied, from just inside the ends of what b reaches a point on, and what is
//! called the nearest pose is the nearest.

use std::time::Instant;

use stillbase::mechanics::planar::{PerDrive, Vector};
use stillbase::planning::pose_space::PoseSpace;

use crate::support::Noise;
use crate::support::random::{a_pose, a_space};

/// How far inside an end b is asked for, rad; half inside at most.
const INSIDE: [f64; 5] = [1e-9, 1e-6, 1e-3, 0.1, f64::INFINITY];

/// Whether q is a pose of p and b within the limits.
fn is_pose(space: &PoseSpace, q: &[f64], p: Vector, b: f64) -> bool {
    let within = space.joints().iter().zip(space.angles(q).iter()).all(|(joint, a)| {
        let [low, high] = joint.limits();
        *a >= low - 1e-9 && *a <= high + 1e-9
    });
    within && (space.end_effector(q) - p).norm() < 1e-9 * space.farthest() && (space.b(q) - b).abs() < 1e-9
}

/// How many b were asked for, and how many poses were denied, for each of [`INSIDE`].
fn denied(n: usize, machines: usize, seed: u64) -> ([usize; 5], [usize; 5]) {
    let mut noise = Noise::of(seed);
    let (mut asked, mut denied) = ([0; 5], [0; 5]);
    for _ in 0..machines {
        let (_, space) = a_space(&mut noise, n);
        // A pose is there by construction.
        let own = noise.between(-6.0, 6.0);
        let p = space.end_effector(&space.lift(&a_pose(&mut noise, &space), own));
        let set = space.reach(p).expect("a pose is there");
        assert!(set.contains(own), "{n} drives at {p}: {own} in {set:?}");
        for [low, high] in &set.intervals {
            for (k, inside) in INSIDE.into_iter().enumerate() {
                let width = high - low;
                if inside.is_finite() && width < 2.0 * inside {
                    continue;
                }
                let by = inside.min(0.5 * width);
                for b in [low + by, high - by] {
                    asked[k] += 1;
                    let poses = space.poses(p, b, &space.middle());
                    assert!(poses.iter().all(|q| is_pose(&space, q, p, b)), "{n} drives at {p}, b = {b}");
                    denied[k] += usize::from(poses.is_empty());
                }
            }
        }
    }
    (asked, denied)
}

#[test]
fn no_pose_is_denied_inside_the_ends() {
    for (n, machines) in [(4, 5), (5, 1)] {
        let (asked, denied) = denied(n, machines, n as u64);
        assert_eq!(denied, [0; 5], "{n} drives, of {asked:?}");
    }
}

/// Poses gone to from all over the limits, one by one: none is nearer than the one that is called the nearest.
#[test]
fn the_nearest_pose_is_the_nearest() {
    let mut noise = Noise::of(77);
    for n in [4, 4, 4, 5] {
        let (_, space) = a_space(&mut noise, n);
        let b = noise.between(-6.0, 6.0);
        let p = space.end_effector(&space.lift(&a_pose(&mut noise, &space), b));
        let near = if n == 4 { a_pose(&mut noise, &space) } else { space.middle() };
        let far = |a: &PerDrive| a.minus(&near).dot(&a.minus(&near)).sqrt();
        let q = space.poses(p, b, &near)[0];
        assert!(is_pose(&space, &q, p, b));
        let nearest = far(&space.angles(&q));
        for i in 0..80 {
            let start = a_pose(&mut noise, &space);
            let share = f64::from(i) / 80.0;
            let between = PerDrive::from_fn(n - 1, |j| near[j] + share * (start[j] - near[j]));
            let (a, off) = space.drag_to(p, b, &between);
            let is_there = off < 1e-10 * space.farthest();
            assert!(!is_there || far(&a) > nearest - 1e-6, "{n} drives: {} is nearer than {nearest}", far(&a));
        }
    }
}

/// What is proposed for a b that does not reach a point reaches it as printed, and no other b is denied.
#[test]
fn proposals_of_b_reach_their_point_as_printed() {
    let mut noise = Noise::of(19);
    for n in [4, 4, 5] {
        let (_, space) = a_space(&mut noise, n);
        let p = space.end_effector(&space.lift(&a_pose(&mut noise, &space), 0.3));
        let set = space.reach(p).expect("a pose is there");
        let reaches = |b: f64| !space.poses(p, b, &space.middle()).is_empty();
        for _ in 0..2 {
            let b = noise.between(-9.0, 9.0);
            assert_eq!(reaches(b), set.contains(b), "{n} drives at {p}: {b} of {}", set.in_words());
            let nearest = set.nearest(b).expect("some b");
            let shown = set.decimal(nearest, 4).expect("enough digits").value();
            assert!(reaches(nearest) && reaches(shown), "{n} drives at {p}: {shown} for {nearest}");
        }
        for end in set.in_words().split(' ').filter_map(|word| word.parse::<f64>().ok()) {
            assert!(reaches(end), "{n} drives at {p}: {end} of {}", set.in_words());
        }
    }
}

#[test]
#[ignore = "long: hundreds of machines; prints what is denied and how long it takes"]
fn no_pose_is_denied_often() {
    let of = |name: &str, or: u64| std::env::var(name).ok().and_then(|x| x.parse().ok()).unwrap_or(or);
    for n in of("FROM", 4)..=of("TO", 8) {
        let clock = Instant::now();
        let (asked, denied) = denied(n as usize, of("MACHINES", 100) as usize, of("SEED", 1000) + n);
        println!("{n} drives: asked {asked:?}, denied {denied:?}, {:.1} s", clock.elapsed().as_secs_f64());
        assert!(
            denied.iter().zip(&asked).all(|(denied, asked)| 100 * denied <= *asked),
            "{n} drives: {denied:?} of {asked:?}"
        );
    }
}
