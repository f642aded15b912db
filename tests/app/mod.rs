//! The desk as a person meets it: widgets by label, the pointer in the scene, keys, and what it looks like.

use egui::accesskit::Role;
use egui::{Key, Modifiers, pos2};
use egui_kittest::{Harness, kittest::NodeT as _, kittest::Queryable as _};
use stillbase::app::AppState;
use stillbase::app::window::{App, Clock};
use stillbase::mechanics::planar::{PerDrive, unit};
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::pointer::Pointer;
use stillbase::picture::scene::stage::Handle;
use stillbase::picture::scene::sway::swayed;
use stillbase::picture::scene::views::ViewKind;
use stillbase::planning::reactionless::PlanePoint;
use stillbase::session::Edit;
use stillbase::session::scenario::Scenario;
use stillbase::simulation::frame::Reach;
use stillbase::simulation::plant::{Base, BaseKind, Each, Plant};

use super::gpu::gpu;

type Desktop = Harness<'static, App>;

/// A desk of 1280 by 800 on which every repaint lasts 20 ms; `None`, with the reason said, without an adapter.
fn desk(case: &str, theme: Theme) -> Option<Desktop> {
    desk_of(Scenario::builtin(case).expect("built in"), theme, 800.0)
}

/// The same of any scenario and height: what is scrolled out of view cannot be found.
fn desk_of(scenario: Scenario, theme: Theme, height: f32) -> Option<Desktop> {
    drop(gpu()?);
    let desk = AppState::new(scenario, theme).expect("it starts");
    Some(
        Harness::builder()
            .with_size([1280.0, height])
            .with_step_dt(0.02)
            .wgpu()
            .build_eframe(move |cc| App::new(cc, desk, Clock::Fixed(0.02)).expect("kittest draws with wgpu")),
    )
}

fn session(h: &Desktop) -> &stillbase::session::Session {
    h.state().app_state().session()
}

/// Where a point of the plane of handles is on the screen.
fn on_screen(h: &Desktop, x: f64, y: f64) -> egui::Pos2 {
    seen(h, [x, y, h.state().app_state().stage().handle_height()])
}

/// Where a point of the scene is on the screen.
fn seen(h: &Desktop, point: [f64; 3]) -> egui::Pos2 {
    let rect = h.get_by_label_contains("Scene:").rect();
    let desk = h.state().app_state();
    let aspect = f64::from(rect.width() / rect.height());
    let [u, v] = desk.look().camera().project(point, aspect).expect("in front of the eye");
    rect.min + egui::vec2(u as f32 * rect.width(), v as f32 * rect.height())
}

fn drag(h: &mut Desktop, from: egui::Pos2, to: egui::Pos2) {
    pull(h, from, to);
    h.drop_at(to);
    h.step();
}

/// A drag that is not let go.
fn pull(h: &mut Desktop, from: egui::Pos2, to: egui::Pos2) {
    h.hover_at(from);
    h.step();
    h.drag_at(from);
    h.step();
    for i in 1..=10 {
        h.hover_at(from + (to - from) * (i as f32 / 10.0));
        h.step();
    }
}

/// Opens the plant's section and has it hold a payload.
fn hold(h: &mut Desktop) {
    h.get_by_label("Plant section").click();
    h.run_steps(2);
    h.get_by_label("payload").click();
    h.run_steps(2);
    assert_eq!(session(h).scenario().plant.payload.mass, 0.3);
}

#[test]
fn playing_case_3_ends_at_b_without_a_reaction() {
    let Some(mut h) = desk("case-3", Theme::Dark) else { return };
    h.get_by_label("Play").click();
    h.run_steps(70);
    let f = session(&h).frame();
    assert_eq!(f.step, 1000, "the run stops by itself where the motion ends");
    assert!((f.tip.re - 0.55).abs() < 1e-6 && (f.tip.im - 0.9).abs() < 1e-6, "{:?}", f.tip);
    assert!(f.peaks.is_reactionless());
    assert!(h.query_by_label("reactionless").is_some());
    assert!(h.query_by_label("Pause").is_some(), "time still runs: sliding b now would move the machine");
    h.key_press(Key::Space);
    h.run_steps(2);
    h.key_press(Key::Space);
    h.run_steps(3);
    assert!(session(&h).frame().step < 200, "paused and played again, it starts over");
}

#[test]
fn dragging_the_target_moves_the_machine_on_its_plane() {
    let Some(mut h) = desk("case-3", Theme::Dark) else { return };
    h.step();
    let (from, to) = (on_screen(&h, 0.55, 0.9), on_screen(&h, 0.62, 0.55));
    h.get_by_label("Play").click();
    h.run_steps(70);
    drag(&mut h, from, to);
    h.run_steps(120);
    let f = session(&h).frame();
    assert_eq!(f.target.reach, Reach::Inside);
    assert!((f.tip.re - 0.62).abs() < 2e-3 && (f.tip.im - 0.55).abs() < 2e-3, "{:?}", f.tip);
    assert!(f.peaks.is_reactionless(), "n_B stays at zero: {:?}", f.peaks);
    assert!((f.b - 2.4).abs() < 1e-11);
}

#[test]
fn a_target_outside_says_why_and_what_b_would_do() {
    let Some(mut h) = desk("case-3", Theme::Light) else { return };
    h.get_by_label("Play").click();
    h.run_steps(70);
    let (from, to) = (on_screen(&h, 0.55, 0.9), on_screen(&h, 0.9, 0.85));
    drag(&mut h, from, to);
    h.run_steps(120);
    let f = *session(&h).frame();
    let Reach::Outside { nearest, mending_b, .. } = f.target.reach else { panic!("{:?}", f.target) };
    assert!((nearest - f.tip).norm() < 1e-6, "the machine waits at the nearest point");
    let b = mending_b.expect("another plane reaches it");
    let planes = session(&h).run().planes().expect("three drives").clone();
    assert!(
        !planes.map().poses(f.target.at, b + 1e-9).is_empty() || !planes.map().poses(f.target.at, b - 1e-9).is_empty()
    );
    assert!(h.query_by_label_contains("outside").is_some());
    h.snapshot("outside-light");
    h.get_by_label_contains("go to b").click();
    h.run_steps(150);
    let f = session(&h).frame();
    assert_eq!(f.target.reach, Reach::Inside, "the way out leads there");
    assert!((f.b - b).abs() < 1e-6);
}

