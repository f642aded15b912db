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

/// Words that do not end a shortened text.
const JOINING_WORDS: [&str; 20] = [
    "and", "the", "of", "on", "in", "to", "for", "with", "at", "is", "by", "or", "as", "an", "that", "its", "from",
    "off", "it", "be",
];
/// Least number of characters of a shortened text, without the ellipsis.
const MIN_CHARS: usize = 3;

/// Returns the longest beginning of a text that fits, with an ellipsis in place of the rest. Words like `and` do not
/// end it; a single word is cut after three characters or more. Empty if not even those fit.
pub fn cut_at_word<'a>(text: &'a str, fits: impl Fn(&str) -> bool) -> Cow<'a, str> {
    if fits(text) {
        return text.into();
    }
    let gaps: Vec<usize> = text.char_indices().filter(|(_, c)| c.is_whitespace()).map(|(i, _)| i).collect();
    let cut = |kept: &str| Some(format!("{kept}…")).filter(|cut| kept.chars().count() >= MIN_CHARS && fits(cut));
    if let Some(words) = gaps.iter().rev().find_map(|end| cut(without_loose_end(&text[..*end]))) {
        return words.into();
    }
    let word = text.split_whitespace().next().unwrap_or_default();
    let ends: Vec<usize> = word.char_indices().map(|(i, _)| i).skip(MIN_CHARS).collect();
    ends.into_iter().rev().find_map(|end| cut(&word[..end])).unwrap_or_default().into()
}

/// Returns words that begin with a capital letter.
pub fn capitalised(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// Returns a text without signs, joining words and single letters at its end.
fn without_loose_end(text: &str) -> &str {
    let mut kept = text;
    loop {
        let trimmed =
            kept.trim_end().trim_end_matches([',', ';', ':', '·', '–', '—', '-', '(', '|', '=', '+', '<', '>']);
        let last = trimmed.rsplit(char::is_whitespace).next().unwrap_or_default();
        let is_loose = last.chars().count() == 1 || JOINING_WORDS.contains(&last.to_lowercase().as_str());
        let shorter = if is_loose { &trimmed[..trimmed.len() - last.len()] } else { trimmed };
        if shorter.len() == kept.len() {
            return kept;
        }
        kept = shorter;
    }
}

/// Returns a path that fits: its last folders, with an ellipsis in place of the first ones.
pub fn cut_path<'a>(path: &'a str, fits: impl Fn(&str) -> bool) -> Cow<'a, str> {
    if fits(path) {
        return path.into();
    }
    let ends = path.match_indices(['/', '\\']).map(|(i, _)| format!("…{}", &path[i..]));
    let folders = ends.skip(1).find(|end| fits(end));
    folders.map_or_else(|| cut_at_word(path.rsplit(['/', '\\']).next().unwrap_or_default(), &fits), Cow::from)
}
