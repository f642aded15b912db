//! [`faults_of`]: all faults of a file. Reading stops at the first fault; so each fault is told, mended, and the file is
//! read again. What was made up to mend one fault is never told as another.

use std::borrow::Cow;
use std::ops::Range;

use toml::de::Error;

use super::fault::{Fault, Faults};
use super::key_path::{KeyPath, KeyStep};
use super::range::{MAX_SAID, quote_clipped, shortened};
use super::spelling::{nearest_keys, nearest_words};
use super::stated::{MendValue, StatedFile, TextPlace};

/// Maximum number of times that a file is read, and of bytes that are read in all: more faults are not counted.
const MAX_ROUNDS: usize = 200;
const MAX_READ_BYTES: usize = 20_000_000;
/// Maximum number of times that one place is mended.
const MAX_MENDED: usize = 3 * MAX_ROUNDS / 4;

/// What is wrong in a file, as its reader finds it.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// The place.
    pub path: KeyPath,
    /// What is wrong there.
    pub wrong: Wrong,
}

/// What is wrong at a place.
#[derive(Clone, Debug, PartialEq)]
pub enum Wrong {
    /// The table at the place lacks a key.
    Missing(String),
    /// The place is a key that its table does not have; the keys that it has.
    UnknownKey(Vec<String>),
    /// The value is wrong, in words that follow the name of the key.
    Value(String),
    /// The value, by which its table has other keys, is wrong or missing, in words that follow the name of the key.
    /// Without it nothing else of the table can be judged.
    Kind(String),
    /// The value cannot be kept for what it leads to, in words that follow the name of the key and say what would do; no
    /// value is right in general.
    Refused(String),
    /// The value is wrong, in a whole sentence.
    Said(String),
    /// The value is a name that nothing has: a whole sentence, and the names that would be right.
    Name(String, Vec<String>),
    /// Something follows from other numbers and names that is wrong: a whole sentence. It is not told once something
    /// was made up. An example follows, empty for the usual one.
    Follows(String, String),
    /// The value is wrong, in a whole sentence, and nothing behind it can be judged before it is right.
    Last(String),
    /// The whole file is wrong: a whole sentence, and an example.
    Whole(String, String),
}

/// What a reader knows of the keys of its files.
pub trait Vocabulary {
    /// Returns the plain name of what is at a place.
    fn name(&self, path: &KeyPath) -> Option<String>;
    /// Returns what would be right at a place, in words that follow "want".
    fn want(&self, path: &KeyPath) -> Option<String>;
    /// Returns a value that would be right at a place, in TOML.
    fn example(&self, path: &KeyPath) -> Option<&'static str>;
    /// Returns the key that people mean by a word that is no key, and what to say of it.
    fn meant(&self, path: &KeyPath) -> Option<Meant>;
    /// Returns an example with names that the file has in the place of made-up ones.
    fn with_own_names(&self, example: String, _file: &StatedFile) -> String {
        example
    }
}

/// What people mean by a word that is no key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meant {
    /// Another key.
    Key(&'static str),
    /// Something that other keys say: a sentence, and lines that may stand in the file instead.
    Else(&'static str, &'static str),
}

impl Problem {
    /// Makes the problem that a reader of TOML has found in a file.
    pub fn of(file: &StatedFile, error: &Error) -> Self {
        Self::said(error.span().map_or_else(KeyPath::default, |span| file.path(&span)), error.message())
    }

    /// Makes the problem of which a reader of TOML says this at a place.
    pub fn said(path: KeyPath, message: &str) -> Self {
        let whole = message;
        let message = shortened(whole, MAX_SAID);
        let mut quoted = whole.split('`').skip(1).step_by(2);
        let wrong = match whole {
            said if said.starts_with("missing field") => match quoted.next() {
                Some(key) => Wrong::Missing(key.into()),
                None => Wrong::Value(message),
            },
            said if said.starts_with("unknown field") => {
                let key = quoted.next().unwrap_or_default();
                let known = quoted.map(Into::into).collect();
                // Some readers place the error at the table.
                let path = if path.last_key() == Some(key) { path } else { path.key(key) };
                return Self { path, wrong: Wrong::UnknownKey(known) };
            }
            said => Wrong::Value(value_in_words(said).unwrap_or(message)),
        };
        Self { path, wrong }
    }

