//! [`StatedFile`]: what a TOML file states, each part with its place in the text. Parts can be mended, so that reading
//! goes on behind a fault; the others keep their places.

use std::borrow::Cow;
use std::ops::Range;

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue, Deserializer, Error};

use super::key_path::{KeyPath, KeyStep};

/// What a TOML file states.
#[derive(Clone, Debug)]
pub struct StatedFile<'a> {
    text: &'a str,
    table: Spanned<DeTable<'a>>,
}

/// A value that is put in the place of a wrong or missing one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MendValue {
    /// A value in TOML.
    Toml(&'static str),
    /// A word.
    Word(String),
}

/// Line and column of a place in a text, counted from 1; columns are characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextPlace {
    /// Line.
    pub line: usize,
    /// Column.
    pub column: usize,
}

impl TextPlace {
    /// Returns the place of a byte offset.
    pub fn of(text: &str, byte: usize) -> Self {
        let before = &text.as_bytes()[..byte.min(text.len())];
        let begin = before.iter().rposition(|b| *b == b'\n').map_or(0, |i| i + 1);
        // Bytes that go on with a character do not count.
        let column = before[begin..].iter().filter(|b| **b & 0xC0 != 0x80).count() + 1;
        Self { line: before.iter().filter(|b| **b == b'\n').count() + 1, column }
    }
}

impl<'a> StatedFile<'a> {
    /// Reads a text.
    ///
    /// # Errors
    /// All places where the text is not TOML.
    pub fn parse(text: &'a str) -> Result<Self, Vec<Error>> {
        let (table, errors) = DeTable::parse_recoverable(text);
        if errors.is_empty() { Ok(Self { text, table }) } else { Err(errors) }
    }

