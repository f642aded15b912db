//! How the session is shown, and what a person is about to do.

use std::sync::Arc;

use crate::app::layout::{Layout, Panel, Panels};
use crate::app::tour::Tour;
use crate::app::{FileDialog, Look};
use crate::picture::charts::choice::Choice;
use crate::picture::scene::Measure;
use crate::picture::scene::camera::Camera;
use crate::picture::scene::framing::Content;
use crate::picture::scene::options::{Handle, Refused};
use crate::picture::scene::palette::{Palette, Theme, palette};
use crate::picture::scene::pick::Pick;
use crate::picture::scene::views::{ViewKind, Views};
use crate::planning::reactionless::Decimal;
use crate::session::{Edit, Refusal, Session};
use crate::study::front_point::FrontMeasure;

/// An edit that was refused.
#[derive(Clone, Debug)]
pub struct RefusedEdit {
    /// The curve that was asked for, and where it stops.
    pub curve: Option<Arc<Refused>>,
    /// The same with another b, rad, that would do, as it is shown.
    pub remedy: Option<(Edit, Decimal)>,
}

impl RefusedEdit {
    pub(super) fn of(edit: &Edit, refusal: &Refusal) -> Self {
        let curve = Refused::of(refusal);
        let remedy = edit.part("task").zip(refusal.mending_b().zip(refusal.shown_b())).map(|(change, (b, shown))| {
            let mut change = change.clone();
            change.insert("b".into(), b.into());
            (Edit::of("task", change), shown)
        });
        Self { curve: curve.map(Arc::new), remedy }
    }
}

/// What is typed into the list, and which line is chosen.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Finder {
    /// A few letters.
    pub sought: String,
    /// Counted from the top.
    pub chosen: usize,
}

/// Whether a view shows everything.
#[derive(Clone, Debug, Default)]
pub enum Framing {
    /// It is to, from the next pass on.
    #[default]
    Wanted,
    /// It does, of what there was when it was asked for, in a scene of this size: a scene of another size is framed
    /// anew, while what moves in it moves nothing else.
    Held(Arc<Content>, [f32; 2]),
    /// A hand has moved it.
    Free,
}

impl Framing {
    /// After another session was opened, or another machine taken: what was not moved by hand shows everything.
    pub fn renew(&mut self) {
        if matches!(self, Self::Held(..)) {
            *self = Self::Wanted;
        }
    }
}

/// How things are shown: no part of the session.
#[derive(Clone, Debug)]
pub struct ViewState {
    /// Light or dark.
    pub theme: Theme,
    /// What the window is for just now.
    pub layout: Layout,
    /// The panels of the layouts that are not on display, in their order.
    pub(super) kept: [Panels; 3],
    /// Settings stand on the right and plots on the left.
    pub swapped: bool,
    /// What was done is on display.
    pub history: bool,
    /// The panel of settings is shown, and how wide it is liked.
    pub side: Panel,
    /// The panel of plots.
    pub plots: Panel,
    /// Which of the linked views.
    pub view: ViewKind,
    /// From where each view is seen, in the order of [`ViewKind::ALL`].
    pub cameras: [Camera; ViewKind::ALL.len()],
    /// Which of them show everything.
    pub framing: [Framing; ViewKind::ALL.len()],
    /// The workspace is shaded by this measure.
    pub dexterity: Option<Measure>,
    /// Simulated seconds a second.
    pub speed: f64,
    /// The run is played over and over.
    pub loops: bool,
    /// What the pointer is over.
    pub hot: Option<Handle>,
    /// What has its place in the panel under the pointer or the keyboard.
    pub lit: Option<Handle>,
    /// The links that a term under the pointer comes from.
    pub lit_links: Vec<usize>,
    /// What is to be shown in the panel.
    pub revealed: Option<Handle>,
    /// The setting that is to be shown there, by its path.
    pub looked_up: Option<String>,
    /// What is being dragged.
    pub grabbed: Option<Pick>,
    /// What was under the pointer when its button went down: it may have moved on before the drag is noticed.
    pub pressed: Option<Pick>,
    /// Where the pointer was last in this drag, and by how much what is dragged stays behind it since Shift was held,
    /// points of the screen.
    pub fine: [egui::Vec2; 2],
    /// Where the pointer holds the target, m.
    pub held: Option<[f64; 2]>,
    /// The force at the end effector before a hand pushes, N.
    pub force: Option<[f64; 2]>,
    /// The table of runs is on display.
    pub compare: bool,
    /// The study of tolerances is on display.
    pub study: bool,
    /// The machine of the front whose counterweights are shown, by its place.
    pub ghost: Option<usize>,
    /// What its machines are told apart by beside mass and inertia.
    pub front_by: Option<FrontMeasure>,
    /// The equations stand beside the machine that is designed, and not its balance.
    pub learns: bool,
    /// What pins carry is on display.
    pub pins: bool,
    /// The drives along the axes of joint space, counted from 0, where there are more than three.
    pub drives: [usize; 3],
    /// The instant of the bookmark whose name is asked for, s.
    pub naming: Option<f64>,
    /// The second cursor, s.
    pub mark: Option<f64>,
    /// What plots show.
    pub charts: Choice,
    /// Snapshots along the motion are on display.
    pub snapshots: bool,
    /// The keys are on display.
    pub help: bool,
    /// The tour, while it is under way.
    pub tour: Option<Tour>,
    /// What a repaint takes is on display.
    pub times: bool,
    /// The list of commands, while it is on display.
    pub finder: Option<Finder>,
    /// A file is being asked for.
    pub dialog: Option<FileDialog>,
    /// The present drag has changed something.
    pub dragged: bool,
    /// How many changes there were to undo when it began.
    pub undone_to: usize,
    /// What has been drawn so far, m; none while nobody draws.
    pub stroke: Option<Vec<[f64; 2]>>,
    /// Dragging the end effector pushes it.
    pub pushing: bool,
    /// b may leave the range that serves the points of the task, and turns them along.
    pub turn_task: bool,
    /// The motion of the base is shown enlarged.
    pub exaggerates_base: bool,
    /// How many times that motion has to be enlarged to be seen.
    pub enough_exaggeration: f64,
    /// The b under the pointer in the chart of which b, rad.
    pub preview: Option<f64>,
    /// What was asked for last and refused.
    pub refused: Option<RefusedEdit>,
    /// The last thing to say, and whether it is bad news.
    pub message: Option<(String, bool)>,
    /// The message is of a branch that was left: a button leads back to it.
    pub left_branch: bool,
}

