//! Tasks of two drives, and of four and more, that leave their b or have none: laws over machines of the gallery and at
//! random, and what is refused.

use stillbase::mechanics::dynamics::angular_momentum;
use stillbase::mechanics::kinematics::end_effector;
use stillbase::mechanics::machine::{Inertia, Machine, builtin};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};
use stillbase::planning::Motion;
use stillbase::planning::curves::Samples;
use stillbase::planning::following::Rule;
use stillbase::planning::following::nearest::{NoClosestMotion, NotMoved, nearest_b, same_tip};
use stillbase::planning::pose_space::PoseSpace;
use stillbase::session::scenario::{Scenario, TaskChange};
use stillbase::session::{Run, replay};

use crate::support::Noise;
use crate::support::random::{a_pose, a_space};

/// A scenario of a machine with a task as it stands in a file.
fn scenario(machine: &Machine, task: &str) -> Scenario {
    let base = Scenario::builtin("two-drive").expect("built in");
    let change: TaskChange = toml::from_str(task).expect("keys and values");
    let task = base.task.with_change(&change, machine).unwrap_or_else(|why| panic!("{why}: {task}"));
    Scenario { machine: machine.clone(), task, ..base }
}

fn run(machine: &Machine, task: &str) -> Run {
    Run::new(&scenario(machine, task)).unwrap_or_else(|why| panic!("{task}\n{why}"))
}

fn refused(machine: &Machine, task: &str) -> String {
    Run::new(&scenario(machine, task)).expect_err("it is refused").to_string()
}

fn point(key: &str, p: Vector) -> String {
    format!("{key} = [{}, {}]\n", p.re, p.im)
}

fn tip(machine: &Machine, q: &DriveAngles) -> Vector {
    end_effector(machine.end_effector(), &q.units())
}

/// Angular momentum at t, kg m²/s.
fn momentum(machine: &Machine, motion: &Motion, t: f64) -> f64 {
    let at = motion.at(t);
    angular_momentum(&Inertia::of(machine), &at.q.units(), &at.qd)
}

fn keeps_limits(machine: &Machine, q: &DriveAngles) -> bool {
    machine.angles().iter().all(|a| {
        let angle = q[a.to] - q[a.from] + a.offset;
        angle >= a.limits.start() - 1e-6 && angle <= a.limits.end() + 1e-6
    })
}

/// A machine with two poses within its limits, each with a b.
fn spaces() -> Vec<(Machine, PoseSpace)> {
    let gallery = ["two-drive", "four-drive"].map(|name| {
        let machine = builtin(name).expect("built in").clone();
        let space = PoseSpace::of(&machine).expect("balanced");
        (machine, space)
    });
    let mut noise = Noise::of(31);
    gallery.into_iter().chain([2, 2, 4, 4, 5, 6].map(|n| a_space(&mut noise, n))).collect()
}

