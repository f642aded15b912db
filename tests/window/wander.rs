//! Random hands and keys, for as long as is asked for: nothing panics, hangs, or takes more and more memory.
//!
//! `STILLBASE_WANDER_SECONDS` says for how long, an hour if it is not set; `STILLBASE_WANDER_SEED` where it starts.

use std::fs;
use std::time::{Duration, Instant};

use super::display::{ALT, CTRL, DELETE, DOWN, END, ENTER, ESC, F12, HOME, LEFT, RIGHT, SHIFT, TAB, UP};
use super::program::Desk;
use super::wait::{pause, within};
use crate::Test;

pub const TESTS: &[Test] = super::tests![random_hands_and_keys_do_no_harm];

/// Numbers that look random and are the same each time.
struct Noise(u64);

impl Noise {
    fn below(&mut self, most: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % most
    }

    fn of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }
}

fn setting(name: &str, usual: u64) -> u64 {
    std::env::var(name).ok().and_then(|value| value.parse().ok()).unwrap_or(usual)
}

/// Resident memory of a process, MiB.
fn memory(id: u32) -> f64 {
    let status = fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap_or_default();
    line.trim().trim_end_matches(" kB").parse::<f64>().unwrap_or_default() / 1024.0
}

const LETTERS: &str = "abcdefghijklmnopqrstuvwxyz0123456789 .,-=[]/;";
const OTHERS: [u32; 13] = [ENTER, ESC, TAB, HOME, END, LEFT, RIGHT, UP, DOWN, DELETE, F12, 0xffbe, 0xff55];

/// Something that a hand may do.
fn something(desk: &Desk, noise: &mut Noise) -> String {
    let [width, height] = desk.display.size.map(usize::from);
    let place = |noise: &mut Noise| [noise.below(width) as i16, noise.below(height) as i16];
    let letters: Vec<char> = LETTERS.chars().collect();
    match noise.below(20) {
        0..5 => {
            let key = u32::from(noise.of(&letters));
            desk.display.tap(key);
            format!("key {key:#x}")
        }
        5..8 => {
            let key = noise.of(&OTHERS);
            desk.display.tap(key);
            format!("key {key:#x}")
        }
        8..10 => {
            let (held, key) = (noise.of(&[CTRL, SHIFT, ALT]), noise.of(&letters));
            let key = if noise.below(2) == 0 { u32::from(key) } else { noise.of(&OTHERS) };
            if (held, key) == (CTRL, u32::from('q')) {
                return "nothing: that would be the end".into();
            }
            desk.display.keys(&[held], key);
            format!("key {held:#x} and {key:#x}")
        }
        10..14 => {
            let at = place(noise);
            desk.display.click(at);
            format!("click at {at:?}")
        }
        14..17 => {
            let (from, to) = (place(noise), place(noise));
            desk.display.drag(from, to);
            format!("drag from {from:?} to {to:?}")
        }
        17 => {
            let (at, button) = (place(noise), noise.of(&[2, 3, 4, 5]));
            desk.display.move_to(at);
            for _ in 0..noise.below(4) + 1 {
                desk.display.press(button);
                desk.display.let_go(button);
            }
            format!("button {button} at {at:?}")
        }
        18 => {
            // What there is to click on is clicked on, too.
            let tree = desk.bus.tree();
            let nodes = tree.as_ref().map(|tree| tree.nodes.as_slice()).unwrap_or_default();
            let buttons: Vec<_> =
                nodes.iter().filter(|node| [7, 11, 43, 44, 51, 52, 62].contains(&node.role)).collect();
            let chosen = (!buttons.is_empty()).then(|| noise.of(&buttons));
            let at = chosen.and_then(|node| tree.as_ref()?.middle(node));
            let at = at.unwrap_or_else(|| place(noise));
            desk.display.click(at);
            format!("click on \"{}\" at {at:?}", chosen.map_or("nothing", |node| &node.name))
        }
        _ => {
            let size = [960 + noise.below(width - 959) as u32, 600 + noise.below(height - 599) as u32];
            desk.display.resize(size);
            format!("size {size:?}")
        }
    }
}

/// Back to the start: nothing open, the paper's case 3; what is resident then, MiB.
fn settled(desk: &Desk) -> f64 {
    desk.display.resize([1280, 800]);
    for _ in 0..4 {
        desk.display.tap(ESC);
        pause(200);
    }
    desk.display.tap(u32::from('5'));
    desk.display.tap(u32::from('3'));
    pause(4000);
    memory(desk.id())
}

/// Opens the program so that all that is large goes back to the system when it is let go: what grows is held.
fn open(desk: &mut Desk) {
    const LARGE: &str = "65536";
    desk.open_with(&[], |command| command.env("MALLOC_MMAP_THRESHOLD_", LARGE).env("MALLOC_TRIM_THRESHOLD_", LARGE));
}

fn random_hands_and_keys_do_no_harm() {
    let (seconds, seed) = (setting("STILLBASE_WANDER_SECONDS", 3600), setting("STILLBASE_WANDER_SEED", 1));
    println!("random hands and keys for {seconds} s from seed {seed}");
    let mut desk = Desk::new("wander", [1440, 900]);
    open(&mut desk);
    let mut noise = Noise(seed);
    let (begun, all) = (Instant::now(), Duration::from_secs(seconds));
    let (mut done, mut last, mut resident) = (0_u64, Vec::new(), Vec::new());
    let mut looked = Instant::now();
    while begun.elapsed() < all {
        last.push(something(&desk, &mut noise));
        done += 1;
        if last.len() > 12 {
            last.remove(0);
        }
        if !desk.is_running() {
            let (code, log) = (desk.ended(), desk.log());
            assert_eq!(code, Some(0), "ended after {done} doings, the last {last:#?}\n{log}");
            println!("closed after {done} doings; opened again");
            open(&mut desk);
            resident.clear();
        }
        if looked.elapsed() > Duration::from_secs(20) || done == 100 {
            desk.display.focus();
            let answers = within(60, || desk.bus.tree()?.containing("Scene:").map(|_| ()));
            assert!(answers.is_some(), "no answer after {done} doings, the last {last:#?}\n{}", desk.log());
            assert!(!desk.log().contains("panicked"), "after {done} doings, the last {last:#?}\n{}", desk.log());
            resident.push(settled(&desk));
            println!(
                "{:5.0} s, {done:6} doings, {:4.0} MiB",
                begun.elapsed().as_secs_f64(),
                resident[resident.len() - 1]
            );
            looked = Instant::now();
        }
    }
    if resident.len() < 8 {
        println!("{done} doings; too short to tell whether memory grows: {resident:.0?} MiB");
        return;
    }
    // The first quarter fills what is kept for later use.
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let quarter = resident.len().div_ceil(4);
    let (early, late) = (mean(&resident[quarter..2 * quarter]), mean(&resident[resident.len() - quarter..]));
    println!("{done} doings; {early:.0} MiB in the second quarter of the time, {late:.0} MiB in the last");
    assert!(late < 1.25 * early + 64.0, "memory grows: {resident:?}");
}
