//! A heading before the session in a file; TOML reads its lines as comments.

use serde::Serialize;
use serde::de::DeserializeOwned;

/// Beginning of each line of a heading.
const MARK: &str = "#| ";

/// Maximum size of a heading that is read, bytes; a heading may hold whole sessions.
const MAX_BYTES: usize = 16 * 1024 * 1024;

/// Returns a text with a heading before it; a heading that cannot be serialised is omitted.
pub fn under(heading: &impl Serialize, text: &str) -> String {
    let heading = toml::to_string(heading).unwrap_or_default();
    let lines: String = heading.lines().map(|line| format!("{MARK}{line}\n")).collect();
    format!("{lines}{text}")
}

/// Returns the heading of a text, if it can be parsed.
pub fn of<T: DeserializeOwned>(text: &str) -> Option<T> {
    let lines = text.lines().map_while(|line| line.strip_prefix(MARK).or((line == MARK.trim_end()).then_some("")));
    let heading: String = lines.flat_map(|line| [line, "\n"]).collect();
    let is_there = !heading.is_empty() && heading.len() <= MAX_BYTES;
    is_there.then(|| toml::from_str(&heading).ok()).flatten()
}