/// From one b to another: the base feels −D₁ b̈, by momentum differentiated and by b differentiated.
#[test]
fn a_change_of_b_costs_what_it_says() {
    let mut noise = Noise::of(7);
    for (machine, space) in spaces() {
        let n = machine.drives();
        for _ in 0..3 {
            let b = [noise.between(-2.0, 2.0), noise.between(-2.0, 2.0)];
            let poses = b.map(|b| space.lift(&a_pose(&mut noise, &space), b));
            let [from, to] = poses.map(|q| space.end_effector(&q));
            let ends = point("from", from) + &point("to", to);
            let text = format!("kind = 'change-b'\n{ends}b = {:?}\nb_to = {:?}\ntime = 0.8\n", b[0], b[1]);
            let run = run(&machine, &text);
            let (motion, price) = (&run.plan().motion, run.plan().price.expect("it has a price"));
            let t = run.planned_time();
            let b_at = |t: f64| space.b(&motion.at(t).q);
            assert!((b_at(0.0) - b[0]).abs() < 1e-9 && (b_at(t) - b[1]).abs() < 1e-9, "{n} drives");
            assert!((price.delta_b() - (b[1] - b[0])).abs() < 1e-9 && price.inertia() == space.inertia());
            assert!((tip(&machine, &motion.at(0.0).q) - from).norm() < 1e-6 * space.farthest(), "{n} drives: A");
            assert!((tip(&machine, &motion.at(t).q) - to).norm() < 1e-6 * space.farthest(), "{n} drives: B");
            let h = 1e-4 * t;
            let mut most = 0.0_f64;
            for i in 1..40 {
                let at = t * f64::from(i) / 40.0;
                let felt = -(momentum(&machine, motion, at + h) - momentum(&machine, motion, at - h)) / (2.0 * h);
                let bdd = (b_at(at + h) - 2.0 * b_at(at) + b_at(at - h)) / (h * h);
                let scale = space.inertia() * (b[1] - b[0]).abs() / (t * t);
                assert!((felt + space.inertia() * bdd).abs() < 1e-4 * scale, "{n} drives: {felt} {bdd}");
                assert!(keeps_limits(&machine, &motion.at(at).q), "{n} drives");
                most = most.max(felt.abs());
            }
            // The quintic's greatest b̈ is 10/√3 of Δb/T².
            let peak = 10.0 / 3f64.sqrt() * space.inertia() * (b[1] - b[0]).abs() / (t * t);
            assert!((run.plan().forecast.moment - peak).abs() < 1e-3 * peak && most < 1.001 * peak);
            // Bounded, it takes as long as that wants.
            let bounded = self::run(&machine, &format!("{text}moment_limit = {:?}\n", 0.5 * peak));
            assert!(bounded.plan().forecast.moment < 0.5 * peak * 1.0001);
            assert!((bounded.planned_time() / t - 2f64.sqrt()).abs() < 1e-6, "T² goes with 1/n_B");
        }
    }
}

/// Limits are a box, so a straight line of joint space joins any two poses: no change between two b that reach their
/// points is refused, to a b that is given or to the nearest one.
fn changes_of_b(noise: &mut Noise, n: usize) {
    let (machine, space) = a_space(noise, n);
    let b = [noise.between(-5.0, 5.0), noise.between(-5.0, 5.0)];
    let [from, to] = b.map(|b| space.end_effector(&space.lift(&a_pose(noise, &space), b)));
    let ends = format!("kind = 'change-b'\n{}{}b = {:?}\n", point("from", from), point("to", to), b[0]);
    for text in [format!("{ends}b_to = {:?}\n", b[1]), ends] {
        let motion = run(&machine, &text).plan().motion.clone();
        assert!((0..=20).all(|i| keeps_limits(&machine, &motion.path.at(f64::from(i) / 20.0).q)), "{n} drives");
        assert!((space.b(&motion.path.at(0.0).q) - b[0]).abs() < 1e-9, "{n} drives");
    }
}

#[test]
fn no_change_of_b_between_two_poses_is_refused() {
    let mut noise = Noise::of(13);
    [4, 4, 4, 4, 5].into_iter().for_each(|n| changes_of_b(&mut noise, n));
}

#[test]
#[ignore = "minutes: 300 machines with four drives to six"]
fn no_change_of_b_of_hundreds_is_refused() {
    let mut noise = Noise::of(1300);
    (0..300).for_each(|i| changes_of_b(&mut noise, 4 + i % 3));
}

