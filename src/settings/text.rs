//! Text from outside, shown so that it does nothing to a terminal.

use std::borrow::Cow;

/// The largest text that is read, bytes: a session of 100,000 edits has half of it.
pub const MOST_BYTES: u64 = 16 << 20;

/// Text for a terminal: what would steer one, or turn the order of its letters, is spelled out.
pub fn plain(text: &str) -> Cow<'_, str> {
    if !text.contains(steers) {
        return text.into();
    }
    let mut plain = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if steers(c) { plain.extend(c.escape_default()) } else { plain.push(c) }
    }
    plain.into()
}

/// The first character of a text that would steer a terminal or turn the order of its letters; line ends may stand.
pub fn steering(text: &str) -> Option<char> {
    text.chars().find(|c| steers(*c))
}

/// A text as a cell of a spreadsheet: one that a spreadsheet would compute as a formula begins with an apostrophe.
pub fn sheet_cell(text: &str) -> Cow<'_, str> {
    let is_formula = text.trim_start().starts_with(['=', '+', '-', '@']);
    if is_formula { format!("'{text}").into() } else { text.into() }
}

fn steers(c: char) -> bool {
    let turns = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    turns || c == '\u{feff}' || (c.is_control() && c != '\n')
}

/// Characters of a message, and of its end, that are kept of a long one.
const MOST_SAID: usize = 1600;
const END_SAID: usize = 400;

/// A message that is not too long to be read: of a longer one the middle is left out.
pub fn brief(text: &str) -> Cow<'_, str> {
    // No text has more characters than bytes.
    if text.len() <= MOST_SAID {
        return text.into();
    }
    let count = text.chars().count();
    if count <= MOST_SAID {
        return text.into();
    }
    let begin: String = text.chars().take(MOST_SAID - END_SAID).collect();
    let end: String = text.chars().skip(count - END_SAID).collect();
    format!("{begin} … ({} characters left out) … {end}", count - MOST_SAID).into()
}
