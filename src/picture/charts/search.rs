//! Text search for signals by parts of a name, symbol, path or unit.

use stillbase_simulation::signals::Signal;

/// Returns the signals that match every word of `text`, best matches first; all signals if `text` is empty.
pub fn search<'a>(signals: &'a [Signal], text: &str) -> Vec<&'a Signal> {
    let text = plain(text);
    let words: Vec<&str> = text.split_whitespace().collect();
    let mut found: Vec<(u32, &Signal)> = signals
        .iter()
        .filter_map(|signal| {
            let fields = [&signal.symbol, &signal.label, &signal.path, signal.unit].map(plain);
            let score =
                |word: &str| fields.iter().map(|field| match_score(field, word)).max().filter(|score| *score > 0);
            let sum = words.iter().map(|word| score(word)).sum::<Option<u32>>()?;
            Some((sum, signal))
        })
        .collect();
    // Stable sort: signals of equal score keep the order of the table.
    found.sort_by_key(|(score, _)| std::cmp::Reverse(*score));
    found.into_iter().map(|(_, signal)| signal).collect()
}

/// Returns the score of a word in a field, from 0 (no match) to 100.
fn match_score(field: &str, word: &str) -> u32 {
    let parts = || field.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|part| !part.is_empty());
    if field == word {
        return 100;
    }
    if parts().any(|part| part == word) {
        return 80;
    }
    if parts().any(|part| part.starts_with(word)) || field.starts_with(word) {
        return 60;
    }
    if field.contains(word) {
        return 40;
    }
    // Abbreviations that omit letters, but not the first: trq for torque.
    let skips = |part: &str| {
        let mut letters = part.chars();
        part.starts_with(&word[..word.chars().next().map_or(0, char::len_utf8)])
            && word.chars().all(|c| letters.any(|l| l == c))
    };
    if word.chars().count() > 1 && parts().any(skips) { 20 } else { 0 }
}

/// Transliterates text to plain letters in lower case: τ₁ is tau1, q̈ is qddot.
fn plain(text: impl AsRef<str>) -> String {
    let mut plain = String::new();
    for c in text.as_ref().chars().flat_map(char::to_lowercase) {
        match c {
            '₀'..='₉' => plain.push(char::from(b'0' + (c as u32 - '₀' as u32) as u8)),
            '²' => plain.push('2'),
            'τ' => plain.push_str("tau"),
            'θ' => plain.push_str("theta"),
            'ω' => plain.push_str("omega"),
            'δ' => plain.push_str("delta"),
            'λ' => plain.push_str("lambda"),
            '∫' => plain.push_str("integral"),
            '−' => plain.push('-'),
            '\u{307}' => plain.push_str("dot"),
            '\u{308}' => plain.push_str("ddot"),
            // Letters that include their dot: ẋ, ẏ.
            'ẋ' => plain.push_str("xdot"),
            'ẏ' => plain.push_str("ydot"),
            c => plain.push(c),
        }
    }
    plain
}
