//! Work beside the window: what was last known stays until the new is there, only the newest request counts, and the
//! hand never waits.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use stillbase::app::jobs::{AtOnce, Job, Poll, Threads, Workers};
use stillbase::app::window::{App, Clock};
use stillbase::app::{AppState, Command, ComparisonCommand};
use stillbase::picture::scene::palette::Theme;
use stillbase::session::Edit;
use stillbase::session::scenario::Scenario;

use super::screen::Screen;
use super::{Window, session};
use crate::Test;
use crate::folder::Folder;

pub const TESTS: &[Test] = tests![
    studies_run_beside_the_window,
    the_ways_of_a_task_run_beside_the_window,
    a_recording_is_written_beside_the_window,
    jobs_end_break_off_and_are_stopped,
];

/// Does nothing until it is told to.
#[derive(Clone, Default)]
struct Waiting(Arc<Mutex<Vec<Work>>>);

type Work = Box<dyn FnOnce() + Send>;

impl Workers for Waiting {
    fn start(&self, work: Box<dyn FnOnce() + Send>) {
        self.0.lock().expect("nobody panicked").push(work);
    }
}

impl Waiting {
    fn work(&self) -> usize {
        let all = std::mem::take(&mut *self.0.lock().expect("nobody panicked"));
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
        .build_eframe(move |cc| App::new(cc, app_state, Clock::Fixed(0.02)).expect("kittest draws with wgpu"))
}

fn tell(h: &mut Window, command: Command) {
    h.state_mut().app_state_mut().carry_out(command);
    h.run_steps(2);
}

fn studies_run_beside_the_window() {
    let workers = Waiting::default();
    let mut h = window("case-3", &workers);
    h.run_steps(2);
    tell(&mut h, Command::Study(true));
    assert!(h.query_by_label("drawing machines …").is_some(), "a panel without a study says so");
    assert!(h.query_by_label("drawing machines, 0 %").is_some(), "the line at the bottom says how far");
    assert_eq!(workers.work(), 1);
    h.run_steps(3);
    assert!(h.query_by_label("drawing machines …").is_none());
    assert!(h.query_by_label_contains("To blame").is_some(), "the study is on display");
    // Two edits, one after the other: the first study is not wanted any more, the last one stays on display.
    for time in [1.5, 2.0] {
        tell(&mut h, Command::Edit(Edit::set("task.time", time)));
        tell(&mut h, Command::EndGesture);
    }
    assert!(h.query_by_label("drawing machines …").is_none(), "the last study is on display");
    assert_eq!(session(&h).scenario().task.time, 2.0, "the hand has not waited");
    assert_eq!(workers.work(), 2);
    h.run_steps(3);
    assert!(h.query_by_label("drawing machines, 0 %").is_none());
    assert_eq!(workers.work(), 0, "nothing is left to do");
}

fn the_ways_of_a_task_run_beside_the_window() {
    let workers = Waiting::default();
    let mut h = window("case-3", &workers);
    h.run_steps(2);
    tell(&mut h, Command::Compare(true));
    let entries = |h: &Window| h.state().app_state().comparison().map(|c| c.entries().len());
    assert_eq!(entries(&h), Some(0), "an empty table, until the runs are there");
    // What is sorted and kept meanwhile stays so.
    tell(&mut h, Command::Comparison(ComparisonCommand::Keep));
    assert_eq!(entries(&h), Some(1));
    assert_eq!(workers.work(), 1);
    h.run_steps(3);
    let count = entries(&h).expect("a table");
    assert!(count > 3, "{count}");
    tell(&mut h, Command::Edit(Edit::set("task.time", 1.5)));
    tell(&mut h, Command::EndGesture);
    assert_eq!(entries(&h), Some(count), "the last runs stay");
    assert_eq!(workers.work(), 1);
    h.run_steps(3);
    let task = h.state().app_state().comparison().map(|c| c.task().task.time);
    assert_eq!((entries(&h), task), (Some(count), Some(1.5)));
    tell(&mut h, Command::Compare(false));
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
    tell(&mut h, Command::Record(file.clone()));
    assert!(h.query_by_label("recording, 0 %").is_some());
    tell(&mut h, Command::Record(folder.path("other.rrd")));
    assert!(h.query_by_label_contains("one recording is under way").is_some());
    // The machine goes on under the hand.
    tell(&mut h, Command::Edit(Edit::SlideB { b: 2.5 }));
    assert!(!file.exists());
    assert_eq!(workers.work(), 1);
    h.run_steps(2);
    assert!(file.exists());
    assert!(h.query_by_label_contains("recorded ").is_some());
}

fn jobs_end_break_off_and_are_stopped() {
    let woken = Arc::new(AtomicUsize::new(0));
    let wake = || {
        let woken = woken.clone();
        move || {
            woken.fetch_add(1, Ordering::SeqCst);
        }
    };
    let job = Job::start(&AtOnce, wake(), |ticket| ticket.goes_on(0.25));
    assert!((job.progress() - 0.25).abs() < 1e-3);
    assert!(matches!(job.poll(), Poll::Done(true)));
    assert!(matches!(job.poll(), Poll::Broken), "a result is given once");
    // On a thread, until it is there.
    let job = Job::start(&Threads, wake(), |_| 7);
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
    waiting.0.lock().expect("nobody panicked").clear();
    assert!(matches!(job.poll(), Poll::Broken));
}