    /// Returns the text as given.
    pub fn text(&self) -> &'a str {
        self.text
    }

    /// Converts it to a value.
    ///
    /// # Errors
    /// The first thing that is wrong or missing.
    pub fn read<T: DeserializeOwned>(&self) -> Result<T, Error> {
        T::deserialize(Deserializer::from(self.table.clone()))
    }

    /// Returns the table of a key of the file as a file of its own; `None` if the key holds no table.
    pub fn inner(&self, key: &str) -> Option<Self> {
        let inner = self.table.get_ref().get(key)?;
        let table = inner.get_ref().as_table()?.clone();
        Some(Self { text: self.text, table: Spanned::new(inner.span(), table) })
    }

    /// Returns the keys of the file.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.table.get_ref().keys().map(|key| key.get_ref().as_ref())
    }

    /// Returns a file of the same text that states nothing.
    #[must_use]
    pub fn emptied(&self) -> Self {
        Self { text: self.text, table: Spanned::new(0..0, DeTable::new()) }
    }

    /// Has a key of this file state what another file states at a place, if it states something there.
    pub fn copy(&mut self, key: &str, from: &Self, path: &KeyPath) {
        if let Some(found) = from.spanned(path) {
            let key = Spanned::new(found.span(), Cow::Owned(key.to_owned()));
            self.table.get_mut().insert(key, found.clone());
        }
    }

    /// Returns the value at a place; `None` if nothing is there.
    pub fn at(&self, path: &KeyPath) -> Option<&DeValue<'a>> {
        self.spanned(path).map(Spanned::get_ref)
    }

    fn spanned(&self, path: &KeyPath) -> Option<&Spanned<DeValue<'a>>> {
        let mut at: Option<&Spanned<DeValue>> = None;
        for step in &path.0 {
            at = Some(next(self.table.get_ref(), at.map(Spanned::get_ref), step)?);
        }
        at
    }

    /// Returns the names of the elements of a list of tables.
    pub fn names(&self, list: &str) -> Vec<&str> {
        let all = self.table.get_ref().get(list).and_then(|list| list.get_ref().as_array());
        let all = all.into_iter().flat_map(|all| all.iter());
        all.filter_map(|one| one.get_ref().get("name")?.get_ref().as_str()).collect()
    }

    /// Returns the place with elements of lists by their names, as far as these are unique.
    #[must_use]
    pub fn named(&self, path: &KeyPath) -> KeyPath {
        let mut path = path.clone();
        if let [KeyStep::Key(list), step, ..] = &mut path.0[..]
            && let KeyStep::At(i) = *step
        {
            let names = self.names(list);
            let own = KeyPath(vec![KeyStep::Key(list.clone()), KeyStep::At(i), KeyStep::Key("name".into())]);
            let own = self.at(&own).and_then(DeValue::as_str);
            if let Some(own) = own.filter(|own| names.iter().filter(|name| *name == own).count() == 1) {
                *step = KeyStep::Named(i, own.to_owned());
            }
        }
        path
    }

    /// Returns the span of the innermost part of a path that exists; `None` if not even its first step does.
    pub fn span(&self, path: &KeyPath) -> Option<Range<usize>> {
        let mut span = None;
        let mut at: Option<&DeValue> = None;
        for step in &path.0 {
            let Some(found) = next(self.table.get_ref(), at, step) else { break };
            (span, at) = (Some(found.span()), Some(found.get_ref()));
        }
        span
    }

    /// Returns where the key is that is the last step of a path, if it stands in the file.
    pub fn key_place(&self, path: &KeyPath) -> Option<TextPlace> {
        let key = path.last_key()?;
        let outer = path.parent()?;
        let table = match outer.0.is_empty() {
            true => self.table.get_ref(),
            false => self.at(&outer)?.as_table()?,
        };
        Some(TextPlace::of(self.text, table.get_key_value(key)?.0.span().start))
    }

    /// Returns where the innermost part of a path is that exists; `None` if not even its first step does.
    pub fn place(&self, path: &KeyPath) -> Option<TextPlace> {
        self.span(path).map(|span| TextPlace::of(self.text, span.start))
    }

    /// Returns the path of the outermost key or value at a span of the text; the whole file if there is none.
    pub fn path(&self, span: &Range<usize>) -> KeyPath {
        let mut path = Vec::new();
        path_in_table(self.table.get_ref(), span, &mut path);
        KeyPath(path)
    }

    /// Removes what is at a place: a key, or an element of a list. Returns whether there was something.
    pub fn remove(&mut self, path: &KeyPath) -> bool {
        let Some((last, outer)) = path.0.split_last() else { return false };
        match (last, self.outer(outer)) {
            (KeyStep::Key(key), Some(Outer::Table(table, _))) => table.remove(key.as_str()).is_some(),
            (KeyStep::At(i) | KeyStep::Named(i, _), Some(Outer::List(list))) if *i < list.len() => {
                let mut kept = DeArray::new();
                let rest = list.iter().enumerate().filter(|(k, _)| k != i).map(|(_, one)| one.clone());
                rest.for_each(|one| kept.push(one));
                *list = kept;
                true
            }
            _ => false,
        }
    }

    /// Gives a key of a table another name, if no key has that name. The keys of a table join those of a table that has
    /// the name, if none is there twice. Returns whether it did.
    pub fn rename(&mut self, path: &KeyPath, name: &str) -> bool {
        let Some((KeyStep::Key(key), outer)) = path.0.split_last() else { return false };
        let Some(Outer::Table(table, _)) = self.outer(outer) else { return false };
        let joins = match (table.get(name).map(Spanned::get_ref), table.get(key.as_str()).map(Spanned::get_ref)) {
            (None, _) => false,
            (Some(DeValue::Table(there)), Some(DeValue::Table(own))) => {
                if own.keys().any(|key| there.contains_key(key.get_ref().as_ref())) {
                    return false;
                }
                true
            }
            (Some(_), _) => return false,
        };
        let Some((key, value)) = table.remove_entry(key.as_str()) else { return false };
        match (value.into_inner(), table.get_mut(name).filter(|_| joins).map(Spanned::get_mut)) {
            (DeValue::Table(own), Some(DeValue::Table(there))) => there.extend(own),
            (value, _) => {
                let span = key.span();
                table.insert(Spanned::new(span.clone(), Cow::Owned(name.to_owned())), Spanned::new(span, value));
            }
        }
        true
    }

    /// Sets a key to a value; the value has the place of the old one, or else that of its table. Returns whether there
    /// is such a table.
    pub fn set(&mut self, path: &KeyPath, value: &MendValue) -> bool {
        let Some((KeyStep::Key(key), outer)) = path.0.split_last() else { return false };
        let Some(Outer::Table(table, span)) = self.outer(outer) else { return false };
        let span = table.get(key.as_str()).map_or(span, Spanned::span);
        let mut value = match value {
            MendValue::Toml(text) => match DeValue::parse(text) {
                Ok(value) => value.into_inner(),
                Err(_) => return false,
            },
            MendValue::Word(word) => DeValue::String(Cow::Owned(word.clone())),
        };
        place_at(&mut value, &span);
        table.insert(Spanned::new(span.clone(), Cow::Owned(key.clone())), Spanned::new(span, value));
        true
    }

    /// Returns the table or list at a path.
    fn outer(&mut self, path: &[KeyStep]) -> Option<Outer<'_, 'a>> {
        let span = self.table.span();
        let mut at = Outer::Table(self.table.get_mut(), span);
        for step in path {
            let next = match (step, at) {
                (KeyStep::Key(key), Outer::Table(table, _)) => table.get_mut(key.as_str())?,
                (KeyStep::At(i) | KeyStep::Named(i, _), Outer::List(list)) => list.get_mut(*i)?,
                _ => return None,
            };
            let span = next.span();
            at = match next.get_mut() {
                DeValue::Table(table) => Outer::Table(table, span),
                DeValue::Array(list) => Outer::List(list),
                _ => return None,
            };
        }
        Some(at)
    }
}