/// Without a b for B: the least change from where A is.
#[test]
fn the_least_change_is_found_and_simulated() {
    for (name, from, to, b) in
        [("two-drive", [0.45, 0.30], [0.60, 0.20], 0.0), ("four-drive", [0.60, 0.50], [-0.55, -0.25], 2.9)]
    {
        let machine = builtin(name).expect("built in");
        let space = PoseSpace::of(machine).expect("balanced");
        let [from, to] = [from, to].map(|[x, y]| Vector::new(x, y));
        let text = format!("kind = 'change-b'\n{}{}b = {b:?}\n", point("from", from), point("to", to));
        let scenario = scenario(machine, &text);
        let mut most = 0.0_f64;
        let run = replay(&scenario, |_, frame| {
            let bdd = space.lambda().dot(&frame.qdd);
            assert!((frame.base_moment() + space.inertia() * bdd).abs() < 1e-9);
            most = most.max(frame.base_moment().abs());
        });
        let run = run.expect("it runs");
        let price = run.plan().price.expect("a price");
        assert!(price.delta_b().abs() > 1e-3 && most > 0.9 * run.plan().forecast.moment, "{name}: {most}");
        assert!((run.frame().end_effector - to).norm() < 1e-5, "{name}");
        // No b of B is nearer to one of A's: the one of the task where that reaches A.
        let [a, z] = [from, to].map(|p| space.reach(p).expect("within reach"));
        let start = space.b(&run.plan().motion.at(0.0).q);
        assert!(a.contains(start) && (!a.contains(b) || (start - b).abs() < 1e-9));
        let nearest = z.nearest(start).expect("within reach") - start;
        assert!((nearest.abs() - price.delta_b().abs()).abs() < 1e-6, "{name}: {nearest} {}", price.delta_b());
        // As fast as a bound lets it: b is bang-bang.
        if name == "four-drive" {
            let fast = self::run(machine, &format!("{text}moment_limit = 1.0\nlaw = 'fastest'\n"));
            let least = 2.0 * (space.inertia() * fast.plan().price.expect("a price").delta_b().abs()).sqrt();
            assert!(fast.planned_time() > least - 1e-9 && fast.plan().forecast.moment < 1.0 + 1e-9);
        }
    }
}

#[test]
fn the_end_effector_goes_as_it_was_with_drive_1_elsewhere() {
    let mut noise = Noise::of(23);
    let mut done = 0;
    for (machine, space) in spaces().into_iter().filter(|(machine, _)| machine.drives() > 3) {
        for _ in 0..6 {
            // Near the middle, so that limits are not in the way.
            let b = noise.between(-2.0, 2.0);
            let middle = space.middle();
            let near = |noise: &mut Noise| {
                let a = a_pose(noise, &space);
                space.lift(&PerDrive::from_fn(a.len(), |i| middle[i] + 0.15 * (a[i] - middle[i])), b)
            };
            let [from, to] = [near(&mut noise), near(&mut noise)].map(|q| space.end_effector(&q));
            let ends = point("from", from) + &point("to", to);
            let line = self::run(&machine, &format!("kind = 'reactionless'\n{ends}b = {b:?}\n"));
            let start = line.plan().motion.at(0.0).q;
            let first_to = start[0] + 0.1;
            let text = format!("kind = 'same-tip'\n{ends}b = {b:?}\nfirst_drive_to = {first_to:?}\n");
            let Ok(other) = Run::new(&scenario(&machine, &text)) else { continue };
            done += 1;
            for i in 0..=50 {
                let s = f64::from(i) / 50.0;
                let [x, y] = [&line, &other].map(|run| run.plan().motion.path.at(s).q);
                assert!((tip(&machine, &x) - tip(&machine, &y)).norm() < 1e-9 * space.farthest(), "{s}");
                assert!((y[0] - start[0] - 0.1 * s).abs() < 1e-9, "drive 1 goes straight");
                assert!(keeps_limits(&machine, &y));
            }
            assert!(other.plan().forecast.moment > 1e-6, "it has left its b");
        }
    }
    assert!(done > 8, "{done} were done");
    let two =
        refused(builtin("two-drive").expect("built in"), "kind = 'same-tip'\nfrom = [0.5, 0.2]\nto = [0.6, 0.1]\n");
    assert!(two.contains("no course of its own: want minimum-norm"), "{two}");
}

