//! Sessions drawn at random: edits of every kind, on every base and plant, between anything that is done to time.

use std::collections::BTreeSet;

use proptest::prelude::*;
use proptest::strategy::ValueTree as _;
use proptest::test_runner::TestRunner;
use stillbase::mechanics::machine::{Lump, PlaceOnLink, Shape};
use stillbase::mechanics::planar::PerDrive;
use stillbase::mechanics::sketch::{BarEnd, BarId, Body, PinId, SketchStep, Template};
use stillbase::session::parts::{new_lump, new_part, set_length};
use stillbase::session::scenario::{Note, NoteTime, Scenario, keys};
use stillbase::session::{Edit, Session, TimedEdit};
use stillbase::settings::key::Key;
use stillbase::simulation::plant::{BaseKind, DriveValues, Friction, Wheel};

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
    Bookmark(f64, bool),
    Note(Option<usize>, f64),
    DropNote(usize),
    Branch(usize),
    DropBranch(usize),
}

/// What an edit is of: its kind, and for settings the part they stand in. A kind that is new does not compile until it has
/// a name here, and is then missed by `every_kind_of_edit_is_drawn` until it is drawn.
fn name(edit: &Edit) -> String {
    match edit {
        Edit::DragTarget { .. } => "drag-target".into(),
        Edit::DragBlocks { .. } => "drag-blocks".into(),
        Edit::HandOver { .. } => "hand-over".into(),
        Edit::DragAngles { .. } => "drag-angles".into(),
        Edit::PullLink { .. } => "pull-link".into(),
        Edit::SlideB { .. } => "slide-b".into(),
        Edit::PoseB { .. } => "pose-b".into(),
        Edit::Push { .. } => "push".into(),
        Edit::Set { change } => change.keys().next().cloned().unwrap_or_default(),
        Edit::Sketch(_) => "sketch".into(),
    }
}

/// Keys of the plant: payloads, friction, limits of torque, links and lengths that differ, and what cannot be.
fn any_plant() -> impl Strategy<Value = Edit> {
    let number = |key: &'static str, range: std::ops::Range<f64>| {
        range.prop_map(move |x| Edit::set(&format!("plant.{key}"), (x * 1e4).round() / 1e4)).boxed()
    };
    prop_oneof![
        3 => number("payload.mass", 0.0..0.5),
        1 => number("payload.from", 0.0..0.3),
        1 => number("payload.until", 0.3..0.8),
        1 => number("friction.viscous", 0.0..0.5),
        1 => number("friction.coulomb", 0.0..0.3),
        1 => number("friction.pin_viscous", 0.0..0.05),
        1 => number("friction.pin_coulomb", 0.0..0.02),
        1 => any::<bool>().prop_map(|on| Edit::set("plant.torque_limits", on)),
        1 => number("link.5.mass", 0.5..3.0),
        1 => number("length.l1", 0.49..0.51),
        1 => (-5.0..5.0, -5.0..5.0).prop_map(|(x, y)| Edit::set("plant.force", vec![x, y])),
        1 => prop::sample::select(vec!["payload.mass", "friction.coulomb", "force"]).prop_map(|key| Edit::set(&format!("plant.{key}"), "default")),
        1 => Just(Edit::set("plant.payload.mass", f64::NAN)),
    ]
}

fn any_base() -> impl Strategy<Value = Edit> {
    prop_oneof![
        3 => prop::sample::select(vec!["fixed", "compliant", "free"]).prop_map(|kind| Edit::set("base.kind", kind)),
        1 => (5.0..80.0).prop_map(|mass: f64| Edit::set("base.mass", mass)),
        1 => (-0.2..0.2, -0.2..0.2).prop_map(|(x, y)| Edit::set("base.com", vec![x, y])),
        1 => (0.2..2.0).prop_map(|most: f64| Edit::set("base.wheel.torque_limit", most)),
        1 => Just(Edit::set("base.wheel", "default")),
        1 => Just(Edit::set("base.mass", -1.0)),
    ]
}

