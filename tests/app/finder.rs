//! The list of commands, the card of keys, and the keys that move the target, b and the view.

use std::collections::HashSet;

use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use stillbase::app::actions::{ACTIONS, FINE_ACTIONS};
use stillbase::app::{SessionCommand, Switch, ViewChange};
use stillbase::picture::notation::{AngleUnit, Notation};
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::Edit;

use super::{Window, session, window};
use crate::Test;
use crate::folder::Folder;

pub const TESTS: &[Test] = tests![
    every_command_is_found_by_a_few_letters,
    a_number_in_a_name_is_no_value,
    a_value_is_in_the_unit_on_display,
    what_a_newcomer_types_is_among_the_first_three,
    the_list_of_commands_closes,
    a_value_is_typed_where_its_setting_is_found,
    the_list_of_commands_is_led_by_keys_alone,
    the_list_of_commands_grows_again,
    what_follows_the_key_in_one_pass_is_no_shortcut,
    a_setting_that_is_found_is_shown_in_the_panel,
    a_machine_of_another_kind_brings_its_task,
    a_list_of_commands_types_nothing_into_the_window,
    no_key_asks_for_two_things,
    the_card_of_keys_is_searched,
    arrows_move_the_target_and_a_burst_is_one_undo,
    brackets_turn_b,
    the_view_is_turned_by_keys,
];

fn press(h: &mut Window, modifiers: Modifiers, key: Key) {
    h.key_press_modifiers(modifiers, key);
    h.run_steps(2);
}

fn type_text(h: &mut Window, text: &str) {
    h.event(egui::Event::Text(text.into()));
    h.run_steps(2);
}

fn every_command_is_found_by_a_few_letters() {
    let folder = Folder::new("recent");
    let mut h = window("case-3", Theme::Dark);
    h.state_mut().app_state_mut().carry_out(SessionCommand::SaveFile(folder.path("mine.toml")));
    h.run_steps(2);
    for (typed, first) in [
        ("snap", "Snapshots along the motion"),
        ("dark", "Light or dark"),
        ("tol", "Tolerances: what the bases of many machines feel, and the spectrum"),
        ("rec rerun", "Record for the Rerun viewer"),
        ("tow", "Tower of workspaces"),
        ("table 1", "Machine: nine-link-table-1"),
        ("import", "Open: a session, scenario, machine, model or table"),
        ("urdf", "Take the machine elsewhere: MJCF, URDF, DXF…"),
        ("csv", "Values of the first plot as CSV or Parquet"),
        ("picture", "Picture of the first plot as PNG"),
        ("gravity", "Setting: gravity"),
        ("recent", "Recent: mine.toml"),
        ("new", "New session: this machine and its task, nothing done yet"),
        ("torque of drive 2", "Plot: torque of drive 2 τ₂, N m"),
        ("payload mass 0.4", "Set mass of the payload (plant.payload.mass) to 0.4 kg, now 0 kg"),
        ("payload mass 0.4 kg", "Set mass of the payload (plant.payload.mass) to 0.4 kg, now 0 kg"),
        ("task.time=3", "Set duration from A to B (task.time) to 3 s, now 1.0 s"),
        ("motion time 3", "Set duration from A to B (task.time) to 3 s, now 1.0 s"),
        ("duration 3 s", "Set duration from A to B (task.time) to 3 s, now 1.0 s"),
        ("task kind least-reaction", "Set kind of motion (task.kind) to least-reaction, now reactionless"),
    ] {
        press(&mut h, Modifiers::COMMAND, Key::K);
        type_text(&mut h, typed);
        assert!(h.query_by_label(first).is_some(), "{typed}: {first} is not among what is found");
        press(&mut h, Modifiers::NONE, Key::Escape);
        assert!(
            h.query_by_label("Find a command").is_none_or(|_| h.state().app_state().view_state().open.finder.is_none())
        );
    }
    press(&mut h, Modifiers::COMMAND, Key::K);
    type_text(&mut h, "qqxz");
    assert!(h.query_by_label("no command answers this").is_some());
}

