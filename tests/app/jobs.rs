//! Work beside the window: what was last known stays until the new is there, only the newest request counts, and the
//! hand never waits.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use stillbase::app::jobs::Threads;
use stillbase::app::window::{App, Clock};
use stillbase::app::{AppState, Command, Message, SessionCommand, Switch, ViewChange, WindowCommand};
use stillbase::picture::scene::options::ViewOptions;
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::views::ViewKind;
use stillbase::query::{InlineWorkers, Job, Poll, Work, Workers};
use stillbase::session::scenario::Scenario;
use stillbase::session::{Edit, Session};

use super::screen::{Screen, whole};
use super::{Window, pull, session, written};
use crate::Test;
use crate::folder::Folder;

pub const TESTS: &[Test] = tests![
    studies_run_beside_the_window,
    ways_to_a_target_are_sought_beside_the_window,
    the_ways_of_a_task_run_beside_the_window,
    a_recording_is_written_beside_the_window,
    what_is_cancelled_is_stopped,
    a_change_that_takes_long_is_made_beside_the_window,
    a_change_that_is_being_made_is_asked_for,
    of_a_drag_the_newest_edit_counts,
    a_drag_that_is_given_up_takes_back_what_it_did,
    a_file_is_opened_beside_the_window,
    what_is_done_beside_equals_what_is_done_at_once,
    jobs_end_break_off_and_are_stopped,
    threads_stay_for_the_next_job,
    work_begins_when_the_window_is_drawn,
    what_a_machine_reaches_is_outlined_beside_the_window,
    counterweights_are_looked_for_beside_the_window,
];

/// Does nothing until it is told to.
#[derive(Clone, Default)]
struct Waiting {
    works: Arc<Mutex<Vec<Work>>>,
    /// Whether even what is short as a rule takes long.
    is_slow: bool,
}

impl Workers for Waiting {
    fn start(&self, work: Work) {
        self.works.lock().expect("nobody panicked").push(work);
    }

    fn start_short(&self, work: Work) {
        match self.is_slow {
            true => self.start(work),
            false => work(),
        }
    }
}

impl Waiting {
    fn slow() -> Self {
        Self { is_slow: true, ..Self::default() }
    }

    fn work(&self) -> usize {
        let all = std::mem::take(&mut *self.works.lock().expect("nobody panicked"));
        let count = all.len();
        all.into_iter().for_each(|work| work());
        count
    }
}

fn window(case: &str, workers: &Waiting) -> Window {
    let scenario = Scenario::builtin(case).expect("built in");
    let app_state = AppState::new(scenario, Theme::Dark).expect("it starts").with_workers(workers.clone());
    Harness::builder()
        .with_size([1280.0, 800.0])
        .with_step_dt(0.02)
        .renderer(Screen::new())
        .build_ui_state(whole, App::new(app_state, Clock::Fixed(0.02)))
}

fn tell(h: &mut Window, command: Command) {
    h.state_mut().app_state_mut().carry_out(command);
    h.run_steps(2);
}

fn ways_to_a_target_are_sought_beside_the_window() {
    let workers = Waiting::default();
    let mut h = window("four-drive", &workers);
    h.run_steps(2);
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::DragTarget { x: 5.0, y: 5.0 })));
    tell(&mut h, Command::Session(SessionCommand::EndGesture));
    h.run_steps(200);
    workers.work();
    h.run_steps(3);
    assert!(h.query_by_label_contains("go to the nearest point").is_some());
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::DragTarget { x: -5.0, y: 5.0 })));
    tell(&mut h, Command::Session(SessionCommand::EndGesture));
    h.run_steps(200);
    assert!(h.query_by_label_contains("go to the nearest point").is_none(), "that was another target");
    assert!(workers.work() > 0);
    h.run_steps(3);
    assert!(h.query_by_label_contains("go to the nearest point").is_some());
}

