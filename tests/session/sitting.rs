//! Sessions drawn at random: edits of every kind, on every base and plant, between anything that is done to time.

use std::collections::BTreeSet;

use proptest::prelude::*;
use proptest::strategy::ValueTree as _;
use proptest::test_runner::TestRunner;
use stillbase::mechanics::planar::PerDrive;
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, Session, TimedEdit};
use stillbase::simulation::plant::{BaseKind, Each, Friction, Wheel};

use super::{coarse, drag, gains, one_path, open, set, slide, state};

/// What can happen to a session.
#[derive(Clone, Debug)]
enum Act {
    Edit(Edit),
    Tick(u64),
    Play,
    Pause,
    EndGesture,
    Undo,
    Redo,
    Seek(f64),
    StepBy(i64),
}

/// The name that a file has for an edit. A kind that is new does not compile until it has one here, and is then missed
/// by `every_kind_of_edit_is_drawn` until it is drawn.
fn name(edit: &Edit) -> &'static str {
    match edit {
        Edit::DragTarget { .. } => "drag-target",
        Edit::SlideB { .. } => "slide-b",
        Edit::PoseB { .. } => "pose-b",
        Edit::Push { .. } => "push",
        Edit::SetPlant { .. } => "set-plant",
        Edit::SetBase { .. } => "set-base",
        Edit::SetControl { .. } => "set-control",
        Edit::SetTolerance { .. } => "set-tolerance",
        Edit::SetMachine { .. } => "set-machine",
        Edit::SetTime { .. } => "set-time",
        Edit::SetTask { .. } => "set-task",
        Edit::CompareB { .. } => "compare-b",
    }
}

/// Keys of the plant: payloads, friction, limits of torque, links and lengths that differ, and what cannot be.
fn any_plant() -> impl Strategy<Value = Edit> {
    let number = |key: &'static str, range: std::ops::Range<f64>| {
        range.prop_map(move |x| Edit::plant(key, (x * 1e4).round() / 1e4)).boxed()
    };
    prop_oneof![
        3 => number("payload.mass", 0.0..0.5),
        1 => number("payload.from", 0.0..0.3),
        1 => number("payload.until", 0.3..0.8),
        1 => number("friction.viscous", 0.0..0.5),
        1 => number("friction.coulomb", 0.0..0.3),
        1 => number("friction.pin_viscous", 0.0..0.05),
        1 => number("friction.pin_coulomb", 0.0..0.02),
        1 => any::<bool>().prop_map(|on| Edit::plant("torque_limits", on)),
        1 => number("link.5.mass", 0.5..3.0),
        1 => number("length.l1", 0.49..0.51),
        1 => (-5.0..5.0, -5.0..5.0).prop_map(|(x, y)| Edit::plant("force", vec![x, y])),
        1 => prop::sample::select(vec!["payload.mass", "friction.coulomb", "force"]).prop_map(|key| Edit::plant(key, "default")),
        1 => Just(Edit::plant("payload.mass", f64::NAN)),
    ]
}

fn any_base() -> impl Strategy<Value = Edit> {
    prop_oneof![
        3 => prop::sample::select(vec!["fixed", "compliant", "free"]).prop_map(|kind| Edit::base("kind", kind)),
        1 => (5.0..80.0).prop_map(|mass: f64| Edit::base("mass", mass)),
        1 => (-0.2..0.2, -0.2..0.2).prop_map(|(x, y)| Edit::base("com", vec![x, y])),
        1 => (0.2..2.0).prop_map(|most: f64| Edit::base("wheel.torque_limit", most)),
        1 => Just(Edit::base("wheel", "default")),
        1 => Just(Edit::base("mass", -1.0)),
    ]
}

fn any_control() -> impl Strategy<Value = Edit> {
    prop_oneof![
        2 => (100.0..600.0, 10.0..50.0).prop_map(|(kp, kd)| gains(kp, kd)),
        1 => (0..4i64).prop_map(|steps| Edit::control("delay", 0.004 * steps as f64)),
        1 => prop::sample::select(vec![0.0, 125.0, 250.0]).prop_map(|rate| Edit::control("rate", rate)),
        1 => prop::sample::select(vec![0.0, 4096.0, 1e6]).prop_map(|counts| Edit::control("encoder", counts)),
        1 => prop::sample::select(vec!["computed-torque", "payload-compensation", "pd"]).prop_map(|law| Edit::control("law", law)),
        1 => any::<bool>().prop_map(|knows| Edit::control("knows_base", knows)),
        1 => Just(Edit::control("delay", 0.001)),
    ]
}

