//! Pose constants of any number of drives: against the reference, against the plane of three, against poses at random,
//! and against climbing along the freedoms that a point leaves.

use std::f64::consts::TAU;

use stillbase::mechanics::balance::design;
use stillbase::mechanics::machine::{Machine, builtin};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase::planning::pose_constant::PoseConstant;
use stillbase::planning::pose_space::{NoPoseSpace, PoseSpace, plane_map};
use stillbase::session::Run;
use stillbase::session::scenario::Scenario;

use crate::support::random::a_chain;
use crate::support::{Noise, close, family_machine};

fn space(machine: &Machine) -> PoseSpace {
    PoseSpace::general(machine).expect("D is constant")
}

/// A balanced chain of n drives with motors and rotors anywhere, of which Σλ is above 0.
fn any_space(noise: &mut Noise, n: usize) -> (Machine, PoseSpace) {
    loop {
        let chain = a_chain(noise, n);
        let machine = design(&chain, &vec![1.0; n]).expect("a chain can be balanced");
        match PoseSpace::general(&machine) {
            Ok(space) => return (machine, space),
            Err(NoPoseSpace::Sum { .. }) => {}
            Err(why) => panic!("{why}"),
        }
    }
}

fn any_pose(noise: &mut Noise, space: &PoseSpace) -> PerDrive {
    PerDrive::from_fn(space.joints().len(), |i| {
        let [low, high] = space.joints()[i].limits();
        noise.between(low, high)
    })
}

#[test]
fn the_b_of_points_are_those_of_the_reference() {
    for (name, p, want, period) in [
        ("two-drive", [0.633, 0.353], vec![[1.949_217_091_1; 2]], 8.514_844_670_1),
        ("serial-3r", [0.669, 0.673], vec![[0.705_917_6, 1.500_877_3]], 7.323_056),
        ("nine-link-geared", [1.073, 0.450], vec![[1.549_380_9, 1.813_560_2]], 8.087_61),
        ("four-drive", [1.141, 0.316], vec![[1.412_902_7, 1.980_405_8]], 8.172_88),
        ("four-drive", [0.050, -0.539], vec![[6.227_433_9, 9.176_216_4]], 8.172_88),
    ] {
        let space = space(&family_machine(&format!("{name}-balanced")));
        let set = space.reach(Vector::new(p[0], p[1])).expect("within reach");
        assert_eq!(set.intervals.len(), want.len(), "{name}: {set:?}");
        close(name, set.intervals.as_flattened(), want.as_flattened(), 1e-7);
        close(name, &[set.period], &[period], 1e-6);
    }
}

/// For three drives the plane knows it all in another way.
#[test]
fn with_three_drives_it_is_the_plane() {
    let mut noise = Noise::of(11);
    let (mut same, mut several) = (0, 0);
    for i in 0..400 {
        let (machine, space) = match i {
            0..100 => {
                let machine = family_machine(["serial-3r-balanced", "nine-link-geared-balanced"][i % 2]);
                let space = space(&machine);
                (machine, space)
            }
            _ => any_space(&mut noise, 3),
        };
        let Ok(map) = plane_map(&machine) else { continue };
        let a = any_pose(&mut noise, &space);
        let q = space.lift(&a, noise.between(-3.0, 3.0));
        let p = space.end_effector(&q);
        let (own, want) = (space.reach(p).expect("a pose is there"), map.reach(p).expect("a pose is there"));
        assert_eq!(own.intervals.len(), want.intervals.len(), "{i}: {p} {own:?} {want:?}");
        close(&format!("{i}"), own.intervals.as_flattened(), want.intervals.as_flattened(), 1e-7);
        same += 1;
        several += usize::from(own.intervals.len() > 1);
    }
    assert!(same > 350 && several > 20, "{same}, {several}");
}

