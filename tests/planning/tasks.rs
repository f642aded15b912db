//! Tasks: what is planned is what the machine then does, and what cannot be is refused with the reason.

use stillbase::mechanics::planar::Vector;
use stillbase::planning::common;
use stillbase::planning::following::SheetEnd;
use stillbase::session::scenario::{Scenario, Task, TaskChange};
use stillbase::session::{Edit, Refusal, Run, Session, curves, replay};
use stillbase::simulation::frame::{Frame, Phase};

fn scenario() -> Scenario {
    Scenario { compare_b: None, ..Scenario::builtin("case-3").expect("built in") }
}

/// Case 3 with keys of its task as they stand in a file.
fn task(text: &str) -> Scenario {
    let base = scenario();
    let change: TaskChange = toml::from_str(text).expect("keys and values");
    Scenario { task: base.task.with_change(&change, &base.machine).expect("a task"), ..base }
}

fn run(scenario: &Scenario) -> (Run, Vec<Frame>) {
    let mut frames = Vec::new();
    let run = replay(scenario, |_, frame| frames.push(*frame)).unwrap_or_else(|e| panic!("{e}"));
    (run, frames)
}

/// Every shape on the plane is reactionless, keeps b, visits its points and ends at rest.
#[test]
fn every_shape_is_reactionless() {
    for (text, closed) in [
        ("shape = 'line'", false),
        ("shape = 'line'\nvia = [[0.6, 0.7], [0.5, 0.8]]", false),
        ("shape = 'line'\nvia = [[0.6, 0.7], [0.5, 0.8]]\ncorners = 'blend'", false),
        ("shape = 'line'\nvia = [[0.6, 0.7]]\nclosed = true", true),
        ("shape = 'arc'\nvia = [[0.6, 0.7]]", false),
        ("shape = 'spline'\nvia = [[0.6, 0.7], [0.5, 0.8]]\nclosed = true", true),
        ("shape = 'spline'\nvia = [[0.6, 0.7]]\nlaw = 'septic'", false),
        ("shape = 'line'\nvia = [[0.6, 0.7]]\nlaw = 'trapezoidal'", false),
        ("shape = 'arc'\nvia = [[0.6, 0.7]]\nlaw = 'fastest'", false),
        ("shape = 'joint-line'\nvia = [[0.6, 0.7], [0.5, 0.8]]", false),
        ("shape = 'joint-line'\nvia = [[0.6, 0.7], [0.5, 0.8]]\ncorners = 'blend'\nblend = 0.1", false),
        ("shape = 'freehand'\nvia = [[0.53, 0.55], [0.57, 0.6], [0.6, 0.7], [0.58, 0.8]]", false),
    ] {
        let scenario = task(text);
        let (run, frames) = run(&scenario);
        let last = frames[frames.len() - 1];
        assert!(last.peaks.is_reactionless(), "{text}: {:?}", last.peaks);
        assert_eq!(last.phase, Phase::Rest, "{text}");
        assert!(last.peaks.torque.max_abs() > 0.1, "{text}: it moves");
        assert!(frames.iter().all(|f| (f.b_reference - 2.4).abs() < 1e-11), "{text}");
        assert!(frames.iter().all(|f| f.q_reference.0.minus(&f.q.0).max_abs() < 1e-4), "{text}");
        let points = scenario.task.points();
        let end = if closed { points[0] } else { points[points.len() - 1] };
        assert!((last.end_effector - end).norm() < 1e-4, "{text}: {}", last.end_effector);
        // Points at which the path must be: all but those whose corner is rounded or smoothed.
        let exact = !text.contains("blend") && !text.contains("freehand");
        for p in points.iter().filter(|_| exact) {
            let nearest = frames.iter().map(|f| (f.end_effector - p).norm()).fold(f64::INFINITY, f64::min);
            assert!(nearest < 3e-3, "{text}: passes {p} at {nearest}");
        }
        let forecast = &run.plan().forecast;
        let most = forecast.torque.minus(&last.peaks.torque).max_abs();
        assert!(most < 2e-2 * last.peaks.torque.max_abs(), "{text}: torques are as forecast, {most}");
        assert!(forecast.moment < 1e-6, "{text}: {}", forecast.moment);
    }
}

