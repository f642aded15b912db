//! Search for a name by a few of its letters.

/// Returns the score of a name for a search text; a higher score is better. `None` if a word of the text is not
/// found. The name must contain the letters of each word in order: contiguous, at the beginnings of words, or
/// scattered.
pub fn score(sought: &str, name: &str) -> Option<i32> {
    let name: Vec<char> = name.to_lowercase().chars().collect();
    sought.split_whitespace().map(|word| score_of(&word.to_lowercase(), &name)).sum()
}

/// Like [`score`], but a word may also be found contiguously in `also`, for half the score.
pub fn score_with(sought: &str, name: &str, also: &str) -> Option<i32> {
    let [name, also] = [name, also].map(|text| text.to_lowercase().chars().collect::<Vec<_>>());
    let best = |word: String| {
        let letters: Vec<char> = word.chars().collect();
        score_of(&word, &name).max(whole(&letters, &also).map(|score| score / 2))
    };
    sought.split_whitespace().map(|word| best(word.to_lowercase())).sum()
}

fn score_of(word: &str, name: &[char]) -> Option<i32> {
    let word: Vec<char> = word.chars().collect();
    whole(&word, name).or_else(|| scattered(&word, name, &|i| starts(name, i)))
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