    /// Returns the problem of a table that is the value of `key`.
    #[must_use]
    pub fn under(self, key: &str) -> Self {
        Self { path: self.path.under(key), ..self }
    }

    /// Returns the problem of an entry, counted from 0, of the list that is the value of `key`.
    #[must_use]
    pub fn in_list(self, key: &str, entry: usize) -> Self {
        Self { path: KeyPath(KeyPath::new(&[&key, &entry]).0.into_iter().chain(self.path.0).collect()), ..self }
    }

    /// Returns what is wrong in words, with names and with what would be right.
    pub fn text(&self, words: &dyn Vocabulary) -> String {
        let want = |path: &KeyPath| words.want(path).map(|want| format!(": want {want}")).unwrap_or_default();
        match &self.wrong {
            Wrong::Missing(key) => {
                let path = self.path.key(key);
                format!("{} is missing{}", called(&path, words), want(&path))
            }
            Wrong::UnknownKey(known) => self.unknown_key(known, words),
            Wrong::Value(said) | Wrong::Kind(said) | Wrong::Refused(said) => {
                let own = want(&self.path);
                // A reader of TOML knows the type alone; the words of the key go on from there.
                let said = said
                    .find(": want ")
                    .filter(|at| own.starts_with(&said[*at..]))
                    .map_or(said.as_str(), |at| &said[..at]);
                let want = if said.contains("want ") { String::new() } else { own };
                let verb = if ["is ", "has ", "names "].iter().any(|verb| said.starts_with(verb)) { " " } else { ": " };
                match self.path.0.is_empty() {
                    true => said.to_owned(),
                    false => format!("{}{verb}{said}{want}", called(&self.path, words)),
                }
            }
            Wrong::Said(said)
            | Wrong::Name(said, _)
            | Wrong::Follows(said, _)
            | Wrong::Last(said)
            | Wrong::Whole(said, _) => said.clone(),
        }
    }

    fn unknown_key(&self, known: &[String], words: &dyn Vocabulary) -> String {
        let key = quote_clipped(self.path.last_key().unwrap_or_default());
        let table = self.path.parent().unwrap_or_default();
        let owner = match table.0.is_empty() {
            true => "the file".to_owned(),
            false => words.name(&table).unwrap_or_else(|| table.to_string()),
        };
        let all = || shortened(&known.join(", "), MAX_SAID);
        let advice = match (words.meant(&self.path), &self.nearest(known)[..]) {
            (Some(Meant::Else(said, _)), _) => said.to_owned(),
            (Some(Meant::Key(meant)), _) => format!("want {}", called(&table.key(meant), words)),
            (None, []) => format!("want one of {}", all()),
            (None, nearest) => {
                let nearest = nearest.iter().map(|key| format!("{key} (nearest)")).collect::<Vec<_>>().join(" or ");
                format!("want {nearest}, or one of {}", all())
            }
        };
        format!("{owner} has no key {key:?}: {advice}")
    }

    fn nearest(&self, known: &[String]) -> Vec<String> {
        let key = self.path.last_key().unwrap_or_default();
        nearest_keys(key, known.iter().map(String::as_str)).into_iter().map(Into::into).collect()
    }

    /// Returns the key that an unknown key was to be, if there is one candidate.
    fn meant(&self, known: &[String], words: &dyn Vocabulary) -> Option<String> {
        match (words.meant(&self.path), &self.nearest(known)[..]) {
            (Some(Meant::Key(meant)), _) => Some(meant.into()),
            (None, [only]) => Some(only.clone()),
            _ => None,
        }
    }
}

/// Returns the plain name of a key with the key: `mass of link 2 (link.2.mass)`.
pub fn called(path: &KeyPath, words: &dyn Vocabulary) -> String {
    words.name(path).map_or_else(|| path.to_string(), |name| with_key(&name, &path.to_string()))
}

/// Returns a plain name with its key: `mass of link 2 (link.2.mass)`; the name alone if it is the key.
pub fn with_key(name: &str, key: &str) -> String {
    // The ends of limits stand in parentheses.
    let key = key.trim_end_matches(')').replace(" (", ", ");
    // A list and its entry are called alike: `bookmark 2` and `bookmark[2]`.
    if name == key || name == key.replace('[', " ").replace(']', "") {
        name.to_owned()
    } else {
        format!("{name} ({key})")
    }
}

