//! The time line: bookmarks, events, branches, and whether time keeps up.

use egui::accesskit::Role;
use egui::{Key, Modifiers, PointerButton};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use stillbase::app::{Command, Message, SessionCommand};
use stillbase::files::journal::{self, Journal};
use stillbase::picture::scene::palette::Theme;
use stillbase::session::Edit;
use stillbase::session::scenario::{MAX_BOOKMARKS, MAX_BRANCHES, Scenario};

use super::{Window, session, window, window_of};
use crate::Test;
use crate::folder::Folder;

pub const TESTS: &[Test] = tests![
    bookmarks_are_found_again,
    a_bookmark_is_named_and_taken_away,
    events_stand_on_the_time_line,
    marks_that_are_close_are_one,
    a_branch_is_shown_compared_and_removed,
    another_path_keeps_what_a_hand_did,
    the_branch_that_goes_is_named,
    a_refused_bookmark_is_no_change,
    what_is_kept_outlives_a_crash,
    slow_time_is_said_and_stays_smooth,
];

fn press(h: &mut Window, modifiers: Modifiers, key: Key) {
    h.key_press_modifiers(modifiers, key);
    h.run_steps(4);
}

fn time(h: &Window) -> f64 {
    session(h).frame().time
}

fn right_click(h: &mut Window, pos: egui::Pos2) {
    h.hover_at(pos);
    h.step();
    for pressed in [true, false] {
        h.event(egui::Event::PointerButton { pos, button: PointerButton::Secondary, pressed, modifiers: PLAIN });
        h.step();
    }
    h.run_steps(3);
}

/// A mark of the time line: a message may say the same.
fn mark<'a>(h: &'a Window, words: &'a str) -> Option<egui_kittest::Node<'a>> {
    h.query_by(move |node| node.role() == Role::Button && node.label().is_some_and(|label| label.contains(words)))
}

fn tell(h: &mut Window, command: Command) {
    h.state_mut().app_state_mut().carry_out(command);
    h.run_steps(3);
}

const PLAIN: Modifiers = Modifiers::NONE;
const SHIFT: Modifiers = Modifiers::SHIFT;

/// K puts a bookmark; a click and N go there; it is saved, undone, and its key takes it away.
fn bookmarks_are_found_again() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    tell(&mut h, Command::Session(SessionCommand::Seek(0.4)));
    press(&mut h, PLAIN, Key::K);
    tell(&mut h, Command::Session(SessionCommand::Seek(0.7)));
    press(&mut h, PLAIN, Key::K);
    let app_state = h.state().app_state();
    assert!(app_state.changes().1, "it is in no file yet");
    assert_eq!(
        app_state.view_state().status.message,
        Some(Message { text: "bookmark 2 at 0.700 s".into(), is_problem: false })
    );
    press(&mut h, PLAIN, Key::Home);
    for (modifiers, want) in [(PLAIN, 0.4), (PLAIN, 0.7), (SHIFT, 0.4)] {
        press(&mut h, modifiers, Key::N);
        assert!((time(&h) - want).abs() < 1e-9, "{} for {want}", time(&h));
    }
    press(&mut h, SHIFT, Key::N);
    assert!((time(&h) - 0.4).abs() < 1e-9, "there is none before");
    tell(&mut h, Command::Session(SessionCommand::Bookmark(5.0, "beyond the end".into())));
    press(&mut h, PLAIN, Key::N);
    press(&mut h, PLAIN, Key::N);
    assert!((time(&h) - 0.7).abs() < 1e-9 && mark(&h, "beyond").is_none(), "{}", time(&h));
    tell(&mut h, Command::Session(SessionCommand::Undo));
    h.get_by_label("bookmark 2 at 0.700 s").click();
    h.run_steps(3);
    assert!((time(&h) - 0.7).abs() < 1e-9, "a click goes there");
    let saved = session(&h).to_scenario();
    let read = Scenario::parse(&saved.to_toml(), "saved", None).expect("what was saved is read");
    assert_eq!(read.bookmarks.len(), 2);
    tell(&mut h, Command::Session(SessionCommand::Open(Box::new(read))));
    assert!(h.query_by_label("bookmark 1 at 0.400 s").is_some(), "opened again");
    press(&mut h, PLAIN, Key::Space);
    tell(&mut h, Command::Session(SessionCommand::Seek(0.7)));
    press(&mut h, PLAIN, Key::K);
    assert!(h.query_by_label("bookmark 2 at 0.700 s").is_none(), "away");
    press(&mut h, Modifiers::COMMAND, Key::Z);
    assert!(h.query_by_label("bookmark 2 at 0.700 s").is_some(), "undone");
}