fn any_control() -> impl Strategy<Value = Edit> {
    prop_oneof![
        2 => (100.0..600.0, 10.0..50.0).prop_map(|(kp, kd)| gains(kp, kd)),
        1 => (0..4i64).prop_map(|steps| Edit::set("control.delay", 0.004 * steps as f64)),
        1 => prop::sample::select(vec![0.0, 125.0, 250.0]).prop_map(|rate| Edit::set("control.rate", rate)),
        1 => prop::sample::select(vec![0.0, 4096.0, 1e6]).prop_map(|counts| Edit::set("control.encoder", counts)),
        1 => prop::sample::select(vec!["computed-torque", "payload-compensation", "pd"]).prop_map(|law| Edit::set("control.law", law)),
        1 => any::<bool>().prop_map(|knows| Edit::set("control.knows_base", knows)),
        1 => Just(Edit::set("control.delay", 0.001)),
    ]
}

fn any_task() -> impl Strategy<Value = Edit> {
    prop_oneof![
        2 => (0.3..0.7, 0.4..1.0).prop_map(|(x, y)| Edit::set("task.to", vec![x, y])),
        1 => (0.5..0.6, 0.5..0.9).prop_map(|(x, y)| Edit::set("task.via", vec![vec![x, y]])),
        1 => prop::sample::select(vec!["joint-line", "line", "spline"]).prop_map(|shape| Edit::set("task.shape", shape)),
        1 => prop::sample::select(vec!["reactionless", "minimum-norm", "change-b"]).prop_map(|kind| Edit::set("task.kind", kind)),
        1 => prop::sample::select(vec!["quintic", "trapezoidal", "fastest"]).prop_map(|law| Edit::set("task.law", law)),
        1 => (2.2..2.7).prop_map(|b: f64| Edit::set("task.b", b)),
        1 => Just(Edit::of("task", toml::Table::new())),
        1 => Just(Edit::set("task.shape", "none")),
    ]
}

fn any_machine() -> impl Strategy<Value = Edit> {
    prop_oneof![
        2 => (1..3usize, 0.0..0.5, 2.5..3.1).prop_map(|(i, min, max)| set(&format!("limits.a{i}"), &format!("{min},{max}"))),
        1 => (-10.0..10.0).prop_map(|g| set("gravity", &format!("0,{g}"))),
        1 => (0.2..1.0).prop_map(|mass: f64| set("link.9.mass", &mass.to_string())),
        1 => (0.4..0.6).prop_map(|metres: f64| set("length.l1", &metres.to_string())),
        1 => (0.0..0.4).prop_map(|mass: f64| set("payload.mass", &mass.to_string())),
        1 => (1..4usize, 5.0..40.0).prop_map(|(k, most): (usize, f64)| set(&format!("drive.{k}.torque_limit"), &most.to_string())),
        1 => (1..4usize).prop_map(|k| Edit::set(&format!("drive.{k}.speed_limit"), "default")),
        1 => Just(set("limits.a1", "3,1")),
        1 => (0.05..2.0, -0.3..0.3).prop_map(|(mass, at)| weight(mass, at)),
        1 => Just(Edit::set("counterweight", "default")),
        1 => (0.01..0.06).prop_map(|width: f64| list("part", &format!("shape = 'flat', width = {width}, thickness = 0.01"))),
        1 => (0.01..0.06).prop_map(|width: f64| Edit::set("part.1.width", width)),
        1 => Just(Edit::set("part", "default")),
        1 => (0.1..2.0).prop_map(|mass: f64| list("lump", &format!("mass = {mass}, at = 'tip'"))),
        1 => prop::sample::select(vec!["mass", "com", "com_normal", "inertia"])
            .prop_map(|number| Edit::set(&format!("link.1.{number}"), "default")),
        1 => (500.0..2e4).prop_map(|density: f64| set("material", &format!("[{{ name = 'pom', density = {density} }}]"))),
        1 => (-0.3..0.3).prop_map(|at| Edit::set("counterweight.1.at", at)),
    ]
}

/// One part or lump, on link 1.
fn list(kind: &str, keys: &str) -> Edit {
    set(kind, &format!("[{{ link = '1', {keys} }}]"))
}