/// Where corners stop, the machine rests at each of them; where they blend, it never does on the way.
#[test]
fn corners_rest_or_do_not() {
    let via = "via = [[0.6, 0.7], [0.5, 0.8]]";
    for shape in ["line", "joint-line"] {
        let slowest = |more: &str| {
            let (_, frames) = run(&task(&format!("shape = '{shape}'\n{via}\n{more}")));
            let middle = &frames[frames.len() / 10..frames.len() * 9 / 10];
            middle.iter().map(|f| f.qd.max_abs()).fold(f64::INFINITY, f64::min)
        };
        assert!(slowest("corners = 'stop'") < 0.02, "{shape}");
        assert!(slowest("corners = 'blend'\nblend = 0.1") > 0.1, "{shape}");
    }
}

/// A line that only makes sense with another b, and one that none allows.
#[test]
fn what_cannot_be_followed_is_refused_before_it_moves() {
    // Through the inner edge of the workspace: both ends are inside, the middle is not.
    let hole = task("shape = 'line'\nfrom = [0.42, 1.12]\nto = [0.0, 0.5]");
    let Err(Refusal::Blocked(blocked)) = Run::new(&hole) else { panic!("the middle is outside") };
    assert!(blocked.leaves_workspace && matches!(blocked.stop, SheetEnd::Limit { .. }), "{blocked:?}");
    let at = hole.task.points()[0] + (hole.task.points()[1] - hole.task.points()[0]) * blocked.s;
    assert!((at - blocked.at).norm() < 1e-9);
    // A joint line joins the same two points.
    assert!(Run::new(&task("from = [0.42, 1.12]\nto = [0.0, 0.5]")).is_ok());

    let Err(refusal) = Run::new(&task("to = [-0.6, -0.2]")) else { panic!("no b serves both") };
    let words = refusal.to_string();
    assert!(words.contains("no b serves both A and B") && words.contains("moving "), "{words}");
}

/// The move that is said to mend it does, and a bit less of it does not.
#[test]
fn the_least_move_mends() {
    let run = Run::new(&scenario()).expect("it starts");
    let space = run.pose_space().expect("it has a b");
    let points = [Vector::new(0.5, 0.5), Vector::new(-0.6, -0.2), Vector::new(0.1, 1.0)];
    for points in [&points[..2], &points[..]] {
        let why = common::no_common(space, points).expect("nothing in common");
        assert_eq!(why.pair, Some([0, 1]));
        let Some(mend) = why.correction else {
            assert_eq!(points.len(), 3, "two can always be brought together");
            continue;
        };
        let moved = |share: f64| {
            let mut points = points.to_vec();
            let was = points[mend.point];
            points[mend.point] = was + share * (mend.to - was);
            common::common_b_set(space, &points)
        };
        assert!(moved(1.0 + 1e-6).is_some(), "{mend:?}");
        assert!(moved(0.999).is_none(), "{mend:?}");
        assert!((mend.distance - (mend.to - points[mend.point]).norm()).abs() < 1e-9);
    }
}

/// Moved, added, taken out, brought forward: the task has the points that it should.
#[test]
fn waypoints_are_edited_as_lists() {
    let Scenario { task, machine, .. } = scenario();
    let with = |task: &Task, change: Option<TaskChange>| {
        task.with_change(&change.expect("possible"), &machine).expect("a task")
    };
    let p = Vector::new(0.6, 0.7);
    let three = with(&task, task.adding(p));
    assert_eq!(three.points(), [Vector::new(0.5, 0.5), p, Vector::new(0.55, 0.9)]);
    assert_eq!(three.name_of(1), "1");
    let moved = with(&three, three.moving(0, Vector::new(0.52, 0.5)));
    assert_eq!(moved.points()[0].re, 0.52);
    let first = with(&three, three.advancing(1));
    assert_eq!(first.points(), [p, Vector::new(0.5, 0.5), Vector::new(0.55, 0.9)]);
    assert_eq!(with(&three, three.removing(1)), task);
    assert_eq!(task.removing(0), None);
    assert_eq!(three.advancing(0), None);
    // Where the least way is added.
    let far = with(&three, three.adding(Vector::new(0.58, 0.8)));
    assert_eq!(far.points()[2], Vector::new(0.58, 0.8));
}

