//! What stands before a session in a file and is no part of it: to TOML it is comments.

use serde::Serialize;
use serde::de::DeserializeOwned;

/// How each of its lines begins.
const MARK: &str = "#| ";

/// The most bytes that are read of it.
const MAX_BYTES: usize = 64 * 1024;

/// A text with a heading before it; one that cannot be written is left out.
pub fn under(heading: &impl Serialize, text: &str) -> String {
    let heading = toml::to_string(heading).unwrap_or_default();
    let lines: String = heading.lines().map(|line| format!("{MARK}{line}\n")).collect();
    format!("{lines}{text}")
}

/// The heading of a text, if it is understood.
pub fn of<T: DeserializeOwned>(text: &str) -> Option<T> {
    let lines = text.lines().map_while(|line| line.strip_prefix(MARK).or((line == MARK.trim_end()).then_some("")));
    let heading: String = lines.flat_map(|line| [line, "\n"]).collect();
    let is_there = !heading.is_empty() && heading.len() <= MAX_BYTES;
    is_there.then(|| toml::from_str(&heading).ok()).flatten()
}
