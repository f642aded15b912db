//! What lies open over the window until it is closed.

use super::FileDialog;
use super::tour::Tour;

/// What is typed into the list, and which line is chosen.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Finder {
    /// A few letters.
    pub sought: String,
    /// Counted from the top.
    pub chosen: usize,
}

/// Cards, lists and dialogs.
#[derive(Clone, Debug, Default)]
pub struct Open {
    /// The keys.
    pub help: bool,
    /// What was done.
    pub history: bool,
    /// What a repaint takes.
    pub times: bool,
    /// The tour, while it is under way.
    pub tour: Option<Tour>,
    /// The list of commands.
    pub finder: Option<Finder>,
    /// A file is being asked for.
    pub dialog: Option<FileDialog>,
    /// The name of the bookmark at this instant, s, is asked for.
    pub naming: Option<f64>,
}
