//! What a newcomer wants to do, by mouse and by keyboard: draw a path, balance a machine, run it, make a film and a
//! report, quit, and go on after a power cut.

use std::fs;
use std::path::Path;

use super::display::{CTRL, DOWN, ENTER, ESC, HOME, SHIFT};
use super::hands::hold;
use super::keyboard::{command, focused, go_to, next};
use super::program::{Desk, numbers};
use super::reader::BUTTON;
use super::wait::{pause, wait_for};
use crate::Test;

pub const TESTS: &[Test] = super::tests![a_newcomer_gets_on_by_mouse, a_newcomer_gets_on_by_keyboard];

/// A desk with the usual session at rest, without hints.
pub fn desk(of: &'static str, size: [u16; 2]) -> Desk {
    let mut desk = Desk::new(of, size);
    desk.open(&[]);
    desk.reads("Drag the white ring.");
    hold(&desk, |desk| desk.click("Pause"));
    desk.display.tap(ESC);
    desk.reads("POSE CONSTANT");
    desk
}

/// Waits until the run has been played to its end.
fn played(desk: &Desk) {
    desk.bus.wait_for("the end of the run", 60, |tree| {
        let time = numbers(&tree.containing(" / ").filter(|node| node.name.ends_with(" s"))?.name);
        (time.len() == 2 && time[0] == time[1]).then_some(())
    });
    desk.reads("run: ");
}

/// Waits until a file is whole: it is there under its name only then.
fn written(file: &Path, begins: &[u8]) {
    wait_for(&format!("{}", file.display()), 240, || file.exists().then_some(()));
    let bytes = fs::read(file).expect("readable");
    assert!(bytes.starts_with(begins) && bytes.len() > 500, "{}: {} bytes", file.display(), bytes.len());
}

/// The session that was kept before a power cut is offered and opened.
fn recovers(desk: &mut Desk) {
    pause(1500);
    let kept = wait_for("the changes in the journal", 20, || desk.journal().filter(|kept| !kept.edits.is_empty()));
    desk.kill();
    desk.open(&[]);
    desk.reads("Go on where you were?");
    desk.click("Open that session");
    desk.reads("here is where you were");
    assert_eq!(wait_for("a journal of it", 10, || desk.journal()).edits, kept.edits);
    desk.reads("machine: balanced");
}

fn a_newcomer_gets_on_by_mouse() {
    let mut desk = desk("tasks", [1440, 900]);
    let export = |desk: &Desk, entry: &str| {
        desk.click("File");
        let export = desk.reads("Export").name;
        desk.click(&export);
        let entry = desk.reads(entry).name;
        desk.click(&entry);
    };

    // Draw: a stroke from the ring becomes the path.
    let before = desk.display.title();
    desk.click("draw a path");
    desk.reads("draw with the pointer");
    let ring = desk.ring();
    desk.display.drag(ring, [ring[0] - 70, ring[1] - 30]);
    desk.titled("*");
    assert_ne!(desk.display.title(), before);
    let drawn = wait_for("the path in the journal", 10, || desk.journal().filter(|kept| !kept.edits.is_empty()));
    assert!(!drawn.edits.is_empty());

    // Balance: a machine from the gallery, the design view, one tick.
    desk.click("Machine");
    let card = desk.reads("nine-link-bare, ").name;
    desk.click(&card);
    desk.reads("machine: off balance by ");
    desk.click("Design");
    desk.click("Keep balanced");
    desk.reads("machine: balanced");

    // Run it.
    desk.click("2D");
    desk.click("Start");
    desk.click("Play");
    played(&desk);

    // A film, and a report.
    export(&desk, "Film of the run");
    desk.click("Choose a file…");
    let film = desk.name_file("tasks.gif");
    written(&film, b"GIF89a");
    export(&desk, "Report as HTML");
    let report = desk.name_file("tasks.html");
    written(&report, b"<!DOCTYPE html>");
    desk.reads("tasks.html");

    // A power cut, then the question at the end.
    recovers(&mut desk);
    desk.click("File");
    let quit = desk.reads("Quit").name;
    desk.click(&quit);
    desk.reads("Save before closing?");
    desk.click_as(BUTTON, "Save…");
    let file = desk.name_file("tasks.toml");
    written(&file, b"#| time");
    wait_for("no mark in the title", 20, || (!desk.display.title().contains('*')).then_some(()));
    desk.display.close();
    assert_eq!(desk.ended(), Some(0), "{}", desk.log());
    assert!(!desk.log().contains("panicked"), "{}", desk.log());
}

fn a_newcomer_gets_on_by_keyboard() {
    let mut desk = desk("tasks-by-keys", [1440, 900]);

    // Draw: a point on the way, typed.
    command(&desk, "task.via=[[0.53,0.68]]");
    desk.titled("*");
    wait_for("the point in the journal", 10, || desk.journal().filter(|kept| !kept.edits.is_empty()));

    // Balance.
    command(&desk, "machine nine-link-bare");
    desk.reads("machine: off balance by ");
    desk.display.tap(u32::from('d'));
    desk.reads("Keep balanced");
    go_to(&desk, "Keep balanced", 120);
    desk.display.tap(ENTER);
    desk.reads("machine: balanced");
    desk.display.tap(ESC);
    desk.display.tap(u32::from('v'));

    // Run it.
    desk.display.tap(HOME);
    pause(300);
    desk.display.tap(u32::from(' '));
    played(&desk);

    // A film, and a report.
    desk.display.keys(&[CTRL, SHIFT], u32::from('e'));
    wait_for("the keys to go to the choices", 10, || focused(&desk).filter(|name| name == "Choose a file…"));
    desk.display.tap(ENTER);
    let film = desk.name_file("keys.gif");
    written(&film, b"GIF89a");
    desk.display.keys(&[CTRL], u32::from('p'));
    let report = desk.name_file("keys.html");
    written(&report, b"<!DOCTYPE html>");

    // A power cut, then the question at the end, which has the keys to itself.
    recovers(&mut desk);
    desk.display.keys(&[CTRL], u32::from('q'));
    wait_for("the keys to go to the question", 10, || focused(&desk).filter(|name| name == "Save…"));
    let b = super::hands::b(&desk);
    desk.display.tap(u32::from(']'));
    desk.display.tap(u32::from('l'));
    desk.display.tap(DOWN);
    assert_eq!(super::hands::b(&desk), b, "keys are for the question");
    desk.display.tap(ESC);
    desk.reads_no("Save before closing?");
    desk.display.keys(&[CTRL], u32::from('q'));
    wait_for("the keys to go to the question", 10, || focused(&desk).filter(|name| name == "Save…"));
    assert_eq!(next(&desk).as_deref(), Some("Close without saving"));
    desk.display.tap(ENTER);
    assert_eq!(desk.ended(), Some(0), "{}", desk.log());
    assert!(!desk.log().contains("panicked"), "{}", desk.log());
}