#[test]
fn sliding_b_poses_at_rest_and_costs_a_moment_in_motion() {
    let Some(mut h) = desk("case-3", Theme::Dark) else { return };
    h.step();
    h.get_by_role_and_label(Role::Slider, "b slider").set_value_accesskit(2.6);
    h.run_steps(2);
    assert!((session(&h).frame().b - 2.6).abs() < 1e-9);
    assert_eq!(session(&h).frame().step, 0, "at rest it is posed");
    h.get_by_label("Play").click();
    h.run_steps(70);
    assert!(session(&h).frame().peaks.is_reactionless());
    // The motion is over but time runs: now the machine follows.
    h.get_by_role_and_label(Role::Slider, "b slider").set_value_accesskit(2.4);
    h.run_steps(100);
    let f = session(&h).frame();
    assert!((f.b - 2.4).abs() < 1e-6, "{}", f.b);
    assert!(f.peaks.moment > 1.0, "the price of b: {}", f.peaks.moment);
    assert!(matches!(session(&h).script().last().map(|e| &e.edit), Some(Edit::SlideB { .. })));
}

#[test]
fn keys_play_step_and_take_back() {
    let Some(mut h) = desk("case-3", Theme::Dark) else { return };
    h.step();
    h.key_press(Key::ArrowRight);
    h.step();
    assert_eq!(session(&h).frame().step, 1);
    h.key_press_modifiers(Modifiers::SHIFT, Key::ArrowRight);
    h.step();
    assert_eq!(session(&h).frame().step, 11);
    h.key_press(Key::Home);
    h.step();
    assert_eq!(session(&h).frame().step, 0);
    hold(&mut h);
    h.get_by_role_and_label(Role::Slider, "payload mass slider").set_value_accesskit(0.5);
    h.run_steps(2);
    assert!(session(&h).scenario().plant.payload.mass > 0.49);
    for _ in 0..2 {
        h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        h.run_steps(2);
    }
    assert_eq!(session(&h).scenario().plant.payload.mass, 0.0);
    h.key_press_modifiers(Modifiers::COMMAND, Key::Y);
    h.run_steps(2);
    h.key_press_modifiers(Modifiers::COMMAND, Key::Y);
    h.run_steps(2);
    assert!(session(&h).scenario().plant.payload.mass > 0.49);
    h.key_press(Key::Num1);
    h.run_steps(2);
    assert_eq!(session(&h).scenario().name, "case-1");
    h.key_press(Key::F1);
    h.run_steps(2);
    assert!(h.query_by_label("play, pause, start over").is_some());
}

#[test]
fn nothing_is_repainted_at_rest() {
    let Some(mut h) = desk("case-3", Theme::Dark) else { return };
    // `run` fails if the desk keeps asking for another repaint.
    h.run();
    h.hover_at(pos2(640.0, 400.0));
    h.run();
}

#[test]
fn case_1_in_motion_looks_as_it_should() {
    let Some(mut h) = desk("case-1", Theme::Dark) else { return };
    h.get_by_label("Play").click();
    h.run_steps(32);
    h.key_press(Key::Space);
    h.run_steps(4);
    assert!(h.query_by_label("reacts on its base").is_some());
    h.snapshot("case-1-dark");
    h.get_by_label("3D").click();
    h.run_steps(4);
    h.snapshot("case-1-dark-3d");
}

#[test]
fn opening_an_odd_scenario_changes_nothing_in_it() {
    let text = include_str!("../../assets/scenarios/case-3.toml")
        .replace("time = 1.0", "time = 20.0")
        .replace("[task]", "[control]\nkp = 20000.0\nkd = 1500.0\n\n[plant.payload]\nmass = 3.0\n\n[task]")
        .replace("compare_b = 5.0", "compare_b = 77.0");
    let scenario = Scenario::parse(&text, "odd", None).expect("odd but right");
    if gpu().is_none() {
        return;
    }
    let desk = AppState::new(scenario.clone(), Theme::Dark).expect("it starts");
    let mut h: Desktop = Harness::builder()
        .with_size([1280.0, 800.0])
        .wgpu()
        .build_eframe(move |cc| App::new(cc, desk, Clock::Fixed(0.02)).expect("kittest draws with wgpu"));
    h.run_steps(5);
    assert!(session(&h).script().is_empty(), "{:?}", session(&h).script());
    assert_eq!(session(&h).to_scenario(), scenario);
}

#[test]
fn escape_cancels_a_drag_and_takes_it_back() {
    let Some(mut h) = desk("case-3", Theme::Dark) else { return };
    h.step();
    // The handle is where it is drawn: on the end effector, at A.
    let (from, to) = (on_screen(&h, 0.5, 0.5), on_screen(&h, 0.6, 0.3));
    h.hover_at(from);
    h.step();
    h.drag_at(from);
    h.step();
    for i in 1..=5 {
        h.hover_at(from + (to - from) * (i as f32 / 5.0));
        h.step();
    }
    assert!(matches!(session(&h).script().last().map(|e| &e.edit), Some(Edit::DragTarget { .. })));
    h.key_press(Key::Escape);
    h.step();
    h.drop_at(to);
    h.run_steps(100);
    let f = session(&h).frame();
    assert!((f.tip - nalgebra::Complex::new(0.6, 0.3)).norm() > 0.1, "{}", f.tip);
}

