//! The workspace of a b of four drives and more: its loops, area, box and distances against each other, against poses at
//! random, against poses found otherwise, and against the closed form of three.

use std::f64::consts::TAU;

use stillbase::mechanics::machine::{Machine, builtin};
use stillbase::mechanics::planar::Vector;
use stillbase::planning::pose_space::plane_map;
use stillbase::planning::pose_space::{Outline, PoseSpace};
use stillbase::planning::reactionless::Boundary;

use crate::support::Noise;
use crate::support::random::{a_pose, a_space};

fn four() -> &'static Machine {
    builtin("four-drive").expect("built in")
}

fn space(machine: &Machine) -> PoseSpace {
    PoseSpace::general(machine).expect("D is constant")
}

/// Within a tolerance that is not relative: m, m².
#[track_caller]
fn near(what: &str, got: &[f64], want: &[f64], tolerance: f64) {
    let off = got.iter().zip(want).fold(0.0_f64, |off, (g, w)| off.max((g - w).abs()));
    assert!(got.len() == want.len() && off <= tolerance, "{what}: got {got:?}, want {want:?}, {off:e} apart");
}

/// The built-in machine with limits at random.
fn limited(noise: &mut Noise) -> PoseSpace {
    let limits = |machine: Machine, angle: &str| {
        let low = noise.between(-2.5, 2.0);
        let limits = format!("{low},{}", low + noise.between(0.3, 3.0));
        machine.set(&format!("limits.{angle}"), &limits).expect("limits")
    };
    space(&["a1", "a2", "a3"].into_iter().fold(four().clone(), limits))
}

/// Machines with four and five drives, and the built-in one with limits at random.
fn spaces(noise: &mut Noise, count: usize) -> Vec<PoseSpace> {
    let any = |i: usize| if i % 3 == 2 { limited(noise) } else { a_space(noise, 4 + i % 3).1 };
    (0..count).map(any).collect()
}

fn signed(line: &[[f64; 2]]) -> f64 {
    let pairs = line.iter().zip(line.iter().cycle().skip(1));
    pairs.map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum()
}

