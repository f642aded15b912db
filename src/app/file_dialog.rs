//! [`FileDialog`]: asking for a file, and what is done with the one that was named.

use crate::exchange::form;
use crate::session::Session;

/// Asking for a file name.
#[derive(Clone, Debug, PartialEq)]
pub struct FileDialog {
    /// What the file is for.
    pub purpose: Purpose,
    /// What is typed so far.
    pub path: String,
}

/// What a file name is for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Read a session.
    Open,
    /// Write the session.
    Save,
    /// Write a recording.
    Record,
    /// Write the plot of a name.
    Plot(String, PlotFile),
    /// Write the machine for another program.
    Machine,
}

/// How a plot is written to a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlotFile {
    /// Every sample of the time shown.
    Csv,
    /// A drawing.
    Svg,
    /// A picture.
    Png,
}

impl PlotFile {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Csv, Self::Svg, Self::Png];

    /// What it is called.
    pub fn words(self) -> &'static str {
        match self {
            Self::Csv => "CSV",
            Self::Svg => "SVG",
            Self::Png => "PNG",
        }
    }
}

impl Purpose {
    /// What a dialog asks, what its button says, and how such a file may be called.
    pub(super) fn words(&self) -> [&'static str; 3] {
        match self {
            Self::Open => ["Open a file", "Open", ".toml .urdf .xml .csv"],
            Self::Save => ["Save the session", "Save", "session.toml"],
            Self::Record => ["Record for the Rerun viewer", "Record", "run.rrd"],
            Self::Machine => ["Take along", "Save", "machine.urdf"],
            Self::Plot(_, PlotFile::Csv) => ["Save the values of the time shown", "Save", "plot.csv"],
            Self::Plot(_, PlotFile::Svg) => ["Save the plot as a drawing", "Save", "plot.svg"],
            Self::Plot(_, PlotFile::Png) => ["Save the plot as a picture", "Save", "plot.png"],
        }
    }

    /// What a dialog asks, with the endings to choose from.
    pub(super) fn title(&self) -> String {
        let [title, ..] = self.words();
        match self {
            Self::Machine => format!("{title}: .{}", form::endings().join(" .")),
            _ => title.into(),
        }
    }
}

impl FileDialog {
    /// To open a file.
    pub fn opening() -> Self {
        Self { purpose: Purpose::Open, path: String::new() }
    }

    /// A file name that is free, for a dialog to start from.
    pub fn suggest(session: &Session, purpose: Purpose) -> Self {
        let own = &session.scenario().name;
        let free = |name: &str, ending: &str| crate::files::free_name(name, ending).display().to_string();
        let name = match &purpose {
            Purpose::Open => String::new(),
            Purpose::Save => free(own, "toml"),
            Purpose::Record => free(own, "rrd"),
            Purpose::Machine => free(session.scenario().machine.name(), form::USUAL_ENDING),
            Purpose::Plot(plot, file) => free(&format!("{own} {}", plot.to_lowercase()), &file.words().to_lowercase()),
        };
        Self { purpose, path: name }
    }
}
