//! Opening of sessions and files in place of the present session.

use std::path::PathBuf;
use std::sync::Arc;

use super::AppState;
use crate::background::{Opening, SessionFile};
use crate::change::{NotOpened, Opened, OpenedSession, SessionChange, SessionSource};
use crate::saving::LeftSession;
use crate::{Activity, Framing, Recovery};
use stillbase_files::table::{TABLE_ENDINGS, is_table};
use stillbase_mechanics::machine::Machine;
use stillbase_query::{Shared, Ticket};
use stillbase_session::Session;
use stillbase_session::assembly::AssemblyScenario;
use stillbase_session::scenario::Scenario;

impl AppState {
    /// Opens a source in the background; a newer request replaces an older one.
    pub(super) fn open(&mut self, source: SessionSource, opening: Opening) {
        self.background.stop(Activity::Opening);
        let work = move |ticket: &Ticket| source.open(&mut |done| ticket.goes_on(done));
        self.background.run(Activity::Opening, work, move |app_state, opened| app_state.take_opened(opening, opened));
        self.finish();
    }

    fn take_opened(&mut self, opening: Opening, opened: Option<Result<Opened, NotOpened>>) {
        let broken = || NotOpened {
            why: "opening broke off: this is a fault of the program".into(),
            refused: None,
            report: None,
        };
        match opened.unwrap_or_else(|| Err(broken())) {
            Ok(Opened::Table(file, table)) if opening.adds => self.add_table(file, table),
            Ok(Opened::Table(file, table)) => self.take_up(file, table),
            Ok(Opened::Session(opened)) => {
                let OpenedSession { session, note, left_out, left_off } = *opened;
                // A file that is taken up again says so.
                let message = if opening.title.is_some() { None } else { note };
                let message = message.or_else(|| opening.message.clone());
                let watched = match &opening.file {
                    Some(SessionFile::Own(file)) => Some(file.clone()),
                    _ => None,
                };
                // Only a file that the window wrote says where the session was left.
                let own = match &opening.file {
                    Some(SessionFile::Own(file)) if left_off.is_some() => Some(file.clone()),
                    // A journal names the file of its session.
                    Some(SessionFile::LeftBehind(_)) => left_off.as_ref().and_then(|left_off| left_off.file.clone()),
                    _ => None,
                };
                self.take_over(session, Opening { message, ..opening });
                self.view_state.open.report = left_out;
                self.watch(watched);
                if let Some(file) = own {
                    self.saving.keep_file(self.session.undo_count(), file);
                }
                if let Some(mut left_off) = left_off {
                    // Without runs of its own, a file leaves the table what the user has added.
                    let runs = std::mem::take(&mut left_off.runs);
                    if !runs.is_empty() {
                        self.background.stop(Activity::ExtraRun);
                        (self.comparison, self.runs) = (None, runs);
                    }
                    left_off.show(&mut self.view_state, self.session.run());
                }
            }
            Err(_) if opening.instead.is_some() => {
                if let Some((scenario, said)) = opening.instead.map(|instead| *instead) {
                    let opening = Opening { message: Some(said), instead: None, ..opening };
                    self.open(SessionSource::Scenario(Box::new(scenario)), opening);
                }
            }
            Err(NotOpened { why, refused, report }) => {
                if let Some(SessionFile::Own(file)) = &opening.file {
                    self.saving.misses(file);
                }
                self.view_state.status.refused = refused;
                self.view_state.open.report = report;
                self.show_outcome(Err(why));
            }
        }
        self.refresh();
    }

    pub(super) fn take_over(
        &mut self,
        next: Session,
        Opening { plays, closes, message: news, title, file, .. }: Opening,
    ) {
        self.saving.opened();
        match file {
            Some(SessionFile::Own(file)) => self.saving.uses(&file),
            // A recovered session is in no file of the user yet.
            Some(SessionFile::LeftBehind(file)) => {
                self.saving.changes += 1;
                self.saving.recovered = Some(file);
            }
            None => {}
        }
        let old = self.session.clone();
        let again = title.map(|_| old.frame().time);
        match title {
            Some(title) => self.session.take_over_as(next, title.into()),
            None => self.session.take_over(next),
        }
        self.saving.begin_file(self.session.undo_count());
        self.view_state.open.note = None;
        // A scenario without a drawing is not drawn on.
        self.view_state.pen = self.view_state.pen.take().filter(|_| self.session.scenario().sketch.is_some());
        // Points of another machine may not exist, and it has another size.
        if old.scenario().machine != self.session.scenario().machine {
            self.view_state.measurements.clear();
            self.view_state.framing = Default::default();
        }
        self.motion_before_drag = None;
        // The measurements of an open table now refer to the newly opened machine.
        if let Some(given) = &mut self.opened_table {
            given.measured = Shared(Arc::new(self.session.scenario().machine.clone()));
        }
        self.view_state.framing.iter_mut().for_each(Framing::renew);
        self.show_blocks();
        self.background.free(old, &self.session);
        self.run_ahead();
        // A file that is taken up again stays at its time, as far as its run goes.
        if let Some(time) = again.filter(|time| *time > 0.0 && self.session.run().waiting().is_none()) {
            self.change(SessionChange::Seek(time.min(self.session.length())));
        }
        if plays {
            self.session.play();
        }
        if closes {
            self.view_state.open.dialog = None;
        }
        self.show_outcome(Ok(news));
    }

