//! Ways out: whatever is refused, what is proposed can be done; and what the statements say agrees.

use std::collections::BTreeMap;

use stillbase::mechanics::machine::{Machine, builtins};
use stillbase::mechanics::planar::Vector;
use stillbase::planning::pose_space::Reach;
use stillbase::session::scenario::{Scenario, Value};
use stillbase::session::verdict::{Statements, StatusLight, Verdict};
use stillbase::session::{
    Edit, Proposal, Run, Session, TargetProposals, for_machine, proposals, proposals_for_settings, replay,
};
use stillbase::settings::change::{join, single_change};
use stillbase::settings::key::KeyType;
use stillbase_query::QuickQuery as _;
use toml::Table;

use crate::support::Noise;

fn case_3() -> Scenario {
    Scenario::builtin("case-3").expect("built in")
}

/// A session of each machine of the gallery, at rest at the start of a task of its own.
fn gallery() -> impl Iterator<Item = (Machine, Session)> {
    builtins().iter().map(|machine| {
        let session = Session::open(for_machine(&case_3(), machine)).expect("it opens");
        (machine.clone(), session)
    })
}

/// Does what a proposal says, as its button does.
fn take(session: &mut Session, proposal: &Proposal) {
    let edits = proposal.edits();
    assert!(!edits.is_empty(), "{proposal:?}");
    for edit in edits {
        session.apply(edit).unwrap_or_else(|why| panic!("{proposal:?}: {why}"));
    }
    session.end_gesture();
}

/// A number out of the range of its key: the nearest allowed number is proposed, and the scenario starts with it.
#[test]
fn a_number_out_of_range_proposes_the_nearest_one() {
    // The length of a link that others share is set under its own name, which the refusal states; a second setting
    // cannot take back the first.
    let shared = |path: &str| path.starts_with("link.") && path.ends_with(".length");
    let scenario = case_3();
    let (mut tried, mut without) = (0, BTreeMap::new());
    for (path, key, _) in scenario.settings() {
        let Some(range) = key.range().filter(|range| range.high() < 1e300) else { continue };
        let past = 1.5 * range.high().abs() + 1.0;
        let value = match key.value_type {
            KeyType::Number(_) | KeyType::PerDrive(_) => Value::Float(past),
            KeyType::Whole(_) if past < 1e15 => Value::Integer(past as i64),
            KeyType::List(count, _) => vec![past; count].into(),
            _ => continue,
        };
        let wanted = single_change(&path, value);
        let changed = scenario.with_settings(&wanted);
        if changed.is_ok_and(|changed| changed.check("").is_ok()) {
            continue;
        }
        tried += 1;
        let found = proposals_for_settings(&scenario, &wanted);
        for proposal in &found {
            let whole = join(wanted.clone(), proposal.change().expect("settings"));
            let changed = scenario.with_settings(&whole).unwrap_or_else(|why| panic!("{proposal:?}: {why}"));
            changed.check("").unwrap_or_else(|why| panic!("{proposal:?}: {why}"));
            Run::new(&changed).unwrap_or_else(|why| panic!("{proposal:?}: {why}"));
        }
        if found.is_empty() && !shared(&path) {
            without.insert(path, wanted);
        }
    }
    assert!(tried > 40, "only {tried} keys");
    assert!(without.is_empty(), "{} of {tried} without a way out: {without:#?}", without.len());
}

/// Words that are no choice of a key, and bounds in the wrong order, have a way out too.
#[test]
fn a_wrong_word_proposes_the_nearest_one() {
    for (key, given, want) in [
        ("task.kind", Value::from("reactionles"), "take kind of motion = reactionless"),
        ("base.kind", "fre".into(), "take how the base is held = free"),
        ("limits.a1", vec![3.0, 0.2].into(), "take limits of angle a1 = 0.2, 3.0 rad"),
        ("task.time", "soon".into(), "keep duration from A to B = 1 s"),
        ("task.shape", "xyzzy".into(), "keep shape of the path = default"),
    ] {
        let found = proposals_for_settings(&case_3(), &single_change(key, given));
        assert_eq!(found.first().map(|one| one.text.as_str()), Some(want), "{key}: {found:?}");
    }
}