fn studies_run_beside_the_window() {
    let workers = Waiting::default();
    let mut h = window("case-3", &workers);
    h.run_steps(2);
    tell(&mut h, Command::View(ViewChange::Switch(Switch::Study, true)));
    assert!(h.query_by_label("sampling machines …").is_some(), "a panel without a study says so");
    assert!(h.query_by_label("sampling machines, 0 %").is_some(), "the line at the bottom says how far");
    assert_eq!(workers.work(), 1);
    h.run_steps(3);
    assert!(h.query_by_label("sampling machines …").is_none());
    assert!(h.query_by_label_contains("To blame").is_some(), "the study is on display");
    // Two edits, one after the other: the first study is not wanted any more, the last one stays on display.
    for time in [1.5, 2.0] {
        tell(&mut h, Command::Session(SessionCommand::Edit(Edit::set("task.time", time))));
        tell(&mut h, Command::Session(SessionCommand::EndGesture));
    }
    assert!(h.query_by_label("sampling machines …").is_none(), "the last study is on display");
    assert_eq!(session(&h).scenario().task.time, 2.0, "the hand has not waited");
    assert_eq!(workers.work(), 2);
    h.run_steps(3);
    assert!(h.query_by_label("sampling machines, 0 %").is_none());
    assert_eq!(workers.work(), 0, "nothing is left to do");
}

/// The scene is drawn without it until then; another machine's is found anew, and only that.
fn what_a_machine_reaches_is_outlined_beside_the_window() {
    let workers = Waiting::slow();
    let mut h = window("four-drive", &workers);
    h.run_steps(2);
    let outlined = |h: &Window| {
        let app_state = h.state().app_state();
        let scene = app_state.views().scene(
            ViewKind::Flat,
            session(h).frame(),
            &ViewOptions::default(),
            app_state.view_state().camera(),
        );
        let lines = scene.lines.iter().filter(|line| line.name == "workspace/boundary").count();
        assert_eq!(app_state.views().unoutlined().is_none(), lines > 0, "what is found is drawn");
        lines > 0
    };
    assert!(!outlined(&h), "the window is there before the outline");
    assert_eq!(workers.work(), 2, "the outline, and which b reach A and B");
    h.run_steps(2);
    assert!(outlined(&h), "it comes when it is found");
    // What does not change the machine does not ask for it again.
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::set("task.time", 2.0))));
    tell(&mut h, Command::Session(SessionCommand::EndGesture));
    workers.work();
    h.run_steps(2);
    assert!(outlined(&h) && workers.work() == 0);
    assert_eq!(session(&h).scenario().task.time, 2.0);
    for limit in [1.2, 1.3] {
        tell(&mut h, Command::Session(SessionCommand::Edit(Edit::set("limits.a3", vec![-limit, limit]))));
        tell(&mut h, Command::Session(SessionCommand::EndGesture));
        workers.work();
        h.run_steps(2);
        assert!(!outlined(&h), "of a machine with other limits it is found anew");
    }
    assert_eq!(workers.work(), 2, "what was found for the limits before is wanted no more");
    h.run_steps(2);
    assert!(outlined(&h) && workers.work() == 0);
}

/// The panel is there before them, keeps those of the machine before meanwhile, and says so once that takes long.
fn counterweights_are_looked_for_beside_the_window() {
    let workers = Waiting::slow();
    let mut h = window("nine-link-bare", &workers);
    tell(&mut h, Command::View(ViewChange::Kind(ViewKind::Design)));
    let front = |h: &Window| {
        let plot = h.query_by_label_contains("Counterweights to choose from");
        plot.map(|node| node.accesskit_node().label().unwrap_or_default())
    };
    let said = |h: &Window| h.query_by_label_contains("looking for them: 0 %").is_some();
    assert!(front(&h).is_none() && said(&h), "there is nothing else to show");
    workers.work();
    h.run_steps(25);
    let first = front(&h).expect("found");
    assert!(!said(&h));
    // What is planned anew is planned beside the window, too.
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::set("link.9.mass", 0.9))));
    workers.work();
    h.run_steps(2);
    assert_eq!(session(&h).scenario().machine.links()[8].mass, 0.9);
    assert_eq!((front(&h).as_ref(), said(&h)), (Some(&first), false), "those before, meanwhile");
    h.run_steps(60);
    assert_eq!((front(&h).as_ref(), said(&h)), (Some(&first), true), "it takes long");
    workers.work();
    h.run_steps(2);
    let next = front(&h).expect("found");
    assert_ne!(next, first);
    tell(&mut h, Command::Session(SessionCommand::EndGesture));
    workers.work();
    h.run_steps(2);
    assert_eq!((front(&h), workers.work()), (Some(next), 0), "nothing is left to do");
}

