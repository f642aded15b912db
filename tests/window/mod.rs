//! What a person needs to use the program, and what is tried with it.

mod beside;
mod display;
mod drawing;
mod hands;
mod keyboard;
mod loss;
mod portal;
mod process;
mod program;
mod reader;
mod tasks;
mod wait;
mod wander;

use std::env::{split_paths, var_os};

use crate::Test;

/// Lists the tests of a module. One that is left out is code that nobody calls, and the lints refuse that.
macro_rules! tests {
    ($($name:ident),+ $(,)?) => {
        &[$((concat!(module_path!(), "::", stringify!($name)), $name)),+]
    };
}

use tests;

pub const TESTS: [&[Test]; 7] =
    [beside::TESTS, drawing::TESTS, hands::TESTS, keyboard::TESTS, loss::TESTS, portal::TESTS, tasks::TESTS];

/// Those that are asked for only.
pub const LONG: &[Test] = wander::TESTS;

/// What a window needs and is not here, if something.
pub fn missing() -> Option<String> {
    let there = |program: &str| split_paths(&var_os("PATH").unwrap_or_default()).any(|p| p.join(program).exists());
    if !there("Xvfb") {
        return Some("there is no Xvfb: `apt-get install xvfb`".into());
    }
    if !there("dbus-daemon") {
        return Some("there is no dbus-daemon: `apt-get install dbus`".into());
    }
    if reader::launcher().is_none() {
        return Some("there is no at-spi-bus-launcher: `apt-get install at-spi2-core`".into());
    }
    crate::gpu::missing().map(ToString::to_string)
}
