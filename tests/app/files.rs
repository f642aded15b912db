//! Files through the window: opened, saved, recorded and dropped, good and bad.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use stillbase::app::{Layout, Message, SessionCommand, ViewChange};
use stillbase::mechanics::sketch::{SketchStep, Template};
use stillbase::picture::charts::choice::PlotChange;
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::Edit;
use stillbase::session::scenario::Scenario;

use super::{Window, hold, painted, session, window};
use crate::Test;
use crate::folder::Folder;

pub const TESTS: &[Test] = tests![
    a_session_is_saved_and_opened_as_it_was,
    the_file_menu_leads_to_every_file,
    a_session_keeps_its_file_and_what_the_window_showed,
    a_file_written_by_hand_is_not_written_over,
    undone_opening_leads_back_to_the_file_before,
    what_is_no_scenario_is_refused_and_changes_nothing,
    a_file_that_is_dropped_is_opened,
    a_machine_that_is_dropped_gets_a_task,
    a_model_of_another_program_is_opened_as_a_machine,
    nothing_is_written_over,
    what_cannot_be_written_is_said,
    a_recording_is_held_against_its_run,
    a_run_is_recorded_whole_or_not,
    a_dialog_that_is_left_does_nothing,
    a_machine_goes_elsewhere_from_the_design_view,
    all_faults_of_a_file_are_listed,
    what_is_left_out_of_a_model_is_listed,
    a_file_that_changes_is_taken_up,
    a_machine_from_a_file_is_its_own_and_keeps_the_time,
    a_saved_machine_leaves_nothing_to_ask,
];

/// A file that is dropped: its name.
#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        fs::read(&self.0).map_err(|e| e.to_string())
    }
}

fn drop_on(h: &mut Window, path: &Path) {
    h.input_mut().dropped_files.push(Arc::new(Dropped(path.into())));
    h.run_steps(3);
}

/// Which dialog, and how one comes to it.
#[derive(Clone, Copy, Debug)]
enum Ask {
    Open,
    Save,
    Record,
}

/// Opens the dialog by its keys.
fn ask(h: &mut Window, what: Ask) {
    match what {
        Ask::Open => h.key_press_modifiers(Modifiers::COMMAND, Key::O),
        Ask::Save => h.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::S),
        Ask::Record => h.key_press(Key::R),
    }
    h.run_steps(3);
    assert!(h.query_by_label("File name").is_some(), "{what:?}: the name is asked for");
}

/// Types a name over what stands there, and presses Enter.
fn answer(h: &mut Window, path: &Path) {
    h.key_press_modifiers(Modifiers::COMMAND, Key::A);
    h.step();
    h.event(egui::Event::Text(path.display().to_string()));
    h.run_steps(2);
    h.key_press(Key::Enter);
    h.run_steps(4);
}

fn name_file(h: &mut Window, what: Ask, path: &Path) {
    ask(h, what);
    answer(h, path);
}

/// The list about a file, by its title; `None` if there is none.
fn report(h: &Window) -> Option<String> {
    h.state().app_state().view_state().open.report.as_ref().map(stillbase::app::FileReport::title)
}

/// A file with several faults is answered by a list, which can be copied and is left by Esc.
fn all_faults_of_a_file_are_listed() {
    let folder = Folder::new("faults");
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let own = include_str!("../../assets/machines/two-drive.toml");
    let bad = own.replacen("mass = 2.0", "mass = -2.0", 1).replacen("mass = 1.0", "weight = 1.0", 1);
    let file = folder.file("bad.toml", bad.replacen("[lengths]", "belt = 2\n[lengths]", 1));
    for dialog in [true, false] {
        if dialog {
            name_file(&mut h, Ask::Open, &file);
        } else {
            drop_on(&mut h, &file);
        }
        assert_eq!(report(&h).as_deref(), Some("bad.toml: 3 faults"));
        let said = painted(&h);
        let says = |words: &str| said.iter().any(|text| text.contains(words));
        assert!(says("A belt from the base") || says("a belt from the base"), "{said:?}");
        assert!(says("mass of link 1 (link.1.mass) is -2: want 1e-15") && says("mass = 1.2"), "{said:?}");
        assert_eq!(session(&h).scenario().name, "case-3");
        h.get_by_label("Copy the list").click();
        h.run_steps(2);
        let said = h.state().app_state().view_state().status.message.clone().expect("it is said");
        assert!(!said.is_problem && said.text.contains("copied"), "{said:?}");
        h.key_press(Key::Escape);
        h.run_steps(2);
        assert!(report(&h).is_none() && h.query_by_label("File name").is_none());
    }
    drop_on(&mut h, &folder.file("empty.toml", ""));
    assert_eq!(report(&h).as_deref(), Some("empty.toml: 1 fault"));
    assert!(painted(&h).iter().any(|text| text.contains("attach = \"base\"")), "a smallest machine is shown");
    // What is opened next closes the list.
    drop_on(&mut h, &folder.file("good.toml", own));
    assert!(report(&h).is_none());
}

