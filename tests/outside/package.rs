//! The Python package, where it is installed (`pip install .`): its documentation, its numbers beside NumPy's, and its
//! notebooks.

use super::python::python;
use crate::Test;

pub const TESTS: &[Test] = tests![the_package_does_what_it_says, an_interrupt_ends_a_call];
#[cfg(feature = "cli")]
pub const NOTEBOOKS: &[Test] = tests![the_notebooks_hold_what_they_assert];

/// Its doctests pass, and so does a script that holds it against sums of its own.
fn the_package_does_what_it_says() {
    passes(include_str!("package.py"));
}

/// Ctrl-C ends a call within a moment, with nothing left behind. Other systems have no alarms.
fn an_interrupt_ends_a_call() {
    if cfg!(unix) {
        passes(include_str!("package_interrupts.py"));
    }
}

fn passes(script: &str) {
    let done = python().args(["-c", script]).output().expect("it was there a moment ago");
    let said = [done.stdout, done.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
    assert!(done.status.success(), "{said}");
}

/// Each runs from its first cell to its last, as a script.
#[cfg(feature = "cli")]
fn the_notebooks_hold_what_they_assert() {
    let folder = super::folder::Folder::new("notebooks");
    let all = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/src/python/notebooks")).expect("a folder");
    let all: Vec<_> = all.map(|entry| entry.expect("an entry").path()).collect();
    assert!(all.len() >= 4, "{all:?}");
    for notebook in all {
        let text = std::fs::read_to_string(&notebook).expect("text");
        assert!(text.starts_with("# %% [markdown]\n# # ") && text.contains("\nassert "), "{}", notebook.display());
        let run = python().arg(&notebook).current_dir(&folder.0).env("MPLBACKEND", "Agg").output().expect("it runs");
        assert!(run.status.success(), "{}: {}", notebook.display(), String::from_utf8_lossy(&run.stderr));
    }
}
