//! The first minute: the contrast until it is touched, hints until they are done, and what is remembered of it.

use egui::{Key, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use stillbase::app::window::{App, Clock};
use stillbase::app::{AppState, Command, Preferences, SessionCommand, WindowCommand};
use stillbase::picture::scene::options::Handle;
use stillbase::picture::scene::palette::Theme;
use stillbase::session::Edit;
use stillbase::session::scenario::Scenario;

use super::screen::{Screen, whole};
use super::{Window, drag, on_screen, painted, session};
use crate::Test;

pub const TESTS: &[Test] = tests![
    the_first_start_shows_the_contrast_over_and_over,
    hints_go_when_they_are_done,
    hints_are_skipped_for_good,
    only_the_built_in_case_has_a_first_minute,
    how_the_window_is_liked_is_remembered,
    the_tour_is_passed_by_doing,
    the_tour_says_done_of_what_happened_alone,
    numbers_of_the_first_screen_are_those_of_the_run,
    hints_speak_of_what_there_is_and_cover_none_of_it,
];

fn window(case: &str, liked: &Preferences) -> Window {
    let scenario = Scenario::builtin(case).expect("built in");
    let app_state = AppState::new(scenario, Theme::Dark).expect("it starts").with_preferences(liked);
    Harness::builder()
        .with_size([1440.0, 900.0])
        .with_step_dt(0.02)
        .renderer(Screen::new())
        .build_ui_state(whole, App::new(app_state, Clock::Fixed(0.02)))
}

fn liked(h: &Window) -> Preferences {
    h.state().app_state().preferences([1440.0, 900.0])
}

fn the_first_start_shows_the_contrast_over_and_over() {
    let mut h = window("case-3", &Preferences::default());
    h.state_mut().app_state_mut().carry_out(SessionCommand::TogglePlay);
    h.run_steps(14);
    assert!(h.query_by_label("POSE CONSTANT").is_none(), "the settings make room");
    assert!(h.query_by_label("Drag the white ring.").is_some());
    h.snapshot("first-minute-dark");
    h.run_steps(45);
    assert!(session(&h).is_at_end() && session(&h).frame().time > 0.99, "{}", session(&h).frame().time);
    h.run_steps(80);
    let time = session(&h).frame().time;
    assert!(session(&h).is_playing() && time > 0.05 && time < 0.9, "it has started over: {time}");
    assert!(liked(&h).hints, "nothing was done yet");
}

fn hints_go_when_they_are_done() {
    let mut h = window("case-3", &Preferences::default());
    h.run_steps(4);
    let at = session(&h).frame().end_effector;
    let from = on_screen(&h, at.re, at.im);
    drag(&mut h, from, from + egui::vec2(14.0, -14.0));
    h.run_steps(4);
    assert!(h.query_by_label("POSE CONSTANT").is_some(), "touched: the settings are back");
    assert!(h.query_by_label("Now drag it out of the amber area.").is_some());
    let at = session(&h).frame().target.at;
    let from = on_screen(&h, at.re, at.im);
    drag(&mut h, from, from + egui::vec2(260.0, -40.0));
    h.run_steps(4);
    assert!(h.query_by_label("Turn b: the amber ring at the base, or the slider.").is_some());
    let b = session(&h).b_aim();
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(stillbase::session::Edit::PoseB { b: b + 0.2 }));
    h.key_press(Key::F);
    h.run_steps(4);
    assert!(h.query_by_label("Turn b: the amber ring at the base, or the slider.").is_none());
    assert!(!liked(&h).hints, "done: never again");
}

fn hints_are_skipped_for_good() {
    let mut h = window("case-3", &Preferences::default());
    h.run_steps(3);
    h.key_press(Key::Escape);
    h.run_steps(3);
    assert!(h.query_by_label("Drag the white ring.").is_none() && !liked(&h).hints);
    let again = window("case-3", &liked(&h));
    assert!(again.query_by_label("Drag the white ring.").is_none());
}

fn only_the_built_in_case_has_a_first_minute() {
    let mut h = window("spacecraft", &Preferences::default());
    h.run_steps(3);
    assert!(h.query_by_label("Drag the white ring.").is_none());
    // Esc there closes nothing and forgets nothing.
    h.key_press(Key::Escape);
    h.run_steps(3);
    assert!(liked(&h).hints);
}