fn the_ways_of_a_task_run_beside_the_window() {
    let workers = Waiting::default();
    let mut h = window("case-3", &workers);
    h.run_steps(2);
    tell(&mut h, Command::View(ViewChange::Switch(Switch::Compare, true)));
    let entries = |h: &Window| h.state().app_state().comparison().map(|c| c.entries().len());
    assert_eq!(entries(&h), Some(0), "an empty table, until the runs are there");
    // What is sorted and kept meanwhile stays so.
    tell(&mut h, Command::Session(SessionCommand::KeepRun));
    assert_eq!(entries(&h), Some(0));
    assert_eq!(workers.work(), 2);
    h.run_steps(3);
    let count = entries(&h).expect("a table");
    assert!(count > 3, "{count}");
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::set("task.time", 1.5))));
    tell(&mut h, Command::Session(SessionCommand::EndGesture));
    assert_eq!(entries(&h), Some(count), "the last runs stay");
    assert_eq!(workers.work(), 1);
    h.run_steps(3);
    let task = h.state().app_state().comparison().map(|c| c.task().task.time);
    assert_eq!((entries(&h), task), (Some(count), Some(1.5)));
    tell(&mut h, Command::View(ViewChange::Switch(Switch::Compare, false)));
    assert_eq!(entries(&h), None);
    assert_eq!(workers.work(), 0);
}

fn a_recording_is_written_beside_the_window() {
    if cfg!(not(feature = "record")) {
        return;
    }
    let workers = Waiting::default();
    let folder = Folder::new("jobs");
    let file = folder.path("run.rrd");
    let mut h = window("case-3", &workers);
    h.run_steps(2);
    tell(&mut h, Command::Session(SessionCommand::Record(file.clone())));
    assert!(h.query_by_label("recording, 0 %").is_some());
    tell(&mut h, Command::Session(SessionCommand::Record(folder.path("other.rrd"))));
    assert!(h.query_by_label_contains("one recording is under way").is_some());
    // The machine goes on under the hand.
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::SlideB { b: 2.5 })));
    assert!(!file.exists());
    assert_eq!(workers.work(), 1);
    h.run_steps(2);
    assert!(file.exists());
    assert!(h.query_by_label_contains("recorded ").is_some());
}

fn what_is_cancelled_is_stopped() {
    let workers = Waiting::default();
    let folder = Folder::new("cancelled");
    let mut h = window("case-3", &workers);
    h.run_steps(2);
    let cancel = |h: &mut Window, what: &str| {
        h.get_by_label(&format!("Cancel {what}")).click();
        h.run_steps(3);
    };
    if cfg!(feature = "record") {
        tell(&mut h, Command::Session(SessionCommand::Record(folder.path("run.rrd"))));
        // Esc is for what is dragged or open: it stops no recording.
        h.key_press(egui::Key::Escape);
        h.run_steps(2);
        cancel(&mut h, "recording");
        assert!(h.query_by_label("cancelled: no file is left").is_some());
        assert_eq!(workers.work(), 1);
        h.run_steps(2);
        assert!(folder.names().is_empty(), "{:?}", folder.names());
    }
    // A study: what is on display stays, and it is not begun again until something changes.
    tell(&mut h, Command::View(ViewChange::Switch(Switch::Study, true)));
    cancel(&mut h, "sampling machines");
    assert!(h.query_by_label_contains("cancelled: any change samples").is_some());
    assert_eq!(workers.work(), 1);
    h.run_steps(3);
    assert!(h.query_by_label_contains("To blame").is_none(), "nobody waits for it any more");
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::set("task.time", 1.5))));
    tell(&mut h, Command::Session(SessionCommand::EndGesture));
    work_all(&mut h, &workers);
    assert!(h.query_by_label_contains("To blame").is_some(), "the run has changed: it is studied");
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::set("task.time", 1.6))));
    tell(&mut h, Command::Session(SessionCommand::EndGesture));
    cancel(&mut h, "sampling machines");
    workers.work();
    h.run_steps(2);
    assert!(h.query_by_label_contains("To blame").is_some(), "the last study stays");
    assert_eq!(workers.work(), 0, "and is not begun again");
    // The ways of the task, the same.
    tell(&mut h, Command::View(ViewChange::Switch(Switch::Compare, true)));
    cancel(&mut h, "running the ways of the task");
    workers.work();
    h.run_steps(2);
    let entries = h.state().app_state().comparison().map(|c| c.entries().len());
    assert_eq!((entries, workers.work()), (Some(0), 0));
}

