//! The main job without a pointer: whatever is needed is reached, says its name, and does what it says.

use std::collections::BTreeSet;
use std::fs;

use stillbase::session::Edit;
use stillbase::session::scenario::Scenario;

use super::display::{CTRL, DOWN, ENTER, ESC, RIGHT, SHIFT, TAB};
use super::hands::{another_b, b, hold};
use super::program::{Desk, numbers};
use super::reader::SPIN_BUTTON;
use super::wait::{pause, wait_for, within};
use crate::Test;

pub const TESTS: &[Test] = super::tests![the_main_job_is_done_by_keyboard];

pub fn focused(desk: &Desk) -> Option<String> {
    desk.bus.tree()?.focused().map(|node| node.name.clone())
}

/// Goes on to the next thing; its name.
pub fn next(desk: &Desk) -> Option<String> {
    let before = focused(desk);
    desk.display.tap(TAB);
    let other = || Some(focused(desk)).filter(|now| *now != before);
    within(3, other).unwrap_or(before.clone())
}

/// Goes on from thing to thing until the keys go to what has a name.
#[track_caller]
pub fn go_to(desk: &Desk, name: &str, most: usize) {
    let mut seen = Vec::new();
    for _ in 0..most {
        seen.extend(next(desk));
        if seen.last().is_some_and(|last| last == name) {
            return;
        }
    }
    panic!("{most} times Tab do not lead to \"{name}\", but to {seen:?}");
}

/// Asks for a command by a few letters of its name.
pub fn command(desk: &Desk, letters: &str) {
    desk.display.keys(&[CTRL], u32::from('k'));
    desk.reads("Find a command");
    desk.display.type_in(letters);
    pause(300);
    desk.display.tap(ENTER);
}

fn the_main_job_is_done_by_keyboard() {
    let mut desk = Desk::new("keyboard", [1280, 800]);
    desk.open(&["--theme", "light"]);
    desk.reads("Drag the white ring.");
    hold(&desk, |desk| desk.display.tap(u32::from(' ')));
    desk.display.tap(ESC);
    desk.reads("POSE CONSTANT");

    // Whatever Tab leads to is on the screen and has a name; it leads around.
    let names: BTreeSet<String> = (0..45).filter_map(|_| next(&desk)).collect();
    assert!(names.len() > 35 && !names.contains(""), "{names:?}");
    for wanted in ["Machine", "Scenario", "Play", "Time", "b rad", "b slider"] {
        assert!(names.contains(wanted), "Tab does not lead to {wanted}: {names:?}");
    }
    desk.display.tap(ESC);

    // The target goes to the right and up, b turns, and a number is typed with its unit.
    let drags = |kept: &Scenario| kept.edits.iter().filter(|e| matches!(e.edit, Edit::DragTarget { .. })).count();
    desk.display.keys(&[CTRL], RIGHT);
    desk.display.keys(&[CTRL, SHIFT], RIGHT);
    wait_for("the target moved in the journal", 10, || desk.journal().filter(|kept| drags(kept) > 0));
    let before = b(&desk);
    desk.display.tap(u32::from(']'));
    let turned = another_b(&desk, before);
    assert!((turned - before - 0.01).abs() < 2e-3, "{before} to {turned}");
    go_to(&desk, "b rad", 60);
    desk.display.type_in("140 deg");
    desk.display.tap(ENTER);
    desk.bus.wait_for("b as it was typed", 10, |tree| {
        tree.value(tree.find_as(SPIN_BUTTON, "b rad")?).filter(|b| (b - 140_f64.to_radians()).abs() < 2e-3)
    });
    desk.display.tap(ESC);

    // A slider goes by the arrow keys once the keys go to it.
    go_to(&desk, "b slider", 60);
    let before = b(&desk);
    desk.display.tap(RIGHT);
    another_b(&desk, before);
    desk.display.tap(ESC);
    desk.display.keys(&[CTRL], u32::from('z'));

    // Cases, and a list that is opened, gone through and left.
    desk.display.tap(u32::from('1'));
    desk.titled("Straight line");
    desk.bus.wait_for("the end of the run", 60, |tree| {
        (numbers(&tree.containing("run: peak |n_B|")?.name)[0] > 0.5).then_some(())
    });
    go_to(&desk, "Scenario", 60);
    desk.display.tap(ENTER);
    desk.reads("Circle without reaction. ");
    for _ in 0..3 {
        desk.display.tap(DOWN);
        pause(150);
    }
    desk.display.tap(ESC);
    desk.reads_no("Circle without reaction. ");
    command(&desk, "case 3");
    desk.titled("Reactionless");

    // Undo by its name, record and save, quit.
    desk.display.keys(&[CTRL], DOWN);
    desk.titled("*");
    command(&desk, "record");
    let recording = desk.name_file("keys.rrd");
    wait_for("the recording", 60, || recording.exists().then_some(()));
    desk.display.keys(&[CTRL], u32::from('q'));
    desk.reads("Save before closing?");
    // The question has the keys at once.
    wait_for("the keys to go to the question", 10, || focused(&desk).filter(|name| name == "Save…"));
    assert_eq!(next(&desk).as_deref(), Some("Close without saving"));
    assert_eq!(next(&desk).as_deref(), Some("Cancel"));
    desk.display.tap(ENTER);
    desk.reads_no("Save before closing?");
    desk.display.keys(&[CTRL], u32::from('q'));
    wait_for("the keys to go to the question", 10, || focused(&desk).filter(|name| name == "Save…"));
    desk.display.tap(ENTER);
    let file = desk.name_file("keys.toml");
    wait_for("the file", 20, || file.exists().then_some(()));
    wait_for("no mark in the title", 20, || (!desk.display.title().contains('*')).then_some(()));
    desk.display.keys(&[CTRL], u32::from('q'));
    assert_eq!(desk.ended(), Some(0), "{}", desk.log());
    let saved = Scenario::parse(&fs::read_to_string(&file).expect("readable"), "keys", None).expect("a session");
    assert_eq!(drags(&saved), 1);
    assert!(!desk.log().contains("panicked"), "{}", desk.log());
}
