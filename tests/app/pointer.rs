//! The pointer in the scene: it drags, draws and pushes.

use egui::accesskit::Role;
use egui::{Key, Modifiers, pos2};
use egui_kittest::kittest::Queryable as _;
use stillbase::app::{AppState, Message, Preferences, SessionCommand, Tool};
use stillbase::mechanics::planar::unit;
use stillbase::picture::scene::options::Handle;
use stillbase::picture::scene::palette::Theme;
use stillbase::session::Edit;
use stillbase::session::scenario::Scenario;
use stillbase::simulation::frame::Reach;

use super::{Window, drag, on_screen, pull, session, type_into, window, written};
use crate::Test;

pub const TESTS: &[Test] = tests![
    dragging_the_target_moves_the_machine_on_its_plane,
    a_target_outside_says_why_and_what_b_would_do,
    machines_of_two_and_four_drives_are_dragged,
    an_arm_without_b_is_led_at_zero_momentum,
    a_machine_that_shakes_says_why_it_has_no_b,
    where_every_path_is_reactionless_the_tip_is_dragged_with_its_point,
    escape_cancels_a_drag_and_takes_it_back,
    the_moving_arm_is_caught_at_the_first_press,
    waypoints_are_handles,
    the_target_comes_before_the_point_that_it_covers,
    a_case_that_another_machine_cannot_do_brings_its_own,
    a_path_is_drawn_by_hand,
    a_hand_pushes_the_end_effector,
    a_hand_is_named_and_let_go,
    a_release_counts_where_the_button_came_up,
    a_key_before_a_press_does_not_give_up_the_drag,
];

fn dragging_the_target_moves_the_machine_on_its_plane() {
    let mut h = window("case-3", Theme::Dark);
    h.step();
    let (from, to) = (on_screen(&h, 0.55, 0.9), on_screen(&h, 0.62, 0.55));
    h.get_by_label("Play").click();
    h.run_steps(70);
    drag(&mut h, from, to);
    h.run_steps(120);
    let f = session(&h).frame();
    assert_eq!(f.target.reach, Reach::Inside);
    assert!((f.end_effector.re - 0.62).abs() < 2e-3 && (f.end_effector.im - 0.55).abs() < 2e-3, "{:?}", f.end_effector);
    assert!(f.peaks.is_reactionless(), "n_B stays at zero: {:?}", f.peaks);
    assert!((f.b - 2.4).abs() < 1e-11);
}

fn machines_of_two_and_four_drives_are_dragged() {
    for (name, to) in [("two-drive", [0.5, 0.2]), ("four-drive", [0.5, 0.6])] {
        let mut h = window(name, Theme::Dark);
        h.run_steps(2);
        let (b, at) = (session(&h).frame().b, session(&h).frame().end_effector);
        let (from, there) = (on_screen(&h, at.re, at.im), on_screen(&h, to[0], to[1]));
        drag(&mut h, from, there);
        h.run_steps(150);
        let f = *session(&h).frame();
        assert!((f.end_effector - at).norm() > 0.05, "{name} follows");
        assert!(f.peaks.is_reactionless() && (f.b - b).abs() < 1e-9, "{name}: {:?}", f.peaks);
        match f.target.reach {
            Reach::Outside { nearest, .. } if name == "two-drive" => {
                assert!((nearest - f.end_effector).norm() < 1e-6, "it waits on its curve");
            }
            Reach::Inside if name == "four-drive" => {
                assert!((f.end_effector.re - to[0]).hypot(f.end_effector.im - to[1]) < 3e-3, "{}", f.end_effector);
            }
            reach => panic!("{name}: {reach:?}"),
        }
        // The curve or the boundary is drawn, and turns with b.
        let edge = |h: &Window| {
            let scene = h.state().app_state().stage().scene(session(h).frame(), &Default::default());
            scene.lines.iter().find(|line| line.name == "workspace/boundary").expect("it is drawn").world_from_item
        };
        let before = edge(&h);
        type_into(&mut h, "b rad", "3");
        h.run_steps(150);
        assert!((session(&h).frame().b - 3.0).abs() < 1e-6, "{name}: {}", session(&h).frame().b);
        assert_ne!(edge(&h), before);
    }
}