/// Pulling in one view moves the session, so all of them follow.
#[test]
fn views_are_linked() {
    let Some(mut h) = desk("case-3", Theme::Dark) else { return };
    h.step();
    // The slice of the tower, pulled up by 0.2 rad at rest: posed there.
    h.get_by_label("Tower").click();
    h.run_steps(3);
    let tower = h.state().app_state().views().tower().expect("three drives").clone();
    let up = |x: f64, y: f64, b: f64| [x, y, b * tower.rise()];
    let (from, to) = (seen(&h, up(0.1, -0.1, 2.4)), seen(&h, up(0.1, -0.1, 2.6)));
    drag(&mut h, from, to);
    h.run_steps(2);
    let f = *session(&h).frame();
    assert!((f.b - 2.6).abs() < 0.01 && f.step == 0, "{} rad at step {}", f.b, f.step);
    // A click on the bar of A chooses that b; a single undo takes it back.
    let bar = seen(&h, up(0.5, 0.5, 2.25));
    h.hover_at(bar);
    h.step();
    h.drag_at(bar);
    h.step();
    h.drop_at(bar);
    h.run_steps(2);
    let chosen = session(&h).frame().b;
    assert!((chosen - 2.25).abs() < 0.01, "{chosen}");
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(2);
    assert!((session(&h).frame().b - f.b).abs() < 1e-9);
    // V goes back around to the machine by way of 2D and 3D; joint space comes third.
    for _ in 0..3 {
        h.key_press(Key::V);
        h.run_steps(2);
    }
    assert_eq!(h.state().app_state().look().view, ViewKind::Joints);
    // The dot in its plane: the end effector goes where that pose has it, without a reaction.
    let (frame, map) = (*session(&h).frame(), *session(&h).run().planes().expect("three drives").map());
    let space = h.state().app_state().views().joints().expect("three drives").clone();
    let at = |q: [f64; 3]| space.point(q, frame.b_reference);
    let a = [frame.a[0] + 0.4, frame.a[1] + 0.3];
    let (from, to) = (at([frame.q[0], frame.q[1], frame.q[2]]), at(map.lift(PlanePoint { a, b: frame.b_reference })));
    let (from, to) = (seen(&h, from), seen(&h, to));
    drag(&mut h, from, to);
    h.run_steps(120);
    let f = session(&h).frame();
    assert!((f.a[0] - a[0]).hypot(f.a[1] - a[1]) < 0.03, "{:?} for {a:?}", f.a);
    assert!(f.peaks.is_reactionless() && (f.b - frame.b).abs() < 1e-11);
}

#[test]
fn dexterity_is_shown_with_its_key_where_there_is_a_workspace() {
    let Some(mut h) = desk("case-3", Theme::Light) else { return };
    h.step();
    assert!(h.query_by_label("|det|").is_none());
    h.get_by_label("dexterity").click();
    h.run_steps(3);
    assert!(h.query_by_label("|det|").is_some() && h.query_by_label("0.139 m²").is_some());
    h.get_by_label("Tower").click();
    h.run_steps(3);
    assert!(h.query_by_label("dexterity").is_none());
    h.get_by_label("3D").click();
    h.run_steps(3);
    // One measure after the other, then none.
    for symbol in ["√det JJ*", "|τ|/|F|"] {
        h.key_press(Key::J);
        h.run_steps(3);
        assert!(h.query_by_label(symbol).is_some(), "{symbol}");
    }
    h.key_press(Key::J);
    h.run_steps(3);
    assert!(h.query_by_label("dexterity").is_some() && h.query_by_label("|det|").is_none());
}

/// A point of the path goes where it is dragged; where the target covers it, by its name.
#[test]
fn waypoints_are_handles() {
    let Some(mut h) = desk("case-3", Theme::Dark) else { return };
    h.step();
    let points = |h: &Desktop| session(h).scenario().task.points();
    // At rest at A the target covers A, so B is taken as it is and A by its letter.
    let (from, to) = (on_screen(&h, 0.55, 0.90), on_screen(&h, 0.60, 0.75));
    drag(&mut h, from, to);
    assert!((points(&h)[1].re - 0.60).abs() < 2e-3 && (points(&h)[1].im - 0.75).abs() < 2e-3, "{:?}", points(&h));
    let letter = egui::vec2(-17.0, 0.0);
    let (from, to) = (on_screen(&h, 0.50, 0.50) + letter, on_screen(&h, 0.45, 0.45));
    drag(&mut h, from, to);
    assert!((points(&h)[0].re - 0.45).abs() < 2e-3 && (points(&h)[0].im - 0.45).abs() < 2e-3, "{:?}", points(&h));
    assert!(!session(&h).is_live(), "nobody leads the machine");
    assert!((session(&h).frame().tip - points(&h)[0]).norm() < 1e-9, "it waits at A");
    // Each drag is one undo.
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(2);
    assert_eq!(points(&h)[0].re, 0.5);

    // Twice in the open: one more point; Delete over it: one less.
    let place = on_screen(&h, 0.62, 0.62);
    for _ in 0..2 {
        h.drag_at(place);
        h.drop_at(place);
        h.step();
    }
    h.run_steps(2);
    assert_eq!(points(&h).len(), 3, "{:?}", points(&h));
    assert!((points(&h)[1].re - 0.62).abs() < 2e-3 && (points(&h)[1].im - 0.62).abs() < 2e-3);
    assert!(h.query_by_label("1 x m").is_some(), "the panel lists it");
    h.hover_at(place);
    h.run_steps(2);
    h.key_press(Key::Delete);
    h.run_steps(2);
    assert_eq!(points(&h).len(), 2);
}

/// What cannot be followed is refused, shown, and mended by a button.
#[test]
fn a_refused_path_shows_where_and_what_b_would_do() {
    let Some(mut h) = desk("case-3", Theme::Dark) else { return };
    h.step();
    let change = stillbase::session::scenario::Change::from_iter([
        ("shape".to_owned(), "line".into()),
        ("from".to_owned(), vec![0.42, 1.12].into()),
        ("to".to_owned(), vec![0.0, 0.5].into()),
    ]);
    let before = session(&h).scenario().task.clone();
    h.state_mut().app_state_mut().carry_out(stillbase::app::Command::Edit(Edit::SetTask { change }));
    h.run_steps(2);
    assert_eq!(session(&h).scenario().task, before, "nothing has changed");
    assert!(h.query_by_label_contains("the path stops at (0.418, 1.116) m").is_some());
    h.snapshot("refused-dark");
    h.get_by_label_contains("take b").click();
    h.run_steps(3);
    let task = &session(&h).scenario().task;
    let message = &h.state().app_state().look().message;
    assert!((task.b - 2.5256).abs() < 1e-3 && task.to == [0.0, 0.5], "{task:?} {message:?}");
    assert!(h.query_by_label_contains("the path stops").is_none());
}

