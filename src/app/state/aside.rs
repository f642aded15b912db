//! The person's own session, set aside while the tour or the hints show a scene of their own.

use std::sync::Arc;

use super::AppState;
use crate::background::Opening;
use crate::change::SessionSource;
use crate::given::assess::OpenedTable;
use crate::intro::Intro;
use crate::pair::Pair;
use crate::saved_runs::SavedRuns;
use crate::saving::Saving;
use crate::tour::Tour;
use crate::{Activity, Command, Layout, SessionCommand, Switch, ViewChange, ViewState, WindowCommand};
use stillbase_picture::scene::views::Views;
use stillbase_query::Query;
use stillbase_session::scenario::Scenario;
use stillbase_session::{Edit, Session};
use stillbase_study::comparison::Comparison;
use stillbase_study::fronts::FrontCase;
use stillbase_study::lengths::LengthsQuery;

/// A session with its display, as it was when a lesson (the tour or the hints) began.
pub(super) struct SetAside {
    pub session: Session,
    pub view_state: ViewState,
    pub saving: Saving,
    views: Arc<Views>,
    comparison: Option<Comparison>,
    runs: SavedRuns,
    fronts: Vec<FrontCase>,
    seeking: Option<<LengthsQuery as Query>::Input>,
    opened_table: Option<OpenedTable>,
}

/// Work whose result belongs to the session on display, so that a lesson cannot begin before its end.
const WORK_OF_SESSION: [Activity; 4] = [Activity::Change, Activity::Opening, Activity::Saving, Activity::ExtraRun];

impl AppState {
    /// The person's own session: the one on display, or the one set aside while the tour or the hints are on display.
    pub fn own_session(&self) -> &Session {
        self.aside.as_ref().map_or(&self.session, |aside| &aside.session)
    }

    /// The view state of the person's own session.
    pub(super) fn own_view_state(&self) -> &ViewState {
        self.aside.as_ref().map_or(&self.view_state, |aside| &aside.view_state)
    }

    /// The record of changes of the person's own session.
    pub(super) fn own_saving(&self) -> &Saving {
        self.aside.as_ref().map_or(&self.saving, |aside| &aside.saving)
    }

    /// The user's part of the table of runs of the person's own session.
    pub(super) fn own_runs(&self) -> SavedRuns {
        match &self.aside {
            Some(aside) => SavedRuns::all(aside.comparison.as_ref(), &aside.runs),
            None => SavedRuns::all(self.comparison.as_ref(), &self.runs),
        }
    }

    /// Sets the person's own session aside; what is done from now on does not touch it.
    ///
    /// # Errors
    /// If the session is being changed, opened or saved, or one more run for the table of runs is under way.
    fn set_aside(&mut self) -> Result<(), String> {
        self.hand_back();
        if let Some(work) = WORK_OF_SESSION.into_iter().find(|work| self.background.runs(*work)) {
            return Err(format!("{}: want that to end first", work.words()));
        }
        self.session.end_gesture();
        let mut view_state = self.view_state.clone();
        (view_state.open.help, view_state.open.finder, view_state.open.dialog) = (false, None, None);
        view_state.status = crate::StatusMessage::default();
        let saving = Saving { recent: self.saving.recent.clone(), ..Saving::default() };
        self.aside = Some(Box::new(SetAside {
            session: self.session.clone(),
            view_state,
            saving: std::mem::replace(&mut self.saving, saving),
            views: self.views.clone(),
            comparison: self.comparison.take(),
            runs: std::mem::take(&mut self.runs),
            fronts: std::mem::take(&mut self.fronts),
            seeking: self.seeking.take(),
            opened_table: self.opened_table.take(),
        }));
        self.view_state.below = None;
        self.session.pause();
        Ok(())
    }

    /// Ends the tour or the hints and shows the person's own session again, as it was. Returns whether one was set aside:
    /// the hints of the first start set none aside.
    pub(super) fn hand_back(&mut self) -> bool {
        let hints = self.intro.take().is_some();
        let Some(aside) = self.aside.take() else {
            self.view_state.open.tour = None;
            self.view_state.pair = self.view_state.pair.take().filter(|pair| !pair.demonstrates);
            return false;
        };
        // Work that the lesson has begun ends with it.
        for work in WORK_OF_SESSION {
            self.background.stop(work);
        }
        let mut arrangement = aside.view_state.arrangement.clone();
        match hints {
            true => arrangement.clone_from(&self.view_state.arrangement),
            false => arrangement.theme = self.view_state.arrangement.theme,
        }
        let guide = self.view_state.open.guide.take();
        let old = std::mem::replace(&mut self.session, aside.session);
        self.background.free(old, &self.session);
        self.view_state = aside.view_state;
        (self.view_state.arrangement, self.view_state.open.guide) = (arrangement, guide);
        let leaves = self.saving.leaves;
        self.saving = Saving { leaves, ..aside.saving };
        (self.views, self.comparison, self.fronts) = (aside.views, aside.comparison, aside.fronts);
        (self.seeking, self.opened_table, self.runs) = (aside.seeking, aside.opened_table, aside.runs);
        (self.designed_from, self.branch_message, self.due_s) = (None, None, 0.0);
        self.motion_before_drag = None;
        self.run_ahead();
        self.refresh();
        true
    }

