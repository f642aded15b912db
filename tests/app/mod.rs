//! The window, driven as a person does: widgets by label, the pointer in the scene, keys; and pictures of it.

mod blocks;
mod drawing;
mod family;
mod files;
mod finder;
mod gallery;
mod given;
mod ground;
mod guide;
mod hands;
mod intro;
mod jobs;
mod labels;
mod layers;
mod layout;
mod lessons;
mod notation;
mod notes;
mod pair;
mod panel;
mod parts;
mod plot_places;
mod plots;
mod pointer;
mod refusal;
mod results;
mod room;
mod run;
mod saving;
mod screen;
mod settings;
mod sizes;
mod sketching;
mod studio;
mod time;
mod view;

use egui::Key;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use stillbase::app::window::{App, Clock};
use stillbase::app::{AppState, Preferences};
use stillbase::picture::scene::palette::Theme;
use stillbase::session::scenario::Scenario;

use crate::Test;

pub const TESTS: [&[Test]; 35] = [
    saving::TESTS,
    blocks::TESTS,
    drawing::TESTS,
    family::TESTS,
    files::TESTS,
    finder::TESTS,
    gallery::TESTS,
    given::TESTS,
    ground::TESTS,
    guide::TESTS,
    hands::TESTS,
    intro::TESTS,
    jobs::TESTS,
    labels::TESTS,
    layout::TESTS,
    notation::TESTS,
    lessons::TESTS,
    pair::TESTS,
    notes::TESTS,
    panel::TESTS,
    layers::TESTS,
    parts::TESTS,
    plot_places::TESTS,
    plots::TESTS,
    pointer::TESTS,
    refusal::TESTS,
    results::TESTS,
    room::TESTS,
    run::TESTS,
    settings::TESTS,
    sizes::TESTS,
    sketching::TESTS,
    studio::TESTS,
    time::TESTS,
    view::TESTS,
];

use screen::{Screen, whole};

type Window = Harness<'static, App>;

/// A window of 1280 by 800 on which every repaint lasts 20 ms.
fn window(case: &str, theme: Theme) -> Window {
    window_of(Scenario::builtin(case).expect("built in"), theme, 800.0)
}

/// The same of any scenario and height: what is scrolled out of view cannot be found.
fn window_of(scenario: Scenario, theme: Theme, height: f32) -> Window {
    let app_state = AppState::new(scenario, theme).expect("it starts");
    Harness::builder()
        .with_size([1280.0, height])
        .with_step_dt(0.02)
        .renderer(Screen::new())
        .build_ui_state(whole, App::new(app_state, Clock::Fixed(0.02)))
}

/// A window of a size with a person's preferences.
fn window_liked(size: impl Into<egui::Vec2>, liked: &Preferences) -> Window {
    let scenario = Scenario::builtin("case-3").expect("built in");
    let app_state = AppState::new(scenario, Theme::Dark).expect("it starts").with_preferences(liked);
    Harness::builder()
        .with_size(size)
        .with_step_dt(0.02)
        .renderer(Screen::new())
        .build_ui_state(whole, App::new(app_state, Clock::Fixed(0.02)))
}

fn session(h: &Window) -> &stillbase::session::Session {
    h.state().app_state().session()
}

/// Where a point of the plane of handles is on the screen.
fn on_screen(h: &Window, x: f64, y: f64) -> egui::Pos2 {
    seen(h, [x, y, h.state().app_state().stage().handle_height()])
}

/// Where a point of the scene is on the screen.
fn seen(h: &Window, point: [f64; 3]) -> egui::Pos2 {
    let rect = h.get_by_label_contains("Scene:").rect();
    let app_state = h.state().app_state();
    let aspect = f64::from(rect.width() / rect.height());
    let [u, v] = app_state.view_state().camera().project(point, aspect).expect("in front of the eye");
    rect.min + egui::vec2(u as f32 * rect.width(), v as f32 * rect.height())
}

/// Where a label of the scene stands.
fn written(h: &Window, text: &str) -> egui::Pos2 {
    let placement = stillbase::picture::paint::labels::last(&h.ctx, 0).expect("drawn");
    placement.all.iter().find(|own| own.text == text).expect("it is written").place.center()
}

fn drag(h: &mut Window, from: egui::Pos2, to: egui::Pos2) {
    pull(h, from, to);
    h.drop_at(to);
    h.step();
}

/// A drag that is not let go.
fn pull(h: &mut Window, from: egui::Pos2, to: egui::Pos2) {
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
fn hold(h: &mut Window) {
    h.get_by_label("Plant section").click();
    h.run_steps(2);
    h.get_by_label("payload").click();
    h.run_steps(2);
    assert_eq!(session(h).scenario().plant.payload.mass, 0.3);
}

/// All texts on the screen.
fn painted(h: &Window) -> Vec<String> {
    fn texts(shape: &egui::Shape, all: &mut Vec<String>) {
        match shape {
            egui::Shape::Text(text) => all.push(text.galley.text().to_owned()),
            egui::Shape::Vec(shapes) => shapes.iter().for_each(|shape| texts(shape, all)),
            _ => {}
        }
    }
    let mut all = Vec::new();
    h.output().shapes.iter().for_each(|clipped| texts(&clipped.shape, &mut all));
    all
}

/// Types into a field and leaves it.
fn type_into(h: &mut Window, label: &str, text: &str) {
    // A panel scrolls, and the field may lie beyond its edge.
    h.get_by_label(label).scroll_to_me();
    h.run_steps(4);
    h.get_by_label(label).click();
    h.run_steps(2);
    h.event(egui::Event::Text(text.into()));
    h.step();
    h.key_press(Key::Enter);
    h.run_steps(3);
}
