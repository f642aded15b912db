//! Dialogs, lists and cards that are open over the window.

use super::FileDialog;
use super::FileReport;
use super::export::Export;
use super::guide::GuideView;
use super::notes::NoteDraft;
use super::tour::Tour;

/// State of the list of commands.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Finder {
    /// Search text.
    pub search_text: String,
    /// Index of the selected line, counted from 0 at the top.
    pub chosen: usize,
}

/// The cards, lists and dialogs that are open.
#[derive(Clone, Debug, Default)]
pub struct OpenDialogs {
    /// The card of keys.
    pub help: bool,
    /// The list of changes.
    pub history: bool,
    /// All settings in a window of their own.
    pub settings: bool,
    /// The display of repaint times.
    pub times: bool,
    /// The tour while it runs.
    pub tour: Option<Tour>,
    /// The list of commands.
    pub finder: Option<Finder>,
    /// The guide.
    pub guide: Option<GuideView>,
    /// The file dialog.
    pub dialog: Option<FileDialog>,
    /// The list about a file: its faults, or what was left out of it.
    pub report: Option<FileReport>,
    /// The card with the choices for a result that becomes a file.
    pub export: Option<Export>,
    /// The time of the bookmark that is being named, s.
    pub naming: Option<f64>,
    /// The note that is being written.
    pub note: Option<NoteDraft>,
}