/// A table with its span, or a list.
enum Outer<'t, 'a> {
    Table(&'t mut DeTable<'a>, Range<usize>),
    List(&'t mut DeArray<'a>),
}

/// Returns what a step leads to, from a value, or from the whole file.
fn next<'t, 'a>(
    file: &'t DeTable<'a>,
    at: Option<&'t DeValue<'a>>,
    step: &KeyStep,
) -> Option<&'t Spanned<DeValue<'a>>> {
    match (step, at) {
        (KeyStep::Key(key), None) => file.get(key.as_str()),
        (KeyStep::Key(key), Some(DeValue::Table(table))) => table.get(key.as_str()),
        (KeyStep::At(i) | KeyStep::Named(i, _), Some(DeValue::Array(list))) => list.get(*i),
        _ => None,
    }
}

fn path_in_table(table: &DeTable, span: &Range<usize>, path: &mut Vec<KeyStep>) -> bool {
    table.iter().any(|(key, value)| {
        path.push(KeyStep::Key(key.get_ref().to_string()));
        let found = key.span() == *span || path_in(value, span, path);
        if !found {
            path.pop();
        }
        found
    })
}

fn path_in(value: &Spanned<DeValue>, span: &Range<usize>, path: &mut Vec<KeyStep>) -> bool {
    // A list of tables has the place of its first table, which is meant.
    let of_tables =
        value.get_ref().as_array().filter(|list| !list.is_empty() && list.iter().all(|one| one.get_ref().is_table()));
    if let Some(list) = of_tables {
        return path_in_list(list, span, path);
    }
    value.span() == *span
        || match value.get_ref() {
            DeValue::Table(table) => path_in_table(table, span, path),
            DeValue::Array(list) => path_in_list(list, span, path),
            _ => false,
        }
}

fn path_in_list(list: &DeArray, span: &Range<usize>, path: &mut Vec<KeyStep>) -> bool {
    list.iter().enumerate().any(|(i, one)| {
        path.push(KeyStep::At(i));
        let found = path_in(one, span, path);
        if !found {
            path.pop();
        }
        found
    })
}

/// Gives all parts of a value the same place.
fn place_at(value: &mut DeValue, span: &Range<usize>) {
    match value {
        DeValue::Table(table) => {
            let all: Vec<_> = std::mem::take(table).into_iter().collect();
            for (key, inner) in all {
                let mut inner = inner.into_inner();
                place_at(&mut inner, span);
                table.insert(Spanned::new(span.clone(), key.into_inner()), Spanned::new(span.clone(), inner));
            }
        }
        DeValue::Array(list) => {
            for one in list.iter_mut() {
                let mut inner = std::mem::replace(one.get_mut(), DeValue::Boolean(false));
                place_at(&mut inner, span);
                *one = Spanned::new(span.clone(), inner);
            }
        }
        _ => {}
    }
}