/// Returns the message of the TOML reader on a value in plain words: what the value is.
fn value_in_words(said: &str) -> Option<String> {
    if said.starts_with("unknown variant") {
        let mut quoted = said.split('`').skip(1).step_by(2);
        let (given, known) = (quoted.next()?, quoted.collect::<Vec<_>>());
        let nearest = nearest_words(given, known.iter().copied());
        let nearest = nearest.first().map(|word| format!("{word:?} (nearest), or ")).unwrap_or_default();
        return Some(format!("is {:?}: want {nearest}one of {}", quote_clipped(given), known.join(", ")));
    }
    let rest = ["invalid type: ", "invalid value: "].iter().find_map(|begin| said.strip_prefix(begin));
    let Some(rest) = rest else {
        let count = said.strip_prefix("invalid length ")?.split(',').next()?.trim();
        return Some(format!("has {} instead of {}", values(count), said.rsplit("length ").next()?));
    };
    let (is, want) = rest.rsplit_once(", expected ").unwrap_or((rest, ""));
    let is = is.replace('`', "");
    let is = [("string ", "the text "), ("integer ", "the number "), ("floating point ", "the number ")]
        .iter()
        .find_map(|(begin, words)| Some(format!("{words}{}", is.strip_prefix(begin)?)))
        .unwrap_or(is);
    let is = match is.as_str() {
        "map" => "a table".to_owned(),
        "sequence" => "a list".to_owned(),
        "the number NaN" | "the number -NaN" => "not a number".to_owned(),
        other => shortened(other, 120),
    };
    let want = match want {
        "f64" => ": want a number",
        "a string" => ": want a text in quotes",
        "a boolean" => ": want true or false",
        "a sequence" => ": want a list",
        "i8" | "u32" | "u64" | "usize" => ": want a whole number",
        want if want == "a map" || want.starts_with("struct ") => ": want a table",
        _ => "",
    };
    let length = rest.rsplit_once("expected an array of length ").map(|(_, length)| length);
    match want {
        "" if let Some(length) = length => Some(format!("is {is}: want a list of {length}")),
        "" => Some(format!("is {is}: want {}", rest.rsplit_once(", expected ")?.1)),
        want => Some(format!("is {is}{want}")),
    }
}

fn values(count: &str) -> String {
    super::number::counted(count, "value")
}

/// Returns the faults of a text. `read` reads it as far as it goes; it is asked again with each fault mended.
pub fn faults_of(text: &str, words: &dyn Vocabulary, read: &dyn Fn(&StatedFile) -> Result<(), Problem>) -> Faults {
    match StatedFile::parse(text) {
        Ok(file) => Mending { stated: file.clone(), file, words, made_up: Vec::new(), found: Vec::new() }.faults(read),
        Err(errors) => {
            let is_far_too_long = errors.len() > MAX_ROUNDS;
            Faults::of(errors.iter().take(MAX_ROUNDS).map(|error| syntax(text, error)).collect(), is_far_too_long)
        }
    }
}

/// Returns the fault of a text that is not TOML.
fn syntax(text: &str, error: &Error) -> Fault {
    let place = error.span().map(|span| TextPlace::of(text, span.start));
    Fault {
        line: place.map(|place| place.line),
        column: place.map(|place| place.column),
        key: String::new(),
        text: format!("this is not TOML: {}", shortened(error.message(), MAX_SAID)),
        example: String::new(),
    }
}

/// A file whose faults are told and mended one by one.
struct Mending<'a> {
    /// The file as stated, and as mended so far.
    stated: StatedFile<'a>,
    file: StatedFile<'a>,
    words: &'a dyn Vocabulary,
    /// Spans at which something was made up or left out, each with its path.
    made_up: Vec<(Option<Range<usize>>, KeyPath)>,
    found: Vec<Fault>,
}