/// Drawn with the pencil, a path is followed.
#[test]
fn a_path_is_drawn_by_hand() {
    let Some(mut h) = desk("case-3", Theme::Dark) else { return };
    h.step();
    h.key_press(Key::P);
    h.run_steps(2);
    let curve = |t: f64| (0.5 + 0.12 * (2.0 * t).sin(), 0.5 + 0.3 * t);
    let at = |h: &Desktop, t: f64| {
        let (x, y) = curve(t);
        on_screen(h, x, y)
    };
    h.hover_at(at(&h, 0.0));
    h.step();
    h.drag_at(at(&h, 0.0));
    h.step();
    for i in 1..=30 {
        h.hover_at(at(&h, f64::from(i) / 30.0));
        h.step();
    }
    h.drop_at(at(&h, 1.0));
    h.run_steps(3);
    let task = &session(&h).scenario().task;
    assert_eq!(task.shape(), stillbase::session::scenario::Shape::Freehand);
    assert!(task.points().len() > 20, "{}", task.points().len());
    assert!(h.state().app_state().look().stroke.is_none(), "the pencil is laid down");
    h.get_by_label("Play").click();
    h.run_steps(70);
    let f = session(&h).frame();
    let (x, y) = curve(1.0);
    assert!((f.tip.re - x).hypot(f.tip.im - y) < 5e-3 && f.peaks.is_reactionless(), "{:?}", f.tip);
}

/// A scenario that cannot be planned still opens: the machine, what was asked for, and the way out.
#[test]
fn a_scenario_that_cannot_be_planned_is_explained() {
    if gpu().is_none() {
        return;
    }
    let scenario = Scenario::builtin("case-3").expect("built in");
    let keys = "shape = 'line'\nfrom = [0.42, 1.12]\nto = [0.0, 0.5]";
    let task = scenario.task.with(&toml::from_str(keys).expect("keys")).expect("a task");
    let asked = Scenario { task: task.clone(), ..scenario };
    assert!(AppState::new(asked.clone(), Theme::Dark).is_err());
    let mut desk = AppState::open_or_explain(asked, Theme::Dark).expect("explained");
    let (words, bad) = desk.look().message.clone().expect("a reason");
    assert!(bad && words.contains("the path stops at"), "{words}");
    let (edit, _) = desk.look().refused.as_ref().and_then(|wish| wish.remedy.clone()).expect("another b would do");
    desk.carry_out(stillbase::app::Command::Edit(edit));
    let done = &desk.session().scenario().task;
    assert_eq!((done.points(), done.shape()), (task.points(), task.shape()));
}

/// Every letter that the sources can put on the screen is in the fonts that come along.
#[test]
fn the_fonts_have_every_letter() {
    let Some(mut h) = desk("case-3", Theme::Dark) else { return };
    h.step();
    let mut letters = std::collections::BTreeSet::new();
    let mut folders = vec![std::path::PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/src"))];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.extend((!path.ends_with("commands") && !path.ends_with("headless")).then_some(path));
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = std::fs::read_to_string(path).expect("readable");
                let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
                letters.extend(code.flat_map(str::chars).filter(|c| !c.is_ascii()));
            }
        }
    }
    assert!(letters.len() > 30, "{letters:?}");
    for family in [egui::FontFamily::Proportional, egui::FontFamily::Name("bold".into())] {
        let font = egui::FontId::new(13.0, family);
        let missing: Vec<char> =
            letters.iter().copied().filter(|c| !h.ctx.fonts_mut(|fonts| fonts.has_glyph(&font, *c))).collect();
        assert!(missing.is_empty(), "{font:?}: {missing:?}");
    }
}

/// Runs side by side: by key, a row laid over, sorted by its head, this run kept; a second cursor shows differences.
#[test]
fn runs_stand_side_by_side() {
    let Some(mut h) = desk("case-1", Theme::Dark) else { return };
    h.run_steps(3);
    h.key_press(Key::C);
    h.run_steps(2);
    let board = |h: &Desktop| h.state().app_state().board().cloned();
    assert_eq!(board(&h).expect("on display").entries().len(), 5);
    h.get_by_label("Lay over: Reactionless").click();
    h.run_steps(2);
    assert_eq!(board(&h).expect("on display").shown().count(), 1);
    h.get_by_label("Sort by largest moment that the base feels").click();
    h.run_steps(2);
    assert_eq!(board(&h).expect("on display").sorted(), Some((1, false)));
    h.get_by_label("Keep this run").click();
    h.run_steps(2);
    assert!(board(&h).expect("on display").entries()[5].kept);
    h.get_by_label("Remove case-1").click();
    h.run_steps(2);
    assert_eq!(board(&h).expect("on display").entries().len(), 5);
    // The other way opens in place of this one.
    h.get_by_label("Open Reactionless").click();
    h.run_steps(2);
    assert_eq!(session(&h).scenario().task.kind, stillbase::session::scenario::TaskKind::Reactionless);
    h.key_press(Key::C);
    h.run_steps(2);
    assert!(board(&h).is_none());

    h.key_press(Key::S);
    h.run_steps(2);
    assert!(h.state().app_state().look().snapshots);
    let plot = h.get_by_label_contains("Torque over time").rect();
    h.event(egui::Event::ModifiersChanged(Modifiers::SHIFT));
    h.hover_at(plot.center());
    h.step();
    h.drag_at(plot.center());
    h.step();
    h.drop_at(plot.center());
    h.step();
    h.event(egui::Event::ModifiersChanged(Modifiers::NONE));
    h.run_steps(2);
    assert!(h.state().app_state().look().mark.is_some(), "a second cursor");
    assert!(h.query_all_by_label_contains("Δτ").count() > 0, "differences");
    h.key_press(Key::Escape);
    h.run_steps(2);
    assert!(h.state().app_state().look().mark.is_none());
}