/// Along any curve, whatever the mass matrix does.
#[test]
fn four_drives_and_more_follow_curves_at_zero_momentum() {
    let mut noise = Noise::of(5);
    let four = builtin("four-drive").expect("built in");
    let mut machines = vec![four.clone(), four.set("payload.mass", "0.5").expect("it carries")];
    for n in [4, 5, 6] {
        let (machine, _) = a_space(&mut noise, n);
        machines.push(machine.set("payload.mass", "0.4").expect("it carries"));
        machines.push(machine);
    }
    let mut done = 0;
    for (i, machine) in machines.iter().enumerate() {
        let (model, n) = (Inertia::of(machine), machine.drives());
        let space = PoseSpace::nominal(machine).expect("coordinates");
        let at = space.end_effector(&space.lift(&space.middle(), 0.4));
        let r = 0.03 * space.farthest();
        let way = [Vector::new(r, 0.4 * r), Vector::new(0.3 * r, r)].map(|off| at + off);
        let b = PoseSpace::of(machine).ok().and_then(|space| {
            let set = space.reach(at).ok()?;
            Some(set.moved_inside(set.nearest(space.b(&space.lift(&space.middle(), 0.4)))?, 0.3))
        });
        let text = format!(
            "kind = 'zero-momentum'\nshape = 'arc'\n{}via = [[{}, {}]]\n{}closed = true\ncycles = 3\nb = {:?}\n",
            point("from", at),
            way[0].re,
            way[0].im,
            point("to", way[1]),
            b.unwrap_or(0.4)
        );
        let Ok(run) = Run::new(&scenario(machine, &text)) else { continue };
        done += 1;
        let (motion, t) = (&run.plan().motion, run.planned_time());
        let speed = run.plan().forecast.speed.max_abs();
        for k in 0..=90 {
            let h = momentum(machine, motion, t * f64::from(k) / 90.0);
            assert!(h.abs() < 1e-7 * model.diagonals().iter().sum::<f64>() * speed, "{i}, {n} drives: {h}");
        }
        for k in 0..=3 {
            let off = (tip(machine, &motion.at(t * f64::from(k) / 3.0).q) - at).norm();
            assert!(off < 1e-9 * space.farthest(), "{i}: {off} m off A after {k} rounds");
        }
        assert_eq!(run.plan().cycles.len(), 4);
        // An arm that keeps b has come back to it; the others have no b that could.
        if let Ok(space) = PoseSpace::of(machine) {
            let kept = run
                .plan()
                .cycles
                .iter()
                .map(|q| space.b(q))
                .fold(0.0, |m: f64, b| m.max((b - space.b(&run.plan().cycles[0])).abs()));
            assert!(!model.is_invariant() || kept < 1e-8, "{kept}");
        }
        assert!(model.is_invariant() || run.plan().forecast.moment < 1e-3 * run.plan().forecast.torque.max_abs());
    }
    assert!(done >= 6, "{done} of {} were done", machines.len());
}

/// Two drives have one curve without momentum, also where nothing is balanced.
#[test]
fn two_drives_go_along_their_curve_without_momentum() {
    let scara = builtin("scara").expect("built in");
    let why = refused(scara, "kind = 'zero-momentum'\nfrom = [0.6, 0.1]\nto = [0.2, 0.55]\n");
    assert!(why.contains("B lies 0.413 m beside it: want it at (0.278797726, 0.144864307) m"), "{why}");
    let text = "kind = 'zero-momentum'\nfrom = [0.6, 0.1]\nto = [0.278797726, 0.144864307]\n";
    // What is said to do, does, and what it says is simulated.
    let done = replay(&scenario(scara, text), |_, frame| {
        assert!(frame.base_moment().abs() < 1e-5 * (1e-3 + frame.torque.max_abs()), "{}", frame.base_moment());
    });
    let done = done.expect("it runs");
    assert!((done.frame().end_effector - Vector::new(0.278797726, 0.144864307)).norm() < 1e-5);
    let motion = &done.plan().motion;
    assert!((0..=50).all(|i| momentum(scara, motion, f64::from(i) / 50.0).abs() < 1e-9));
    assert!(done.plan().forecast.torque.max_abs() > 0.1, "it moves");
    // There and back again, and again.
    let round = run(scara, &format!("{text}closed = true\ncycles = 2\n"));
    assert!(round.plan().drift().all(|drift| drift < 1e-12));
    let why = refused(scara, &format!("{text}shape = 'line'\n"));
    assert!(why.contains("want the shape joint-line"), "{why}");
    // Where every motion is reactionless any line is.
    let free = builtin("counter-rotating").expect("built in");
    let line = run(free, "kind = 'zero-momentum'\nfrom = [0.55, 0.2]\nto = [0.25, 0.5]\n");
    assert!((tip(free, &line.plan().motion.path.at(0.5).q) - Vector::new(0.4, 0.35)).norm() < 1e-9);
    assert!(line.plan().forecast.moment < 1e-9);
    let why = refused(free, "kind = 'change-b'\nfrom = [0.55, 0.2]\nto = [0.25, 0.5]\n");
    assert!(why.contains("want reactionless or minimum-norm"), "{why}");
}

