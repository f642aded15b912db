//! Commands of the user: to the session, to its display, and to the window.

use std::path::PathBuf;

use super::activity::Activity;
use super::export::Export;
use super::file_dialog::{FileDialog, FilePurpose, PlotFile};
use super::file_report::FileReport;
use super::given::assess::{TableAction, TableOptions};
use super::guide::GuideStep;
use super::layout::Layout;
use super::notes::NoteDraft;
use super::pair::Pair;
use super::sketching::PenChange;
use super::widgets::RefusedEntry;
use stillbase_mechanics::counterweights::Objective;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::sketch::Template;
use stillbase_picture::charts::choice::PlotChange;
use stillbase_picture::notation::Notation;
use stillbase_picture::scene::Measure;
use stillbase_picture::scene::options::Handle;
use stillbase_picture::scene::palette::Theme;
use stillbase_picture::scene::views::ViewKind;
use stillbase_session::scenario::{Note, Scenario};
use stillbase_session::{Edit, Proposal};
use stillbase_study::front_point::FrontMeasure;

/// A command of the user.
#[derive(Clone, Debug)]
pub enum Command {
    /// Read or change the session; waits while the session is being changed in the background.
    Session(SessionCommand),
    /// Change the view state.
    View(ViewChange),
    /// Change the window, or the work in the background.
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

/// A command that reads or changes the session.
#[derive(Clone, Debug)]
pub enum SessionCommand {
    /// Change the machine, the run or its parameters.
    Edit(Edit),
    /// End the gesture: the next edit gets a new undo entry.
    EndGesture,
    /// Play or pause.
    TogglePlay,
    /// Show an instant, s.
    Seek(f64),
    /// Set or rename the bookmark at a time, s; an empty name removes it.
    Bookmark(f64, String),
    /// Open the field for the name of the bookmark at a time, s; creates the bookmark if there is none.
    NameBookmark(f64),
    /// Write a note in place of the one with this index, or a new one.
    Note(Option<usize>, Note),
    /// Remove the note with this index.
    DropNote(usize),
    /// Show the next mark of the time line (`true`), or the previous one.
    ToMark(bool),
    /// Show the branch of this index; the run on display becomes a branch.
    Branch(usize),
    /// Add a branch to the runs side by side.
    CompareBranch(usize),
    /// Remove a branch.
    DropBranch(usize),
    /// Move by a number of steps, and pause.
    Step(i64),
    /// Lead another block of the assembly, by its place.
    Lead(usize),
    /// Have the b of another block of the assembly, by its place, change against that of the block that is led; or let go.
    Against(Option<usize>),
    /// Open another scenario in place of the session.
    Open(Box<Scenario>),
    /// Open a new drawing of a machine.
    NewDrawing(Template),
    /// Open one of the paper's cases, by name.
    Case(&'static str),
    /// Open a saved session or scenario.
    OpenFile(PathBuf),
    /// Add a table to the measurement on display.
    AddFile(PathBuf),
    /// Answer the question about a session left by an earlier program run.
    Recover(Recovery),
    /// Save the session to its own file, or ask for one.
    Save,
    /// Save the session to a file, which becomes its own.
    SaveFile(PathBuf),
    /// Write a recording for the Rerun viewer.
    Record(PathBuf),
    /// Write the plot of a name to a file.
    WritePlot(PathBuf, String, PlotFile),
    /// Write a picture, a film, values of signals or a report.
    Export(PathBuf, Export),
    /// Write the machine to a file for another program, in the format of its extension.
    TakeElsewhere(PathBuf),
    /// Allow the next write to replace this file: the user has agreed.
    Replace(PathBuf),
    /// Undo the last edit.
    Undo,
    /// Undo the change of a cancelled drag: the last change, if there are more undo entries than this number.
    TakeBack(usize),
    /// Undo the changes of the drag under way.
    GiveUp,
    /// Redo the change undone last.
    Redo,
    /// Undo or redo until the session has this number of undo entries.
    GoTo(usize),
    /// Put the machine back at the start of its planned path.
    BackToPath,
    /// Apply a result of the open table.
    TakeGiven(TableAction),
    /// Apply the counterweights of a point of the Pareto front, by its index.
    Take(usize),
    /// Apply the link lengths found, with their counterweights.
    TakeLengths,
    /// Cut the links from bars, with the counterweights that balance what is cut.
    TakeCut,
    /// Give the links the heights of the layers in which no two parts meet.
    TakeHeights,
    /// Apply the counterweights and rotor ratios with the least Σ |D_k|, kg m², from which the angular momentum
    /// Σ D_k q̇_k of the arm follows.
    TakeStillest,
    /// Add the session's run to the table of runs.
    KeepRun,
    /// Open the scenario of a row of the table of runs.
    OpenRun(usize),
}

/// A panel, a mode or a tool that can be turned on and off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Switch {
    /// The panel of settings.
    Side,
    /// The panel of plots.
    Plots,
    /// Both panels.
    Panels,
    /// Settings on the right and plots on the left.
    Swapped,
    /// The list of changes.
    History,
    /// Runs side by side.
    Compare,
    /// The run on display and another one in one view.
    Pair,
    /// The study of tolerances.
    Study,
    /// The panel of the open table.
    Table,
    /// The pin forces.
    Pins,
    /// Snapshots along the motion.
    Snapshots,
    /// The card of keys.
    Help,
    /// The guide.
    Guide,
    /// All settings in a window of their own.
    Settings,
    /// The display of repaint times.
    Times,
    /// The list of commands.
    Finder,
    /// The equations beside the machine being designed, in place of its balance.
    Equations,
    /// Draw the machine: bars, motors, end effector.
    Sketching,
    /// Play in a loop.
    Loop,
    /// Enlarge the drawn motion of the base so that it can be seen.
    Exaggeration,
    /// Let b leave the interval that is feasible for the points of the task; the points then rotate with b.
    TurnTask,
    /// Dragging the target moves what carries the block, too.
    InSpace,
    /// Shade the workspace by a measure of dexterity.
    Dexterity,
    /// The pointer drags objects: it neither draws nor pushes.
    Holding,
    /// The pointer draws a path.
    Drawing,
    /// Dragging the end effector with the pointer pushes it.
    Pushing,
    /// The pointer measures distances and angles.
    Measuring,
}

/// A change of a [`ViewState`].
///
/// [`ViewState`]: super::ViewState
#[derive(Clone, Debug)]
pub enum ViewChange {
    /// Turn something on or off.
    Switch(Switch, bool),
    /// Show one of the linked views.
    Kind(ViewKind),
    /// Choose a layout; choosing the present one again restores its defaults.
    Layout(Layout),
    /// Light or dark colours.
    Theme(Theme),
    /// Units and names.
    Notation(Notation),
    /// Put a problem message away; what holds on, such as a run that waits, comes back when it changes.
    PutAway(Vec<String>),
    /// Playback rate, simulated seconds per second.
    Speed(f64),
    /// Shade the workspace by this measure of dexterity, or by none.
    Dexterity(Option<Measure>),
    /// Change the state of drawing.
    Pen(PenChange),
    /// Draw the machine, with the keyboard's focus in the field of this name.
    DrawAt(&'static str),
    /// Frame the camera to show everything.
    Fit,
    /// Move the camera.
    Look(CameraMove),
    /// Assign these drives, counted from 0, to the axes of joint space, if there are more than three.
    Drives([usize; 3]),
    /// Set the second cursor at a time, s, or remove it.
    Mark(Option<f64>),
    /// Change the content of the plots.
    Charts(PlotChange),
    /// Preview the posture at the start point A on the plane of another b, rad, or end the preview.
    Preview(Option<f64>),
    /// Show the counterweights of a point of the Pareto front, by its index, or hide them.
    Ghost(Option<usize>),
    /// Colour the points of the Pareto front by this measure, or by none.
    FrontBy(Option<FrontMeasure>),
    /// Show the rows of an object in the panel of settings.
    Reveal(Handle),
    /// Show a setting in the list of all settings, by its path.
    LookUp(String),
    /// Close the field for the name of a bookmark.
    LeaveNaming,
    /// Take a step in the guide; opens it if it is closed.
    Guide(GuideStep),
    /// Show two runs.
    Pair(Pair),
    /// End the search in the guide.
    LeaveGuideSearch,
    /// Open or close the card in which a note is written.
    WriteNote(Option<NoteDraft>),
    /// Remove the measurement with this index, or all.
    DropMeasurement(Option<usize>),
    /// Open or close the file dialog.
    Dialog(Option<FileDialog>),
    /// Open or close the list about a file.
    Report(Option<FileReport>),
    /// Open, change or close the card of options for an export to a file.
    Export(Option<Export>),
}

/// A command to the window, or to the work in the background.
#[derive(Clone, Debug)]
pub enum WindowCommand {
    /// Change the table of runs.
    Comparison(ComparisonCommand),
    /// Assess the open table of samples with these options.
    Ask(TableOptions),
    /// Search for link lengths that minimise this objective within the bounds of the design brief.
    Seek(Objective),
    /// Add or remove Pareto fronts that are drawn beside that of the machine being designed.
    Fronts(FrontsCommand),
    /// Take a file that is not there any more off the list of recent files.
    Forget(PathBuf),
    /// Move the keyboard focus to the search for signals.
    LookFor,
    /// Copy the command that runs the scenario on display.
    CopyCommand,
    /// Take up the file of the session that another program has changed, or keep the session as it is.
    ChangedFile(bool),
    /// Copy a text, and say so.
    Copy(String),
    /// Show why what was typed is refused, with ways out that are known.
    Refuse(String, Vec<Proposal>),
    /// Show why a number is refused that was typed out of its range.
    RefuseEntry(RefusedEntry),
    /// Stop an activity in the background.
    Cancel(Activity),
    /// Open or close the question whether the window may close with unsaved changes.
    AskToLeave(bool),
    /// Close the window, after a question if there are unsaved changes.
    Quit,
    /// Close the window without a question.
    Leave,
    /// Show no more hints, now and at the next start.
    SkipHints,
    /// Begin the hints: the first things to do.
    Hints,
    /// Begin or leave the tour.
    Tour(bool),
    /// Go to the next step of the tour (`true`), or to the previous one.
    TurnTour(bool),
}

/// A change of the Pareto fronts that are drawn beside that of the machine being designed.
#[derive(Clone, Debug)]
pub enum FrontsCommand {
    /// Keep the Pareto front of this machine in its present state.
    Keep,
    /// Add the Pareto front of another machine, with the same design brief.
    Add(Box<Machine>),
    /// Remove a Pareto front, by its index.
    Remove(usize),
}

/// Answers to the question about a session left by an earlier program run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recovery {
    /// Open that session.
    Open,
    /// Remove that session.
    Forget,
    /// Offer that session again at the next start.
    Later,
}

/// A movement of the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CameraMove {
    /// Rotate about the scene to the right and up, rad; in 2D pan by these fractions of the view's height.
    Turn([f64; 2]),
    /// Zoom in by this factor.
    Zoom(f64),
}

/// Changes of the table of runs.
#[derive(Clone, Debug)]
pub enum ComparisonCommand {
    /// Sort by a column, counted from 0.
    Sort(usize),
    /// Draw the run of a row in plots and scene, or not.
    Show(usize, bool),
    /// Add a scenario.
    Add(Box<Scenario>),
    /// Remove a kept row.
    Remove(usize),
}

impl FileDialog {
    /// Returns the command for the file named in the dialog.
    pub fn named(self, file: PathBuf) -> SessionCommand {
        match self.purpose {
            FilePurpose::Open => SessionCommand::OpenFile(file),
            FilePurpose::Add => SessionCommand::AddFile(file),
            FilePurpose::Save => SessionCommand::SaveFile(file),
            FilePurpose::Record => SessionCommand::Record(file),
            FilePurpose::Plot(plot, kind) => SessionCommand::WritePlot(file, plot, kind),
            FilePurpose::Export(wanted) => SessionCommand::Export(file, wanted),
            FilePurpose::Machine => SessionCommand::TakeElsewhere(file),
        }
    }
}
