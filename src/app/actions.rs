//! The table of actions: name, keys, place in the window, and command. The keyboard, the list of commands and the card
//! of keys are made from this table.

use egui::{Key, KeyboardShortcut, Modifiers};

use super::command::CameraMove;
use super::export::{Export, PictureForm, RowForm};
use super::sketching::fields;
use super::theme::other;
use super::{
    BottomPanel, Command, FileDialog, FilePurpose, Layout, NoteDraft, PlotFile, SessionCommand, Switch, ViewChange,
    ViewState, WindowCommand, set_b,
};
use stillbase_mechanics::sketch::Template;
use stillbase_picture::charts::choice::PlotChange;
use stillbase_picture::notation::Notation;
use stillbase_picture::scene::Measure;
use stillbase_picture::scene::views::{ViewKind, Views};
use stillbase_session::scenario::{NoteTime, Scenario};
use stillbase_session::{Edit, Session};
use stillbase_simulation::signals::signals;

/// A command with a name.
pub struct Action {
    /// The group in which it is listed.
    pub group: ActionGroup,
    /// Its name in lists.
    pub name: &'static str,
    /// Further search words.
    pub also: &'static str,
    /// Its keys; the first is shown.
    pub keys: &'static [KeyboardShortcut],
    /// Its place in the window.
    pub place: &'static str,
    /// The switch that it toggles, if any.
    pub switch: Option<Switch>,
    /// Returns its command in the present state, or `None` while it has no effect. Without this function, the action
    /// toggles its switch.
    command_fn: Option<fn(&Session, &ViewState) -> Option<Command>>,
}

impl Action {
    /// Returns its name without explanation, for a menu.
    pub fn title(&self) -> &'static str {
        self.name.split([':', ';']).next().unwrap_or(self.name)
    }

    /// Returns its command in the present state; `None` while it has no effect.
    pub fn command(&self, session: &Session, view_state: &ViewState) -> Option<Command> {
        let other = |switch| view_state.has(switch, session).then(|| view_state.other(switch));
        match self.command_fn {
            Some(command) => command(session, view_state),
            None => self.switch.and_then(other),
        }
    }
}

/// Groups of actions, in the order in which they are listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActionGroup {
    /// Time.
    Run,
    /// The machine and its task.
    Task,
    /// The display.
    View,
    /// Analyses.
    Analysis,
    /// New sessions and files to open.
    Open,
    /// Files of the session.
    Save,
    /// Results and machines for other programs.
    Export,
    /// The end of the program.
    Quit,
    /// History and help.
    Help,
}

impl ActionGroup {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Run,
        Self::Task,
        Self::View,
        Self::Analysis,
        Self::Open,
        Self::Save,
        Self::Export,
        Self::Quit,
        Self::Help,
    ];

    /// Returns the heading, which groups of one menu share.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Run => "Run",
            Self::Task => "Machine and task",
            Self::View => "View",
            Self::Analysis => "Analysis",
            Self::Open | Self::Save | Self::Export | Self::Quit => "File",
            Self::Help => "History and help",
        }
    }
}

const fn on(modifiers: Modifiers, key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(modifiers, key)
}

const PLAIN: Modifiers = Modifiers::NONE;
const SHIFT: Modifiers = Modifiers::SHIFT;
const CTRL: Modifiers = Modifiers::COMMAND;
const CTRL_SHIFT: Modifiers = Modifiers::COMMAND.plus(SHIFT);
const ALT: Modifiers = Modifiers::ALT;

/// Displacement of the target by one key press without and with Shift, m.
const TARGET_STEP_M: f64 = 0.01;
const FINE_TARGET_STEP_M: f64 = 0.001;
/// Change of b by one key press without and with Shift, rad.
const B_STEP_RAD: f64 = 0.01;
const FINE_B_STEP_RAD: f64 = 0.001;
/// Rotation of the view by one key press, rad (in 2D its displacement, a fraction of the view's height), and zoom
/// factor.
const VIEW_TURN_RAD: f64 = 0.1;
const ZOOM_FACTOR: f64 = 1.15;

/// Moves the target by a displacement, m.
fn nudge(session: &Session, [x, y]: [f64; 2]) -> Option<Command> {
    session.run().pose_space().ok()?;
    let now = session.frame().target.at;
    Some(Command::Session(SessionCommand::Edit(Edit::DragTarget { x: now.re + x, y: now.im + y })))
}

