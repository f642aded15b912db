//! [`SessionChange`]: a user's change of a session. It may take long, so it is made on a copy of the session.

use std::path::{Path, PathBuf};

use super::{FileReport, RefusedEdit, ResumePoint};
use stillbase_files::FoundScenario;
use stillbase_files::table::{Table, is_table};
use stillbase_session::scenario::Scenario;
use stillbase_session::{Edit, ProgressCallback, Refusal, Session};
use stillbase_settings::text::shorten_message;

/// A change of a session.
#[derive(Clone, Debug)]
pub(super) enum SessionChange {
    /// One edit.
    Edit(Edit),
    /// Undoes the last change.
    Undo,
    /// Redoes the change undone last.
    Redo,
    /// Undoes or redoes until the session has this number of undo entries.
    GoTo(usize),
    /// Shows the instant at this time, s.
    Seek(f64),
    /// Shows the branch of this index.
    Branch(usize),
    /// Puts the machine back at the start of its planned path.
    BackToPath,
}

impl SessionChange {
    /// Makes the change in `session` and returns a message for the user, if there is one. `watch` reports progress and
    /// can stop the change.
    pub fn make(&self, session: &mut Session, watch: ProgressCallback<'_>) -> Result<Option<String>, Refusal> {
        match self {
            Self::Edit(edit) => {
                session.apply_while(edit.clone(), watch)?;
                if matches!(edit, Edit::Sketch(_)) && session.has_just_made_task() {
                    return Ok(Some(
                        "the machine could not do the task: one is made for it; Ctrl Z undoes both".into(),
                    ));
                }
            }
            Self::Undo => {
                let title = session.undo_title().map(|title| format!("undone: {title}"));
                session.undo_while(watch)?;
                return Ok(title);
            }
            Self::Redo => {
                let title = session.redo_title().map(|title| format!("redone: {title}"));
                session.redo_while(watch)?;
                return Ok(title);
            }
            Self::GoTo(changes) => {
                let before = session.undo_count();
                while session.undo_count() > *changes {
                    session.undo_while(watch)?;
                }
                while session.undo_count() < *changes && session.redo_title().is_some() {
                    session.redo_while(watch)?;
                }
                let done =
                    |word: &str, n: usize| Some(format!("{word}: {n} {}", if n == 1 { "change" } else { "changes" }));
                return Ok(match session.undo_count() {
                    now if now < before => done("undone", before - now),
                    now if now > before => done("redone", now - before),
                    _ => None,
                });
            }
            Self::Seek(time) => {
                session.pause();
                session.seek_while(*time, watch);
            }
            Self::Branch(branch) => {
                session.switch_branch_while(*branch, watch)?;
                return Ok(session.undo_title().map(String::from));
            }
            Self::BackToPath => {
                session.apply_while(Edit::of("task", Default::default()), watch)?;
                session.end_gesture();
                session.pause();
                session.seek(0.0);
                return Ok(Some("back on the planned path, at its start".into()));
            }
        }
        Ok(None)
    }
}

/// Source of a session or table to open.
#[derive(Clone, Debug)]
pub(super) enum SessionSource {
    /// A scenario in memory.
    Scenario(Box<Scenario>),
    /// A file.
    File(PathBuf),
    /// The journal of a program run that ended abnormally.
    Journal(PathBuf),
}

/// Result of opening a [`SessionSource`].
pub(super) enum Opened {
    Session(Box<OpenedSession>),
    /// A table of numbers to be assessed for the session on display.
    Table(PathBuf, Table),
}

/// An opened session.
pub(super) struct OpenedSession {
    pub session: Session,
    /// A note about the source, for the user.
    pub note: Option<String>,
    /// What was left out of the file.
    pub left_out: Option<FileReport>,
    /// What the window showed when the file was written, if the file says so.
    pub left_off: Option<ResumePoint>,
}

/// The reason why a source was not opened.
#[derive(Debug)]
pub(super) struct NotOpened {
    pub why: String,
    pub refused: Option<RefusedEdit>,
    /// The faults of the file.
    pub report: Option<FileReport>,
}

impl NotOpened {
    /// Returns the reason of a source that cannot be read.
    fn unread(why: &dyn std::fmt::Display) -> Self {
        Self { why: shorten_message(&why.to_string()).into_owned(), refused: None, report: None }
    }
}

impl SessionSource {
    /// Reads, plans and replays the source. `watch` reports progress and can stop the work.
    pub fn open(self, watch: ProgressCallback<'_>) -> Result<Opened, NotOpened> {
        let read = |path: &Path| {
            let found = stillbase_files::any_scenario(&path.display().to_string());
            found.map_err(|why| {
                let report = why.faults().map(|(file, faults)| FileReport::of_faults(file, faults));
                NotOpened { report, ..NotOpened::unread(&why) }
            })
        };
        if let Self::File(path) = &self
            && is_table(path)
        {
            let table = Table::open(path).map_err(|why| NotOpened::unread(&why))?;
            return Ok(Opened::Table(path.clone(), table));
        }
        let (FoundScenario { scenario, note, left_out, recorded }, left_off, path) = match self {
            Self::Scenario(scenario) => {
                let found = FoundScenario { scenario: *scenario, note: None, left_out: Vec::new(), recorded: None };
                (found, None, PathBuf::new())
            }
            Self::File(path) | Self::Journal(path) => {
                let text = stillbase_files::text::read(&path).unwrap_or_default();
                (read(&path)?, ResumePoint::of(&text), path)
            }
        };
        let mut session = Session::open_while(scenario.clone(), watch).map_err(|refusal| NotOpened {
            why: refusal.to_string(),
            refused: Some(RefusedEdit::of_opening(&scenario, &refusal)),
            report: None,
        })?;
        if let Some(ResumePoint { time, reached, .. }) = &left_off {
            // The file may name any time: the run is not extended beyond its length.
            for time in [reached.max(*time), *time] {
                session.seek_while(time.min(session.length()), watch);
            }
        }
        let note = recorded.map_or(note.clone(), |case| {
            let of = path.file_name().unwrap_or_default().to_string_lossy();
            let difference = case.simulated_again(&scenario, &case.tolerances(), || true);
            let found = difference.map_or_else(|why| why.to_string(), |difference| difference.sentence(""));
            let found = format!("{of}, simulated again: {found}");
            Some(note.map_or(found.clone(), |note| format!("{found}; {note}")))
        });
        Ok(Opened::Session(Box::new(OpenedSession {
            session,
            note,
            left_out: FileReport::not_read(&path, left_out),
            left_off,
        })))
    }
}