/// What a model leaves out is listed once it is written, and again when it is read.
fn what_is_left_out_of_a_model_is_listed() {
    let folder = Folder::new("left-out");
    let mut h = window("scara", Theme::Light);
    h.run_steps(2);
    let file = folder.path("arm.xml");
    h.state_mut().app_state_mut().carry_out(SessionCommand::TakeElsewhere(file));
    h.run_steps(4);
    let title = report(&h).expect("MJCF has no names of angles");
    assert!(title.starts_with("arm.xml: ") && title.ends_with("left out when it was written"), "{title}");
    h.get_by_label("Close").click();
    h.run_steps(2);
    assert!(report(&h).is_none());
    let model = "<robot name=\"x\"><link name=\"base\"/><link name=\"a\"><inertial><mass value=\"1\"/>\
                 <inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial></link><link name=\"tool\"/>\
                 <joint name=\"j\" type=\"continuous\"><parent link=\"base\"/><child link=\"a\"/><axis xyz=\"0 0 1\"/>\
                 <dynamics damping=\"0.5\"/></joint>\
                 <joint name=\"t\" type=\"fixed\"><parent link=\"a\"/><child link=\"tool\"/><origin xyz=\"0.5 0 0\"/></joint>\
                 </robot>";
    drop_on(&mut h, &folder.file("one.urdf", model));
    h.run_steps(3);
    let why = h.state().app_state().view_state().status.message.clone();
    assert_eq!(report(&h).as_deref(), Some("one.urdf: 1 thing left out when it was read"), "{why:?}");
}

/// Another program changes the file: it is taken up as one change; a broken one changes nothing; with changes of one's
/// own the window asks.
fn a_file_that_changes_is_taken_up() {
    let folder = Folder::new("changes");
    let own = include_str!("../../assets/machines/two-drive.toml");
    let with = |mass: &str| own.replacen("mass = 2.0", &format!("mass = {mass}"), 1);
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let file = folder.file("arm.toml", own);
    drop_on(&mut h, &file);
    h.run_steps(3);
    let mass = |h: &Window| session(h).scenario().machine.spec().links[0].mass;
    assert_eq!(mass(&h), 2.0);
    // Seen once it rests, at the second look.
    let look = |h: &mut Window| {
        h.state_mut().app_state_mut().look_at_file(1.0);
        h.run_steps(3);
    };
    look(&mut h);
    let undo_count = session(&h).undo_count();
    folder.file("arm.toml", with("2.125"));
    look(&mut h);
    assert_eq!(mass(&h), 2.0, "it may still be written");
    look(&mut h);
    assert_eq!(mass(&h), 2.125);
    assert_eq!(session(&h).undo_title(), Some("taken from the file"));
    assert_eq!(session(&h).undo_count(), undo_count + 1);
    done(&h, "taken from the file");
    assert!(!h.state().app_state().changes().1, "nothing is unsaved");
    // A file that is broken keeps the machine, and shows its faults; mended, it is taken.
    folder.file("arm.toml", with("-3"));
    look(&mut h);
    look(&mut h);
    assert_eq!((mass(&h), report(&h).as_deref()), (2.125, Some("arm.toml: 1 fault")));
    look(&mut h);
    folder.file("arm.toml", with("2.25"));
    look(&mut h);
    look(&mut h);
    assert!(mass(&h) == 2.25 && report(&h).is_none());
    // Changes of one's own are asked about.
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::set("link.1.mass", 5.0)));
    h.state_mut().app_state_mut().carry_out(SessionCommand::EndGesture);
    h.run_steps(2);
    folder.file("arm.toml", with("2.0625"));
    look(&mut h);
    look(&mut h);
    assert_eq!(mass(&h), 5.0);
    h.get_by_label("Keep mine").click();
    h.run_steps(3);
    look(&mut h);
    assert!(mass(&h) == 5.0 && h.query_by_label("Keep mine").is_none());
    folder.file("arm.toml", with("2.03125"));
    look(&mut h);
    look(&mut h);
    h.get_by_label("Take the file's").click();
    h.run_steps(4);
    assert_eq!(mass(&h), 2.03125);
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(4);
    assert_eq!(mass(&h), 5.0);
    // A file that is gone changes nothing.
    fs::remove_file(&file).expect("it is there");
    look(&mut h);
    look(&mut h);
    assert_eq!(mass(&h), 5.0);
}