/// Changes b by an amount, rad.
fn turn(session: &Session, view_state: &ViewState, by: f64) -> Option<Command> {
    session.run().pose_space().ok()?;
    Some(Command::Session(SessionCommand::Edit(set_b(session, view_state, session.b_aim() + by))))
}

fn case(view_state: &ViewState, i: usize) -> Option<Command> {
    // In the design view, a digit beside a field was meant for the field.
    if view_state.view == ViewKind::Design {
        return None;
    }
    Scenario::cases().nth(i).map(|it| Command::Session(SessionCommand::Case(it)))
}

fn dialog(session: &Session, purpose: FilePurpose) -> Option<Command> {
    Some(Command::View(ViewChange::Dialog(Some(FileDialog::suggest(session, purpose)))))
}

/// Opens the card of options for an export to a file.
fn export(wanted: Export) -> Option<Command> {
    Some(Command::View(ViewChange::Export(Some(wanted))))
}

/// Opens the present machine and task as a new session without edits.
fn new_session(session: &Session) -> Option<Command> {
    Some(Command::Session(SessionCommand::Open(Box::new(session.scenario().without_edits()))))
}

/// Opens the dialog that saves the first plot to a file.
fn plot_file(session: &Session, view_state: &ViewState, file: PlotFile) -> Option<Command> {
    let signals = signals(&session.scenario().machine);
    let plots = view_state.plots(session.scenario(), &signals);
    dialog(session, FilePurpose::Plot(plots.first()?.name.clone(), file))
}

/// Zooms the time range of the plots about the instant on display by a factor; without a factor, shows the whole run.
fn charts(session: &Session, view_state: &ViewState, factor: Option<f64>) -> Option<Command> {
    let (extent, chosen) = (super::plots::extent(session), view_state.charts.range);
    let range = match factor {
        Some(factor) => extent.zoomed(extent.shown(chosen), session.frame().time, factor),
        None => extent.all(chosen),
    };
    Some(Command::View(ViewChange::Charts(PlotChange::Range(range))))
}

/// Shows the next view, or the 2D view if the machine lacks the next one.
fn next_view(session: &Session, view_state: &ViewState) -> Option<Command> {
    let next = view_state.view.next();
    let has = Views::has(next, session.run()).is_ok();
    Some(Command::View(ViewChange::Kind(if has { next } else { ViewKind::Flat })))
}

/// Shows the joint space or the tower of workspaces, if the machine has them.
fn view_of_planes(session: &Session, view_state: &ViewState, kind: ViewKind) -> Option<Command> {
    Views::has(kind, session.run()).ok()?;
    view(view_state, kind)
}

/// Draws the machine, with the keyboard's focus in a field.
fn draw_at(session: &Session, view_state: &ViewState, field: &'static str) -> Option<Command> {
    view_state.has(Switch::Sketching, session).then_some(Command::View(ViewChange::DrawAt(field)))
}

/// Returns the command if the present view shows the machine.
fn of_machine(view_state: &ViewState, command: Command) -> Option<Command> {
    view_state.view.shows_machine().then_some(command)
}

macro_rules! actions {
    ($($group:ident, $name:literal $(= $also:literal)?, [$($key:expr),*], $place:literal
        $(turns $switch:ident)? $(, $command:expr)?;)+) => {
        &[$(Action {
            group: ActionGroup::$group, name: $name, also: concat!($($also)?), keys: &[$($key),*], place: $place,
            switch: actions!(@of Switch $($switch)?), command_fn: actions!(@option $($command)?),
        }),+]
    };
    (@of $kind:ident) => { None };
    (@of $kind:ident $of:ident) => { Some($kind::$of) };
    (@option) => { None };
    (@option $value:expr) => { Some($value) };
}