impl ViewState {
    /// A flat view of everything.
    pub fn new(theme: Theme, views: &Views) -> Self {
        Self {
            theme,
            layout: Layout::Explore,
            kept: Layout::ALL.map(Panels::usual),
            swapped: false,
            history: false,
            side: Panel::usual(true),
            plots: Panel::usual(true),
            view: ViewKind::default(),
            cameras: ViewKind::ALL.map(|kind| views.camera(kind)),
            framing: Default::default(),
            dexterity: None,
            speed: 1.0,
            loops: false,
            hot: None,
            lit: None,
            lit_links: Vec::new(),
            revealed: None,
            looked_up: None,
            grabbed: None,
            pressed: None,
            fine: [egui::Vec2::ZERO; 2],
            held: None,
            force: None,
            compare: false,
            study: false,
            ghost: None,
            front_by: None,
            learns: false,
            pins: false,
            drives: [0, 1, 2],
            naming: None,
            mark: None,
            charts: Choice::default(),
            snapshots: false,
            help: false,
            tour: None,
            times: false,
            finder: None,
            dialog: None,
            dragged: false,
            undone_to: 0,
            stroke: None,
            pushing: false,
            turn_task: false,
            exaggerates_base: true,
            enough_exaggeration: 1.0,
            preview: None,
            refused: None,
            message: None,
            left_branch: false,
        }
    }

    /// Colours.
    pub fn palette(&self) -> Palette {
        palette(self.theme)
    }

    /// How many times the motion of the base is shown.
    pub fn base_exaggeration(&self) -> f64 {
        if self.exaggerates_base { self.enough_exaggeration } else { 1.0 }
    }

    /// The view in use.
    pub fn camera(&self) -> &Camera {
        &self.cameras[self.view as usize]
    }

    /// The panels of a layout, on display or not.
    pub fn panels(&self, layout: Layout) -> Panels {
        let now = Panels { side: self.side, plots: self.plots, compare: self.compare };
        if layout == self.layout { now } else { self.kept[layout as usize] }
    }

    /// Lays the window out; again: as that layout is at first.
    pub(super) fn lay_out(&mut self, layout: Layout) {
        let again = layout == self.layout;
        self.kept[self.layout as usize] = self.panels(self.layout);
        let usual = Panels::usual(layout);
        let panels = if again || layout == Layout::Present { usual } else { self.kept[layout as usize] };
        (self.layout, self.side, self.plots, self.compare) = (layout, panels.side, panels.plots, usual.compare);
        self.study &= layout == Layout::Explore;
        (self.history, self.naming) = (false, None);
    }

    /// Moves the camera of the view in use.
    pub(super) fn look(&mut self, look: Look) {
        let camera = self.camera_mut();
        match look {
            Look::Turn([right, up]) if camera.is_flat() => camera.pan(-right, up, 1.0),
            Look::Turn([right, up]) => camera.turn(right, up),
            Look::Zoom(factor) => camera.zoom(factor, [0.5, 0.5], 1.0),
        }
    }

    /// The camera, for a hand that moves it.
    pub(super) fn camera_mut(&mut self) -> &mut Camera {
        self.framing[self.view as usize] = Framing::Free;
        &mut self.cameras[self.view as usize]
    }
}

/// The edit that a slider of b asks for: while time runs, that the machine follows it; paused, that it is put on the
/// plane b, or on the nearest one that serves the points of the task unless these may turn along.
pub(super) fn set_b(session: &Session, view_state: &ViewState, b: f64) -> Edit {
    if session.is_playing() && session.is_at_end() {
        return Edit::SlideB { b };
    }
    let stays = |b: f64| session.serving(b).unwrap_or(b);
    Edit::PoseB { b: if session.is_led() || view_state.turn_task { b } else { stays(b) } }
}
