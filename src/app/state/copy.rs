//! [`DisplayCopy`]: a copy of what the window shows, from which another thread draws pictures.

use super::AppState;
use crate::gesture::{DragGesture, HoverTarget, Tool};
use crate::given::assess::OpenedTable;
use crate::{BottomPanel, OpenDialogs, StatusMessage, ViewState, studio, viewport};
use stillbase_picture::scene::Scene;
use stillbase_picture::scene::camera::Camera;
use stillbase_picture::scene::options::WeightOption;
use stillbase_picture::scene::views::ViewKind;
use stillbase_session::Session;
use stillbase_study::comparison::Comparison;
use stillbase_study::fronts::FrontCase;

/// A copy of session and display, without dialogs, messages and gestures.
pub struct DisplayCopy {
    session: Session,
    view_state: ViewState,
    comparison: Option<Comparison>,
    fronts: Vec<FrontCase>,
    opened_table: Option<OpenedTable>,
    motion_before_drag: Option<[f64; 2]>,
}

impl DisplayCopy {
    /// Simulates the run to its end while `goes_on` returns `true`; `goes_on` gets the fraction done.
    pub fn run_to_end(&mut self, goes_on: &mut dyn FnMut(f64) -> bool) {
        self.session.seek_while(self.session.length(), goes_on);
    }

    /// Opens the copy, with all of its work done at once.
    pub fn open(self) -> AppState {
        let Self { session, view_state, comparison, fronts, opened_table, motion_before_drag } = self;
        let mut app_state = AppState::around(session, view_state.arrangement.theme);
        app_state.view_state = view_state;
        (app_state.comparison, app_state.fronts, app_state.opened_table) = (comparison, fronts, opened_table);
        app_state.motion_before_drag = motion_before_drag;
        app_state.refresh();
        app_state
    }
}

impl AppState {
    /// Copies session and display.
    pub(super) fn copy(&self) -> DisplayCopy {
        let mut session = self.session.clone();
        session.pause();
        let mut view_state = ViewState {
            open: OpenDialogs::default(),
            status: StatusMessage::default(),
            pointed: HoverTarget::default(),
            gesture: DragGesture::default(),
            tool: Tool::default(),
            ..self.view_state.clone()
        };
        // The panel of tolerances is left out, so that a picture does not compute the study again.
        view_state.below = view_state.below.filter(|below| *below != BottomPanel::Tolerances);
        let (comparison, fronts) = (self.comparison.clone(), self.fronts.clone());
        let (opened_table, motion_before_drag) = (self.opened_table.clone(), self.motion_before_drag);
        DisplayCopy { session, view_state, comparison, fronts, opened_table, motion_before_drag }
    }

    /// Returns the scene on display, framed for a picture of a size in points.
    pub(crate) fn still_scene(&mut self, size: [f32; 2]) -> (Scene, Camera) {
        let (exaggeration, weights) = (self.base_exaggeration(), self.chosen_weights());
        let (session, views, comparison) = (&self.session, &*self.views, self.comparison.as_ref());
        let content = viewport::SceneContent {
            session,
            views,
            blocks: self.blocks.as_ref(),
            exaggeration,
            comparison,
            intro: None,
            other: None,
            weights: &weights,
            news: None,
        };
        viewport::still(content, size, &mut self.view_state)
    }

    /// Returns what a picture of a view alone shows.
    pub(crate) fn plain_content(&self) -> viewport::SceneContent<'_> {
        viewport::SceneContent {
            session: &self.session,
            views: &self.views,
            blocks: self.blocks.as_ref(),
            exaggeration: 1.0,
            comparison: None,
            intro: None,
            other: None,
            weights: &[],
            news: None,
        }
    }

    /// Returns the counterweights of the chosen point of the Pareto front, in the design view.
    fn chosen_weights(&self) -> Vec<WeightOption> {
        let Some(point) = self.view_state.ghost.filter(|_| self.view_state.view == ViewKind::Design) else {
            return Vec::new();
        };
        let front_by = self.view_state.front_by;
        studio::DesignFacts::weighed(self.queries(), (&self.session, None), front_by, &self.fronts).weights(point)
    }
}