impl Mending<'_> {
    fn faults(mut self, read: &dyn Fn(&StatedFile) -> Result<(), Problem>) -> Faults {
        let rounds = (MAX_READ_BYTES / self.file.text().len().max(1)).clamp(1, MAX_ROUNDS);
        let mut before = None;
        for _ in 0..rounds {
            let Err(problem) = read(&self.file) else { return Faults::of(self.found, false) };
            let problem = Problem { path: problem.path.by_position(), ..problem };
            // What no mending changes ends the search, and what follows from made up numbers does not count.
            let follows = matches!(problem.wrong, Wrong::Follows(..)) && !self.made_up.is_empty();
            let here = Some((problem.clone(), self.file.span(&problem.path)));
            if before == here || follows {
                return Faults::of(self.found, false);
            }
            if !self.is_made_up(&problem) {
                self.found.push(self.fault(&problem));
            }
            if !self.mend(&problem) {
                return Faults::of(self.found, false);
            }
            before = here;
        }
        Faults::of(self.found, true)
    }

    /// Returns the place of the key that a problem is about.
    fn key(problem: &Problem) -> KeyPath {
        match &problem.wrong {
            Wrong::Missing(key) => problem.path.key(key),
            _ => problem.path.clone(),
        }
    }

    /// Returns whether a problem is about something that was made up or left out.
    fn is_made_up(&self, problem: &Problem) -> bool {
        let key = Self::key(problem);
        let span = key.parent().and_then(|table| self.file.span(&table));
        self.made_up.iter().any(|(at, path)| match key.0.strip_prefix(&path.0[..]) {
            Some([]) => *at == span,
            // What stands within something that was made up was made up, too.
            Some(_) => self.file.at(path).is_some(),
            // What is said of an entry of a list may follow from what was made up in it.
            None => matches!(key.0.last(), Some(KeyStep::At(_))) && path.0.starts_with(&key.0),
        })
    }

    /// Returns the fault of a problem, with its place in the file as stated.
    fn fault(&self, problem: &Problem) -> Fault {
        // Elements of lists that were left out have changed the positions of others.
        let found = |path: &KeyPath| {
            let span = self.file.span(path).filter(|_| self.file.at(path).is_some());
            let found = span.map(|span| self.stated.path(&span)).filter(|found| found.0.len() == path.0.len())?;
            // A table that was renamed is called as it was meant.
            let steps = path.0.iter().zip(found.0).map(|(own, found)| match own {
                KeyStep::Key(_) => own.clone(),
                _ => found,
            });
            Some(KeyPath(steps.collect()))
        };
        let stated = |path: &KeyPath| {
            // A key that is missing belongs to a table that is there.
            let in_table = || Some(found(&path.parent()?)?.key(path.last_key()?));
            self.stated.named(&found(path).or_else(in_table).unwrap_or_else(|| path.clone()))
        };
        let said = Problem { path: stated(&problem.path), wrong: problem.wrong.clone() };
        let place = match problem.wrong {
            Wrong::Missing(_) => self.file.place(&problem.path),
            _ => self.file.key_place(&problem.path).or_else(|| self.file.place(&problem.path)),
        };
        Fault {
            line: place.map(|place| place.line),
            column: place.map(|place| place.column),
            key: Self::key(&said).to_string(),
            text: said.text(self.words),
            example: self.words.with_own_names(self.example(problem), &self.stated),
        }
    }

    /// Returns lines that may stand in the file instead of what is wrong.
    fn example(&self, problem: &Problem) -> String {
        let words = self.words;
        let line = |path: &KeyPath, value: &str| match (path.last_key(), &path.0[..]) {
            (Some(key), [_]) => in_a_table(key, value),
            (Some(key), _) => format!("{} = {value}", bare(key)),
            (None, _) => String::new(),
        };
        let usual = |path: &KeyPath| words.example(path).map(|value| line(path, value)).unwrap_or_default();
        match &problem.wrong {
            Wrong::Whole(_, example) => example.clone(),
            Wrong::Follows(_, example) if !example.is_empty() => example.clone(),
            Wrong::Refused(_) => String::new(),
            Wrong::Name(_, known) => {
                let given = self.file.at(&problem.path).and_then(|value| value.as_str()).unwrap_or_default();
                let nearest = nearest_words(given, known.iter().map(String::as_str));
                let name = nearest.first().copied().or(known.first().map(String::as_str));
                name.map_or_else(|| usual(&problem.path), |name| line(&problem.path, &format!("{name:?}")))
            }
            Wrong::UnknownKey(known) => match problem.meant(known, words) {
                Some(meant) => {
                    let span = self.file.span(&problem.path).unwrap_or(0..0);
                    let value = self.file.text().get(span).filter(|value| !value.contains('\n') && value.len() < 80);
                    let path = problem.path.parent().unwrap_or_default().key(&meant);
                    let is_table = self.file.at(&problem.path).is_some_and(|value| value.is_table());
                    if is_table && value.is_none_or(|value| !value.starts_with('{')) {
                        return header(&path);
                    }
                    match value.filter(|value| !value.starts_with('[') || path.0.len() > 1) {
                        Some(value) => line(&path, value),
                        None => usual(&path),
                    }
                }
                None => match words.meant(&problem.path) {
                    Some(Meant::Else(_, example)) => example.to_owned(),
                    _ => String::new(),
                },
            },
            _ => usual(&self.whole_value(&Self::key(problem))),
        }
    }

    /// Returns the place of the value to which a place belongs: a number of a list belongs to the list.
    fn whole_value(&self, path: &KeyPath) -> KeyPath {
        let mut path = path.clone();
        let is_own = |one: &toml::de::DeValue| one.is_table() || one.is_str();
        while matches!(path.0.last(), Some(KeyStep::At(_))) && !self.file.at(&path).is_some_and(is_own) {
            path.0.pop();
        }
        path
    }

    /// Mends a problem; returns whether something has changed.
    fn mend(&mut self, problem: &Problem) -> bool {
        let key = self.whole_value(&Self::key(problem));
        let words = self.words;
        if self.made_up.iter().filter(|(_, path)| *path == key).count() > MAX_MENDED {
            return false;
        }
        match &problem.wrong {
            Wrong::Whole(..) | Wrong::Follows(..) | Wrong::Last(_) => false,
            Wrong::Missing(_) => self.make_up(&key),
            Wrong::UnknownKey(known) => match problem.meant(known, words) {
                Some(meant) if self.file.rename(&key, &meant) => {
                    let key = key.parent().unwrap_or_default().key(&meant);
                    // Whether its value is right there is another matter; that a table has keys is what was meant.
                    if !self.file.at(&key).is_some_and(|value| value.is_table()) {
                        self.mark(&key);
                    }
                    true
                }
                _ => self.file.remove(&key),
            },
            Wrong::Name(_, known) => match known.first() {
                Some(name) => {
                    self.mark(&key);
                    self.file.set(&key, &MendValue::Word(name.clone()))
                }
                None => self.leave_out(&key),
            },
            Wrong::Value(_) | Wrong::Refused(_) | Wrong::Said(_) => self.leave_out(&key),
            Wrong::Kind(_) => match (key.parent(), self.words.example(&key)) {
                (Some(table), Some(example)) => {
                    self.mark(&table);
                    self.file.set(&key, &MendValue::Toml(example))
                }
                (Some(table), None) => self.file.remove(&table),
                (None, _) => false,
            },
        }
    }

    /// Notes that something was made up or left out at a place.
    fn mark(&mut self, key: &KeyPath) {
        let span = key.parent().and_then(|table| self.file.span(&table));
        self.made_up.push((span, key.clone()));
    }

    /// Sets a key to its example.
    fn make_up(&mut self, key: &KeyPath) -> bool {
        let Some(example) = self.words.example(key) else { return false };
        self.mark(key);
        self.file.set(key, &MendValue::Toml(example))
    }

    /// Leaves a key out, so that its default applies; if it has none, it is made up when it is missed.
    fn leave_out(&mut self, key: &KeyPath) -> bool {
        self.mark(key);
        self.file.remove(key)
    }
}

