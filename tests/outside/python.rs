//! Asking Python.

use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Command, Stdio};

pub fn python() -> Command {
    Command::new(std::env::var_os("STILLBASE_PYTHON").unwrap_or_else(|| "python3".into()))
}

/// Whether every package has to be there.
pub fn is_required() -> bool {
    std::env::var_os("STILLBASE_REQUIRE_PYTHON").is_some_and(|word| word == "1")
}

/// Why a package cannot be asked.
pub fn missing(package: &str) -> Option<String> {
    let asked = python().args(["-c", &format!("import {package}, numpy")]).stdin(Stdio::null()).output();
    match asked {
        Ok(out) if out.status.success() => None,
        Ok(out) => {
            let words = String::from_utf8_lossy(&out.stderr);
            Some(words.lines().last().unwrap_or("python ends with an error").to_owned())
        }
        Err(why) => Some(format!("no python3: {why}")),
    }
}

/// A line for each line that a script is given.
pub fn answers(script: &str, lines: &[String]) -> Vec<serde_json::Value> {
    let mut child = python()
        .args(["-c", script])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("it was there a moment ago");
    let mut to = child.stdin.take().expect("piped");
    let from = BufReader::new(child.stdout.take().expect("piped"));
    std::thread::scope(|scope| {
        scope.spawn(move || lines.iter().for_each(|line| writeln!(to, "{line}").expect("it listens")));
        let answers = from.lines().map(|line| serde_json::from_str(&line.expect("text")).expect("JSON")).collect();
        assert!(child.wait().expect("it ends").success());
        answers
    })
}
