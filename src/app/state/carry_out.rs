//! Execution of commands.

use super::AppState;
use crate::background::Opening;
use crate::change::{SessionChange, SessionSource};
use crate::given::TableView;
use crate::guide::{GuidePlace, GuideStep};
use crate::marks;
use crate::pair::Pair;
use crate::{Command, FileDialog, FilePurpose, PenTool, SessionCommand, Switch, ViewChange, WindowCommand};
use stillbase_mechanics::sketch::Template;
use stillbase_picture::scene::beside::BesideQuery;
use stillbase_picture::scene::views::ViewKind;
use stillbase_session::{for_template, session_command};

/// Message at the end of the tour.
const HANDED_BACK: &str = "the tour is over: your session is as it was";

impl AppState {
    /// Carries out one command, after all earlier ones. A command that fails changes nothing, and a message says why.
    /// Session commands wait while the session is being changed in the background.
    pub fn carry_out(&mut self, command: impl Into<Command>) {
        self.collect();
        self.catch_up();
        let mut command = command.into();
        if self.ends_lesson(&command) {
            self.hand_back();
            // The name that the dialog proposes is that of the person's own session.
            if let Command::View(ViewChange::Dialog(Some(dialog))) = &mut command {
                *dialog = FileDialog::suggest(&self.session, dialog.purpose.clone());
            }
        }
        match command {
            Command::Session(command) if self.background.is_changing() => {
                let edits = matches!(command, SessionCommand::Edit(_));
                self.view_state.gesture.dragged |= self.view_state.gesture.grabbed.is_some() && edits;
                self.background.enqueue(command);
            }
            command => self.do_now(command),
        }
    }

    pub(super) fn do_now(&mut self, command: Command) {
        let done = self.attempt(command);
        self.show_outcome(done);
        self.refresh();
    }

    /// Carries out the commands that waited for a change of the session, until one of them starts a change in the
    /// background.
    pub(super) fn catch_up(&mut self) {
        while self.background.change.is_none() {
            let Some(command) = self.background.waiting_commands.pop_front() else { return };
            self.do_now(command.into());
        }
    }

    fn attempt(&mut self, command: Command) -> Result<Option<String>, String> {
        match command {
            Command::Session(command) => self.do_to_session(command),
            // Without an open table, the file dialog opens, so that the user can choose one.
            Command::View(ViewChange::Switch(Switch::Table, true)) if self.opened_table.is_none() => {
                self.view_state.open.dialog = Some(FileDialog::suggest(&self.session, FilePurpose::Open));
                Ok(None)
            }
            Command::View(ViewChange::Switch(Switch::Guide, true)) => {
                let found = self.assessed();
                let answer = found.as_ref().map(|(answer, _)| &**answer);
                let table = self.opened_table.as_ref();
                let table = table.and_then(|table| TableView { table, answer, is_known: true }.content());
                let place = GuidePlace::of_display(&self.view_state, table);
                self.view_state.apply(ViewChange::Guide(GuideStep::Go(place)));
                Ok(None)
            }
            Command::View(ViewChange::Switch(Switch::Pair, true)) => {
                self.view_state.pair = Some(Pair::of(&self.session));
                Ok(None)
            }
            Command::View(change) => {
                if matches!(change, ViewChange::Pair(_)) {
                    // Until the new run is made, no earlier run may be shown under its title.
                    self.queries().forget::<BesideQuery>();
                }
                let designs = matches!(
                    change,
                    ViewChange::Kind(ViewKind::Design)
                        | ViewChange::DrawAt(_)
                        | ViewChange::Switch(Switch::Equations | Switch::Sketching, true)
                );
                self.view_state.apply(change);
                // The run pauses while its machine is designed.
                if designs {
                    self.session.pause();
                }
                Ok(None)
            }
            Command::Window(command) => self.do_to_window(command),
        }
    }

