//! Files, written beside the window: sessions, plots, machines and recordings.

use std::path::{Path, PathBuf};

use super::AppState;
use super::beside::fault;
use crate::app::{Activity, PlotFile, plots};
use crate::exchange::cut::Cut;
use crate::exchange::form::Form;
use crate::query::Ticket;

/// What a file is to hold, made beside the window.
type Content = Box<dyn FnOnce() -> Result<Vec<u8>, String> + Send>;

impl AppState {
    /// Whether a file is replaced where it is there; it may not be without the person's word for that.
    fn may_replace(&mut self, file: &Path) -> Result<bool, String> {
        let agreed = self.saving.replaces.take().is_some_and(|agreed| agreed == file);
        match file.exists() && !agreed {
            true => Err(format!("{} exists: want another name", file.display())),
            false => Ok(agreed),
        }
    }

    /// Starts to write a file, if it is free or may be replaced, and nothing else of its kind is being written. What is
    /// done at once says at once how it went, with the dialog still open where it failed.
    fn write<W>(
        &mut self,
        path: &Path,
        (activity, busy): (Activity, &str),
        of: Option<(u64, PathBuf)>,
        work: impl FnOnce(&Self) -> Result<W, String>,
    ) -> Result<(), String>
    where
        W: FnOnce(&Ticket, &Path, bool) -> Result<String, String> + Send + 'static,
    {
        let replaces = self.may_replace(path)?;
        if self.background.runs(activity) {
            return Err(busy.into());
        }
        let (work, path) = (work(self)?, path.to_owned());
        let work = move |ticket: &Ticket| work(ticket, &path, replaces);
        self.background.run(activity, work, move |app_state, said: Option<Result<String, String>>| {
            let said = said.unwrap_or_else(|| Err(fault(activity.words())));
            if let (Ok(_), Some((changes, file))) = (&said, of) {
                app_state.saving.saved = changes;
                app_state.saving.uses(&file);
            }
            app_state.tell(said.map(Some));
        });
        self.collect();
        let failed = matches!(self.view_state.said.message, Some((_, true)));
        if self.background.runs(activity) || !failed {
            self.view_state.open.dialog = None;
        }
        Ok(())
    }

    /// Writes what a file is to hold; of a session, so many changes and their file count as saved then.
    fn write_content(
        &mut self,
        path: &Path,
        busy: &str,
        of: Option<(u64, PathBuf)>,
        content: impl FnOnce(&Self) -> Result<Content, String>,
    ) -> Result<(), String> {
        self.write(path, (Activity::Saving, busy), of, |app_state| {
            let content = content(app_state)?;
            Ok(move |_: &Ticket, path: &Path, replaces: bool| {
                crate::files::write_new(path, &content()?, replaces).map_err(|e| e.to_string())?;
                Ok(format!("saved {}", whole(path)))
            })
        })
    }

    /// Saves the session.
    pub(super) fn save(&mut self, path: &Path) -> Result<(), String> {
        let of = Some((self.saving.changes, path.to_owned()));
        self.write_content(path, "one session is being saved: want that to end first", of, |app_state| {
            let scenario = app_state.session.to_scenario();
            Ok(Box::new(move || Ok(scenario.to_toml().into_bytes())))
        })
    }

    /// Writes a plot to a file.
    pub(super) fn write_plot(&mut self, path: &Path, plot: &str, file: PlotFile) -> Result<(), String> {
        self.write_content(path, ANOTHER, None, |app_state| {
            let Self { session, view_state, comparison, .. } = app_state;
            let (queries, signals, comparison) = (app_state.queries(), &app_state.signals(), comparison.as_ref());
            let what = plots::Shown { session, queries, signals, comparison, view_state };
            plots::written(&what, plot, file)
        })
    }

    /// Writes the machine for another program, in the pose on display.
    pub(super) fn take_elsewhere(&mut self, path: &Path) -> Result<(), String> {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let form = Form::of(&ending).map_err(|e| format!("{}: {e}", path.display()))?;
        self.write_content(path, ANOTHER, None, |app_state| {
            let scenario = app_state.session.scenario();
            let pose = &app_state.session.frame().q.0[..scenario.machine.drives()];
            // Of the material that the design view has counterweights of.
            let cut = Cut { density: scenario.design.density, ..Cut::default() };
            let text = form.written(&scenario.machine, pose, &cut).map_err(|e| e.to_string())?;
            Ok(Box::new(move || Ok(text.into_bytes())))
        })
    }

    /// Records the run.
    #[cfg(feature = "record")]
    pub(super) fn record(&mut self, path: &Path) -> Result<(), String> {
        let busy = "one recording is under way: want it to end first";
        self.write(path, (Activity::Recording, busy), None, |app_state| {
            let mut scenario = app_state.session.to_scenario();
            scenario.duration = Some(app_state.session.length());
            Ok(move |ticket: &Ticket, path: &Path, force: bool| {
                let options = crate::recording::Options { pictures: None, force };
                let mut told = |progress: crate::recording::Progress| {
                    ticket.goes_on(progress.done as f64 / progress.of.max(1) as f64)
                };
                let done = crate::recording::record(&[scenario], path, &options, &mut told);
                let done = done.map_err(|e| e.to_string())?;
                let verdict = if done.iter().all(|r| r.reactionless) { "reactionless" } else { "with reactions" };
                Ok(format!("recorded {} ({verdict}); open it with the Rerun viewer", whole(path)))
            })
        })
    }

    #[cfg(not(feature = "record"))]
    pub(super) fn record(&mut self, _path: &Path) -> Result<(), String> {
        Err("this build cannot record: build it with the feature `record`".into())
    }
}

/// What is said where another file is being saved.
const ANOTHER: &str = "one file is being saved: want that to end first";

/// The whole name of a file, so that it can be found again.
fn whole(path: &Path) -> String {
    crate::files::whole(path).unwrap_or_else(|| path.into()).display().to_string()
}
