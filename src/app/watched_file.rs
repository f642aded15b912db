//! [`WatchedFile`]: the file from which the session was opened, while another program may change it, and the question
//! what to do if the session has changed, too.

use std::path::{Path, PathBuf};

use egui::{Align2, Id, RichText};

use super::theme::{colour, plain};
use super::{Command, ViewState, WindowCommand};
use stillbase_files::stamp::FileStamp;
use stillbase_query::Shared;
use stillbase_session::Session;
use stillbase_session::scenario::Scenario;

/// A file that other programs may change.
#[derive(Clone, Debug)]
pub(super) struct WatchedFile {
    file: PathBuf,
    /// Number of undo entries right after the file was opened; undo leads back to a session without this file.
    since: usize,
    /// The scenario as the file states it.
    stated: Shared<Scenario>,
    /// Stamp of the file as it was taken up or written last.
    stamp: Option<FileStamp>,
    /// Stamp of a change that may still be under way.
    changing: Option<FileStamp>,
    /// Time since the last look, s.
    unseen_s: f64,
    /// Whether the question is open.
    pub asks: bool,
}

/// Time between two looks at the file, s. A change counts once the file looks the same twice.
const INTERVAL_S: f64 = 1.0;

impl WatchedFile {
    /// Begins to watch a file that a session has just been opened from or saved to.
    pub fn of(file: PathBuf, session: &Session) -> Self {
        let (stamp, since) = (FileStamp::of(&file), session.undo_count());
        let stated = session.run().shared_scenario();
        Self { file, since, stated, stamp, changing: None, unseen_s: 0.0, asks: false }
    }

    /// Returns the scenario as the file states it.
    pub fn stated(&self) -> &Scenario {
        &self.stated.0
    }

    /// Returns the file.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// Returns whether a session with this number of undo entries is of the file.
    pub fn is_of(&self, undo_count: usize) -> bool {
        undo_count >= self.since
    }

    /// Looks at the file if it is time to, `elapsed` s after the last call. Returns whether another program has changed
    /// the file and is done with that.
    pub fn look(&mut self, elapsed: f64) -> bool {
        self.unseen_s += elapsed;
        if self.unseen_s < INTERVAL_S {
            return false;
        }
        self.unseen_s = 0.0;
        let now = FileStamp::of(&self.file);
        // A file that is gone leaves the session as it is.
        if now.is_none() || now == self.stamp {
            self.changing = None;
            return false;
        }
        if self.changing != now {
            self.changing = now;
            return false;
        }
        (self.stamp, self.changing) = (now, None);
        true
    }
}

/// Shows the question whether to take up a changed file, if it is open. Nothing waits for the answer.
pub(super) fn show(
    ctx: &egui::Context,
    watched: Option<&WatchedFile>,
    view_state: &ViewState,
    commands: &mut Vec<Command>,
) {
    let Some(watched) = watched.filter(|watched| watched.asks) else { return };
    let p = view_state.palette();
    let file = watched.file.file_name().map_or_else(String::new, |name| name.display().to_string());
    let window = egui::Window::new(format!("{file} has changed")).id(Id::unique("changed file"));
    let window = window.collapsible(false).resizable(false).anchor(Align2::CENTER_TOP, [0.0, 96.0]);
    window.show(ctx, |ui| {
        ui.set_max_width(420.0);
        let words = "Another program has changed the file, and this session has changes that are in no file.";
        ui.add(egui::Label::new(RichText::new(words).font(plain(12.5)).color(colour(p.ink))).wrap());
        ui.horizontal(|ui| {
            let take = ui.button("Take the file's").on_hover_text("one change; Ctrl Z goes back to yours");
            if take.clicked() {
                commands.push(WindowCommand::ChangedFile(true).into());
            }
            let keep = ui.button("Keep mine").on_hover_text("the file stays as it is until you save");
            if keep.clicked() {
                commands.push(WindowCommand::ChangedFile(false).into());
            }
        });
    });
}
