//! Writing of files in the background: sessions, plots, machines and recordings.

use std::path::{Path, PathBuf};

use super::AppState;
use super::background::fault;
use crate::export::{PictureForm, write_values};
use crate::file_dialog::MACHINE_EXTENSION;
use crate::{Activity, FileReport, PlotFile, ResumePoint, plots, studio};
use stillbase_exchange::form::{Exported, Form, FormContent};
use stillbase_files::row_file::{RowForm, table_bytes};
use stillbase_files::{floating_base, is_standard, left_out_of_base};
use stillbase_query::Ticket;
use stillbase_session::scenario::{MachineFile, Scenario, UnfinishedDrawing};

/// Computes the content of a file, in the background.
type Content = Box<dyn FnOnce() -> Result<Vec<u8>, String> + Send>;

/// What happens once a file is written.
pub(super) enum AfterWriting {
    /// Nothing more.
    Nothing,
    /// This number of changes of the session is saved, in this file.
    Saved(u64, PathBuf),
    /// The machine is in this file of the user's own; this number of changes of the session is saved with it, if all of
    /// them are changes of the machine.
    Machine(Option<u64>, PathBuf),
    /// A list is shown of what the file leaves out, if it leaves out anything.
    List(Option<FileReport>),
}

impl AppState {
    /// Returns whether the user has agreed to replace the file. Fails if the file exists and the user has not agreed.
    fn may_replace(&mut self, file: &Path) -> Result<bool, String> {
        let agreed = self.saving.replaces.take().is_some_and(|agreed| agreed == file);
        match file.exists() && !agreed {
            true => Err(format!("{} exists: want another name", file.display())),
            false => Ok(agreed),
        }
    }

    /// Starts to write a file, if it does not exist or may be replaced, and if no work of this activity is under way.
    /// The dialog closes unless the work fails at once. `then` happens once the file is there.
    pub(super) fn write<W>(
        &mut self,
        path: &Path,
        activity: Activity,
        busy: &str,
        then: AfterWriting,
        work: impl FnOnce(&Self) -> Result<W, String>,
    ) -> Result<(), String>
    where
        W: FnOnce(&Ticket, &Path, bool) -> Result<String, String> + Send + 'static,
    {
        // In the window `-` is a file as any other: nobody reads its standard output.
        let path = &if is_standard(path) { Path::new(".").join(path) } else { path.to_owned() };
        let replaces = self.may_replace(path)?;
        if self.background.runs(activity) {
            return Err(busy.into());
        }
        let (work, path) = (work(self)?, path.to_owned());
        let work = move |ticket: &Ticket| work(ticket, &path, replaces);
        self.background.run(activity, work, move |app_state, said: Option<Result<String, String>>| {
            let said = said.unwrap_or_else(|| Err(fault(activity.words())));
            match (&said, then) {
                (Ok(_), AfterWriting::Saved(changes, file)) => {
                    app_state.saving.saved = changes;
                    app_state.saving.uses(&file);
                    app_state.watch(Some(file.clone()));
                    app_state.saving.keep_file(app_state.own_session().undo_count(), file);
                }
                (Ok(_), AfterWriting::Machine(changes, file)) => {
                    app_state.saving.saved = changes.unwrap_or(app_state.saving.saved);
                    app_state.saving.uses(&file);
                }
                (Ok(_), AfterWriting::List(report)) => app_state.view_state.open.report = report,
                _ => {}
            }
            app_state.show_outcome(said.map(Some));
        });
        self.collect();
        let failed = self.view_state.status.problem().is_some();
        if self.background.runs(activity) || !failed {
            self.view_state.open.dialog = None;
        }
        Ok(())
    }

    /// Writes `content` to a file.
    fn write_content(
        &mut self,
        path: &Path,
        busy: &str,
        then: AfterWriting,
        content: impl FnOnce(&Self) -> Result<Content, String>,
    ) -> Result<(), String> {
        self.write(path, Activity::Saving, busy, then, |app_state| {
            let content = content(app_state)?;
            Ok(move |_: &Ticket, path: &Path, replaces: bool| {
                stillbase_files::write_new(path, &content()?, replaces).map_err(|e| e.to_string())?;
                Ok(format!("saved {}", absolute(path)))
            })
        })
    }

    /// Saves the session.
    pub(super) fn save(&mut self, path: &Path) -> Result<(), String> {
        let then = AfterWriting::Saved(self.saving.changes, path.to_owned());
        self.write_content(path, "one session is being saved: want that to end first", then, |app_state| {
            let (scenario, left_off) = (app_state.session.to_scenario(), app_state.left_off());
            let left_off = ResumePoint { file: None, ..left_off };
            Ok(Box::new(move || Ok(left_off.before(&scenario.to_toml()).into_bytes())))
        })
    }

    /// Writes a plot to a file, of which the ending decides between values or between pictures.
    pub(super) fn write_plot(&mut self, path: &Path, plot: &str, file: PlotFile) -> Result<(), String> {
        if matches!(file, PlotFile::Values(_)) {
            RowForm::of(path).map_err(|why| why.to_string())?;
            return self.write_plot_values(path, plot);
        }
        let form = PictureForm::of(path).map_err(|why| why.to_string())?;
        self.write_content(path, FILE_BEING_SAVED, AfterWriting::Nothing, |app_state| {
            let Self { session, view_state, comparison, .. } = app_state;
            let (queries, signals, comparison) = (app_state.queries(), &app_state.signals(), comparison.as_ref());
            let what = plots::DisplayContext { session, queries, signals, comparison, view_state };
            let figure = plots::figure(&what, plot)?;
            Ok(Box::new(move || form.of_figure(figure)))
        })
    }