/// From the start, where the target covers A, and from the middle of a run; far out it stops and says why.
fn an_arm_without_b_is_led_at_zero_momentum() {
    for plays in [false, true] {
        let mut h = window("spot", Theme::Dark);
        h.step();
        if plays {
            h.get_by_label("Play").click();
            h.run_steps(100);
            h.get_by_label("Pause").click();
        }
        h.run_steps(2);
        let (points, at) = (session(&h).scenario().task.points(), session(&h).frame().end_effector);
        let to = at + nalgebra::Complex::new(0.04, -0.06);
        let (from, there) = (on_screen(&h, at.re, at.im), on_screen(&h, to.re, to.im));
        drag(&mut h, from, there);
        h.run_steps(240);
        assert!(session(&h).is_dragged(), "plays {plays}");
        let f = *session(&h).frame();
        assert!((f.end_effector - to).norm() < 2e-3, "plays {plays}: {} {to}", f.end_effector);
        assert!(f.totals.base_angle < 1e-9 && f.base.at.norm() > 1e-4, "plays {plays}: {}", f.totals.base_angle);
        assert_eq!(session(&h).scenario().task.points(), points, "the points stay");
        let (from, far) = (on_screen(&h, f.end_effector.re, f.end_effector.im), on_screen(&h, -0.75, 0.5));
        drag(&mut h, from, far);
        h.run_steps(240);
        let f = *session(&h).frame();
        let Reach::Stopped { nearest, .. } = f.target.reach else { panic!("plays {plays}: {:?}", f.target) };
        assert!((nearest - f.end_effector).norm() < 1e-6 && f.totals.base_angle < 1e-9, "plays {plays}");
        assert!(h.query_by_label_contains("at zero momentum the end effector stops here").is_some());
    }
}

fn a_machine_that_shakes_says_why_it_has_no_b() {
    let mut h = window("scara", Theme::Dark);
    h.run_steps(2);
    assert!(h.query_all_by_label_contains("no pose constant b").next().is_some());
    assert!(h.query_by_label("b rad").is_none() && h.query_by_label("target x m").is_none());
}

/// No b is shown where there is none; the tip takes the end of the path along, which stays reactionless.
fn where_every_path_is_reactionless_the_tip_is_dragged_with_its_point() {
    let mut h = window("counter-rotating", Theme::Dark);
    h.get_by_label("Play").click();
    h.run_steps(70);
    assert!(h.query_all_by_label_contains("every motion of this machine is reactionless").next().is_some());
    assert!(h.query_by_label_contains("any path will do").is_some());
    assert!(h.query_by_label_contains("b 0.000").is_none() && h.query_by_label_contains("Pose constant").is_none());
    let at = session(&h).frame().end_effector;
    let from = on_screen(&h, at.re, at.im);
    let to = on_screen(&h, 0.3, 0.45);
    drag(&mut h, from, to);
    h.run_steps(4);
    let f = session(&h).frame();
    let [x, y] = session(&h).scenario().task.to;
    assert!((x - 0.3).abs() < 2e-3 && (y - 0.45).abs() < 2e-3, "{x}, {y}");
    assert!((f.end_effector.re - x).hypot(f.end_effector.im - y) < 1e-3, "the arm follows: {}", f.end_effector);
    assert!(f.peaks.is_reactionless());
}

fn a_target_outside_says_why_and_what_b_would_do() {
    let mut h = window("case-3", Theme::Light);
    h.get_by_label("Play").click();
    h.run_steps(70);
    let (from, to) = (on_screen(&h, 0.55, 0.9), on_screen(&h, 0.9, 0.85));
    drag(&mut h, from, to);
    h.run_steps(120);
    let f = *session(&h).frame();
    let Reach::Outside { nearest, feasible_b, .. } = f.target.reach else { panic!("{:?}", f.target) };
    assert!((nearest - f.end_effector).norm() < 1e-6, "the machine waits at the nearest point");
    let b = feasible_b.expect("another plane reaches it");
    let planes = session(&h).run().planes().expect("three drives").clone();
    assert!(
        !planes.map().poses(f.target.at, b + 1e-9).is_empty() || !planes.map().poses(f.target.at, b - 1e-9).is_empty()
    );
    assert!(h.query_by_label("the target is outside").is_some());
    h.snapshot("outside-light");
    h.get_by_label_contains("go to b").click();
    h.run_steps(150);
    let f = session(&h).frame();
    assert_eq!(f.target.reach, Reach::Inside, "the way out leads there");
    assert!((f.b - b).abs() < 1e-6);
}