fn holds(line: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let pairs = line.iter().zip(line.iter().cycle().skip(1));
    let crosses =
        pairs.filter(|(a, b)| (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
    crosses.count() % 2 == 1
}

#[test]
fn the_limits_of_one_joint_leave_a_part_without_a_hole() {
    let machine = four().set("limits.a2", "0,1").expect("limits");
    let (space, b) = (space(&machine), 2.4);
    let outline = space.outline(b);
    near("area", &[outline.area], &[0.545_807], 1e-5);
    near("loops", &[outline.loops.iter().map(|line| signed(line)).sum()], &[outline.area], 1e-6);
    // What no pose at this b reaches lies outside.
    for (p, poses) in [([0.9, -0.3], 0), ([0.3, 0.2], 1)] {
        let p = Vector::new(p[0], p[1]);
        let found = space.poses(p, b, &space.middle()).len();
        assert_eq!((found, outline.distance(p) > 0.0), (poses, poses > 0), "{p}");
    }
}

/// The loops hold the area, outer ones counter-clockwise and holes clockwise; the box is theirs.
fn adds_up(noise: &mut Noise, spaces: &[PoseSpace]) {
    for (i, space) in spaces.iter().enumerate() {
        let outline = space.outline(noise.between(-4.0, 4.0));
        let sum: f64 = outline.loops.iter().map(|line| signed(line)).sum();
        near(&format!("{i}: loops"), &[sum], &[outline.area], 1e-6);
        for (k, line) in outline.loops.iter().enumerate() {
            let others = outline.loops.iter().enumerate().filter(|(l, _)| *l != k);
            let depth = others.filter(|(_, other)| holds(other, line[0])).count();
            assert_eq!(signed(line) > 0.0, depth % 2 == 0, "{i}: loop {k}");
        }
        let all = || outline.loops.iter().flatten();
        let least = |k: usize| all().fold(f64::INFINITY, |x, p| x.min(p[k]));
        let most = |k: usize| all().fold(f64::NEG_INFINITY, |x, p| x.max(p[k]));
        near("box", &outline.extent, &[least(0), most(0), least(1), most(1)], 0.0);
    }
}

#[test]
fn loops_add_up_to_the_area() {
    let mut noise = Noise::of(3);
    let spaces = spaces(&mut noise, 8);
    adds_up(&mut noise, &spaces);
}

/// How many points on the edges have the workspace on their left and not on their right, by the b that reach a point
/// there, and of how many. Loops that are nearly as thin as the points are apart do not count.
fn have_it_on_their_left(noise: &mut Noise, space: &PoseSpace, b: f64, outline: &Outline) -> [usize; 2] {
    const BESIDE: f64 = 2e-5;
    let far = space.farthest();
    let reached = |p: Vector| space.reach(p).is_ok_and(|set| set.contains(b));
    let (mut right, mut all) = (0, 0);
    for line in outline.loops.iter().filter(|line| signed(line).abs() > 5e-3 * far * far) {
        let at = |i: usize| Vector::new(line[i % line.len()][0], line[i % line.len()][1]);
        let length: f64 = (0..line.len()).map(|i| (at(i + 1) - at(i)).norm()).sum();
        for _ in 0..12 {
            let mut way = noise.between(0.0, length);
            let passes = |i: &usize| {
                way -= (at(i + 1) - at(*i)).norm();
                way <= 0.0
            };
            let i = (0..line.len()).find(passes).unwrap_or(0);
            let edge = at(i + 1) - at(i);
            let (p, normal) = (at(i) + 0.5 * edge, Vector::new(0.0, BESIDE * far) * edge / edge.norm());
            all += 1;
            right += usize::from(reached(p + normal) && !reached(p - normal));
        }
    }
    [right, all]
}

/// Thin false rings would have it on both sides, or on none.
fn edges_are_edges(noise: &mut Noise, spaces: &[PoseSpace]) -> [usize; 2] {
    let mut sum = [0, 0];
    for (i, space) in spaces.iter().enumerate() {
        let b = noise.between(-4.0, 4.0);
        let [right, all] = have_it_on_their_left(noise, space, b, &space.outline(b));
        assert!(4 * right >= 3 * all, "{i}: at {right} of {all} points");
        sum = [sum[0] + right, sum[1] + all];
    }
    sum
}

#[test]
fn every_edge_has_the_workspace_on_its_left() {
    let mut noise = Noise::of(5);
    let mut spaces = spaces(&mut noise, 8);
    spaces.extend((0..4).map(|_| a_space(&mut noise, 3).1));
    let [right, all] = edges_are_edges(&mut noise, &spaces);
    assert!(right as f64 >= 0.99 * all as f64, "{right} of {all}");
}

fn of_all_kinds(noise: &mut Noise, count: usize) -> Vec<PoseSpace> {
    let any = |i: usize| match i % 6 {
        2 | 5 => limited(noise),
        k => a_space(noise, [3, 4, 5, 4, if i.is_multiple_of(5) { 6 } else { 5 }, 0][k]).1,
    };
    (0..count).map(any).collect()
}

/// The longest way of an outline along one circle about B, rad, and the circle, m. No edge runs along one: where a look
/// missed poses, or saw some that are not there, the outline jumps from circle to circle.
fn along_a_circle(space: &PoseSpace, b: f64) -> [f64; 2] {
    let same = 1e-9 * space.farthest();
    let mut longest = [0.0; 2];
    for line in space.outline(b).loops {
        let at = |i: usize| Vector::new(line[i % line.len()][0], line[i % line.len()][1]);
        let mut way = 0.0;
        for i in 0..2 * line.len() {
            let [p, q] = [at(i), at(i + 1)];
            way = if (p.norm() - q.norm()).abs() < same { way + (q * p.conj()).arg().abs() } else { 0.0 };
            if way > longest[0] {
                longest = [way, p.norm()];
            }
        }
    }
    longest
}

const A_CUSP: f64 = 0.03;

/// Two machines whose outlines once jumped: critical poses were missed beside their last place, and what is known of a
/// circle went on to others of which it was not true.
#[test]
fn no_edge_runs_along_a_circle() {
    let mut noise = Noise::of(11);
    let all = of_all_kinds(&mut noise, 92);
    for (i, space) in [&all[0], &all[27], &all[91]].into_iter().enumerate() {
        let [way, r] = along_a_circle(space, 0.3);
        assert!(way < A_CUSP, "machine {i}: {way} rad at {r} m");
    }
}

/// The b of two distances that hardly differ are as many intervals that hardly differ.
fn alike(space: &PoseSpace, r: f64) {
    let of = |r: f64| space.reach(Vector::new(r, 0.0)).map_or(Vec::new(), |set| set.intervals);
    let (here, beside) = (of(r), of(r + 1e-7 * space.farthest()));
    let ends = here.iter().flatten().zip(beside.iter().flatten());
    let apart = ends.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    assert!(here.len() == beside.len() && apart < 0.02, "at {r} m: {here:?}, beside it {beside:?}");
}

/// On the first machine a critical pose was missed where its curve turns back beyond the limits, on the second one any pose
/// near B.
#[test]
fn distances_beside_each_other_have_nearly_the_same_b() {
    let the = |seed: u64, i: usize| {
        let mut noise = Noise::of(seed);
        (0..i).for_each(|_| {
            a_space(&mut noise, 5);
            noise.between(-4.0, 4.0);
        });
        a_space(&mut noise, 5).1
    };
    let (turns, small) = (the(9, 171), the(8, 162));
    for below in [1e-5, 1e-6, 1e-7] {
        alike(&turns, (0.616_565_763_950_347_9 - below) * turns.farthest());
    }
    for share in [0.0, 1e-4, 5e-3, 0.0117] {
        let whole = [[0.0, small.period()]];
        let set = small.reach(Vector::new(share * small.farthest(), 0.0)).expect("poses");
        assert_eq!(set.intervals, whole, "at {share} of the reach");
    }
    let mut noise = Noise::of(17);
    for n in [4, 5, 4, 5, 6] {
        let space = a_space(&mut noise, n).1;
        for _ in 0..4 {
            let a = a_pose(&mut noise, &space);
            alike(&space, space.end_effector(&space.lift(&a, 0.0)).norm());
        }
    }
}

#[test]
#[ignore = "a campaign of minutes: 300 machines with four drives, 200 with five, 60 with six"]
fn no_edge_of_hundreds_runs_along_a_circle() {
    for (n, count) in [(4, 300), (5, 200), (6, 60)] {
        let mut noise = Noise::of(20 + n as u64);
        let mut run = 0;
        for i in 0..count {
            let space = a_space(&mut noise, n).1;
            let [way, r] = along_a_circle(&space, noise.between(-4.0, 4.0));
            if way > A_CUSP {
                println!("{n} drives, machine {i}: {way} rad at {r} m of {} m", space.farthest());
                run += 1;
            }
        }
        assert!(100 * run <= count, "{n} drives: {run} of {count}");
    }
}

#[test]
#[ignore = "a campaign of minutes: 360 machines, from three drives to six"]
fn every_edge_of_hundreds_has_the_workspace_on_its_left() {
    let mut noise = Noise::of(11);
    let spaces = of_all_kinds(&mut noise, 360);
    adds_up(&mut noise, &spaces);
    let [right, all] = edges_are_edges(&mut noise, &spaces);
    println!("{right} of {all} points");
    assert!(right as f64 >= 0.995 * all as f64, "{right} of {all}");
}

/// Between two circles of this machine poses begin whose joints all have to be near to one place.
#[test]
fn what_lies_outside_is_reached_by_no_pose() {
    let (space, b) = (a_space(&mut Noise::of(15), 5).1, 0.7);
    let outline = space.outline(b);
    let mut noise = Noise::of(16);
    let poses: Vec<Vec<f64>> = (0..2000).map(|_| a_pose(&mut noise, &space).to_vec()).collect();
    let turns = (0..100).map(|i| f64::from(i) / 100.0 * TAU);
    for p in turns.flat_map(|turn| [1.3216, 1.3218].map(|r| Vector::from_polar(r, turn))) {
        let off = outline.distance(p);
        if off < -1e-5 && off > -0.02 {
            let near = approached(&space, p, b, &poses);
            assert!(near > 1e-6, "{p} is reached to {near:e} m, {off:e} m from the boundary");
        }
    }
}

/// Poses at random, some with joints at their limits, have their ends inside; what lies inside is reached by a pose that
/// is found by small steps from poses at random.
#[test]
fn inside_is_what_poses_reach() {
    let mut noise = Noise::of(29);
    for (i, space) in spaces(&mut noise, 6).iter().enumerate() {
        let b = noise.between(-4.0, 4.0);
        let outline = space.outline_within(b, 1e-5, &mut |_| true).expect("wanted to its end");
        let poses: Vec<Vec<f64>> = (0..400)
            .map(|k| {
                let mut a = a_pose(&mut noise, space);
                for (a, joint) in a.iter_mut().zip(space.joints()) {
                    let [low, high] = joint.limits();
                    if k % 2 == 1 && noise.between(0.0, 1.0) < 0.4 {
                        *a = if noise.sign() > 0.0 { low } else { high };
                    }
                }
                a.to_vec()
            })
            .collect();
        for a in &poses {
            let p = space.end_effector(&space.lift(a, b));
            assert!(outline.distance(p) > -2e-5, "{i}: {p} of {a:?} is {} outside", -outline.distance(p));
        }
        for p in points(&mut noise, &outline, 6) {
            if outline.distance(p) > 1e-3 {
                assert!(approached(space, p, b, &poses) < 1e-6, "{i}: nothing reaches {p}");
            }
        }
    }
}

/// Points of the box of an outline.
fn points(noise: &mut Noise, outline: &Outline, count: usize) -> Vec<Vector> {
    let [x_min, x_max, y_min, y_max] = outline.extent;
    (0..count).map(|_| Vector::new(noise.between(x_min, x_max), noise.between(y_min, y_max))).collect()
}

/// How near to a point, m, steps of Gauss and Newton come from the nearest of these poses, held at limits.
fn approached(space: &PoseSpace, p: Vector, b: f64, poses: &[Vec<f64>]) -> f64 {
    let place = |a: &[f64]| space.end_effector(&space.lift(a, b));
    let mut order: Vec<&Vec<f64>> = poses.iter().collect();
    order.sort_by(|x, y| (place(x) - p).norm().total_cmp(&(place(y) - p).norm()));
    let mut best = f64::INFINITY;
    for start in order.into_iter().take(40) {
        let mut a = start.clone();
        for _ in 0..60 {
            let miss = p - place(&a);
            best = best.min(miss.norm());
            if best < 1e-6 {
                return best;
            }
            let step = step(space, &a, miss, &place);
            let size = step.iter().map(|s| s * s).sum::<f64>().sqrt();
            for ((a, step), joint) in a.iter_mut().zip(step).zip(space.joints()) {
                *a = (*a + step * (0.3 / size).min(1.0)).clamp(joint.limits()[0], joint.limits()[1]);
            }
        }
    }
    best
}

/// The least step of the joints that do not push against a limit that takes up a miss, to first order.
fn step(space: &PoseSpace, a: &[f64], miss: Vector, place: &impl Fn(&[f64]) -> Vector) -> Vec<f64> {
    let columns: Vec<Vector> = (0..a.len())
        .map(|j| {
            let beside =
                |by: f64| a.iter().enumerate().map(|(i, a)| if i == j { a + by } else { *a }).collect::<Vec<_>>();
            (place(&beside(1e-6)) - place(&beside(-1e-6))) / 2e-6
        })
        .collect();
    let mut held = vec![false; a.len()];
    loop {
        let free = || columns.iter().zip(&held).filter(|(_, held)| !**held).map(|(c, _)| c);
        let xx = free().map(|c| c.re * c.re).sum::<f64>() + 1e-12;
        let yy = free().map(|c| c.im * c.im).sum::<f64>() + 1e-12;
        let xy: f64 = free().map(|c| c.re * c.im).sum();
        let det = xx * yy - xy * xy;
        let by = [(yy * miss.re - xy * miss.im) / det, (xx * miss.im - xy * miss.re) / det];
        let step: Vec<f64> =
            columns.iter().zip(&held).map(|(c, held)| if *held { 0.0 } else { c.re * by[0] + c.im * by[1] }).collect();
        let pushes = |j: &usize| {
            let [low, high] = space.joints()[*j].limits();
            (a[*j] <= low + 1e-12 && step[*j] < 0.0) || (a[*j] >= high - 1e-12 && step[*j] > 0.0)
        };
        match (0..a.len()).find(|j| !held[*j] && pushes(j)) {
            Some(j) => held[j] = true,
            None => return step,
        }
    }
}

/// ∫ r |B(r)| dr / Σλ, of circles that are asked for one by one.
#[test]
fn the_area_is_that_of_all_circles() {
    const RINGS: u32 = 500;
    let mut noise = Noise::of(43);
    for (i, space) in spaces(&mut noise, 4).iter().enumerate() {
        let outline = space.outline_within(0.7, 1e-5, &mut |_| true).expect("wanted to its end");
        let (nearest, far) = (space.nearest(), space.farthest());
        let width = (far - nearest) / f64::from(RINGS);
        let ring = |j: u32| {
            let r = nearest + width * (f64::from(j) + 0.5);
            let Ok(set) = space.reach(Vector::new(r, 0.0)) else { return 0.0 };
            set.intervals.iter().map(|[low, high]| high - low).sum::<f64>() / set.period * TAU * r * width
        };
        let area = (0..RINGS).map(ring).sum::<f64>();
        near(&format!("{i}"), &[outline.area], &[area], 5e-4 * far * far);
    }
}

/// Area and box of the built-in machine: the area by independent rasters, extrapolated, and then by ∫ r |B(r)| dr / Σλ.
#[test]
fn four_drives_have_their_area() {
    let outline = space(four()).outline(2.4);
    near("area", &[outline.area], &[1.352_36], 1e-5);
    near("box", &outline.extent, &[-0.469_23, 0.982_23, -0.411_89, 1.283_28], 1e-5);
    assert_eq!(outline.loops.len(), 1);
}

/// Three drives have a closed form.
#[test]
fn three_drives_have_the_workspace_of_their_plane() {
    let mut noise = Noise::of(17);
    for i in 0..12 {
        let (machine, space) = a_space(&mut noise, 3);
        let Ok(map) = plane_map(&machine) else { continue };
        let b = noise.between(-4.0, 4.0);
        let (outline, boundary) = (space.outline(b), Boundary::of(&map));
        near(&format!("{i}: area"), &[outline.area], &[boundary.area()], 2e-6);
        let extent = boundary.extent(b);
        let want = [extent.x_min, extent.x_max, extent.y_min, extent.y_max];
        near(&format!("{i}: box"), &outline.extent, &want, 2e-6);
        for p in points(&mut noise, &outline, 20) {
            near(&format!("{i}: {p}"), &[outline.distance(p)], &[boundary.distance(p, b)], 2e-5);
        }
    }
}