fn any_task() -> impl Strategy<Value = Edit> {
    prop_oneof![
        2 => (0.3..0.7, 0.4..1.0).prop_map(|(x, y)| Edit::task("to", vec![x, y])),
        1 => (0.5..0.6, 0.5..0.9).prop_map(|(x, y)| Edit::task("via", vec![vec![x, y]])),
        1 => prop::sample::select(vec!["joint-line", "line", "spline"]).prop_map(|shape| Edit::task("shape", shape)),
        1 => prop::sample::select(vec!["reactionless", "minimum-norm", "change-b"]).prop_map(|kind| Edit::task("kind", kind)),
        1 => prop::sample::select(vec!["quintic", "trapezoidal", "fastest"]).prop_map(|law| Edit::task("law", law)),
        1 => (2.2..2.7).prop_map(|b: f64| Edit::task("b", b)),
        1 => Just(Edit::SetTask { change: toml::Table::new() }),
        1 => Just(Edit::task("shape", "none")),
    ]
}

fn any_machine() -> impl Strategy<Value = Edit> {
    prop_oneof![
        2 => (1..3usize, 0.0..0.5, 2.5..3.1).prop_map(|(i, min, max)| set(&format!("limits.a{i}"), &format!("{min},{max}"))),
        1 => (-10.0..10.0).prop_map(|g| set("gravity", &format!("0,{g}"))),
        1 => (0.2..1.0).prop_map(|mass: f64| set("link.9.mass", &mass.to_string())),
        1 => Just(set("limits.a1", "3,1")),
    ]
}

fn any_edit() -> impl Strategy<Value = Edit> {
    let spread = |key: &str, value: toml::Value| Edit::SetTolerance {
        change: toml::Table::from_iter([(key.to_owned(), value)]),
    };
    prop_oneof![
        6 => (-0.2..1.0, -0.2..1.2).prop_map(|(x, y)| drag(x, y)),
        3 => (1.8..3.2).prop_map(slide),
        2 => (2.2..2.7).prop_map(|b| Edit::PoseB { b }),
        2 => (-5.0..5.0, -5.0..5.0).prop_map(|(x, y)| Edit::Push { x, y }),
        1 => Just(Edit::Push { x: 0.0, y: 0.0 }),
        4 => any_plant(),
        3 => any_base(),
        3 => any_control(),
        3 => any_machine(),
        3 => any_task(),
        1 => (0.001..0.1).prop_map(move |most: f64| spread("moment_limit", most.into())),
        1 => Just(spread("link.*.com", toml::Value::Table(toml::Table::from_iter([("normal".into(), 0.001.into())])))),
        1 => (0.3..1.5).prop_map(|time| Edit::SetTime { time }),
        1 => prop::option::of(0.0..7.0).prop_map(|b| Edit::CompareB { b }),
    ]
}

/// Case 3 in coarse steps on any base, with or without a wheel, and a plant and control that are as the model or not.
fn any_start() -> impl Strategy<Value = Scenario> {
    let kind = prop::sample::select(vec![BaseKind::Fixed, BaseKind::Compliant, BaseKind::Free]);
    let wheel = prop::option::weighted(0.3, (0.2..2.0, 5.0..100.0));
    let differs = (prop::bool::weighted(0.3), prop::bool::weighted(0.3), prop::bool::weighted(0.3));
    let control = (prop::bool::weighted(0.3), 0..3u8);
    (kind, wheel, differs, control).prop_map(|(kind, wheel, (load, rubs, limits), (rounded, delay))| {
        let mut scenario = coarse();
        scenario.base.kind = kind;
        scenario.base.wheel = wheel.map(|(torque, speed)| Wheel {
            torque_limit: Some(torque),
            speed_limit: Some(speed),
            ..Wheel::default()
        });
        if load {
            (scenario.plant.payload.mass, scenario.plant.payload.from) = (0.3, 0.1);
            scenario.plant.payload.until = Some(0.5);
        }
        if rubs {
            scenario.plant.friction = Friction {
                viscous: Each::All(0.05),
                coulomb: Each::Own(PerDrive::from_fn(3, |k| 0.1 + 0.1 * k as f64)),
                pin_viscous: 0.01,
                pin_coulomb: 0.005,
            };
        }
        scenario.plant.torque_limits = limits;
        scenario.control.encoder = if rounded { 8192.0 } else { 0.0 };
        scenario.control.delay = 0.004 * f64::from(delay);
        scenario
    })
}

