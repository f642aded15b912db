//! The view state: how the session is displayed, and the state of gestures and dialogs.

use std::sync::Arc;

use super::CameraMove;
use super::export::DisplaySize;
use super::gesture::{DragGesture, HoverTarget, Tool};
use super::layout::{BottomPanel, Layout, WindowArrangement};
use super::open::OpenDialogs;
use super::pair::Pair;
use super::sketching::{Pen, PenTool};
use super::status_message::StatusMessage;
use stillbase_picture::charts::choice::{Plot, PlotChoice};
use stillbase_picture::notation::Notation;
use stillbase_picture::scene::Measure;
use stillbase_picture::scene::camera::Camera;
use stillbase_picture::scene::framing::ViewContent;
use stillbase_picture::scene::measurement::Measurement;
use stillbase_picture::scene::options::Handle;
use stillbase_picture::scene::palette::{Palette, Theme, palette};
use stillbase_picture::scene::views::{ViewKind, Views};
use stillbase_session::scenario::Scenario;
use stillbase_session::{Edit, Session};
use stillbase_simulation::signals::Signal;
use stillbase_study::front_point::FrontMeasure;

/// Framing of a view: whether it shows everything.
#[derive(Clone, Debug, Default)]
pub enum Framing {
    /// To be framed in the next pass.
    #[default]
    Pending,
    /// Framed to this content, in a scene of this width and height under a message of this height, points. A scene of
    /// another size is framed anew; motion of the content does not change the view.
    Framed(Arc<ViewContent>, [f32; 3]),
    /// Moved by the user.
    Manual,
}

impl Framing {
    /// Requests a new framing after another session was opened or the machine changed, unless the user has moved the
    /// view.
    pub fn renew(&mut self) {
        if matches!(self, Self::Framed(..)) {
            *self = Self::Pending;
        }
    }
}

/// The view state, which is not part of the session. Preferences, gestures, dialogs and messages have structures of
/// their own, each with its own lifetime; the other fields last as long as the window.
#[derive(Clone, Debug)]
pub struct ViewState {
    /// Arrangement of the window: a preference of the user.
    pub arrangement: WindowArrangement,
    /// Open dialogs, lists and cards.
    pub open: OpenDialogs,
    /// Messages.
    pub status: StatusMessage,
    /// Problems that hold on, but that the user has put away.
    pub put_away: Vec<String>,
    /// Objects under the pointer.
    pub pointed: HoverTarget,
    /// The drag under way.
    pub gesture: DragGesture,
    /// Tool of the pointer.
    pub tool: Tool,
    /// Distances and angles that the scene shows.
    pub measurements: Vec<Measurement>,
    /// The view on display.
    pub view: ViewKind,
    /// Camera of each view, in the order of [`ViewKind::ALL`].
    pub cameras: [Camera; ViewKind::ALL.len()],
    /// Framing of each view.
    pub framing: [Framing; ViewKind::ALL.len()],
    /// The panel below the scene.
    pub below: Option<BottomPanel>,
    /// Two runs in one view, while they are shown.
    pub pair: Option<Pair>,
    /// The object whose rows the panel of settings must show.
    pub revealed: Option<Handle>,
    /// The path of the setting that the list of all settings must show.
    pub looked_up: Option<String>,
    /// The name of the field that must get the keyboard's focus.
    pub asked_field: Option<&'static str>,
    /// The measure of dexterity that shades the workspace.
    pub dexterity: Option<Measure>,
    /// Requested playback rate, simulated seconds per second.
    pub speed: f64,
    /// Whether the run is played in a loop.
    pub loops: bool,
    /// Time of the second cursor, s.
    pub mark: Option<f64>,
    /// The choice of plots.
    pub charts: PlotChoice,
    /// Whether pin forces are shown.
    pub pins: bool,
    /// Whether snapshots along the motion are shown.
    pub snapshots: bool,
    /// The drives along the axes of joint space, counted from 0, if the machine has more than three.
    pub drives: [usize; 3],
    /// Whether b may leave the interval that is feasible for the points of the task; the points then rotate with b.
    pub turn_task: bool,
    /// Whether dragging the target of a carried block moves in space, and what carries it goes along.
    pub in_space: bool,
    /// Whether the drawn motion of the base is enlarged.
    pub exaggerates_base: bool,
    /// Size of window and scene on display.
    pub displayed: DisplaySize,
    /// Index of the point of the Pareto front whose counterweights are shown.
    pub ghost: Option<usize>,
    /// The measure that colours the points of the Pareto front.
    pub front_by: Option<FrontMeasure>,
    /// The state of drawing, while the design view draws the machine.
    pub pen: Option<Pen>,
}

