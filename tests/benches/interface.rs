//! How long the window takes for a repaint while everything runs beside it: a study of a million machines, a recording,
//! a replay of 150,000 steps, and a hand that drags the target all the while.
//!
//! `cargo bench --bench interface` prints median and worst of what the interface does in a repaint: the steps of the
//! simulation that are due, the drag, all panels and the scene, and their tessellation. It fails if one takes 50 ms. What
//! the GPU draws is not in it. Before that it prints what one event of a drag takes at its beginning and after a hundred
//! thousand, and what a repaint takes while a machine is designed.

use std::time::{Duration, Instant};

use stillbase::app::jobs::Threads;
use stillbase::app::{Activity, AppState, SessionCommand, Switch, ViewChange};
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, TimedEdit};

/// Between two repaints.
const PACE: Duration = Duration::from_micros(16_667);

/// The longest repaint.
const LONGEST: Duration = Duration::from_millis(50);

/// A hand that has moved the target at so many steps.
fn led(edits: u32, every: u64) -> Scenario {
    let mut scenario = Scenario::builtin("case-3").expect("built in");
    scenario.edits = (0..edits).map(|i| TimedEdit { step: every * u64::from(i) + 1, edit: drag(i) }).collect();
    scenario.duration = Some((every * u64::from(edits)) as f64 * scenario.step);
    scenario
}

fn drag(i: u32) -> Edit {
    let a = 0.01 * f64::from(i);
    Edit::DragTarget { x: 0.5 + 0.05 * a.cos(), y: 0.55 + 0.05 * a.sin() }
}

/// What an event of a drag takes, each at a step of its own.
fn events_of_a_drag() {
    for before in [10, 100_000] {
        let mut app_state = AppState::new(led(before, 1), Theme::Dark).expect("it starts");
        app_state.carry_out(SessionCommand::Seek(1e9));
        app_state.carry_out(SessionCommand::Edit(drag(before)));
        let event = |i: u32| {
            app_state.pass(0.001);
            let begun = Instant::now();
            app_state.carry_out(SessionCommand::Edit(drag(before + i)));
            begun.elapsed()
        };
        let all: Vec<Duration> = (1..2000).map(event).collect();
        assert!(app_state.session().frames().len() > before as usize + 1000, "time has passed");
        tell(&format!("an event of a drag, after {before}"), &all);
    }
}

/// A centre of mass that is dragged in the design view, with discs that stay clear of pins: the front is sought all the
/// while, and thousands of cone programs with it.
fn a_design_that_is_dragged() {
    let scenario = Scenario::builtin("nine-link-bare").expect("built in");
    let mut app_state = AppState::new(scenario, Theme::Dark).expect("it starts").with_workers(Threads::Background);
    app_state.carry_out(ViewChange::Kind(ViewKind::Design));
    app_state.carry_out(SessionCommand::Edit(Edit::set("design.clearance", 0.005)));
    app_state.carry_out(SessionCommand::EndGesture);
    let mut repaint = Repaint { ctx: egui::Context::default(), now: 0.0 };
    let com = |i: u32| Edit::at(&["link", "5", "com"], 0.14 + 0.02 * (0.05 * f64::from(i)).sin());
    for i in 0..30 {
        repaint.once(&mut app_state, Some(com(i)));
    }
    let all: Vec<Duration> = (30..330).map(|i| repaint.once(&mut app_state, Some(com(i)))).collect();
    tell("a design with clearance, dragged", &all);
}

