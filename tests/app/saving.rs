//! Nothing is lost: the journal of a session, what a program left behind, and changes that are in no file.

use std::path::{Path, PathBuf};

use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use stillbase::app::window::{App, Clock};
use stillbase::app::{
    AppState, CameraMove, Command, LeftSession, Preferences, ResumePoint, SessionCommand, ViewChange, WindowCommand,
};
use stillbase::files::journal::{self, Journal};
use stillbase::picture::charts::choice::PlotChange;
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::Edit;
use stillbase::session::scenario::Scenario;

use super::screen::{Screen, whole};
use super::{Window, drag, on_screen, session, window};
use crate::Test;
use crate::folder::Folder;

pub const TESTS: &[Test] = tests![
    what_a_program_left_behind_is_found,
    programs_beside_each_other_keep_a_journal_each,
    a_session_that_was_left_behind_is_offered_and_opened,
    one_that_is_not_wanted_goes,
    changes_in_no_file_are_marked_and_asked_for,
    a_question_has_keys_and_pointer_for_itself,
    files_are_remembered_by_the_whole_of_their_names,
    own_plots_and_the_instant_are_recovered,
    a_recovered_session_has_its_file,
    runs_side_by_side_are_saved_and_come_back,
];

fn tell(h: &mut Window, command: Command) {
    h.state_mut().app_state_mut().carry_out(command);
    h.run_steps(3);
}

fn heavier() -> Command {
    Command::Session(SessionCommand::Edit(Edit::set("plant.payload.mass", 0.3)))
}

fn what_a_program_left_behind_is_found() {
    let folder = Folder::new("journal");
    assert!(journal::leftover_journals(&folder.0).is_empty());
    let mut h = window("case-3", Theme::Dark);
    tell(&mut h, heavier());
    let kept = session(&h).to_scenario();
    let running = Journal::begin(&folder.0).expect("the folder can be written");
    journal::write(running.file(), &kept.to_toml()).expect("written");
    assert!(journal::leftover_journals(&folder.0).is_empty(), "its program still runs");
    // A program that is killed lets go of its lock and removes nothing.
    drop(running);
    let left = journal::leftover_journals(&folder.0);
    assert_eq!(left.len(), 1);
    let text = std::fs::read_to_string(&left[0].file).expect("readable");
    assert_eq!(Scenario::parse(&text, "left", None).expect("a session"), kept);
    // The next program does not write over it.
    let next = Journal::begin(&folder.0).expect("another");
    assert_ne!(next.file(), left[0].file);
    journal::write(next.file(), "").expect("written");
    next.end();
    assert_eq!(journal::leftover_journals(&folder.0), left, "one that ended in order leaves nothing");
    journal::remove_journal(&left[0].file);
    assert!(journal::leftover_journals(&folder.0).is_empty());
}

fn programs_beside_each_other_keep_a_journal_each() {
    let folder = Folder::new("journals");
    let all: Vec<Journal> = (0..5).map(|_| Journal::begin(&folder.0).expect("one more")).collect();
    for (i, one) in all.iter().enumerate() {
        journal::write(one.file(), &i.to_string()).expect("written");
    }
    let texts: Vec<String> = all.iter().map(|one| std::fs::read_to_string(one.file()).expect("readable")).collect();
    assert_eq!(texts, ["0", "1", "2", "3", "4"]);
    all.into_iter().for_each(Journal::end);
    assert_eq!(folder.names(), [""; 0], "nothing is left, locks included");
}

fn found(file: &std::path::Path) -> Window {
    let scenario = Scenario::builtin("case-3").expect("built in");
    let app_state = AppState::new(scenario, Theme::Dark).expect("it starts");
    let app_state = app_state.offering_recovery(Some(LeftSession::of(file.into(), "3 minutes ago".into())));
    Harness::builder()
        .with_size([1280.0, 800.0])
        .with_step_dt(0.02)
        .renderer(Screen::new())
        .build_ui_state(whole, App::new(app_state, Clock::Fixed(0.02)))
}