/// From the foot of the design view; the ending of the name says what is written.
fn a_machine_goes_elsewhere_from_the_design_view() {
    let folder = Folder::new("elsewhere-window");
    let mut h = window("nine-link-geared", Theme::Dark);
    h.run_steps(2);
    h.key_press(Key::D);
    h.run_steps(3);
    let mut take = |name: &str| {
        let path = folder.path(name);
        h.get_by_label("take it along →").click();
        h.run_steps(3);
        assert!(h.query_by_label("File name").is_some(), "{name}: the name is asked for");
        answer(&mut h, &path);
        match name.rsplit('.').next() {
            Some("txt") => refused(&h, "want one that ends in .xml, .urdf", true),
            _ => done(&h, "saved"),
        }
        fs::read(path).map_or_else(|_| String::new(), |bytes| String::from_utf8_lossy(&bytes).into_owned())
    };
    assert!(take("arm.urdf").contains("<robot name=\"nine-link-geared\">"));
    assert!(take("arm.xml").contains("<mujoco model=\"nine-link-geared\">"));
    assert!(take("arm.svg").contains("<svg "));
    assert!(take("arm.dxf").contains("AC1009"));
    assert!(take("arm.csv").contains("\nmotor,"));
    assert!(take("arm.parquet").starts_with("PAR1"));
    assert!(take("arm.md").contains("# Parts of nine-link-geared"));
    assert!(take("arm.txt").is_empty());
    answer(&mut h, &folder.path("arm.svg"));
    refused(&h, "exists", true);
    assert_eq!(folder.names().len(), 7);
}

/// The File menu comes first; it opens, saves, exports and quits, and shows recent files with their folder.
fn the_file_menu_leads_to_every_file() {
    let folder = Folder::new("menu");
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    name_file(&mut h, Ask::Save, &folder.path("mine.toml"));
    done(&h, "saved");
    let left = |h: &Window, label: &str| h.get_by_label(label).rect().left();
    assert!(left(&h, "File") < left(&h, "Machine") && left(&h, "Machine") < left(&h, "Scenario"));
    h.get_by_label("File").click();
    h.run_steps(3);
    for entry in
        ["New session", "Open", "Open recent", "Save", "Save as", "Record for the Rerun viewer", "Export", "Quit"]
    {
        assert!(h.query_all_by_label_contains(entry).next().is_some(), "{entry}");
    }
    h.get_by_label_contains("Open recent").click();
    h.run_steps(4);
    let said = painted(&h);
    let (file, within) = ("mine.toml".to_owned(), folder.0.display().to_string());
    let named = |text: &String| *text == file || !text.is_empty() && within.starts_with(text.trim_end_matches('…'));
    assert!(said.iter().filter(|text| named(text)).count() >= 2, "{said:?}");
    h.get_by_label("Open mine.toml").click();
    h.run_steps(4);
    done(&h, "opened");
}