/// Words of somebody who does not know the names yet.
fn what_a_newcomer_types_is_among_the_first_three() {
    let folder = Folder::new("newcomer");
    let mut h = window("case-3", Theme::Dark);
    h.state_mut().app_state_mut().carry_out(SessionCommand::SaveFile(folder.path("mine.toml")));
    h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::set("plant.payload.mass", 0.1)));
    h.run_steps(2);
    let mut wrong = Vec::new();
    for (typed, expected) in [
        ("import", "Open: a session, scenario, machine, model or table"),
        ("csv", "Values of the first plot as CSV or Parquet"),
        ("export", "Values of the first plot as CSV or Parquet"),
        ("excel", "Values of the first plot as CSV or Parquet"),
        ("picture", "Picture of the first plot as PNG"),
        ("screenshot", "Picture of the first plot as PNG"),
        ("gravity", "Setting: gravity"),
        ("new", "New session: this machine and its task, nothing done yet"),
        ("recent", "Recent: mine.toml"),
        ("movie", "Record for the Rerun viewer"),
        ("film", "Film of the run: GIF, animated PNG or WebP, MP4 or pictures"),
        ("gif", "Film of the run: GIF, animated PNG or WebP, MP4 or pictures"),
        ("undo", "Undo"),
        ("revert", "Undo"),
        ("shake", "Shake and still: two runs side by side"),
        ("split", "Shake and still: two runs side by side"),
        ("units", "Angles in degrees or radians"),
        ("degrees", "Angles in degrees or radians"),
        ("help", "Guide: what all this is and how it is used"),
        ("manual", "Guide: what all this is and how it is used"),
        ("tutorial", "Tour: what this is about, in seven steps"),
        ("hints", "Hints: the first three things to do"),
        ("shortcuts", "Keys and gestures"),
        ("urdf", "Take the machine elsewhere: MJCF, URDF, DXF…"),
        ("mujoco", "Take the machine elsewhere: MJCF, URDF, DXF…"),
        ("slow motion", "Twice as slow"),
        ("loop", "Play in a loop; only the time range of the plots, if one was chosen"),
        ("rewind", "To the start"),
        ("fit", "Show everything"),
        ("fullscreen", "Present: the scene alone, what counts in large type"),
        ("dark mode", "Light or dark"),
        ("monte carlo", "Tolerances: what the bases of many machines feel, and the spectrum"),
        ("vibration", "Tolerances: what the bases of many machines feel, and the spectrum"),
        ("balance", "Design: masses, centres of mass, lengths and counterweights"),
        ("friction", "Setting: viscous friction"),
        ("how do i save", "Save"),
        ("compare", "Compare: scene, wide plots and the runs side by side"),
        ("snapshots", "Snapshots along the motion"),
        ("bearing forces", "Inside the machine: what the pins carry"),
        ("equations", "Equations of the paper with today's numbers, beside the design view"),
        ("spacecraft", "Scenario: Spacecraft"),
        ("exit", "Quit; asks first if changes are in no file"),
        ("payload", "Setting: payload"),
        ("exit status", "Guide: Exit status, Command line"),
    ] {
        press(&mut h, Modifiers::COMMAND, Key::K);
        type_text(&mut h, typed);
        h.run_steps(2);
        let fields = h.query_all_by_label("Find a command").map(|node| node.rect().bottom());
        let top = fields.fold(f32::MAX, f32::min);
        let row = h.query_all_by_label_contains(expected).map(|node| node.rect()).filter(|rect| rect.top() > top);
        let row = row.map(|rect| (rect.top() - top) / 27.0).fold(f32::MAX, f32::min);
        if row > 3.0 {
            wrong.push(format!("{typed}: {expected} is in row {row}"));
        }
        press(&mut h, Modifiers::NONE, Key::Escape);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// It closes with Esc, with a press elsewhere, after Enter, and when something else wants the keyboard.
fn the_list_of_commands_closes() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let is_open = |h: &Window| h.state().app_state().view_state().open.finder.is_some();
    let mut closes = |by: &str, how: &mut dyn FnMut(&mut Window)| {
        press(&mut h, Modifiers::COMMAND, Key::K);
        assert!(is_open(&h), "{by}");
        type_text(&mut h, "snap");
        how(&mut h);
        h.run_steps(3);
        assert!(!is_open(&h), "{by}");
        h.state_mut().app_state_mut().carry_out(ViewChange::Dialog(None));
        h.state_mut().app_state_mut().carry_out(ViewChange::Switch(Switch::Help, false));
        h.run_steps(2);
    };
    closes("Esc", &mut |h| press(h, Modifiers::NONE, Key::Escape));
    closes("Enter", &mut |h| press(h, Modifiers::NONE, Key::Enter));
    closes("a press elsewhere", &mut |h| {
        h.hover_at(egui::pos2(640.0, 780.0));
        h.step();
        h.drag_at(egui::pos2(640.0, 780.0));
        h.step();
        h.drop_at(egui::pos2(640.0, 780.0));
    });
    closes("a file dialog", &mut |h| press(h, Modifiers::COMMAND, Key::O));
    closes("the card of keys", &mut |h| press(h, Modifiers::NONE, Key::F1));
    closes("the guide", &mut |h| press(h, Modifiers::NONE, Key::F2));
    // Where the window has lost the focus, the list stays.
    press(&mut h, Modifiers::COMMAND, Key::K);
    h.event(egui::Event::WindowFocused(false));
    h.run_steps(3);
    assert!(is_open(&h), "it stays while another window has the focus");
}

