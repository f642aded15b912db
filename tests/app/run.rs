//! Time and b in the window: played, stepped, undone, and how it looks.

use egui::accesskit::Role;
use egui::{Key, Modifiers, pos2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use stillbase::app::{Message, SessionCommand, ViewChange};
use stillbase::picture::charts;
use stillbase::picture::scene::palette::Theme;
use stillbase::planning::common::common_b_set;
use stillbase::session::Edit;

use super::{Window, hold, pull, session, type_into, window};
use crate::Test;

pub const TESTS: &[Test] = tests![
    playing_case_3_ends_at_b_without_a_reaction,
    sliding_b_poses_at_rest_and_costs_a_moment_in_motion,
    keys_play_step_and_take_back,
    nothing_is_repainted_at_rest,
    case_1_in_motion_looks_as_it_should,
    a_run_is_played_over_and_over,
    what_a_repaint_takes_is_told_behind_a_key,
    b_leaves_the_task_as_it_is,
    lamps_of_a_run_to_come,
    the_knob_of_b_stops_where_b_does,
];

fn playing_case_3_ends_at_b_without_a_reaction() {
    let mut h = window("case-3", Theme::Dark);
    h.get_by_label("Play").click();
    h.run_steps(70);
    let f = session(&h).frame();
    assert_eq!(f.step, 1000, "the run stops by itself where the motion ends");
    assert!((f.end_effector.re - 0.55).abs() < 1e-6 && (f.end_effector.im - 0.9).abs() < 1e-6, "{:?}", f.end_effector);
    assert!(f.peaks.is_reactionless());
    for lamp in ["machine: balanced, good", "plan: holds b, good", "run: transmitted nothing, good"] {
        assert!(h.query_by_label(lamp).is_some(), "{lamp}");
    }
    // Time still runs: sliding b now would move the machine. One press plays the run again.
    assert!(session(&h).is_playing() && h.query_by_label("Play").is_some());
    h.key_press(Key::Space);
    h.run_steps(3);
    assert!(session(&h).frame().step < 200 && h.query_by_label("Pause").is_some(), "it starts over");
}

fn sliding_b_poses_at_rest_and_costs_a_moment_in_motion() {
    let mut h = window("case-3", Theme::Dark);
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

fn keys_play_step_and_take_back() {
    let mut h = window("case-3", Theme::Dark);
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
    assert!(h.query_by_label("Play, pause, start over").is_some());
}

/// What has not run is neither praised nor blamed, and a machine off balance is told so before it moves.
fn lamps_of_a_run_to_come() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    assert!(h.query_by_label("run: none yet, open").is_some());
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::set("link.5.com", -0.05)));
    h.run_steps(3);
    assert!(h.query_by_label_contains("machine: off balance by ").is_some());
    assert!(
        h.query_by_label("plan: no b to hold, open").is_some() && h.query_by_label("run: none yet, open").is_some()
    );
    assert!(h.query_by_label_contains("reactionless, good").is_none());
}

fn nothing_is_repainted_at_rest() {
    let mut h = window("case-3", Theme::Dark);
    // `run` fails if the window keeps asking for another repaint.
    h.run();
    h.hover_at(pos2(640.0, 400.0));
    h.run();
}

fn case_1_in_motion_looks_as_it_should() {
    let mut h = window("case-1", Theme::Dark);
    h.get_by_label("Play").click();
    h.run_steps(32);
    h.key_press(Key::Space);
    h.run_steps(4);
    // The path does it, not the machine.
    for lamp in ["machine: balanced, good", "plan: changes b by ", "run: peak |n_B| 1.0891 N m, bad"] {
        assert!(h.query_by_label_contains(lamp).is_some(), "{lamp}");
    }
    h.snapshot("case-1-dark");
    h.get_by_label("3D").click();
    h.run_steps(4);
    h.snapshot("case-1-dark-3d");
}

/// Paused, the slider's knob stops where b does, however far the pointer goes.
fn the_knob_of_b_stops_where_b_does() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let points = session(&h).scenario().task.points();
    let ends = common_b_set(session(&h).run().pose_space().expect("planes"), &points).expect("a band").intervals[0];
    let slider = h.get_by_role_and_label(Role::Slider, "b slider").rect();
    let shown = |h: &Window| h.get_by_role_and_label(Role::Slider, "b slider").accesskit_node().numeric_value();
    let period = session(&h).run().planes().expect("planes").map().period();
    let at = |b: f64| pos2(slider.left() + 6.0 + (slider.width() - 12.0) * (b / period) as f32, slider.center().y);
    for (to, stops) in [(slider.right() - 8.0, ends[1]), (slider.left() + 8.0, ends[0])] {
        let from = at(session(&h).b_aim());
        pull(&mut h, from, pos2(to, slider.center().y));
        h.run_steps(2);
        let knob = shown(&h).expect("a number");
        assert!((knob - stops).abs() < 1e-4, "the knob stands at {knob}, b stops at {stops}");
        assert!((session(&h).b_aim() - stops).abs() < 1e-4);
        h.drop_at(pos2(to, slider.center().y));
        h.run_steps(2);
    }
}