/// Once a session has a file, Save asks no more; the file brings back plots, layout, view and instant.
fn a_session_keeps_its_file_and_what_the_window_showed() {
    let folder = Folder::new("kept");
    let file = folder.path("mine.toml");
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    name_file(&mut h, Ask::Save, &file);
    done(&h, "saved");
    let first = fs::read_to_string(&file).expect("it is there");
    let app_state = h.state_mut().app_state_mut();
    app_state.carry_out(ViewChange::Layout(Layout::Compare));
    app_state.carry_out(ViewChange::Kind(ViewKind::Tower));
    app_state.carry_out(ViewChange::Charts(PlotChange::Plot("torque/2".into())));
    app_state.carry_out(ViewChange::Speed(0.25));
    app_state.carry_out(SessionCommand::Edit(Edit::set("task.time", 2.0)));
    app_state.carry_out(SessionCommand::Seek(0.25));
    h.run_steps(3);
    let kept = h.state().app_state().left_off();
    h.key_press_modifiers(Modifiers::COMMAND, Key::S);
    h.run_steps(4);
    done(&h, "saved");
    assert_ne!(fs::read_to_string(&file).expect("it is there"), first);
    assert!(!h.state().app_state().changes().1, "all is saved");
    let mut other = window("two-drive", Theme::Dark);
    other.run_steps(2);
    drop_on(&mut other, &file);
    assert_eq!(other.state().app_state().left_off(), kept);
    // It has its file there, too.
    other.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::set("task.time", 3.0)));
    other.key_press_modifiers(Modifiers::COMMAND, Key::S);
    other.run_steps(4);
    done(&other, "saved");
    assert!(fs::read_to_string(&file).expect("it is there").contains("time = 3.0"));
}

/// After the opening of another file is undone, Save writes the file of the session that is back, never the other one.
fn undone_opening_leads_back_to_the_file_before() {
    let folder = Folder::new("back");
    let [mine, other] = ["mine.toml", "other.toml"].map(|name| folder.path(name));
    let mut h = window("two-drive", Theme::Dark);
    h.run_steps(2);
    name_file(&mut h, Ask::Save, &other);
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    name_file(&mut h, Ask::Save, &mine);
    let [text_of_mine, text_of_other] = [&mine, &other].map(|file| fs::read_to_string(file).expect("it is there"));
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::set("task.time", 2.0)));
    h.state_mut().app_state_mut().carry_out(SessionCommand::EndGesture);
    drop_on(&mut h, &other);
    assert_eq!(session(&h).scenario().name, "two-drive");
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(4);
    assert_eq!(session(&h).scenario().task.time, 2.0);
    h.key_press_modifiers(Modifiers::COMMAND, Key::S);
    h.run_steps(4);
    done(&h, "mine.toml");
    assert_eq!(fs::read_to_string(&other).expect("it is there"), text_of_other);
    assert_ne!(fs::read_to_string(&mine).expect("it is there"), text_of_mine);
    // Forward again, it is the other file's session once more.
    h.key_press_modifiers(Modifiers::COMMAND, Key::Y);
    h.run_steps(4);
    let saved = fs::read_to_string(&mine).expect("it is there");
    h.key_press_modifiers(Modifiers::COMMAND, Key::S);
    h.run_steps(4);
    done(&h, "other.toml");
    assert_eq!(fs::read_to_string(&mine).expect("it is there"), saved);
}

/// A scenario written by hand has comments that a saved session lacks: Save asks for a name.
fn a_file_written_by_hand_is_not_written_over() {
    let folder = Folder::new("by-hand");
    let text = include_str!("../../assets/scenarios/case-3.toml");
    let file = folder.file("mine.toml", text);
    let mut h = window("two-drive", Theme::Dark);
    h.run_steps(2);
    drop_on(&mut h, &file);
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::set("task.time", 2.0)));
    h.key_press_modifiers(Modifiers::COMMAND, Key::S);
    h.run_steps(4);
    assert!(h.query_by_label("File name").is_some(), "the name is asked for");
    assert_eq!(fs::read_to_string(&file).expect("it is there"), text);
}

/// What the window says, if it is good news.
#[track_caller]
fn done(h: &Window, words: &str) {
    let Message { text: said, is_problem: bad } =
        h.state().app_state().view_state().status.message.clone().expect("it is said");
    assert!(!bad && said.contains(words), "{said:?} does not say {words:?}");
    assert!(h.query_by_label("File name").is_none(), "the dialog has gone");
}