/// A target out of reach: to go to the nearest point, or to the b that reaches it, makes the target reachable.
#[test]
fn a_target_out_of_reach_has_ways_out() {
    let mut noise = Noise::of(907);
    let mut seen = 0;
    for (machine, session) in gallery().filter(|(_, session)| session.run().pose_space().is_ok()) {
        let reach = session.run().pose_space().expect("a space").farthest();
        for _ in 0..4 {
            let mut session = session.clone();
            let size = 1.6 * reach;
            let (x, y) = (noise.between(-size, size), noise.between(-size, size));
            session.apply(Edit::DragTarget { x, y }).expect("any place");
            session.end_gesture();
            session.tick(2500);
            let Some(missed) = session.missed_target() else { continue };
            let found = TargetProposals::answer(&missed);
            assert!(found.iter().any(|one| one.text.starts_with("go to the nearest point")), "{found:?}");
            for proposal in &found {
                seen += 1;
                let mut session = session.clone();
                take(&mut session, proposal);
                session.tick(6000);
                let target = session.frame().target;
                let is_off =
                    matches!(target.reach, Reach::Outside { nearest, .. } if (nearest - target.at).norm() > 1e-3);
                assert!(!is_off, "{}: ({x}, {y}): {proposal:?}: {:?}", machine.name(), target);
            }
        }
    }
    assert!(seen > 20, "only {seen} proposals");
}

/// A b that does not serve the points: the nearest that does, or the points turned.
#[test]
fn a_b_that_does_not_serve_has_ways_out() {
    let mut noise = Noise::of(311);
    for (machine, session) in gallery() {
        let Ok(space) = session.run().pose_space().cloned() else { continue };
        for _ in 0..3 {
            let b = noise.between(-1.0, 2.0) * space.period();
            if session.nearest_feasible_b(b) == Some(b) {
                continue;
            }
            let found = session.proposals_for_b(b);
            assert!(!found.is_empty(), "{}: {b}", machine.name());
            for proposal in found {
                let mut session = session.clone();
                take(&mut session, &proposal);
                assert!(session.run().waiting().is_none(), "{}: {proposal:?}", machine.name());
            }
        }
    }
}

/// A base that floats turns while b changes: what is proposed brings the end effector to the target all the same, as
/// closely as the printed numbers say.
#[test]
fn a_floating_base_is_reckoned_with() {
    let mut noise = Noise::of(907);
    let (mut led, mut put) = (0, 0);
    for (machine, payload) in builtins().iter().flat_map(|machine| [(machine, false), (machine, true)]) {
        let mut base = "[base]\nkind = \"free\"\nmass = 30.0\ninertia = 2.5\ncom = [0.15, -0.1]".to_owned();
        if payload {
            base += "\n[plant.payload]\nmass = 0.3";
        }
        let changed = for_machine(&case_3(), machine).with_settings(&base.parse().expect("TOML"));
        let Ok(session) = Session::open(changed.expect("settings")) else { continue };
        let Ok(space) = session.run().pose_space().cloned() else { continue };
        let size = 1.2 * space.farthest();
        for _ in 0..6 {
            let mut session = session.clone();
            let (x, y) = (noise.between(-size, size), noise.between(-size, size));
            session.apply(Edit::DragTarget { x, y }).expect("any place");
            session.end_gesture();
            session.tick(4000);
            let (Some(missed), target) = (session.missed_target(), session.frame().target) else { continue };
            let found = TargetProposals::answer(&missed);
            assert!(found.iter().any(|one| one.text.starts_with("go to the nearest point")), "{found:?}");
            for proposal in found.iter().filter(|one| !one.text.starts_with("go to the nearest point")) {
                let mut session = session.clone();
                take(&mut session, proposal);
                let is_led = proposal.text.starts_with("go to (");
                if is_led {
                    assert!(!payload, "{proposal:?}: only a run tells how the base turns");
                    session.tick(9000);
                }
                let frame = session.frame();
                let verdict = Verdict::of(session.scenario(), frame);
                let distance = verdict.target_distance.expect("a target");
                assert!(distance < 1e-4, "{proposal:?}: {distance} m");
                let off = (frame.end_effector - target.at).norm();
                assert!(off < 1e-3, "{}, payload {payload}: {:?}: {off} m: {proposal:?}", machine.name(), target.at);
                (led, put) = (led + usize::from(is_led), put + usize::from(!is_led));
            }
        }
    }
    assert!(led > 8 && put > 8, "only {led} led and {put} put");
}