fn escape_cancels_a_drag_and_takes_it_back() {
    let mut h = window("case-3", Theme::Dark);
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
    assert!((f.end_effector - nalgebra::Complex::new(0.6, 0.3)).norm() > 0.1, "{}", f.end_effector);
}

/// A point of the path goes where it is dragged; where the target covers it, by its name.
fn waypoints_are_handles() {
    let mut h = window("case-3", Theme::Dark);
    h.step();
    let points = |h: &Window| session(h).scenario().task.points();
    // At rest at A the target covers A, so B is taken as it is and A by its letter.
    let (from, to) = (on_screen(&h, 0.55, 0.90), on_screen(&h, 0.60, 0.75));
    drag(&mut h, from, to);
    assert!((points(&h)[1].re - 0.60).abs() < 2e-3 && (points(&h)[1].im - 0.75).abs() < 2e-3, "{:?}", points(&h));
    h.run_steps(2);
    let (from, to) = (written(&h, "A"), on_screen(&h, 0.45, 0.45));
    drag(&mut h, from, to);
    assert!((points(&h)[0].re - 0.45).abs() < 2e-3 && (points(&h)[0].im - 0.45).abs() < 2e-3, "{:?}", points(&h));
    assert!(!session(&h).is_dragged(), "nobody leads the machine");
    assert!((session(&h).frame().end_effector - points(&h)[0]).norm() < 1e-9, "it waits at A");
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

/// Drawn with the pencil, a path is followed.
/// Within its ring the target is held; the name of the point beside it moves the point, and hovering says which.
fn the_target_comes_before_the_point_that_it_covers() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let ring = on_screen(&h, 0.5, 0.5);
    let hot = |h: &mut Window, left: f32| {
        h.hover_at(ring - egui::vec2(left, 0.0));
        h.run_steps(40);
        h.state().app_state().view_state().pointed.object
    };
    for left in [0.0, 9.0, 13.0, -13.0] {
        assert_eq!(hot(&mut h, left), Some(Handle::Target), "{left} px left");
    }
    assert!(h.query_by_label_contains("target at 0.500, 0.500 m").is_some());
    let letter = ring.x - written(&h, "A").x;
    assert_eq!(hot(&mut h, letter), Some(Handle::Waypoint(0)));
    assert!(h.query_by_label_contains("start point A of the path").is_some());
    drag(&mut h, ring - egui::vec2(11.0, 0.0), ring + egui::vec2(-40.0, 0.0));
    assert!(session(&h).is_dragged() && session(&h).scenario().task.from == [0.5, 0.5]);
}

/// On two drives there is no case 3: it comes with the paper's machine, says so, and is undone.
fn a_case_that_another_machine_cannot_do_brings_its_own() {
    let mut h = window("two-drive", Theme::Dark);
    h.run_steps(2);
    h.key_press(Key::Num3);
    h.run_steps(4);
    assert_eq!((session(&h).scenario().name.as_str(), session(&h).scenario().machine.name()), ("case-3", "nine-link"));
    let Message { text: said, is_problem: bad } =
        h.state().app_state().view_state().status.message.clone().expect("it is said");
    assert!(!bad && said.contains("the paper's machine") && said.contains("two-drive cannot"), "{said}");
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(4);
    assert_eq!(session(&h).scenario().machine.name(), "two-drive");
}

/// A window at its very first start.
fn first_minute() -> Window {
    let mut h = window("case-3", Theme::Dark);
    let first = AppState::new(Scenario::builtin("case-3").expect("built in"), Theme::Dark).expect("it starts");
    *h.state_mut().app_state_mut() = first.with_preferences(&Preferences::default());
    h.set_size(egui::vec2(1440.0, 900.0));
    h.run_steps(3);
    h
}