/// Paused, b stops where it would move A and B, unless that is asked for; what is typed and cannot be is said.
fn b_leaves_the_task_as_it_is() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let points = session(&h).scenario().task.points();
    let ends = common_b_set(session(&h).run().pose_space().expect("planes"), &points).expect("a band").intervals[0];
    for (asked, stops) in [(3.6, ends[1]), (0.9, ends[0])] {
        h.get_by_role_and_label(Role::Slider, "b slider").set_value_accesskit(asked);
        h.run_steps(2);
        let task = &session(&h).scenario().task;
        assert!((task.b - stops).abs() < 1e-5, "{} for {asked}: it stops at {stops}", task.b);
        assert_eq!(task.points(), points);
    }
    for (text, words) in [
        ("abc", "\"abc\" changes nothing"),
        ("-3", "A and B"),
        ("9e9", "from −1000.000 to 1000.000"),
        ("3.6", "A and B"),
    ] {
        let before = session(&h).to_scenario();
        type_into(&mut h, "b rad", text);
        let Message { text: said, is_problem: bad } =
            h.state().app_state().view_state().status.message.clone().unwrap_or_else(|| panic!("{text} is refused"));
        assert!(bad && said.contains(words), "{said}");
        assert_eq!(session(&h).to_scenario(), before, "{text}");
    }
    type_into(&mut h, "b rad", "2.5");
    assert!((session(&h).frame().b - 2.5).abs() < 1e-9);
    assert!(h.state().app_state().view_state().status.message.is_none());
    h.get_by_label("turn the task too").click();
    h.run_steps(2);
    h.get_by_role_and_label(Role::Slider, "b slider").set_value_accesskit(3.6);
    h.run_steps(2);
    let task = session(&h).scenario().task.clone();
    assert!((task.b - 3.6).abs() < 1e-9 && (task.points()[0] - points[0]).norm() > 0.1, "{task:?}");
    assert!(h.query_by_label_contains("Scenario").is_some());
    // In motion it goes round and round: panel, slider and status show the same number, that of the plots.
    h.key_press(Key::Num3);
    h.run_steps(70);
    let period = session(&h).run().planes().expect("planes").map().period();
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::SlideB { b: 2.4 + period }));
    h.run_steps(2);
    assert!((session(&h).b_aim() - 2.4 - period).abs() < 1e-9);
    let value = h.get_by_role_and_label(Role::Slider, "b slider").accesskit_node().numeric_value();
    assert!(value.is_some_and(|b| (b - 2.4 - period).abs() < 1e-9), "{value:?}");
    h.run_steps(400);
    let b = session(&h).frame().b;
    assert!((b - 2.4 - period).abs() < 1e-3, "{b}");
    assert!(h.query_by_label_contains(&format!("b {b:.3} rad")).is_some(), "the status says the same number");
}

fn a_run_is_played_over_and_over() {
    let mut h = window("case-3", Theme::Dark);
    h.get_by_label("loop").click();
    h.get_by_label("Play").click();
    h.run_steps(70);
    let time = session(&h).frame().time;
    assert!(session(&h).is_playing() && time > 0.1 && time < 0.6, "after 1.4 s it is under way again: {time}");
    // A range of the plots is played alone.
    h.state_mut().app_state_mut().carry_out(ViewChange::Charts(charts::choice::PlotChange::Range(Some([0.4, 0.6]))));
    let mut seen = [f64::INFINITY, 0.0];
    h.run_steps(30);
    for _ in 0..40 {
        h.step();
        let time = session(&h).frame().time;
        seen = [seen[0].min(time), seen[1].max(time)];
    }
    assert!(seen[0] >= 0.4 - 1e-9 && seen[1] <= 0.62 + 1e-9 && seen[1] > 0.58, "{seen:?}");
    h.key_press(Key::O);
    h.run_steps(2);
    h.run_steps(80);
    assert!(session(&h).frame().time > 0.99, "once more to the end");
}

fn what_a_repaint_takes_is_told_behind_a_key() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(3);
    assert!(h.query_by_label_contains("a second").is_none());
    h.key_press(Key::F12);
    h.run_steps(3);
    let told = h.get_by_label_contains("for the interface").accesskit_node().value().unwrap_or_default();
    let ms: Vec<f64> = told.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    assert!(ms.len() == 3 && ms.iter().all(|x| *x > 0.0), "{told}");
    h.key_press(Key::F12);
    h.run_steps(2);
    assert!(h.query_by_label_contains("for the interface").is_none());
}