/// A space answers by its closed forms where it has them, and by the way of any number of drives where these are left out:
/// the same coordinates, poses, sets and workspaces, however the machine's file orders its angles.
#[test]
fn closed_forms_and_the_general_way_agree() {
    let mut noise = Noise::of(37);
    let (mut machines, mut several, mut none) = (0, 0, 0);
    while machines < 40 {
        let (machine, general) = any_space(&mut noise, 3);
        let own = PoseSpace::of(&machine).expect("it has a b");
        if own.planes().is_err() {
            continue;
        }
        machines += 1;
        assert!(general.planes().is_err());
        // Where a space has planes its angles are in the order of the machine's.
        let place = |space: &PoseSpace| space.joints().iter().map(|joint| joint.angle()).collect::<Vec<_>>();
        assert_eq!(place(&own), [Some(0), Some(1)]);
        assert_eq!((own.lambda(), own.arms(), own.period()), (general.lambda(), general.arms(), general.period()));
        let order: Vec<usize> = place(&general).into_iter().map(|i| i.expect("an angle")).collect();
        let ordered = |a: &PerDrive| PerDrive::from_fn(2, |i| a[order[i]]);
        let outlines = [&own, &general].map(|space| space.outline(0.7));
        let size = own.farthest() * own.farthest();
        close("area", &[outlines[0].area / size], &[outlines[1].area / size], 1e-5);
        for _ in 0..12 {
            let (a, b) = (any_pose(&mut noise, &own), noise.between(-4.0, 4.0));
            let (q, p) = (own.lift(&a, b), own.forward(&a, b));
            close("lifted", &q, &general.lift(&ordered(&a), b), 1e-12);
            close("placed", &[p.re, p.im], &[general.end_effector(&q).re, general.end_effector(&q).im], 1e-12);
            close("b", &[own.project(&q).1], &[general.project(&q).1], 1e-12);
            close("angles", &ordered(&own.angles(&q)), &general.angles(&q), 1e-12);
            let rates = [&own, &general].map(|space| space.lift_rates(&space.angle_rates(&q), space.b(&q)));
            close("rates", &rates[0], &rates[1], 1e-12);
            // A pose is found at every b of its point, by both.
            let (b, at) = (b + noise.between(-0.6, 0.6), p);
            let found = [&own, &general].map(|space| space.representative_poses(at, b));
            let sets = [&own, &general].map(|space| space.reach(at).expect("a pose is there"));
            let (inside, edge) = (
                sets[0].contains(b),
                sets[0].intervals.iter().flatten().any(|end| {
                    let off = (end - b).rem_euclid(own.period());
                    off.min(own.period() - off) < 1e-6
                }),
            );
            if edge {
                continue;
            }
            assert_eq!(sets[1].contains(b), inside, "{at} at {b}: {sets:?}");
            assert_eq!([&own, &general].map(|space| space.reaches(at, b)), [inside; 2]);
            assert_eq!(found[0].len(), found[1].len(), "{at} at {b}: {found:?}");
            for a in &found[0] {
                let twin = found[1].iter().map(|other| other.minus(&ordered(a)).max_abs()).fold(1.0, f64::min);
                assert!(twin < 1e-6, "{at} at {b}: {found:?}");
            }
            several += usize::from(found[0].len() > 1);
            none += usize::from(found[0].is_empty());
        }
    }
    assert!(several > 5 && none > 50, "{several} {none}");
}

/// b of any pose lies in the set of its point, and a pose is found at every b well within it.
#[test]
fn poses_and_sets_agree() {
    let mut noise = Noise::of(5);
    for i in 0..120 {
        let n = 1 + i % 6;
        let (_, space) = any_space(&mut noise, n);
        for _ in 0..20 {
            let b = noise.between(-6.0, 6.0);
            let q = space.lift(&any_pose(&mut noise, &space), b);
            close("there and back", &[space.b(&q)], &[b], 1e-12);
            let p = space.end_effector(&q);
            let set = space.reach(p).expect("a pose is there");
            assert!(set.contains(b), "{n} drives at {p}: {b} in {set:?}");
        }
        if n > 4 {
            continue;
        }
        let p = space.end_effector(&space.lift(&any_pose(&mut noise, &space), 0.0));
        for [low, high] in space.reach(p).expect("a pose is there").intervals {
            let b = 0.5 * (low + high);
            let poses = space.poses(p, b, &space.middle());
            assert!(!poses.is_empty(), "{n} drives at {p}: no pose at {b} of [{low}, {high}]");
            for q in poses {
                close("b", &[space.b(&q)], &[b], 1e-9);
                let miss = (space.end_effector(&q) - p).norm();
                assert!(miss < 2e-6 * space.farthest(), "{n} drives: {miss}");
                for (joint, a) in space.joints().iter().zip(space.angles(&q).iter()) {
                    assert!(*a >= joint.limits()[0] - 1e-9 && *a <= joint.limits()[1] + 1e-9);
                }
            }
        }
    }
}