    /// Leads another block of the assembly: the same motion, and the same instant on display. Ctrl Z leads the one before.
    pub(super) fn lead(&mut self, block: usize) -> Result<(), String> {
        let present = self.session.to_scenario();
        let Some(whole) = AssemblyScenario::of(&present).filter(|whole| whole.lead != block) else { return Ok(()) };
        let title = format!("lead {}", whole.assembly.blocks()[block].name);
        self.take_over_whole(&AssemblyScenario { lead: block, ..whole }, title)
    }

    /// Has the b of another block follow that of the block that is led, or lets go of it.
    pub(super) fn bind_b(&mut self, other: Option<usize>) -> Result<(), String> {
        let Some(mut whole) = AssemblyScenario::of(&self.session.to_scenario()) else { return Ok(()) };
        let title = match other {
            Some(other) => {
                whole.bind([whole.lead, other])?;
                format!("b against that of {}", whole.assembly.blocks()[other].name)
            }
            None => {
                whole.against = None;
                "b for itself".to_owned()
            }
        };
        self.take_over_whole(&whole, title)
    }

    /// Takes over a scenario of the assembly on display, at the same instant.
    fn take_over_whole(&mut self, whole: &AssemblyScenario, title: String) -> Result<(), String> {
        let mut next = Session::open(whole.leading(whole.lead)).map_err(|refusal| refusal.to_string())?;
        next.seek(self.session.frame().time);
        let (old, plays) = (self.session.clone(), self.session.is_playing());
        self.session.take_over_as(next, title);
        if plays {
            self.session.play();
        }
        self.view_state.measurements.clear();
        self.view_state.gesture = Default::default();
        self.saving.changes += 1;
        self.background.free(old, &self.session);
        self.run_ahead();
        Ok(())
    }

    /// Opens one of the paper's cases with the machine on display, or the paper's if both have the same name. The
    /// message names the machine on display if it is another one.
    pub(super) fn open_case(&mut self, name: &str) {
        let Some(case) = Scenario::builtin(name) else { return };
        let present = &self.session.scenario().machine;
        let other = (present.name() != case.machine.name()).then(|| present.clone());
        let own = case.machine.name();
        let news = |machine: &Machine| {
            format!("{}, with {}; choose the paper's machine, {own}, at the top left", case.title, machine.name())
        };
        let instead = |machine: &Machine| {
            let said = format!(
                "{}, with the paper's machine, as {} cannot do it; Ctrl Z goes back",
                case.title,
                machine.name()
            );
            Box::new((case.clone(), said))
        };
        let (message, instead) = (other.as_ref().map(news), other.as_ref().map(instead));
        let scenario = Scenario { machine: other.unwrap_or_else(|| case.machine.clone()), ..case };
        let opening = Opening { plays: true, message, instead, ..Opening::default() };
        self.open(SessionSource::Scenario(Box::new(scenario)), opening);
    }

    /// Opens a file.
    pub(super) fn open_file(&mut self, path: PathBuf) {
        let back = if self.saving.is_unsaved() { "; Ctrl Z leads back to unsaved changes" } else { "" };
        let message = Some(format!("opened {}{back}", path.display()));
        let file = Some(SessionFile::Own(path.clone()));
        self.open(SessionSource::File(path), Opening { closes: true, message, file, ..Opening::default() });
    }

    /// Opens tables, all of them as one measurement, and shows them; what is wrong with one is said.
    #[must_use]
    pub fn with_tables(mut self, files: Vec<PathBuf>) -> Self {
        for file in files {
            let opening = Opening { adds: self.opened_table.is_some(), ..Opening::default() };
            let opened = SessionSource::File(file).open(&mut |_| true);
            self.take_opened(opening, Some(opened));
        }
        self
    }

    /// Opens a file of further motions of the measurement on display.
    ///
    /// # Errors
    /// If it is no table.
    pub(super) fn add_file(&mut self, path: PathBuf) -> Result<(), String> {
        if !is_table(&path) {
            return Err(format!("{}: want a table, .{}", path.display(), TABLE_ENDINGS.join(" or .")));
        }
        self.open(SessionSource::File(path), Opening { closes: true, adds: true, ..Opening::default() });
        Ok(())
    }

    pub(super) fn recover(&mut self, what: Recovery) {
        let Some(LeftSession { file, .. }) = self.saving.left_session.take() else { return };
        match what {
            Recovery::Open => {
                let (from, message) =
                    (Some(SessionFile::LeftBehind(file.clone())), Some("here is where you were".into()));
                self.open(SessionSource::Journal(file), Opening { message, file: from, ..Opening::default() });
            }
            Recovery::Forget => self.saving.recovered = Some(file),
            Recovery::Later => {}
        }
    }
}
