//! The main job by hand: each step is done as a person does it, and checked by what the program says and writes.

use std::fs;
use std::time::{Duration, Instant};

use stillbase::session::Edit;
use stillbase::session::scenario::Scenario;

use super::display::{CTRL, ESC, HOME};
use super::program::{Desk, numbers};
use super::reader::{BUTTON, COMBO_BOX, LABEL, SLIDER, SPIN_BUTTON, Tree};
use super::wait::{pause, wait_for};
use crate::Test;

pub const TESTS: &[Test] = super::tests![the_main_job_is_done_by_hand, the_tour_is_taken_by_hand];

/// The number beside b.
pub fn b(desk: &Desk) -> f64 {
    desk.value(SPIN_BUTTON, "b rad")
}

/// The number beside b once it is another one and rests.
pub fn another_b(desk: &Desk, before: f64) -> f64 {
    wait_for("another b", 20, || {
        let now = b(desk);
        pause(400);
        (now != before && b(desk) == now).then_some(now)
    })
}

/// Stops time; in the first minute it starts over now and then.
pub fn hold(desk: &Desk, stop: impl Fn(&Desk)) {
    let plays = |tree: &Tree| Some(tree.find_as(BUTTON, "Pause").is_some());
    for _ in 0..5 {
        if desk.bus.wait_for("a button to stop", 20, plays) {
            stop(desk);
        }
        pause(1500);
        if !desk.bus.wait_for("a button to stop", 20, plays) {
            return;
        }
    }
    panic!("time cannot be stopped");
}

/// Drags along a slider by a share of its length.
fn slide(desk: &Desk, name: &str, by: f64) {
    let (place, value, range) = desk.bus.wait_for(&format!("the slider {name}"), 20, |tree| {
        let node = tree.find_as(SLIDER, name)?;
        Some((tree.place(node)?, tree.value(node)?, tree.range(node)?))
    });
    let [x, y, width, height] = place;
    let share = (value - range[0]) / (range[1] - range[0]);
    let at = |share: f64| {
        let (knob, length) = (f64::from(height) / 2.0, f64::from(width) - f64::from(height));
        [(f64::from(x) + knob + share * length).round() as i16, (y + height / 2) as i16]
    };
    desk.display.drag(at(share), at(share + by));
}