/// Does all that there is to do, and what follows from it.
fn work_all(h: &mut Window, workers: &Waiting) {
    for _ in 0..8 {
        workers.work();
        h.run_steps(2);
    }
    assert!(!h.state().app_state().is_working());
}

/// A window that closes meanwhile would lose it.
fn a_change_that_is_being_made_is_asked_for() {
    let workers = Waiting::slow();
    let mut h = window("least-reaction", &workers);
    h.run_steps(2);
    assert!(h.state().app_state().may_leave());
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::set("task.time", 1.7))));
    tell(&mut h, Command::Session(SessionCommand::EndGesture));
    assert!(!h.state().app_state().may_leave(), "it is in no count yet");
    tell(&mut h, Command::Window(WindowCommand::Quit));
    assert!(!h.state().app_state().wants_to_leave());
    assert!(h.query_by_label("A change of this session is being made.").is_some());
    workers.work();
    h.run_steps(2);
    assert!(h.query_by_label("One change of this session is in no file.").is_some());
}

fn a_change_that_takes_long_is_made_beside_the_window() {
    let workers = Waiting::slow();
    let mut h = window("least-reaction", &workers);
    h.run_steps(2);
    let time = |h: &Window| session(h).scenario().task.time;
    let was = time(&h);
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::set("task.time", 1.7))));
    tell(&mut h, Command::Session(SessionCommand::EndGesture));
    assert_eq!(time(&h), was, "what was shown stays until the new run is there");
    h.run_steps(8);
    assert!(h.query_by_label("making the run again, 0 %").is_some(), "the line at the bottom says so");
    // Meanwhile the window goes on: views turn, and what is done to the session waits for its turn.
    tell(&mut h, Command::View(ViewChange::Switch(Switch::Snapshots, true)));
    assert!(h.state().app_state().view_state().snapshots);
    tell(&mut h, Command::Session(SessionCommand::Undo));
    assert_eq!(workers.work(), 1);
    h.run_steps(1);
    assert_eq!(time(&h), 1.7, "it has been made, and what waited is under way");
    workers.work();
    h.run_steps(2);
    assert_eq!(time(&h), was);
    assert_eq!(session(&h).redo_title(), Some("set duration from A to B to 1.7 s"));
    // Cancelled, nothing has changed, and what waited for it goes too.
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::set("task.time", 1.8))));
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::set("task.b", 2.45))));
    h.run_steps(8);
    h.get_by_label("Cancel making the run again").click();
    h.run_steps(3);
    assert!(h.query_by_label("cancelled: nothing has changed").is_some());
    workers.work();
    h.run_steps(2);
    assert_eq!((time(&h), session(&h).undo_title()), (was, None));
    assert!(!h.state().app_state().is_working());
}

