//! External text, shown so that it does not control a terminal.

use std::borrow::Cow;

/// Maximum size of a text that is read, bytes: a session of 100,000 edits takes half of it.
pub const MAX_TEXT_BYTES: u64 = 16 << 20;

/// Returns text for a terminal: characters that control a terminal or change the writing direction are escaped.
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

/// Returns the first character that controls a terminal or changes the writing direction; line feeds are allowed.
pub fn control_character(text: &str) -> Option<char> {
    text.chars().find(|c| steers(*c))
}

/// Returns a word as a shell takes it: in quotes if it holds more than letters, digits and harmless signs.
pub fn shell_word(word: &str) -> Cow<'_, str> {
    let is_plain = |c: char| c.is_alphanumeric() || "=.,-_+:/".contains(c);
    if word.chars().all(is_plain) { word.into() } else { format!("'{}'", word.replace('\'', r"'\''")).into() }
}

/// Returns a text as a cell of a spreadsheet: a text that a spreadsheet would read as a formula gets an apostrophe in
/// front.
pub fn sheet_cell(text: &str) -> Cow<'_, str> {
    let is_formula = text.trim_start().starts_with(['=', '+', '-', '@']);
    if is_formula { format!("'{text}").into() } else { text.into() }
}

fn steers(c: char) -> bool {
    let turns = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    turns || c == '\u{feff}' || (c.is_control() && c != '\n')
}

/// Maximum length of a message, characters.
const MAX_MESSAGE_CHARS: usize = 1600;
/// Number of characters that are kept from the end of a longer message.
const MESSAGE_END_CHARS: usize = 400;

/// Returns a message of readable length: the middle of a longer one is omitted.
pub fn shorten_message(text: &str) -> Cow<'_, str> {
    // A text has at most as many characters as bytes.
    if text.len() <= MAX_MESSAGE_CHARS {
        return text.into();
    }
    let count = text.chars().count();
    if count <= MAX_MESSAGE_CHARS {
        return text.into();
    }
    let begin: String = text.chars().take(MAX_MESSAGE_CHARS - MESSAGE_END_CHARS).collect();
    let end: String = text.chars().skip(count - MESSAGE_END_CHARS).collect();
    format!("{begin} … ({} characters left out) … {end}", count - MAX_MESSAGE_CHARS).into()
}