/// Every action.
pub const ACTIONS: &[Action] = actions![
    Run, "Play, pause, start over" = "run start stop animate simulate go animation again", [on(PLAIN, Key::Space)], "top bar", |_, _| Some(Command::Session(SessionCommand::TogglePlay));
    Run, "One step on" = "forward next frame advance", [on(PLAIN, Key::ArrowRight)], "top bar", |_, _| Some(Command::Session(SessionCommand::Step(1)));
    Run, "One step back" = "previous frame backward", [on(PLAIN, Key::ArrowLeft)], "keyboard", |_, _| Some(Command::Session(SessionCommand::Step(-1)));
    Run, "Ten steps on" = "forward skip", [on(SHIFT, Key::ArrowRight)], "keyboard", |_, _| Some(Command::Session(SessionCommand::Step(10)));
    Run, "Ten steps back" = "backward skip", [on(SHIFT, Key::ArrowLeft)], "keyboard", |_, _| Some(Command::Session(SessionCommand::Step(-10)));
    Run, "To the start" = "rewind reset beginning", [on(PLAIN, Key::Home)], "top bar", |_, _| Some(Command::Session(SessionCommand::Seek(0.0)));
    Run, "To the newest instant" = "end last finish latest now", [on(PLAIN, Key::End)], "keyboard", |s, _| Some(Command::Session(SessionCommand::Seek(s.length())));
    Run, "Add or remove a bookmark here" = "remember mark pin note flag", [on(PLAIN, Key::K)], "time line", |s, _| {
        let time = s.frame().time;
        let name = if s.bookmark_at(time).is_some() { String::new() } else { s.free_name() };
        Some(Command::Session(SessionCommand::Bookmark(time, name)))
    };
    Run, "Name the bookmark here" = "rename label", [on(SHIFT, Key::K)], "time line, right button", |s, v| {
        (v.arrangement.layout != Layout::Present).then(|| Command::Session(SessionCommand::NameBookmark(s.frame().time)))
    };
    Run, "Write a note at this instant" = "comment text annotate label remark", [on(SHIFT, Key::W)], "time line, right button", |s, _| {
        Some(Command::View(ViewChange::WriteNote(Some(NoteDraft::new(None, NoteTime::At(s.frame().time), None)))))
    };
    Run, "To the next mark: bookmark, note, event, branch" = "jump", [on(PLAIN, Key::N)], "time line", |_, _| {
        Some(Command::Session(SessionCommand::ToMark(true)))
    };
    Run, "To the mark before" = "previous jump", [on(SHIFT, Key::N)], "time line", |_, _| Some(Command::Session(SessionCommand::ToMark(false)));
    Run, "The newest branch; again: back", [on(PLAIN, Key::G)], "history", |s, _| {
        s.branch_count().checked_sub(1).map(|it| Command::Session(SessionCommand::Branch(it)))
    };
    Run, "Compare with the newest branch" = "difference", [on(SHIFT, Key::G)], "history", |s, _| {
        s.branch_count().checked_sub(1).map(|it| Command::Session(SessionCommand::CompareBranch(it)))
    };
    Run, "Play in a loop; only the time range of the plots, if one was chosen" = "loop repeat cycle", [on(PLAIN, Key::O)], "top bar, loop" turns Loop;
    Export, "Copy as command line" = "shell terminal script cli simulate", [on(CTRL_SHIFT, Key::C)], "top bar, File", |_, _| Some(Command::Window(WindowCommand::CopyCommand));
    Run, "Twice as slow" = "speed slow motion slower rate", [on(PLAIN, Key::Comma)], "top bar, speed", |_, v| slower(v);
    Run, "Twice as fast" = "speed faster speed up rate quick", [on(PLAIN, Key::Period)], "top bar, speed", |_, v| faster(v);

    Task, "The paper's case 1, as it is in the paper" = "example demo straight line", [on(PLAIN, Key::Num1)], "top bar, scenario", |_, v| case(v, 0);
    Task, "The paper's case 2, as it is in the paper" = "example demo", [on(PLAIN, Key::Num2)], "top bar, scenario", |_, v| case(v, 1);
    Task, "The paper's case 3, as it is in the paper" = "example demo reactionless", [on(PLAIN, Key::Num3)], "top bar, scenario", |_, v| case(v, 2);
    Task, "Put the machine back on its planned path" = "reset return stop leading by hand release undo drag", [on(PLAIN, Key::B)], "left panel", |s, _| {
        s.is_dragged().then_some(Command::Session(SessionCommand::BackToPath))
    };
    Task, "Target to the right by 10 mm; Shift: by 1 mm" = "move tip end effector goal", [on(CTRL, Key::ArrowRight)], "scene", |s, _| {
        nudge(s, [TARGET_STEP_M, 0.0])
    };
    Task, "Target to the left by 10 mm; Shift: by 1 mm" = "move tip end effector goal", [on(CTRL, Key::ArrowLeft)], "scene", |s, _| {
        nudge(s, [-TARGET_STEP_M, 0.0])
    };
    Task, "Target up by 10 mm; Shift: by 1 mm" = "move tip end effector goal", [on(CTRL, Key::ArrowUp)], "scene", |s, _| nudge(s, [0.0, TARGET_STEP_M]);
    Task, "Target down by 10 mm; Shift: by 1 mm" = "move tip end effector goal", [on(CTRL, Key::ArrowDown)], "scene", |s, _| {
        nudge(s, [0.0, -TARGET_STEP_M])
    };
    Task, "Turn b forward by 0.01 rad; Shift: by 0.001 rad" = "pose constant plane", [on(PLAIN, Key::CloseBracket)], "left panel", |s, v| {
        turn(s, v, B_STEP_RAD)
    };
    Task, "Turn b back by 0.01 rad; Shift: by 0.001 rad" = "pose constant plane", [on(PLAIN, Key::OpenBracket)], "left panel", |s, v| {
        turn(s, v, -B_STEP_RAD)
    };
    Task, "Turn the task along with b" = "rotate points", [], "left panel" turns TurnTask;
    Task, "Lead the end effector in space, with what carries it" = "spatial target chain", [], "left panel" turns InSpace;
    Task, "Draw a path with the pointer" = "curve freehand sketch trajectory", [on(PLAIN, Key::P)], "tool bar" turns Drawing;
    Task, "Push the end effector with the pointer" = "force disturb poke load kick", [on(PLAIN, Key::U)], "tool bar" turns Pushing;

    View, "The next view: 2D, 3D, joint space, tower, design" = "camera change switch", [on(PLAIN, Key::V)], "tool bar", |s, v| {
        next_view(s, v)
    };
    View, "2D: the machine from above" = "flat top camera plan", [], "tool bar", |_, v| view(v, ViewKind::Flat);
    View, "3D: the machine in space" = "perspective orbit camera rotate", [], "tool bar", |_, v| view(v, ViewKind::Space);
    View, "Joint space" = "configuration plane q", [], "tool bar", |s, v| view_of_planes(s, v, ViewKind::Joints);
    View, "Tower of workspaces" = "b height stack", [], "tool bar", |s, v| view_of_planes(s, v, ViewKind::Tower);
    View, "Design: masses, centres of mass, lengths and counterweights" = "balance edit machine links trim", [on(PLAIN, Key::D)], "tool bar", |_, v| {
        Some(Command::View(ViewChange::Kind(if v.view == ViewKind::Design { ViewKind::Flat } else { ViewKind::Design })))
    };
    View, "Equations of the paper with today's numbers, beside the design view" = "learn formulas theory math mathematics", [on(PLAIN, Key::E)], "design view, tab" turns Equations;
    View, "Draw the machine: bars, motors, end effector" = "sketch edit new link pin", [on(SHIFT, Key::D)], "design view, Draw" turns Sketching;
    View, "Draw a bar by numbers: from a pin, length and angle" = "sketch new link keyboard add type", [], "drawing, left panel", |s, v| {
        draw_at(s, v, fields::BAR_LENGTH)
    };
    View, "Hang a motor on a pin, by name" = "sketch draw new drive keyboard add joint actuator", [], "drawing, left panel", |s, v| {
        draw_at(s, v, fields::MOTOR_PIN)
    };
    View, "Put the end effector on a pin, by name" = "sketch draw tip tool keyboard", [], "drawing, left panel", |s, v| {
        draw_at(s, v, fields::END_PIN)
    };
    View, "Choose a bar or a pin of the drawing, by name" = "sketch draw card select edit link joint keyboard length angle", [], "drawing, left panel", |s, v| {
        draw_at(s, v, fields::CARD)
    };
    View, "Show everything" = "fit frame zoom home centre center reset camera view lost find", [on(PLAIN, Key::F)], "tool bar", |_, _| Some(Command::View(ViewChange::Fit));
    View, "Zoom in" = "bigger nearer magnify", [on(PLAIN, Key::Plus), on(PLAIN, Key::Equals)], "scene, wheel", |_, _| {
        Some(Command::View(ViewChange::Look(CameraMove::Zoom(ZOOM_FACTOR))))
    };
    View, "Zoom out" = "smaller farther", [on(PLAIN, Key::Minus)], "scene, wheel", |_, _| Some(Command::View(ViewChange::Look(CameraMove::Zoom(1.0 / ZOOM_FACTOR))));
    View, "Plots closer to the instant shown", [on(ALT, Key::Plus), on(ALT, Key::Equals)], "plots, Ctrl wheel", |s, v| {
        charts(s, v, Some(1.5))
    };
    View, "Plots from farther away", [on(ALT, Key::Minus)], "plots, Ctrl wheel", |s, v| charts(s, v, Some(1.0 / 1.5));
    View, "Plots show all time" = "reset zoom range whole", [on(ALT, Key::Num0)], "plots, double click", |s, v| charts(s, v, None);
    View, "Turn or pan the view left" = "rotate camera move", [on(ALT, Key::ArrowLeft)], "scene, drag", |_, _| look(-VIEW_TURN_RAD, 0.0);
    View, "Turn or pan the view right" = "rotate camera move", [on(ALT, Key::ArrowRight)], "scene, drag", |_, _| look(VIEW_TURN_RAD, 0.0);
    View, "Turn or pan the view up" = "rotate camera move", [on(ALT, Key::ArrowUp)], "scene, drag", |_, _| look(0.0, VIEW_TURN_RAD);
    View, "Turn or pan the view down" = "rotate camera move", [on(ALT, Key::ArrowDown)], "scene, drag", |_, _| look(0.0, -VIEW_TURN_RAD);
    View, "Shade the workspace by dexterity, one measure after the other" = "manipulability heat map colour color shading singularity", [on(PLAIN, Key::J)], "tool bar" turns Dexterity,
        |_, v| of_machine(v, Command::View(ViewChange::Dexterity(Measure::after(v.dexterity))));
    View, "Snapshots along the motion" = "ghost poses strobe", [on(PLAIN, Key::S)], "tool bar" turns Snapshots;
    View, "Exaggerate the motion of the base, or show it as it is" = "enlarge magnify shake", [on(PLAIN, Key::X)], "left panel, base" turns Exaggeration;
    View, "Panel of settings, shown or hidden" = "left sidebar parameters options preferences properties", [on(PLAIN, Key::Num8)], "tool bar, layout" turns Side;
    View, "Panel of plots, shown or hidden" = "right sidebar charts graphs", [on(PLAIN, Key::Num9)], "tool bar, layout" turns Plots;
    View, "All settings in a window of their own" = "every key parameter list", [], "left panel" turns Settings;
    View, "Nothing but the scene, or all panels" = "full screen hide", [on(PLAIN, Key::Num0)], "keyboard" turns Panels;
    View, "Settings and plots change sides" = "swap left right", [on(PLAIN, Key::Num4)], "tool bar, layout" turns Swapped;
    View, "Explore: settings, scene and plots" = "layout default normal", [on(PLAIN, Key::Num5)], "tool bar, layout", |_, _| {
        Some(Command::View(ViewChange::Layout(Layout::Explore)))
    };
    View, "Compare: scene, wide plots and the runs side by side" = "layout", [on(PLAIN, Key::Num6)], "tool bar, layout", |_, _| {
        Some(Command::View(ViewChange::Layout(Layout::Compare)))
    };
    View, "Present: the scene alone, what counts in large type" = "presentation slides talk full screen projector lecture fullscreen", [on(PLAIN, Key::Num7)], "tool bar, layout", |_, _| {
        Some(Command::View(ViewChange::Layout(Layout::Present)))
    };
    View, "Time that a repaint takes, shown or hidden" = "fps performance frame rate", [on(PLAIN, Key::F12)], "keyboard" turns Times;
    View, "Light or dark" = "theme night mode colours color white black background appearance", [on(PLAIN, Key::L)], "top bar", |_, v| Some(Command::View(ViewChange::Theme(other(v.arrangement.theme))));

    View, "Angles in degrees or radians" = "unit units deg rad angle", [], "tool bar, layout", |_, v| notation(v, |shown| {
        shown.angle = shown.angle.other();
    });
    View, "Lengths in millimetres or metres" = "unit units mm length size", [], "tool bar, layout", |_, v| notation(v, |shown| {
        shown.length = shown.length.other();
    });
    View, "Plain terms first, or the paper's symbols" = "names notation greek words", [], "tool bar, layout", |_, v| notation(v, |shown| {
        shown.names = shown.names.other();
    });

    Task, "Use the heights of the layers: no part meets another" = "stack links height axial collide collision order plates workshop", [], "design view, layers", |s, _| {
        (s.scenario().machine.links().len() > 1).then_some(Command::Session(SessionCommand::TakeHeights))
    };

    Analysis, "The same task done in other ways, side by side" = "compare alternatives table difference versus runs", [on(PLAIN, Key::C)], "tool bar" turns Compare;
    Analysis, "Shake and still: two runs side by side" = "compare split contrast straight line vibration beside demo machine branch double", [on(PLAIN, Key::Y)], "scene" turns Pair;
    Analysis, "Add this run to the runs side by side", [], "side by side", |_, v| {
        (v.below == Some(BottomPanel::Runs)).then_some(Command::Session(SessionCommand::KeepRun))
    };
    Analysis, "Tolerances: what the bases of many machines feel, and the spectrum" = "monte carlo errors scatter manufacturing frequency jitter vibration fft uncertainty random", [on(PLAIN, Key::T)],
        "tool bar" turns Study;
    Analysis, "A table: a motion of your own, or a measured machine" = "import trim csv samples measurement", [on(PLAIN, Key::W)], "tool bar" turns Table;
    Analysis, "Inside the machine: what the pins carry" = "forces joints bearings loads stress strength bearing", [on(PLAIN, Key::I)], "tool bar" turns Pins;
    Analysis, "Measure: distance and angle" = "ruler length dimension protractor caliper", [on(SHIFT, Key::M)], "tool bar" turns Measuring;
    Analysis, "Remove all measures" = "clear ruler distance angle", [], "scene, Delete on each", |_, v| {
        (!v.measurements.is_empty()).then_some(Command::View(ViewChange::DropMeasurement(None)))
    };
    Analysis, "Plot any signal" = "chart graph curve add torque velocity acceleration momentum", [on(PLAIN, Key::A)], "below the plots", |_, _| Some(Command::Window(WindowCommand::LookFor));
    Analysis, "Statistics of the time that plots show" = "mean average maximum minimum rms", [], "menu of a plot", |_, v| {
        Some(Command::View(ViewChange::Charts(PlotChange::Statistics(!v.charts.statistics))))
    };
    Analysis, "Add or remove a second cursor here" = "measure difference delta", [on(PLAIN, Key::M)], "plots, Shift click", |s, v| {
        Some(Command::View(ViewChange::Mark(v.mark.is_none().then(|| s.frame().time))))
    };

    Help, "Undo" = "back revert", [on(CTRL, Key::Z)], "keyboard", |s, _| s.undo_title().map(|_| Command::Session(SessionCommand::Undo));
    Help, "Redo" = "again forward repeat", [on(CTRL, Key::Y), on(CTRL_SHIFT, Key::Z)], "keyboard", |s, _| s.redo_title().map(|_| Command::Session(SessionCommand::Redo));
    Help, "History: what was done, to go back and forth in" = "log changes branches undo", [on(PLAIN, Key::H)], "tool bar" turns History;
    Open, "Draw a new machine from nothing" = "new machine sketch create own linkage bars template", [], "top bar, machine", |_, _| Some(Command::Session(SessionCommand::NewDrawing(Template::Blank)));
    Open, "Draw a serial arm of two bars" = "new machine sketch create own linkage bars template", [], "top bar, machine", |_, _| Some(Command::Session(SessionCommand::NewDrawing(Template::SerialOfTwo)));
    Open, "Draw a serial arm of three bars" = "new machine sketch create own linkage bars template", [], "top bar, machine", |_, _| Some(Command::Session(SessionCommand::NewDrawing(Template::SerialOfThree)));
    Open, "Draw a parallelogram arm" = "new machine sketch create own linkage bars template", [], "top bar, machine", |_, _| Some(Command::Session(SessionCommand::NewDrawing(Template::ParallelogramArm)));
    Open, "Draw a pantograph" = "new machine sketch create own linkage bars template", [], "top bar, machine", |_, _| Some(Command::Session(SessionCommand::NewDrawing(Template::Pantograph)));
    Open, "Draw a SCARA with belts" = "new machine sketch create own linkage bars template", [], "top bar, machine", |_, _| Some(Command::Session(SessionCommand::NewDrawing(Template::ScaraWithBelts)));
    Open, "Draw the nine links of the paper" = "new machine sketch create own linkage bars template", [], "top bar, machine", |_, _| Some(Command::Session(SessionCommand::NewDrawing(Template::NineLinks)));
    Open, "New session: this machine and its task, nothing done yet" = "start over fresh clear reset blank", [],
        "top bar, File", |s, _| new_session(s);
    Open, "Open: a session, scenario, machine, model or table" = "load file import machine model urdf mjcf xml toml csv recent", [on(CTRL, Key::O)], "top bar, File", |s, _| dialog(s, FilePurpose::Open);
    Save, "Save" = "store file keep toml session", [on(CTRL, Key::S)], "top bar, File", |_, _| Some(Command::Session(SessionCommand::Save));
    Save, "Save as" = "store file export toml keep copy name session", [on(CTRL_SHIFT, Key::S)], "top bar, File", |s, _| dialog(s, FilePurpose::Save);
    Quit, "Quit; asks first if changes are in no file" = "exit close leave", [on(CTRL, Key::Q)], "window frame", |_, _| Some(Command::Window(WindowCommand::Quit));
    Export, "Values of the first plot as CSV or Parquet" = "export table data numbers spreadsheet excel signals save", [],
        "menu of a plot", |s, v| plot_file(s, v, PlotFile::Values(RowForm::Csv));
    Export, "Picture of the first plot as PNG" = "image export screenshot figure save", [], "menu of a plot",
        |s, v| plot_file(s, v, PlotFile::Picture(PictureForm::Png));
    Export, "Drawing of the first plot as SVG" = "picture image vector export figure save", [], "menu of a plot",
        |s, v| plot_file(s, v, PlotFile::Picture(PictureForm::Svg));
    Export, "Picture of the scene or the whole window: PNG, WebP, SVG or PDF" = "image export screenshot snapshot figure save transparent outlines vector print", [on(CTRL, Key::E)], "top bar, File", |_, v| {
        export(Export::picture(v.arrangement.theme))
    };
    Export, "Film of the run: GIF, animated PNG or WebP, MP4 or pictures" = "movie video animation export mp4 webp frames save transparent", [on(CTRL_SHIFT, Key::E)], "top bar, File", |_, v| {
        export(Export::film(v.arrangement.theme))
    };
    Export, "Values of signals as CSV or Parquet" = "export table data numbers spreadsheet excel columns save", [], "top bar, File", |_, _| export(Export::values());
    Export, "Report as HTML: machine, task, verdicts and plots" = "print page document pdf summary export save", [on(CTRL, Key::P)], "top bar, File", |s, _| {
        dialog(s, FilePurpose::Export(Export::Report))
    };
    Export, "Save the machine as a file of its own" = "toml own write drawn", [], "design", |s, _| {
        Some(Command::View(ViewChange::Dialog(Some(FileDialog::of_machine(s)))))
    };
    Export, "Take the machine elsewhere: MJCF, URDF, DXF…" = "export cad mujoco ros robot svg csv parts list write", [], "design", |s, _| dialog(s, FilePurpose::Machine);
    Save, "Record for the Rerun viewer" = "rrd video capture export movie", [on(PLAIN, Key::R)], "top bar", |s, _| dialog(s, FilePurpose::Record);
    Help, "Find a command" = "palette search help how menu", [on(CTRL, Key::K)], "top bar" turns Finder;
    Help, "Tour: what this is about, in seven steps" = "tutorial introduction learn guide start help", [], "?", |_, v| Some(Command::Window(WindowCommand::Tour(v.open.tour.is_none())));
    Help, "Hints: the first three things to do" = "help tutorial start begin beginner first learn introduction", [], "?", |_, _| Some(Command::Window(WindowCommand::Hints));
    Help, "Guide: what all this is and how it is used" = "help manual documentation handbook read pages learn explain how", [on(PLAIN, Key::F2)], "?" turns Guide;
    Help, "Keys and gestures" = "shortcuts help keyboard", [on(PLAIN, Key::F1)], "top bar, ?" turns Help;
];