fn a_session_that_was_left_behind_is_offered_and_opened() {
    let folder = Folder::new("left");
    let mut h = window("case-3", Theme::Dark);
    tell(&mut h, heavier());
    tell(&mut h, Command::Session(SessionCommand::Edit(Edit::DragTarget { x: 0.52, y: 0.6 })));
    h.run_steps(20);
    let kept = session(&h).to_scenario();
    let file = folder.file("session-0.toml", kept.to_toml());
    let mut h = found(&file);
    h.run_steps(2);
    assert!(h.query_by_label_contains("3 minutes ago").is_some());
    let held = "with nine-link, 2 changes.\nThe last: drag target to 0.520, 0.600 m";
    assert!(h.query_by_label_contains(held).is_some(), "what it holds");
    h.get_by_label("Open that session").click();
    h.run_steps(4);
    assert_eq!(session(&h).to_scenario().edits, kept.edits);
    assert!(h.query_by_label("Open that session").is_none());
    assert!(h.state().app_state().changes().1, "it is in no file of the person's own");
    assert_eq!(h.state_mut().app_state_mut().take_recovered(), Some(file), "which goes when a journal holds it");
}

fn one_that_is_not_wanted_goes() {
    for (answer, goes) in [("Forget it", true), ("Later", false)] {
        let folder = Folder::new("unwanted");
        let file = folder.file("session-0.toml", "whatever");
        let mut h = found(&file);
        h.run_steps(2);
        h.get_by_label(answer).click();
        h.run_steps(3);
        assert!(h.query_by_label(answer).is_none());
        assert_eq!(h.state_mut().app_state_mut().take_recovered().is_some(), goes, "{answer}");
        assert!(!h.state().app_state().changes().1);
    }
}

fn changes_in_no_file_are_marked_and_asked_for() {
    let folder = Folder::new("unsaved");
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let state = |h: &Window| (h.state().app_state().may_leave(), h.state().app_state().title());
    assert_eq!(state(&h), (true, "Reactionless, from A to B – Stillbase".into()));
    tell(&mut h, heavier());
    assert_eq!(state(&h), (false, "Reactionless, from A to B * – Stillbase".into()));
    tell(&mut h, Command::Window(WindowCommand::Quit));
    assert!(h.query_by_label("One change of this session is in no file.").is_some());
    assert!(!h.state().app_state().wants_to_leave());
    h.get_by_label("Cancel").click();
    h.run_steps(3);
    assert!(h.query_by_label("Save before closing?").is_none() && !h.state().app_state().wants_to_leave());
    let file = folder.path("mine.toml");
    tell(&mut h, Command::Session(SessionCommand::SaveFile(file.clone())));
    assert!(state(&h).0, "saved");
    assert_eq!(h.state().app_state().preferences([1280.0, 800.0]).recent, [file]);
    tell(&mut h, Command::Session(SessionCommand::Undo));
    tell(&mut h, Command::Window(WindowCommand::AskToLeave(true)));
    h.get_by_label("Close without saving").click();
    h.run_steps(3);
    assert!(h.state().app_state().wants_to_leave());
    // With nothing to lose there is no question.
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    tell(&mut h, Command::Window(WindowCommand::Quit));
    assert!(h.state().app_state().wants_to_leave());
}

/// Behind a question nothing happens, whatever is pressed; Esc leaves things as they are.
fn a_question_has_keys_and_pointer_for_itself() {
    let mut h = window("case-3", Theme::Dark);
    tell(&mut h, heavier());
    tell(&mut h, Command::Window(WindowCommand::Quit));
    let before = session(&h).to_scenario();
    for key in [Key::Num1, Key::Num2, Key::V, Key::L, Key::B, Key::T, Key::ArrowRight, Key::Home, Key::CloseBracket] {
        h.key_press(key);
        h.run_steps(2);
    }
    for key in [Key::Z, Key::K, Key::O] {
        h.key_press_modifiers(Modifiers::COMMAND, key);
        h.run_steps(2);
    }
    let at = session(&h).frame().end_effector;
    let from = on_screen(&h, at.re, at.im);
    drag(&mut h, from, from + egui::vec2(-20.0, 20.0));
    h.run_steps(3);
    assert!(h.query_by_label("Save before closing?").is_some());
    assert_eq!(session(&h).to_scenario(), before);
    let view_state = h.state().app_state().view_state();
    assert_eq!(view_state.arrangement.theme, Theme::Dark);
    assert!(
        view_state.open.finder.is_none()
            && view_state.open.dialog.is_none()
            && view_state.below.is_none()
            && !session(&h).is_playing()
    );
    h.key_press(Key::Escape);
    h.run_steps(3);
    assert!(h.query_by_label("Save before closing?").is_none() && !h.state().app_state().wants_to_leave());
    h.key_press(Key::Num1);
    h.run_steps(3);
    assert_eq!(session(&h).scenario().name, "case-1", "and the keys are back");
    // The same of a session that was left behind: Esc asks again at the next start.
    let folder = Folder::new("asked");
    let mut h = found(&folder.file("session-0.toml", "whatever"));
    h.run_steps(2);
    h.key_press(Key::Num1);
    h.run_steps(2);
    assert_eq!(session(&h).scenario().name, "case-3");
    h.key_press(Key::Escape);
    h.run_steps(2);
    assert!(h.query_by_label("Go on where you were?").is_none());
    assert!(h.state_mut().app_state_mut().take_recovered().is_none());
}