/// One counterweight, on link 1.
fn weight(mass: f64, at: f64) -> Edit {
    let numbers = [("mass", mass), ("at", at), ("radius", 0.03)].map(|(key, x)| (key.to_owned(), x.into()));
    let link = [("link".to_owned(), "1".into())];
    let one = toml::Table::from_iter(numbers.into_iter().chain(link));
    Edit::set("counterweight", toml::Value::Array(vec![one.into()]))
}

/// What is asked of the machine while it is designed; no frame depends on it.
fn any_brief() -> impl Strategy<Value = Edit> {
    let hold = prop_oneof![
        Just(toml::Value::from("fixed")),
        Just("free".into()),
        (0.1..0.5).prop_map(|low: f64| vec![low, low + 0.2].into()),
        Just("default".into()),
    ];
    prop_oneof![
        any::<bool>().prop_map(|keeps| Edit::set("design.keep_balanced", keeps)),
        prop::option::of(0.0..0.01)
            .prop_map(|x| Edit::set("design.clearance", x.map_or_else(|| "default".into(), toml::Value::from))),
        (1e3..2e4).prop_map(|density: f64| Edit::set("design.density", density)),
        any::<bool>().prop_map(|is_fixed| Edit::set("design.fixed.9", is_fixed)),
        hold.prop_map(|hold| Edit::set("design.hold.link.5.mass", hold)),
        Just(Edit::set("design", "default")),
    ]
}

/// Steps of drawing: the pins of the nine-link machine are 0 to 8, its bars the next nine numbers.
pub fn any_sketch() -> impl Strategy<Value = Edit> {
    let pin = || (0..10u32).prop_map(PinId);
    let bar_id = || (8..20u32).prop_map(BarId);
    let place = || (-0.6..0.6, -0.2..1.2);
    prop_oneof![
        3 => (pin(), place()).prop_map(|(pin, (x, y))| SketchStep::MovePin { pin, to: [x, y] }),
        2 => (pin(), place()).prop_map(|(pin, (x, y))| SketchStep::Bar {
            from: BarEnd::pin(pin),
            to: BarEnd::At([x, y]),
            name: None
        }),
        1 => (pin(), pin()).prop_map(|(from, to)| SketchStep::Bar {
            from: BarEnd::pin(from),
            to: BarEnd::pin(to),
            name: None
        }),
        1 => (bar_id(), 0.02..0.3).prop_map(|(bar, along)| SketchStep::Split { bar, along }),
        1 => bar_id().prop_map(|bar| SketchStep::DeleteBar { bar }),
        1 => pin().prop_map(|pin| SketchStep::DeletePin { pin }),
        1 => (pin(), pin()).prop_map(|(pin, onto)| SketchStep::Weld { pin, onto }),
        1 => (pin(), bar_id()).prop_map(|(pin, bar)| SketchStep::Attach { pin, bar }),
        2 => (bar_id(), 0.1..0.6).prop_map(|(bar, metres)| SketchStep::Length { bar, metres }),
        1 => (bar_id(), 1..4u32).prop_map(|(bar, k)| SketchStep::Follow { bar, drive: Some(k.to_string()) }),
        1 => (1..4u32, 0.0..1e-4, 1.0..50.0)
            .prop_map(|(k, inertia, ratio)| SketchStep::Gear { drive: k.to_string(), inertia, ratio }),
        1 => pin().prop_map(|pin| SketchStep::EndEffector { pin, bar: None }),
        1 => (bar_id(), bar_id()).prop_map(|(bar, with)| SketchStep::Join { bar, with }),
        1 => (1..4u32, 1..4u32, -3.0..0.0, 0.1..3.0).prop_map(|(to, from, low, span)| SketchStep::Limits {
            to: to.to_string(),
            from: from.to_string(),
            offset: 0.0,
            range: Some([low, low + span])
        }),
        1 => (bar_id(), prop::option::of(0.1..2.0)).prop_map(|(bar, mass)| SketchStep::Mass {
            bar,
            body: mass.map(|mass| Body { mass: Some(mass), ..Body::default() }),
            per_metre: 1.5
        }),
        1 => (9..18u32, 0.01..0.05, prop::bool::ANY).prop_map(|(bar, width, is_flat)| {
            let shape = if is_flat { Shape::Flat } else { Shape::Tube };
            let mut part = new_part(&(bar - 8).to_string(), shape, 0.3);
            set_length(&mut part, if is_flat { "width" } else { "diameter" }, width);
            SketchStep::Parts { bar: BarId(bar), parts: vec![part], lumps: vec![] }
        }),
        2 => (bar_id(), prop::option::of(1..3usize), prop::option::of((0.01..1.0, 0.0..0.3, -0.05..0.05)))
            .prop_map(|(bar, number, lump)| SketchStep::Lump {
                bar,
                number,
                lump: lump.map(|(mass, at, across)| Lump {
                    mass,
                    ..new_lump(&(bar.0 - 8).to_string(), PlaceOnLink::Metres(at), across)
                })
            }),
        1 => Just(SketchStep::New { template: Template::Pantograph }),
        1 => Just(SketchStep::New { template: Template::NineLinks }),
        1 => Just(SketchStep::New { template: Template::Blank }),
    ]
    .prop_map(Edit::Sketch)
}

