//! The Python package, where it is installed (`pip install .`): its documentation, and its numbers beside NumPy's.

use super::python::python;
use crate::Test;

pub const TESTS: &[Test] = tests![the_package_does_what_it_says];

/// Its doctests pass, and so does a script that holds it against sums of its own.
fn the_package_does_what_it_says() {
    let done = python().args(["-c", include_str!("package.py")]).output().expect("it was there a moment ago");
    let said = [done.stdout, done.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
    assert!(done.status.success(), "{said}");
}
