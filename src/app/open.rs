//! What lies open over the window until it is closed.

use super::FileDialog;
use super::finder::Finder;
use super::tour::Tour;

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