fn any_edit() -> impl Strategy<Value = Edit> {
    let spread = |key: &str, value: toml::Value| Edit::at(&["tolerance", key], value);
    prop_oneof![
        6 => (-0.2..1.0, -0.2..1.2).prop_map(|(x, y)| drag(x, y)),
        3 => (-0.5..3.5, -0.5..3.5).prop_map(|(a1, a2)| Edit::DragAngles { a1, a2 }),
        // A machine by itself refuses it.
        1 => (0.0..1.0, 0.0..1.0).prop_map(|(x, y)| Edit::DragBlocks { targets: [("arm".into(), [x, y])].into() }),
        1 => Just(Edit::HandOver { from: "arm".into(), to: "other".into() }),
        1 => (0.0..1.0, 0.0..1.0).prop_map(|(x, y)| Edit::PullLink { link: "5".into(), along: 0.1, x, y }),
        3 => (1.8..3.2).prop_map(slide),
        2 => (2.2..2.7).prop_map(|b| Edit::PoseB { b }),
        2 => (-5.0..5.0, -5.0..5.0).prop_map(|(x, y)| Edit::Push { x, y }),
        1 => Just(Edit::Push { x: 0.0, y: 0.0 }),
        4 => any_plant(),
        3 => any_base(),
        3 => any_control(),
        3 => any_machine(),
        3 => any_task(),
        2 => any_sketch(),
        1 => (0.001..0.1).prop_map(move |most: f64| spread("moment_limit", most.into())),
        1 => Just(spread("link.*.com", toml::Value::Table(toml::Table::from_iter([("normal".into(), 0.001.into())])))),
        2 => any_brief(),
        1 => (0.3..1.5).prop_map(|time| Edit::set("task.time", time)),
        1 => prop::sample::select(vec![0.002, 0.004, 0.005]).prop_map(|step| Edit::set("step", step)),
        1 => (0.3..1.5).prop_map(|time| Edit::set("duration", time)),
        1 => (0.5..5.0).prop_map(|most| Edit::set("pose_acceleration", most)),
        1 => prop::option::of(0.0..7.0).prop_map(|b| Edit::set("compare_b", b.map_or_else(|| "default".into(), toml::Value::from))),
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
                viscous: DriveValues::All(0.05),
                coulomb: DriveValues::Own(PerDrive::from_fn(3, |k| 0.1 + 0.1 * k as f64)),
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
        1 => ((0..6u8), any::<bool>()).prop_map(|(tenths, on)| Act::Bookmark(0.1 * f64::from(tenths), on)),
        1 => (prop::option::of(0usize..3), -0.1..0.5).prop_map(|(known, time)| Act::Note(known, time)),
        1 => (0usize..3).prop_map(Act::DropNote),
        1 => (0usize..3).prop_map(Act::Branch),
        1 => (0usize..9).prop_map(Act::DropBranch),
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
            Self::Bookmark(time, on) => {
                // There may be as many as there can be.
                let _ = session.bookmark(*time, if *on { "here" } else { "" });
                Ok(())
            }
            Self::Note(known, time) => {
                // A time before the start is refused.
                let note = Note { text: format!("at {time}"), point: None, time: NoteTime::At(*time) };
                let before = session.notes().to_vec();
                if session.write_note(*known, note).is_err() {
                    assert_eq!(session.notes(), before);
                }
                Ok(())
            }
            Self::DropNote(index) => {
                session.remove_note(*index);
                Ok(())
            }
            Self::Branch(branch) => session.switch_branch_while(*branch, &mut |_| true),
            Self::DropBranch(branch) => {
                session.drop_branch(*branch);
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
    let again = open(session.to_scenario());
    prop_assert_eq!((again.forks(), again.bookmarks()), (session.forks(), session.bookmarks()));
    prop_assert_eq!(again.notes(), session.notes());
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
    let kinds = known.split_once("one of ").expect("the kinds").1;
    let kinds: BTreeSet<String> = kinds.split(", ").map(str::to_owned).collect();
    assert_eq!(kinds.len(), 10, "{kinds:?}");
    // Settings by the parts of the table of keys.
    let part = |key: &Key| key.path.split('.').next().map(str::to_owned);
    let known: BTreeSet<String> =
        kinds.iter().filter(|kind| *kind != "set").cloned().chain(keys().filter_map(part)).collect();
    let mut runner = TestRunner::deterministic();
    let edits = any_edit();
    let mut draw = || edits.new_tree(&mut runner).expect("a value").current();
    let drawn: Vec<Edit> = (0..2000).map(|_| draw()).collect();
    assert_eq!(drawn.iter().map(name).collect::<BTreeSet<_>>(), known);
    for edit in &drawn {
        let written = TimedEdit { step: 0, edit: edit.clone() }.to_table();
        let word = if matches!(edit, Edit::Set { .. }) { "set".into() } else { name(edit) };
        assert_eq!(written["do"].as_str(), Some(word.as_str()), "files call it so");
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

/// A window that only counts as seen: everything is laid out and nothing is drawn.
#[cfg(feature = "ui")]
struct Unseen {
    ctx: egui::Context,
    now: f64,
}

#[cfg(feature = "ui")]
impl Unseen {
    /// What a repaint draws but for the scene, which is a picture of its own, so much later, s.
    fn repaint(&mut self, app: &mut stillbase::app::AppState, later: f64) -> Vec<egui::Shape> {
        self.now += later;
        let input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(1440.0, 900.0))),
            time: Some(self.now),
            ..Default::default()
        };
        let output = self.ctx.run_ui(input, |ui| app.ui(ui));
        let shapes = output.shapes.into_iter().map(|clipped| clipped.shape);
        shapes.filter(|shape| !matches!(shape, egui::Shape::Callback(_))).collect()
    }
}

/// Whatever was done before, every answer that the window asks for is the one made afresh: with all that is derived
/// forgotten, it draws what it has drawn before.
#[cfg(feature = "ui")]
#[test]
fn what_any_window_shows_is_what_one_made_afresh_shows() {
    use stillbase::app::{AppState, Command, SessionCommand, Switch, ViewChange};
    use stillbase::picture::charts::choice::PlotChange;
    use stillbase::picture::scene::palette::Theme;
    use stillbase::picture::scene::views::ViewKind;

    let mut runner = TestRunner::deterministic();
    let charts = [
        PlotChange::Statistics(true),
        PlotChange::Plot("transmission/12".into()),
        PlotChange::Range(Some([0.05, 0.2])),
        PlotChange::Range(None),
        PlotChange::Against("Torque".into(), Some("tip/x".into())),
    ];
    let others = [
        Command::Session(SessionCommand::Undo),
        Command::Session(SessionCommand::Redo),
        Command::Session(SessionCommand::Seek(0.0)),
        Command::Session(SessionCommand::Seek(0.3)),
        Command::Session(SessionCommand::TogglePlay),
        Command::Session(SessionCommand::Step(-20)),
        Command::Session(SessionCommand::Branch(0)),
        Command::View(ViewChange::Switch(Switch::Compare, true)),
        Command::View(ViewChange::Switch(Switch::Compare, false)),
        Command::View(ViewChange::Switch(Switch::Equations, true)),
        Command::View(ViewChange::Switch(Switch::Equations, false)),
        Command::Session(SessionCommand::Bookmark(0.1, "here".into())),
        Command::Session(SessionCommand::BackToPath),
    ];
    let views = ViewKind::ALL.map(|view| Command::View(ViewChange::Kind(view)));
    let others: Vec<Command> =
        others.into_iter().chain(views).chain(charts.map(|it| Command::View(ViewChange::Charts(it)))).collect();
    let (mut done, mut drawn) = (0, 0);
    for _ in 0..3 {
        let start = Scenario { step: 0.005, ..any_start().new_tree(&mut runner).expect("drawn").current() };
        let Ok(mut app) = AppState::new(start, Theme::Dark) else { continue };
        let mut window = Unseen { ctx: egui::Context::default(), now: 0.0 };
        window.repaint(&mut app, 0.0);
        for i in 0..60 {
            let command = match i % 2 {
                0 => Command::Session(SessionCommand::Edit(any_edit().new_tree(&mut runner).expect("drawn").current())),
                _ => prop::sample::select(others.clone()).new_tree(&mut runner).expect("drawn").current(),
            };
            let before = app.session().to_scenario();
            app.carry_out(command.clone());
            app.carry_out(SessionCommand::EndGesture);
            if matches!(command, Command::Session(SessionCommand::Edit(Edit::Push { .. }))) {
                // How far the base will move is not foreseen again at each push: too many come one after the other.
                app.carry_out(SessionCommand::Undo);
                app.carry_out(SessionCommand::Redo);
            }
            done += usize::from(before != app.session().to_scenario());
            // Not before each is everything asked for.
            app.pass(0.1);
            if i % 3 == 0 {
                continue;
            }
            for _ in 0..4 {
                window.repaint(&mut app, 1.0);
            }
            let known = window.repaint(&mut app, 0.0);
            app.forget();
            window.repaint(&mut app, 0.0);
            let afresh = window.repaint(&mut app, 0.0);
            // What stands nowhere is the same in words alone.
            let differs = |known: &egui::Shape, afresh: &egui::Shape| {
                known != afresh && format!("{known:?}") != format!("{afresh:?}")
            };
            let first = known.iter().zip(&afresh).position(|(known, afresh)| differs(known, afresh));
            let said = |shapes: &[egui::Shape]| -> Vec<String> {
                let text = |shape: &egui::Shape| match shape {
                    egui::Shape::Text(text) => Some(text.galley.text().to_owned()),
                    _ => None,
                };
                shapes.iter().filter_map(text).collect()
            };
            let (one, other) = (said(&known), said(&afresh));
            let words = one.iter().zip(&other).find(|(one, other)| one != other);
            assert!(
                first.is_none() && known.len() == afresh.len(),
                "after {command:?}: {words:?}; {:?} in place of {:?}",
                first.map(|i| &known[i]),
                first.map(|i| &afresh[i])
            );
            drawn += known.len();
        }
    }
    assert!(done > 30 && drawn > 10_000, "{drawn} shapes of {done} changes");
}

/// No store of answers keeps itself: none is left of a window, nor of a recording. In a program of its own, where no other
/// test has one.
#[cfg(all(feature = "ui", feature = "record"))]
#[test]
fn no_store_of_answers_outlives_its_window() {
    use stillbase::app::{AppState, Command, SessionCommand, Switch, ViewChange};
    use stillbase::picture::scene::palette::Theme;
    use stillbase::picture::scene::views::ViewKind;
    use stillbase::query::Queries;

    const ALONE: &str = "STILLBASE_TEST_ALONE";
    if std::env::var_os(ALONE).is_none() {
        let this = "session::sitting::no_store_of_answers_outlives_its_window";
        let program = std::env::current_exe().expect("this program");
        let done = std::process::Command::new(program).args(["--exact", this]).env(ALONE, "1").output();
        let done = done.expect("it runs");
        let said = String::from_utf8_lossy(&done.stdout).into_owned();
        assert!(done.status.success() && said.contains("1 passed"), "{said}");
        return;
    }
    for name in ["case-3", "least-reaction", "four-drive"] {
        let Some(scenario) = Scenario::builtin(name) else { panic!("no {name}") };
        let mut app = AppState::new(scenario.clone(), Theme::Dark).expect("it starts");
        let mut window = Unseen { ctx: egui::Context::default(), now: 0.0 };
        let acts = [
            Command::Session(SessionCommand::TogglePlay),
            Command::View(ViewChange::Switch(Switch::Compare, true)),
            Command::View(ViewChange::Switch(Switch::Study, true)),
            Command::View(ViewChange::Switch(Switch::Equations, true)),
            Command::View(ViewChange::Switch(Switch::Equations, false)),
            Command::Session(SessionCommand::Edit(Edit::set("plant.payload.mass", 0.1))),
            Command::Session(SessionCommand::EndGesture),
            Command::View(ViewChange::Kind(ViewKind::Tower)),
            Command::View(ViewChange::Kind(ViewKind::Joints)),
            Command::Session(SessionCommand::Open(Box::new(scenario.clone()))),
            Command::Session(SessionCommand::Undo),
        ];
        for act in acts {
            app.carry_out(act);
            app.pass(0.1);
            window.repaint(&mut app, 0.1);
        }
        assert!(Queries::stores() > 0);
        drop(app);
        assert_eq!(Queries::stores(), 0, "a window of {name}");
        let folder = crate::folder::Folder::new(&format!("stores-{name}"));
        let brief = Scenario { duration: Some(0.05), ..scenario };
        let mut most = 0;
        let mut told = |_: stillbase::recording::RecordingProgress<'_>| {
            most = most.max(Queries::stores());
            true
        };
        let options = stillbase::recording::Options::default();
        stillbase::recording::record(&[brief], &folder.path("one.rrd"), &options, &mut told).expect("a recording");
        assert!(most > 0);
        assert_eq!(Queries::stores(), 0, "a recording of {name}");
    }
}