fn any_act() -> impl Strategy<Value = Act> {
    prop_oneof![
        10 => any_edit().prop_map(Act::Edit),
        8 => (0u64..30).prop_map(Act::Tick),
        3 => Just(Act::Play),
        1 => Just(Act::Pause),
        2 => Just(Act::EndGesture),
        2 => Just(Act::Undo),
        1 => Just(Act::Redo),
        1 => (0.0..0.5).prop_map(Act::Seek),
        1 => (-20i64..20).prop_map(Act::StepBy),
    ]
}

impl Act {
    /// What is refused must have left no trace.
    fn perform(&self, session: &mut Session) {
        let before = state(session);
        let done = match self {
            Self::Edit(edit) => session.apply(edit.clone()),
            Self::Undo => session.undo(),
            Self::Redo => session.redo(),
            Self::Tick(n) => {
                session.tick(*n);
                Ok(())
            }
            Self::Play => {
                session.play();
                Ok(())
            }
            Self::Pause => {
                session.pause();
                Ok(())
            }
            Self::EndGesture => {
                session.end_gesture();
                Ok(())
            }
            Self::Seek(t) => {
                session.seek(*t);
                Ok(())
            }
            Self::StepBy(n) => {
                session.step_by(*n);
                Ok(())
            }
        };
        if let Err(refusal) = done {
            assert!(!refusal.to_string().is_empty());
            assert!(state(session) == before, "{self:?} was refused ({refusal}) and has left its mark");
        }
    }
}

/// Replayed and opened again, a sitting gives equal frames.
fn sit(start: Scenario, acts: &[Act]) -> Result<(), TestCaseError> {
    let mut session = open(start);
    for act in acts {
        act.perform(&mut session);
        let waits = session.run().waiting().is_some();
        prop_assert!(waits || session.script().iter().all(|e| e.step < session.frames().len() as u64));
    }
    one_path(&session);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, max_shrink_iters: 200, ..ProptestConfig::default() })]

    /// Three hundred: a sitting takes a tenth of a second in a debug build. A thousand are in the long test.
    #[test]
    fn any_sitting_replayed_gives_equal_frames(
        start in any_start(),
        acts in prop::collection::vec(any_act(), 1..24),
    ) {
        sit(start, &acts)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, max_shrink_iters: 200, ..ProptestConfig::default() })]

    #[test]
    #[ignore = "long: a thousand sittings, two minutes in a debug build"]
    fn any_sitting_replayed_gives_equal_frames_often(
        start in any_start(),
        acts in prop::collection::vec(any_act(), 1..24),
    ) {
        sit(start, &acts)?;
    }
}

/// All that a file may name is drawn, and on every base.
#[test]
fn every_kind_of_edit_is_drawn() {
    let entry = toml::Table::from_iter([("step".to_owned(), 0.into()), ("do".to_owned(), "nothing".into())]);
    let known = TimedEdit::from_table(entry).expect_err("there is no such edit");
    let known: BTreeSet<&str> = known.split('`').skip(3).step_by(2).collect();
    assert!(known.len() >= 12, "{known:?}");
    let mut runner = TestRunner::deterministic();
    let edits = any_edit();
    let mut draw = || edits.new_tree(&mut runner).expect("a value").current();
    let drawn: Vec<Edit> = (0..2000).map(|_| draw()).collect();
    assert_eq!(drawn.iter().map(name).collect::<BTreeSet<_>>(), known);
    for edit in &drawn {
        let written = TimedEdit { step: 0, edit: edit.clone() }.to_table();
        assert_eq!(written["do"].as_str(), Some(name(edit)), "files call it so");
    }
    let mut runner = TestRunner::deterministic();
    let starts = any_start();
    let starts: Vec<Scenario> = (0..500).map(|_| starts.new_tree(&mut runner).expect("a value").current()).collect();
    for kind in [BaseKind::Fixed, BaseKind::Compliant, BaseKind::Free] {
        for wheel in [false, true] {
            assert!(starts.iter().any(|s| s.base.kind == kind && s.base.wheel.is_some() == wheel), "{kind:?}, {wheel}");
        }
    }
    let seen = |what: &dyn Fn(&Scenario) -> bool| starts.iter().any(what) && !starts.iter().all(what);
    assert!(seen(&|s| s.plant.payload.mass > 0.0) && seen(&|s| s.plant.torque_limits));
    assert!(seen(&|s| s.plant.friction.pin_coulomb > 0.0));
    assert!(seen(&|s| s.control.encoder > 0.0) && seen(&|s| s.control.delay > 0.0));
}