/// A setting and a value, typed and entered, set it; a signal opens its plot; what is out of range is refused in words.
fn a_value_is_typed_where_its_setting_is_found() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let mut enter = |text: &str| {
        press(&mut h, Modifiers::COMMAND, Key::K);
        type_text(&mut h, text);
        press(&mut h, Modifiers::NONE, Key::Enter);
        h.run_steps(4);
        let state = h.state().app_state();
        (state.session().scenario().clone(), state.view_state().status.problem().map(ToOwned::to_owned))
    };
    assert_eq!(enter("plant.payload.mass 0.4").0.plant.payload.mass, 0.4);
    assert_eq!(enter("task.time = 3").0.task.time, 3.0);
    let (kept, problem) = enter("task.time -1");
    assert!(kept.task.time == 3.0 && problem.expect("a reason").contains("task.time"));
    assert!(enter("torque of drive 2").1.is_none());
}

/// On a slow display the key and what is typed after it come in one pass: no letter is taken for a shortcut.
fn what_follows_the_key_in_one_pass_is_no_shortcut() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let before = session(&h).to_scenario();
    let pressed =
        |key, modifiers| egui::Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers };
    let mut events = vec![pressed(Key::K, Modifiers::COMMAND)];
    events.extend([Key::L, Key::I, Key::G, Key::Num1, Key::T].map(|key| pressed(key, Modifiers::NONE)));
    h.input_mut().events.extend(events);
    h.run_steps(3);
    let view_state = h.state().app_state().view_state();
    assert!(
        view_state.open.finder.is_some()
            && view_state.arrangement.theme == Theme::Dark
            && !view_state.pins
            && view_state.below.is_none()
    );
    assert_eq!(session(&h).to_scenario(), before);
}

/// The first line answers what was typed; after two lines the list has room for ten again.
fn the_list_of_commands_grows_again() {
    for size in [[1280.0, 800.0], [960.0, 600.0]] {
        let mut h = window("case-3", Theme::Dark);
        h.set_size(size.into());
        h.run_steps(2);
        let height = |h: &Window| h.ctx.memory(|m| m.area_rect(egui::Id::unique("finder"))).expect("a list").height();
        press(&mut h, Modifiers::COMMAND, Key::K);
        h.run_steps(3);
        assert!(height(&h) > 270.0, "{size:?}: {}", height(&h));
        type_text(&mut h, "snapshots along");
        h.run_steps(3);
        let low = height(&h);
        for _ in 0.."snapshots along".len() {
            press(&mut h, Modifiers::NONE, Key::Backspace);
        }
        h.run_steps(3);
        assert!(height(&h) > 270.0 && low < height(&h), "{size:?}: {low}, then {}", height(&h));
    }
}