/// The base has turned with b: the end effector goes to the place in space at which the target is put, which the base
/// then carries along.
#[test]
fn a_target_rides_on_a_base_that_has_turned() {
    let base = "[base]\nkind = \"free\"\nmass = 20.0\ninertia = 1.0".parse().expect("TOML");
    let mut session = Session::open(case_3().with_settings(&base).expect("settings")).expect("it opens");
    let lead = |session: &mut Session, edit: Edit| {
        session.apply(edit).expect("the machine is led");
        session.end_gesture();
        session.tick(4000);
    };
    lead(&mut session, Edit::SlideB { b: 3.2 });
    assert!(session.frame().base.angle < -0.3, "the base turns: {}", session.frame().base.angle);
    let end = session.frame().end_effector;
    let put = end + Vector::new(-0.03, 0.02);
    lead(&mut session, Edit::DragTarget { x: put.re, y: put.im });
    let frame = session.frame();
    assert!((frame.end_effector - put).norm() < 1e-4, "{} is not at {put}", frame.end_effector);
    assert!((frame.target.at - put).norm() < 1e-12 && frame.target_rides);
    let angle = frame.base.angle;
    lead(&mut session, Edit::SlideB { b: 3.1 });
    let frame = session.frame();
    assert!(frame.base.angle > angle + 0.01);
    assert!((frame.target.at - put).norm() > 1e-3, "the base carries the target along");
    assert!((frame.end_effector - frame.target.at).norm() < 1e-4);
}

/// A run that waits has no b that serves A and B: a new b leaves them where they are, unless they may turn with it.
#[test]
fn a_new_b_leaves_the_points_of_a_waiting_run() {
    let off = "[task]\nb = 5.0".parse().expect("TOML");
    let mut session = Session::open_waiting(case_3().with_settings(&off).expect("settings")).expect("it opens");
    assert!(session.run().waiting().is_some());
    let points = session.scenario().task.points();
    session.apply(session.edit_of_b(50.0, false)).expect("the nearest b");
    assert_eq!(session.scenario().task.points(), points);
    let mut turned = session.clone();
    turned.apply(turned.edit_of_b(2.0, true)).expect("the points turn");
    assert_ne!(turned.scenario().task.points(), points);
    session.apply(session.edit_of_b(2.5, false)).expect("a b that serves them");
    assert!(session.run().waiting().is_none());
    assert_eq!(session.scenario().task.points(), points);
}

/// At the end of a run a b far away would turn the whole arm round: a question says how often, and its first answer
/// reaches the same without.
#[test]
fn whole_turns_are_asked_about() {
    let mut session = Session::open(case_3()).expect("it opens");
    session.tick(4000);
    let now = session.b_aim();
    let period = session.run().pose_space().expect("a space").period();
    for (turns, words) in [(1, "once"), (6, "6 times"), (-3, "3 times")] {
        let b = now + 0.3 + f64::from(turns) * period;
        let (why, answers) = session.question_of_turns(b).expect("whole turns");
        assert!(why.contains(words), "{why}");
        let mut led = session.clone();
        take(&mut led, &answers[0]);
        assert!((led.b_aim() - now - 0.3).abs() < 1e-3, "{answers:?}");
        take(&mut session.clone(), &answers[1]);
    }
    assert_eq!(session.question_of_turns(now + 0.4 * period), None);
}