    /// Writes the values of a plot within the time range on display.
    fn write_plot_values(&mut self, path: &Path, plot: &str) -> Result<(), String> {
        self.write(path, Activity::Saving, FILE_BEING_SAVED, AfterWriting::Nothing, |app_state| {
            let Self { session, view_state, .. } = app_state;
            let all = app_state.signals();
            let plots = view_state.plots(session.scenario(), &all);
            let plot = plots.iter().find(|own| own.name == plot).ok_or_else(|| plots::no_plot(plot))?;
            let (order, frames) = (plots::values(session, view_state, plot), session.frames().clone());
            Ok(move |ticket: &Ticket, path: &Path, force: bool| {
                let goes_on = &mut |done| ticket.goes_on(done);
                write_values(&frames, &order, path, force, goes_on).map_err(|e| e.to_string())?;
                Ok(format!("saved {}", absolute(path)))
            })
        })
    }

    /// Writes the machine for another program, in the pose on display.
    pub(super) fn take_elsewhere(&mut self, path: &Path) -> Result<(), String> {
        self.require_machine()?;
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        if ending.eq_ignore_ascii_case(MACHINE_EXTENSION) {
            let changes = self.session.changes_machine_only().then_some(self.saving.changes);
            let then = AfterWriting::Machine(changes, path.to_owned());
            return self.write_content(path, FILE_BEING_SAVED, then, |app_state| {
                let Scenario { machine, design, .. } = app_state.session.scenario();
                let text = MachineFile { machine: machine.clone(), design: design.clone() }.to_toml();
                Ok(Box::new(move || Ok(text.into_bytes())))
            });
        }
        let form = Form::of(&ending).map_err(|e| format!("{}: {e}", path.display()))?;
        let Scenario { machine, base, .. } = self.session.scenario();
        let of_base = Some(base).filter(|_| form.is_model()).and_then(left_out_of_base);
        let left_out = form.left_out(machine).into_iter().chain(of_base).collect();
        let then = AfterWriting::List(FileReport::not_written(path, left_out));
        self.write_content(path, FILE_BEING_SAVED, then, |app_state| {
            let scenario = app_state.session.scenario();
            let pose = &app_state.session.frame().q.0[..scenario.machine.drives()];
            let cut = studio::cut(&app_state.session);
            let base = floating_base(&scenario.base);
            let exported = Exported { machine: &scenario.machine, base: base.as_ref(), pose, cut: &cut };
            let content = form.written(&exported).map_err(|e| e.to_string())?;
            let (path, rows) = (path.to_owned(), RowForm::of_ending(form.ending));
            Ok(Box::new(move || match (content, rows) {
                (FormContent::Table(table), Some(rows)) => table_bytes(&table, rows, &path).map_err(|e| e.to_string()),
                (content, _) => Ok(content.text().into_bytes()),
            }))
        })
    }

    /// Refuses to write anything about a machine whose drawing is not complete: the machine before would be written.
    pub(super) fn require_machine(&self) -> Result<(), String> {
        let complete = |why: &UnfinishedDrawing| format!("{why}; complete the drawing first, or save the session");
        self.session.run().unfinished().map_or(Ok(()), |why| Err(complete(why)))
    }

    /// Records the run.
    #[cfg(feature = "record")]
    pub(super) fn record(&mut self, path: &Path) -> Result<(), String> {
        self.require_machine()?;
        let busy = "one recording is under way: want it to end first";
        self.write(path, Activity::Recording, busy, AfterWriting::Nothing, |app_state| {
            let mut scenario = app_state.session.to_scenario();
            scenario.duration = Some(app_state.session.length());
            Ok(move |ticket: &Ticket, path: &Path, force: bool| {
                let options = stillbase_recording::Options { force, ..Default::default() };
                let mut report = |progress: stillbase_recording::RecordingProgress| {
                    ticket.goes_on(progress.done as f64 / progress.total.max(1) as f64)
                };
                let done = stillbase_recording::record(&[scenario], path, &options, &mut report);
                let done = done.map_err(|e| e.to_string())?;
                let verdict = if done.iter().all(|r| r.reactionless) { "reactionless" } else { "with reactions" };
                Ok(format!("recorded {} ({verdict}); open it with the Rerun viewer", absolute(path)))
            })
        })
    }

    #[cfg(not(feature = "record"))]
    pub(super) fn record(&mut self, _path: &Path) -> Result<(), String> {
        Err("this build cannot record: build it with the feature `record`".into())
    }
}

/// Message when another file is being saved.
const FILE_BEING_SAVED: &str = "one file is being saved: want that to end first";

/// Returns the absolute path of a file as text, so that the user can find it.
pub(super) fn absolute(path: &Path) -> String {
    stillbase_files::absolute_path(path).unwrap_or_else(|| path.into()).display().to_string()
}