/// Planning edits are edits: refused ones change nothing, undone ones leave no trace, saved ones replay.
#[test]
fn planning_is_done_by_edits() {
    let mut session = Session::open(scenario()).expect("it starts");
    session.play();
    session.tick(300);
    let before = session.frames().to_vec();
    session.apply(Edit::set("task.shape", "line")).expect("feasible");
    session.end_gesture();
    assert_eq!(session.frames().len(), before.len(), "the display stays where it was");
    assert_ne!(session.frame().q, before[300].q);
    assert!(session.undo_title().expect("an edit").contains("shape of the path to line"));

    let task = session.scenario().task.clone();
    let outside = task.moving(1, Vector::new(1.1, 0.3)).expect("a point");
    let frames = session.frames().to_vec();
    let refusal = session.apply(Edit::of("task", outside)).expect_err("outside of every plane of A");
    assert!(matches!(refusal, Refusal::NoCommonPlane { .. } | Refusal::Unreachable { .. }), "{refusal}");
    assert_eq!((session.frames().to_vec(), &session.scenario().task), (frames, &task));
    let nonsense = session.apply(Edit::set("task.shape", "square")).expect_err("no such shape").to_string();
    assert!(nonsense.contains("square") && nonsense.contains("spline"), "{nonsense}");

    let inside = task.adding(Vector::new(0.6, 0.7)).expect("a point");
    session.apply(Edit::of("task", inside)).expect("feasible");
    session.end_gesture();
    assert_eq!(session.scenario().task.points().len(), 3);

    let saved = session.to_scenario();
    let read = Scenario::parse(&saved.to_toml(), "saved.toml", None).expect("reads");
    assert_eq!(read, saved);
    let (_, replayed) = run(&read);
    assert_eq!(replayed, session.frames().to_vec());

    session.undo().expect("taken back");
    session.undo().expect("taken back");
    assert_eq!(session.scenario().task, scenario().task);
    assert_eq!(session.frames().to_vec()[..300], before[..300]);
}

/// Who plans again takes the machine back from the hand that led it.
#[test]
fn a_new_path_ends_following() {
    let mut session = Session::open(scenario()).expect("it starts");
    session.apply(Edit::DragTarget { x: 0.6, y: 0.7 }).expect("follows");
    session.end_gesture();
    session.tick(400);
    assert!(session.is_dragged());
    session.apply(Edit::set("task.shape", "line")).expect("feasible");
    assert!(!session.is_dragged());
    assert_eq!(session.frames().len(), 1);
    session.undo().expect("taken back");
    assert!(session.is_dragged());
}

/// Slid while at rest, b turns all points of a path when no plane serves them any more.
#[test]
fn posing_turns_all_points() {
    let mut session = Session::open(task("via = [[0.6, 0.7]]")).expect("it starts");
    let before = session.scenario().task.points();
    session.apply(Edit::PoseB { b: 4.0 }).expect("posed");
    let after = session.scenario().task.points();
    assert_eq!(after.len(), 3);
    let ratio = after[0] / before[0];
    assert!((ratio.norm() - 1.0).abs() < 1e-9);
    for (p, q) in before.iter().zip(&after) {
        assert!((p * ratio - q).norm() < 1e-9, "all turn alike");
    }
}

/// The curve that is drawn is the one that is followed.
#[test]
fn what_is_drawn_is_followed() {
    let scenario = task("shape = 'spline'\nvia = [[0.6, 0.7], [0.5, 0.8]]");
    let (run, frames) = run(&scenario);
    let drawn = curves(&scenario.task, &scenario.task.points()).expect("a curve");
    for frame in frames.iter().step_by(50) {
        let s = drawn[0].nearest(frame.end_effector, 4000);
        assert!((drawn[0].at(s).p - frame.end_effector).norm() < 1e-6);
    }
    let end = run.plan().motion.at(run.planned_time()).q;
    assert!((run.end_effector_at(&end) - Vector::new(0.55, 0.9)).norm() < 1e-10);
}