/// The right button, or Shift K, asks for its name.
fn a_bookmark_is_named_and_taken_away() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    tell(&mut h, Command::Session(SessionCommand::Seek(0.4)));
    press(&mut h, SHIFT, Key::K);
    assert!(h.get_by_label("Name of the bookmark").accesskit_node().is_focused());
    press(&mut h, Modifiers::COMMAND, Key::A);
    h.event(egui::Event::Text("the worst".into()));
    h.step();
    press(&mut h, PLAIN, Key::Enter);
    assert_eq!(session(&h).bookmarks()[0].name, "the worst");
    assert!(h.query_by_label("Name of the bookmark").is_none());
    let at = h.get_by_label("the worst at 0.400 s").rect().center();
    right_click(&mut h, at);
    h.snapshot("bookmark-name-dark");
    h.get_by_label("Remove").click();
    h.run_steps(3);
    assert!(session(&h).bookmarks().is_empty() && h.query_by_label("Name of the bookmark").is_none());
    // One of several that are one mark; what is undone meanwhile is not asked for any more.
    tell(&mut h, Command::Session(SessionCommand::Bookmark(0.405, "near".into())));
    tell(&mut h, Command::Session(SessionCommand::Bookmark(0.4, "first".into())));
    tell(&mut h, Command::Session(SessionCommand::NameBookmark(0.405)));
    assert_eq!(h.get_by_label("Name of the bookmark").value().as_deref(), Some("near"));
    for _ in 0..2 {
        tell(&mut h, Command::Session(SessionCommand::Undo));
    }
    assert!(h.state().app_state().view_state().open.naming.is_none() && session(&h).bookmarks().is_empty());
    // Esc leaves it as it is.
    press(&mut h, SHIFT, Key::K);
    press(&mut h, PLAIN, Key::Escape);
    assert!(h.query_by_label("Name of the bookmark").is_none());
    assert_eq!(session(&h).bookmarks()[0].name, "bookmark 1");
}

/// What happens in a run has a mark that says what and when; its worst moment is one of them.
fn events_stand_on_the_time_line() {
    let mut h = window("case-1", Theme::Light);
    h.get_by_label("Play").click();
    h.run_steps(70);
    let worst = session(&h).frames().iter().max_by(|a, b| a.peaks.arm_moment.total_cmp(&b.peaks.arm_moment));
    let peak = worst.expect("frames").peaks.arm_moment;
    let at = session(&h).frames().iter().find(|frame| frame.peaks.arm_moment == peak).expect("the worst").time;
    let label = format!("peak |n_B| {peak:.4} N m at {at:.3} s");
    h.get_by_label(&label).click();
    h.run_steps(3);
    assert_eq!(time(&h), at);
    h.get_by_label_contains("end of motion at 1.000 s");
    h.get_by_label_contains("the base begins to feel the arm at 0.00");
    // A run that is laid over has its worst moment there too.
    press(&mut h, PLAIN, Key::C);
    assert!(mark(&h, "Other pose: peak").is_none());
    h.get_by_label("Lay over: Other pose").click();
    h.run_steps(3);
    assert!(mark(&h, "Other pose: peak |n_B| 0.4851 N m at").is_some());
    press(&mut h, PLAIN, Key::C);
    assert!(mark(&h, "Other pose: peak").is_none());
    // A change in the run.
    press(&mut h, PLAIN, Key::Home);
    tell(&mut h, Command::Session(SessionCommand::Seek(0.6)));
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::Push { x: 5.0, y: 0.0 })));
    tell(&mut h, Command::Session(SessionCommand::EndGesture));
    assert!(mark(&h, "push with 5.00, 0.00 N at 0.600 s").is_some());
    assert!(h.query_by_label_contains("end of motion").is_none(), "that lies ahead again");
    // In the same words as a recording.
    press(&mut h, Modifiers::COMMAND, Key::Z);
    assert!(mark(&h, "push with").is_none());
}

fn marks_that_are_close_are_one() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    for (i, at) in [0.300, 0.305, 0.310, 0.6].into_iter().enumerate() {
        tell(&mut h, Command::Session(SessionCommand::Bookmark(at, format!("place {i}"))));
    }
    let both = mark(&h, "place 0 at 0.300 s\nplace 1 at 0.305 s\nplace 2 at 0.310 s").expect("one").rect();
    let other = mark(&h, "place 3 at 0.600 s").expect("a mark").rect();
    let bar = h.get_by_role_and_label(Role::Slider, "Time").rect();
    assert!(both.right() < other.left() && bar.x_range().contains(other.center().x), "{both} {other} {bar}");
    assert!(both.bottom() <= bar.center().y - 5.0, "{both} leaves the bar {bar} to be dragged");
    let share = (both.center().x - bar.left()) / bar.width();
    assert!((share - 0.3).abs() < 0.03, "{share}");
}

