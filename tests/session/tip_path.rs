//! Paths of the last platform in space: against central differences of the assembly's own places, and with proposals typed
//! back.

use nalgebra::{DMatrix, DVector, Vector3};
use stillbase::mechanics::assembly::{Assembly, BlockState, MAX_BLOCKS, builtin_assemblies};
use stillbase::mechanics::planar::{DriveAngles, PerDrive};
use stillbase::session::assembly::{AssemblyFrame, AssemblyScenario};
use stillbase::session::{Edit, Session};

fn builtin(name: &str) -> Assembly {
    builtin_assemblies().iter().find(|own| own.name == name).expect("built in").clone()
}

fn scenario(assembly: &Assembly, tip: &str) -> Result<AssemblyScenario, String> {
    let text = format!("machine = \"{}\"\n[tip]\n{tip}", assembly.name);
    AssemblyScenario::parse(&text, "tip.toml", assembly.clone()).map_err(|why| why.to_string())
}

fn frames(scenario: &AssemblyScenario) -> Vec<AssemblyFrame> {
    let mut all = Vec::new();
    let see = |frame: &AssemblyFrame| {
        all.push(frame.clone());
        true
    };
    let verdict = scenario.run(see).expect("a run");
    assert_eq!(verdict.silent(), [true; 6], "{verdict:?}");
    all
}

fn tip(assembly: &Assembly, block: usize, q: &[Vec<f64>]) -> Vector3<f64> {
    let none = PerDrive::zeros(0);
    let mut states = [BlockState { q: DriveAngles(none), qd: none, qdd: none }; MAX_BLOCKS];
    for (state, q) in states.iter_mut().zip(q) {
        let still = PerDrive::zeros(q.len());
        *state = BlockState { q: DriveAngles(PerDrive::from_fn(q.len(), |k| q[k])), qd: still, qdd: still };
    }
    assembly.end_effectors(&states)[block]
}

/// Directions of all drives that change no b, of unit length and at right angles, as columns.
fn holding_b(assembly: &Assembly) -> DMatrix<f64> {
    let count: usize = assembly.blocks().iter().map(|block| block.machine.drives()).sum();
    let mut rows = DMatrix::zeros(assembly.blocks().len(), count);
    let mut at = 0;
    for (i, block) in assembly.blocks().iter().enumerate() {
        for (k, lambda) in assembly.conditions(i).inertia.lambda().iter().enumerate() {
            rows[(i, at + k)] = *lambda;
        }
        at += block.machine.drives();
    }
    null_space(&rows)
}

/// Returns a basis of what a matrix takes to zero, of unit length and at right angles.
fn null_space(of: &DMatrix<f64>) -> DMatrix<f64> {
    let square = of.transpose() * of;
    let eigen = square.symmetric_eigen();
    let most = eigen.eigenvalues.max();
    let columns: Vec<_> = (0..of.ncols()).filter(|k| eigen.eigenvalues[*k] < 1e-9 * most).collect();
    DMatrix::from_fn(of.ncols(), columns.len(), |row, k| eigen.eigenvectors[(row, columns[k])])
}

fn angles(assembly: &Assembly, frame: &AssemblyFrame) -> Vec<Vec<f64>> {
    frame.states[..assembly.blocks().len()].iter().map(|state| state.q.0.to_vec()).collect()
}

/// J of all drives, by central differences.
fn jacobian(assembly: &Assembly, block: usize, q: &[Vec<f64>]) -> DMatrix<f64> {
    let mut columns = Vec::new();
    for i in 0..q.len() {
        for k in 0..q[i].len() {
            let moved = |by: f64| {
                let mut other = q.to_vec();
                other[i][k] += by;
                tip(assembly, block, &other)
            };
            columns.push((moved(1e-5) - moved(-1e-5)) / 2e-5);
        }
    }
    DMatrix::from_fn(3, columns.len(), |row, k| columns[k][row])
}