/// However fast the pointer jumps about within folded limits, the machine stays on its plane, keeps its bounds and does
/// not pass a fold.
#[test]
fn dragging_never_jumps_sheets() {
    let base = scenario();
    let machine = base.machine.set_all([("limits.a1", "-3.1,3.1"), ("limits.a2", "-3.1,3.1")]).expect("valid");
    let mut session = Session::open(Scenario { machine, step: 0.002, ..base }).expect("it starts");
    let map = *session.run().planes().expect("planes").map();
    let sheet = map.det([session.frame().a[0], session.frame().a[1]]);
    let mut seed = 7_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut other_sheets = 0;
    for _ in 0..60 {
        let (x, y) = (2.4 * random() - 1.2, 2.4 * random() - 1.2);
        session.apply(Edit::DragTarget { x, y }).expect("follows");
        session.tick(60);
        let target = session.frame().target.reach;
        other_sheets +=
            usize::from(matches!(target, stillbase::simulation::frame::Reach::Outside { other_sheet: true, .. }));
    }
    assert!(other_sheets > 3, "{other_sheets} targets were beyond a fold");
    let frames = session.frames();
    let least = frames.iter().map(|f| map.det([f.a[0], f.a[1]]) * sheet.signum()).fold(f64::INFINITY, f64::min);
    assert!(least > -1e-6, "{least}");
    assert!(frames.iter().all(|f| (f.b_reference - 2.4).abs() < 1e-12));
    assert!(frames[frames.len() - 1].peaks.is_reactionless());
    let limit = session.scenario().machine.spec().drives[0].torque_limit;
    if let Some(limit) = limit {
        assert!(frames.iter().all(|f| f.torque[0].abs() < limit));
    }
}

/// A change of b costs what was said: n_B = −D_1 b̈ all the way, the peak and the time are those of the law.
#[test]
fn the_price_of_b_is_what_was_said() {
    let d1 = stillbase::mechanics::machine::Inertia::of(&scenario().machine).diagonal(0);
    let far = "kind = 'change-b'\nto = [-0.6, -0.2]";
    for (law, limit, factor) in [
        ("quintic", None, 10.0 / 3f64.sqrt()),
        ("trapezoidal", None, 4.5),
        ("quintic", Some(3.0), 10.0 / 3f64.sqrt()),
        ("septic", Some(3.0), 84.0 * 5f64.sqrt() / 25.0),
        ("fastest", Some(2.0), 4.0),
    ] {
        let limited = limit.map_or(String::new(), |n| format!("\nmoment_limit = {n}"));
        let (run, frames) = run(&task(&format!("{far}\nlaw = '{law}'{limited}")));
        let plan = run.plan();
        let price = plan.price.expect("b changes");
        let time = run.planned_time();
        let peak = factor * d1 * price.delta_b().abs() / (time * time);
        assert!((plan.forecast.moment - peak).abs() < 2e-4 * peak, "{law}: {} {peak}", plan.forecast.moment);
        if let Some(limit) = limit {
            assert!((peak - limit).abs() < 1e-9 * limit, "{law}: {peak} for {limit}");
        }
        assert!(price.least_peak(time) <= peak * (1.0 + 1e-12));
        let moved = frames[frames.len() - 1].b_reference - frames[0].b_reference;
        assert!((moved - price.delta_b()).abs() < 1e-9, "{law}: {moved}");
        // The measured moment against the second derivative of the machine's own b.
        let lambda = stillbase::mechanics::machine::Inertia::of(&scenario().machine).lambda();
        for f in &frames {
            assert!((f.base_moment() + d1 * lambda.dot(&f.qdd)).abs() < 1e-9, "{law}: at {} s", f.time);
        }
        let last = frames[frames.len() - 1];
        assert!((last.peaks.moment - peak).abs() < 0.02 * peak, "{law}: {} {peak}", last.peaks.moment);
        assert!(last.peaks.force < 1e-9 && !last.peaks.is_reactionless());
        assert!((last.end_effector - scenario().task.points()[0]).norm() > 0.5);
    }
    // Where A and B share a plane, nothing has to change.
    let (free, frames) = run(&task("kind = 'change-b'"));
    assert!(free.plan().price.expect("a price").delta_b().abs() < 1e-12);
    assert!(frames[frames.len() - 1].peaks.is_reactionless());
}