fn the_main_job_is_done_by_hand() {
    let mut desk = Desk::new("hands", [1440, 900]);
    // Start: the first minute, something to see, and the name of what is open.
    let took = desk.open(&[]);
    println!("open and readable after {:.2} s", took.as_secs_f64());
    desk.titled("Reactionless, from A to B – Stillbase");
    desk.reads("Drag the white ring.");
    wait_for("a picture", 20, || (desk.display.picture().colours() > 200).then_some(()));
    assert!(desk.journal().is_none(), "nothing was done yet");

    // Drag the target: the machine follows, the base feels nothing, and the journal has it within two seconds.
    hold(&desk, |desk| desk.click("Pause"));
    let ring = desk.ring();
    let from = desk.target(ring);
    let to = [ring[0] + 18, ring[1] - 14];
    desk.display.drag(ring, to);
    let dragged = Instant::now();
    desk.reads("Now drag it out of the amber area.");
    let kept = wait_for("the drag in the journal", 10, || desk.journal().filter(|kept| !kept.edits.is_empty()));
    let late = dragged.elapsed();
    println!("in the journal after {:.2} s", late.as_secs_f64());
    assert!(kept.edits.iter().any(|e| matches!(e.edit, Edit::DragTarget { .. })), "{:?}", kept.edits);
    let at = desk.target(desk.ring());
    assert!(at[0] > from[0] + 0.01 && at[1] > from[1] + 0.01, "dragged from {from:?} to {at:?}");
    assert!(desk.display.title().contains('*'), "marked as in no file: {}", desk.display.title());
    desk.reads("run: transmitted nothing, good");

    // Slide b: the number follows; undo takes it back, redo brings it again.
    hold(&desk, |desk| desk.click("Pause"));
    desk.display.tap(ESC);
    let before = b(&desk);
    slide(&desk, "b slider", 0.06);
    let after = another_b(&desk, before);
    assert!(after > before, "slid to the right: {before} to {after}");
    desk.display.keys(&[CTRL], u32::from('z'));
    desk.bus.wait_for("b as it was", 10, |tree| {
        tree.value(tree.find_as(SPIN_BUTTON, "b rad")?).filter(|b| (b - before).abs() < 2e-3)
    });
    desk.display.keys(&[CTRL], u32::from('y'));
    desk.bus.wait_for("b once more", 10, |tree| {
        tree.value(tree.find_as(SPIN_BUTTON, "b rad")?).filter(|b| (b - after).abs() < 2e-3)
    });

    // The paper's cases: what reacts says so, what does not stays silent.
    for (key, title, silent) in
        [('1', "Straight line", false), ('2', "Off the plane", false), ('3', "Reactionless", true)]
    {
        desk.display.tap(u32::from(key));
        desk.titled(title);
        let said = desk.bus.wait_for("the end of the run", 60, |tree| {
            let time = numbers(&tree.containing(" / 1.000 s")?.name);
            let run = tree.containing("run: ")?.name.clone();
            (time[0] == 1.0).then_some(run)
        });
        assert_eq!(said == "run: transmitted nothing, good", silent, "{title}: {said}");
        assert_eq!(said.starts_with("run: peak |n_B| "), !silent, "{title}: {said}");
    }

    // Record: a file of the viewer's kind.
    desk.display.tap(u32::from('r'));
    let recording = desk.name_file("run.rrd");
    wait_for("the recording", 60, || recording.exists().then_some(()));
    desk.reads("run.rrd");
    assert!(fs::read(&recording).expect("readable").starts_with(b"RRF2"));

    // Kill, recover: the change made a moment ago is there.
    let at = desk.ring();
    desk.display.drag(at, [at[0] - 16, at[1] + 10]);
    let kept = wait_for("the drag in the journal", 10, || {
        desk.journal().filter(|kept| kept.edits.iter().any(|e| matches!(e.edit, Edit::DragTarget { .. })))
    });
    pause(1200);
    let kept = desk.journal().unwrap_or(kept);
    desk.kill();
    desk.open(&[]);
    desk.reads("Go on where you were?");
    desk.click("Open that session");
    desk.reads("here is where you were");
    desk.titled("*");
    let again = wait_for("a journal of it", 10, || desk.journal());
    assert_eq!(again.edits, kept.edits);

    // Light, and the plots away: how it is liked.
    desk.display.tap(u32::from('l'));
    desk.display.tap(u32::from('9'));
    desk.reads_no("plot a signal");
    let shown = b(&desk);

    // Quit: asked for what is in no file; saved, it ends in order and leaves nothing behind.
    desk.display.close();
    desk.reads("Save before closing?");
    desk.click("Save…");
    let file = desk.name_file("mine.toml");
    wait_for("the file", 20, || file.exists().then_some(()));
    wait_for("no mark in the title", 20, || (!desk.display.title().contains('*')).then_some(()));
    desk.display.close();
    assert_eq!(desk.ended(), Some(0), "{}", desk.log());
    assert!(desk.journals().is_empty(), "{:?}", desk.journals());
    let saved = Scenario::parse(&fs::read_to_string(&file).expect("readable"), "mine", None).expect("a session");
    assert_eq!(saved.edits, kept.edits);

    // Reopened, all is as it was: colours, panels, and the session among the files used last.
    desk.open(&[]);
    desk.reads_no("Drag the white ring.");
    desk.reads("Dark");
    assert!(desk.bus.tree().expect("it answers").containing("plot a signal").is_none());
    desk.click("File");
    desk.click("Open recent");
    let entry = desk.reads("Open mine.toml").name;
    desk.click(&entry);
    desk.bus.wait_for("b as it was saved", 20, |tree| {
        tree.value(tree.find_as(SPIN_BUTTON, "b rad")?).filter(|b| (b - shown).abs() < 2e-3)
    });
    assert!(desk.journal().is_none_or(|kept| kept.edits == saved.edits));
    desk.display.tap(HOME);

    // What was liked last is kept, however soon the window closes.
    for theme in ["Light", "Dark"] {
        desk.display.tap(u32::from('l'));
        desk.reads(theme);
    }
    desk.display.close();
    assert_eq!(desk.ended(), Some(0), "{}", desk.log());
    assert!(desk.preferences().contains("theme = \"light\""), "{}", desk.preferences());
    assert!(late < Duration::from_secs(3), "{late:?}");
    assert!(!desk.log().contains("panicked"), "{}", desk.log());
}

/// Each of the seven steps is done, not skipped.
fn the_tour_is_taken_by_hand() {
    let mut desk = Desk::new("tour", [1440, 900]);
    desk.open(&[]);
    desk.click("Help");
    desk.click("Take the tour");
    let next = |desk: &Desk| {
        desk.reads("Done: ");
        desk.click("Next: tour");
    };
    for (title, button) in [
        ("An arm shakes what it stands on", "Show me"),
        ("Balance takes the force away", "Hang 0.3 kg on it"),
        ("Balance makes the mass matrix constant", "Take it off"),
        ("On a plane the drives cancel out", "Show me"),
    ] {
        desk.bus.node_as(LABEL, title);
        assert!(desk.bus.tree().expect("it answers").containing("Done: ").is_none(), "{title}: nothing was done yet");
        desk.click_as(BUTTON, button);
        next(&desk);
    }
    desk.bus.node_as(LABEL, "The reactionless workspace");
    let ring = desk.ring();
    desk.display.drag(ring, [ring[0] - 20, ring[1] + 20]);
    next(&desk);
    desk.bus.node_as(LABEL, "b only turns it");
    slide(&desk, "b slider", 0.06);
    next(&desk);
    desk.bus.node_as(LABEL, "What it costs to change planes");
    desk.click_as(BUTTON, "Start time");
    slide(&desk, "b slider", 0.05);
    desk.reads("Done: ");
    desk.click("End: tour");
    desk.reads_no("What it costs to change planes");
    desk.display.close();
    desk.reads("Save before closing?");
    desk.click("Close without saving");
    assert_eq!(desk.ended(), Some(0), "{}", desk.log());
}