/// Going on from an earlier moment keeps what is left; it is shown, compared, removed, and saved with the session.
fn a_branch_is_shown_compared_and_removed() {
    let mut h = window("case-3", Theme::Dark);
    h.get_by_label("Play").click();
    h.run_steps(70);
    tell(&mut h, Command::Session(SessionCommand::Seek(0.5)));
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::DragTarget { x: 0.5, y: 0.62 })));
    tell(&mut h, Command::Session(SessionCommand::EndGesture));
    assert!(h.query_by_label("what came after 0.500 s is kept as a branch (H)").is_some());
    h.run_steps(40);
    press(&mut h, PLAIN, Key::Space);
    let here = session(&h).frames().to_vec();
    let at = h.get_by_label_contains("a branch parts: as planned").rect().center();
    right_click(&mut h, at);
    assert!(h.state().app_state().view_state().open.history, "the right button lists the branches");
    h.snapshot("branches-dark");
    h.get_by_label("Branch 1: as planned, parts at 0.500 s, to 1.000 s").click();
    h.run_steps(4);
    assert!(session(&h).script().is_empty() && session(&h).frames().len() == 1001);
    h.get_by_label_contains("Branch 1: drag target to 0.500, 0.620 m, parts at 0.500 s");
    press(&mut h, PLAIN, Key::Escape);
    press(&mut h, PLAIN, Key::G);
    assert!(*session(&h).frames() == here, "G shows the newest branch: the run before");
    press(&mut h, SHIFT, Key::G);
    let comparison = h.state().app_state().comparison().expect("runs side by side");
    let kept: Vec<_> = comparison.entries().iter().filter(|entry| entry.added_by_user).collect();
    assert_eq!(kept.len(), 1);
    assert!(kept[0].shown && kept[0].title == "branch at 0.500 s", "{}", kept[0].title);
    let run = kept[0].outcome.as_ref().expect("it ran");
    assert!(run.summary.reactionless && (run.duration() - 1.0).abs() < 1e-9);
    press(&mut h, PLAIN, Key::C);
    press(&mut h, PLAIN, Key::H);
    h.get_by_label("remove branch").click();
    h.run_steps(3);
    assert_eq!(session(&h).branch_count(), 0);
    assert!(h.query_by_label_contains("Branch 1").is_none());
    press(&mut h, PLAIN, Key::Escape);
    press(&mut h, Modifiers::COMMAND, Key::Z);
    assert_eq!(session(&h).branch_count(), 1, "it comes back");
}

/// Another end point after a drag keeps what was led by hand, says so, and a button leads back.
fn another_path_keeps_what_a_hand_did() {
    let mut h = window_of(Scenario::builtin("case-3").expect("built in"), Theme::Dark, 1000.0);
    h.run_steps(2);
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::DragTarget { x: 0.5, y: 0.62 })));
    tell(&mut h, Command::Session(SessionCommand::EndGesture));
    h.run_steps(20);
    press(&mut h, PLAIN, Key::Space);
    let led = session(&h).frames().to_vec();
    super::type_into(&mut h, "B y m", "0.88");
    assert!(!session(&h).is_dragged() && session(&h).branch_count() == 1, "{:?}", session(&h).forks());
    assert!(h.query_by_label("what you led by hand is kept as a branch (H)").is_some());
    h.snapshot("kept-by-hand-dark");
    h.get_by_label("Show the branch").click();
    h.run_steps(4);
    assert!(session(&h).is_dragged() && *session(&h).frames() == led, "here it is again");
    assert!(h.query_by_label("Show the branch").is_none());
}

/// One more branch than there may be takes the place of the oldest, and that is said.
fn the_branch_that_goes_is_named() {
    let mut h = window("case-3", Theme::Dark);
    h.get_by_label("Play").click();
    h.run_steps(20);
    let said = |h: &Window| {
        h.state().app_state().view_state().status.message.clone().map_or_else(String::new, |message| message.text)
    };
    for i in 0..=MAX_BRANCHES {
        assert!(!said(&h).contains("is gone"), "{}", said(&h));
        let app_state = h.state_mut().app_state_mut();
        app_state.carry_out(SessionCommand::Seek(0.1));
        app_state.carry_out(SessionCommand::Edit(Edit::DragTarget { x: 0.48 + 0.001 * i as f64, y: 0.6 }));
        app_state.carry_out(SessionCommand::EndGesture);
        h.run_steps(2);
    }
    assert_eq!(session(&h).branch_count(), MAX_BRANCHES);
    assert!(said(&h).contains("the oldest of 32 is gone: as planned"), "{}", said(&h));
}