/// Whatever differs in the plant is switched on, set and taken back in its section.
#[test]
fn what_differs_is_set_and_taken_back() {
    let Some(mut h) = desk_of(Scenario::builtin("case-3").expect("built in"), Theme::Dark, 1700.0) else { return };
    h.step();
    assert!(h.query_by_label("payload").is_none(), "folded while all is as the model");
    assert!(h.query_by_label("as the model").is_some());
    hold(&mut h);
    assert!(h.query_by_label("1 difference").is_some());
    for label in ["friction", "torque limits", "force"] {
        h.get_by_label(label).click();
        h.run_steps(2);
    }
    h.get_by_role_and_label(Role::Slider, "Coulomb slider").set_value_accesskit(0.05);
    h.run_steps(2);
    h.get_by_label("viscous per drive").click();
    h.run_steps(2);
    let plant = session(&h).scenario().plant.clone();
    assert_eq!(plant.friction.viscous, Each::Own(PerDrive::from_fn(3, |_| 0.02)));
    assert!((plant.friction.coulomb.of(3)[2] - 0.05).abs() < 1e-3 && plant.torque_limits && plant.force == [2.0, 0.0]);
    assert!(h.query_by_label("4 differences").is_some());
    assert!(h.query_by_label_contains("Friction over time").is_some(), "friction has a plot where there is some");
    // One at a time, then all.
    h.get_by_label("Coulomb back to normal").click();
    h.run_steps(2);
    assert_eq!(session(&h).scenario().plant.friction.coulomb, Each::All(0.0));
    h.get_by_label("Plant back to normal").click();
    h.run_steps(2);
    assert_eq!(session(&h).scenario().plant, Plant::default());
    assert!(h.query_by_label("payload").is_some(), "it does not fold under the hand");
    assert!(h.query_by_label_contains("Friction over time").is_none());
}

/// A link and a length that differ show what they would be in the model.
#[test]
fn a_link_that_differs_is_named() {
    let text = include_str!("../../assets/scenarios/case-3.toml")
        .replace("[task]", "[plant.link.5]\nmass = 2.5\n\n[plant.length]\nl1 = 0.51\n\n[task]");
    let scenario = Scenario::parse(&text, "differs", None).expect("right");
    let Some(mut h) = desk_of(scenario, Theme::Light, 1700.0) else { return };
    h.run_steps(3);
    assert!(h.query_by_label("2 differences").is_some(), "it opens unfolded");
    let reach = h.state().app_state().stage().linkage().reach();
    assert!((reach - 1.27).abs() < 1e-9, "drawn as it is: {reach}");
    h.get_by_label("link 5 mass back to normal").click();
    h.run_steps(2);
    assert!(session(&h).scenario().plant.link.get("5").is_none_or(|d| d.mass.is_none()));
    h.get_by_label("length l1 back to normal").click();
    h.run_steps(2);
    assert!(session(&h).scenario().plant.length.is_empty());
    assert!((h.state().app_state().stage().linkage().reach() - 1.26).abs() < 1e-9);
}

/// A base that floats is chosen, seen and plotted, and its motion exaggerated until it is seen.
#[test]
fn a_base_that_moves_is_seen_to_move() {
    let Some(mut h) = desk_of(Scenario::builtin("case-1").expect("built in"), Theme::Dark, 1700.0) else { return };
    h.step();
    assert!(h.query_by_label_contains("Base over time").is_none());
    h.get_by_label("Base section").click();
    h.run_steps(2);
    h.get_by_label("free").click();
    h.run_steps(2);
    assert_eq!(session(&h).scenario().base.kind, BaseKind::Free);
    assert!(h.query_by_label_contains("Base over time").is_some());
    let foreseen = h.state().app_state().look().sway();
    h.get_by_label("Play").click();
    h.run_steps(70);
    let f = *session(&h).frame();
    assert!(f.base.angle.abs() > 1e-3, "{:?}", f.base);
    assert_eq!(h.state().app_state().look().sway(), foreseen, "known before it plays, so that nothing jumps");
    let moved = foreseen * (f.totals.shift + f.totals.tilt * 1.26);
    assert!((0.04..0.13).contains(&moved), "{moved} m is seen, {foreseen} times");
    // The ring's knob is where it is drawn, and pulling it there asks for the same b.
    let shown = swayed(&f, foreseen);
    let stage = h.state().app_state().stage().clone();
    let at = stage.handle(Handle::Ring, &shown).expect("three drives");
    let b = stage.ring_b([at[0], at[1]], f.b_reference, &shown).expect("three drives");
    assert!((b - f.b_reference).abs() < 1e-12);
    h.key_press(Key::X);
    h.run_steps(2);
    assert_eq!(h.state().app_state().look().sway(), 1.0);
    h.get_by_label("Base back to normal").click();
    h.run_steps(2);
    assert_eq!(session(&h).scenario().base, Base::default());
}

/// With Alt the end effector is pushed while time passes; letting go ends the push, and all of it is one undo.
#[test]
fn a_hand_pushes_the_end_effector() {
    let Some(mut h) = desk("case-3", Theme::Dark) else { return };
    h.get_by_label("Play").click();
    h.run_steps(70);
    let tip = session(&h).frame().tip;
    let (from, to) = (on_screen(&h, tip.re, tip.im), on_screen(&h, tip.re - 0.2, tip.im));
    h.key_press(Key::U);
    h.run_steps(2);
    assert!(h.state().app_state().look().pushing);
    pull(&mut h, from, to);
    let pushed = session(&h).scenario().plant.force;
    assert!((pushed[0] + 4.0).abs() < 0.5 && pushed[1].abs() < 0.5, "{pushed:?} N for 0.2 m");
    h.run_steps(10);
    assert!((session(&h).frame().tip - tip).norm() > 1e-3, "it gives way: {}", session(&h).frame().tip);
    assert!(session(&h).frame().peaks.moment > 0.1, "a force that nobody planned reaches the base");
    h.drop_at(to);
    h.run_steps(60);
    assert_eq!(session(&h).scenario().plant.force, [0.0; 2]);
    assert!((session(&h).frame().tip - tip).norm() < 1e-3, "and returns");
    let again = stillbase::session::replay(&session(&h).to_scenario(), |_, _| {}).expect("it runs");
    assert_eq!(again.frame(), session(&h).run().frame(), "the push is in the script");
}

