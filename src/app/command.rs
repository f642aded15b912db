//! What a person asks for.

use std::path::PathBuf;

use super::layout::Layout;
use crate::exchange::form;
use crate::picture::charts::choice::Change;
use crate::picture::scene::Measure;
use crate::picture::scene::options::Handle;
use crate::picture::scene::palette::Theme;
use crate::picture::scene::views::ViewKind;
use crate::session::scenario::Scenario;
use crate::session::{Edit, Session};
use crate::study::front_point::FrontMeasure;

/// What a person can ask for.
#[derive(Clone, Debug)]
pub enum Command {
    /// Change the machine, the run or its parameters.
    Edit(Edit),
    /// The drag is over: the next edit is an undo of its own.
    EndGesture,
    /// Let time pass, or stop it.
    TogglePlay,
    /// Show an instant, s.
    Seek(f64),
    /// Put a bookmark at an instant, s, or give the one there this name; without a name it is taken away.
    Bookmark(f64, String),
    /// Ask for the name of the bookmark at an instant, s, or no longer; where there is none it is put there.
    NameBookmark(Option<f64>),
    /// Show the next mark of the time line, or the one before.
    ToMark(bool),
    /// Show a branch, by its place among them; the run on display becomes one.
    Branch(usize),
    /// Add a branch to the runs side by side.
    CompareBranch(usize),
    /// Let go of a branch.
    DropBranch(usize),
    /// Move by steps; time stops.
    Step(i64),
    /// Play faster or slower: simulated seconds a second.
    Speed(f64),
    /// Play over and over, or once.
    Loop(bool),
    /// Replace everything by another scenario.
    Open(Box<Scenario>),
    /// Open a saved session or scenario.
    OpenFile(PathBuf),
    /// Save the session.
    SaveFile(PathBuf),
    /// Write a recording for the Rerun viewer.
    Record(PathBuf),
    /// Undo the last edit.
    Undo,
    /// Undo what has been done since there were so many changes to undo: what a drag did that is given up.
    TakeBack(usize),
    /// Take back what the drag under way has done.
    GiveUp,
    /// Redo what was undone last.
    Redo,
    /// Show one of the linked views.
    View(ViewKind),
    /// Show the equations beside the machine that is designed, or its balance.
    Learn(bool),
    /// Shade the workspace by a measure of dexterity, or not.
    Dexterity(Option<Measure>),
    /// Point the camera so that everything is seen.
    Fit,
    /// Move the camera.
    Look(Look),
    /// Light or dark colours.
    Theme(Theme),
    /// Show how A would be held on the plane of another b, rad.
    Preview(Option<f64>),
    /// Start or stop drawing a path with the pointer.
    Draw(bool),
    /// Show where in the panel of settings a thing of the scene stands.
    Reveal(Handle),
    /// Show a setting there, by its path.
    LookUp(String),
    /// Show or hide the panel of settings on the left.
    Side(bool),
    /// Show or hide the panel of plots on the right.
    Plots(bool),
    /// Show both panels, or nothing but the scene.
    Panels(bool),
    /// Lay the window out for what it is for now; again: as that is at first.
    Layout(Layout),
    /// Put the settings on the right and the plots on the left, or the other way round.
    Swap(bool),
    /// Show or hide what was done.
    History(bool),
    /// Undo or redo up to where there are so many changes to undo.
    GoTo(usize),
    /// Show or hide runs side by side.
    Compare(bool),
    /// Show or hide the study of tolerances.
    Study(bool),
    /// Show or hide what pins carry.
    Pins(bool),
    /// Put these drives, counted from 0, along the axes of joint space, where there are more than three.
    Drives([usize; 3]),
    /// Change what is asked of the machine that is designed.
    Design(DesignCommand),
    /// Change the table of runs.
    Comparison(ComparisonCommand),
    /// Put the second cursor at a time, s, or away.
    Mark(Option<f64>),
    /// Change what plots show.
    Charts(Change),
    /// Put the cursor where a signal to plot is sought.
    LookFor,
    /// Write the plot of a name to a file.
    WritePlot(PathBuf, String, PlotFile),
    /// Write the machine to a file for another program, which its ending names.
    TakeElsewhere(PathBuf),
    /// Show or hide snapshots along the motion.
    Snapshots(bool),
    /// The pointer neither draws nor pushes.
    TakeHold,
    /// Let the pointer push the end effector when it drags it, or no longer.
    Push(bool),
    /// Exaggerate the motion of the base as much as it takes to be seen, or show it as it is.
    Exaggerate(bool),
    /// Let b leave the range that serves the points of the task, and turn the points along with it.
    TurnTask(bool),
    /// Open one of the paper's cases, by name.
    Case(&'static str),
    /// Put the machine back at the start of its planned path.
    BackToPath,
    /// Show why a number that was typed is refused.
    Refuse(String),
    /// Stop what is under way beside the window.
    Cancel(Activity),
    /// Ask whether the window may close with changes that are in no file, or ask no more.
    AskToLeave(bool),
    /// Close the window, after a question if changes are in no file.
    Quit,
    /// Close the window as it is.
    Leave,
    /// What becomes of a session that was left behind.
    Recover(Recovery),
    /// Show no more hints, now and at the next start.
    SkipHints,
    /// Begin the tour, or leave it.
    Tour(bool),
    /// On to its next step, or back.
    TurnTour(bool),
    /// Show or hide the list of commands.
    Find(bool),
    /// Show or hide the keys.
    Help(bool),
    /// Shows what a repaint takes, or no longer.
    Times(bool),
    /// Show or hide the dialog for a file.
    Dialog(Option<FileDialog>),
    /// The next file that is written may take the place of this one: the person has agreed to that.
    Replace(PathBuf),
}

impl Command {
    /// Whether it reads or changes the session, not only how that is shown: it waits while the session is being changed.
    pub(super) fn is_of_session(&self) -> bool {
        match self {
            Self::Edit(_)
            | Self::EndGesture
            | Self::TogglePlay
            | Self::Seek(_)
            | Self::Bookmark(..)
            | Self::NameBookmark(Some(_))
            | Self::ToMark(_)
            | Self::Branch(_)
            | Self::CompareBranch(_)
            | Self::DropBranch(_)
            | Self::Step(_)
            | Self::Open(_)
            | Self::OpenFile(_)
            | Self::Recover(_)
            | Self::SaveFile(_)
            | Self::Replace(_)
            | Self::Record(_)
            | Self::WritePlot(..)
            | Self::TakeElsewhere(_)
            | Self::Undo
            | Self::TakeBack(_)
            | Self::GiveUp
            | Self::GoTo(_)
            | Self::Redo
            | Self::Design(DesignCommand::Take(_))
            | Self::Comparison(ComparisonCommand::Keep | ComparisonCommand::Open(_))
            | Self::Case(_)
            | Self::BackToPath => true,
            Self::Speed(_)
            | Self::Loop(_)
            | Self::View(_)
            | Self::Learn(_)
            | Self::Dexterity(_)
            | Self::Fit
            | Self::Look(_)
            | Self::NameBookmark(None)
            | Self::Reveal(_)
            | Self::LookUp(_)
            | Self::Side(_)
            | Self::Plots(_)
            | Self::Panels(_)
            | Self::Layout(_)
            | Self::Swap(_)
            | Self::History(_)
            | Self::SkipHints
            | Self::AskToLeave(_)
            | Self::Quit
            | Self::Leave
            | Self::Find(_)
            | Self::Theme(_)
            | Self::Preview(_)
            | Self::Draw(_)
            | Self::Compare(_)
            | Self::Study(_)
            | Self::Pins(_)
            | Self::Design(_)
            | Self::Comparison(_)
            | Self::Mark(_)
            | Self::Charts(_)
            | Self::LookFor
            | Self::Snapshots(_)
            | Self::TakeHold
            | Self::Push(_)
            | Self::Exaggerate(_)
            | Self::TurnTask(_)
            | Self::Refuse(_)
            | Self::Cancel(_)
            | Self::Help(_)
            | Self::Tour(_)
            | Self::TurnTour(_)
            | Self::Times(_)
            | Self::Drives(_)
            | Self::Dialog(_) => false,
        }
    }
}

/// What can be under way beside the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Activity {
    /// A change of the session.
    Change,
    /// A session is opened.
    Opening,
    /// The session is saved.
    Saving,
    /// A recording is written.
    Recording,
    /// Machines of a study of tolerances are drawn.
    Study,
    /// The ways of the task run side by side.
    Ways,
    /// A run that is kept beside them.
    Kept,
}