/// Actions of keys with Shift, which change the target and b by finer steps.
pub const FINE_ACTIONS: &[Action] = actions![
    Task, "", [on(CTRL_SHIFT, Key::ArrowRight)], "", |s, _| nudge(s, [FINE_TARGET_STEP_M, 0.0]);
    Task, "", [on(CTRL_SHIFT, Key::ArrowLeft)], "", |s, _| nudge(s, [-FINE_TARGET_STEP_M, 0.0]);
    Task, "", [on(CTRL_SHIFT, Key::ArrowUp)], "", |s, _| nudge(s, [0.0, FINE_TARGET_STEP_M]);
    Task, "", [on(CTRL_SHIFT, Key::ArrowDown)], "", |s, _| nudge(s, [0.0, -FINE_TARGET_STEP_M]);
    Task, "", [on(SHIFT, Key::CloseBracket), on(SHIFT, Key::CloseCurlyBracket)], "", |s, v| turn(s, v, FINE_B_STEP_RAD);
    Task, "", [on(SHIFT, Key::OpenBracket), on(SHIFT, Key::OpenCurlyBracket)], "", |s, v| turn(s, v, -FINE_B_STEP_RAD);
];

/// Gestures of the pointer, and their effects.
pub const GESTURES: [(&str, &str); 25] = [
    ("drag the target", "the machine follows on its plane"),
    ("drag a link", "its drive turns, the others follow so that b stays"),
    ("drag a link, four drives or more", "it follows the pointer, the tip and b stay"),
    ("drag A, B, 1 …", "move a point of the path; where the target covers it, drag its name"),
    ("double click", "add a point to the path"),
    ("Delete", "leave out the point under the pointer"),
    ("drag the b ring", "the workspace turns"),
    ("drag plane, slice", "change b, in joint space and in the tower"),
    ("Alt drag", "push the end effector, 20 N for each metre"),
    ("Shift or Ctrl in a drag", "a tenth of the movement; round numbers"),
    ("click a thing", "its rows in the panel"),
    ("right button", "what can be done with the thing or the place there; write a note"),
    ("click a note", "change or remove it"),
    (
        "measure: click two points",
        "their distance; a third: the angle at the second; Enter, Esc; Delete over it removes it",
    ),
    ("drag elsewhere", "pan in 2D, else orbit; Shift pans"),
    ("wheel", "zoom"),
    (
        "click a mark of the time line",
        "show that instant; right button: a bookmark's name, a note, the list of branches",
    ),
    ("click a plot", "show that instant"),
    ("Ctrl wheel, drag on a plot", "closer to a time, and along; a double click shows all"),
    ("drag the numbers of a plot", "along its values; there Ctrl wheel, or Alt wheel on the plot: closer"),
    ("Shift drag on a plot", "plots show this time"),
    ("drag a plot's heading", "another place; out of the panel: a window of its own"),
    ("right button on a plot", "its menu: curves, statistics, CSV, Parquet, SVG, PNG"),
    ("Shift click a plot", "a second cursor: plots show differences; Esc takes it away"),
    ("Esc", "close what is open, cancel a drag"),
];

