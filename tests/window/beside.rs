//! Plots in windows of the desktop, beside the main window.

use std::fs;

use super::display::{CTRL, ESC, HOME};
use super::program::Desk;
use super::reader::LABEL;
use super::tasks::desk;
use super::wait::{pause, wait_for};
use crate::Test;

pub const TESTS: &[Test] = super::tests![a_plot_has_a_window_of_the_desktop];

/// The screen is wider than the main window, as two screens are.
const SCREEN: [u16; 2] = [1960, 940];
const TITLE: &str = "Torque – Reactionless";

/// Drags the plot of the torques out of the main window; its own window.
fn pull_out(desk: &Desk) -> u32 {
    desk.display.focus();
    let from = desk.bus.wait_for("the heading", 20, |tree| tree.middle(tree.find_as(LABEL, "Torque")?));
    desk.display.drag(from, [1500, 120]);
    wait_for("a window of the plot", 20, || desk.display.titled(TITLE))
}

/// Waits until the plot is back in the panel.
fn is_back(desk: &Desk) {
    wait_for("no window of the plot", 20, || desk.display.titled(TITLE).is_none().then_some(()));
    desk.bus.node_as(LABEL, "Torque");
}

/// The text of the only journal.
fn journal(desk: &Desk) -> Option<String> {
    let [file] = desk.journals().try_into().ok()?;
    fs::read_to_string(file).ok()
}

fn a_plot_has_a_window_of_the_desktop() {
    let mut desk = desk("beside", SCREEN);
    let window = pull_out(&desk);
    let [left, top, width, height] = desk.display.place(window).expect("a place");
    assert_eq!([width, height], [460, 260]);
    assert!((left - 1460).abs() < 12 && (top - 108).abs() < 12, "where it was let go: {left}, {top}");
    assert!(desk.bus.tree().expect("it answers").find_as(LABEL, "Torque").is_none(), "no more in the panel");
    desk.reads("Torque over time");

    // Moved, it is kept there.
    desk.display.put(window, [1480, 420]);
    let is_kept = |text: String| text.replace(' ', "").contains("desktop=[1480,420]").then_some(());
    wait_for("its place in the journal", 20, || journal(&desk).and_then(is_kept));

    // Its keys lead time, which its cursor shows.
    desk.display.focus_on(window);
    desk.display.move_to([700, 450]);
    desk.display.tap(HOME);
    let cursor = || desk.display.picture().cursor([1480, 420, 460, 260]);
    let begin = wait_for("the cursor at the start", 20, || cursor().filter(|x| *x < 1540));
    desk.display.tap(u32::from(' '));
    let first = wait_for("the cursor on its way", 20, || cursor().filter(|x| *x > begin + 20));
    wait_for("the cursor at the end", 20, || cursor().filter(|x| *x > first + 20 && *x > 1900));
    // What is typed is typed in the main window.
    desk.display.keys(&[CTRL], u32::from('k'));
    desk.reads("Find a command");
    desk.display.focus();
    desk.display.tap(ESC);
    desk.reads_no("Find a command");

    // A power cut: it comes back where it was.
    pause(1500);
    desk.kill();
    desk.open(&[]);
    desk.reads("Go on where you were?");
    desk.click("Open that session");
    let window = wait_for("the plot once more", 20, || desk.display.titled(TITLE));
    assert_eq!(desk.display.place(window), Some([1480, 420, 460, 260]));

    // Its close button puts it back, and so does Esc.
    desk.display.close_one(window);
    is_back(&desk);
    let window = pull_out(&desk);
    desk.display.focus_on(window);
    pause(200);
    desk.display.tap(ESC);
    is_back(&desk);

    // The main window asks before it closes, and closes all.
    let window = pull_out(&desk);
    desk.display.focus_on(window);
    pause(200);
    desk.display.keys(&[CTRL], u32::from('q'));
    desk.reads("Save before closing?");
    desk.click("Close without saving");
    assert_eq!(desk.ended(), Some(0), "{}", desk.log());
    assert!(!desk.log().contains("panicked"), "{}", desk.log());
}