/// Climbing b from random poses of a point, by small moves of the joints that keep the point: it comes to rest at an
/// end of the set, and never beyond.
#[test]
fn climbing_ends_where_the_set_does() {
    let mut noise = Noise::of(23);
    let mut reached = 0;
    for i in 0..24 {
        let machine = match i % 4 {
            0 => family_machine("four-drive-balanced"),
            k => any_space(&mut noise, 3 + k).0,
        };
        let space = space(&machine);
        let start = space.lift(&any_pose(&mut noise, &space), 0.0);
        let p = space.end_effector(&start);
        let set = space.reach(p).expect("a pose is there");
        for up in [1.0, -1.0] {
            let (mut a, mut b) = (space.angles(&start), space.b(&start));
            let mut step = 0.3;
            while step > 1e-7 {
                let better = (0..60).find_map(|_| {
                    let wanted = PerDrive::from_fn(a.len(), |j| a[j] + step * noise.between(-1.0, 1.0));
                    let there = projected(&space, p, &space.lift(&a, b), wanted)?;
                    (up * (there.1 - b) > 0.0).then_some(there)
                });
                match better {
                    Some(there) => (a, b) = there,
                    None => step *= 0.5,
                }
            }
            let period = set.period;
            let gap = |x: f64| {
                let by = (b - x).rem_euclid(period);
                by.min(period - by)
            };
            assert!(set.contains(b) || set.intervals.iter().flatten().any(|x| gap(*x) < 1e-6), "{i}: {b} {set:?}");
            let end = set.intervals.iter().map(|[low, high]| if up > 0.0 { *high } else { *low });
            // Some hills are not the highest: most are.
            reached += usize::from(end.map(gap).fold(f64::INFINITY, f64::min) < 2e-3);
        }
    }
    assert!(reached > 24, "{reached} of 48");
}

/// Relative angles near wanted ones that keep the point, and their b, continued from a pose: two joints take up the
/// miss. `None` beyond the limits.
fn projected(space: &PoseSpace, p: Vector, from: &[f64], wanted: PerDrive) -> Option<(PerDrive, f64)> {
    let mut a = wanted;
    let within =
        |a: &PerDrive| space.joints().iter().zip(a.iter()).all(|(j, a)| *a >= j.limits()[0] && *a <= j.limits()[1]);
    for (a, joint) in a.iter_mut().zip(space.joints()) {
        *a = a.clamp(joint.limits()[0], joint.limits()[1]);
    }
    let last = a.len() - 1;
    // The distance from B is met by one joint; the turn of all by b.
    let distance = |a: &PerDrive| space.end_effector(&space.lift(a, 0.0)).norm() - p.norm();
    for joint in [last, 0] {
        let mut at = a;
        for _ in 0..30 {
            let miss = distance(&at);
            let mut beside = at;
            beside[joint] += 1e-6;
            let slope = (distance(&beside) - miss) / 1e-6;
            let by = -miss / slope;
            if !by.is_finite() || by.abs() > 0.5 {
                break;
            }
            at[joint] += by;
            if by.abs() < 1e-14 {
                break;
            }
        }
        if distance(&at).abs() < 1e-11 && within(&at) {
            let unturned = space.lift(&at, 0.0);
            let turn = (p * space.end_effector(&unturned).conj()).arg();
            let near = from[0] - unturned[0];
            let turn = turn + TAU * ((near - turn) / TAU).round();
            let b = turn * space.lambda().iter().sum::<f64>();
            return Some((at, b));
        }
    }
    None
}