/// Refused with these words, on the screen; `dialog` says whether another name can be typed at once.
#[track_caller]
fn refused(h: &Window, words: &str, dialog: bool) {
    let Message { text: said, is_problem: bad } = h
        .state()
        .app_state()
        .view_state()
        .status
        .message
        .clone()
        .unwrap_or_else(|| panic!("nothing said about {words:?}"));
    assert!(bad && said.contains(words), "{said:?} does not say {words:?}");
    assert!(h.query_by_label(&said).is_some(), "{said} is on the screen");
    assert_eq!(h.query_by_label("File name").is_some(), dialog, "{said}");
}

fn a_session_is_saved_and_opened_as_it_was() {
    let folder = Folder::new("window");
    let file = folder.path("mine.toml");
    let mut h = window("case-3", Theme::Dark);
    h.step();
    hold(&mut h);
    h.key_press(Key::Space);
    h.run_steps(20);
    h.key_press(Key::Space);
    h.run_steps(2);
    let saved = session(&h).to_scenario();
    name_file(&mut h, Ask::Save, &file);
    done(&h, "saved");
    assert_eq!(Scenario::parse(&fs::read_to_string(&file).expect("written"), "mine", None).expect("valid"), saved);
    assert_eq!(folder.names(), ["mine.toml"], "nothing is left beside it");
    h.key_press(Key::Num1);
    h.run_steps(3);
    assert_eq!(session(&h).scenario().name, "case-1");
    name_file(&mut h, Ask::Open, &file);
    done(&h, "opened");
    assert_eq!(session(&h).to_scenario(), saved);
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(3);
    assert_eq!(session(&h).scenario().name, "case-1", "opening is an undo of its own");
}