const CASES: [(&str, &str); 4] = [
    ("carrier-and-arm", "to = [0.45, 0.55, 0.1]\ntime = 1.2\n"),
    ("carrier-and-arm", "from = [0.45, 0.35, 0.09]\nto = [0.52, 0.42, 0.06]\nvia = [[0.40, 0.52, 0.14]]\ntime = 2.0\n"),
    ("carrier-and-arm", "to = [0.40, 0.45, 0.08]\nlaw = \"septic\"\ntime = 1.0\n"),
    ("carrier-and-wrist", "to = [0.42, 0.45, 0.1]\ntime = 1.0\n"),
];

/// The end effector keeps to its straight way and its law, every block its b, and nothing reaches the base.
#[test]
fn the_end_effector_goes_straight_and_every_b_is_held() {
    for (name, text) in CASES {
        let assembly = builtin(name);
        for choice in ["least-rates", "mid-range"] {
            let scenario = scenario(&assembly, &format!("{text}choice = \"{choice}\"\n")).expect(text);
            let all = frames(&scenario);
            let block = scenario.tip.as_ref().expect("a path").blocks.last().copied().expect("a block");
            let path = &scenario.tip.as_ref().expect("a path").path;
            let mut points = vec![all[0].tips[block]];
            points.extend(path.via.iter().map(|p| Vector3::from(*p)));
            points.push(path.to.map(Vector3::from).expect("an end"));
            for frame in &all {
                let p = frame.tips[block];
                let off = |pair: &[Vector3<f64>]| {
                    let way = pair[1] - pair[0];
                    let share = ((p - pair[0]).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
                    (p - pair[0] - share * way).norm()
                };
                let off = points.windows(2).map(off).fold(f64::INFINITY, f64::min);
                assert!(off < 1e-6, "{name} {choice}: {off} m off at {} s", frame.time);
            }
            let end = all.last().expect("a frame");
            assert!((end.tips[block] - points[points.len() - 1]).norm() < 1e-6, "{name}: {}", end.tips[block]);
            let b = |frame: &AssemblyFrame, i: usize| assembly.conditions(i).inertia.lambda().dot(&frame.states[i].q);
            for i in 0..assembly.blocks().len() {
                let most = all.iter().map(|frame| (b(frame, i) - b(&all[0], i)).abs()).fold(0.0, f64::max);
                assert!(most < 1e-9, "{name}: b of block {i} changes by {most}");
            }
            // What is written gives the same motion.
            let again = AssemblyScenario::parse(&scenario.to_toml(), "again.toml", assembly.clone()).expect("valid");
            assert_eq!(again.tasks, scenario.tasks);
        }
    }
}

/// The rates have no part in the directions that move neither the end effector nor a b.
#[test]
fn rates_are_the_least() {
    let mut seen = 0;
    for (name, text) in CASES {
        let assembly = builtin(name);
        let scenario = scenario(&assembly, text).expect(text);
        let block = assembly.blocks().len() - 1;
        let held = holding_b(&assembly);
        for frame in frames(&scenario).iter().step_by(37) {
            let q = angles(&assembly, frame);
            let rates: Vec<f64> =
                frame.states[..q.len()].iter().flat_map(|state| state.qd.iter().copied().collect::<Vec<_>>()).collect();
            let rates = DVector::from_vec(rates);
            let free = &held * null_space(&(jacobian(&assembly, block, &q) * &held));
            let idle = (free.transpose() * &rates).norm();
            assert!(idle <= 1e-4 * rates.norm() + 1e-6, "{name} at {} s: {idle} of {}", frame.time, rates.norm());
            seen += free.ncols();
        }
    }
    assert!(seen > 100, "{seen}");
}

/// While the arm alone can follow, what carries it stands still; and not with another choice.
#[test]
fn a_carrier_stands_still_where_it_can() {
    let assembly = builtin("carrier-and-arm");
    let way = "from = [0.4337, 0.3873, 0.0971]\nto = [0.4237, 0.3873, 0.0871]\ntime = 1.0\n";
    for (choice, stands) in [("still-carrier", true), ("least-rates", false)] {
        let all = frames(&scenario(&assembly, &format!("{way}choice = \"{choice}\"\n")).expect("a path"));
        let moved =
            (0..3).map(|k| (all[all.len() / 2].states[0].q[k] - all[0].states[0].q[k]).abs()).fold(0.0, f64::max);
        assert_eq!(moved < 1e-9, stands, "{choice}: {moved} rad");
    }
}

/// Whether a carrier that stands still where it can leads the end effector does not depend on how fast it goes.
#[test]
fn a_still_carrier_takes_over_with_every_law() {
    let assembly = builtin("carrier-and-arm");
    for to in ["0.4, 0.52, 0.14", "0.45, 0.45, 0.09", "0.52, 0.42, 0.06"] {
        for law in ["quintic", "septic", "fastest"] {
            let text = format!("from = [0.45, 0.35, 0.09]\nto = [{to}]\nlaw = \"{law}\"\nchoice = \"still-carrier\"\n");
            let all = frames(&scenario(&assembly, &text).unwrap_or_else(|why| panic!("{to} {law}: {why}")));
            let end = all.last().expect("a frame").tips[1];
            let wanted: Vec<f64> = to.split(", ").map(|x| x.parse().expect("a number")).collect();
            assert!((end - Vector3::from_column_slice(&wanted)).norm() < 1e-6, "{to} {law}: {end}");
        }
    }
}

/// A closed way brings mid-range angles back, and they are nearest to the middles of their ranges all along.
#[test]
fn mid_range_comes_back() {
    let assembly = builtin("carrier-and-arm");
    let text =
        "from = [0.45, 0.35, 0.09]\nto = [0.52, 0.42, 0.06]\nvia = [[0.40, 0.52, 0.14]]\nclosed = true\ntime = 3.0\n";
    let held = holding_b(&assembly);
    for (choice, comes_back) in [("mid-range", true), ("least-rates", false)] {
        let all = frames(&scenario(&assembly, &format!("{text}choice = \"{choice}\"\n")).expect("a path"));
        let (first, last) = (angles(&assembly, &all[0]).concat(), angles(&assembly, &all[all.len() - 1]).concat());
        let off = first.iter().zip(&last).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert_eq!(off < 1e-6, comes_back, "{choice}: {off} rad");
        if !comes_back {
            continue;
        }
        for frame in all.iter().step_by(61) {
            let q = angles(&assembly, frame);
            let free = &held * null_space(&(jacobian(&assembly, 1, &q) * &held));
            // Σ ((a − m)/h)² does not change along what is free.
            let measure = |by: f64| -> f64 {
                let mut sum = 0.0;
                for (i, (block, own)) in assembly.blocks().iter().zip(&q).enumerate() {
                    let moved: Vec<f64> = (0..own.len()).map(|k| own[k] + by * free[(3 * i + k, 0)]).collect();
                    for angle in block.machine.angles() {
                        let a = angle.value(&moved);
                        let (low, high) = (angle.limits.start(), angle.limits.end());
                        sum += ((a - 0.5 * (low + high)) / (0.5 * (high - low))).powi(2);
                    }
                }
                sum
            };
            let slope = (measure(1e-5) - measure(-1e-5)) / 2e-5;
            assert!(slope.abs() < 1e-5, "{slope} at {} s", frame.time);
            assert!(measure(1e-2) > measure(0.0) && measure(-1e-2) > measure(0.0));
        }
    }
}

/// Without a time, the drive that is asked most is just at its limit.
#[test]
fn the_least_time_keeps_all_limits() {
    for text in ["to = [0.45, 0.55, 0.1]\n", "from = [0.45, 0.35, 0.09]\nto = [0.52, 0.42, 0.06]\n"] {
        let assembly = builtin("carrier-and-arm");
        let all = frames(&scenario(&assembly, text).expect(text));
        let mut most = 0.0_f64;
        for frame in &all {
            for (k, drive) in assembly.blocks()[0].machine.spec().drives.iter().enumerate() {
                most = most.max(frame.torques[0][k].abs() / drive.torque_limit.expect("a limit"));
            }
        }
        assert!((0.99..1.001).contains(&most), "{most}");
    }
    let why = scenario(&builtin("two-arms"), "to = [0.6, 0.4, 0.0]\nblock = \"nobody\"\n").expect_err("no block");
    assert!(why.contains("(tip.block) names no block \"nobody\": want one of"), "{why}");
}

/// With the fastest law some drive is near its limit nearly all the time, none passes it, the way is straight, and every
/// leg takes less time than with another law.
#[test]
fn the_fastest_law_uses_the_limits_all_the_way() {
    let assembly = builtin("carrier-and-arm");
    for text in [
        "to = [0.45, 0.55, 0.1]\n",
        "from = [0.45, 0.35, 0.09]\nvia = [[0.40, 0.52, 0.14]]\nto = [0.52, 0.42, 0.06]\nclosed = true\n",
    ] {
        for choice in ["least-rates", "mid-range"] {
            let of = |law: &str| {
                let text = format!("{text}choice = \"{choice}\"\nlaw = \"{law}\"\n");
                scenario(&assembly, &text).unwrap_or_else(|why| panic!("{text}{why}"))
            };
            let (fastest, quintic) = (of("fastest"), of("quintic"));
            let all = frames(&fastest);
            let path = &fastest.tip.as_ref().expect("a path").points;
            let points: Vec<Vector3<f64>> = path.iter().map(|p| Vector3::from(*p)).collect();
            let mut usage = Vec::new();
            for frame in &all {
                let p = frame.tips[1];
                let off = points.windows(2).map(|pair| {
                    let way = pair[1] - pair[0];
                    let share = ((p - pair[0]).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
                    (p - pair[0] - share * way).norm()
                });
                let off = off.fold(f64::INFINITY, f64::min);
                assert!(off < 1e-6, "{choice}: {off} m off at {} s", frame.time);
                let mut most = 0.0_f64;
                for (block, torques) in assembly.blocks().iter().zip(&frame.torques) {
                    for (drive, torque) in block.machine.spec().drives.iter().zip(torques.iter()) {
                        most = most.max(drive.torque_limit.map_or(0.0, |limit| torque.abs() / limit));
                    }
                }
                usage.push(most);
            }
            let greatest = usage.iter().copied().fold(0.0, f64::max);
            assert!((0.97..1.002).contains(&greatest), "{choice}: {greatest}");
            let near = usage.iter().filter(|most| **most > 0.9).count() as f64 / usage.len() as f64;
            assert!(near > 0.85, "{choice}: near a limit for {near} of the time");
            let lasts = |of: &AssemblyScenario| of.tasks[1].scenario.task.samples.as_ref().expect("samples").duration();
            let [short, long] = [&fastest, &quintic].map(lasts);
            assert!(short < 0.9 * long, "{choice}: {short} s and {long} s");
        }
    }
}

/// What is refused says what would do, and that does.
#[test]
fn proposals_work_as_printed() {
    let assembly = builtin("carrier-and-arm");
    let refused = |text: &str| scenario(&assembly, text).expect_err(text);
    for text in [
        "to = [0.45, 0.55, 0.9]\n",
        "to = [0.45, 5.0, 0.1]\n",
        "to = [-3.0, 0.1, -2.0]\n",
        "from = [9.0, 0.0, 0.0]\nto = [0.45, 0.55, 0.1]\n",
    ] {
        let why = refused(text);
        let key = if why.contains("tip.from") { "from" } else { "to" };
        let proposed = why.rsplit_once("as [").and_then(|(_, rest)| rest.split_once(']')).expect(&why).0;
        let kept: Vec<&str> = text.lines().filter(|line| !line.starts_with(key)).collect();
        let mended = format!("{}\n{key} = [{proposed}]\n", kept.join("\n"));
        match scenario(&assembly, &mended) {
            Ok(_) => {}
            // A begin is proposed by itself: the way from there is another question.
            Err(why) => assert!(key == "from" && !why.contains("is not reached at these b"), "{mended}{why}"),
        }
    }
    let way = "to = [0.7, 0.3, 0.0]\ntime = 1.0\n";
    let why = refused(&format!("{way}choice = \"still-carrier\"\n"));
    let choice = why.rsplit_once("want choice = ").expect(&why).1;
    scenario(&assembly, &format!("{way}choice = {choice}\n")).expect("as proposed");
    for (text, words) in [
        ("time = 1.0\n", "(tip.to): want a place"),
        ("to = [0.4, 0.4]\n", "(tip.to) has 2 values instead of 3: want three numbers"),
        ("to = [0.45, 0.55, nan]\n", "(tip.to) is not a number: want -1000000 to 1000000 m"),
        ("to = [0.45, 0.55, 0.1]\ntime = -1.0\n", "(tip.time) is -1: want 0.001 to 3600 s"),
        (
            "to = [0.45, 0.55, 0.1]\nlaw = \"trapezoidal\"\n",
            "(tip.law) is \"trapezoidal\": want one of quintic, septic, fastest",
        ),
        (
            "to = [0.45, 0.55, 0.1]\nb = { arm = nan }\n",
            "b of block arm on the path (tip.b.arm) is not a number: want -1000 to 1000 rad",
        ),
        (
            "to = [0.45, 0.55, 0.1]\nb = { leg = 1.0 }\n",
            "table of b on the path has no key \"leg\": want one of carrier, arm",
        ),
        (
            "to = [0.45, 0.55, 0.1]\n[task.arm]\nkind = \"reactionless\"\n",
            "task of block arm (task.arm) is that of a block which [tip] leads",
        ),
    ] {
        let why = refused(text);
        assert!(why.contains(words), "{text}{why}");
    }
}

/// Led in space by hand, the end effector comes to the place, nothing reaches the base, and the session is the same when it
/// is saved, opened and led from the other block.
#[test]
fn an_end_effector_is_led_in_space_by_hand() {
    let whole = scenario(&builtin("carrier-and-arm"), "to = [0.45, 0.42, 0.1]\ntime = 1.0\n").expect("a path");
    let mut session = Session::open(whole.leading(1)).expect("it opens");
    session.seek(session.length());
    for place in [[0.40, 0.50, 0.12], [0.47, 0.38, 0.07]] {
        let edit = session.edit_on_base(place).expect("a way");
        assert!(matches!(&edit, Edit::DragBlocks { targets } if targets.len() == 2), "{edit:?}");
        let undone = session.run().inverse_of(&edit).expect("an inverse");
        assert!(matches!(undone, Edit::DragBlocks { .. }));
        session.apply(edit).expect("led by hand");
        session.play();
        session.tick(4000);
        let tip = Vector3::from(session.tip_on_base().expect("a tip"));
        assert!((tip - Vector3::from(place)).norm() < 1e-5, "{tip} {place:?}");
    }
    assert_eq!(session.frame().shared.expect("shared").silent(), [true; 6]);
    // From one step to the next the tip moves in the plane that is dragged in, and the carrier goes along.
    let at = session.frame().end_effector;
    let edit = session.edit_in_space([at.re, at.im, 0.02]).expect("a way");
    let before = Vector3::from(session.tip_on_base().expect("a tip"));
    session.apply(edit).expect("led by hand");
    session.tick(4000);
    let way = Vector3::from(session.tip_on_base().expect("a tip")) - before;
    assert!((way - Vector3::new(0.0, 0.02, 0.0)).norm() < 1e-5, "{way}");
    let text = session.to_scenario().to_toml();
    assert!(!text.contains("drag-blocks"), "each block has its part");
    let saved = AssemblyScenario::parse(&text, "saved.toml", builtin("carrier-and-arm")).expect("it is read");
    for led in [0, 1] {
        let mut again = Session::open(saved.leading(led)).expect("it opens");
        again.seek(session.frame().time);
        let (one, two) = (again.frame().shared.expect("shared"), session.frame().shared.expect("shared"));
        for (a, b) in one.loads.motion.components().iter().zip(two.loads.motion.components()) {
            assert!((a - b).abs() < 1e-9);
        }
        assert!((Vector3::from(again.run().shared().expect("shared").now().tips[1]) - before - way).norm() < 1e-9);
    }
    // Out of reach it comes as far as the way leads.
    let edit = session.edit_on_base([3.0, 3.0, 3.0]).expect("a way");
    session.apply(edit).expect("led by hand");
    session.tick(4000);
    assert!(session.frame().is_finite());
    let wrong = Edit::DragBlocks { targets: [("leg".to_owned(), [0.1, 0.2])].into() };
    let why = session.apply(wrong).expect_err("no block").to_string();
    assert!(why.contains("names no block") && why.contains("want one of carrier, arm"), "{why}");
    // A block on the base carries itself.
    let first = Session::open(whole.leading(0)).expect("it opens");
    assert_eq!(first.edit_on_base([0.4, 0.4, 0.1]), None);
}
