//! Files that other programs change while their session is open.

use std::path::{Path, PathBuf};

use super::AppState;
use crate::Activity;
use crate::background::{Opening, SessionFile};
use crate::change::SessionSource;
use crate::watched_file::WatchedFile;
use stillbase_session::scenario::Scenario;

/// Title of the change in the history, and message.
const TAKEN: &str = "taken from the file";

impl AppState {
    /// Watches the file from which the session was opened.
    #[must_use]
    pub fn watching(mut self, file: Option<PathBuf>) -> Self {
        self.watch(file);
        self
    }

    /// Begins to watch the file of the session, or ends it with `None`.
    pub(super) fn watch(&mut self, file: Option<PathBuf>) {
        self.watched = file.map(|file| WatchedFile::of(file, &self.session));
    }

    /// Returns the file that is watched.
    pub fn watched_file(&self) -> Option<&Path> {
        self.watched.as_ref().map(WatchedFile::file)
    }

    /// Returns the scenario as the file of the session states it, if the session has one.
    pub(super) fn stated_in_file(&self) -> Option<&Scenario> {
        let own = self.watched.as_ref().filter(|watched| watched.is_of(self.session.undo_count()));
        own.map(WatchedFile::stated)
    }

    /// Looks about once a second whether another program has changed the file of the session, `elapsed` s after the
    /// last call. A changed file is taken up as one change; if the session has changes that are in no file, the user is
    /// asked.
    pub fn look_at_file(&mut self, elapsed: f64) {
        let is_busy = self.background.runs(Activity::Opening) || self.background.runs(Activity::Saving);
        if self.aside.is_some() || is_busy || self.background.is_changing() {
            return;
        }
        let undo_count = self.session.undo_count();
        let Some(watched) = self.watched.as_mut().filter(|watched| watched.is_of(undo_count)) else { return };
        if !watched.look(elapsed) {
            return;
        }
        if self.saving.is_unsaved() {
            watched.asks = true;
        } else {
            self.take_changed_file();
        }
    }

    /// Answers the question about a changed file.
    pub(super) fn answer_changed_file(&mut self, takes: bool) {
        if let Some(watched) = &mut self.watched {
            watched.asks = false;
        }
        if takes {
            self.take_changed_file();
        }
    }

    fn take_changed_file(&mut self) {
        let Some(file) = self.watched_file().map(Path::to_owned) else { return };
        let opening = Opening {
            message: Some(format!("{}: {TAKEN}", file.display())),
            file: Some(SessionFile::Own(file.clone())),
            title: Some(TAKEN),
            ..Opening::default()
        };
        self.open(SessionSource::File(file), opening);
    }
}