/// A file that was opened by a name relative to a folder is found from any other; one that is gone is forgotten.
fn files_are_remembered_by_the_whole_of_their_names() {
    let folder = Folder::new("relative");
    let mut h = window("case-3", Theme::Dark);
    let file = folder.file("mine.toml", session(&h).to_scenario().to_toml());
    let here = std::env::current_dir().expect("a folder");
    let up: PathBuf = here.components().skip(1).map(|_| Path::new("..")).collect();
    let relative = up.join(file.strip_prefix("/").expect("whole"));
    assert!(relative.is_relative() && relative.exists());
    tell(&mut h, Command::Session(SessionCommand::OpenFile(relative)));
    let recent = |h: &Window| h.state().app_state().recent().to_vec();
    assert_eq!(recent(&h), [file.canonicalize().expect("it is there")]);
    tell(&mut h, Command::Session(SessionCommand::OpenFile("case-1".into())));
    assert_eq!(recent(&h).len(), 1, "a built-in name is no file");
    std::fs::remove_file(&file).expect("removed");
    let gone = recent(&h)[0].clone();
    tell(&mut h, Command::Session(SessionCommand::OpenFile(gone)));
    assert_eq!(recent(&h), [""; 0].map(PathBuf::from), "what is gone is forgotten");
    // What an older program remembered by half a name cannot be found any more.
    let liked = Preferences { recent: vec!["mine.toml".into(), file.clone()], ..Preferences::default() };
    assert_eq!(liked.sound().recent, [file]);
}

/// The rows that a person added to the table of runs, its ticks and its order are saved and come back.
fn runs_side_by_side_are_saved_and_come_back() {
    use stillbase::app::{ComparisonCommand, Switch};
    let folder = Folder::new("runs");
    let file = folder.path("runs.toml");
    let table = |h: &Window| -> Vec<(String, bool)> {
        let comparison = h.state().app_state().comparison().expect("open");
        comparison.order().into_iter().map(|i| &comparison.entries()[i]).map(|e| (e.title.clone(), e.shown)).collect()
    };
    let column = |h: &Window| h.state().app_state().comparison().and_then(|comparison| comparison.sorted());
    let mut h = window("case-3", Theme::Dark);
    tell(&mut h, ViewChange::Switch(Switch::Compare, true).into());
    let case_1 = Scenario::builtin("case-1").expect("built in");
    for on in [
        ComparisonCommand::Add(Box::new(case_1.clone())),
        ComparisonCommand::Add(Box::new(case_1)),
        ComparisonCommand::Show(1, true),
        ComparisonCommand::Show(5, false),
        ComparisonCommand::Sort(1),
        ComparisonCommand::Sort(1),
    ] {
        tell(&mut h, Command::Window(WindowCommand::Comparison(on)));
    }
    let (rows, sorted) = (table(&h), column(&h));
    assert_eq!(rows.iter().filter(|(title, shown)| title.starts_with("case-1") && *shown).count(), 1, "{rows:?}");
    assert!(rows.contains(&("Straight line".into(), true)) && sorted == Some((1, true)), "{rows:?}");
    // A table that is closed and opened again is the same.
    tell(&mut h, ViewChange::Switch(Switch::Compare, false).into());
    assert!(h.state().app_state().comparison().is_none());
    tell(&mut h, ViewChange::Switch(Switch::Compare, true).into());
    assert_eq!((table(&h), column(&h)), (rows.clone(), sorted));
    tell(&mut h, Command::Session(SessionCommand::SaveFile(file.clone())));
    let mut h = window("case-2", Theme::Dark);
    tell(&mut h, Command::Session(SessionCommand::OpenFile(file)));
    h.run_steps(6);
    assert_eq!((table(&h), column(&h)), (rows, sorted));
    // A run that nobody can read is said, and the session opens all the same.
    let text = "#| below = \"runs\"\n#| [runs]\n#| [[runs.added]]\n#| shown = true\n#| run = \"cheese\"\n";
    let text = format!("{text}{}", Scenario::builtin("case-3").expect("built in").to_toml());
    let broken = folder.file("broken.toml", text);
    tell(&mut h, Command::Session(SessionCommand::OpenFile(broken)));
    h.run_steps(6);
    assert_eq!(table(&h).len(), 5);
    assert!(h.query_by_label_contains("a run side by side").is_some(), "it says why a row is missing");
}