/// Bad files: what each is, and what is said about it.
fn bad(folder: &Folder) -> [(PathBuf, &'static str); 7] {
    let case = include_str!("../../assets/scenarios/case-3.toml");
    [
        (folder.file("noise.toml", b"\x00\xff\xfe nonsense"), "UTF-8"),
        (folder.file("empty.toml", b""), "machine"),
        (folder.file("cut.toml", &case.as_bytes()[..case.len() / 2]), "cut.toml"),
        (folder.file("odd.toml", case.replace("b = 2.4", "b = 2.4\nc = 1.0").as_bytes()), "odd.toml:"),
        (folder.file("far.toml", case.replace("to = [0.55, 0.90]", "to = [5.5, 0.90]").as_bytes()), "5.5"),
        (folder.path("nowhere.toml"), "nowhere.toml"),
        (folder.0.clone(), "folder"),
    ]
}

fn what_is_no_scenario_is_refused_and_changes_nothing() {
    let folder = Folder::new("window");
    let mut h = window("case-3", Theme::Dark);
    h.step();
    hold(&mut h);
    for (file, words) in bad(&folder) {
        let (before, frames) = (session(&h).to_scenario(), session(&h).frames().to_vec());
        name_file(&mut h, Ask::Open, &file);
        refused(&h, words, true);
        assert_eq!(session(&h).to_scenario(), before, "{}", file.display());
        h.key_press(Key::Escape);
        h.run_steps(2);
        drop_on(&mut h, &file);
        refused(&h, words, false);
        assert_eq!(session(&h).to_scenario(), before, "{}", file.display());
        assert!(*session(&h).frames() == frames);
    }
    // What is good can be opened all the same.
    drop_on(&mut h, &folder.file("good.toml", include_bytes!("../../assets/scenarios/case-1.toml")));
    done(&h, "opened");
    assert_eq!(session(&h).scenario().name, "case-1");
}

fn a_machine_that_is_dropped_gets_a_task() {
    let folder = Folder::new("window");
    let mut h = window("case-3", Theme::Dark);
    h.step();
    hold(&mut h);
    let file = folder.file("serial.toml", include_bytes!("../../assets/machines/serial-3r.toml"));
    drop_on(&mut h, &file);
    done(&h, "is a machine, so a task was made for it: reactionless");
    assert_eq!(session(&h).scenario().name, "serial-3r");
    h.key_press(Key::Num1);
    h.run_steps(3);
    name_file(&mut h, Ask::Open, &file);
    done(&h, "is a machine, so a task was made for it");
    // What is wrong with one is said with its line.
    let broken = include_str!("../../assets/machines/serial-3r.toml").replacen("mass = ", "mass = -", 1);
    drop_on(&mut h, &folder.file("broken.toml", broken.as_bytes()));
    refused(&h, "broken.toml:", false);
    assert_eq!(session(&h).scenario().name, "serial-3r");
}

fn a_file_that_is_dropped_is_opened() {
    let folder = Folder::new("window");
    let mut h = window("case-3", Theme::Dark);
    h.step();
    let file = folder.file("one.toml", include_bytes!("../../assets/scenarios/spacecraft.toml"));
    // While a dialog asks for a name too, and while time runs.
    for (dialog, plays) in [(false, false), (true, false), (false, true)] {
        h.key_press(Key::Num3);
        h.run_steps(2);
        h.key_press(Key::Space);
        h.run_steps(2);
        assert_eq!(session(&h).scenario().name, "case-3");
        if dialog {
            ask(&mut h, Ask::Open);
        }
        if plays {
            h.key_press(Key::Home);
            h.key_press(Key::Space);
            h.run_steps(5);
        }
        drop_on(&mut h, &file);
        done(&h, "opened");
        assert_eq!(session(&h).to_scenario(), Scenario::builtin("spacecraft").expect("built in"));
    }
    assert_eq!(folder.names(), ["one.toml"]);
}

/// What the window writes for other programs it reads again, and a model that is none says why.
fn a_model_of_another_program_is_opened_as_a_machine() {
    let folder = Folder::new("model");
    let mut h = window("two-drive", Theme::Dark);
    for name in ["arm.urdf", "arm.xml"] {
        let file = folder.path(name);
        h.state_mut().app_state_mut().carry_out(SessionCommand::TakeElsewhere(file.clone()));
        h.run_steps(3);
        let mass = session(&h).scenario().machine.mass();
        drop_on(&mut h, &file);
        h.run_steps(3);
        let machine = &session(&h).scenario().machine;
        assert!((machine.mass() - mass).abs() < 1e-6 && machine.drives() == 2, "{name}: {} kg", machine.mass());
        let Message { text: said, is_problem: bad } =
            h.state().app_state().view_state().status.message.clone().expect("what it is");
        assert!(!bad && said.contains("is a machine, so a task was made for it"), "{name}: {said}");
        assert_eq!(h.state().app_state().recent()[0], file.canonicalize().expect("it is there"));
    }
    drop_on(&mut h, &folder.file("none.urdf", "<robot name='x'><link name='a'/></robot>"));
    let Message { text: said, is_problem: bad } =
        h.state().app_state().view_state().status.message.clone().expect("why not");
    assert!(bad && said.contains("none.urdf"), "{said}");
}

/// A file that is there stays as it is, whatever it is; the dialog stays for another name.
fn nothing_is_written_over() {
    let folder = Folder::new("window");
    for (ending, what) in [("toml", Ask::Save), ("rrd", Ask::Record)] {
        let (mine, other) = (format!("mine.{ending}"), format!("other.{ending}"));
        let file = folder.file(&mine, b"somebody's own work");
        let mut h = window("case-3", Theme::Dark);
        h.step();
        name_file(&mut h, what, &file);
        refused(&h, "exists: want another name", true);
        assert_eq!(fs::read(&file).expect("still there"), b"somebody's own work");
        answer(&mut h, &folder.path(&other));
        done(&h, &other);
        // Not even what has just been written, by who asks for it twice.
        let written = fs::read(folder.path(&other)).expect("written");
        hold(&mut h);
        name_file(&mut h, what, &folder.path(&other));
        refused(&h, "exists: want another name", true);
        assert_eq!(fs::read(folder.path(&other)).expect("still there"), written);
    }
    assert_eq!(folder.names(), ["mine.rrd", "mine.toml", "other.rrd", "other.toml"]);
}

fn what_cannot_be_written_is_said() {
    let folder = Folder::new("window");
    let plain = folder.file("plain", b"no folder");
    let sub = folder.path("sub");
    fs::create_dir(&sub).expect("a folder");
    let long = folder.path(&"x".repeat(300));
    for what in [Ask::Save, Ask::Record] {
        let mut h = window("case-3", Theme::Dark);
        h.step();
        let before = session(&h).to_scenario();
        ask(&mut h, what);
        for (path, words) in [
            (folder.path("missing/run.toml"), "no folder"),
            (sub.clone(), "sub"),
            (plain.join("run.toml"), "run.toml"),
            (long.clone(), "xxx"),
            #[cfg(target_os = "linux")]
            ("/dev/full".into(), "/dev/full"),
        ] {
            answer(&mut h, &path);
            refused(&h, words, true);
            assert_eq!(session(&h).to_scenario(), before);
            assert_eq!(folder.names(), ["plain", "sub"], "{what:?} {}", path.display());
        }
    }
}

/// A recording is opened like a session, is simulated again, and the message says whether both are equal.
fn a_recording_is_held_against_its_run() {
    let folder = Folder::new("window");
    let mut h = window("case-2", Theme::Dark);
    h.step();
    let file = folder.path("run.rrd");
    name_file(&mut h, Ask::Record, &file);
    done(&h, "run.rrd");
    let mut h = window("case-1", Theme::Dark);
    drop_on(&mut h, &file);
    h.run_steps(3);
    done(&h, "run.rrd, simulated again: equal: ");
    assert_eq!(session(&h).scenario().name, "case-2");
    // A recording without its end is refused, and the session stays.
    let bytes = fs::read(&file).expect("a recording");
    drop_on(&mut h, &folder.file("cut.rrd", &bytes[..bytes.len() - 1]));
    h.run_steps(3);
    refused(&h, "its end is missing", false);
    assert_eq!(session(&h).scenario().name, "case-2");
}

/// What is recorded is what has been seen; one that exists is left alone in `nothing_is_written_over`.
fn a_run_is_recorded_whole_or_not() {
    let folder = Folder::new("window");
    let mut h = window("case-1", Theme::Dark);
    h.step();
    for (name, played) in [("start.rrd", false), ("end.rrd", true)] {
        if played {
            h.key_press(Key::Space);
            h.run_steps(70);
        }
        name_file(&mut h, Ask::Record, &folder.path(name));
        done(&h, "with reactions");
        let bytes = fs::read(folder.path(name)).expect("written");
        assert!(bytes.starts_with(b"RRF2") && bytes.len() > 100_000, "{name}: {} bytes", bytes.len());
    }
    assert_eq!(folder.names(), ["end.rrd", "start.rrd"]);
    // What waits has no run to record, and says so.
    h.key_press(Key::Num3);
    h.run_steps(2);
    h.state_mut()
        .app_state_mut()
        .carry_out(SessionCommand::Edit(Edit::set("limits.a1", stillbase::settings::change::value("0,2.618"))));
    h.run_steps(2);
    assert!(session(&h).run().waiting().is_some());
    name_file(&mut h, Ask::Record, &folder.path("waits.rrd"));
    refused(&h, "B", true);
    assert_eq!(folder.names(), ["end.rrd", "start.rrd"]);
}

fn a_dialog_that_is_left_does_nothing() {
    let folder = Folder::new("window");
    for what in [Ask::Open, Ask::Save, Ask::Record] {
        for cancel in [true, false] {
            let mut h = window("case-3", Theme::Dark);
            h.step();
            let before = session(&h).to_scenario();
            ask(&mut h, what);
            h.key_press_modifiers(Modifiers::COMMAND, Key::A);
            h.step();
            h.event(egui::Event::Text(folder.path("never.toml").display().to_string()));
            h.run_steps(2);
            match cancel {
                true => h.get_by_label("Cancel").click(),
                false => h.key_press(Key::Escape),
            }
            h.run_steps(3);
            assert!(h.query_by_label("File name").is_none(), "{what:?}");
            assert_eq!(session(&h).to_scenario(), before);
            assert!(h.state().app_state().view_state().status.message.is_none());
        }
    }
    assert!(folder.names().is_empty());
}

/// What a list at the top shows.
fn shown(h: &Window, list: &str) -> String {
    h.get_by_label(list).accesskit_node().value().unwrap_or_default()
}

/// A file's machine with the name of a built-in one is not "(edited)" before it is; and where its file changes, the run
/// stays at its time.
fn a_machine_from_a_file_is_its_own_and_keeps_the_time() {
    let folder = Folder::new("own-machine");
    let own = include_str!("../../assets/machines/two-drive.toml");
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let file = folder.file("two-drive.toml", own.replacen("mass = 2.0", "mass = 2.125", 1));
    drop_on(&mut h, &file);
    h.run_steps(4);
    assert_eq!(shown(&h, "Machine"), "two-drive");
    assert!(!shown(&h, "Scenario").contains("edited"), "{}", shown(&h, "Scenario"));
    h.state_mut().app_state_mut().carry_out(SessionCommand::Seek(0.25));
    h.run_steps(4);
    let look = |h: &mut Window| {
        h.state_mut().app_state_mut().look_at_file(1.0);
        h.run_steps(6);
    };
    look(&mut h);
    folder.file("two-drive.toml", own.replacen("mass = 2.0", "mass = 2.25", 1));
    look(&mut h);
    look(&mut h);
    assert_eq!(session(&h).scenario().machine.spec().links[0].mass, 2.25);
    assert_eq!((session(&h).frame().time, shown(&h, "Machine").as_str()), (0.25, "two-drive"));
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::set("link.1.mass", 2.5)));
    h.run_steps(4);
    assert_eq!(shown(&h, "Machine"), "two-drive (edited)");
    h.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    h.run_steps(4);
    assert_eq!(shown(&h, "Machine"), "two-drive");
    // So is one that has no name of a built-in one.
    drop_on(&mut h, &folder.file("arm.toml", own.replacen("two-drive", "arm", 1)));
    h.run_steps(4);
    assert_eq!(shown(&h, "Machine"), "arm");
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::set("link.1.axial", 0.01)));
    h.run_steps(4);
    assert_eq!(shown(&h, "Machine"), "arm (edited)");
}