/// The least reaction is none where b can be held; else it is refused with a way that goes.
#[test]
fn the_least_reaction_of_other_drives_holds_b_or_says_what_would_do() {
    let four = builtin("four-drive").expect("built in");
    let ends = "from = [0.60, 0.50]\nto = [0.35, 0.85]\n";
    let held = run(four, &format!("kind = 'least-reaction'\n{ends}b = 2.9\n"));
    let verdicts = held.plan().verdicts.as_ref().expect("verdicts");
    assert!(held.plan().forecast.moment < 1e-5 && verdicts.least.peak == 0.0);
    let usual = run(four, &format!("kind = 'minimum-norm'\n{ends}b = 2.9\n"));
    let norm = verdicts.minimum_norm.as_ref().expect("the usual inverse");
    assert!((norm.reaction.peak - usual.plan().forecast.moment).abs() < 1e-9 && norm.reaction.peak > 0.1);
    // Between the points the path leaves what this b reaches.
    let ends = "from = [0.6, 0.5]\nto = [-0.4, 0.5]\n";
    let why = refused(four, &format!("kind = 'least-reaction'\n{ends}b = 2.9\n"));
    let b = why.split("; at b = ").nth(1).and_then(|rest| rest.split(' ').next()).expect("a b is named");
    assert!(
        why.contains("m is outside the reactionless workspace of b = 2.900000 rad), and with other than three drives")
            && why.contains("want that"),
        "{why}"
    );
    run(four, &format!("kind = 'least-reaction'\n{ends}b = {b}\n"));
    let why = refused(four, &format!("kind = 'least-reaction'\n{ends}b = {b}\nb_to = 2.0\n"));
    assert!(why.contains("want change-b"), "{why}");
    let two = refused(builtin("two-drive").expect("built in"), &format!("kind = 'least-reaction'\n{ends}"));
    assert!(two.contains("no b to choose: want minimum-norm"), "{two}");
}

/// Samples of the end effector are followed with b held, in every posture, or by least rates.
#[test]
fn samples_of_the_end_effector_are_followed() {
    let four = builtin("four-drive").expect("built in");
    let space = PoseSpace::of(four).expect("balanced");
    let place = |s: f64| {
        let u = s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
        [0.60 - 0.25 * u, 0.50 + 0.35 * u]
    };
    let rows: Vec<String> = (0..=40)
        .map(|i| {
            let (s, [x, y]) = (f64::from(i) / 40.0, place(f64::from(i) / 40.0));
            format!("[{s}, {x:?}, {y:?}]")
        })
        .collect();
    let rows = rows.join(", ");
    for (kind, posture) in [
        ("given", "least-rates"),
        ("reactionless", "orientation"),
        ("given", "mid-range"),
        ("given", "least-torque"),
        ("minimum-norm", "least-rates"),
    ] {
        let text = format!(
            "kind = '{kind}'\nsamples = [{rows}]\nb = 2.9\nposture = '{posture}'\nfrom = [0.6, 0.5]\nto = [0.35, 0.85]\ntime = 1.0"
        );
        let run = run(four, &text);
        for i in 0..=40 {
            let s = f64::from(i) / 40.0;
            let (q, [x, y]) = (run.plan().motion.at(s).q, place(s));
            assert!((tip(four, &q) - Vector::new(x, y)).norm() < 1e-9, "{kind}, {posture}");
            assert!(kind == "minimum-norm" || (space.b(&q) - 2.9).abs() < 1e-9, "{kind}, {posture}");
        }
        let ends = [0.0, 1.0].map(|s| run.plan().motion.at(s).q[3]);
        assert!(posture != "orientation" || (ends[1] - ends[0]).abs() < 1e-9);
        assert_eq!(run.plan().forecast.moment < 1e-5, kind != "minimum-norm", "{kind}, {posture}");
    }
    let two = builtin("two-drive").expect("built in");
    let why = refused(two, &format!("kind = 'reactionless'\nsamples = [{rows}]\nfrom = [0.6, 0.5]\nto = [0.4, 0.5]"));
    assert!(why.contains("want minimum-norm, or samples of the drive angles"), "{why}");
}

