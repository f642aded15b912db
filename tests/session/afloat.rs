//! Arms on free bases led at zero momentum: their bases keep their orientation, and the end effector arrives.

use std::f64::consts::{FRAC_PI_2, PI};

use stillbase::mechanics::planar::Vector;
use stillbase::session::scenario::Scenario;
use stillbase::session::verdict::Verdict;
use stillbase::session::{Refusal, Run, replay};
use stillbase::simulation::frame::Frame;
use toml::Table;

/// The arm on an air bearing with another task.
fn spot(task: &str) -> Scenario {
    let base = "[base]\nkind = 'free'\nmass = 11.211\ninertia = 0.20215\n\
                com = [-0.0680112181717378, -0.24212956077851439]\n";
    Scenario::parse(&format!("machine = 'spot'\n[task]\n{task}\n{base}"), "spot", None).expect("valid")
}

/// The last frame, and the largest angle of the base on the way, rad.
fn run(scenario: &Scenario) -> (Frame, f64) {
    let mut turned = 0.0_f64;
    let run = replay(scenario, |_, frame| turned = turned.max(frame.base.angle.abs())).expect("it runs");
    (run.frame(), turned)
}

fn away(frame: &Frame, x: f64, y: f64) -> f64 {
    (frame.end_effector - Vector::new(x, y)).norm()
}

/// Lines as seen from the base pin end at the angles of an independent integration, lines in space where they should.
#[test]
fn the_base_of_a_real_arm_keeps_its_orientation() {
    let line = "kind = 'zero-momentum'\nshape = 'line'\ntime = 10.0";
    let seen = [
        (
            "[1.9, 2.6, 3.4]",
            [-0.2937174408133392, 0.4728225832686124],
            [2.6958044856371743, 1.3816740424231353, 2.633332376333862],
        ),
        (
            "[1.2, 0.4, -0.6]",
            [0.34281154131289504, 0.4531187311062876],
            [0.478718085768398, 1.6176929806971474, 0.09974239107843176],
        ),
    ];
    for (start, [x, y], end) in seen {
        let (frame, turned) = run(&spot(&format!("{line}\nframe = 'base'\nstart = {start}\nto = [{x}, {y}]")));
        let off = (0..3).map(|k| (frame.relative(k) - end[k]).abs()).fold(0.0, f64::max);
        assert!(off < 1e-6 && turned < 1e-9, "{off:e} rad off, turned by {turned:e} rad");
        assert!((frame.in_base(frame.end_effector) - Vector::new(x, y)).norm() < 1e-8);
        let (frame, turned) = run(&spot(&format!("{line}\nstart = {start}\nto = [{x}, {y}]")));
        assert!(away(&frame, x, y) < 1e-8 && turned < 1e-9, "{:e} m, {turned:e} rad", away(&frame, x, y));
        assert!((frame.target.at - frame.end_effector).norm() < 1e-8 && frame.base.at.norm() > 1e-3);
    }
}