/// A b typed far away: first the one in the period of the present b, then the nearest one of all.
#[test]
fn a_b_far_away_is_brought_back() {
    for (machine, session) in gallery() {
        let Ok(space) = session.run().pose_space().cloned() else { continue };
        let now = session.b_aim();
        for b in [now + 8.6 * space.period(), now - 5.4 * space.period(), 50.0, -30.0] {
            let asked = session.in_this_period(b);
            assert!((asked - now).abs() <= 0.5 * space.period() + 1e-9, "{asked}");
            let Some(nearest) = session.nearest_feasible_b(asked).filter(|_| session.nearest_feasible_b(b) != Some(b))
            else {
                continue;
            };
            let found = session.proposals_for_b(b);
            let mut taken = session.clone();
            take(&mut taken, &found[0]);
            assert!((taken.b_aim() - nearest).abs() < 1e-3, "{}: {b}: {found:?}", machine.name());
            assert_eq!(taken.scenario().task.points(), session.scenario().task.points(), "{found:?}");
        }
    }
    let session = Session::open(case_3()).expect("it opens");
    let words = |b: f64| session.proposals_for_b(b).into_iter().map(|one| one.text).collect::<Vec<_>>();
    assert_eq!(words(50.0)[..1], words(50.0 - 7.0 * session.run().pose_space().expect("a space").period())[..1]);
    // Less than half a period away, the nearest one is what is meant.
    let near = words(0.3);
    assert_eq!(near.len(), 2, "{near:?}");
}

/// Joint limits in the way of a task: they are made as wide as the motion needs.
#[test]
fn limits_in_the_way_are_made_wider() {
    let mut seen = 0;
    for name in ["case-1", "case-2", "case-3", "least-reaction", "spacecraft", "circle", "serial-3r", "scara"] {
        let scenario = Scenario::builtin(name).expect("built in");
        for angle in scenario.machine.angles().iter().map(|angle| angle.name.clone()).collect::<Vec<_>>() {
            for limits in [[0.4, 1.2], [1.5, 2.7], [0.9, 1.4]] {
                let wanted = single_change(&format!("limits.{angle}"), limits.to_vec());
                let Ok(changed) = scenario.with_settings(&wanted) else { continue };
                let Err(why) = Run::new(&changed) else { continue };
                let named = why.to_string().contains("limit");
                let found = proposals(&changed, &why);
                let wider = found.iter().find(|one| one.text.contains("limits of angle"));
                if let Some(wider) = wider {
                    seen += 1;
                    let whole = changed.with_settings(wider.change().expect("settings")).expect("settings");
                    Run::new(&whole).unwrap_or_else(|why| panic!("{wider:?}: {why}"));
                }
                assert!(wider.is_some() || !named, "{name} {angle} {limits:?}: {why}: {found:?}");
            }
        }
    }
    assert!(seen > 15, "only {seen}");
}

/// A joint limit tightened while a hand leads: the limit is put back, or made as tight as the pose lets it.
#[test]
fn a_limit_that_leaves_out_the_pose_has_two_ways_out() {
    let mut seen = 0;
    for (machine, mut session) in gallery().filter(|(_, session)| session.can_be_dragged()) {
        let at = session.frame().end_effector;
        session.apply(Edit::DragTarget { x: 0.97 * at.re, y: 0.97 * at.im }).expect("near");
        session.end_gesture();
        session.tick(300);
        session.pause();
        let frame = *session.frame();
        for angle in machine.angles() {
            let now = frame.q[angle.to] - frame.q[angle.from] + angle.offset;
            let (low, high) = (*angle.limits.start(), *angle.limits.end());
            let tight = now - 0.2;
            if !(low.is_finite() && high.is_finite() && tight > low + 0.05) {
                continue;
            }
            let mut session = session.clone();
            let key = format!("limits.{}", angle.name);
            if session.apply(Edit::set(&key, vec![low, tight])).is_err() {
                continue;
            }
            session.end_gesture();
            let Some(outside) = session.outside_limits() else { continue };
            assert_eq!(outside.proposals.len(), 2, "{outside:?}");
            assert!(outside.why.starts_with(&format!("{} is at ", angle.name)), "{outside:?}");
            for proposal in &outside.proposals {
                seen += 1;
                let mut session = session.clone();
                take(&mut session, proposal);
                assert_eq!(session.outside_limits(), None, "{}: {proposal:?}", machine.name());
            }
        }
    }
    assert!(seen >= 2, "only {seen} proposals");
}

