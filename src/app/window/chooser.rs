//! [`Chooser`]: the file dialogs of the system, if there are any.

mod portal;

use std::path::{Path, PathBuf};

use rfd::{AsyncFileDialog, FileHandle};
use winit::window::Window;

use crate::file_dialog::MACHINE_EXTENSION;
use crate::jobs::Threads;
use crate::{AppState, FileDialog, FilePurpose, SessionCommand, ViewChange};
use stillbase_exchange::form;
use stillbase_files::table::TABLE_ENDINGS;
use stillbase_query::{Job, Poll};

/// Shows file dialogs of the system in the background.
#[derive(Default)]
pub struct Chooser {
    /// Whether the system has no file dialog.
    is_unavailable: bool,
    pending: Option<(FileDialog, Job<Answer>)>,
    /// Folder of the file chosen last.
    folder: Option<PathBuf>,
}

/// Result of a dialog of the system.
enum Answer {
    /// A file was chosen.
    Chosen(PathBuf),
    /// The dialog was closed without a file.
    Closed,
    /// The system has no file dialog.
    NoDialog,
}

impl Chooser {
    /// Shows the system's dialog in place of the window's. The window shows its own dialog if the system has none, or
    /// if a file is requested again while the system's dialog is open.
    pub fn follow(&mut self, ctx: &egui::Context, window: &Window, app_state: &mut AppState) {
        let Some((dialog, job)) = self.pending.take() else {
            if let Some(dialog) = app_state.view_state().open.dialog.clone().filter(|_| !self.is_unavailable) {
                app_state.carry_out(ViewChange::Dialog(None));
                let last = app_state.recent().first().and_then(|file| file.parent());
                let folder = self.folder.as_deref().or(last).filter(|folder| folder.is_dir());
                let (answer, wake) = (system_dialog(&dialog, folder, window), ctx.clone());
                let wait = move |_: &_| match portal::is_there() {
                    true => pollster::block_on(answer)
                        .map_or(Answer::Closed, |file| Answer::Chosen(file.path().to_path_buf())),
                    false => Answer::NoDialog,
                };
                self.pending = Some((dialog, Job::start(&Threads::Background, move || wake.request_repaint(), wait)));
            }
            return;
        };
        match job.poll() {
            Poll::Working => self.pending = Some((dialog, job)),
            Poll::Done(Answer::Chosen(file)) => {
                self.folder = file.parent().map(Path::to_path_buf);
                // The system's dialog has asked whether an existing file may be replaced.
                app_state.carry_out(SessionCommand::Replace(file.clone()));
                // A file to open keeps its name.
                let file = match dialog.purpose {
                    FilePurpose::Open | FilePurpose::Add => file,
                    _ => match endings(&dialog.purpose).first() {
                        Some(ending) => with_ending(file, ending),
                        None => file,
                    },
                };
                app_state.carry_out(dialog.named(file));
                ctx.request_repaint();
            }
            Poll::Done(Answer::NoDialog) => {
                self.is_unavailable = true;
                app_state.carry_out(ViewChange::Dialog(Some(dialog)));
                ctx.request_repaint();
            }
            Poll::Done(Answer::Closed) | Poll::Broken => {}
        }
    }
}

/// Returns the file extensions for a purpose, the usual one first.
fn endings(purpose: &FilePurpose) -> Vec<&'static str> {
    match purpose {
        FilePurpose::Open => [&["toml", "urdf", "xml"], TABLE_ENDINGS, &["rrd"]].concat(),
        FilePurpose::Add => TABLE_ENDINGS.to_vec(),
        FilePurpose::Save => vec!["toml"],
        FilePurpose::Record => vec!["rrd"],
        FilePurpose::Plot(_, file) => file.endings(),
        FilePurpose::Export(wanted) => wanted.naming().1,
        FilePurpose::Machine => {
            let mut endings = [&[MACHINE_EXTENSION], form::endings().as_slice()].concat();
            endings.sort_by_key(|ending| *ending != form::DEFAULT_EXTENSION);
            endings
        }
    }
}

/// Adds the extension to a file name without one.
fn with_ending(file: PathBuf, ending: &str) -> PathBuf {
    if file.extension().is_some() { file } else { file.with_extension(ending) }
}

type DialogFuture = std::pin::Pin<Box<dyn Future<Output = Option<FileHandle>> + Send>>;

/// Creates the dialog of the system, in front of the window.
fn system_dialog(dialog: &FileDialog, folder: Option<&Path>, window: &Window) -> DialogFuture {
    let ([title, ..], endings) = (dialog.purpose.words(), endings(&dialog.purpose));
    let kind = match &dialog.purpose {
        FilePurpose::Open => "Sessions, machines, models and tables",
        FilePurpose::Add => "Tables",
        FilePurpose::Save => "Sessions",
        FilePurpose::Record => "Recordings",
        FilePurpose::Plot(..) => "Plots",
        FilePurpose::Export(wanted) => wanted.kind(),
        FilePurpose::Machine => "Models, drawings and lists",
    };
    let mut asks = AsyncFileDialog::new().set_parent(window).set_title(title);
    if !endings.is_empty() {
        asks = asks.add_filter(kind, &endings);
    }
    if let Some(folder) = folder {
        asks = asks.set_directory(folder);
    }
    match (&dialog.purpose, Path::new(&dialog.path).file_name()) {
        (FilePurpose::Open | FilePurpose::Add, _) => Box::pin(asks.add_filter("All files", &["*"]).pick_file()),
        (_, Some(name)) => Box::pin(asks.set_file_name(name.to_string_lossy()).save_file()),
        (_, None) => Box::pin(asks.save_file()),
    }
}