/// Six lamps say how far every audited figure is from zero.
#[test]
fn lamps_tell_the_audit() {
    let Some(mut h) = desk("case-3", Theme::Light) else { return };
    h.get_by_label("Play").click();
    h.run_steps(70);
    for figure in ["momentum", "angular", "energy", "loops", "step", "plane"] {
        let words = format!("audit {figure}:");
        let lamp = h.get_by_label_contains(&words);
        assert!(lamp.accesskit_node().label().is_some_and(|label| label.ends_with(", good")), "{figure}");
    }
    assert!(h.query_by_label_contains("cannot be trusted").is_none());
    let lamp = h.get_by_label_contains("audit energy:").rect().center();
    h.hover_at(lamp);
    h.run_steps(60);
    assert!(h.query_by_label_contains("energy − work + losses").is_some(), "its figure is under the pointer");
}

/// Tolerances by key: the panel shows them, a spread is set by its number, and they make room for runs side by side.
#[test]
fn tolerances_are_shown_and_set() {
    let Some(mut h) = desk("case-3", Theme::Dark) else { return };
    h.run_steps(3);
    h.key_press(Key::T);
    h.run_steps(2);
    assert!(h.query_by_label("Histogram of peaks of the base moment over machines, N m").is_some());
    assert!(h.query_by_label_contains("20000 machines, 41 numbers vary in each").is_some());
    h.get_by_label("Spread of limit on |n_B|, N m").set_value_accesskit(0.01);
    h.run_steps(3);
    assert_eq!(session(&h).scenario().tolerance.moment_limit, Some(0.01));
    assert!(h.query_by_label_contains("keep within limits").is_some());
    h.key_press(Key::C);
    h.run_steps(2);
    assert!(h.query_by_label_contains("Histogram").is_none() && h.state().app_state().board().is_some());
    h.key_press(Key::I);
    h.run_steps(2);
    assert!(h.query_by_label_contains("Pin forces over time").is_some());
}

/// How a drag arrives: a frame for each event, its release together with what comes after, or all of it at once.
#[derive(Clone, Copy, PartialEq)]
enum Arrival {
    Slowly,
    ReleasedLate,
    AtOnce,
}