    /// Begins the tour in a scene of its own.
    ///
    /// # Errors
    /// If the session is being changed, opened or saved, or one more run for the table of runs is under way.
    pub(super) fn begin_tour(&mut self) -> Result<(), String> {
        self.set_aside()?;
        let mut view_state = ViewState::new(self.view_state.arrangement.theme, &self.views);
        view_state.open.guide = self.view_state.open.guide.take();
        self.view_state = view_state;
        let tour = Tour::begin(&self.session);
        self.show_tour(tour);
        Ok(())
    }

    /// Shows a step of the tour in its scene.
    pub(super) fn show_tour(&mut self, tour: Tour) {
        self.background.stop(Activity::Change);
        let (scenario, instead) = tour.scene(self.own_session());
        self.view_state.view = Default::default();
        self.view_state.open.tour = Some(tour);
        self.open(SessionSource::Scenario(Box::new(scenario)), Opening { instead, ..Opening::default() });
    }

    /// Begins the hints on the machine on display, with its task as it was opened.
    ///
    /// # Errors
    /// If the session is being changed, opened or saved, or one more run for the table of runs is under way.
    pub(super) fn begin_hints(&mut self) -> Result<(), String> {
        self.set_aside()?;
        self.view_state.lay_out(Layout::Explore);
        if !self.view_state.view.shows_machine() {
            self.view_state.view = Default::default();
        }
        let (has_planes, edited) =
            (self.session.can_be_dragged(), self.session.undo_count() > 0 || !self.session.script().is_empty());
        self.view_state.pair = has_planes.then(Pair::demonstration);
        self.intro = Some(Intro::of(&self.session));
        if edited {
            let scenario: Scenario = self.session.scenario().without_edits();
            self.open(SessionSource::Scenario(Box::new(scenario)), Opening { plays: true, ..Opening::default() });
        } else {
            self.session.seek(0.0);
            self.session.play();
        }
        self.refresh();
        Ok(())
    }

    /// Whether a command ends the lesson before it is carried out, because it is about the person's own session.
    pub(super) fn ends_lesson(&self, command: &Command) -> bool {
        if self.aside.is_none() {
            return false;
        }
        let is_of_files = match command {
            Command::Session(command) => matches!(
                command,
                SessionCommand::OpenFile(_)
                    | SessionCommand::AddFile(_)
                    | SessionCommand::Save
                    | SessionCommand::Export(..)
                    | SessionCommand::Recover(_)
                    | SessionCommand::SaveFile(_)
                    | SessionCommand::Record(_)
                    | SessionCommand::WritePlot(..)
                    | SessionCommand::TakeElsewhere(_)
                    | SessionCommand::Replace(_)
            ),
            Command::View(change) => matches!(change, ViewChange::Dialog(Some(_)) | ViewChange::Export(Some(_))),
            Command::Window(command) => matches!(
                command,
                WindowCommand::Quit
                    | WindowCommand::Leave
                    | WindowCommand::AskToLeave(true)
                    | WindowCommand::ChangedFile(_)
                    | WindowCommand::CopyCommand
            ),
        };
        let is_held = self.view_state.gesture.grabbed.is_some();
        is_of_files || (self.intro.is_some() && !is_held && !is_of_hints(command))
    }
}

/// Whether a command may belong to what the hints ask for; anything else is work of the person's own.
fn is_of_hints(command: &Command) -> bool {
    match command {
        Command::Session(command) => match command {
            SessionCommand::Edit(edit) => !matches!(edit, Edit::Set { .. }),
            SessionCommand::EndGesture
            | SessionCommand::TogglePlay
            | SessionCommand::Seek(_)
            | SessionCommand::Step(_)
            | SessionCommand::ToMark(_)
            | SessionCommand::Undo
            | SessionCommand::Redo
            | SessionCommand::TakeBack(_)
            | SessionCommand::GiveUp
            | SessionCommand::BackToPath => true,
            _ => false,
        },
        Command::View(change) => match change {
            ViewChange::Switch(
                Switch::Drawing | Switch::Pushing | Switch::Compare | Switch::Study | Switch::Table,
                on,
            ) => !on,
            ViewChange::Switch(Switch::Equations | Switch::Pair, _) | ViewChange::Reveal(_) | ViewChange::LookUp(_) => {
                false
            }
            ViewChange::Layout(layout) => *layout == Layout::Explore,
            ViewChange::Kind(view) => view.shows_machine(),
            _ => true,
        },
        Command::Window(command) => {
            !matches!(command, WindowCommand::LookFor | WindowCommand::Seek(_) | WindowCommand::Fronts(_))
        }
    }
}
