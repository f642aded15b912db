//! Search for a name by a few of its letters.

/// Returns the score of a name for a search text; a higher score is better. `None` if a word of the text is not
/// found. The name must contain the letters of each word in order: contiguous, at the beginnings of words, or
/// scattered.
pub fn score(sought: &str, name: &str) -> Option<i32> {
    let name = letters(name);
    of_all(sought, |word| anyhow(word, &name))
}

/// Like [`score`], but a word may also be found contiguously in `also`, for half the score.
pub fn score_with(sought: &str, name: &str, also: &str) -> Option<i32> {
    let [name, also] = [name, also].map(letters);
    of_all(sought, |word| anyhow(word, &name).max(whole(word, &also).map(|score| score / 2)))
}

/// Like [`score_with`], but each word must be contiguous: a long text contains almost any scattered letters.
pub fn score_of_prose(sought: &str, heading: &str, text: &str) -> Option<i32> {
    let [heading, text] = [heading, text].map(letters);
    of_all(sought, |word| whole(word, &heading).max(whole(word, &text).map(|score| score / 2)))
}

fn letters(text: &str) -> Vec<char> {
    text.to_lowercase().chars().collect()
}

/// Words of a question that say nothing of what is sought.
const FILLERS: [&str; 14] = ["a", "an", "the", "to", "of", "do", "i", "how", "is", "in", "on", "with", "my", "can"];

/// Returns the sum of the scores of all words of a search text; `None` if a word has none. Fillers do not count beside
/// other words. A word that is not found is sought again without its final s.
fn of_all(sought: &str, score: impl Fn(&[char]) -> Option<i32>) -> Option<i32> {
    let words: Vec<String> = sought.split_whitespace().map(str::to_lowercase).collect();
    let says = |word: &String| !FILLERS.contains(&word.as_str());
    let only_fillers = !words.iter().any(says);
    let one = |word: &String| {
        let singular = || word.strip_suffix('s').filter(|rest| rest.len() > 2).and_then(|rest| score(&letters(rest)));
        score(&letters(word)).or_else(singular)
    };
    words.iter().filter(|word| only_fillers || says(word)).map(one).sum()
}

/// Returns what has a score, best first; of equal scores the first one stays first.
pub fn best_first<T>(all: impl IntoIterator<Item = T>, score: impl Fn(&T) -> Option<i32>, most: usize) -> Vec<T> {
    let mut scored: Vec<(i32, T)> = all.into_iter().filter_map(|one| Some((score(&one)?, one))).collect();
    scored.sort_by_key(|(score, _)| -score);
    scored.into_iter().take(most).map(|(_, one)| one).collect()
}

/// Returns the score of a word that is contiguous or scattered in the name.
fn anyhow(word: &[char], name: &[char]) -> Option<i32> {
    whole(word, name).or_else(|| scattered(word, name, &|i| starts(name, i)))
}

/// Whether a word of the name begins at letter `i`.
fn starts(name: &[char], i: usize) -> bool {
    i == 0 || !name[i - 1].is_alphanumeric()
}

/// Returns the score of a word whose letters are contiguous in the name.
fn whole(word: &[char], name: &[char]) -> Option<i32> {
    let starts = |i: usize| starts(name, i);
    let whole = name.windows(word.len()).enumerate().filter(|(_, part)| **part == *word).map(|(i, _)| i);
    // At one place, a whole word scores more than a beginning, a beginning more than a middle. Later places score less.
    let ends = |i: usize| name.get(i + word.len()).is_none_or(|c| !c.is_alphanumeric());
    let best = whole.map(|i| 60 + 40 * i32::from(starts(i)) + 10 * i32::from(starts(i) && ends(i)) - i.min(30) as i32);
    best.max()
}

/// Returns the score of a word whose letters are found in order. Letters at the beginning of a word, or next to the
/// previous letter, count more.
fn scattered(word: &[char], name: &[char], starts: &dyn Fn(usize) -> bool) -> Option<i32> {
    let (mut score, mut next, mut last) = (0, 0, None);
    for letter in word {
        // The beginning of a later word is preferred to a letter inside this word.
        let from = |at: usize| (at..name.len()).filter(|i| name[*i] == *letter);
        let beside = last.map(|last| last + 1).filter(|i| name.get(*i) == Some(letter));
        let at = beside.or_else(|| from(next).find(|i| starts(*i))).or_else(|| from(next).next())?;
        score += if beside.is_some() || starts(at) { 4 } else { 1 };
        (next, last) = (at + 1, Some(at));
    }
    // A match with too many letters in the middle of words is not significant.
    (score >= 3 * word.len() as i32).then_some(score)
}