/// The set of poses of a b of two drives is a curve: its ends are those of the joint's limits, its length that of its
/// chords.
#[test]
fn two_drives_have_a_curve() {
    let (mut noise, mut against) = (Noise::of(3), 0);
    // The rotor of drive 2 has more momentum than its links, the other way: λ_2 is below 0.
    let rotor = [("drive.2.rotor.inertia", "0.01"), ("drive.2.rotor.ratio", "-10")];
    let geared = builtin("two-drive").expect("built in").set_all(rotor).expect("valid");
    for i in 0..60 {
        let space = if i < 5 { space(&geared) } else { any_space(&mut noise, 2).1 };
        against += usize::from(space.lambda().iter().any(|x| *x < 0.0));
        let b = noise.between(-4.0, 4.0);
        let outline = space.outline(b);
        let [low, high] = space.joints()[0].limits();
        let place = |a: f64| space.end_effector(&space.lift(&[a], b));
        let n = 20_000;
        let chords: f64 = (0..n)
            .map(|i| {
                let at = |i: usize| place(low + (high - low) * i as f64 / f64::from(n as u32));
                (at(i + 1) - at(i)).norm()
            })
            .sum();
        close("length", &[outline.length], &[chords], 1e-5);
        let ends = [outline.curve[0], *outline.curve.last().expect("points")];
        for (end, a) in ends.iter().zip([low, high]) {
            close("end", end, &[place(a).re, place(a).im], 1e-12);
        }
        for [x, y] in outline.curve.iter().step_by(17) {
            assert!(space.reach(Vector::new(*x, *y)).expect("on the curve").contains(b));
        }
        // A chord is nowhere farther from the curve than in its middle, also where one drive turns against the other.
        let turned = |q: f64| space.end_effector(&DriveAngles(PerDrive::from([0.0, q]))).norm();
        let reach = turned(0.0).max(turned(std::f64::consts::PI));
        let parts = outline.curve.len() - 1;
        for (k, ends) in outline.curve.windows(2).enumerate() {
            let on_curve = place(low + (high - low) * (k as f64 + 0.5) / parts as f64);
            let middle = 0.5 * (Vector::new(ends[0][0], ends[0][1]) + Vector::new(ends[1][0], ends[1][1]));
            assert!((on_curve - middle).norm() <= 1.01e-5 * reach.max(1e-3), "{}", (on_curve - middle).norm() / reach);
        }
    }
    assert!(against >= 5, "{against} machines with a drive that turns against the other");
}

/// Area and boundary of four drives, at b = 2.4 the reference's; what random poses reach lies inside, and points of the
/// boundary are reached just there.
#[test]
fn the_workspace_of_four_drives() {
    let space = space(&family_machine("four-drive-balanced"));
    let outline = space.outline(2.4);
    // The reference counts cells of a grid that random poses fall into, some of them cut by the boundary. Grids of 2, 4
    // and 8 mm give 1.3588, 1.3657 and 1.3793 m²: what is left of them at 0 is 1.352.
    close("area", &[outline.area], &[1.365], 1.2e-2);
    close("area", &[outline.area], &[1.352], 1e-3);
    close("extent", &outline.extent, &[-0.469_23, 0.982_23, -0.411_89, 1.283_28], 2e-5);
    let polygon: f64 = outline.loops.iter().map(|line| signed(line)).sum();
    close("polygon", &[polygon], &[outline.area], 1e-4);
    let mut noise = Noise::of(9);
    for _ in 0..100 {
        let p = space.end_effector(&space.lift(&any_pose(&mut noise, &space), 2.4));
        let windings: f64 = outline.loops.iter().map(|line| winding(line, p)).sum();
        let near = outline.loops.iter().flatten().any(|q| (Vector::new(q[0], q[1]) - p).norm() < 2e-3);
        assert!(near || (windings - 1.0).abs() < 1e-9, "{p}: {windings}");
    }
    for line in &outline.loops {
        for (i, q) in line.iter().enumerate().step_by(47) {
            let p = Vector::new(q[0], q[1]);
            assert!(space.reach(p).is_ok_and(|set| set.contains(2.4)), "{p}");
            // Beside it, on one side only, there is no pose at this b.
            let next = line[(i + 1) % line.len()];
            let along = Vector::new(next[0] - q[0], next[1] - q[1]);
            let outside = p + Vector::new(along.im, -along.re) / along.norm() * 1e-3;
            let sharp = along.norm() < 1e-6;
            assert!(sharp || !space.reach(outside).is_ok_and(|set| set.contains(2.4)), "{p} is inside");
        }
    }
}