/// The same end effector at a b: no pose with both is closer, and the b that is chosen is the closest of all.
#[test]
fn the_closest_motion_of_a_b_is_found() {
    let mut noise = Noise::of(3);
    let mut moved_some = 0;
    for (machine, space) in spaces().into_iter().filter(|(machine, _)| machine.drives() > 3) {
        let (model, n) = (Inertia::of(&machine), machine.drives());
        let (middle, a) = (space.middle(), a_pose(&mut noise, &space));
        let pose = |s: f64| {
            let a = PerDrive::from_fn(a.len(), |i| middle[i] + 0.2 * s * (a[i] - middle[i]));
            space.lift(&a, 1.0 + 0.05 * s)
        };
        let rows: Vec<Vec<f64>> = (0..=24)
            .map(|i| {
                let s = f64::from(i) / 24.0;
                [&[s], &pose(s * s * (3.0 - 2.0 * s))[..]].concat()
            })
            .collect();
        let samples = Samples::new(&rows).expect("samples");
        let far = |x: &[f64], y: &[f64]| -> f64 {
            x.iter().zip(y).enumerate().map(|(k, (x, y))| model.diagonal(k) * (x - y) * (x - y)).sum()
        };
        let Ok(Some(moved)) = same_tip(&space, &model, &samples, 1.02, Rule::default()) else { continue };
        moved_some += 1;
        for i in 0..samples.count() {
            let (given, own) = (samples.values(i), moved.values(i));
            assert!(
                (space.end_effector(given) - space.end_effector(own)).norm() < 1e-9 * space.farthest(),
                "{n} drives"
            );
            assert!((space.b(own) - 1.02).abs() < 1e-9);
            // Poses beside it with the same point and b are no closer.
            let from = space.angles(own);
            for _ in 0..4 {
                let beside = PerDrive::from_fn(from.len(), |k| from[k] + noise.between(-0.02, 0.02));
                let (a, off) = space.drag_to(space.end_effector(own), 1.02, &beside);
                if off < 1e-10 * space.farthest() {
                    let other = space.lift(&a, 1.02);
                    assert!(far(given, own) <= far(given, &other) + 1e-9, "{n} drives");
                }
            }
        }
        let (b, least) = nearest_b(&space, &model, &samples, Rule::default(), &mut |_| true).expect("some b does");
        for other in [b - 0.01, b + 0.01, 1.0, 1.05] {
            let Ok(Some(other)) = same_tip(&space, &model, &samples, other, Rule::default()) else { continue };
            let whole: f64 = model.diagonals().iter().sum();
            let mean: f64 = (0..24)
                .map(|i| {
                    0.5 * (far(samples.values(i), other.values(i)) + far(samples.values(i + 1), other.values(i + 1)))
                })
                .sum::<f64>()
                / 24.0;
            assert!(least <= (mean / whole).sqrt() + 1e-6, "{n} drives: {least} {}", (mean / whole).sqrt());
        }
        assert!(matches!(
            same_tip(&space, &model, &samples, 60.0, Rule::default()),
            Err(NotMoved::NoneClose(NoClosestMotion::Pose { .. } | NoClosestMotion::Limit { .. }))
        ));
    }
    assert!(moved_some >= 3, "{moved_some}");
}