/// The least reaction is less than that of minimum norm, what it was said to be, and none at all where b can stay.
#[test]
fn the_least_reaction_is_less_than_others() {
    let line = "kind = 'least-reaction'\nb = 1.75";
    let (least, frames) = run(&task(line));
    let verdicts = least.plan().verdicts.clone().expect("compared");
    let last = frames[frames.len() - 1];
    assert!((last.peaks.moment - verdicts.least.peak).abs() < 0.02 * verdicts.least.peak, "{:?}", last.peaks);
    let (_, norm) = run(&task("kind = 'minimum-norm'\nb = 1.75"));
    let norm = norm[norm.len() - 1].peaks.moment;
    let said = verdicts.minimum_norm.expect("regular").reaction.peak;
    assert!((norm - said).abs() < 5e-3 * norm, "{norm} {said}");
    assert!(last.peaks.moment < 0.9 * norm);
    let (peak, _) = run(&task(&format!("{line}\nleast = 'peak'")));
    let peak = peak.plan().verdicts.clone().expect("compared").least;
    assert!(peak.peak < verdicts.least.peak && peak.rms > verdicts.least.rms, "{peak:?} {:?}", verdicts.least);
    // Limits are kept.
    let limits = least.planes().expect("planes").map().limits();
    assert!(frames.iter().all(|f| (0..2).all(|i| limits[i].contains(f.a[i], 1e-6))));
    let (stays, frames) = run(&task("kind = 'least-reaction'\nvia = [[0.58, 0.7]]"));
    assert!(frames[frames.len() - 1].peaks.is_reactionless());
    assert_eq!(stays.plan().verdicts.as_ref().expect("compared").least.peak, 0.0);
}

/// Zero momentum transmits no moment on any machine; round and round it drifts where D is not constant, and only there.
#[test]
fn zero_momentum_drifts_only_without_invariance() {
    let circle = "kind = 'zero-momentum'\nshape = 'arc'\nfrom = [0.6, 0.62]\nvia = [[0.52, 0.7]]\nto = [0.44, 0.62]\n\
                  closed = true\ncycles = 3\nb = 2.65";
    let invariant = Run::new(&task(circle)).expect("planned");
    let drift = |run: &Run, i: usize| {
        let cycles = &run.plan().cycles;
        cycles[i].0.minus(&cycles[0].0).max_abs()
    };
    assert_eq!(invariant.plan().cycles.len(), 4);
    assert!(drift(&invariant, 3) < 1e-9);
    let loaded = scenario().machine.set_all([("payload.mass", "0.5")]).expect("valid");
    let (run, frames) = run(&Scenario { machine: loaded, ..task(circle) });
    assert!((1..4).all(|i| drift(&run, i) > 0.01 * i as f64), "{}", drift(&run, 3));
    assert!((run.planned_time() - 3.0).abs() < 1e-9, "each cycle takes the time of the task");
    let last = frames[frames.len() - 1];
    assert!(last.peaks.moment < 1e-5 * last.peaks.torque_sum, "{:?}", last.peaks);
    assert!(frames.iter().all(|f| f.angular_momentum.abs() < 1e-6));
    assert!((last.end_effector - run.scenario().task.points()[0]).norm() < 1e-6);
    assert!(last.q.0.minus(&run.plan().cycles[3].0).max_abs() < 1e-6);
}

/// All scenarios that come along start, and do what their titles say.
#[test]
fn the_scenarios_that_come_along_do_what_they_say() {
    for name in Scenario::builtin_names() {
        let scenario = Scenario::builtin(name).expect("built in");
        let run = Run::new(&scenario).unwrap_or_else(|e| panic!("{name}: {e}"));
        let forecast = &run.plan().forecast;
        let quiet = forecast.moment < 1e-5 * forecast.torque.max_abs();
        // The plan is of the model; what the plant and the base make of it is another matter.
        let family = ["two-drive", "four-drive", "serial-3r", "nine-link-geared", "counter-rotating"];
        let planned = [&["case-3", "circle", "drift", "pick-up", "friction"][..], &family].concat();
        assert_eq!(quiet, planned.contains(&name), "{name}: {}", forecast.moment);
        let end = stillbase::session::replay(&scenario, |_, _| {}).expect("it runs").frame();
        let fault = end.first_violation();
        assert!(fault.is_none(), "{name}: {fault:?}");
        let done = end.peaks.moment < 1e-5 * end.peaks.torque_sum;
        // The base of these feels no moment about its own centre of mass.
        let still = [&["case-3", "circle", "drift", "spot", "ets-vii-silent"][..], &family].concat();
        assert_eq!(done, still.contains(&name), "{name}: {}", end.peaks.moment);
        assert_eq!(
            end.totals.base_angle > 1e-6,
            ["spacecraft", "bench-top", "space-arm", "spot-swing", "spot-turn", "ets-vii"].contains(&name),
            "{name}"
        );
        assert_eq!(end.totals.saturated.is_some(), name == "wheel");
    }
    let words = Run::new(&task("kind = 'change-b'\nvia = [[0.5, 0.6]]")).expect_err("no points between").to_string();
    assert!(words.contains("no points between"), "{words}");
    let near = Scenario { task: Scenario::builtin("drift").expect("built in").task, ..scenario() };
    let near = Scenario { task: stillbase::session::scenario::Task { b: 2.07, ..near.task }, ..near };
    let words = Run::new(&near).expect_err("passes a limit").to_string();
    assert!(words.contains("would pass its upper limit"), "{words}");
    let words = Run::new(&task("kind = 'zero-momentum'\ncycles = 2")).expect_err("open").to_string();
    assert!(words.contains("closed = true"), "{words}");
    let words = Run::new(&task("kind = 'least-reaction'\nlaw = 'fastest'")).expect_err("no time").to_string();
    assert!(words.contains("quintic or septic"), "{words}");
}

