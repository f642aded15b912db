//! Names that nothing has, and those that come nearest.

use std::fmt;

use super::range::shortened;

/// Number of equally near names that are told; of more, none is meant more than another.
const MAX_NEAREST: usize = 3;

/// Number of letters from which on a word counts as the beginning of another.
const MIN_BEGINNING: usize = 3;

/// A name that nothing has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownName {
    /// The name as given.
    pub name: String,
    /// What it was to name: `machine`.
    pub what: &'static str,
    /// The names that exist, for the message.
    pub known: Vec<&'static str>,
    /// The names that come nearest, if any is near.
    pub nearest: Vec<&'static str>,
}

impl UnknownName {
    /// Returns the error for a name; the nearest names are sought in `known` and in `others`.
    pub fn new(name: &str, what: &'static str, known: Vec<&'static str>, others: &[&'static str]) -> Self {
        let nearest = nearest_words(name, known.iter().chain(others).copied());
        Self { name: name.into(), what, known, nearest }
    }
}

impl fmt::Display for UnknownName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: no such {}: want ", shortened(&self.name, 300), self.what)?;
        for nearest in &self.nearest {
            write!(f, "{nearest} (nearest), ")?;
        }
        let others: Vec<&str> = self.known.iter().filter(|known| !self.nearest.contains(known)).copied().collect();
        write!(f, "{}, or a TOML file", others.join(", "))
    }
}

impl std::error::Error for UnknownName {}

/// Returns the words that come nearest to a word, in their order, without regard to capitals; none if no word is near,
/// or if too many are equally near. A word that begins with the given one is near before all others; another one is near if
/// at most half of the given letters are wrong.
#[doc(hidden)]
pub fn nearest_words<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let word = word.to_lowercase();
    let letters = word.chars().count();
    let (mut nearest, mut apart) = (Vec::new(), letters / 2);
    let known: Vec<&str> = known.into_iter().collect();
    let mut begun: Vec<&str> = Vec::new();
    for one in &known {
        if one.to_lowercase().starts_with(&word) && !begun.contains(one) {
            begun.push(one);
        }
    }
    if letters >= MIN_BEGINNING && (1..=MAX_NEAREST).contains(&begun.len()) {
        return begun;
    }
    for one in known {
        match letters_apart(&one.to_lowercase(), &word) {
            off if off < apart || (off == apart && nearest.is_empty()) => (nearest, apart) = (vec![one], off),
            off if off == apart && !nearest.contains(&one) => nearest.push(one),
            _ => {}
        }
    }
    if nearest.len() > MAX_NEAREST { Vec::new() } else { nearest }
}

/// Returns the keys that come nearest to a word that is none: those of which few letters are wrong.
#[doc(hidden)]
pub fn nearest_keys<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    let letters = word.chars().count();
    let is_near = |key: &&str| 5 * letters_apart(&key.to_lowercase(), &word.to_lowercase()) <= 2 * (letters + 1);
    nearest_words(word, known).into_iter().filter(is_near).collect()
}

/// Number of letters that are compared; the effort grows with its square.
const MAX_LETTERS: usize = 100;

/// Returns the number of letters to insert, delete or replace that turns one word into another. Of long words only the
/// beginnings are compared.
fn letters_apart(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().take(MAX_LETTERS).collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, a) in a.chars().take(MAX_LETTERS).enumerate() {
        let mut before = std::mem::replace(&mut row[0], i + 1);
        for (j, b) in b.iter().enumerate() {
            let best = (before + usize::from(a != *b)).min(row[j] + 1).min(row[j + 1] + 1);
            before = std::mem::replace(&mut row[j + 1], best);
        }
    }
    row[b.len()]
}
