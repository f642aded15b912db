//! [`Activity`]: what can be under way beside the window, and what is said of it.

/// What can be under way beside the window, what matters most first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Activity {
    /// A change of the session.
    Change,
    /// A session is opened.
    Opening,
    /// The session is saved.
    Saving,
    /// A recording is written.
    Recording,
    /// What a table says is found.
    Table,
    /// Machines of a study of tolerances are drawn.
    Study,
    /// The ways of the task run side by side.
    Ways,
    /// A run that is kept beside them.
    Kept,
    /// Lengths are sought.
    Seeking,
    /// Fronts of other machines are found.
    Fronts,
}

impl Activity {
    /// What it does, for the line at the bottom, and what is said when it has been cancelled; none if it cannot be.
    fn said(self) -> (&'static str, Option<&'static str>) {
        match self {
            Self::Change => ("making the run again", Some("cancelled: nothing has changed")),
            Self::Opening => ("opening", Some("cancelled: nothing was opened")),
            Self::Saving => ("saving", None),
            Self::Recording => ("recording", Some("cancelled: no file is left")),
            Self::Table => ("finding what the table says", Some("cancelled: another choice asks the table again")),
            Self::Study => ("drawing machines", Some("cancelled: no machines were drawn for the run as it is")),
            Self::Ways => ("running the ways of the task", Some("cancelled: the ways of the task were not run again")),
            Self::Fronts => ("finding fronts", Some("cancelled: take one away, or add one, to find them again")),
            Self::Seeking => ("seeking lengths", Some("cancelled: no lengths were found")),
            Self::Kept => ("running one more beside them", Some("cancelled: no run was added")),
        }
    }

    /// What it does, for the line at the bottom.
    pub fn words(self) -> &'static str {
        self.said().0
    }

    /// Whether it stops when it is told to.
    pub(super) fn can_stop(self) -> bool {
        self.said().1.is_some()
    }

    /// What to say when it has been cancelled.
    pub(super) fn cancelled(self) -> &'static str {
        self.said().1.unwrap_or_default()
    }
}
