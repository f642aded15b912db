//! Merges the shards of a study, or reports which of them are missing, duplicate or of another study.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use super::error::ShardError;
use super::rows::{StudyId, StudyPart, Writer, difference, outcome_of};
use crate::row_file::RowForm;
use stillbase_study::tolerance::SampleOutcome;

/// Number of rows between two questions whether to go on.
const ROWS_BETWEEN_QUESTIONS: u64 = 4096;

/// Merges shards, given in any order, into one file of a format, or standard output, and returns the study and the
/// outcomes of its machines; `None` if `goes_on` says that it is to stop, and then no file is left.
///
/// # Errors
/// If a shard is unreadable or of another study, samples are duplicate or missing, or `whole` cannot be written.
pub fn merge(
    parts: &[PathBuf],
    whole: (&Path, RowForm),
    force: bool,
    goes_on: &dyn Fn() -> bool,
) -> Result<Option<(StudyId, Vec<SampleOutcome>)>, ShardError> {
    let mut opened = Vec::with_capacity(parts.len());
    for file in parts {
        let part = StudyPart::open(file)?;
        opened.push((part.first_sample()?, part));
    }
    let Some((_, reference)) = opened.first() else { return Err(ShardError::Wrong("--merge: want parts".into())) };
    let head = reference.head.clone();
    if let Some((_, other)) = opened.iter().find(|(_, part)| part.head != head) {
        let [other_file, file] = [other, reference].map(|part| part.file.display());
        let is_same_draw = other.head.study.samples == head.study.samples && other.head.study.seed == head.study.seed;
        let varies = is_same_draw && other.head.columns != head.columns;
        let why = match difference(&other.head.study, &head.study) {
            Some(why) if !varies => why,
            _ => "other numbers vary".into(),
        };
        return Err(ShardError::Wrong(format!("{other_file} and {file} are parts of different studies: {why}")));
    }
    // Shards without machines come last.
    opened.sort_by_key(|(first, _)| first.unwrap_or(u64::MAX));
    let mut writer = Writer::create(whole, force, &head)?;
    let (mut next, mut outcomes, mut before) = (0, Vec::new(), None::<PathBuf>);
    for (first, part) in opened {
        let file = part.file.clone();
        if first.is_some_and(|first| first > next) {
            return Err(missing(next, first.unwrap_or(next) - 1));
        }
        if let (Some(first), Some(before)) = (first.filter(|first| *first < next), &before) {
            let (file, before) = (file.display(), before.display());
            let why = format!("{file}: sample {first} stands in {before} too: want every shard once");
            return Err(ShardError::Wrong(why));
        }
        part.rows(|sample, row| {
            if sample != next {
                let why = format!("{}: sample {sample} where {next} should follow: want a whole shard", file.display());
                return Err(ShardError::Wrong(why));
            }
            next += 1;
            outcomes.push(outcome_of(row));
            writer.row(sample, row)?;
            let asks = next.is_multiple_of(ROWS_BETWEEN_QUESTIONS);
            Ok(if asks && !goes_on() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
        })?;
        if !goes_on() {
            return Ok(None);
        }
        before = Some(file);
    }
    if next < head.study.samples {
        return Err(missing(next, head.study.samples - 1));
    }
    writer.finish()?;
    Ok(Some((head.study, outcomes)))
}

fn missing(first: u64, last: u64) -> ShardError {
    ShardError::Wrong(format!("samples {first} to {last} are in no part: want every shard"))
}