/// What is derived is of the session as it is: after each of many edits, every view shows what one made afresh shows.
#[cfg(feature = "ui")]
#[test]
fn views_of_any_sitting_are_those_made_afresh() {
    use stillbase::app::{AppState, Command, SessionCommand};
    use stillbase::picture::scene::options::ViewOptions;
    use stillbase::picture::scene::palette::Theme;
    use stillbase::picture::scene::views::{ViewKind, Views};

    let mut runner = TestRunner::deterministic();
    let (mut compared, mut made) = (0, 0);
    for _ in 0..4 {
        let start = any_start().new_tree(&mut runner).expect("drawn").current();
        let Ok(mut app) = AppState::new(start, Theme::Dark) else { continue };
        for i in 0..40 {
            let command = match i % 8 {
                5 => Command::Session(SessionCommand::EndGesture),
                6 => Command::Session(SessionCommand::Undo),
                7 => Command::Session(SessionCommand::Seek(0.0)),
                _ => Command::Session(SessionCommand::Edit(any_edit().new_tree(&mut runner).expect("drawn").current())),
            };
            let before = app.session().scenario().clone();
            app.carry_out(command.clone());
            made += usize::from(before != *app.session().scenario());
            app.pass(0.05);
            let (run, frame, options) = (app.session().run(), app.session().frame(), ViewOptions::default());
            let fresh = Views::of(run);
            for kind in ViewKind::ALL {
                let (shown, wanted) = (app.views(), &fresh);
                assert_eq!(shown.shows(kind), wanted.shows(kind), "{kind:?} after {command:?}");
                if wanted.shows(kind) {
                    let scenes = [shown, wanted].map(|views| views.scene(kind, frame, &options, &wanted.camera(kind)));
                    assert!(scenes[0] == scenes[1], "{kind:?} after {command:?}");
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 500 && made > 40, "{compared} scenes of {made} changes");
}