/// Who keeps off change points does so while dragging too: the machine stays where q_3 < q_1 or q_3 > q_1.
#[test]
fn dragging_can_keep_off_change_points() {
    for keep in [false, true] {
        let mut session = Session::open(task(&format!("keep_off_change_points = {keep}"))).expect("case 3 stays off");
        let side = |f: &Frame| (f.q[2] - f.q[0]).signum();
        let start = side(session.frame());
        // A place of the other side.
        let map = *session.run().planes().expect("planes").map();
        let p = map.forward([1.2, 1.4], 2.4);
        session.apply(Edit::DragTarget { x: p.re, y: p.im }).expect("follows");
        session.tick(3000);
        let crossed = session.frames().iter().any(|f| side(f) != start);
        assert_eq!(crossed, !keep);
        let reach = session.frame().target.reach;
        assert_eq!(
            matches!(reach, stillbase::simulation::frame::Reach::Outside { other_sheet: true, .. }),
            keep,
            "{reach:?}"
        );
        assert!(session.frame().peaks.is_reactionless());
    }
}

/// Motions whose rates alone are given stay on their curve across the joints of a spline, and keep limits or are
/// refused.
#[test]
fn rates_follow_splines_too() {
    let zigzag: Vec<String> = (1..16)
        .map(|i| {
            let t = f64::from(i) / 16.0;
            let off = if i % 2 == 0 { 0.01 } else { -0.01 };
            format!("[{}, {}]", 0.5 + 0.05 * t + off, 0.5 + 0.4 * t)
        })
        .collect();
    for kind in ["minimum-norm", "zero-momentum"] {
        let scenario = task(&format!("kind = '{kind}'\nshape = 'spline'\nvia = [{}]\ntime = 4.0", zigzag.join(", ")));
        let (run, frames) = run(&scenario);
        let drawn = curves(&scenario.task, &scenario.task.points()).expect("a curve");
        let motion = &run.plan().motion;
        for i in 0..=500 {
            let tip = run.end_effector_at(&motion.path.at(f64::from(i) / 500.0).q);
            let s = drawn[0].nearest(tip, 20_000);
            assert!((drawn[0].at(s).p - tip).norm() < 1e-8, "{kind} {i}");
        }
        let last = frames[frames.len() - 1];
        assert_eq!(last.peaks.moment < 1e-6 * last.peaks.torque_sum, kind == "zero-momentum", "{:?}", last.peaks);
    }
}

/// A limit on n_B never asks more of the drives than they have.
#[test]
fn a_price_limit_spares_the_drives() {
    for text in [
        "kind = 'change-b'\nmoment_limit = 3.0",
        "kind = 'change-b'\nmoment_limit = 100.0\nlaw = 'fastest'\nb_to = 2.41",
        "kind = 'change-b'\nto = [-0.6, -0.2]\nmoment_limit = 1000.0\nlaw = 'fastest'",
    ] {
        let run = Run::new(&task(text)).unwrap_or_else(|e| panic!("{text}: {e}"));
        let forecast = &run.plan().forecast;
        assert!(forecast.exceeded_limit.is_none(), "{text}: {:?}", forecast.exceeded_limit);
    }
    let hasty = Run::new(&task("time = 0.1")).expect("it can be planned");
    let (limit, factor) = hasty.plan().forecast.exceeded_limit.expect("too fast");
    assert!(factor > 5.0 && limit.to_string().contains("torque"), "{limit} {factor}");
}
