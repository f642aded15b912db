//! The graphics device goes away: another one takes over, or what was done is kept.

use std::time::Instant;

use super::display::{CTRL, ESC, F12, SHIFT};
use super::hands::{b, hold};
use super::program::Desk;
use super::wait::{pause, wait_for};
use crate::Test;

pub const TESTS: &[Test] =
    super::tests![another_device_takes_over_with_everything_in_place, what_cannot_be_shown_any_more_is_kept];

fn open(desk: &mut Desk) {
    desk.open_with(&[], |command| command.env("STILLBASE_BREAK_DEVICE", "1"));
    desk.reads("Drag the white ring.");
    hold(desk, |desk| desk.click("Pause"));
    desk.display.tap(ESC);
    desk.reads("POSE CONSTANT");
}

fn break_it(desk: &Desk) {
    desk.display.keys(&[CTRL, SHIFT], F12);
}

fn another_device_takes_over_with_everything_in_place() {
    let mut desk = Desk::new("loss", [1440, 900]);
    open(&mut desk);
    // Nothing as it is at the start: another view, light, a panel away, a change, a list open, another size.
    desk.display.tap(u32::from('v'));
    desk.display.tap(u32::from('l'));
    desk.display.tap(u32::from('9'));
    desk.display.tap(u32::from('h'));
    desk.display.keys(&[], u32::from(']'));
    desk.display.resize([1300, 820]);
    wait_for("the change in the journal", 10, || desk.journal());
    desk.display.move_to([700, 860]);
    pause(1500);
    let (before, shown) = (desk.display.picture(), b(&desk));
    let names = |desk: &Desk| {
        let mut names = desk.bus.tree().map(|tree| tree.names()).unwrap_or_default();
        names.sort();
        // The line at the bottom says what happened.
        names.retain(|name| !name.contains("F1 keys") && !name.contains("took over"));
        names
    };
    let read = names(&desk);
    for _ in 0..2 {
        // Any other key takes the news of the last time away.
        desk.display.tap(u32::from('l'));
        desk.reads_no("another one took over");
        desk.display.tap(u32::from('l'));
        let (window, begun) = (desk.display.window(), Instant::now());
        break_it(&desk);
        desk.reads("another one took over");
        assert_eq!(desk.display.window(), window, "the window stays where it is");
        wait_for("the same picture", 30, || {
            // But for the line at the bottom.
            (before.differs(&desk.display.picture()) < 4000).then_some(())
        });
        println!("another device drew after {:.2} s", begun.elapsed().as_secs_f64());
        assert!(begun.elapsed().as_secs() < 20);
        desk.seen();
        assert_eq!(b(&desk), shown);
        assert_eq!(names(&desk), read);
        // One that is lost again at once would be lost for ever.
        pause(10_500);
    }
    // It goes on as before: what was done before can be undone, and it ends in order.
    desk.display.keys(&[CTRL], u32::from('z'));
    desk.bus.wait_for("b as it was", 10, |tree| tree.value(tree.find("b rad")?).filter(|b| (b - shown).abs() > 5e-3));
    desk.display.close();
    desk.reads("Save before closing?");
    desk.click("Close without saving");
    assert_eq!(desk.ended(), Some(0), "{}", desk.log());

    assert!(!desk.log().contains("panicked"), "{}", desk.log());
}

fn what_cannot_be_shown_any_more_is_kept() {
    let mut desk = Desk::new("loss", [1280, 800]);
    open(&mut desk);
    desk.display.keys(&[], u32::from(']'));
    desk.titled("*");
    // Twice at once: a device that does not last. Not even the journal had its time.
    break_it(&desk);
    desk.reads("another one took over");
    break_it(&desk);
    assert_eq!(desk.ended(), Some(1), "{}", desk.log());
    let log = desk.log();
    assert!(log.contains("graphics device was lost") && log.contains("session-0.toml"), "{log}");
    let kept = desk.journal().expect("kept");
    assert_eq!(kept.edits.len(), 1);
    desk.open(&[]);
    desk.reads("Go on where you were?");
    desk.click("Open that session");
    desk.reads("here is where you were");
    assert_eq!(wait_for("a journal of it", 10, || desk.journal()).edits, kept.edits);
}
