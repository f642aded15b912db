//! What a person asks for: of the session, of how it is shown, and of the window itself.

use std::path::PathBuf;

use super::activity::Activity;
use super::file_dialog::{FileDialog, PlotFile, Purpose};
use super::given::assess::{TableOptions, Taking};
use super::layout::Layout;
use crate::mechanics::counterweights::Objective;
use crate::mechanics::machine::Machine;
use crate::picture::charts::choice::Change;
use crate::picture::scene::Measure;
use crate::picture::scene::options::Handle;
use crate::picture::scene::palette::Theme;
use crate::picture::scene::views::ViewKind;
use crate::session::Edit;
use crate::session::scenario::Scenario;
use crate::study::front_point::FrontMeasure;

/// What a person can ask for.
#[derive(Clone, Debug)]
pub enum Command {
    /// Read or change the session; this waits while the session is being changed beside the window.
    Session(SessionCommand),
    /// Change how it is shown.
    View(ViewChange),
    /// What is neither: the window itself, and what works beside it.
    Window(WindowCommand),
}

impl From<SessionCommand> for Command {
    fn from(command: SessionCommand) -> Self {
        Self::Session(command)
    }
}

impl From<ViewChange> for Command {
    fn from(change: ViewChange) -> Self {
        Self::View(change)
    }
}

impl From<WindowCommand> for Command {
    fn from(command: WindowCommand) -> Self {
        Self::Window(command)
    }
}

/// What reads or changes the session.
#[derive(Clone, Debug)]
pub enum SessionCommand {
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
    /// Ask for the name of the bookmark at an instant, s; where there is none it is put there.
    NameBookmark(f64),
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
    /// Replace everything by another scenario.
    Open(Box<Scenario>),
    /// Open one of the paper's cases, by name.
    Case(&'static str),
    /// Open a saved session or scenario.
    OpenFile(PathBuf),
    /// What becomes of a session that was left behind.
    Recover(Recovery),
    /// Save the session.
    SaveFile(PathBuf),
    /// Write a recording for the Rerun viewer.
    Record(PathBuf),
    /// Write the plot of a name to a file.
    WritePlot(PathBuf, String, PlotFile),
    /// Write the machine to a file for another program, which its ending names.
    TakeElsewhere(PathBuf),
    /// The next file that is written may take the place of this one: the person has agreed to that.
    Replace(PathBuf),
    /// Undo the last edit.
    Undo,
    /// Undo what has been done since there were so many changes to undo: what a drag did that is given up.
    TakeBack(usize),
    /// Take back what the drag under way has done.
    GiveUp,
    /// Redo what was undone last.
    Redo,
    /// Undo or redo up to where there are so many changes to undo.
    GoTo(usize),
    /// Put the machine back at the start of its planned path.
    BackToPath,
    /// Take something of what a table says that was opened.
    TakeGiven(Taking),
    /// Take the counterweights of a machine of the front, by its place.
    Take(usize),
    /// Take the lengths that were found, with their counterweights.
    TakeLengths,
    /// Take the counterweights and ratios of rotors with which the drives give least to the base.
    TakeStillest,
    /// Keep the session's own run in the table of runs.
    KeepRun,
    /// Open the scenario of a row of that table in the session.
    OpenRun(usize),
}

/// What is shown or not, done or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Switch {
    /// The panel of settings.
    Side,
    /// The panel of plots.
    Plots,
    /// Both panels, or nothing but the scene.
    Panels,
    /// Settings on the right and plots on the left.
    Swapped,
    /// What was done.
    History,
    /// Runs side by side.
    Compare,
    /// The study of tolerances.
    Study,
    /// What a table says that was opened.
    Table,
    /// What pins carry.
    Pins,
    /// Snapshots along the motion.
    Snapshots,
    /// The keys.
    Help,
    /// What a repaint takes.
    Times,
    /// The list of commands.
    Finder,
    /// The equations beside the machine that is designed, and not its balance.
    Equations,
    /// Play over and over, not once.
    Loop,
    /// Exaggerate the motion of the base as much as it takes to be seen.
    Exaggeration,
    /// Let b leave the range that serves the points of the task, and turn the points along with it.
    TurnTask,
    /// The workspace is shaded by a measure of dexterity.
    Dexterity,
    /// The pointer takes hold of things: it neither draws nor pushes.
    Holding,
    /// The pointer draws a path.
    Drawing,
    /// The pointer pushes the end effector when it drags it.
    Pushing,
}

