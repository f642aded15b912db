//! Bookmarks on the time line of a run, and branches, which are courses of the run that other edits have replaced.

use serde::{Deserialize, Serialize};

use super::bounds::MAX_TIME;
use crate::TimedEdit;
use stillbase_settings::number::ShortNumber;
use stillbase_settings::text::control_character;

/// A named instant of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bookmark {
    /// Time, s.
    pub time: f64,
    /// Name.
    pub name: String,
}

/// A course of a run that was replaced when the user went back in time and edited.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// Duration, s.
    pub duration: f64,
    /// All edits of this course of the run, from the start on.
    pub edits: Vec<TimedEdit>,
}

/// Maximum number of bookmarks of a session.
pub const MAX_BOOKMARKS: usize = 100;

/// Maximum number of branches of a session.
pub const MAX_BRANCHES: usize = 32;

/// Maximum length of the name of a bookmark, characters.
pub const MAX_NAME: usize = 60;

/// A branch as a file states it.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StatedBranch {
    duration: f64,
    #[serde(default, rename = "edit", skip_serializing_if = "Vec::is_empty")]
    edits: Vec<toml::Table>,
}

impl From<Branch> for StatedBranch {
    fn from(branch: Branch) -> Self {
        Self { duration: branch.duration, edits: branch.edits.iter().map(TimedEdit::to_table).collect() }
    }
}

impl Bookmark {
    fn check(&self) -> Result<(), String> {
        let count = self.name.chars().count();
        match self {
            _ if !(0.0..=MAX_TIME).contains(&self.time) => {
                Err(format!("time is {}: want a number from 0 to {MAX_TIME} s", ShortNumber(self.time)))
            }
            _ if self.name.trim().is_empty() || count > MAX_NAME => {
                Err(format!("name has {count} characters: want 1 to {MAX_NAME}, not all of them spaces"))
            }
            _ => control_character(&self.name).map_or(Ok(()), |c| {
                Err(format!("name holds the control character U+{:04X}: want printable characters", u32::from(c)))
            }),
        }
    }
}

/// Checks the bookmarks of a file.
///
/// # Errors
/// If a bookmark is wrong: the index of the first wrong one, and the reason.
pub(super) fn check_bookmarks(bookmarks: &[Bookmark]) -> Result<(), (usize, String)> {
    if bookmarks.len() > MAX_BOOKMARKS {
        return Err((MAX_BOOKMARKS, format!("want at most {MAX_BOOKMARKS} bookmarks")));
    }
    let wrong = |(i, mark): (usize, &Bookmark)| mark.check().err().map(|why| (i, why));
    bookmarks.iter().enumerate().find_map(wrong).map_or(Ok(()), Err)
}

/// Reads the branches of a file. `check` tests the edits of one branch, and returns the index of a wrong one.
///
/// # Errors
/// If a branch is wrong: the index of the first wrong one, and the reason.
pub(super) fn branches(
    stated: Vec<StatedBranch>,
    check: impl Fn(&[TimedEdit]) -> Result<(), (usize, String)>,
) -> Result<Vec<Branch>, (usize, String)> {
    if stated.len() > MAX_BRANCHES {
        return Err((MAX_BRANCHES, format!("want at most {MAX_BRANCHES} branches")));
    }
    let read = |(i, branch): (usize, StatedBranch)| {
        let StatedBranch { duration, edits } = branch;
        if !(0.0..=MAX_TIME).contains(&duration) {
            return Err((i, format!("duration is {}: want a number from 0 to {MAX_TIME} s", ShortNumber(duration))));
        }
        let of_edit = |(entry, why): (usize, String)| (i, format!("edit {}: {why}", entry + 1));
        let edits: Result<Vec<TimedEdit>, (usize, String)> =
            edits.into_iter().enumerate().map(|(k, e)| TimedEdit::from_table(e).map_err(|why| (k, why))).collect();
        let edits = edits.map_err(of_edit)?;
        check(&edits).map_err(of_edit)?;
        Ok(Branch { duration, edits })
    };
    stated.into_iter().enumerate().map(read).collect()
}
