//! Symbols with indices. In text, `_{…}` encloses an index, as in `l_{c1}`, and `ᵀ` marks a transpose.

/// Vertical position of a piece of a symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// On the baseline.
    Line,
    /// Subscript.
    Index,
    /// Superscript.
    Raised,
}

/// Splits a symbol into pieces. The T of a transpose is a separate piece, because few fonts have it as a superscript.
pub fn pieces(symbol: &str) -> impl Iterator<Item = (&str, Level)> {
    symbol.split("_{").enumerate().flat_map(|(i, piece)| {
        let (index, rest) = if i == 0 { ("", piece) } else { piece.split_once('}').unwrap_or((piece, "")) };
        let transposes = rest.split('\u{1d40}').enumerate().flat_map(|(i, text)| {
            let raised = if i == 0 { "" } else { "T" };
            [(raised, Level::Raised), (text, Level::Line)]
        });
        [(index, Level::Index)].into_iter().chain(transposes).filter(|(text, _)| !text.is_empty())
    })
}

/// Returns a symbol as plain text: numeric indices as subscript digits, m₁, others after an underscore, l_c1.
pub fn plain(symbol: &str) -> String {
    let small = |c: char| c.to_digit(10).and_then(|digit| char::from_u32('₀' as u32 + digit));
    let digits = |text: &str| text.chars().map(small).collect::<Option<String>>();
    let piece = |(text, level): (&str, Level)| match level {
        Level::Line => text.to_owned(),
        Level::Raised => "\u{1d40}".to_owned(),
        Level::Index => digits(text).unwrap_or_else(|| format!("_{text}")),
    };
    pieces(symbol).map(piece).collect()
}

/// Converts a name of a machine file to a symbol: `l12` is l with the index 12.
pub(super) fn symbol_of_name(name: &str) -> String {
    let letters = name.trim_end_matches(|c: char| c.is_ascii_digit());
    match letters.len() < name.len() && !letters.is_empty() {
        true => format!("{letters}_{{{}}}", &name[letters.len()..]),
        false => name.to_owned(),
    }
}

/// Returns a letter with an index.
pub(super) fn indexed_symbol(letter: &str, index: impl std::fmt::Display) -> String {
    format!("{letter}_{{{index}}}")
}