fn main() {
    events_of_a_drag();
    a_design_that_is_dragged();
    // A hand has led the machine for two minutes and a half: what is changed before that makes all of it again.
    let mut scenario = led(15_000, 10);
    scenario.tolerance.samples = Some(1_000_000);
    let mut app_state = AppState::new(scenario, Theme::Dark).expect("it starts").with_workers(Threads::Background);
    // A hand at an instant further back would cut off what comes after.
    app_state.carry_out(SessionCommand::Seek(1e9));
    let ctx = egui::Context::default();
    let mut repaint = Repaint { ctx: ctx.clone(), now: 0.0 };
    for _ in 0..60 {
        repaint.once(&mut app_state, None);
    }
    let alone: Vec<Duration> = (0..120).map(|i| repaint.once(&mut app_state, (i > 60).then(|| drag(i)))).collect();
    tell("dragged, nothing beside it", &alone);

    let file = std::env::temp_dir().join(format!("stillbase-interface-{}.rrd", std::process::id()));
    let begun = Instant::now();
    let mut seen: Vec<(Activity, usize)> = Vec::new();
    app_state.carry_out(ViewChange::Switch(Switch::Study, true));
    if cfg!(feature = "record") {
        app_state.carry_out(SessionCommand::Record(file.clone()));
    }
    app_state.carry_out(SessionCommand::EndGesture);
    app_state.carry_out(SessionCommand::Seek(30.0));
    app_state.carry_out(SessionCommand::Edit(Edit::set("plant.payload.mass", 0.1)));
    app_state.carry_out(SessionCommand::EndGesture);
    let mut all = Vec::new();
    let mut said = None;
    while app_state.is_working() || all.len() < 300 {
        all.push(repaint.once(&mut app_state, Some(drag(all.len() as u32))));
        for activity in app_state.under_way() {
            match seen.iter_mut().find(|(known, _)| *known == activity) {
                Some((_, count)) => *count += 1,
                None => seen.push((activity, 1)),
            }
        }
        let message = app_state.view_state().status.message.clone();
        if message.is_some() && message != said {
            println!("after {} repaints: {message:?}", all.len());
            said = message;
        }
        // A drag goes on for as long as it likes: the study waits for its end.
        if all.len() == 200 {
            app_state.carry_out(SessionCommand::EndGesture);
        }
        assert!(begun.elapsed() < Duration::from_secs(120), "it does not end: {seen:?}");
    }
    let _ = std::fs::remove_file(&file);
    for (activity, count) in &seen {
        println!("{:40} under way during {count} repaints", activity.words());
    }
    tell("dragged, with all of it beside", &all);
    assert!(seen.iter().any(|(known, _)| *known == Activity::Study), "{seen:?}");
    assert!(all.iter().all(|took| *took < LONGEST), "a repaint took too long");
}

struct Repaint {
    ctx: egui::Context,
    now: f64,
}

impl Repaint {
    /// One repaint, with the hand somewhere; how long it took.
    fn once(&mut self, app_state: &mut AppState, hand: Option<Edit>) -> Duration {
        let begun = Instant::now();
        let drawing = app_state.drawing();
        app_state.pass(PACE.as_secs_f64());
        if let Some(edit) = hand {
            app_state.carry_out(SessionCommand::Edit(edit));
        }
        let input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(1440.0, 900.0))),
            time: Some(self.now),
            ..Default::default()
        };
        let output = self.ctx.run_ui(input, |ui| app_state.ui(ui));
        let drawn = self.ctx.tessellate(output.shapes, output.pixels_per_point);
        let took = begun.elapsed();
        drop(drawing);
        assert!(drawn.len() > 5, "the panels are drawn: {}", drawn.len());
        self.now += PACE.as_secs_f64();
        std::thread::sleep(PACE.saturating_sub(took));
        took
    }
}

fn tell(what: &str, all: &[Duration]) {
    let mut sorted = all.to_vec();
    sorted.sort_unstable();
    let ms = |share: f64| sorted[((sorted.len() - 1) as f64 * share) as usize].as_secs_f64() * 1e3;
    println!(
        "{what:40} {:5} times: median {:.3} ms, 99 % within {:.3} ms, worst {:.3} ms",
        all.len(),
        ms(0.5),
        ms(0.99),
        ms(1.0)
    );
}
