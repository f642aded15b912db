//! How the session is shown, and what a person is about to do.

use std::sync::Arc;

use super::Look;
use super::gesture::{Gesture, Pointed, Tool};
use super::layout::{Arrangement, Below, Layout};
use super::open::Open;
use super::said::Said;
use crate::picture::charts::choice::Choice;
use crate::picture::scene::Measure;
use crate::picture::scene::camera::Camera;
use crate::picture::scene::framing::Content;
use crate::picture::scene::options::Handle;
use crate::picture::scene::palette::{Palette, Theme, palette};
use crate::picture::scene::views::{ViewKind, Views};
use crate::session::{Edit, Session};
use crate::study::front_point::FrontMeasure;

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

/// How things are shown: no part of the session. Its parts live as long as a person's liking, a gesture, a dialog, a
/// message; what stands here itself lives as long as the window.
#[derive(Clone, Debug)]
pub struct ViewState {
    /// How the window is arranged: remembered from one start to the next.
    pub arrangement: Arrangement,
    /// What lies open over it.
    pub open: Open,
    /// What it says.
    pub said: Said,
    /// What the pointer is over.
    pub pointed: Pointed,
    /// The drag under way.
    pub gesture: Gesture,
    /// What dragging in the scene does.
    pub tool: Tool,
    /// Which of the linked views.
    pub view: ViewKind,
    /// From where each view is seen, in the order of [`ViewKind::ALL`].
    pub cameras: [Camera; ViewKind::ALL.len()],
    /// Which of them show everything.
    pub framing: [Framing; ViewKind::ALL.len()],
    /// What is on display below the scene.
    pub below: Option<Below>,
    /// What is to be shown in the panel of settings.
    pub revealed: Option<Handle>,
    /// The setting that is to be shown there, by its path.
    pub looked_up: Option<String>,
    /// The workspace is shaded by this measure.
    pub dexterity: Option<Measure>,
    /// Simulated seconds a second.
    pub speed: f64,
    /// The run is played over and over.
    pub loops: bool,
    /// The second cursor, s.
    pub mark: Option<f64>,
    /// What plots show.
    pub charts: Choice,
    /// What pins carry is on display.
    pub pins: bool,
    /// Snapshots along the motion are on display.
    pub snapshots: bool,
    /// The drives along the axes of joint space, counted from 0, where there are more than three.
    pub drives: [usize; 3],
    /// b may leave the range that serves the points of the task, and turns them along.
    pub turn_task: bool,
    /// The motion of the base is shown enlarged.
    pub exaggerates_base: bool,
    /// The machine of the front whose counterweights are shown, by its place.
    pub ghost: Option<usize>,
    /// What its machines are told apart by beside mass and inertia.
    pub front_by: Option<FrontMeasure>,
}

impl ViewState {
    /// A flat view of everything.
    pub fn new(theme: Theme, views: &Views) -> Self {
        Self {
            arrangement: Arrangement::usual(theme),
            open: Open::default(),
            said: Said::default(),
            pointed: Pointed::default(),
            gesture: Gesture::default(),
            tool: Tool::default(),
            view: ViewKind::default(),
            cameras: ViewKind::ALL.map(|kind| views.camera(kind)),
            framing: Default::default(),
            below: None,
            revealed: None,
            looked_up: None,
            dexterity: None,
            speed: 1.0,
            loops: false,
            mark: None,
            charts: Choice::default(),
            pins: false,
            snapshots: false,
            drives: [0, 1, 2],
            turn_task: false,
            exaggerates_base: true,
            ghost: None,
            front_by: None,
        }
    }

    /// Colours.
    pub fn palette(&self) -> Palette {
        palette(self.arrangement.theme)
    }

    /// The view in use.
    pub fn camera(&self) -> &Camera {
        &self.cameras[self.view as usize]
    }

    /// Lays the window out; again: as that layout is at first.
    pub(super) fn lay_out(&mut self, layout: Layout) {
        self.arrangement.lay_out(layout);
        self.below = match layout {
            Layout::Explore => self.below.filter(|below| *below != Below::Runs),
            Layout::Compare => Some(Below::Runs),
            Layout::Present => None,
        };
        (self.open.history, self.open.naming) = (false, None);
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