/// Boundaries carry over what is covered from one distance to the next: for machines at random with four drives, the
/// area is that of what is reached at many distances, each asked for alone.
#[test]
fn areas_of_any_four_drives_are_what_is_reached() {
    const RINGS: u32 = 300;
    let mut noise = Noise::of(41);
    for i in 0..8 {
        let (_, space) = any_space(&mut noise, 4);
        let outline = space.outline_within(0.4, 1e-3, &mut |_| true).expect("wanted to its end");
        let (near, far) = (space.nearest(), space.farthest());
        let width = (far - near) / f64::from(RINGS);
        let ring = |j: u32| {
            let r = near + width * (f64::from(j) + 0.5);
            let Ok(set) = space.reach(Vector::new(r, 0.0)) else { return 0.0 };
            set.intervals.iter().map(|[low, high]| high - low).sum::<f64>() / set.period * TAU * r * width
        };
        let area = (0..RINGS).map(ring).sum::<f64>();
        assert!((outline.area - area).abs() < 5e-3 * area, "{i}: {} by the boundary, {area} by rings", outline.area);
    }
}

fn signed(line: &[[f64; 2]]) -> f64 {
    let pairs = line.iter().zip(line.iter().cycle().skip(1));
    pairs.map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum()
}

fn winding(line: &[[f64; 2]], p: Vector) -> f64 {
    let at = |q: &[f64; 2]| Vector::new(q[0], q[1]) - p;
    let pairs = line.iter().zip(line.iter().cycle().skip(1));
    pairs.map(|(a, b)| (at(b) * at(a).conj()).arg()).sum::<f64>() / TAU
}

/// A machine that has no b says so, and why.
#[test]
fn without_b_it_says_why() {
    let builtin = |name| stillbase::mechanics::machine::builtin(name).expect("built in");
    let why = PoseSpace::of(builtin("space-arm")).expect_err("not balanced");
    assert!(matches!(why, NoPoseSpace::Varies { .. }), "{why}");
    assert!(why.to_string().contains("link") && why.to_string().contains("design"), "{why}");
    assert!(!why.to_string().contains("integral"), "{why}");
    // Two drives have a quantity of their own, and are told why it is not offered.
    let two = PoseSpace::of(builtin("scara")).expect_err("not balanced").to_string();
    assert!(two.contains("integral over q₂ − q₁") && two.contains("not offered as b, because"), "{two}");
    // Three drives are no exception: they run, without planes.
    let planes = plane_map(builtin("space-arm")).expect_err("not balanced");
    assert_eq!(planes.to_string(), why.to_string());
    let run = Run::new(&Scenario::builtin("space-arm").expect("built in")).expect("it runs");
    assert!(run.planes().is_none() && run.waiting().is_none());
}