/// A journal keeps the instant on display and the plots that a person has made.
fn own_plots_and_the_instant_are_recovered() {
    let folder = Folder::new("left-off");
    let mut h = window("case-3", Theme::Dark);
    tell(&mut h, heavier());
    for change in [
        PlotChange::Plot("torque/2".into()),
        PlotChange::Add("Torque".into(), "drives/q1".into()),
        PlotChange::Show("Torque".into(), "torque/2".into(), false),
        PlotChange::Statistics(true),
    ] {
        tell(&mut h, Command::View(ViewChange::Charts(change)));
    }
    tell(&mut h, Command::View(ViewChange::Kind(ViewKind::Space)));
    tell(&mut h, Command::View(ViewChange::Look(CameraMove::Turn([0.3, -0.2]))));
    tell(&mut h, Command::Session(SessionCommand::Seek(1.0)));
    tell(&mut h, Command::Session(SessionCommand::Seek(0.412)));
    let frames = session(&h).frames().len();
    let left_off = h.state().app_state().left_off();
    assert_eq!(left_off.cameras.iter().map(|kept| kept.view).collect::<Vec<_>>(), [ViewKind::Space]);
    assert_eq!(left_off.time, session(&h).frame().time);
    let kept = session(&h).to_scenario();
    let text = left_off.before(&kept.to_toml());
    assert_eq!(ResumePoint::of(&text).as_ref(), Some(&left_off));
    assert_eq!(Scenario::parse(&text, "left", None).expect("a session all the same"), kept);
    assert_eq!(ResumePoint::of(&kept.to_toml()), None);
    let mut h = found(&folder.file("session-0.toml", text));
    h.run_steps(2);
    h.get_by_label("Open that session").click();
    h.run_steps(4);
    assert_eq!(h.state().app_state().left_off(), left_off);
    assert!((session(&h).frame().time - 0.412).abs() < 1e-9);
    assert_eq!(session(&h).frames().len(), frames, "the run is as complete as it was");
    // An instant that the run never had: no more is made than the run has.
    let far = ResumePoint { time: 1e300, ..ResumePoint::default() }.before(&kept.to_toml());
    let mut h = found(&folder.file("session-0.toml", far));
    h.run_steps(2);
    h.get_by_label("Open that session").click();
    h.run_steps(4);
    assert!((session(&h).frame().time - 1.0).abs() < 1e-9 && session(&h).frames().len() <= 1001);
    // What no program wrote does no harm.
    let [flat, still] =
        ["flat = { centre = [0.0, inf], half_height = 1.0 }", "flat = { centre = [0.0, 0.0], half_height = 0.0 }"];
    for camera in [flat, still] {
        let text = format!("#| [[cameras]]\n#| view = \"flat\"\n#| camera = {{ {camera} }}\n");
        assert_eq!(ResumePoint::of(&text), None, "{text}");
    }
    for strange in ["#| time = nan\n", "#| time = -1.0\n", "#| plots = 3\n", "#| \u{0}\n"] {
        assert_eq!(ResumePoint::of(strange), None, "{strange}");
    }
}

/// After a power cut Save writes the file that the session had, and the saved file does not name itself.
fn a_recovered_session_has_its_file() {
    let folder = Folder::new("recovered-file");
    let file = folder.path("mine.toml");
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    tell(&mut h, Command::Session(SessionCommand::SaveFile(file.clone())));
    tell(&mut h, heavier());
    let title = h.state().app_state().title();
    assert!(title.starts_with("mine.toml * – ") && title.ends_with(" – Stillbase"), "{title}");
    let first = std::fs::read_to_string(&file).expect("saved");
    assert!(!first.contains("mine.toml") && !first.contains("0.3"), "{first}");
    let left_off = h.state().app_state().left_off();
    assert_eq!(left_off.file.as_deref(), Some(file.as_path()));
    let journal = folder.file("session-0.toml", left_off.before(&session(&h).to_scenario().to_toml()));
    let mut h = found(&journal);
    h.run_steps(2);
    h.get_by_label("Open that session").click();
    h.run_steps(4);
    assert!(h.state().app_state().changes().1, "the change is in no file of the person");
    h.key_press_modifiers(Modifiers::COMMAND, Key::S);
    h.run_steps(4);
    assert!(h.query_by_label("File name").is_none(), "the file is known");
    assert!(std::fs::read_to_string(&file).expect("saved").contains("mass = 0.3"));
}