fn of_a_drag_the_newest_edit_counts() {
    let workers = Waiting::slow();
    let mut h = window("least-reaction", &workers);
    h.run_steps(2);
    let to = session(&h).scenario().task.points()[1];
    for i in 1..=20 {
        tell(
            &mut h,
            Command::Session(SessionCommand::Edit(Edit::set("task.to", vec![to.re - 1e-3 * f64::from(i), to.im]))),
        );
    }
    tell(&mut h, Command::Session(SessionCommand::EndGesture));
    assert_eq!(workers.work(), 1, "the first");
    h.run_steps(2);
    assert_eq!(workers.work(), 1, "the last, and none between");
    h.run_steps(2);
    assert_eq!(workers.work(), 0);
    assert_eq!(session(&h).scenario().task.points()[1].re, to.re - 0.02);
    tell(&mut h, Command::Session(SessionCommand::Undo));
    work_all(&mut h, &workers);
    assert_eq!(session(&h).scenario().task.points()[1], to, "all of the drag is one undo");
}

fn a_drag_that_is_given_up_takes_back_what_it_did() {
    let workers = Waiting::slow();
    let mut h = window("least-reaction", &workers);
    h.run_steps(2);
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::set("task.time", 1.5))));
    tell(&mut h, Command::Session(SessionCommand::EndGesture));
    work_all(&mut h, &workers);
    let before = session(&h).to_scenario();
    // B is held by its name where the target covers it.
    h.run_steps(2);
    let name = written(&h, "B");
    pull(&mut h, name, name + egui::vec2(-14.0, 6.0));
    assert!(h.state().app_state().view_state().gesture.grabbed.is_some(), "it is held");
    h.key_press(egui::Key::Escape);
    h.run_steps(2);
    work_all(&mut h, &workers);
    h.drop_at(name);
    work_all(&mut h, &workers);
    assert_eq!(session(&h).to_scenario(), before);
}

fn a_file_is_opened_beside_the_window() {
    let workers = Waiting::default();
    let folder = Folder::new("opened-beside");
    let file = folder.path("mine.toml");
    std::fs::write(&file, Scenario::builtin("circle").expect("built in").to_toml()).expect("a file");
    let mut h = window("case-3", &workers);
    h.run_steps(2);
    tell(&mut h, Command::Session(SessionCommand::OpenFile(folder.path("none.toml"))));
    tell(&mut h, Command::Session(SessionCommand::OpenFile(file.clone())));
    assert!(h.query_by_label("opening, 0 %").is_some());
    // The session that is there can be worked with until then.
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::SlideB { b: 2.5 })));
    assert_eq!(session(&h).b_aim(), 2.5);
    assert_eq!(session(&h).scenario().name, "case-3");
    work_all(&mut h, &workers);
    assert_eq!(session(&h).scenario().task, Scenario::builtin("circle").expect("built in").task);
    let said = h.state().app_state().view_state().status.message.clone();
    assert_eq!(
        said,
        Some(Message { text: format!("opened {}", file.display()), is_problem: false }),
        "of two only the newest counts"
    );
    tell(&mut h, Command::Session(SessionCommand::Undo));
    work_all(&mut h, &workers);
    assert_eq!(session(&h).b_aim(), 2.5, "undo brings back what was there");
    // What cannot be opened is said when it is known, and nothing has changed.
    tell(&mut h, Command::Session(SessionCommand::OpenFile(folder.path("none.toml"))));
    workers.work();
    h.run_steps(2);
    assert!(h.query_by_label_contains("none.toml").is_some());
    assert_eq!(session(&h).b_aim(), 2.5);
    // Bad news goes with the next thing that is done.
    h.key_press(egui::Key::F);
    h.run_steps(2);
    tell(&mut h, Command::Session(SessionCommand::OpenFile(file)));
    h.get_by_label("Cancel opening").click();
    h.run_steps(3);
    work_all(&mut h, &workers);
    assert_eq!(session(&h).b_aim(), 2.5);
}