fn a_setting_that_is_found_is_shown_in_the_panel() {
    let mut h = window("case-3", Theme::Dark);
    h.state_mut().app_state_mut().carry_out(ViewChange::Switch(Switch::Side, false));
    h.run_steps(2);
    press(&mut h, Modifiers::COMMAND, Key::K);
    type_text(&mut h, "setting friction coulomb");
    press(&mut h, Modifiers::NONE, Key::Enter);
    h.run_steps(6);
    let field = h.get_by_label("plant.friction.coulomb").rect();
    assert!(field.top() > 40.0 && field.bottom() < 780.0, "it is seen: {field:?}");
    assert!(session(&h).script().is_empty(), "and nothing has changed");
}

fn the_list_of_commands_is_led_by_keys_alone() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    press(&mut h, Modifiers::COMMAND, Key::K);
    type_text(&mut h, "snap");
    press(&mut h, Modifiers::NONE, Key::Enter);
    let view_state = h.state().app_state().view_state();
    assert!(view_state.snapshots && view_state.open.finder.is_none(), "the first line is carried out, the list closes");
    // From the top upwards is the last line, and back.
    press(&mut h, Modifiers::COMMAND, Key::K);
    type_text(&mut h, "tower");
    press(&mut h, Modifiers::NONE, Key::ArrowUp);
    press(&mut h, Modifiers::NONE, Key::ArrowDown);
    press(&mut h, Modifiers::NONE, Key::Enter);
    assert_eq!(h.state().app_state().view_state().view, ViewKind::Tower);
}

/// As the list of machines does it: one of another kind brings a task of its own.
fn a_machine_of_another_kind_brings_its_task() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    press(&mut h, Modifiers::COMMAND, Key::K);
    type_text(&mut h, "machine four");
    press(&mut h, Modifiers::NONE, Key::Enter);
    h.run_steps(4);
    assert_eq!(session(&h).scenario().machine.drives(), 4);
    assert_eq!(session(&h).scenario().name, "four-drive");
    assert!(h.state().app_state().view_state().status.message.is_none());
}

fn a_list_of_commands_types_nothing_into_the_window() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let before = session(&h).to_scenario();
    press(&mut h, Modifiers::COMMAND, Key::K);
    for key in [Key::Num1, Key::V, Key::L, Key::Space, Key::ArrowRight, Key::S] {
        press(&mut h, Modifiers::NONE, key);
    }
    press(&mut h, Modifiers::NONE, Key::Escape);
    let view_state = h.state().app_state().view_state();
    assert_eq!(
        (view_state.arrangement.theme, view_state.view, view_state.snapshots),
        (Theme::Dark, ViewKind::Flat, false)
    );
    assert_eq!(session(&h).to_scenario(), before);
    assert!(!session(&h).is_playing() && session(&h).frame().time == 0.0);
}

fn no_key_asks_for_two_things() {
    let mut seen = HashSet::new();
    for action in ACTIONS.iter().chain(FINE_ACTIONS) {
        for key in action.keys {
            assert!(seen.insert(format!("{key:?}")), "{}: {key:?} is taken", action.name);
        }
    }
    let names: HashSet<&str> = ACTIONS.iter().map(|action| action.name).collect();
    assert_eq!(names.len(), ACTIONS.len(), "each name stands once");
}

fn the_card_of_keys_is_searched() {
    let mut h = window("case-3", Theme::Dark);
    press(&mut h, Modifiers::NONE, Key::F1);
    assert!(h.query_by_label("Undo").is_some() && h.query_by_label("drag the b ring").is_some());
    h.get_by_label("Search the keys").focus();
    h.run_steps(2);
    type_text(&mut h, "undo");
    assert!(h.query_by_label("Undo").is_some() && h.query_by_label("drag the b ring").is_none());
    press(&mut h, Modifiers::NONE, Key::Escape);
    press(&mut h, Modifiers::NONE, Key::Escape);
    assert!(!h.state().app_state().view_state().open.help);
}