/// A drag after which the pointer goes elsewhere.
fn arrive(h: &mut Desktop, how: Arrival, [from, to, after]: [egui::Pos2; 3]) {
    let button = |pos, pressed| egui::Event::PointerButton {
        pos,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    let moved = egui::Event::PointerMoved;
    let begun = [moved(from), button(from, true), moved(from + 0.5 * (to - from)), moved(to)];
    let rest = [button(to, false), moved(after)];
    for event in begun.into_iter().chain(rest.clone()) {
        h.input_mut().events.push(event.clone());
        let waits = match how {
            Arrival::Slowly => false,
            Arrival::ReleasedLate => event == rest[0],
            Arrival::AtOnce => event != rest[1],
        };
        if !waits {
            h.step();
        }
    }
    h.run_steps(4);
}

/// On a slow display press, drag, release and what the hand does then may come in one frame: each counts where it was.
#[test]
fn a_release_counts_where_the_button_came_up() {
    let outcome = |how: Arrival| {
        let mut h = desk("case-3", Theme::Dark)?;
        h.run_steps(2);
        let mut said = Vec::new();
        let slider = h.get_by_role_and_label(Role::Slider, "b slider").rect();
        let [low, high] = [slider.left() + 8.0, slider.right() - 8.0];
        let at = |share: f32| pos2(low + share * (high - low), slider.center().y);
        arrive(&mut h, how, [at(0.307), at(0.32), at(0.33)]);
        said.push(session(&h).frame().b);
        // The ring's knob, a little on; then the hand goes across the picture.
        let stage = h.state().app_state().stage().clone();
        let knob = |b: f64| {
            let p = stage.ring_radius() * unit(session(&h).run().planes().expect("planes").map().turn(b));
            on_screen(&h, p.re, p.im)
        };
        let way = [knob(session(&h).frame().b), knob(2.3), on_screen(&h, 0.5, -0.3)];
        arrive(&mut h, how, way);
        said.push(session(&h).frame().b);
        let way = [(0.55, 0.9), (0.57, 0.8), (0.3, 0.3)].map(|(x, y)| on_screen(&h, x, y));
        arrive(&mut h, how, way);
        let to = session(&h).scenario().task.to;
        said.extend(to);
        let time = h.get_by_role_and_label(Role::Slider, "Time").rect();
        let at = |share: f32| pos2(time.left() + 8.0 + share * (time.width() - 16.0), time.center().y);
        arrive(&mut h, how, [at(0.0), at(0.4), at(0.9)]);
        said.push(session(&h).frame().time);
        h.key_press(Key::Home);
        h.run_steps(2);
        h.key_press(Key::P);
        h.run_steps(2);
        let way = [(0.5, 0.5), (0.5, 0.8), (0.1, 0.2)].map(|(x, y)| on_screen(&h, x, y));
        arrive(&mut h, how, way);
        said.extend(session(&h).scenario().task.to);
        h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        h.run_steps(2);
        let way = [(0.5, 0.5), (0.45, 0.6), (0.2, 0.8)].map(|(x, y)| on_screen(&h, x, y));
        arrive(&mut h, how, way);
        let target = session(&h).frame().target.at;
        said.extend([target.re, target.im]);
        Some(said)
    };
    let Some(slowly) = outcome(Arrival::Slowly) else { return };
    assert!((slowly[1] - 2.3).abs() < 0.02 && (slowly[2] - 0.57).abs() < 2e-3, "{slowly:?}");
    assert!((slowly[4] - 0.4).abs() < 0.02 && (slowly[6] - 0.8).abs() < 2e-3, "{slowly:?}");
    assert!((slowly[7] - 0.45).abs() < 2e-3 && (slowly[8] - 0.6).abs() < 2e-3, "{slowly:?}");
    for how in [Arrival::ReleasedLate, Arrival::AtOnce] {
        let all = outcome(how).expect("as before");
        for (i, (x, y)) in slowly.iter().zip(&all).enumerate() {
            assert!((x - y).abs() < 1e-9, "number {i}: {x} slowly, {y} {}", how == Arrival::AtOnce);
        }
    }
}

/// Types into a field and leaves it.
fn type_into(h: &mut Desktop, label: &str, text: &str) {
    h.get_by_label(label).click();
    h.run_steps(2);
    h.event(egui::Event::Text(text.into()));
    h.step();
    h.key_press(Key::Enter);
    h.run_steps(3);
}

/// Paused, b stops where it would move A and B, unless that is asked for; what is typed and cannot be is said.
#[test]
fn b_leaves_the_task_as_it_is() {
    let Some(mut h) = desk("case-3", Theme::Dark) else { return };
    h.run_steps(2);
    let points = session(&h).scenario().task.points();
    let ends = session(&h).run().planes().expect("planes").common(&points).expect("a band").intervals[0];
    for (asked, stops) in [(3.6, ends[1]), (0.9, ends[0])] {
        h.get_by_role_and_label(Role::Slider, "b slider").set_value_accesskit(asked);
        h.run_steps(2);
        let task = &session(&h).scenario().task;
        assert!((task.b - stops).abs() < 1e-5, "{} for {asked}: it stops at {stops}", task.b);
        assert_eq!(task.points(), points);
    }
    for (text, words) in
        [("abc", "\"abc\" changes nothing"), ("-3", "from 0.000 to"), ("9e9", "from 0.000 to"), ("3.6", "A and B")]
    {
        let before = session(&h).to_scenario();
        type_into(&mut h, "b rad", text);
        let (said, bad) = h.state().app_state().look().message.clone().unwrap_or_else(|| panic!("{text} is refused"));
        assert!(bad && said.contains(words), "{said}");
        assert_eq!(session(&h).to_scenario(), before, "{text}");
    }
    type_into(&mut h, "b rad", "2.5");
    assert!((session(&h).frame().b - 2.5).abs() < 1e-9);
    assert!(h.state().app_state().look().message.is_none());
    h.get_by_label("turn the task too").click();
    h.run_steps(2);
    h.get_by_role_and_label(Role::Slider, "b slider").set_value_accesskit(3.6);
    h.run_steps(2);
    let task = session(&h).scenario().task.clone();
    assert!((task.b - 3.6).abs() < 1e-9 && (task.points()[0] - points[0]).norm() > 0.1, "{task:?}");
    assert!(h.query_by_label_contains("Scenario").is_some());
    // In motion it goes round and round; a whole turn is not shown.
    h.key_press(Key::Num3);
    h.run_steps(70);
    let period = session(&h).run().planes().expect("planes").map().period();
    h.state_mut().app_state_mut().carry_out(stillbase::app::Command::Edit(Edit::SlideB { b: 2.4 + period }));
    h.run_steps(2);
    assert!((session(&h).b_aim() - 2.4 - period).abs() < 1e-9);
    let value = h.get_by_role_and_label(Role::Slider, "b slider").accesskit_node().numeric_value();
    assert!(value.is_some_and(|b| (b - 2.4).abs() < 1e-9), "{value:?}");
}

/// Led by hand, the panel says so and leads back; the paper's cases come back whole.
#[test]
fn a_hand_is_named_and_let_go() {
    let Some(mut h) = desk("case-3", Theme::Dark) else { return };
    h.run_steps(2);
    let band = "A and B: b from";
    assert!(h.query_by_label_contains(band).is_some() && h.query_by_label("led by hand").is_none());
    let (from, to) = (on_screen(&h, 0.5, 0.5), on_screen(&h, 0.45, 0.62));
    drag(&mut h, from, to);
    h.run_steps(20);
    assert!(session(&h).is_live() && h.query_by_label("led by hand").is_some());
    assert!(h.query_by_label_contains(band).is_none() && h.query_by_label("planned").is_none());
    for by_key in [true, false] {
        match by_key {
            true => h.key_press(Key::B),
            false => h.get_by_label("back to the path").click(),
        }
        h.run_steps(3);
        assert!(!session(&h).is_live() && h.query_by_label_contains(band).is_some());
        assert_eq!(session(&h).frame().step, 0);
        assert!(session(&h).script().is_empty(), "{:?}", session(&h).script());
        h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        h.run_steps(3);
        assert!(session(&h).is_live(), "the hand comes back");
    }
    let gravity = Edit::SetMachine { key: "gravity".into(), value: "0,-9.81".into() };
    h.state_mut().app_state_mut().carry_out(stillbase::app::Command::Edit(gravity));
    h.key_press(Key::Num3);
    h.run_steps(2);
    assert_eq!(session(&h).to_scenario().machine, Scenario::builtin("case-3").expect("built in").machine);
    assert!(h.state().app_state().look().message.is_none());
    // Another machine that somebody has chosen stays, and that is said.
    let case = Scenario::builtin("case-3").expect("built in");
    let other = stillbase::mechanics::machine::builtins().iter().find(|m| m.name() == "nine-link-table-1");
    let other = other.unwrap_or_else(|| {
        panic!(
            "{:?}",
            stillbase::mechanics::machine::builtins().iter().map(|m| m.name().to_owned()).collect::<Vec<_>>()
        )
    });
    let open = stillbase::app::Command::Open(Box::new(Scenario { machine: other.clone(), ..case }));
    h.state_mut().app_state_mut().carry_out(open);
    h.key_press(Key::Num3);
    h.run_steps(2);
    let (said, bad) = h.state().app_state().look().message.clone().expect("it is said");
    assert!(!bad && said.contains(other.name()), "{said}");
    assert_eq!(session(&h).scenario().machine.name(), other.name());
}

/// The bar stands above the scene: in the default view nothing of the workspace, the machine or the target is covered.
#[test]
fn the_bar_covers_nothing() {
    for (width, height) in [(1280.0, 800.0), (960.0, 600.0), (1440.0, 900.0)] {
        let Some(mut h) = desk("case-3", Theme::Dark) else { return };
        h.set_size(egui::vec2(width, height));
        h.run_steps(4);
        let scene = h.get_by_label_contains("Scene:").rect();
        for label in ["2D", "Tower", "draw a path", "side by side"] {
            let rect = h.get_by_label(label).rect();
            assert!(rect.bottom() <= scene.top() && rect.right() <= scene.right(), "{label} {rect} {scene}");
        }
        let planes = session(&h).run().planes().expect("planes").clone();
        for p in planes.boundary().turned(planes.map().turn(2.4)).iter().flatten() {
            let at = on_screen(&h, p[0], p[1]);
            assert!(scene.contains(at), "{p:?} at {at} in {scene}, {width} by {height}");
        }
    }
}

/// Choosing what the machine stands on, or what it holds, moves nothing away from under the pointer.
#[test]
fn the_panel_holds_still() {
    let Some(mut h) = desk_of(Scenario::builtin("case-3").expect("built in"), Theme::Dark, 1700.0) else { return };
    h.run_steps(2);
    h.get_by_label("Base section").click();
    h.run_steps(2);
    let top = |h: &Desktop| ["Plant section", "Base section"].map(|label| h.get_by_label(label).rect().top());
    let before = top(&h);
    for kind in ["compliant", "free", "fixed"] {
        h.get_by_label(kind).click();
        h.run_steps(3);
        assert_eq!(top(&h), before, "{kind}");
    }
}

/// A list closes with Esc and nothing else does; a link says its name.
#[test]
fn lists_close_and_links_are_named() {
    let Some(mut h) = desk("case-3", Theme::Dark) else { return };
    h.run_steps(2);
    h.key_press(Key::U);
    h.run_steps(2);
    for list in ["Scenario", "Machine", "Speed", "Shape"] {
        h.get_by_label(list).click();
        h.run_steps(3);
        assert!(egui::Popup::is_any_open(&h.ctx), "{list} opens");
        h.key_press(Key::Escape);
        h.run_steps(3);
        assert!(!egui::Popup::is_any_open(&h.ctx), "{list} closes");
        assert!(h.state().app_state().look().pushing, "Esc was for the list");
    }
    h.key_press(Key::U);
    let frame = *session(&h).frame();
    let e = frame.q.units();
    let stage = h.state().app_state().stage().clone();
    for (i, bar) in stage.linkage().bars().iter().enumerate() {
        let [from, to] = bar.ends(&e);
        // Where no other link lies on it.
        let free = (1..20).map(|k| f64::from(k) / 20.0).map(|t| [0, 1, 2].map(|j| from[j] + t * (to[j] - from[j])));
        let alone = free.map(|p| seen(&h, p)).find(|at| {
            let scene = h.get_by_label_contains("Scene:").rect();
            let pair = |v: egui::Vec2| [f64::from(v.x), f64::from(v.y)];
            let camera = *h.state().app_state().look().camera();
            let pointer = Pointer { camera, size: pair(scene.size()), at: pair(*at - scene.min) };
            let views = h.state().app_state().views();
            views.link_at(&frame, &pointer) == Some(i) && views.pick(ViewKind::Flat, &frame, &pointer).is_none()
        });
        h.hover_at(alone.unwrap_or_else(|| panic!("{} is seen somewhere", bar.name)));
        h.run_steps(40);
        let words = format!("link {}, drive {}", bar.name, bar.drive + 1);
        assert!(h.query_by_label_contains(&words).is_some(), "{words}");
    }
}

/// A joint limit applies whatever the task: what no longer fits turns red, the run waits, and there are two ways out.
#[test]
fn limits_apply_and_the_run_waits() {
    let Some(mut h) = desk("case-3", Theme::Dark) else { return };
    h.run_steps(2);
    let red = |h: &Desktop| {
        let desk = h.state().app_state();
        let scene = desk.stage().scene(session(h).frame(), &Default::default());
        let named = scene.labels.iter().filter(|l| l.colour == desk.look().palette().reaction);
        named.map(|l| l.text.clone()).collect::<Vec<_>>()
    };
    for way_out in ["take b", "take back", "by hand"] {
        type_into(&mut h, "a₁ greatest °", "150");
        let limit = *session(&h).scenario().machine.angles()[0].limits.end();
        assert!((limit - 150f64.to_radians()).abs() < 1e-12, "{limit}");
        let waiting = session(&h).run().waiting().cloned().expect("B does not fit");
        let [(1, Some(b))] = waiting.points[..] else { panic!("{waiting:?}") };
        assert_eq!(red(&h), ["B".to_owned(), format!("b = {b} rad would reach it")]);
        assert!(h.query_by_label_contains("The run waits: B").is_some() && h.query_by_label("waits").is_some());
        if way_out == "take b" {
            h.snapshot("waits-dark");
        }
        h.key_press(Key::Space);
        h.run_steps(10);
        assert_eq!(session(&h).frame().step, 0, "time stands still");
        match way_out {
            "take b" => h.get_by_label_contains("take b").click(),
            "take back" => h.key_press_modifiers(Modifiers::COMMAND, Key::Z),
            _ => {
                let (from, to) = (on_screen(&h, 0.55, 0.9), on_screen(&h, 0.55, 0.7));
                drag(&mut h, from, to);
            }
        }
        h.run_steps(3);
        assert!(session(&h).run().waiting().is_none(), "{way_out}: {:?}", session(&h).run().waiting());
        assert!(red(&h).is_empty() && h.query_by_label_contains("The run waits").is_none());
        h.key_press(Key::Space);
        h.run_steps(70);
        assert!(session(&h).frame().step > 900 && session(&h).frame().peaks.is_reactionless(), "{way_out}");
        h.key_press(Key::Num3);
        h.run_steps(2);
        h.key_press(Key::Space);
        h.key_press(Key::Home);
        h.run_steps(2);
    }
}