impl Activity {
    /// What it does, for the line at the bottom.
    pub fn words(self) -> &'static str {
        match self {
            Self::Change => "making the run again",
            Self::Opening => "opening",
            Self::Saving => "saving",
            Self::Recording => "recording",
            Self::Study => "drawing machines",
            Self::Ways => "running the ways of the task",
            Self::Kept => "running one more beside them",
        }
    }

    /// Whether it stops when it is told to.
    pub(super) fn can_stop(self) -> bool {
        self != Self::Saving
    }

    /// What to say when it has been cancelled.
    pub(super) fn cancelled(self) -> &'static str {
        match self {
            Self::Change => "cancelled: nothing has changed",
            Self::Opening => "cancelled: nothing was opened",
            Self::Saving => "",
            Self::Recording => "cancelled: no file is left",
            Self::Study => "cancelled: no machines were drawn for the run as it is",
            Self::Ways => "cancelled: the ways of the task were not run again",
            Self::Kept => "cancelled: no run was added",
        }
    }
}

/// What becomes of a session that was left behind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recovery {
    /// It is opened.
    Open,
    /// It is removed.
    Forget,
    /// It is offered again at the next start.
    Later,
}

/// How the camera is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Look {
    /// Around the scene to the right and up, rad; in 2D along it.
    Turn([f64; 2]),
    /// Nearer, so many times.
    Zoom(f64),
}