/// Every shape of path, and samples, in space and seen from the base.
#[test]
fn every_shape_of_path_leaves_the_base_as_it_is_oriented() {
    let shapes = [
        "shape = 'arc'\nvia = [[-0.40, 0.50]]\nto = [-0.30, 0.45]",
        "shape = 'spline'\nvia = [[-0.40, 0.48], [-0.35, 0.44]]\nto = [-0.30, 0.47]",
        "shape = 'freehand'\nvia = [[-0.42, 0.43], [-0.40, 0.435], [-0.38, 0.45], [-0.36, 0.45]]\nto = [-0.35, 0.46]",
        "shape = 'line'\nvia = [[-0.40, 0.50]]\nto = [-0.30, 0.45]\ncorners = 'blend'\nblend = 0.02",
    ];
    for (shape, frame) in shapes.iter().flat_map(|shape| [(shape, "space"), (shape, "base")]) {
        let scenario =
            spot(&format!("kind = 'zero-momentum'\nframe = '{frame}'\nstart = [1.9, 2.6, 3.4]\ntime = 8.0\n{shape}"));
        let (end, turned) = run(&scenario);
        let to = scenario.task.to;
        let at = if frame == "space" { end.end_effector } else { end.in_base(end.end_effector) };
        assert!(turned < 1e-9 && (at - Vector::new(to[0], to[1])).norm() < 1e-7, "{shape}, {frame}: {turned:e} rad");
        assert!(Verdict::of(&scenario, &end).target_distance.expect("a target") < 1e-7, "{shape}, {frame}");
    }
    let rows: Vec<String> = (0..=10)
        .map(|i| f64::from(i) / 10.0)
        .map(|u: f64| {
            let s = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
            format!("[{}, {}, {}]", 6.0 * u, -0.4437174408133392 + 0.12 * s, 0.4228225832686124 + 0.04 * s)
        })
        .collect();
    let sampled = spot(&format!("kind = 'zero-momentum'\nstart = [1.9, 2.6, 3.4]\nsamples = [{}]", rows.join(", ")));
    let (end, turned) = run(&sampled);
    assert!(turned < 1e-9 && away(&end, -0.3237174408133392, 0.4628225832686124) < 1e-7, "{turned:e} rad");
}

/// The arm is moved by its joints, and turns its base by the angles that momentum computed outside gives. Joint angles
/// count from the y axis of the base.
#[test]
fn joint_motions_turn_the_base_as_momentum_says() {
    let swung = |from: [f64; 3], to: [f64; 3]| {
        let rows: Vec<String> = (0..=16)
            .map(|i| f64::from(i) / 16.0)
            .map(|u: f64| {
                let s = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
                let joint = |k: usize| (from[k] + s * (to[k] - from[k])).to_radians();
                let first = FRAC_PI_2 + joint(0);
                format!("[{}, {}, {}, {}]", 8.0 * u, first, first + joint(1), first + joint(1) + joint(2))
            })
            .collect();
        let (end, _) = run(&spot(&format!("kind = 'given'\nsamples = [{}]", rows.join(", "))));
        end.base.angle * 180.0 / PI
    };
    for (from, to, turn) in [
        ([0.0; 3], [90.0, 0.0, 0.0], -34.921),
        ([-90.0, 0.0, 0.0], [90.0, 0.0, 0.0], -70.930),
        ([90.0, -90.0, -90.0], [0.0, 90.0, 90.0], 6.526),
    ] {
        let got = swung(from, to);
        assert!((got - turn).abs() < 1e-3, "{got} for {turn} degrees");
    }
    let (end, _) = run(&Scenario::builtin("spot-swing").expect("built in"));
    assert!((end.base.angle * 180.0 / PI + 34.921).abs() < 1e-3);
}

/// A motion that was flown turns the base by what momentum computed outside gives, and the silent one between the same
/// points by nothing.
#[test]
fn a_satellite_turns_as_it_flew() {
    let [flown, silent] = ["ets-vii", "ets-vii-silent"].map(|name| Scenario::builtin(name).expect("built in"));
    let (end, _) = run(&flown);
    assert!((end.base.angle + 0.010736574209523).abs() < 1e-8 && end.time >= 22.6 - 1e-9, "{} rad", end.base.angle);
    for (k, turned) in
        [0.263828840, 0.263828840 + 0.320653514, 0.263828840 + 0.320653514 + 0.056824673].iter().enumerate()
    {
        let start = Run::new(&flown).expect("it runs").frame().relative(k);
        assert!((end.relative(k) - start - turned).abs() < 1e-7, "angle {k}");
    }
    let (still, turned) = run(&silent);
    let begin = [&flown, &silent].map(|scenario| Run::new(scenario).expect("it runs").frame().end_effector);
    assert!((begin[0] - begin[1]).norm() < 1e-9, "{begin:?}");
    assert!(turned < 1e-9 && (end.in_base(end.end_effector) - still.in_base(still.end_effector)).norm() < 1e-7);
}