fn view(view_state: &ViewState, kind: ViewKind) -> Option<Command> {
    (view_state.view != kind).then_some(Command::View(ViewChange::Kind(kind)))
}

/// Returns the command for a change of units or names.
fn notation(view_state: &ViewState, change: fn(&mut Notation)) -> Option<Command> {
    let mut notation = view_state.arrangement.notation;
    change(&mut notation);
    Some(Command::View(ViewChange::Notation(notation)))
}

fn look(right: f64, up: f64) -> Option<Command> {
    Some(Command::View(ViewChange::Look(CameraMove::Turn([right, up]))))
}

/// The selectable playback rates, simulated seconds per second.
pub const SPEEDS: [f64; 6] = [0.05, 0.1, 0.25, 0.5, 1.0, 2.0];

fn slower(view_state: &ViewState) -> Option<Command> {
    SPEEDS.into_iter().rev().find(|speed| *speed < view_state.speed).map(|it| Command::View(ViewChange::Speed(it)))
}

fn faster(view_state: &ViewState) -> Option<Command> {
    SPEEDS.into_iter().find(|speed| *speed > view_state.speed).map(|it| Command::View(ViewChange::Speed(it)))
}

/// Returns the first key of the action of this name, if it has one.
pub fn key_of(action: &str) -> Option<String> {
    ACTIONS.iter().find(|known| known.name == action)?.keys.first().map(shortcut_label)
}

/// Returns the first key of the action that toggles this switch, if it has one.
pub fn key_of_switch(switch: Switch) -> Option<String> {
    ACTIONS.iter().find(|known| known.switch == Some(switch))?.keys.first().map(shortcut_label)
}

/// Returns the label of a keyboard shortcut, such as `Ctrl K`.
pub fn shortcut_label(key: &KeyboardShortcut) -> String {
    let m = key.modifiers;
    let held = [(m.command || m.ctrl, "Ctrl "), (m.alt, "Alt "), (m.shift, "Shift ")];
    let held: String = held.into_iter().filter(|(held, _)| *held).map(|(_, word)| word).collect();
    held + match key.logical_key {
        Key::ArrowLeft => "←",
        Key::ArrowRight => "→",
        Key::ArrowUp => "↑",
        Key::ArrowDown => "↓",
        Key::Comma => ",",
        Key::Period => ".",
        Key::OpenBracket => "[",
        Key::CloseBracket => "]",
        Key::Minus => "−",
        Key::Plus | Key::Equals => "+",
        other => other.name(),
    }
}