fn how_the_window_is_liked_is_remembered() {
    let usual = Preferences { hints: false, ..Preferences::default() };
    let mut h = window("case-3", &usual);
    h.run_steps(3);
    h.key_press(Key::L);
    h.key_press(Key::Num8);
    h.run_steps(3);
    // The edge of the plots is dragged to the left.
    let edge = 1440.0 - 336.0 + 2.0;
    drag(&mut h, pos2(edge, 500.0), pos2(edge - 120.0, 500.0));
    h.run_steps(3);
    let now = liked(&h);
    assert_eq!((now.theme, now.side, now.plots), (Theme::Light, false, true));
    assert!((now.plots_width.expect("made wider") - 336.0 - 120.0).abs() < 6.0, "{:?}", now.plots_width);
    assert_eq!(now.side_width, None, "left alone");
    let text = toml::to_string(&now).expect("plain data");
    let read: Preferences = toml::from_str(&text).expect("its own");
    assert_eq!(read, now);
    // What a stranger wrote is brought within what a window can be.
    let strange: Preferences = toml::from_str("size = [nan, 1e9]\nplots_width = -4.0\nnew_key = 3").expect("read");
    let sound = strange.sound();
    assert_eq!((sound.size, sound.plots_width), ([1440.0, 16_000.0], Some(260.0)));
    let mut again = window("case-3", &now);
    again.run_steps(3);
    assert!(again.query_by_label("POSE CONSTANT").is_none());
}

/// Each step asks for one thing, sees it done on the live scene, and goes on by a button; Esc leaves.
fn the_tour_is_passed_by_doing() {
    let mut h = window("case-2", &Preferences { hints: false, ..Preferences::default() });
    h.run_steps(2);
    let is_done = |h: &Window| h.query_by_label_contains("Done: ").is_some();
    let on = |h: &mut Window, words: &str| {
        assert!(is_done(h), "{words}: nothing is passed without being done");
        h.get_by_label(&format!("{words}: tour")).click();
        h.run_steps(3);
    };
    h.get_by_label("Help").click();
    h.run_steps(4);
    h.get_by_label("Take the tour").click();
    h.run_steps(4);
    assert!(h.query_by_label("An arm shakes what it stands on").is_some() && !is_done(&h));
    assert!(h.query_by_label("Skip: tour").is_some());
    h.get_by_label("Show me").click();
    h.run_steps(70);
    h.snapshot("tour-dark");
    on(&mut h, "Next");
    h.get_by_label("Hang 0.3 kg on it").click();
    h.run_steps(70);
    let f = *session(&h).frame();
    assert!(f.peaks.force > 0.5, "{} s, {} N, {} kg", f.time, f.peaks.force, session(&h).scenario().plant.payload.mass);
    on(&mut h, "Next");
    assert!(!is_done(&h));
    h.get_by_label("Take it off").click();
    h.run_steps(4);
    on(&mut h, "Next");
    h.get_by_label("Show me").click();
    h.run_steps(70);
    on(&mut h, "Next");
    let at = session(&h).frame().end_effector;
    let from = on_screen(&h, at.re, at.im);
    drag(&mut h, from, from + egui::vec2(-20.0, 20.0));
    h.run_steps(20);
    on(&mut h, "Next");
    let b = session(&h).b_aim();
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::SlideB { b: b + 0.1 }));
    h.run_steps(3);
    assert!(!is_done(&h), "half of it");
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::SlideB { b: b + 0.21 }));
    h.run_steps(3);
    on(&mut h, "Next");
    h.get_by_label("Start time").click();
    h.run_steps(15);
    assert!(session(&h).is_moving() && !is_done(&h));
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::SlideB { b: 2.6 }));
    h.run_steps(30);
    h.get_by_label("Back: tour").click();
    h.run_steps(3);
    assert!(h.query_by_label("b only turns it").is_some());
    h.key_press(Key::Escape);
    h.run_steps(3);
    assert!(h.query_by_label("b only turns it").is_none());
}