/// The first two links of the arm on its free base, with a task.
fn two_links(task: &str, base: &str) -> Scenario {
    let link = |name: &str, drive: &str, at: &str, values: &str| {
        format!("[[machine.link]]\nname = '{name}'\ndrive = '{drive}'\nattach = {at}\nlength = 0.3045\n{values}\n")
    };
    let links = [
        link("1", "shoulder", "'base'", "mass = 0.345\ninertia = 0.003704\ncom = 0.196822"),
        link("2", "elbow", "{ link = '1', at = 'tip' }", "mass = 0.335\ninertia = 0.003506\ncom = 0.198152"),
    ];
    let text = format!(
        "[machine]\nname = 'two links'\n[[machine.drive]]\nname = 'shoulder'\n[[machine.drive]]\nname = 'elbow'\n\
         on = 'shoulder'\n{}[machine.end_effector]\nlink = '2'\nat = 'tip'\n[task]\nkind = 'zero-momentum'\n{task}\n\
         time = 10.0\n[base]\n{base}",
        links.concat()
    );
    Scenario::parse(&text, "two links", None).expect("valid")
}

const CRAFT: &str =
    "kind = 'free'\nmass = 11.211\ninertia = 0.20215\ncom = [-0.0680112181717378, -0.24212956077851439]";

/// Two drives go along a line in one way, and the base turns by what an integration of the conserved momenta by SciPy
/// gives, in space and as seen from the base.
#[test]
fn two_drives_follow_a_line_and_turn_their_base() {
    let to = "shape = 'line'\nto = [-0.25, 0.4728]";
    let known = [
        ("space", 0.203_890_934_562_286_24, [1.169_963_636_666_105_5, 2.352_602_694_159_917_6]),
        ("base", 0.102_603_448_613_451_72, [1.558_490_217_986_192, 2.555_889_973_537_470_7]),
    ];
    for (frame, turn, end) in known {
        let scenario = two_links(&format!("{to}\nstart = [1.9, 2.9]\nframe = '{frame}'"), CRAFT);
        let planned = Run::new(&scenario).expect("a plan");
        let [at_end, most] =
            planned.plan().base_turn.as_ref().map(|turn| [turn.angle_end, turn.angle]).expect("it turns");
        assert!((at_end - turn).abs() < 1e-9 && (most - turn).abs() < 1e-9, "{frame}: {at_end}");
        let (last, turned) = run(&scenario);
        assert!((last.base.angle - turn).abs() < 1e-9 && (turned - turn).abs() < 1e-9, "{frame}: {}", last.base.angle);
        // Drive angles of a run count from axes in space, those of the integration from the base.
        let off = (0..2).map(|k| (last.q[k] - last.base.angle - end[k]).abs()).fold(0.0, f64::max);
        assert!(off < 1e-8, "{frame}: {off}");
        if frame == "space" {
            assert!(away(&last, -0.25, 0.4728) < 1e-8);
        }
    }
    // From a point, the elbow of less turn: 0.153041 rad instead of 0.203891 rad.
    let scenario = two_links(&format!("{to}\nfrom = [-0.39409843, 0.3609998]"), CRAFT);
    let (last, _) = run(&scenario);
    assert!((last.base.angle - 0.153_040_836).abs() < 1e-6, "{}", last.base.angle);
    // A limit that the turn passes is refused with one that would do.
    let bound = |limit: f64| two_links(&format!("{to}\nstart = [1.9, 2.9]\nturn_limit = {limit}"), CRAFT);
    let Err(Refusal::Turns { stopped: None, turn_limit }) = Run::new(&bound(4.0)) else {
        panic!("11.7° are more than 4°")
    };
    assert!((turn_limit - 12.0).abs() < 1e-12, "{turn_limit}");
    Run::new(&bound(turn_limit)).expect("it will do");
    // Where no turn lets them follow it, what does is said.
    let line = format!("{to}\nstart = [1.9, 2.9]");
    let wheel = format!("{CRAFT}\n[base.wheel]\ninertia = 0.02");
    for (base, task) in [("kind = 'fixed'", &line), (&wheel, &line)] {
        let why = Run::new(&two_links(task, base)).expect_err("no one turns").to_string();
        assert!(why.contains("want the shape joint-line, or minimum-norm"), "{why}");
    }
    let curve = Run::new(&two_links(&line.replace("'line'", "'joint-line'"), CRAFT)).expect_err("no curve").to_string();
    assert!(curve.contains("want the shape line"), "{curve}");
}

