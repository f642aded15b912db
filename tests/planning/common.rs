//! Which b serve several points, and the least move where none does: against poses at random, for any number of drives.

use std::f64::consts::TAU;
use std::time::Instant;

use stillbase::mechanics::machine::builtin;
use stillbase::mechanics::planar::{Vector, unit};
use stillbase::planning::common::{common_b_set, middle_b, no_common};
use stillbase::planning::pose_constant::PoseConstant;
use stillbase::planning::pose_space::PoseSpace;
use stillbase::planning::posed::{carried_points, nearest_poses, poses_of_points};

use crate::support::Noise;
use crate::support::random::{a_chain, a_pose, a_space};

/// Two or three points that are within reach of some b each.
fn points(noise: &mut Noise, space: &PoseSpace, count: usize) -> Vec<Vector> {
    (0..count)
        .map(|_| {
            let a = a_pose(noise, space);
            space.end_effector(&space.lift(&a, noise.between(0.0, space.period())))
        })
        .collect()
}

/// Moves of points without a common b, checked against `poses` random poses each; how many there were.
fn checked(noise: &mut Noise, space: &PoseSpace, map: &PoseSpace, poses: usize) -> usize {
    let count = 2 + usize::from(noise.between(0.0, 1.0) < 0.3);
    let points = points(noise, space, count);
    let n = space.drives();
    let Some(why) = no_common(map, &points) else {
        assert!(common_b_set(map, &points).is_some(), "{n} drives: {points:?}");
        let b = middle_b(map, &points).expect("some");
        assert!(
            points.iter().all(|p| map.reach(*p).expect("within reach").shifted_near(b).nearest(b).is_some()),
            "{n} drives"
        );
        return 0;
    };
    let Some(mend) = why.correction else {
        assert!(count > 2, "two can always be brought together: {n} drives, {points:?}");
        return 0;
    };
    let (was, others): (Vector, Vec<Vector>) =
        (points[mend.point], points.iter().enumerate().filter(|(i, _)| *i != mend.point).map(|(_, p)| *p).collect());
    let moved = |share: f64| {
        let mut points = points.clone();
        points[mend.point] = was + share * (mend.to - was);
        common_b_set(map, &points).is_some()
    };
    assert!((mend.distance - (mend.to - was).norm()).abs() < 1e-9 * space.farthest(), "{n} drives: {mend:?}");
    assert!(moved(1.0) || moved(1.0 + 1e-6), "{n} drives: {points:?} {mend:?}");
    assert!(mend.distance < 1e-3 * space.farthest() || !moved(0.995), "{n} drives: {points:?} {mend:?}");
    // No pose at a b of the others is nearer.
    let shared = common_b_set(map, &others).expect("the others share some b");
    for _ in 0..poses {
        let a = a_pose(noise, space);
        for [low, high] in &shared.intervals {
            let at = space.end_effector(&space.lift(&a, noise.between(*low, high.max(low + 1e-12))));
            let far = (at - was).norm();
            assert!(
                far > mend.distance - 2e-6 * space.farthest(),
                "{n} drives: {points:?} {mend:?}, {at} is {far} m off"
            );
        }
    }
    1
}

/// Sets of points on machines of so many drives each, checked against `poses` random poses; moves for each n.
fn checked_on(drives: impl Iterator<Item = usize>, sets: usize, poses: usize, seed: u64) -> [usize; 9] {
    let mut noise = Noise::of(seed);
    let mut mended = [0; 9];
    for n in drives {
        let clock = Instant::now();
        let (machine, space) = a_space(&mut noise, n);
        let own = PoseSpace::of(&machine).expect("it has a b");
        assert_eq!(own.planes().is_ok(), n == 3, "{n} drives");
        for _ in 0..sets {
            mended[n] += checked(&mut noise, &space, &own, poses);
        }
        println!("{n} drives: {:.2} s, {mended:?}", clock.elapsed().as_secs_f64());
    }
    mended
}

#[test]
fn the_least_move_is_least_for_any_number_of_drives() {
    let mended = checked_on([2, 2, 2, 2, 3, 3, 4].into_iter(), 3, 400, 211);
    assert!(mended[2] > 3 && mended.iter().sum::<usize>() > 6, "{mended:?}");
}

#[test]
#[ignore = "long: hundreds of sets of points, ten thousand poses each; prints how many moves there were"]
fn the_least_move_is_least_often() {
    let of = |name: &str, or: u64| std::env::var(name).ok().and_then(|x| x.parse().ok()).unwrap_or(or);
    let machines = (0..of("MACHINES", 40)).map(|i| 2 + i as usize % 5);
    println!("{:?}", checked_on(machines, 10, 10_000, of("SEED", 223)));
}