/// Saved as a machine, a session that changes only its machine closes without a question.
fn a_saved_machine_leaves_nothing_to_ask() {
    let folder = Folder::new("saved-machine");
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let edit = |h: &mut Window, path: &str, value: f64| {
        h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::set(path, value)));
        h.state_mut().app_state_mut().carry_out(SessionCommand::EndGesture);
        h.run_steps(3);
    };
    edit(&mut h, "link.9.mass", 0.3);
    edit(&mut h, "design.clearance", 0.005);
    assert!(h.state().app_state().changes().1, "unsaved");
    h.state_mut().app_state_mut().carry_out(SessionCommand::TakeElsewhere(folder.path("own.toml")));
    h.run_steps(4);
    done(&h, "saved");
    assert!(!h.state().app_state().changes().1, "all of it is in the file");
    let (machine, design) = (session(&h).scenario().machine.clone(), session(&h).scenario().design.clone());
    let mut other = window("case-1", Theme::Dark);
    drop_on(&mut other, &folder.path("own.toml"));
    other.run_steps(4);
    let opened = session(&other).scenario();
    assert!((&opened.machine, &opened.design) == (&machine, &design) && design.clearance == Some(0.005));
    edit(&mut h, "plant.payload.mass", 0.3);
    h.state_mut().app_state_mut().carry_out(SessionCommand::TakeElsewhere(folder.path("other.toml")));
    h.run_steps(4);
    assert!(h.state().app_state().changes().1, "a machine holds no payload of the plant");
    // A machine that was never saved is not in the file of a later drawing.
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    for template in [Template::SerialOfTwo, Template::Pantograph] {
        let edit = Edit::Sketch(SketchStep::New { template });
        h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(edit));
        h.state_mut().app_state_mut().carry_out(SessionCommand::EndGesture);
        h.run_steps(3);
    }
    h.state_mut().app_state_mut().carry_out(SessionCommand::TakeElsewhere(folder.path("second.toml")));
    h.run_steps(4);
    done(&h, "saved");
    assert!(h.state().app_state().changes().1, "the first drawing is in no file");
    // A drawing that is not complete is no machine to save: the one before is not written in its place.
    let edit = Edit::Sketch(SketchStep::New { template: Template::Blank });
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(edit));
    h.state_mut().app_state_mut().carry_out(SessionCommand::EndGesture);
    h.run_steps(3);
    for name in ["third.toml", "third.dxf"] {
        h.state_mut().app_state_mut().carry_out(SessionCommand::TakeElsewhere(folder.path(name)));
        h.run_steps(4);
        assert!(!folder.path(name).exists(), "{name}");
    }
}