/// A start brings A and b, whatever else is stated; another A has no start.
#[test]
fn a_task_may_state_its_pose_of_a() {
    let scenario = spot("kind = 'zero-momentum'\nstart = [1.9, 2.6, 3.4]\nto = [-0.2937, 0.4728]");
    assert!((scenario.task.from[0] + 0.4437174408133392).abs() < 1e-12);
    let again = Scenario::parse(&scenario.to_toml(), "again", None).expect("what is written is read");
    assert_eq!((&again.task.start, again.task.from), (&scenario.task.start, scenario.task.from));
    let both =
        spot("kind = 'zero-momentum'\nstart = [1.9, 2.6, 3.4]\nfrom = [0.1, 0.2]\nb = 1.0\nto = [-0.2937, 0.4728]");
    assert_eq!(both.task, scenario.task);
    let change = |text: &str| text.parse::<Table>().expect("TOML");
    let moved = scenario.task.with_change(&change("from = [-0.44, 0.42]"), &scenario.machine).expect("a task");
    assert_eq!((moved.start, moved.from), (None, [-0.44, 0.42]));
    let begun = moved.with_change(&change("start = [1.9, 2.6, 3.4]"), &scenario.machine).expect("a task");
    assert_eq!(begun.from, scenario.task.from);
    for (task, words) in [
        ("start = [1.9, 2.6]\nto = [0.3, 0.3]", "start (task.start): 2 angles: want 3, one for each drive"),
        ("to = [0.3, 0.3]", "point A (task.from) is missing"),
    ] {
        let text = format!("machine = 'spot'\n[task]\nkind = 'zero-momentum'\n{task}\n");
        let why = Scenario::parse(&text, "wrong", None).expect_err("wrong").to_string();
        assert!(why.contains(words), "{why}");
    }
    // The other kinds begin there, too.
    let nine = |kind: &str| {
        let text = format!(
            "machine = 'nine-link'\n[task]\nkind = '{kind}'\nstart = [1.6875182179, 3.7146223682, 2.1801769897]\nto = [0.35, 0.60]\n"
        );
        Scenario::parse(&text, "nine", None).expect("valid")
    };
    for kind in ["reactionless", "minimum-norm", "least-reaction", "zero-momentum", "same-tip", "change-b"] {
        let scenario = nine(kind);
        let run = Run::new(&scenario).unwrap_or_else(|why| panic!("{kind}: {why}"));
        let start = scenario.task.start_pose(3).expect("stated");
        assert!(run.frame().q.0.minus(&start.0).max_abs() < 1e-9, "{kind}: {:?}", run.frame().q);
    }
}

