//! [`FileDialog`]: the dialog for a file name.

use std::path::Path;

use super::export::{Export, PictureForm, RowForm};
use stillbase_exchange::form;
use stillbase_session::Session;

/// A dialog for a file name.
#[derive(Clone, Debug, PartialEq)]
pub struct FileDialog {
    /// The purpose of the file.
    pub purpose: FilePurpose,
    /// The text typed so far.
    pub path: String,
}

/// Purpose of a file name.
#[derive(Clone, Debug, PartialEq)]
pub enum FilePurpose {
    /// Open a session, a machine or a table.
    Open,
    /// Add a file to the measurement on display.
    Add,
    /// Write the session.
    Save,
    /// Write a recording.
    Record,
    /// Write the plot of this name.
    Plot(String, PlotFile),
    /// Write a picture, a film, values of signals or a report.
    Export(Export),
    /// Write the machine for another program.
    Machine,
}

/// File format of a plot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlotFile {
    /// The samples within the time range on display.
    Values(RowForm),
    /// A picture.
    Picture(PictureForm),
}

impl PlotFile {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Values(RowForm::Csv),
        Self::Values(RowForm::Parquet),
        Self::Picture(PictureForm::Svg),
        Self::Picture(PictureForm::Pdf),
        Self::Picture(PictureForm::Png),
        Self::Picture(PictureForm::Webp),
    ];

    /// Returns its name.
    pub fn words(self) -> &'static str {
        match self {
            Self::Values(form) => form.words(),
            Self::Picture(form) => form.words()[0],
        }
    }

    /// Returns the file name extensions, the suggested one first. Values and pictures are not exchanged.
    pub fn endings(self) -> Vec<&'static str> {
        let (mut endings, own) = match self {
            Self::Values(form) => (RowForm::ALL.map(RowForm::ending).to_vec(), form.ending()),
            Self::Picture(form) => (PictureForm::ALL.map(PictureForm::ending).to_vec(), form.ending()),
        };
        endings.sort_by_key(|ending| *ending != own);
        endings
    }
}

impl FilePurpose {
    /// Returns the title of the dialog, the text of its button, and an example of a file name.
    pub(super) fn words(&self) -> [&'static str; 3] {
        match self {
            Self::Open => ["Open a file", "Open", ".toml .urdf .xml .csv .parquet"],
            Self::Add => ["Add a file of the measurement", "Add", ".csv .parquet"],
            Self::Save => ["Save the session", "Save", "session.toml"],
            Self::Record => ["Record for the Rerun viewer", "Record", "run.rrd"],
            Self::Export(wanted) => [wanted.title(), "Save", wanted.example()],
            Self::Machine => ["Take the machine along", "Save", "machine.urdf"],
            Self::Plot(_, PlotFile::Values(form)) => {
                let example = if *form == RowForm::Csv { "plot.csv" } else { "plot.parquet" };
                ["Save the values shown", "Save", example]
            }
            Self::Plot(_, PlotFile::Picture(form)) => {
                let example = match form {
                    PictureForm::Png => "plot.png",
                    PictureForm::Webp => "plot.webp",
                    PictureForm::Svg => "plot.svg",
                    PictureForm::Pdf => "plot.pdf",
                };
                ["Save the plot as a picture", "Save", example]
            }
        }
    }

    /// Says how the name may end, if there is a choice that the dialog does not list otherwise.
    pub(super) fn endings(&self) -> Option<String> {
        let endings = match self {
            Self::Export(wanted) => wanted.naming().1,
            Self::Plot(_, file) => file.endings(),
            _ => return None,
        };
        Some(match &endings[..] {
            [] => "a folder".into(),
            endings => format!("the name ends in .{}", endings.join(" or .")),
        })
    }
}

/// Ending of machine files of this program.
pub(super) const MACHINE_EXTENSION: &str = "toml";

/// Formats of a machine's file: the ending, and what it is.
pub(super) const MACHINE_FORMATS: [(&str, &str); 9] = [
    (MACHINE_EXTENSION, "TOML"),
    ("urdf", "URDF"),
    ("xml", "MJCF"),
    ("svg", "drawing, SVG"),
    ("dxf", "drawing, DXF"),
    ("stl", "solids, STL"),
    ("csv", "parts, CSV"),
    ("parquet", "parts, Parquet"),
    ("md", "parts, Markdown"),
];

impl FileDialog {
    /// Returns whether it asks for a file to open.
    pub(super) fn opens(&self) -> bool {
        matches!(self.purpose, FilePurpose::Open | FilePurpose::Add)
    }

    /// Returns the ending of the name typed so far; empty if it has none.
    pub(super) fn ending(&self) -> String {
        Path::new(self.path.trim()).extension().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// Gives the name an ending in place of its own.
    pub(super) fn set_ending(&mut self, ending: &str) {
        if !self.path.trim().is_empty() {
            self.path = Path::new(self.path.trim()).with_extension(ending).display().to_string();
        }
    }

    /// Returns a dialog to open a file.
    pub fn opening() -> Self {
        Self { purpose: FilePurpose::Open, path: String::new() }
    }

    /// Returns a dialog to add a file to the measurement on display.
    pub fn adding() -> Self {
        Self { purpose: FilePurpose::Add, path: String::new() }
    }

    /// Returns a dialog to save the machine as a file of this program.
    pub fn of_machine(session: &Session) -> Self {
        let name = stillbase_files::free_name(session.scenario().machine.name(), MACHINE_EXTENSION);
        Self { purpose: FilePurpose::Machine, path: name.display().to_string() }
    }

    /// Returns a dialog that suggests an unused file name; a dialog to open a file suggests none.
    pub fn suggest(session: &Session, purpose: FilePurpose) -> Self {
        let own = &session.scenario().name;
        let free = |name: &str, ending: &str| stillbase_files::free_name(name, ending).display().to_string();
        let name = match &purpose {
            FilePurpose::Open | FilePurpose::Add => String::new(),
            FilePurpose::Save => free(own, "toml"),
            FilePurpose::Record => free(own, "rrd"),
            FilePurpose::Machine => free(session.scenario().machine.name(), form::DEFAULT_EXTENSION),
            FilePurpose::Export(wanted) => {
                let (addition, endings) = wanted.naming();
                free(&format!("{own}{addition}"), endings.first().copied().unwrap_or_default())
            }
            FilePurpose::Plot(plot, file) => {
                free(&format!("{own} {}", plot.to_lowercase()), file.endings().first().copied().unwrap_or_default())
            }
        };
        Self { purpose, path: name }
    }
}