/// A change of how the session is shown, or of what a person is about to do: no more than a [`ViewState`] knows.
///
/// [`ViewState`]: super::ViewState
#[derive(Clone, Debug)]
pub enum ViewChange {
    /// Turn something on or off.
    Switch(Switch, bool),
    /// Show one of the linked views.
    Kind(ViewKind),
    /// Lay the window out for what it is for now; again: as that is at first.
    Layout(Layout),
    /// Light or dark colours.
    Theme(Theme),
    /// Play faster or slower: simulated seconds a second.
    Speed(f64),
    /// Shade the workspace by a measure of dexterity, or not.
    Dexterity(Option<Measure>),
    /// Point the camera so that everything is seen.
    Fit,
    /// Move the camera.
    Look(Look),
    /// Put these drives, counted from 0, along the axes of joint space, where there are more than three.
    Drives([usize; 3]),
    /// Put the second cursor at a time, s, or away.
    Mark(Option<f64>),
    /// Change what plots show.
    Charts(Change),
    /// Show how A would be held on the plane of another b, rad.
    Preview(Option<f64>),
    /// Show the counterweights of a machine of the front, by its place, or none.
    Ghost(Option<usize>),
    /// Tell the machines of the front apart by this, or by nothing more.
    FrontBy(Option<FrontMeasure>),
    /// Show where in the panel of settings a thing of the scene stands.
    Reveal(Handle),
    /// Show a setting there, by its path.
    LookUp(String),
    /// Ask for the name of a bookmark no longer.
    LeaveNaming,
    /// Show or hide the dialog for a file.
    Dialog(Option<FileDialog>),
}

/// What is asked of the window itself, and of what works beside it.
#[derive(Clone, Debug)]
pub enum WindowCommand {
    /// Change the table of runs.
    Comparison(ComparisonCommand),
    /// Read the table that was opened so, and ask this of it.
    Ask(TableOptions),
    /// Seek lengths with which this is least, as the brief has them.
    Seek(Objective),
    /// Change which fronts are drawn beside that of the machine that is designed.
    Fronts(FrontsCommand),
    /// Put the cursor where a signal to plot is sought.
    LookFor,
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
    /// Show no more hints, now and at the next start.
    SkipHints,
    /// Begin the tour, or leave it.
    Tour(bool),
    /// On to its next step, or back.
    TurnTour(bool),
}

/// Which fronts are drawn beside that of the machine that is designed.
#[derive(Clone, Debug)]
pub enum FrontsCommand {
    /// That of this machine stays as it is now.
    Keep,
    /// That of another machine, asked as this one is.
    Add(Box<Machine>),
    /// One is taken away, by its place.
    Remove(usize),
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
    /// Add a scenario.
    Add(Box<Scenario>),
    /// Take a kept row away.
    Remove(usize),
}

impl FileDialog {
    /// What to do with a file that was named.
    pub fn named(self, file: PathBuf) -> SessionCommand {
        match self.purpose {
            Purpose::Open => SessionCommand::OpenFile(file),
            Purpose::Save => SessionCommand::SaveFile(file),
            Purpose::Record => SessionCommand::Record(file),
            Purpose::Plot(plot, kind) => SessionCommand::WritePlot(file, plot, kind),
            Purpose::Machine => SessionCommand::TakeElsewhere(file),
        }
    }
}
