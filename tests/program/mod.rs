//! The program, from outside.

mod assemblies;
mod dynamics;
#[cfg(feature = "ui")]
mod figures;
mod files;
#[cfg(unix)]
mod guide;
mod headless;
mod help;
mod in_process;
mod input;
mod joints;
mod learn;
mod machines;
mod net;
mod plan;
mod reach;
#[cfg(feature = "record")]
mod recorded;
mod results;
mod schema;
mod scripts;
mod simulate;
mod study;
mod trim;
mod ways;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use serde_json::{Value, json};

use crate::folder::Folder;

impl Folder {
    /// The program, to be run in it.
    pub fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_stillbase"));
        command.args(args).current_dir(&self.0).stdin(Stdio::null());
        command
    }

    pub fn run(&self, args: &[&str]) -> Output {
        self.command(args).output().expect("the program starts")
    }
}

fn stillbase_in(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_stillbase"))
        .args(args)
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .expect("the program starts")
}

fn stillbase(args: &[&str]) -> Output {
    stillbase_in(Path::new(env!("CARGO_TARGET_TMPDIR")), args)
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("UTF-8")
}

/// What a command that succeeds prints.
fn prints(args: &[&str]) -> String {
    let out = stillbase(args);
    assert_eq!(out.status.code(), Some(0), "{args:?}: {}", text(&out.stderr));
    text(&out.stdout).to_owned()
}

/// The one object that a command prints.
fn object(args: &[&str]) -> Value {
    let printed = prints(&[args, &["--json"]].concat());
    let value: Value = serde_json::from_str(&printed).unwrap_or_else(|e| panic!("{args:?}: {e}"));
    assert!(value.is_object(), "{args:?}: {printed}");
    value
}

/// A command that fails says why in one line, proposes settings or command lines in further lines, and prints no result.
/// Faults of a file have a line each, with lines of examples.
fn fails(args: &[&str], status: i32, words: &[&str]) {
    let out = stillbase(args);
    let said = text(&out.stderr);
    assert_eq!(out.status.code(), Some(status), "{args:?}: {said}");
    let way_out = |line: &str| line.contains(": --set ") || line.contains(": stillbase ");
    let is_of_faults = |line: &str| {
        let fault =
            line.strip_prefix("stillbase: ").is_some_and(|rest| rest.contains(".toml") || rest.starts_with("and "));
        fault || line == "stillbase: for example:" || line.starts_with("    ") || line.is_empty()
    };
    let has_faults = said.contains(" faults\n") || said.contains("stillbase: for example:\n");
    let proposes =
        |line: &str| (line.starts_with("stillbase: ") && way_out(line)) || (has_faults && is_of_faults(line));
    assert!(said.starts_with("stillbase: ") && said.trim_end().lines().skip(1).all(proposes), "{args:?}: {said}");
    for word in words {
        assert!(said.contains(word), "{args:?}: {said:?} lacks {word:?}");
    }
    // As JSON, the refusal of a scenario is an object of its own.
    let refusal: Option<Value> = serde_json::from_slice(&out.stdout).ok().filter(|_| args.contains(&"--json"));
    let keys_of_one = [&["proposals", "reason"][..], &["faults", "more_faults", "proposals", "reason"]];
    let is_refusal = refusal.is_some_and(|refusal| keys_of_one.contains(&&keys(&refusal)[..]));
    assert!(out.stdout.is_empty() || is_refusal, "{args:?}: {}", text(&out.stdout));
}

/// The keys of an object, in alphabetical order.
fn keys(value: &Value) -> Vec<&str> {
    value.as_object().expect("an object").keys().map(String::as_str).collect()
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(all) => all.iter().flat_map(numbers).collect(),
        other => vec![other.as_f64().expect("a number")],
    }
}

/// Every number within `tolerance` of the largest wanted one.
fn near(got: &Value, want: &Value, tolerance: f64, what: &str) {
    let (got, want) = (numbers(got), numbers(want));
    assert_eq!(got.len(), want.len(), "{what}");
    let scale = want.iter().fold(1e-3, |m: f64, x| m.max(x.abs()));
    for (g, w) in got.iter().zip(&want) {
        assert!((g - w).abs() <= tolerance * scale, "{what}: {g} for {w}");
    }
}

fn planning() -> Value {
    serde_json::from_str(include_str!("../reference/planning.json")).expect("reference")
}

/// `x,y` with every digit.
fn joined(values: &Value) -> String {
    numbers(values).iter().map(f64::to_string).collect::<Vec<_>>().join(",")
}

/// A file as a word of a command line.
fn word(file: std::path::PathBuf) -> String {
    file.display().to_string()
}

const NINE_LINK: &str = include_str!("../../assets/machines/nine-link.toml");

/// A folder of this test's own, empty.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// Runs in a folder and says what it printed on standard error.
fn said_in(folder: &Path, args: &[&str], status: i32) -> String {
    let out = stillbase_in(folder, args);
    assert_eq!(out.status.code(), Some(status), "{args:?}: {}", text(&out.stderr));
    text(&out.stderr).to_owned()
}