fn arrows_move_the_target_and_a_burst_is_one_undo() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let before = session(&h).to_scenario();
    let target = |h: &Window| session(h).frame().target.at;
    let start = target(&h);
    let ctrl = Modifiers::COMMAND;
    for _ in 0..3 {
        press(&mut h, ctrl, Key::ArrowUp);
    }
    press(&mut h, ctrl | Modifiers::SHIFT, Key::ArrowLeft);
    h.run_steps(200);
    let moved = target(&h) - start;
    assert!((moved.im - 0.03).abs() < 1e-9 && (moved.re + 0.001).abs() < 1e-9, "{moved}");
    assert!(session(&h).is_dragged());
    for _ in 0..4 {
        if session(&h).to_scenario() != before {
            press(&mut h, ctrl, Key::Z);
        }
    }
    assert_eq!(session(&h).to_scenario(), before, "undone as a whole");
}

fn brackets_turn_b() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let b = session(&h).b_aim();
    press(&mut h, Modifiers::NONE, Key::CloseBracket);
    assert!((session(&h).b_aim() - b - 0.01).abs() < 1e-9);
    press(&mut h, Modifiers::SHIFT, Key::OpenBracket);
    assert!((session(&h).b_aim() - b - 0.009).abs() < 1e-9);
}

fn the_view_is_turned_by_keys() {
    let mut h = window("case-3", Theme::Dark);
    for view in ["2D", "3D"] {
        h.get_by_label(view).click();
        h.run_steps(2);
        let before = *h.state().app_state().view_state().camera();
        press(&mut h, Modifiers::ALT, Key::ArrowRight);
        let turned = *h.state().app_state().view_state().camera();
        press(&mut h, Modifiers::NONE, Key::Plus);
        let nearer = *h.state().app_state().view_state().camera();
        assert!(before != turned && turned != nearer);
        press(&mut h, Modifiers::NONE, Key::F);
        assert_eq!(*h.state().app_state().view_state().camera(), before);
    }
}

fn a_number_in_a_name_is_no_value() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    for text in ["mass of link 3", "link 3", "drive 2"] {
        press(&mut h, Modifiers::COMMAND, Key::K);
        type_text(&mut h, text);
        let sets = |label: Option<String>| label.is_some_and(|label| label.starts_with("Set "));
        let count = h.query_all_by_role(egui::accesskit::Role::Button).filter(|n| sets(n.accesskit_node().label()));
        assert_eq!(count.count(), 0, "{text}");
        press(&mut h, Modifiers::NONE, Key::Escape);
    }
    // Behind the name of its link, a number is a value.
    press(&mut h, Modifiers::COMMAND, Key::K);
    type_text(&mut h, "mass of link 3 2.25 kg");
    press(&mut h, Modifiers::NONE, Key::Enter);
    assert_eq!(session(&h).scenario().machine.links()[2].mass, 2.25);
    // With the sign, any setting is meant.
    press(&mut h, Modifiers::COMMAND, Key::K);
    type_text(&mut h, "link.3.mass=2.5");
    press(&mut h, Modifiers::NONE, Key::Enter);
    assert_eq!(session(&h).scenario().machine.links()[2].mass, 2.5);
}

fn a_value_is_in_the_unit_on_display() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    let notation = Notation { angle: AngleUnit::Degrees, ..Notation::default() };
    h.state_mut().app_state_mut().carry_out(ViewChange::Notation(notation));
    for (text, b) in [("task.b 140", 140_f64.to_radians()), ("task.b=2.5 rad", 2.5)] {
        press(&mut h, Modifiers::COMMAND, Key::K);
        type_text(&mut h, text);
        press(&mut h, Modifiers::NONE, Key::Enter);
        let now = session(&h).scenario().task.b;
        assert!((now - b).abs() < 1e-9, "{text}: {now}");
    }
}
