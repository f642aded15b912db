//! Lines of XML.

use std::fmt::{Arguments, Write as _};

/// A text that grows line by line.
#[derive(Debug, Default)]
pub struct Lines {
    out: String,
}

impl Lines {
    /// One more line, indented by so many steps.
    pub fn add(&mut self, depth: usize, line: Arguments<'_>) {
        // A `String` takes everything.
        let _ = writeln!(self.out, "{:1$}{line}", "", 2 * depth);
    }

    /// The whole text.
    pub fn into_text(self) -> String {
        self.out
    }
}

/// Text that may stand in an attribute.
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

/// Text that may stand in a comment, which two hyphens would end.
pub fn remark(text: &str) -> String {
    quoted(text).replace("--", "-\u{2010}")
}
