//! Notes and measures in the window: written by pointer and keyboard, drawn in the scene, found again.

use egui::accesskit::Role;
use egui::{Key, Modifiers, PointerButton, Pos2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use stillbase::app::{Command, ResumePoint, SessionCommand, Tool, ViewChange};
use stillbase::picture::notation::{AngleUnit, LengthUnit, Notation};
use stillbase::picture::scene::Scene;
use stillbase::picture::scene::measurement::Measurement;
use stillbase::picture::scene::options::ViewOptions;
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::pointer::Pointer;
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::scenario::{Note, NoteTime, PathPoint, Scenario, SnapPoint};

use super::{Window, on_screen, session, window};
use crate::Test;

pub const TESTS: &[Test] = tests![
    a_note_is_written_where_the_pointer_is,
    a_note_is_written_on_the_time_line_by_keys,
    a_wrong_note_says_why_and_is_not_written,
    the_list_of_places_works_by_keys,
    a_note_is_found_by_its_words,
    a_distance_is_measured_by_two_clicks_and_follows,
    a_third_click_measures_the_angle,
    measures_are_removed,
    keys_lead_the_measuring_tool,
    points_snap_on_every_machine,
];

const PLAIN: Modifiers = Modifiers::NONE;
const SHIFT: Modifiers = Modifiers::SHIFT;

fn press(h: &mut Window, modifiers: Modifiers, key: Key) {
    h.key_press_modifiers(modifiers, key);
    h.run_steps(4);
}

fn tell(h: &mut Window, command: impl Into<Command>) {
    h.state_mut().app_state_mut().carry_out(command);
    h.run_steps(3);
}

fn click(h: &mut Window, pos: Pos2, button: PointerButton) {
    h.hover_at(pos);
    h.step();
    for pressed in [true, false] {
        h.event(egui::Event::PointerButton { pos, button, pressed, modifiers: PLAIN });
        h.step();
    }
    h.run_steps(3);
}

fn type_text(h: &mut Window, text: &str) {
    h.event(egui::Event::Text(text.into()));
    h.run_steps(2);
}

/// The hints at the start are skipped, and the run is paused at an instant, s.
fn paused(case: &str, time: f64) -> Window {
    let mut h = window(case, Theme::Dark);
    h.run_steps(2);
    tell(&mut h, SessionCommand::Seek(time));
    h
}

fn notes(h: &Window) -> &[Note] {
    session(h).notes()
}

/// The scene as the window draws it.
fn scene(h: &Window) -> Scene {
    let app_state = h.state().app_state();
    let measurements = app_state.view_state().measurements.clone();
    let options = ViewOptions { notes: notes(h).to_vec(), measurements, ..ViewOptions::default() };
    app_state.stage().scene(session(h).frame(), &options)
}

fn words(h: &Window, name: &str) -> Option<String> {
    scene(h).labels.into_iter().find(|label| label.name == name).map(|label| label.text)
}

fn end_effector(h: &Window) -> Pos2 {
    let at = session(h).frame().end_effector;
    on_screen(h, at.re, at.im)
}

/// The right button on the end effector: its note sticks to it, stands in the scene, and is changed and removed there.
fn a_note_is_written_where_the_pointer_is() {
    let mut h = paused("case-3", 0.5);
    let before = h.state().app_state().changes().0;
    let at = end_effector(&h);
    click(&mut h, at, PointerButton::Secondary);
    h.get_by_label("Write a note here").click();
    h.run_steps(3);
    assert!(h.get_by_label("Text of the note").accesskit_node().is_focused(), "the keyboard writes at once");
    type_text(&mut h, "fast here, 0.25 m");
    h.snapshot("note-card-dark");
    press(&mut h, PLAIN, Key::Enter);
    assert!(h.query_by_label("Text of the note").is_none());
    let written =
        Note { text: "fast here, 0.25 m".into(), point: Some(SnapPoint::EndEffector), time: NoteTime::Always };
    assert_eq!(notes(&h), [written]);
    assert!(h.state().app_state().changes().0 > before, "the journal is told");
    let place = |h: &Window| scene(h).labels.iter().find(|label| label.name == "notes/1").expect("drawn").at;
    let here = place(&h);
    tell(&mut h, SessionCommand::Seek(0.0));
    assert_ne!(place(&h), here, "it goes with the end effector");
    // The words are the user's own: no unit is converted.
    tell(&mut h, ViewChange::Notation(Notation { length: LengthUnit::Millimetres, ..Notation::default() }));
    h.get_by_label("Note: fast here, 0.25 m").click();
    h.run_steps(3);
    press(&mut h, Modifiers::COMMAND, Key::A);
    type_text(&mut h, "slow here");
    h.get_by_label("an instant").click();
    h.run_steps(2);
    h.get_by_label("Change").click();
    h.run_steps(3);
    let changed = Note { text: "slow here".into(), point: Some(SnapPoint::EndEffector), time: NoteTime::At(0.0) };
    assert_eq!(notes(&h), [changed]);
    h.get_by_label("Note: slow here").click();
    h.run_steps(3);
    h.get_by_label("Remove").click();
    h.run_steps(3);
    assert!(notes(&h).is_empty() && words(&h, "notes/1").is_none());
    press(&mut h, Modifiers::COMMAND, Key::Z);
    assert_eq!(notes(&h)[0].text, "slow here", "undone");
    tell(&mut h, SessionCommand::Seek(0.5));
    assert!(h.query_by_label("Note: slow here").is_none(), "its instant has passed");
}

/// The list of places is used by keys alone: up and down go through it, while the run stays where it is.
fn the_list_of_places_works_by_keys() {
    let mut h = paused("case-3", 0.4);
    press(&mut h, SHIFT, Key::W);
    type_text(&mut h, "here");
    press(&mut h, PLAIN, Key::Tab);
    let chosen = |h: &Window| h.get_by_label("Where the note sticks").value();
    let nowhere = chosen(&h);
    press(&mut h, PLAIN, Key::ArrowDown);
    let first = chosen(&h);
    assert_ne!(first, nowhere, "down takes the next place");
    press(&mut h, PLAIN, Key::Enter);
    press(&mut h, PLAIN, Key::ArrowDown);
    let second = chosen(&h);
    assert!(second != first && second != nowhere, "also with the list open");
    press(&mut h, PLAIN, Key::ArrowUp);
    assert_eq!(chosen(&h), first);
    press(&mut h, PLAIN, Key::Enter);
    assert!((session(&h).frame().time - 0.4).abs() < 1e-9);
    h.get_by_label("Write").click();
    h.run_steps(3);
    assert!(notes(&h)[0].point.is_some());
}

/// Shift W writes at the instant shown; its mark goes there, and the right button on it changes the note.
fn a_note_is_written_on_the_time_line_by_keys() {
    let mut h = paused("case-3", 0.4);
    press(&mut h, SHIFT, Key::W);
    type_text(&mut h, "half way");
    press(&mut h, PLAIN, Key::Enter);
    assert_eq!(notes(&h), [Note { text: "half way".into(), point: None, time: NoteTime::At(0.4) }]);
    press(&mut h, PLAIN, Key::Home);
    press(&mut h, PLAIN, Key::N);
    assert!((session(&h).frame().time - 0.4).abs() < 1e-9, "{}", session(&h).frame().time);
    let mark = h.get_by_label("note: half way at 0.400 s").rect().center();
    click(&mut h, mark, PointerButton::Secondary);
    assert_eq!(h.get_by_label("Text of the note").value().as_deref(), Some("half way"));
    h.get_by_label("an interval").click();
    h.run_steps(2);
    h.get_by_label("Where the note sticks").click();
    h.run_steps(3);
    h.get_by_label("centre of mass").click();
    h.run_steps(3);
    h.get_by_label("Change").click();
    h.run_steps(3);
    let Note { point, time, .. } = notes(&h)[0].clone();
    assert_eq!(point, Some(SnapPoint::CentreOfMass));
    assert!(matches!(time, NoteTime::Between([from, to]) if from == 0.4 && to >= 0.99), "{time:?}");
    // Beside the marks, the right button writes a note of the instant there.
    let line = h.get_by_label("Time").rect();
    click(&mut h, Pos2::new(line.left() + 0.25 * line.width(), line.bottom() - 2.0), PointerButton::Secondary);
    type_text(&mut h, "a quarter");
    h.get_by_label("Write").click();
    h.run_steps(3);
    let NoteTime::At(time) = notes(&h)[1].time else { panic!("{:?}", notes(&h)) };
    assert!((time - 0.25).abs() < 0.03, "{time}");
    // What is undone while its card is open closes the card.
    // Its tip, if it is shown, says the same.
    let mark = h.get_by(|node| {
        node.role() == Role::Button && node.label().is_some_and(|label| label.contains("note: a quarter"))
    });
    let mark = mark.rect().center();
    click(&mut h, mark, PointerButton::Secondary);
    assert!(h.query_by_label("Text of the note").is_some());
    tell(&mut h, SessionCommand::Undo);
    assert!(h.query_by_label("Text of the note").is_none() && notes(&h).len() == 1);
    // It is in the file.
    let read = Scenario::parse(&session(&h).to_scenario().to_toml(), "saved", None).expect("what was saved is read");
    tell(&mut h, SessionCommand::Open(Box::new(read)));
    assert_eq!(notes(&h).len(), 1);
    assert!(h.query_by_label("note: half way at 0.400 s").is_some(), "opened again");
}

fn a_wrong_note_says_why_and_is_not_written() {
    let mut h = paused("case-3", 0.4);
    press(&mut h, SHIFT, Key::W);
    press(&mut h, PLAIN, Key::Enter);
    assert!(notes(&h).is_empty() && h.query_by_label("Text of the note").is_some(), "an empty text is not written");
    h.get_by_label("Text of the note").focus();
    h.run_steps(2);
    type_text(&mut h, "bell \u{202e}");
    assert!(h.query_by_label_contains("the control character U+202E").is_some());
    press(&mut h, PLAIN, Key::Enter);
    assert!(notes(&h).is_empty());
    h.get_by_label("always").click();
    h.run_steps(2);
    press(&mut h, PLAIN, Key::Escape);
    assert!(h.query_by_label("Text of the note").is_none() && notes(&h).is_empty(), "Esc leaves it");
}

/// A note of an instant leads there; one of all times is opened.
fn a_note_is_found_by_its_words() {
    let mut h = paused("case-3", 0.0);
    for (text, point, time) in
        [("zebra", None, NoteTime::At(0.7)), ("walrus", Some(SnapPoint::BasePin), NoteTime::Always)]
    {
        tell(&mut h, SessionCommand::Note(None, Note { text: text.into(), point, time }));
    }
    for sought in ["zebra", "walrus"] {
        press(&mut h, Modifiers::COMMAND, Key::K);
        type_text(&mut h, sought);
        press(&mut h, PLAIN, Key::Enter);
    }
    assert!((session(&h).frame().time - 0.7).abs() < 1e-9);
    assert_eq!(h.get_by_label("Text of the note").value().as_deref(), Some("walrus"));
}

fn measurements(h: &Window) -> &[Measurement] {
    &h.state().app_state().view_state().measurements
}

/// Position of a point on the screen.
fn at(h: &Window, point: &SnapPoint) -> Pos2 {
    let app_state = h.state().app_state();
    let at = app_state.stage().position(point, &session(h).frame().into()).expect("the machine has it");
    on_screen(h, at.re, at.im)
}

fn click_point(h: &mut Window, point: &SnapPoint) {
    let pos = at(h, point);
    click(h, pos + egui::vec2(2.0, 1.0), PointerButton::Primary);
}

/// From B to the end effector: it snaps, follows the motion, and is written in the user's units.
fn a_distance_is_measured_by_two_clicks_and_follows() {
    let mut h = paused("case-3", 0.4);
    h.get_by_label("measure").click();
    h.run_steps(2);
    assert_eq!(h.state().app_state().view_state().tool, Tool::Measure(Vec::new()));
    let end = SnapPoint::PathPoint(PathPoint::End);
    click_point(&mut h, &end);
    click_point(&mut h, &SnapPoint::EndEffector);
    h.snapshot("measure-dark");
    press(&mut h, PLAIN, Key::Escape);
    assert_eq!(h.state().app_state().view_state().tool, Tool::Hold, "Esc ends the tool");
    assert_eq!(measurements(&h), [Measurement::of(vec![end, SnapPoint::EndEffector])]);
    // A saved session keeps them; points of another machine, or too few, are left out.
    let left = h.state().app_state().left_off();
    assert_eq!(left.measurements, measurements(&h));
    assert_eq!(ResumePoint::of(&left.before("")), Some(left));
    let machine = &h.state().app_state().session().scenario().machine;
    for strange in [vec![], vec![SnapPoint::Target], vec![SnapPoint::Target, SnapPoint::Pin(vec!["nobody".into()])]] {
        assert!(!Measurement::of(strange.clone()).is_of(machine), "{strange:?}");
    }
    let [x, y] = session(&h).scenario().task.to;
    let distance = |h: &Window| {
        let tip = session(h).frame().end_effector;
        format!("{:.3} m", (tip.re - x).hypot(tip.im - y))
    };
    let name = "measures/1/distance/1";
    let first = words(&h, name).expect("drawn");
    assert_eq!(first, distance(&h));
    for (time, view) in [(0.8, ViewKind::Flat), (0.1, ViewKind::Space)] {
        tell(&mut h, ViewChange::Kind(view));
        tell(&mut h, SessionCommand::Seek(time));
        assert_eq!(words(&h, name), Some(distance(&h)));
    }
    assert_ne!(words(&h, name), Some(first), "it follows");
    // Nothing of it is in the session.
    assert!(session(&h).undo_title().is_none() && !h.state().app_state().changes().1);
}

/// The base pin between two pins of the machine: the angle of the paper's drawing, also where the base moves.
fn a_third_click_measures_the_angle() {
    let mut h = paused("case-3", 0.4);
    tell(&mut h, ViewChange::Notation(Notation { angle: AngleUnit::Degrees, ..Notation::default() }));
    press(&mut h, SHIFT, Key::M);
    let points = [SnapPoint::EndEffector, SnapPoint::BasePin, SnapPoint::PathPoint(PathPoint::Start)];
    for point in &points {
        click_point(&mut h, point);
    }
    assert_eq!(measurements(&h), [Measurement::of(points.to_vec())]);
    let (tip, start) = (session(&h).frame().end_effector, session(&h).scenario().task.from);
    let angle = (tip.im.atan2(tip.re) - start[1].atan2(start[0])).abs();
    assert_eq!(words(&h, "measures/1/angle"), Some(format!("{angle:.3} rad")));
    // The next click begins another one; the same point again ends it as a distance.
    click_point(&mut h, &SnapPoint::BasePin);
    let free = on_screen(&h, -0.2, 0.45);
    click(&mut h, free, PointerButton::Primary);
    click(&mut h, free, PointerButton::Primary);
    let [_, second] = measurements(&h) else { panic!("{:?}", measurements(&h)) };
    let [SnapPoint::BasePin, SnapPoint::Place([x, y])] = second.points[..] else { panic!("{second:?}") };
    assert!((x + 0.2).abs() < 2e-3 && (y - 0.45).abs() < 2e-3, "{x}, {y}");
}

/// Delete removes the one under the pointer; the menu does, and the list of commands removes all.
fn measures_are_removed() {
    let mut h = paused("case-3", 0.4);
    let place = |x: f64, y: f64| SnapPoint::Place([x, y]);
    press(&mut h, SHIFT, Key::M);
    for y in [-0.3, -0.2, -0.1] {
        for x in [0.5, 0.7] {
            click_point(&mut h, &place(x, y));
        }
        press(&mut h, PLAIN, Key::Enter);
    }
    press(&mut h, PLAIN, Key::Escape);
    assert_eq!(measurements(&h).len(), 3);
    let beside = on_screen(&h, 0.6, -0.25);
    h.hover_at(beside);
    h.run_steps(2);
    press(&mut h, PLAIN, Key::Delete);
    assert_eq!(measurements(&h).len(), 3, "none is under the pointer");
    let second = on_screen(&h, 0.56, -0.2);
    h.hover_at(second);
    h.run_steps(2);
    press(&mut h, PLAIN, Key::Delete);
    assert_eq!(measurements(&h).len(), 2);
    let first = on_screen(&h, 0.56, -0.3);
    click(&mut h, first, PointerButton::Secondary);
    h.get_by_label("Remove this measure").click();
    h.run_steps(3);
    let [last] = measurements(&h) else { panic!("{:?}", measurements(&h)) };
    assert!(matches!(last.points[0], SnapPoint::Place([_, y]) if (y + 0.1).abs() < 5e-3), "{last:?}");
    press(&mut h, Modifiers::COMMAND, Key::K);
    type_text(&mut h, "remove all measures");
    press(&mut h, PLAIN, Key::Enter);
    assert!(measurements(&h).is_empty());
}

/// One point alone is no measure; another tool keeps a distance; another machine has other points.
fn keys_lead_the_measuring_tool() {
    let mut h = paused("case-3", 0.4);
    press(&mut h, SHIFT, Key::M);
    click_point(&mut h, &SnapPoint::BasePin);
    press(&mut h, PLAIN, Key::Escape);
    assert!(measurements(&h).is_empty());
    press(&mut h, SHIFT, Key::M);
    click_point(&mut h, &SnapPoint::BasePin);
    click_point(&mut h, &SnapPoint::EndEffector);
    press(&mut h, PLAIN, Key::P);
    assert!(matches!(h.state().app_state().view_state().tool, Tool::Draw(_)) && measurements(&h).len() == 1);
    press(&mut h, SHIFT, Key::M);
    press(&mut h, SHIFT, Key::M);
    assert_eq!(h.state().app_state().view_state().tool, Tool::Hold);
    tell(&mut h, SessionCommand::Case("case-1"));
    assert_eq!(measurements(&h).len(), 1, "the same machine");
    tell(&mut h, SessionCommand::Open(Box::new(Scenario::builtin("scara").expect("built in"))));
    assert!(measurements(&h).is_empty());
}

/// Whatever the machine, each of its points has a place, and the pointer there takes that place.
fn points_snap_on_every_machine() {
    for scenario in Scenario::builtins() {
        let h = super::window_of(scenario.clone(), Theme::Dark, 800.0);
        let app_state = h.state().app_state();
        let shown = session(&h).frame().into();
        for point in app_state.stage().snap_points() {
            let Some(place) = app_state.stage().position(&point, &shown) else {
                assert_eq!(point, SnapPoint::Target, "{}: {point:?}", scenario.name);
                continue;
            };
            let pointer = Pointer { camera: *app_state.view_state().camera(), size: [900.0, 700.0], at: [0.0; 2] };
            let z = app_state.stage().handle_height();
            let there = pointer.project([place.re, place.im, z]).expect("in front of the eye");
            let pointer = Pointer { at: there, ..pointer };
            let snapped = app_state.stage().snap(&shown, &pointer).expect("it is seen");
            let found = app_state.stage().position(&snapped, &shown).expect("the machine has it");
            let off = pointer.distance([found.re, found.im, z]).expect("in front of the eye");
            assert!(
                off < 1.0 && !matches!(snapped, SnapPoint::Place(_)),
                "{}: {snapped:?} for {point:?}",
                scenario.name
            );
            let note = Note { text: "a".into(), point: Some(point), time: NoteTime::Always };
            assert!(place.re.is_finite() && place.im.is_finite(), "{note:?}");
            assert_eq!(note.check(&scenario.machine), Ok(()), "{}", scenario.name);
            let read = Scenario { notes: vec![note], ..scenario.clone() };
            assert_eq!(Scenario::parse(&read.to_toml(), "saved", None).expect("it is read").notes, read.notes);
        }
    }
}