/// Returns a key as TOML wants it: in quotes unless it is one plain word.
pub fn bare(key: &str) -> Cow<'_, str> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-');
    if !key.is_empty() && key.chars().all(is_plain) { key.into() } else { format!("{key:?}").into() }
}

/// Returns the header of a table.
fn header(path: &KeyPath) -> String {
    let word = |step: &KeyStep| match step {
        KeyStep::Key(key) | KeyStep::Named(_, key) => Some(bare(key).into_owned()),
        KeyStep::At(_) => None,
    };
    format!("[{}]", path.0.iter().filter_map(word).collect::<Vec<_>>().join("."))
}

/// Returns a key of the file with its value, tables under their headers.
fn in_a_table(key: &str, value: &str) -> String {
    let whole: Result<toml::Table, _> = format!("{key} = {value}").parse();
    let is_of_tables = whole.as_ref().is_ok_and(|whole| {
        whole.values().all(|value| {
            let is_list =
                value.as_array().is_some_and(|list| !list.is_empty() && list.iter().all(toml::Value::is_table));
            value.is_table() || is_list
        })
    });
    match whole {
        Ok(whole) if is_of_tables => toml::to_string(&whole).unwrap_or_default().trim_end().to_owned(),
        _ => format!("{key} = {value}"),
    }
}