/// A press near the tip, or anywhere on the arm, stops the demonstration and takes hold; one that misses moves nothing.
fn the_moving_arm_is_caught_at_the_first_press() {
    for aside in [egui::vec2(35.0, -30.0), egui::vec2(-45.0, 3.0)] {
        let mut h = first_minute();
        h.state_mut().app_state_mut().carry_out(SessionCommand::TogglePlay);
        h.run_steps(24);
        assert!(session(&h).is_moving());
        let camera = *h.state().app_state().view_state().camera();
        let scene = h.get_by_label_contains("Scene:").rect();
        drag(&mut h, scene.left_bottom() + egui::vec2(60.0, -200.0), scene.left_bottom() + egui::vec2(160.0, -90.0));
        assert_eq!(*h.state().app_state().view_state().camera(), camera, "a miss moves nothing");
        assert!(session(&h).is_moving() && !session(&h).is_dragged());
        h.run_steps(2);
        let at = session(&h).frame().end_effector;
        let from = on_screen(&h, at.re, at.im) + aside;
        h.hover_at(from);
        h.step();
        h.drag_at(from);
        h.run_steps(3);
        let stopped = session(&h).frame().step;
        h.run_steps(5);
        assert_eq!(session(&h).frame().step, stopped, "the loop has stopped");
        for i in 1..=10 {
            h.hover_at(from + egui::vec2(-3.0, 3.0) * i as f32);
            h.step();
        }
        h.drop_at(from + egui::vec2(-30.0, 30.0));
        h.run_steps(3);
        assert!(session(&h).is_dragged(), "and it follows");
        assert!(h.query_by_label("Now drag it out of the amber area.").is_some());
    }
}

fn a_path_is_drawn_by_hand() {
    let mut h = window("case-3", Theme::Dark);
    h.step();
    h.key_press(Key::P);
    h.run_steps(2);
    let curve = |t: f64| (0.5 + 0.12 * (2.0 * t).sin(), 0.5 + 0.3 * t);
    let at = |h: &Window, t: f64| {
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
    assert_eq!(task.shape(), stillbase::session::scenario::PathShape::Freehand);
    assert!(task.points().len() > 20, "{}", task.points().len());
    assert!(h.state().app_state().view_state().tool == Tool::Hold, "the pencil is laid down");
    h.get_by_label("Play").click();
    h.run_steps(70);
    let f = session(&h).frame();
    let (x, y) = curve(1.0);
    assert!(
        (f.end_effector.re - x).hypot(f.end_effector.im - y) < 5e-3 && f.peaks.is_reactionless(),
        "{:?}",
        f.end_effector
    );
}

/// With Alt the end effector is pushed while time passes; letting go ends the push, and all of it is one undo.
fn a_hand_pushes_the_end_effector() {
    let mut h = window("case-3", Theme::Dark);
    h.get_by_label("Play").click();
    h.run_steps(70);
    let tip = session(&h).frame().end_effector;
    let (from, to) = (on_screen(&h, tip.re, tip.im), on_screen(&h, tip.re - 0.2, tip.im));
    h.key_press(Key::U);
    h.run_steps(2);
    assert!(h.state().app_state().view_state().tool == Tool::Push);
    pull(&mut h, from, to);
    let pushed = session(&h).scenario().plant.force;
    assert!((pushed[0] + 4.0).abs() < 0.5 && pushed[1].abs() < 0.5, "{pushed:?} N for 0.2 m");
    h.run_steps(10);
    assert!(
        (session(&h).frame().end_effector - tip).norm() > 1e-3,
        "it gives way: {}",
        session(&h).frame().end_effector
    );
    assert!(session(&h).frame().peaks.moment > 0.1, "a force that nobody planned reaches the base");
    h.drop_at(to);
    h.run_steps(60);
    assert_eq!(session(&h).scenario().plant.force, [0.0; 2]);
    assert!((session(&h).frame().end_effector - tip).norm() < 1e-3, "and returns");
    let again = stillbase::session::replay(&session(&h).to_scenario(), |_, _| {}).expect("it runs");
    assert_eq!(again.frame(), session(&h).run().frame(), "the push is in the script");
}

/// Led by hand, the panel says so and leads back; the paper's cases come back whole.
fn a_hand_is_named_and_let_go() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let band = "A and B: b from";
    assert!(h.query_by_label_contains(band).is_some() && h.query_by_label("led by hand").is_none());
    let (from, to) = (on_screen(&h, 0.5, 0.5), on_screen(&h, 0.45, 0.62));
    drag(&mut h, from, to);
    h.run_steps(20);
    assert!(session(&h).is_dragged() && h.query_by_label("led by hand").is_some());
    assert!(h.query_by_label_contains(band).is_none() && h.query_by_label("planned").is_none());
    for by_key in [true, false] {
        match by_key {
            true => h.key_press(Key::B),
            false => h.get_by_label("back to the path").click(),
        }
        h.run_steps(3);
        assert!(!session(&h).is_dragged() && h.query_by_label_contains(band).is_some());
        assert_eq!(session(&h).frame().step, 0);
        assert!(session(&h).script().is_empty(), "{:?}", session(&h).script());
        h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        h.run_steps(3);
        assert!(session(&h).is_dragged(), "the hand comes back");
    }
    let gravity = Edit::set("gravity", stillbase::settings::change::value("0,-9.81"));
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(gravity));
    h.key_press(Key::Num3);
    h.run_steps(2);
    assert_eq!(session(&h).to_scenario().machine, Scenario::builtin("case-3").expect("built in").machine);
    assert!(h.state().app_state().view_state().status.message.is_none());
    // Another machine that somebody has chosen stays, and that is said.
    let case = Scenario::builtin("case-3").expect("built in");
    let other = stillbase::mechanics::machine::builtins().iter().find(|m| m.name() == "nine-link-table-1");
    let other = other.unwrap_or_else(|| {
        panic!(
            "{:?}",
            stillbase::mechanics::machine::builtins().iter().map(|m| m.name().to_owned()).collect::<Vec<_>>()
        )
    });
    let open = SessionCommand::Open(Box::new(Scenario { machine: other.clone(), ..case }));
    h.state_mut().app_state_mut().carry_out(open);
    h.key_press(Key::Num3);
    h.run_steps(2);
    let Message { text: said, is_problem: bad } =
        h.state().app_state().view_state().status.message.clone().expect("it is said");
    assert!(!bad && said.contains(other.name()), "{said}");
    assert_eq!(session(&h).scenario().machine.name(), other.name());
}