/// How things stand is not what was done: a step that begins where its end would be is not passed.
fn the_tour_says_done_of_what_happened_alone() {
    let is_done = |h: &Window| h.query_by_label_contains("Done: ").is_some();
    let tell = |h: &mut Window, command: Command| {
        h.state_mut().app_state_mut().carry_out(command);
        h.run_steps(3);
    };
    let case =
        |name: &str| Command::Session(SessionCommand::Open(Box::new(Scenario::builtin(name).expect("built in"))));
    // A run that has ended before the tour, of another task; then the straight line, jumped through.
    let mut h = window("case-2", &Preferences { hints: false, ..Preferences::default() });
    tell(&mut h, Command::Session(SessionCommand::TogglePlay));
    h.run_steps(70);
    assert!(session(&h).is_at_end() && session(&h).frame().peaks.moment > 0.05);
    tell(&mut h, Command::Window(WindowCommand::Tour(true)));
    assert!(!is_done(&h), "1: that was another run, before");
    tell(&mut h, case("case-1"));
    let end = session(&h).length();
    tell(&mut h, Command::Session(SessionCommand::Seek(end)));
    assert!(session(&h).frame().peaks.moment > 0.05 && !is_done(&h), "1: nothing was run");
    for step in 2..=7 {
        tell(&mut h, Command::Window(WindowCommand::TurnTour(true)));
        assert!(!is_done(&h), "{step}: as things stand, nothing was done");
    }
    // 2: a heavy load that was there and an end that is jumped to.
    let tour_at = |step: usize, before: &mut dyn FnMut(&mut Window)| {
        let mut h = window("case-3", &Preferences { hints: false, ..Preferences::default() });
        h.run_steps(2);
        before(&mut h);
        h.run_steps(2);
        tell(&mut h, Command::Window(WindowCommand::Tour(true)));
        (1..step).for_each(|_| tell(&mut h, Command::Window(WindowCommand::TurnTour(true))));
        assert!(!is_done(&h), "{step}");
        h
    };
    let mut loaded = |h: &mut Window| {
        tell(h, Command::Session(SessionCommand::Edit(Edit::set("plant.payload.mass", 0.3))));
        tell(h, Command::Session(SessionCommand::TogglePlay));
        h.run_steps(70);
    };
    tour_at(2, &mut loaded);
    // 4: the run on its plane was before.
    let mut ran = |h: &mut Window| {
        tell(h, Command::Session(SessionCommand::TogglePlay));
        h.run_steps(70);
    };
    tour_at(4, &mut ran);
    // 5: what was dragged before; 6: b that another session has, and that the machine is opened at.
    let mut led = |h: &mut Window| {
        tell(h, Command::Session(SessionCommand::Edit(Edit::DragTarget { x: 0.45, y: 0.55 })));
        tell(h, Command::Session(SessionCommand::TogglePlay));
        h.run_steps(60);
    };
    tour_at(5, &mut led);
    let mut h = tour_at(6, &mut |_| ());
    let mut other = Scenario::builtin("case-3").expect("built in");
    other.task.b = 2.65;
    tell(&mut h, Command::Session(SessionCommand::Open(Box::new(other))));
    assert!(!is_done(&h), "6: nobody turned b");
    // 7: b that is turned while time stands costs nothing.
    let mut h = tour_at(7, &mut |_| ());
    let b = session(&h).b_aim();
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::PoseB { b: b + 0.2 })));
    assert!((session(&h).b_aim() - b).abs() > 0.1 && !is_done(&h));
}

/// The arm of the first screen is drawn shaking. What is said of it is true all the same: it misses nothing.
fn numbers_of_the_first_screen_are_those_of_the_run() {
    let mut h = window("case-3", &Preferences::default());
    h.state_mut().app_state_mut().carry_out(SessionCommand::TogglePlay);
    for _ in 0..4 {
        h.run_steps(12);
        let said = painted(&h);
        assert!(said.iter().any(|text| text == "Straight line"), "{said:?}");
        let off: Vec<_> = said.iter().filter(|text| text.contains("mm off") || text.contains("end effector")).collect();
        assert!(off.is_empty(), "{off:?} at {} s", session(&h).frame().time);
        // Both arms follow their paths; the places are those of the frames.
        let at = session(&h).frame().end_effector;
        assert!(said.contains(&format!("{:.3}, {:.3} m", at.re, at.im)), "{said:?}");
    }
}

/// A hint speaks of an area only where there is one, of nothing where nothing can be dragged, and stands beside what it
/// speaks of, in small windows too.
fn hints_speak_of_what_there_is_and_cover_none_of_it() {
    for (machine, words) in [("two-drive", Some("amber curve")), ("nine-link-bare", None)] {
        let mut h = window("case-3", &Preferences::default());
        h.run_steps(2);
        let scenario = Scenario::builtin(machine).expect("built in");
        h.state_mut().app_state_mut().carry_out(SessionCommand::Open(Box::new(scenario)));
        h.run_steps(4);
        assert!(h.query_by_label_contains("amber area").is_none(), "{machine}");
        assert_eq!(h.query_by_label("Drag the white ring.").is_some(), words.is_some(), "{machine}");
        assert!(words.is_none_or(|words| h.query_by_label_contains(words).is_some()), "{machine}");
    }
    for size in [[1440.0, 900.0], [960.0, 600.0], [1100.0, 640.0]] {
        let mut h = window("case-3", &Preferences::default());
        h.set_size(size.into());
        h.run_steps(3);
        let at = session(&h).frame().end_effector;
        let from = on_screen(&h, at.re, at.im);
        drag(&mut h, from, from + egui::vec2(14.0, -14.0));
        h.run_steps(30);
        let card = h.ctx.memory(|m| m.area_rect(egui::Id::unique("hint"))).expect("a hint");
        let shown = session(&h).frame().into();
        let stage = h.state().app_state().stage().clone();
        let [x, y, z] = stage.handle(Handle::Ring, &shown).expect("a ring");
        let (knob, middle) = (super::seen(&h, [x, y, z]), super::seen(&h, [0.0, 0.0, z]));
        let ring = egui::Rect::from_center_size(middle, egui::Vec2::splat(2.0 * (knob - middle).length()));
        let target = session(&h).frame().end_effector;
        let target = on_screen(&h, target.re, target.im);
        assert!(!card.intersects(ring), "{size:?}: {card:?} lies over the ring, {ring:?}");
        assert!(!card.contains(target), "{size:?}: {card:?} lies over the target, {target:?}");
    }
}