/// A point that no b reaches is moved to the nearest place from which the task can be run.
#[test]
fn a_point_that_no_b_reaches_is_moved() {
    for (machine, session) in gallery() {
        let Ok(space) = session.run().pose_space().cloned() else { continue };
        let far = 1.3 * space.farthest();
        let scenario = session.scenario().without_edits();
        let wanted = single_change("task.to", vec![far, 0.1 * far]);
        let Ok(changed) = scenario.with_settings(&wanted) else { continue };
        let Err(why) = Run::new(&changed) else { continue };
        let found = proposals(&changed, &why);
        assert!(!found.is_empty(), "{}: {why}", machine.name());
        for proposal in &found {
            let settings = proposal.change().expect("settings");
            Run::new(&changed.with_settings(settings).expect("settings")).expect("it starts");
        }
    }
}

/// An edit of a file that is refused at its step: what is proposed lets the whole file run.
#[test]
fn a_refused_edit_proposes_what_lets_the_file_run() {
    let mut scenario = case_3();
    let text = "step = 0\ndo = \"set\"\nchange = { task = { b = 0.2 } }";
    let table: Table = text.parse().expect("TOML");
    scenario.edits = vec![stillbase::session::TimedEdit::from_table(table).expect("an edit")];
    let why = replay(&scenario, |_, _| {}).map(|_| ()).expect_err("refused");
    for proposal in proposals(&scenario, &why) {
        let changed = scenario.with_settings(proposal.change().expect("settings")).expect("settings");
        let done = replay(&changed, |_, _| {});
        assert!(done.is_ok() || !matches!(why, stillbase::session::Refusal::Edit { .. }), "{proposal:?}");
    }
}

/// After the plan has become shorter under way, the run does not keep the length of the earlier plan.
#[test]
fn a_run_has_the_length_of_its_plan_after_an_undo() {
    let mut session = Session::open(case_3()).expect("it opens");
    session.apply(Edit::set("task.time", 3.0)).expect("a time");
    session.end_gesture();
    session.play();
    session.tick(2000);
    assert!(session.is_playing() && session.length() == 3.0);
    session.undo().expect("undone");
    assert!((session.run().planned_time() - 1.0).abs() < 1e-12);
    assert!((session.length() - 1.0).abs() < 2e-3, "{} s for a plan of 1 s", session.length());
    assert!((session.frame().time - session.length()).abs() < 2e-3);
    // At rest, too: a shorter motion ends the run with it, and undo brings the longer run back as it was.
    let mut session = Session::open(case_3()).expect("it opens");
    session.play();
    session.tick(1200);
    session.pause();
    let before = session.frames().to_vec();
    session.apply(Edit::set("task.time", 0.5)).expect("a time");
    session.end_gesture();
    assert!((session.length() - 0.5).abs() < 2e-3, "{}", session.length());
    session.undo().expect("undone");
    assert!(*session.frames() == before, "the same frames");
}

/// The three statements on every scenario and machine, with and without a payload, a hand and a moving base: none calls
/// good what another calls bad without naming what does it.
#[test]
fn statements_agree() {
    let payload: Table = "[plant.payload]\nmass = 0.3".parse().expect("TOML");
    let base: Table = "[base]\nkind = \"free\"".parse().expect("TOML");
    let bare = Scenario::builtins().cloned();
    let machines = builtins().iter().map(|machine| for_machine(&case_3(), machine));
    for scenario in bare.chain(machines) {
        for change in [None, Some(&payload), Some(&base)] {
            let scenario = match change.map(|change| scenario.with_settings(change)) {
                None => scenario.clone(),
                Some(Ok(changed)) if changed.check("").is_ok() => changed,
                Some(_) => continue,
            };
            let Ok(mut session) = Session::open(scenario.clone()) else { continue };
            for slides in [false, true] {
                if slides && !session.can_be_dragged() {
                    continue;
                }
                if slides && session.run().pose_space().is_ok() {
                    let b = session.b_aim() + 0.4;
                    session.apply(Edit::SlideB { b }).expect("any b");
                    session.end_gesture();
                } else if slides {
                    let [x, y] = scenario.task.to;
                    session.apply(Edit::DragTarget { x, y }).expect("any target");
                    session.end_gesture();
                }
                session.play();
                for steps in [1, 300, 2500] {
                    session.tick(steps);
                    agree(&session, &format!("{} {change:?} slides {slides}, step {steps}", scenario.name));
                }
            }
        }
    }
}

