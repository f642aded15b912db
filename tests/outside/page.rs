//! The scripts of the page *From Python* of the guide run as they stand there, and print what the page shows.

use std::process::Stdio;

use super::folder::Folder;
use super::markdown::blocks;
use super::python::python;
use crate::Test;

pub const TABLES: &[Test] = tests![a_run_is_a_table, a_recording_is_a_table];
pub const IN_MUJOCO: &[Test] = tests![the_same_motion_in_mujoco];
pub const IN_PINOCCHIO: &[Test] = tests![the_mass_matrix_by_pinocchio];

const PAGE: &str = include_str!("../../src/guide/python.md");

/// Text of the block of a kind: `python table.py`, or `text table.py` for what it prints.
fn block(kind: &str) -> String {
    let all = blocks(PAGE);
    let mut found = all.into_iter().filter(|block| block.kind == kind);
    let one = found.next().unwrap_or_else(|| panic!("the page has no block {kind:?}"));
    assert!(found.next().is_none(), "the page has one block {kind:?}");
    one.text
}

/// Runs a script of the page in a folder of its own, with the program on its path. In what the page shows, `…` stands for
/// the rest of a line.
fn runs(script: &str) {
    let (folder, shown) = (Folder::new("python"), block(&format!("text {script}")));
    folder.file(script, block(&format!("python {script}")));
    let program = std::path::Path::new(env!("CARGO_BIN_EXE_stillbase")).parent().expect("a folder");
    let path = std::env::var("PATH").unwrap_or_default();
    let run = python()
        .arg(script)
        .current_dir(&folder.0)
        .env("PATH", format!("{}:{path}", program.display()))
        .stdin(Stdio::null())
        .output()
        .expect("it was there a moment ago");
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(run.status.success(), "{script}: {said}");
    let printed = String::from_utf8(run.stdout).expect("UTF-8");
    let (shown, printed): (Vec<&str>, Vec<&str>) = (shown.lines().collect(), printed.lines().collect());
    assert_eq!(shown.len(), printed.len(), "{script} prints\n{}", printed.join("\n"));
    for (shown, printed) in shown.iter().zip(&printed) {
        let is_same = shown.strip_suffix('…').map_or(shown == printed, |start| printed.starts_with(start));
        assert!(is_same, "{script}: {printed}, the page shows {shown}");
    }
}

fn a_run_is_a_table() {
    runs("table.py");
}

fn a_recording_is_a_table() {
    runs("recorded.py");
}

fn the_same_motion_in_mujoco() {
    runs("in_mujoco.py");
}

fn the_mass_matrix_by_pinocchio() {
    runs("in_pinocchio.py");
}
