//! [`Fault`]: something that is wrong in a file, with its place and an example; [`Faults`]: all of a file.

use schemars::JsonSchema;
use serde::Serialize;

use super::number::counted;

/// Maximum number of faults that are told one by one.
pub const MAX_FAULTS: usize = 20;

/// Something that is wrong in a file.
#[derive(Clone, Debug, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Fault {
    /// Line, counted from 1; `None` for a fault of the whole file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<usize>,
    /// Column, characters counted from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<usize>,
    /// The key, in the syntax of `--set`; empty for a fault of the whole file.
    pub key: String,
    /// What is wrong, and what would be right.
    pub text: String,
    /// Lines that may stand there instead; empty if there is no general example.
    pub example: String,
}

/// The faults of a file, by lines.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// The first faults.
    pub list: Vec<Fault>,
    /// Number of further faults.
    pub more: usize,
    /// Whether the file may have still more faults, which nobody has counted.
    pub is_cut: bool,
}

impl Faults {
    /// Sorts faults by lines, those of the whole file last, and keeps the first.
    pub fn of(mut all: Vec<Fault>, is_cut: bool) -> Self {
        all.sort_by_key(|fault| (fault.line.is_none(), fault.line, fault.column));
        let more = all.len().saturating_sub(MAX_FAULTS);
        all.truncate(MAX_FAULTS);
        Self { list: all, more, is_cut }
    }

    /// Returns the faults of a file with only one.
    pub fn one(fault: Fault) -> Self {
        Self { list: vec![fault], ..Self::default() }
    }

    /// Returns the number of faults that are known.
    pub fn count(&self) -> usize {
        self.list.len() + self.more
    }

    /// Says how many faults there are: `3 faults`.
    pub fn counted(&self) -> String {
        let least = if self.is_cut { "at least " } else { "" };
        format!("{least}{}", counted(self.count(), "fault"))
    }

    /// Says how many faults there are beside those of the list; `None` if the list is whole.
    pub fn rest(&self) -> Option<String> {
        match (self.more, self.is_cut) {
            (0, false) => None,
            (0, true) => Some("and perhaps more".into()),
            (more, is_cut) => Some(format!("and {}{more} more", if is_cut { "at least " } else { "" })),
        }
    }
}

impl Fault {
    /// Returns the fault as one line, after the name of its file: `arm.toml:4: …`.
    pub fn in_file(&self, file: &str) -> String {
        let line = self.line.map_or_else(String::new, |line| format!(":{line}"));
        format!("{file}{line}: {}", self.text)
    }
}
