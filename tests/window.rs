//! The running program in a real window on a virtual display, used with a pointer and keys, and read as a screen reader
//! reads it.
//!
//! Without a virtual display, an accessibility bus or a graphics adapter every test here counts as ignored, with the
//! reason; with `STILLBASE_REQUIRE_WINDOW=1`, as CI sets it, every one fails.

use std::process::ExitCode;

use libtest_mimic::{Arguments, Trial, run};

#[cfg(target_os = "linux")]
#[allow(dead_code, reason = "other tests use the rest")]
mod folder;
#[cfg(target_os = "linux")]
#[allow(dead_code, reason = "other tests use the rest")]
mod gpu;
#[cfg(target_os = "linux")]
#[path = "window/mod.rs"]
mod real;

/// A test: its name with its module, and what it does. It passes unless it panics.
#[cfg(target_os = "linux")]
pub type Test = (&'static str, fn());

/// What is tested, and what that lacks here, if something.
#[cfg(target_os = "linux")]
fn trials() -> (Vec<Trial>, Option<String>) {
    use libtest_mimic::Completion;

    let missing = real::missing();
    let required = std::env::var_os("STILLBASE_REQUIRE_WINDOW").is_some_and(|value| value == "1");
    let why = missing.clone();
    let trial = move |(name, test): Test| {
        let (name, why) = (name.split_once("::real::").map_or(name, |(_, rest)| rest), why.clone());
        Trial::ignorable_test(name, move || match why {
            Some(why) if required => Err(format!("STILLBASE_REQUIRE_WINDOW=1, but {why}").into()),
            Some(why) => Ok(Completion::ignored_with(why)),
            None => {
                test();
                Ok(Completion::Completed)
            }
        })
    };
    let long = real::LONG.iter().map(|test| trial(*test).with_ignored_flag(true));
    (real::TESTS.concat().into_iter().map(&trial).chain(long).collect(), missing)
}

#[cfg(not(target_os = "linux"))]
fn trials() -> (Vec<Trial>, Option<String>) {
    (Vec::new(), Some("the virtual display is for Linux".into()))
}

fn main() -> ExitCode {
    let (trials, missing) = trials();
    if let Some(why) = missing {
        eprintln!("tests in a real window are left out: {why}");
    }
    // Each has a screen and hands of its own, and yet they would wait for each other's pictures.
    let mut arguments = Arguments::from_args();
    arguments.test_threads.get_or_insert(1);
    run(&arguments, trials).exit_code()
}