/// What is refused is no change: nothing is to be saved.
fn a_refused_bookmark_is_no_change() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    for i in 0..MAX_BOOKMARKS {
        tell(&mut h, Command::Session(SessionCommand::Bookmark(0.009 * i as f64, format!("mark {i}"))));
    }
    let before = h.state().app_state().changes();
    for command in [
        Command::Session(SessionCommand::Bookmark(0.9995, "more".into())),
        Command::Session(SessionCommand::NameBookmark(0.9995)),
    ] {
        tell(&mut h, command);
        let app_state = h.state().app_state();
        assert_eq!((app_state.changes(), app_state.view_state().open.naming), (before, None));
        let Message { text: said, is_problem: bad } =
            app_state.view_state().status.message.clone().expect("it is said");
        assert!(bad && said.contains("take one away"), "{said}");
    }
}

/// The journal holds bookmarks and branches, and the next start has them.
fn what_is_kept_outlives_a_crash() {
    let folder = Folder::new("kept");
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    tell(&mut h, Command::Session(SessionCommand::Seek(0.6)));
    tell(&mut h, Command::Session(SessionCommand::Seek(0.4)));
    let before = h.state().app_state().changes().0;
    press(&mut h, PLAIN, Key::K);
    assert!(h.state().app_state().changes().0 > before, "the journal is told");
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::DragTarget { x: 0.5, y: 0.62 })));
    press(&mut h, PLAIN, Key::Space);
    let journal = Journal::begin(&folder.0).expect("the folder can be written");
    journal::write(journal.file(), &session(&h).to_scenario().to_toml()).expect("written");
    let (kept, forks) = (session(&h).bookmarks().to_vec(), session(&h).forks());
    assert_eq!((kept.len(), forks.len()), (1, 1));
    let file = journal.file().to_owned();
    drop(journal);
    let mut next = window("case-1", Theme::Dark);
    tell(&mut next, Command::Session(SessionCommand::OpenFile(file)));
    assert_eq!((session(&next).bookmarks(), session(&next).forks()), (&kept[..], forks));
    assert!(mark(&next, "bookmark 1 at 0.400 s").is_some() && mark(&next, "a branch parts: as planned").is_some());
}

/// Where a step takes longer than it lasts, repaints do fewer of them, and the clock says how fast time passes.
fn slow_time_is_said_and_stays_smooth() {
    let mut h = window("case-3", Theme::Dark);
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::set("task.time", 10.0))));
    let bar = |h: &Window| h.get_by_role_and_label(Role::Slider, "Time").rect();
    h.get_by_label("Play").click();
    h.run_steps(40);
    assert!(h.query_by_label_contains("real time").is_none() && h.state().app_state().lagging_rate().is_none());
    let before = bar(&h);
    // Each step takes 2 ms from now on; of a repaint of 20 ms, 12 are for them.
    for _ in 0..80 {
        let step = session(&h).frame().step;
        h.step();
        let done = session(&h).frame().step - step;
        h.state_mut().app_state_mut().record_cost(0.002 * done as f64);
    }
    let step = session(&h).frame().step;
    h.run_steps(10);
    let done = session(&h).frame().step - step;
    assert_eq!(done, 60, "6 steps a repaint: it takes 12 ms and not 40");
    let told = h.get_by_label("0.3× real time").rect();
    assert!(bar(&h) == before, "nothing moves: {} for {before}", bar(&h));
    assert!(told.bottom() < 44.0 && told.left() > before.right(), "{told}");
    h.snapshot("behind-dark");
    press(&mut h, PLAIN, Key::Space);
    assert!(h.query_by_label_contains("real time").is_none(), "time stands");
    // What is known already is played back at its own pace.
    for _ in 0..10 {
        h.state_mut().app_state_mut().record_cost(0.0);
        h.step();
    }
    press(&mut h, PLAIN, Key::Home);
    press(&mut h, PLAIN, Key::Space);
    for _ in 0..60 {
        h.state_mut().app_state_mut().record_cost(1e-6);
        h.step();
    }
    assert!(h.query_by_label_contains("real time").is_none(), "{:?}", h.state().app_state().lagging_rate());
}