/// The planes of three drives and their pose space reach the same: two ways to one least move.
#[test]
fn planes_and_spaces_move_alike() {
    let machine = builtin("nine-link").expect("built in");
    let spaces = [PoseSpace::of(machine), PoseSpace::general(machine)].map(|space| space.expect("a b"));
    let mut noise = Noise::of(227);
    let mut seen = 0;
    while seen < 6 {
        let points: Vec<Vector> = (0..2).map(|_| noise.between(0.3, 1.2) * unit(noise.between(0.0, TAU))).collect();
        let [Some(one), Some(other)] = spaces.each_ref().map(|space| no_common(space, &points)) else { continue };
        let [one, other] = [one, other].map(|why| why.correction.expect("two can be brought together"));
        assert!((one.distance - other.distance).abs() < 1e-7, "{one:?} {other:?}");
        seen += 1;
    }
}

/// The move as it is printed is hardly longer than the least one, however short that is.
#[test]
fn a_printed_move_is_hardly_longer() {
    let space = PoseSpace::of(builtin("nine-link").expect("built in")).expect("a b");
    let mut noise = Noise::of(233);
    let mut seen = 0;
    while seen < 12 {
        let mut points: Vec<Vector> = (0..2).map(|_| noise.between(0.3, 1.2) * unit(noise.between(0.0, TAU))).collect();
        let Some(mend) = no_common(&space, &points).and_then(|why| why.correction) else { continue };
        // Most of the way is gone already: from a hundredth to a millionth of it is left.
        let left = 10.0_f64.powf(noise.between(-6.0, -2.0));
        let was = points[mend.point];
        points[mend.point] = was + (1.0 - left) * (mend.to - was);
        let Some(mend) = no_common(&space, &points).and_then(|why| why.correction) else { continue };
        let Some(shown) = mend.shown else { continue };
        if shown.to.iter().all(|x| x.decimals() <= 8) {
            assert!(shown.length <= 1.1001 * mend.distance, "{points:?} {mend:?}");
            seen += 1;
        }
    }
}

/// One word for one machine, wherever it is asked.
#[test]
fn whether_there_is_a_b_is_said_once() {
    let mut noise = Noise::of(229);
    for n in 2..=6 {
        let (balanced, _) = a_space(&mut noise, n);
        assert_eq!(PoseConstant::of(&balanced), PoseConstant::Exact, "{n} drives");
        let bare = a_chain(&mut noise, n);
        let constant = PoseConstant::of(&bare);
        match PoseSpace::of(&bare) {
            Ok(_) => assert!(matches!(constant, PoseConstant::Nearly { .. }), "{n} drives: {constant}"),
            Err(why) => assert!(constant.to_string().ends_with(&why.to_string()), "{n} drives: {constant}"),
        }
    }
}

/// Points that one b serves have a pose each; past the b that serve them they turn about the base.
#[test]
fn points_have_a_pose_each_and_turn_where_b_does_not_serve_them() {
    let mut noise = Noise::of(239);
    let mut turned = 0;
    for i in 0..12 {
        let (machine, general) = a_space(&mut noise, 2 + i % 3);
        let own = PoseSpace::of(&machine).expect("it has a b");
        for space in [&own, &general] {
            let (n, b) = (space.drives(), noise.between(-3.0, 3.0));
            let points: Vec<Vector> = (0..2).map(|_| space.forward(&a_pose(&mut noise, space), b)).collect();
            let poses = poses_of_points(space, &points, b).expect("both are reached");
            assert_eq!(poses.len(), 2);
            for (pose, p) in poses.iter().zip(&points) {
                assert!(
                    (space.end_effector(&pose.q) - p).norm() < 1e-6 * space.farthest(),
                    "{n} drives: {pose:?} off {p}"
                );
                assert!((space.b(&pose.q) - b).abs() < 1e-6 && (pose.b - b).abs() < 1e-6, "{n} drives: {pose:?}");
                assert!(space.angles(&pose.q).minus(&pose.a).max_abs() < 1e-9, "{n} drives: {pose:?}");
            }
            let apart = nearest_poses(space, [points[0], points[1]], [b, b]).expect("both are reached");
            let ways = [apart, [poses[0], poses[1]]].map(|[from, to]| from.distance_to(space, &to));
            assert!(space.planes().is_err() || ways[0] <= ways[1] + 1e-9, "{n} drives: {ways:?}");
            assert_eq!(carried_points(space, &points, [b, b]), points, "where b serves them they stay");
            let other = b + noise.between(1.0, 3.0);
            let there = carried_points(space, &points, [b, other]);
            turned += usize::from(there != points);
            for (p, at) in points.iter().zip(&there) {
                assert!((p.norm() - at.norm()).abs() < 1e-6 * space.farthest(), "{n} drives: {p} goes to {at}");
            }
        }
    }
    assert!(turned > 8, "{turned}");
}
