//! Writes lines of XML.

use std::fmt::{Arguments, Write as _};

/// A text that grows line by line.
#[derive(Debug, Default)]
pub struct XmlWriter {
    out: String,
}

impl XmlWriter {
    /// Adds a line, indented by `depth` steps.
    pub fn add(&mut self, depth: usize, line: Arguments<'_>) {
        // Writing to a `String` never fails.
        let _ = writeln!(self.out, "{:1$}{line}", "", 2 * depth);
    }

    /// Returns the whole text.
    pub fn into_text(self) -> String {
        self.out
    }
}

/// Escapes text for an attribute.
pub fn quoted(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

/// Escapes text for a comment, which must not contain two hyphens.
pub fn remark(text: &str) -> String {
    quoted(text).replace("--", "-\u{2010}")
}