/// How a drag arrives: a frame for each event, its release together with what comes after, or all of it at once.
#[derive(Clone, Copy, PartialEq)]
enum Arrival {
    Slowly,
    ReleasedLate,
    AtOnce,
}

/// A drag after which the pointer goes elsewhere.
fn arrive(h: &mut Window, how: Arrival, [from, to, after]: [egui::Pos2; 3]) {
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
fn a_release_counts_where_the_button_came_up() {
    let outcome = |how: Arrival| {
        let mut h = window("case-3", Theme::Dark);
        h.run_steps(2);
        let mut said = Vec::new();
        let slider = h.get_by_role_and_label(Role::Slider, "b slider").rect();
        let [low, high] = [slider.left() + 8.0, slider.right() - 8.0];
        let at = |share: f32| pos2(low + share * (high - low), slider.center().y);
        arrive(&mut h, how, [at(0.307), at(0.32), at(0.33)]);
        said.push(session(&h).frame().b);
        // The ring's field, a little on; then the hand goes across the picture.
        let stage = h.state().app_state().stage().clone();
        let field = |b: f64| {
            let p = stage.ring_radius() * unit(session(&h).run().planes().expect("planes").map().turn(b));
            on_screen(&h, p.re, p.im)
        };
        let way = [field(session(&h).frame().b), field(2.3), on_screen(&h, 0.5, -0.3)];
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
        said
    };
    let slowly = outcome(Arrival::Slowly);
    assert!((slowly[1] - 2.3).abs() < 0.02 && (slowly[2] - 0.57).abs() < 2e-3, "{slowly:?}");
    assert!((slowly[4] - 0.4).abs() < 0.02 && (slowly[6] - 0.8).abs() < 2e-3, "{slowly:?}");
    assert!((slowly[7] - 0.45).abs() < 2e-3 && (slowly[8] - 0.6).abs() < 2e-3, "{slowly:?}");
    for how in [Arrival::ReleasedLate, Arrival::AtOnce] {
        let all = outcome(how);
        for (i, (x, y)) in slowly.iter().zip(&all).enumerate() {
            assert!((x - y).abs() < 1e-9, "number {i}: {x} slowly, {y} {}", how == Arrival::AtOnce);
        }
    }
}

/// Esc closes what is open; in one slow frame with the press that follows it must not take back the drag.
fn a_key_before_a_press_does_not_give_up_the_drag() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let slider = h.get_by_role_and_label(Role::Slider, "b slider").rect();
    let at = |share: f32| pos2(slider.left() + 8.0 + share * (slider.width() - 16.0), slider.center().y);
    let key = |pressed| egui::Event::Key {
        key: Key::Escape,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: Modifiers::NONE,
    };
    h.input_mut().events.extend([key(true), key(false)]);
    arrive(&mut h, Arrival::AtOnce, [at(0.307), at(0.35), at(0.35)]);
    assert!(session(&h).frame().b > 2.6, "{}", session(&h).frame().b);
}
