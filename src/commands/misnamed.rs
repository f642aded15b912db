//! [`Misnamed`]: a word of the command line that names nothing, and what it may have been to name.

use std::ffi::OsStr;
use std::io::{Error, ErrorKind};
use std::path::Path;

use stillbase_files::text::{names_in, read};
use stillbase_mechanics::machine::FileError;
use stillbase_session::scenario::{FileContent, ScenarioError, content};
use stillbase_settings::range::shortened;
use stillbase_settings::spelling::{UnknownName, nearest_words};

/// Endings of files that hold a scenario or a machine.
const TOML: &[&str] = &["toml"];

/// A word of the command line that names nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Misnamed {
    /// The word as given.
    pub given: String,
    /// The nearest words that name something of the kind, if any is near.
    pub nearest: Vec<String>,
    /// Whether the word names a file.
    is_file: bool,
}

impl Misnamed {
    /// Returns the word if a machine could not be read because nothing has its name.
    pub fn machine(why: &FileError) -> Option<Self> {
        let of_kind = |text: &str| content(text) == Some(FileContent::Machine);
        match why {
            FileError::UnknownName(unknown) => Some(Self::name(unknown, of_kind)),
            FileError::Unreadable { file, source } => Self::missing(file, source, TOML, of_kind),
            FileError::Wrong { .. } => None,
        }
    }

    /// Returns the word if a scenario could not be read because nothing has its name.
    pub fn scenario(why: &ScenarioError) -> Option<Self> {
        let of_kind = |text: &str| content(text).is_some();
        match why {
            ScenarioError::UnknownName(unknown) => Some(Self::name(unknown, of_kind)),
            ScenarioError::Unreadable { file, source } => Self::missing(Path::new(file), source, TOML, of_kind),
            ScenarioError::MachineFile(why) => Self::machine(why),
            _ => None,
        }
    }

    /// Returns the word if a file of another kind could not be read because there is none.
    pub fn file(file: &Path, why: &Error, endings: &[&str]) -> Option<Self> {
        Self::missing(file, why, endings, |_| true)
    }

    /// Returns a word that is near the names of commands, and is no such name.
    pub fn command(given: &str, commands: &[String]) -> Option<Self> {
        let none = Self { given: given.into(), nearest: Vec::new(), is_file: false };
        Some(none.or_command(commands)).filter(|found| !found.nearest.is_empty())
    }

    /// Returns the word with the nearest command in place of a name, if that is nearer than any name.
    #[must_use]
    pub fn or_command(self, commands: &[String]) -> Self {
        let names = self.nearest.iter().filter(|_| !self.is_file).chain(commands).map(String::as_str);
        let nearest: Vec<String> = nearest_words(&self.given, names).into_iter().map(str::to_owned).collect();
        if nearest.is_empty() { self } else { Self { nearest, is_file: false, ..self } }
    }

    /// Says which file is the nearest, for the end of a message; empty if the word names no file, or none is near.
    pub fn nearest_file(&self) -> String {
        let named: Vec<String> =
            self.nearest.iter().filter(|_| self.is_file).map(|file| shortened(file, 300)).collect();
        if named.is_empty() { String::new() } else { format!("; the nearest file is {}", named.join(" or ")) }
    }

    /// A word that is no name may be the name of a file without its ending.
    fn name(unknown: &UnknownName, of_kind: impl Fn(&str) -> bool) -> Self {
        let given = unknown.name.clone();
        let (nearest, is_file) = match &unknown.nearest[..] {
            [] => (nearest_files(Path::new(&given), TOML, of_kind), true),
            known => (known.iter().map(ToString::to_string).collect(), false),
        };
        Self { given, nearest, is_file }
    }

    fn missing(file: &Path, why: &Error, endings: &[&str], of_kind: impl Fn(&str) -> bool) -> Option<Self> {
        let given = (why.kind() == ErrorKind::NotFound).then(|| file.to_str()).flatten()?;
        Some(Self { given: given.into(), nearest: nearest_files(file, endings, of_kind), is_file: true })
    }
}

/// Returns the files in the folder of a file that come nearest to its name, with one of some endings; none if no name
/// is near, or if no text of theirs is of the kind.
fn nearest_files(file: &Path, endings: &[&str], of_kind: impl Fn(&str) -> bool) -> Vec<String> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let listed = names_in(if folder.as_os_str().is_empty() { Path::new(".") } else { folder });
    let has_ending = |name: &String| {
        let ending = Path::new(name).extension().and_then(OsStr::to_str).unwrap_or_default();
        endings.iter().any(|one| one.eq_ignore_ascii_case(ending))
    };
    let names: Vec<String> = listed.into_iter().filter(has_ending).collect();
    let stem = |name: &Path| name.file_stem().and_then(OsStr::to_str).unwrap_or_default().to_owned();
    let mut stems: Vec<String> = names.iter().map(|name| stem(Path::new(name))).collect();
    stems.dedup();
    let near = stem(file);
    let near = nearest_words(&near, stems.iter().map(String::as_str));
    let found = names.iter().filter(|name| near.contains(&stem(Path::new(name)).as_str()));
    let found = found.map(|name| folder.join(name)).filter(|file| read(file).is_ok_and(|text| of_kind(&text)));
    found.filter_map(|file| Some(file.to_str()?.to_owned())).collect()
}
