//! The tests that draw: the window and its pictures. They need a GPU adapter; one in software will do.
//!
//! The standard harness cannot ignore a test once it runs; this one can. Without an adapter every test here counts as
//! ignored, with the reason; with `STILLBASE_REQUIRE_GPU=1`, as CI sets it, every one fails.

use std::process::ExitCode;

use libtest_mimic::{Arguments, Completion, Trial, run};

/// A test: its name with its module, and what it does. It passes unless it panics.
pub type Test = (&'static str, fn());

/// Lists the tests of a module. One that is left out is code that nobody calls, and the lints refuse that.
macro_rules! tests {
    ($($name:ident),+ $(,)?) => {
        &[$((concat!(module_path!(), "::", stringify!($name)), $name)),+]
    };
}

#[cfg(feature = "window")]
mod app;
#[cfg(feature = "window")]
mod folder;
mod gpu;
mod picture {
    #[cfg(all(feature = "window", feature = "cli"))]
    pub mod committed;
    pub mod drawn;
    #[cfg(feature = "ui")]
    pub mod gui;
    pub mod render;
}

fn main() -> ExitCode {
    let required = std::env::var_os("STILLBASE_REQUIRE_GPU").is_some_and(|value| value == "1");
    let mut tests = [picture::drawn::TESTS, picture::render::TESTS].concat();
    #[cfg(feature = "ui")]
    tests.extend(picture::gui::TESTS);
    #[cfg(feature = "window")]
    tests.extend(app::TESTS.concat());
    #[cfg(all(feature = "window", feature = "cli"))]
    tests.extend(picture::committed::TESTS);
    if let Some(why) = gpu::missing() {
        eprintln!("tests that draw {}: {why}", if required { "fail" } else { "are ignored" });
    }
    let trial = |(name, test): Test| {
        let name = name.split_once("::").map_or(name, |(_, rest)| rest);
        Trial::ignorable_test(name, move || match gpu::missing() {
            Some(_) if required => Err("STILLBASE_REQUIRE_GPU=1, but there is no GPU adapter".into()),
            Some(_) => Ok(Completion::ignored_with("no GPU adapter")),
            None => {
                // Each in a thread of its own, as the standard harness does it: snapshots are counted by thread.
                let test = std::thread::Builder::new().name(name.into()).spawn(test);
                test?.join().unwrap_or_else(|why| std::panic::resume_unwind(why));
                Ok(Completion::Completed)
            }
        })
    };
    run(&Arguments::from_args(), tests.into_iter().map(trial).collect()).exit_code()
}