/// What can be done to the table of runs.
#[derive(Clone, Debug)]
pub enum ComparisonCommand {
    /// Sort by a column, counted from 0.
    Sort(usize),
    /// Draw a row's run in plots and scene, or no longer.
    Show(usize, bool),
    /// Keep the session's own run.
    Keep,
    /// Add a scenario.
    Add(Box<Scenario>),
    /// Take a kept row away.
    Remove(usize),
    /// Open a row's scenario in the session.
    Open(usize),
}

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
            Self::Open => ["Open a session, machine or model", "Open", ".toml .urdf .xml"],
            Self::Save => ["Save the session", "Save", "session.toml"],
            Self::Record => ["Record for the Rerun viewer", "Record", "run.rrd"],
            Self::Machine => ["Take along", "Save", "machine.urdf"],
            Self::Plot(_, PlotFile::Csv) => ["Save the values of the time shown", "Save", "plot.csv"],
            Self::Plot(_, PlotFile::Svg) => ["Save the plot as a drawing", "Save", "plot.svg"],
            Self::Plot(_, PlotFile::Png) => ["Save the plot as a picture", "Save", "plot.png"],
        }
    }
}

impl Purpose {
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
    /// What to do with a file that was named.
    pub fn named(self, file: PathBuf) -> Command {
        match self.purpose {
            Purpose::Open => Command::OpenFile(file),
            Purpose::Save => Command::SaveFile(file),
            Purpose::Record => Command::Record(file),
            Purpose::Plot(plot, kind) => Command::WritePlot(file, plot, kind),
            Purpose::Machine => Command::TakeElsewhere(file),
        }
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

/// What a person asks of the machine that is designed.
#[derive(Clone, Debug)]
pub enum DesignCommand {
    /// Show the counterweights of a machine of the front, by its place, or none.
    Ghost(Option<usize>),
    /// Take them.
    Take(usize),
    /// Take the counterweights and ratios of rotors with which the drives give least to the base.
    TakeStillest,
    /// Tell the machines of the front apart by this, or by nothing more.
    FrontBy(Option<FrontMeasure>),
}
