//! [`Activity`]: the kinds of background work, and their messages.

/// A kind of background work; the most important comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Activity {
    /// A change of the session.
    Change,
    /// Opening a session or table.
    Opening,
    /// Saving a file.
    Saving,
    /// Writing a recording.
    Recording,
    /// Writing a picture, a film, values of signals or a report.
    Exporting,
    /// Assessing a table.
    Table,
    /// Sampling machines for a study of tolerances.
    Study,
    /// Running the same task in several ways, for comparison.
    TaskVariants,
    /// Running one more scenario for the table of runs.
    ExtraRun,
    /// Searching for link lengths.
    Seeking,
    /// Computing the Pareto fronts of other machines.
    Fronts,
}

impl Activity {
    /// Returns the text for the status line, and the message after cancelling; the second is `None` if the work cannot
    /// be cancelled.
    fn texts(self) -> (&'static str, Option<&'static str>) {
        match self {
            Self::Change => ("making the run again", Some("cancelled: nothing has changed")),
            Self::Opening => ("opening", Some("cancelled: nothing was opened")),
            Self::Saving => ("saving", None),
            Self::Recording => ("recording", Some("cancelled: no file is left")),
            Self::Exporting => ("writing the file", Some("cancelled: no file is left")),
            Self::Table => ("finding what the table says", Some("cancelled: choose again to assess the table again")),
            Self::Study => ("sampling machines", Some("cancelled: no machines were sampled for the present run")),
            Self::TaskVariants => {
                ("running the ways of the task", Some("cancelled: the ways of the task were not run again"))
            }
            Self::Fronts => ("finding fronts", Some("cancelled: take one away, or add one, to find them again")),
            Self::Seeking => ("seeking lengths", Some("cancelled: no lengths were found")),
            Self::ExtraRun => ("running one more for the table of runs", Some("cancelled: no run was added")),
        }
    }

    /// Returns the text for the status line.
    pub fn words(self) -> &'static str {
        self.texts().0
    }

    /// Whether the work can be cancelled.
    pub(super) fn can_stop(self) -> bool {
        self.texts().1.is_some()
    }

    /// Returns the message after cancelling.
    pub(super) fn cancelled(self) -> &'static str {
        self.texts().1.unwrap_or_default()
    }
}