fn agree(session: &Session, what: &str) {
    let (run, frame) = (session.run(), session.frames().last().expect("a frame"));
    let Statements { machine, plan, run: stated } = Statements::of(run, frame);
    let all = || format!("{what}: {machine:?} {plan:?} {stated:?}");
    let held = &run.scenario().plant.payload;
    if held.is_held(frame.time, 0.5 * run.scenario().step) {
        let built = run.scenario().plant.machine(&run.scenario().machine).expect("a machine");
        let moves = held.held_by(&built).expect("a machine");
        let balanced = stillbase::mechanics::machine::Inertia::of(&moves).is_balanced();
        assert_eq!(machine.outcome == StatusLight::Good, balanced, "{}", all());
    }
    // With machine and plan good, only what is neither of them can have moved the base, and it is named.
    let is_good = machine.outcome == StatusLight::Good && plan.outcome == StatusLight::Good;
    if is_good && stated.outcome == StatusLight::Bad {
        assert!(stated.why.contains("neither machine nor path"), "{}", all());
        let plain = run.scenario().plant == Default::default() && !run.scenario().base.moves();
        assert!(!plain || session.is_dragged(), "{}", all());
    }
    if stated.why.contains("a hand does this") {
        assert!(plan.outcome == StatusLight::Bad && plan.words.contains("turn"), "{}", all());
    }
    if stated.why.contains("the path does this") {
        assert!(plan.outcome == StatusLight::Bad && machine.outcome == StatusLight::Good, "{}", all());
    }
    if stated.why.contains("the machine") && stated.why.contains("not balanced") {
        assert_eq!(machine.outcome, StatusLight::Bad, "{}", all());
    }
    // A plan whose b is held says so if the run is off it.
    let off = (frame.b - frame.b_reference).abs();
    if plan.words.starts_with("holds b") {
        assert_eq!(plan.words.contains("the run is off"), off > 5e-4, "{}", all());
    }
}

/// Gears change what a turning base takes up, but not b: it is formed from the angles between drives and base.
#[test]
fn b_is_that_of_the_plan_on_every_base() {
    for (machine, session) in gallery() {
        let at_rest = |kind: &str| {
            let base = single_change("base.kind", kind);
            let scenario = session.scenario().without_edits().with_settings(&base).expect("settings");
            let session = Session::open(scenario).expect("it opens");
            session.frame().b
        };
        let fixed = at_rest("fixed");
        for kind in ["free", "compliant"] {
            let b = at_rest(kind);
            assert!((b - fixed).abs() < 1e-9, "{}, {kind}: {b}, fixed {fixed}", machine.name());
        }
    }
}

/// A drawing that is begun beside one of the same name has a name of its own.
#[test]
fn a_new_drawing_is_told_apart() {
    use stillbase::mechanics::sketch::Template;
    use stillbase::session::for_template;
    let first = for_template(&case_3(), Template::Blank);
    let second = for_template(&first, Template::Blank);
    let third = for_template(&second, Template::Blank);
    let names = [first, second, third].map(|scenario| scenario.sketch.expect("a drawing").name);
    assert_eq!(names, ["my arm", "my arm 2", "my arm"]);
}

/// Counterweights of a file may lie farther off the axes than the brief of its scenario says.
#[test]
fn a_brief_fits_the_counterweights_of_its_machine() {
    let machine = builtins()[0].set("counterweight", "default").unwrap_or_else(|_| builtins()[0].clone());
    let brief = case_3().design;
    assert_eq!(brief.fitting(&machine), brief);
    let mut spec = machine.spec().clone();
    let link = spec.links[0].name.clone();
    let weight = |across| stillbase::mechanics::machine::Counterweight {
        link: link.clone(),
        mass: 0.1,
        at: -0.1,
        across,
        radius: 0.01,
        ..Default::default()
    };
    spec.counterweights = vec![weight(0.02), weight(-0.03)];
    let off = Machine::new(spec).expect("a machine");
    assert_eq!(brief.fitting(&off).across, 0.03);
}