/// The last link points where it is told to, all along a curve or a joint line; where it cannot, it is said where it
/// can.
#[test]
fn the_last_link_points_where_it_is_told() {
    let four = builtin("four-drive").expect("built in");
    let space = PoseSpace::of(four).expect("balanced");
    let ends = "kind = 'reactionless'\nfrom = [0.60, 0.50]\nto = [0.35, 0.85]\nb = 2.9\n";
    let points_to = |q: &DriveAngles| q[3] + std::f64::consts::PI;
    let free = run(four, &format!("{ends}shape = 'line'\nposture = 'orientation'\n"));
    let own = points_to(&free.plan().motion.path.at(0.0).q);
    let mut done = 0;
    for way in ["shape = 'line'\nposture = 'orientation'\n", "shape = 'joint-line'\n"] {
        for turn in [-0.3, -0.1, 0.05, 0.2] {
            let angle = own + turn + std::f64::consts::TAU;
            let Ok(run) = Run::new(&scenario(four, &format!("{ends}{way}orientation = {angle:?}\n"))) else { continue };
            done += 1;
            for i in 0..=50 {
                let q = run.plan().motion.path.at(f64::from(i) / 50.0).q;
                let off = points_to(&q) - angle;
                assert!(
                    (off - std::f64::consts::TAU * (off / std::f64::consts::TAU).round()).abs() < 1e-9,
                    "{way}: {off}"
                );
                assert!((space.b(&q) - 2.9).abs() < 1e-9 && keeps_limits(four, &q), "{way}");
            }
            let [a, b] = [0.0, 1.0].map(|s| tip(four, &run.plan().motion.path.at(s).q));
            assert!((a - Vector::new(0.6, 0.5)).norm() < 1e-9 && (b - Vector::new(0.35, 0.85)).norm() < 1e-9);
            assert!(run.plan().forecast.moment < 1e-5);
        }
    }
    assert!(done >= 4, "{done}");
    let why = refused(four, &format!("{ends}posture = 'orientation'\nshape = 'line'\norientation = {:?}\n", own + 2.5));
    assert!(why.contains("has the last link point to") && why.contains("want it from"), "{why}");
    // What it is said to be, does, at A.
    let words: Vec<&str> = why.split("want it from ").nth(1).expect("a range").split(' ').collect();
    let [low, high] = [words[0], words[2]].map(|word| word.parse::<f64>().expect("a number"));
    for angle in [low, 0.5 * (low + high), high] {
        let poses =
            space.poses_with_drive_angle(Vector::new(0.6, 0.5), 2.9, 3, angle - std::f64::consts::PI, &space.middle());
        assert!(!poses.is_empty(), "{angle} of {low} to {high}");
    }
    // Random machines: every pose that is given is one.
    let mut noise = Noise::of(41);
    for n in [4, 4, 5, 5, 6] {
        let (_, space) = a_space(&mut noise, n);
        for _ in 0..5 {
            let q = space.lift(&a_pose(&mut noise, &space), noise.between(-3.0, 3.0));
            let (p, b) = (space.end_effector(&q), space.b(&q));
            let found = space.poses_with_drive_angle(p, b, n - 1, q[n - 1] + std::f64::consts::TAU, &space.angles(&q));
            assert!(n > 4 || !found.is_empty(), "the pose it was made of");
            // The nearest first, whatever they are to be near to.
            for near in [space.angles(&q), a_pose(&mut noise, &space), a_pose(&mut noise, &space)] {
                let far = |other: &DriveAngles| space.angles(other).minus(&near).iter().map(|x| x * x).sum::<f64>();
                let found = space.poses_with_drive_angle(p, b, n - 1, q[n - 1], &near);
                assert!(found.windows(2).all(|pair| far(&pair[0]) <= far(&pair[1]) + 1e-9), "{n} drives");
            }
            for other in found {
                assert!(
                    (space.end_effector(&other) - p).norm() < 1e-6 * space.farthest()
                        && (space.b(&other) - b).abs() < 1e-9
                );
                assert!(
                    ((other[n - 1] - q[n - 1]) / std::f64::consts::TAU)
                        .fract()
                        .abs()
                        .min(1.0 - ((other[n - 1] - q[n - 1]) / std::f64::consts::TAU).fract().abs())
                        < 1e-9
                );
                for (joint, a) in space.joints().iter().zip(space.angles(&other).iter()) {
                    assert!(*a >= joint.limits()[0] - 1e-8 && *a <= joint.limits()[1] + 1e-8);
                }
            }
        }
    }
}