/// What a person can do to a session, drawn at random; edits that follow each other are of different drags, so that each
/// of them counts.
fn any_commands() -> impl Strategy<Value = Vec<Command>> {
    let number = |path: &'static str, range: std::ops::Range<f64>| {
        range.prop_map(move |x| Edit::set(path, (x * 1e3).round() / 1e3)).boxed()
    };
    let edit = prop_oneof![
        number("task.time", 0.3..0.9),
        number("task.b", 2.2..2.7),
        number("plant.payload.mass", 0.0..0.4),
        number("plant.friction.viscous", 0.0..0.3),
        (0.3..0.7, 0.4..1.0).prop_map(|(x, y)| Edit::set("task.to", vec![x, y])),
        (0.3..0.7, 0.4..1.0).prop_map(|(x, y)| Edit::DragTarget { x, y }),
        (2.0..2.8).prop_map(|b| Edit::SlideB { b }),
        (2.0..2.8).prop_map(|b| Edit::PoseB { b }),
        (0.1..0.6).prop_map(|least: f64| Edit::set("limits.a1", vec![least, 3.0])),
        prop::sample::select(vec!["quintic", "fastest"]).prop_map(|law| Edit::set("task.law", law)),
    ];
    let command = prop_oneof![
        8 => edit.prop_map(|it| Command::Session(SessionCommand::Edit(it))),
        3 => Just(Command::Session(SessionCommand::Undo)),
        2 => Just(Command::Session(SessionCommand::Redo)),
        2 => Just(Command::Session(SessionCommand::TogglePlay)),
        2 => (0.0..0.8).prop_map(|it| Command::Session(SessionCommand::Seek(it))),
        1 => (-30i64..30).prop_map(|it| Command::Session(SessionCommand::Step(it))),
        1 => Just(Command::Session(SessionCommand::BackToPath)),
        1 => prop::sample::select(vec!["case-1", "case-2"]).prop_map(|it| Command::Session(SessionCommand::Case(it))),
    ];
    prop::collection::vec(command, 1..12)
}

/// Sixty sittings at random, with waits between what is done or without: frames, scenario and history are those of the
/// program without threads.
fn what_is_done_beside_equals_what_is_done_at_once() {
    let start = || {
        let mut scenario = Scenario::builtin("case-3").expect("built in");
        scenario.step = 0.005;
        AppState::new(scenario, Theme::Dark).expect("it starts")
    };
    let until_done = |app_state: &mut AppState| {
        for _ in 0..6000 {
            // Commands that wait are carried out with the next.
            app_state.carry_out(ViewChange::Preview(None));
            if !app_state.is_working() {
                return;
            }
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        panic!("it does not end");
    };
    let mut runner = TestRunner::new(Config { cases: 60, failure_persistence: None, ..Config::default() });
    let sitting = (any_commands(), prop::collection::vec(any::<bool>(), 12));
    let result = runner.run(&sitting, |(commands, waits)| {
        let (mut at_once, mut beside) = (start(), start().with_workers(Threads::Background));
        for (command, wait) in commands.into_iter().zip(waits) {
            for app_state in [&mut at_once, &mut beside] {
                app_state.carry_out(command.clone());
                app_state.carry_out(SessionCommand::EndGesture);
            }
            // What is opened takes the place of all; until then one works with what is there.
            if wait || matches!(command, Command::Session(SessionCommand::Case(_))) {
                until_done(&mut beside);
                at_once.pass(0.1);
                beside.pass(0.1);
            }
        }
        until_done(&mut beside);
        let [one, other] = [&at_once, &beside].map(|app_state| app_state.session());
        prop_assert_eq!(one.to_scenario(), other.to_scenario());
        prop_assert!(one.frames() == other.frames(), "other frames");
        prop_assert_eq!(one.frame().step, other.frame().step);
        prop_assert_eq!(one.is_playing(), other.is_playing());
        let history = |session: &Session| [session.undo_title(), session.redo_title()].map(|t| t.map(String::from));
        prop_assert_eq!(history(one), history(other));
        Ok(())
    });
    result.unwrap_or_else(|why| panic!("{why}"));
}

/// Until then it waits: only a change of the session is made meanwhile.
fn work_begins_when_the_window_is_drawn() {
    let workers = Waiting::default();
    let scenario = Scenario::builtin("case-3").expect("built in");
    let mut app_state = AppState::new(scenario, Theme::Dark).expect("it starts").with_workers(workers.clone());
    let ctx = egui::Context::default();
    let draw = |app_state: &mut AppState| {
        let input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(1280.0, 800.0))),
            ..egui::RawInput::default()
        };
        let _ = ctx.run_ui(input, |ui| app_state.ui(ui));
    };
    draw(&mut app_state);
    workers.work();
    let drawing = app_state.drawing();
    app_state.carry_out(ViewChange::Switch(Switch::Study, true));
    app_state.carry_out(SessionCommand::Edit(Edit::set("task.time", 2.0)));
    draw(&mut app_state);
    assert_eq!(app_state.session().scenario().task.time, 2.0, "a change is made at once");
    assert_eq!(workers.work(), 0, "the window is being drawn");
    assert!(app_state.is_working(), "and the work is not forgotten");
    drop(drawing);
    assert!(workers.work() > 0);
    draw(&mut app_state);
    // What begins after that waits no more.
    app_state.carry_out(SessionCommand::Edit(Edit::set("task.time", 1.5)));
    app_state.carry_out(SessionCommand::EndGesture);
    draw(&mut app_state);
    assert!(workers.work() > 0);
}