    fn do_to_session(&mut self, command: SessionCommand) -> Result<Option<String>, String> {
        match command {
            SessionCommand::Edit(edit) => {
                let edit = self.with_balance(edit)?;
                self.view_state.status.refused = None;
                self.change(SessionChange::Edit(edit));
                self.view_state.gesture.dragged |=
                    self.view_state.gesture.grabbed.is_some() && self.view_state.status.refused.is_none();
            }
            SessionCommand::EndGesture => {
                self.session.end_gesture();
                self.designed_from = None;
                let said = self.branch_message.take();
                self.view_state.status.left_branch |= said.is_some();
                return Ok(said);
            }
            SessionCommand::TogglePlay if self.view_state.plays(&self.session) => self.session.pause(),
            SessionCommand::TogglePlay => self.session.play(),
            SessionCommand::Seek(time) => self.change(SessionChange::Seek(time)),
            SessionCommand::Bookmark(time, name) => {
                let done = self.session.bookmark(time, &name)?;
                self.saving.changes += u64::from(done.is_some());
                return Ok(done);
            }
            SessionCommand::Note(known, note) => {
                let done = self.session.write_note(known, note)?;
                self.saving.changes += u64::from(done.is_some());
                return Ok(done);
            }
            SessionCommand::DropNote(index) => {
                let done = self.session.remove_note(index);
                self.saving.changes += u64::from(done.is_some());
                return Ok(done);
            }
            SessionCommand::NameBookmark(time) => self.name_bookmark(time)?,
            SessionCommand::ToMark(on) => {
                if let Some(time) = marks::neighbour(self.queries(), &self.session, on) {
                    self.change(SessionChange::Seek(time));
                }
            }
            SessionCommand::Branch(branch) => self.change(SessionChange::Branch(branch)),
            SessionCommand::CompareBranch(branch) => self.compare_branch(branch),
            SessionCommand::DropBranch(branch) => {
                let done = self.session.drop_branch(branch);
                self.saving.changes += u64::from(done.is_some());
                return Ok(done);
            }
            SessionCommand::Step(steps) => self.session.step_by(steps),
            SessionCommand::Lead(block) => self.lead(block)?,
            SessionCommand::Against(block) => self.bind_b(block)?,
            SessionCommand::Open(scenario) => {
                self.open(SessionSource::Scenario(scenario), Opening { plays: true, ..Opening::default() });
            }
            SessionCommand::NewDrawing(template) => {
                let scenario = for_template(self.session.scenario(), template);
                self.open(SessionSource::Scenario(Box::new(scenario)), Opening::default());
                let tool = if template == Template::Blank { PenTool::Bar } else { PenTool::Move };
                self.view_state.begin_drawing(tool);
            }
            SessionCommand::Case(name) => self.open_case(name),
            SessionCommand::OpenFile(path) => self.open_file(path),
            SessionCommand::AddFile(path) => self.add_file(path)?,
            SessionCommand::Recover(what) => self.recover(what),
            SessionCommand::Save => match self.saving.own_file(self.session.undo_count()).cloned() {
                Some(file) => {
                    self.saving.replaces = Some(file.clone());
                    self.save(&file)?;
                }
                None => {
                    self.view_state.open.dialog = Some(FileDialog::suggest(&self.session, FilePurpose::Save));
                }
            },
            SessionCommand::SaveFile(path) => self.save(&path)?,
            SessionCommand::Record(path) => self.record(&path)?,
            SessionCommand::WritePlot(path, plot, file) => self.write_plot(&path, &plot, file)?,
            SessionCommand::Export(path, wanted) => self.export(&path, &wanted)?,
            SessionCommand::TakeElsewhere(path) => self.take_elsewhere(&path)?,
            SessionCommand::Replace(file) => self.saving.replaces = Some(file),
            SessionCommand::Undo => self.change(SessionChange::Undo),
            SessionCommand::TakeBack(since) if self.session.undo_count() > since => self.change(SessionChange::Undo),
            SessionCommand::TakeBack(_) => {}
            SessionCommand::GiveUp if self.session.is_in_gesture() => self.change(SessionChange::Undo),
            SessionCommand::GiveUp => {}
            SessionCommand::Redo => self.change(SessionChange::Redo),
            SessionCommand::GoTo(changes) => self.change(SessionChange::GoTo(changes)),
            SessionCommand::BackToPath if self.session.is_dragged() => self.change(SessionChange::BackToPath),
            SessionCommand::BackToPath => {}
            SessionCommand::TakeGiven(taking) => self.take_given(taking)?,
            SessionCommand::Take(i) => self.take_of_front(i),
            SessionCommand::TakeLengths => self.take_lengths()?,
            SessionCommand::TakeCut => self.take_cut()?,
            SessionCommand::TakeHeights => self.take_heights()?,
            SessionCommand::TakeStillest => self.take_stillest()?,
            SessionCommand::KeepRun => self.keep_run(),
            SessionCommand::OpenRun(entry) => self.open_run(entry),
        }
        Ok(None)
    }