#[test]
fn what_is_nearly_balanced_has_a_b_and_is_not_called_reactionless() {
    let exact = stillbase::mechanics::machine::builtin("nine-link").expect("built in");
    let heavier = exact.set("link.9.mass", "0.5").expect("a machine");
    let rounded = stillbase::mechanics::machine::builtin("nine-link-table-1").expect("built in");
    let is_reactionless = |machine| crate::support::planes(machine).is_reactionless();
    assert!(is_reactionless(exact) && !is_reactionless(rounded) && !is_reactionless(&heavier));
    let bare = family_machine("four-drive");
    let four = PoseSpace::of(&bare).expect("it has a b");
    assert!(!four.is_reactionless());
    // The label of b in the window says what `check`, `reach` and `plan` say.
    for machine in [exact, rounded, &heavier, &bare] {
        let space = PoseSpace::of(machine).expect("it has a b");
        assert_eq!(space.is_reactionless(), PoseConstant::of(machine) == PoseConstant::Exact, "{}", machine.name());
    }
}

/// One arm, whichever way it points: b is the angle of the drive at which its end is on the point.
#[test]
fn one_arm_points_both_ways() {
    let arm = |direction: i32| {
        let text = format!(
            "name = \"one\"\n[[drive]]\nname = \"1\"\n[[link]]\nname = \"1\"\ndrive = \"1\"\nattach = \"base\"\n\
             direction = {direction}\nlength = 0.7\nmass = 1.0\ninertia = 0.1\ncom = 0.0\n[end_effector]\nlink = \"1\"\n"
        );
        stillbase::mechanics::machine::parse(&text, "one").expect("a machine")
    };
    for direction in [1, -1] {
        let space = space(&arm(direction));
        for i in 0..12 {
            let angle = 0.3 + TAU * f64::from(i) / 12.0;
            let p = space.end_effector(&space.lift(&[], angle));
            let along = f64::from(direction) * Vector::from_polar(0.7, angle);
            assert!((p - along).norm() < 1e-12, "{direction}: {p} at {angle}");
            let set = space.reach(p).expect("within reach");
            assert_eq!(set.intervals.len(), 1);
            let off = (set.intervals[0][0] - angle).rem_euclid(TAU);
            assert!(off.min(TAU - off) < 1e-9, "{direction}: {set:?}, want {angle}");
        }
    }
}

/// The curve of two drives is as long as its chords add up to, however they are weighed: fine chords, and half as fine.
#[test]
fn the_curve_of_two_drives_is_as_long_as_its_chords() {
    let mut noise = Noise::of(61);
    for _ in 0..10 {
        let (_, space) = any_space(&mut noise, 2);
        let b = noise.between(-3.0, 3.0);
        let [low, high] = space.joints()[0].limits();
        let sum = |count: u32| {
            let at =
                |i: u32| space.end_effector(&space.lift(&[low + (high - low) * f64::from(i) / f64::from(count)], b));
            (0..count).map(|i| (at(i + 1) - at(i)).norm()).sum::<f64>()
        };
        // What chords leave out falls with the square of their length.
        let (coarse, fine) = (sum(4000), sum(8000));
        let length = fine + (fine - coarse) / 3.0;
        let found = space.outline(b).length;
        assert!((found - length).abs() < 1e-5 * length, "{found}, want {length}");
    }
}

/// Beside an angle that hardly turns the others still come to the middle of their limits, as near as they can.
#[test]
fn an_angle_that_hardly_turns_leaves_the_others_to_be_centred() {
    let mut noise = Noise::of(79);
    for n in [5, 6, 7] {
        for _ in 0..4 {
            let (machine, _) = any_space(&mut noise, n);
            let mut spec = machine.spec().clone();
            spec.angles[1].max = spec.angles[1].min.map(|min| min + 1e-5);
            let space = PoseSpace::general(&Machine::new(spec).expect("in range")).expect("it has a b");
            let b = noise.between(-3.0, 3.0);
            let from = space.clamped(&any_pose(&mut noise, &space));
            let p = space.end_effector(&space.lift(&from, b));
            let nearest = space.midrange_pose(p, b, &from);
            let far = |a: &PerDrive| {
                let share = |i: usize| {
                    let [low, high] = space.joints()[i].limits();
                    if high - low > 1e-3 { (a[i] - 0.5 * (low + high)) / (0.5 * (high - low)) } else { 0.0 }
                };
                (0..n - 1).map(|i| share(i).powi(2)).sum::<f64>()
            };
            assert!((space.end_effector(&space.lift(&nearest, b)) - p).norm() < 1e-8 * space.farthest());
            for _ in 0..20 {
                let size = 10.0_f64.powf(noise.between(-3.0, -1.0));
                let beside = PerDrive::from_fn(n - 1, |i| nearest[i] + size * noise.between(-1.0, 1.0));
                let (back, missed) = space.drag_to(p, b, &space.clamped(&beside));
                if missed < 1e-10 * space.farthest() {
                    let (own, other) = (far(&nearest), far(&back));
                    assert!(other > own - 1e-4, "{n} drives: {other} below {own}, step {size}");
                }
            }
        }
    }
}