impl ViewState {
    /// Returns the initial state: a flat view of everything.
    pub fn new(theme: Theme, views: &Views) -> Self {
        Self {
            arrangement: WindowArrangement::with_theme(theme),
            open: OpenDialogs::default(),
            status: StatusMessage::default(),
            put_away: Vec::new(),
            pointed: HoverTarget::default(),
            gesture: DragGesture::default(),
            tool: Tool::default(),
            measurements: Vec::new(),
            view: ViewKind::default(),
            cameras: ViewKind::ALL.map(|kind| views.camera(kind)),
            framing: Default::default(),
            below: None,
            pair: None,
            revealed: None,
            looked_up: None,
            asked_field: None,
            dexterity: None,
            speed: 1.0,
            loops: false,
            mark: None,
            charts: PlotChoice::default(),
            pins: false,
            snapshots: false,
            drives: [0, 1, 2],
            turn_task: false,
            in_space: false,
            exaggerates_base: true,
            displayed: DisplaySize::default(),
            ghost: None,
            front_by: None,
            pen: None,
        }
    }

    /// Returns the colours of the theme.
    pub fn palette(&self) -> Palette {
        palette(self.arrangement.theme)
    }

    /// Returns the state of drawing, if the view on display draws the machine.
    pub fn drawing_pen(&self) -> Option<&Pen> {
        self.pen.as_ref().filter(|_| self.view == ViewKind::Design && self.arrangement.layout != Layout::Present)
    }

    /// Returns how numbers are shown: as the user has chosen, but in the units of a drawing while a machine is drawn.
    pub fn notation(&self) -> Notation {
        let chosen = self.arrangement.notation;
        if self.drawing_pen().is_some() { chosen.of_drawings() } else { chosen }
    }

    /// Begins to draw the machine with a tool.
    pub(super) fn begin_drawing(&mut self, tool: PenTool) {
        self.view = ViewKind::Design;
        self.arrangement.now_mut().side.shown = true;
        self.ghost = None;
        self.pen = Some(Pen { tool, ..Pen::default() });
        self.framing[ViewKind::Design as usize] = Framing::Pending;
    }

    /// Whether a press of the play key pauses: the run moves, is led by hand, or starts over by itself. At the end of a
    /// run the press plays the run again.
    pub fn plays(&self, session: &Session) -> bool {
        let starts_over = self.loops || self.pair.as_ref().is_some_and(|pair| pair.demonstrates);
        session.is_playing() && (session.is_moving() || session.is_dragged() || starts_over)
    }

    /// Returns the plots on display.
    pub fn plots<'a>(&self, scenario: &Scenario, signals: &'a [Signal]) -> Vec<Plot<'a>> {
        self.charts.plots(scenario, signals, self.pins, self.arrangement.notation)
    }

    /// Returns the camera of the view on display.
    pub fn camera(&self) -> &Camera {
        &self.cameras[self.view as usize]
    }

    /// Chooses a layout; choosing the present one again restores its defaults.
    pub(super) fn lay_out(&mut self, layout: Layout) {
        self.arrangement.lay_out(layout);
        self.below = match layout {
            Layout::Explore => self.below.filter(|below| *below != BottomPanel::Runs),
            Layout::Compare => Some(BottomPanel::Runs),
            Layout::Present => None,
        };
        (self.open.history, self.open.naming) = (false, None);
    }

    /// Moves the camera of the view on display.
    pub(super) fn look(&mut self, look: CameraMove) {
        let camera = self.camera_mut();
        match look {
            CameraMove::Turn([right, up]) if camera.is_flat() => camera.pan(-right, up, 1.0),
            CameraMove::Turn([right, up]) => camera.turn(right, up),
            CameraMove::Zoom(factor) => camera.zoom(factor, [0.5, 0.5], 1.0),
        }
    }

    /// Returns the camera for a movement by the user, after which the view no longer shows everything by itself.
    pub(super) fn camera_mut(&mut self) -> &mut Camera {
        self.framing[self.view as usize] = Framing::Manual;
        &mut self.cameras[self.view as usize]
    }
}

/// Returns the edit for a new b, rad, as the view says whether the task turns with it.
pub(super) fn set_b(session: &Session, view_state: &ViewState, b: f64) -> Edit {
    session.edit_of_b(b, view_state.turn_task)
}