    fn do_to_window(&mut self, command: WindowCommand) -> Result<Option<String>, String> {
        match command {
            WindowCommand::Comparison(on) => self.change_comparison(on),
            WindowCommand::Ask(options) => {
                if let Some(given) = &mut self.opened_table {
                    given.options = options;
                }
            }
            WindowCommand::Seek(objective) => self.seek(objective),
            WindowCommand::Fronts(change) => self.change_fronts(change),
            WindowCommand::Forget(file) => self.saving.misses(&file),
            WindowCommand::LookFor => {
                self.view_state.arrangement.now_mut().plots.shown = true;
                self.focuses_search = true;
            }
            WindowCommand::CopyCommand => {
                let Some(command) = session_command(&self.session, self.queries()) else {
                    return Err(
                        "settings alone are not enough: save (Ctrl S), then type: stillbase simulate FILE.toml".into(),
                    );
                };
                let said = format!("copied: {command}");
                self.clipboard = Some(command);
                return Ok(Some(said));
            }
            WindowCommand::Copy(text) => {
                let said = format!("copied: {}", stillbase_settings::text::shorten_message(&text));
                self.clipboard = Some(text);
                return Ok(Some(said));
            }
            WindowCommand::Refuse(why, proposals) => {
                self.view_state.status.refused = None;
                self.show_outcome(Err(why));
                self.view_state.status.proposals = proposals;
            }
            WindowCommand::RefuseEntry(entry) => {
                self.view_state.status.refused = None;
                self.show_outcome(Err(entry.why.clone()));
                self.view_state.status.entry = Some(entry);
            }
            WindowCommand::ChangedFile(takes) => self.answer_changed_file(takes),
            WindowCommand::Cancel(activity) => return Ok(Some(self.cancel(activity))),
            WindowCommand::AskToLeave(asks) => self.ask_to_leave(asks),
            WindowCommand::Quit if !self.may_leave() => self.ask_to_leave(true),
            WindowCommand::Quit | WindowCommand::Leave => (self.saving.asks, self.saving.leaves) = (false, true),
            WindowCommand::SkipHints => {
                self.hints &= self.intro.is_none();
                if self.intro.is_some() {
                    self.hand_back();
                }
            }
            WindowCommand::Hints => self.begin_hints()?,
            // The tour ends the hints. `self.hints` stays as it is, so unfinished hints return at the next start.
            WindowCommand::Tour(true) => self.begin_tour()?,
            WindowCommand::Tour(false) => return Ok(self.hand_back().then(|| HANDED_BACK.into())),
            WindowCommand::TurnTour(forward) => {
                let tour = self.view_state.open.tour.take();
                match tour.and_then(|tour| tour.turned(forward, &self.session)) {
                    Some(tour) => self.show_tour(tour),
                    None => return Ok(self.hand_back().then(|| HANDED_BACK.into())),
                }
            }
        }
        Ok(None)
    }

    /// Opens or closes the question whether the window may close; it takes the place of the list of commands.
    fn ask_to_leave(&mut self, asks: bool) {
        self.saving.asks = asks;
        self.view_state.open.finder = self.view_state.open.finder.take().filter(|_| !asks);
    }

    /// Opens the field for the name of the bookmark at `time`, s; creates the bookmark if there is none.
    pub(super) fn name_bookmark(&mut self, time: f64) -> Result<(), String> {
        if self.session.bookmark_at(time).is_none() {
            let name = self.session.free_name();
            self.saving.changes += u64::from(self.session.bookmark(time, &name)?.is_some());
        }
        self.view_state.open.naming = Some(time);
        Ok(())
    }
}