/// The nearest of all poses at a point and b: no pose beside it that keeps both is nearer to the middle of the limits.
#[test]
fn nothing_beside_the_nearest_pose_is_nearer() {
    let mut noise = Noise::of(67);
    for n in [4, 5, 6] {
        for _ in 0..8 {
            let (_, space) = any_space(&mut noise, n);
            let b = noise.between(-3.0, 3.0);
            let from = any_pose(&mut noise, &space);
            let p = space.end_effector(&space.lift(&from, b));
            let nearest = space.midrange_pose(p, b, &from);
            let far = |a: &PerDrive| {
                let share = |i: usize| {
                    let [low, high] = space.joints()[i].limits();
                    (a[i] - 0.5 * (low + high)) / (0.5 * (high - low))
                };
                (0..n - 1).map(|i| share(i).powi(2)).sum::<f64>()
            };
            assert!((space.end_effector(&space.lift(&nearest, b)) - p).norm() < 1e-8 * space.farthest());
            assert!(far(&nearest) <= far(&from) + 1e-9);
            // Others: a step at random, led back onto the point with b held.
            for _ in 0..20 {
                let size = 10.0_f64.powf(noise.between(-5.0, -1.0));
                let beside = PerDrive::from_fn(n - 1, |i| nearest[i] + size * noise.between(-1.0, 1.0));
                let beside = space.clamped(&beside);
                let (back, missed) = space.drag_to(p, b, &beside);
                if missed < 1e-10 * space.farthest() {
                    let (own, other) = (far(&nearest), far(&back));
                    assert!(other > own - 1e-8, "{n} drives: {other} below {own}, step {size}");
                }
            }
        }
    }
}

/// A machine of a thousandth of the size has the same poses, as exact for its size.
#[test]
fn small_machines_are_as_exact_as_large_ones() {
    let mut noise = Noise::of(71);
    let n = 4;
    for scale in [1.0, 1e-3] {
        let (machine, _) = any_space(&mut noise, n);
        let mut spec = machine.spec().clone();
        for link in &mut spec.links {
            if let stillbase::mechanics::machine::Length::Metres(length) = &mut link.length {
                *length *= scale;
            }
            (link.com, link.com_normal) = (scale * link.com, scale * link.com_normal);
            link.inertia *= scale * scale;
        }
        spec.drives
            .iter_mut()
            .filter_map(|drive| drive.rotor.as_mut())
            .for_each(|rotor| rotor.inertia *= scale * scale);
        let space = space(&Machine::new(spec).expect("a machine"));
        let (mut worst, mut found) = (0.0_f64, 0);
        for _ in 0..30 {
            let (a, from) = (any_pose(&mut noise, &space), any_pose(&mut noise, &space));
            let b = noise.between(-3.0, 3.0);
            let p = space.end_effector(&space.lift(&a, b));
            for q in space.poses(p, b, &from) {
                worst = worst.max((space.end_effector(&q) - p).norm() / space.farthest());
                found += 1;
            }
            let (led, missed) = space.drag_to(p, b, &from);
            assert!(((space.end_effector(&space.lift(&led, b)) - p).norm() - missed).abs() < 1e-12 * space.farthest());
            if missed < 1e-6 * space.farthest() {
                worst = worst.max(missed / space.farthest());
            }
        }
        assert!(found >= 30 && worst < 1e-12, "{n} drives, {scale}: {worst:e} of {found}");
    }
}