fn threads_stay_for_the_next_job() {
    let on = || {
        let job = Job::start(
            &Threads::Background,
            || (),
            |_| {
                let nice = std::fs::read_to_string("/proc/thread-self/stat").unwrap_or_default();
                let nice = nice.rsplit(')').next().and_then(|rest| rest.split_whitespace().nth(16)).map(String::from);
                (std::thread::current().id(), nice)
            },
        );
        let ran = job.wait().expect("it ends");
        // Its thread is back a moment later.
        std::thread::sleep(std::time::Duration::from_millis(2));
        ran
    };
    let ran: Vec<_> = (0..40).map(|_| on()).collect();
    let mut threads = std::collections::HashSet::new();
    for (thread, nice) in &ran {
        threads.insert(*thread);
        if cfg!(target_os = "linux") {
            assert_eq!(nice.as_deref(), Some("19"), "the window goes first");
        }
    }
    assert!(threads.len() < 20, "{} threads for 40 jobs, one after the other", threads.len());
    // A panic costs a thread and not the others.
    let broken: Job<()> = Job::start(&Threads::Background, || (), |_| panic!("this one breaks off, as the test wants"));
    assert_eq!(broken.wait(), None);
    assert!(matches!(Job::start(&Threads::Background, || (), |_| 7).wait(), Some(7)));
}

fn jobs_end_break_off_and_are_stopped() {
    let woken = Arc::new(AtomicUsize::new(0));
    let wake = || {
        let woken = woken.clone();
        move || {
            woken.fetch_add(1, Ordering::SeqCst);
        }
    };
    let job = Job::start(&InlineWorkers, wake(), |ticket| ticket.goes_on(0.25));
    assert!((job.progress() - 0.25).abs() < 1e-3);
    assert!(matches!(job.poll(), Poll::Done(true)));
    assert!(matches!(job.poll(), Poll::Broken), "a result is given once");
    // On a thread, until it is there.
    for threads in [Threads::Background, Threads::Prompt] {
        let job = Job::start(&threads, wake(), |_| 7);
        let mut found = None;
        for _ in 0..2000 {
            match job.poll() {
                Poll::Done(result) => {
                    found = Some(result);
                    break;
                }
                Poll::Working => std::thread::sleep(std::time::Duration::from_millis(5)),
                Poll::Broken => panic!("it ended without a result"),
            }
        }
        assert_eq!(found, Some(7));
    }
    // Dropped, it hears that nobody waits.
    let waiting = Waiting::default();
    let heard = Arc::new(Mutex::new(None));
    let job = Job::start(&waiting, wake(), {
        let heard = heard.clone();
        move |ticket| *heard.lock().expect("nobody panicked") = Some(ticket.goes_on(0.5))
    });
    drop(job);
    assert_eq!(waiting.work(), 1);
    assert_eq!(*heard.lock().expect("nobody panicked"), Some(false));
    // Work that is thrown away has no result.
    let job: Job<i32> = Job::start(&waiting, wake(), |_| 1);
    waiting.works.lock().expect("nobody panicked").clear();
    assert!(matches!(job.poll(), Poll::Broken));
}