/// Every kind begins at a stated start, whatever the number of drives: one turn farther than its own, and, where freedoms
/// are left, beside it. Past a limit it is told before anything else.
#[test]
fn every_kind_begins_at_its_start() {
    let mut begun = 0;
    for name in ["case-3", "serial-3r", "four-drive", "two-drive", "counter-rotating"] {
        let own = Scenario::builtin(name).expect("built in");
        for kind in ["reactionless", "line", "minimum-norm", "least-reaction", "zero-momentum", "same-tip", "change-b"]
        {
            let (kind, shape) = if kind == "line" { ("reactionless", "line") } else { (kind, "default") };
            let with = |scenario: &Scenario, keys: &str| {
                let change =
                    format!("[task]\nkind = '{kind}'\nshape = '{shape}'\n{keys}").parse::<Table>().expect("TOML");
                scenario.with_settings(&change).expect("settings")
            };
            let Ok(usual) = Run::new(&with(&own, "")) else { continue };
            let (q, tip) = (usual.frame().q, usual.frame().end_effector);
            let [x, y] = own.task.to;
            // The perturbed starts go a part of the way, for they may come to a limit sooner.
            let beside = [0.02, -0.03, 0.04, -0.02].map(|by| by - 0.01);
            let near = format!("to = [{}, {}]", 0.8 * tip.re + 0.2 * x, 0.8 * tip.im + 0.2 * y);
            let turned = (std::f64::consts::TAU, [0.0; 4], String::new());
            let all = [Some(turned), (q.len() > 2).then_some((0.0, beside, near))];
            for (turn, beside, to) in all.into_iter().flatten() {
                let start: Vec<f64> = (0..q.len()).map(|k| q[k] + turn + beside[k]).collect();
                let scenario = with(&own, &format!("start = {start:?}\n{to}"));
                let run = Run::new(&scenario).unwrap_or_else(|why| panic!("{name}, {kind}, {shape}: {why}"));
                let apart = run.frame().q.iter().zip(&start).fold(0.0, |most: f64, (q, s)| most.max((q - s).abs()));
                assert!(apart < 1e-9, "{name}, {kind}, {shape}: {apart}");
                begun += 1;
            }
            let far: Vec<f64> = (0..q.len()).map(|k| q[k] + 4.0 * k as f64).collect();
            let why = Run::new(&with(&own, &format!("start = {far:?}"))).expect_err("past a limit").to_string();
            assert!(why.starts_with("at the start a1 is ") && why.contains(" rad: want it from "), "{why}");
        }
    }
    assert!(begun >= 40, "{begun}");
    // A posture that looks for the best pose of A itself has no use for a start.
    let own = Scenario::builtin("four-drive").expect("built in");
    let q = Run::new(&own).expect("a plan").frame().q.to_vec();
    let change = format!("[task]\nkind = 'reactionless'\nshape = 'line'\nposture = 'least-torque'\nstart = {q:?}");
    let begun = own.with_settings(&change.parse::<Table>().expect("TOML")).expect("settings");
    let why = Run::new(&begun).expect_err("two poses of A").to_string();
    assert!(why.contains("want no start, or the posture least-rates"), "{why}");
}

/// What takes the start away is undone with it, and the other way round.
#[test]
fn a_start_is_undone_with_its_point() {
    let scenario = spot("kind = 'zero-momentum'\nstart = [1.9, 2.6, 3.4]\nto = [-0.2937, 0.4728]");
    for text in
        ["[task]\nfrom = [-0.44, 0.42]", "[task]\nb = 2.0", "[task]\nstart = [1.8, 2.6, 3.4]", "[task]\ntime = 5.0"]
    {
        let change = text.parse::<Table>().expect("TOML");
        let changed = scenario.with_settings(&change).expect("settings");
        assert_ne!(changed.task, scenario.task);
        let back = scenario.present_values(&change).expect("known");
        assert_eq!(changed.with_settings(&back).expect("as it was").task, scenario.task, "{text}");
    }
}

/// Where the path crosses a dynamic singularity, peaks last for milliseconds; the plan has those of a run of short steps.
#[test]
fn plans_have_the_peaks_of_crossings() {
    for to in ["[0.4, 0.0]", "[0.0, 0.0]"] {
        let task = "kind = 'zero-momentum'\nstart = [1.9, 2.6, 3.4]\nturn_limit = 43.0\ntime = 10.0\nframe = 'space'";
        let mut crossing = spot(&format!("{task}\nto = {to}"));
        crossing.step = 2e-4;
        let (frame, _) = run(&crossing);
        let planned = Run::new(&crossing).expect("it plans").plan().forecast;
        let (got, want) = (planned.moment, frame.peaks.arm_moment);
        assert!((got / want - 1.0).abs() < 5e-3, "{to}: {got} N m for {want}");
        let (got, want) = (planned.force, frame.peaks.force);
        assert!((got / want - 1.0).abs() < 5e-3, "{to}: {got} N for {want}");
    }
}
