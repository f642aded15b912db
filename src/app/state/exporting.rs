//! Writing of results in the background: pictures, films, values of signals and the report.

use std::path::Path;

use super::AppState;
use super::writing::{AfterWriting, absolute};
use crate::export::{
    Export, FilmChoice, FilmForm, FilmOrder, Look, PictureForm, TimeChoice, ValuesChoice, check_film, write_film,
    write_picture, write_report, write_values,
};
use crate::shot::PictureOrder;
use crate::{Activity, SessionCommand, plots};
use stillbase_picture::charts::figure::Figure;
use stillbase_picture::scene::palette::{Theme, palette};
use stillbase_query::Ticket;
use stillbase_settings::number::counted;

/// Message when another result is being written.
const BUSY: &str = "one result is being written: want that to end first";

/// Makes a file in the background; returns what to say of it.
type Work = Box<dyn FnOnce(&Ticket, &Path, bool) -> Result<String, String> + Send>;

impl AppState {
    /// Writes a result to a file.
    pub(super) fn export(&mut self, path: &Path, wanted: &Export) -> Result<(), String> {
        self.require_machine()?;
        if let Export::Film(choice) = wanted {
            // The path is checked first, so that a wrong one is refused before the film is drawn.
            let replaces = self.saving.replaces.as_deref() == Some(path);
            let checked =
                FilmForm::of(path).and_then(|form| check_film((path, form), &self.order(&choice.look), replaces));
            checked.map_err(|e| e.to_string())?;
        }
        self.write(path, Activity::Exporting, BUSY, AfterWriting::Nothing, |app_state| {
            Ok(match wanted {
                Export::Picture(choice) => app_state.picture_work(&choice.look),
                Export::Film(choice) => app_state.film_work(choice)?,
                Export::Values(choice) => app_state.values_work(choice)?,
                Export::Report => app_state.report_work(),
            })
        })
    }

    fn order(&self, look: &Look) -> PictureOrder {
        let (size_px, scale) = look.size.of(look.shot, &self.view_state.displayed);
        let Look { shot, theme, transparent, plots, .. } = *look;
        PictureOrder { shot, theme, transparent, plots, size_px, scale }
    }

    fn picture_work(&self, look: &Look) -> Work {
        let (copy, order) = (self.copy(), self.order(look));
        Box::new(move |ticket, path, force| {
            let goes_on = &mut |done| ticket.goes_on(done);
            let form = PictureForm::of(path).map_err(|e| e.to_string())?;
            let note = write_picture(&mut copy.open(), &order, (path, form), force, goes_on);
            let note = note.map_err(|e| e.to_string())?;
            let [width, height] = order.size_px;
            let note = note.map_or_else(String::new, |note| format!("; {note}"));
            Ok(format!("saved {}, {width} × {height} pixels{note}", absolute(path)))
        })
    }

    fn film_work(&self, choice: &FilmChoice) -> Result<Work, String> {
        let FilmChoice { ref look, whole, fps, slow, .. } = *choice;
        let times = if whole { TimeChoice::Whole } else { TimeChoice::Shown };
        let order =
            FilmOrder { picture: self.order(look), times: times.of(&self.session, &self.view_state), fps, slow };
        order.count().map_err(|e| e.to_string())?;
        let mut copy = self.copy();
        Ok(Box::new(move |ticket, path, force| {
            let goes_on = &mut |done| ticket.goes_on(done);
            // The pictures take most of the time.
            copy.run_to_end(&mut |_| goes_on(0.0));
            let form = FilmForm::of(path).map_err(|e| e.to_string())?;
            let done = write_film(&mut copy.open(), &order, (path, form), force, goes_on).map_err(|e| e.to_string())?;
            Ok(format!("saved {}, {}", absolute(path), counted(done.pictures, "picture")))
        }))
    }

    fn values_work(&self, choice: &ValuesChoice) -> Result<Work, String> {
        let order = choice.order(&self.session, &self.view_state, &self.signals())?;
        let mut session = self.session.clone();
        Ok(Box::new(move |ticket, path, force| {
            let goes_on = &mut |done| ticket.goes_on(done);
            session.seek_while(order.times[1], &mut |_| goes_on(0.0));
            let rows = write_values(session.frames(), &order, path, force, goes_on).map_err(|e| e.to_string())?;
            let columns = counted(order.signals.len(), "signal");
            Ok(format!("saved {}, {} of {columns}", absolute(path), counted(rows, "row")))
        }))
    }

    fn report_work(&self) -> Work {
        let mut copy = self.copy();
        Box::new(move |ticket, path, force| {
            let goes_on = &mut |done| ticket.goes_on(done);
            copy.run_to_end(&mut |done| goes_on(0.5 * done));
            write_report(&mut copy.open(), None, path, force, goes_on).map_err(|e| e.to_string())?;
            Ok(format!("saved {}; a browser shows and prints it", absolute(path)))
        })
    }

    /// Returns the number of plots on display.
    pub(crate) fn plot_count(&self) -> usize {
        self.view_state.plots(self.session.scenario(), &self.signals()).len()
    }

    /// Returns drawings of the plots on display, of a size in points.
    pub(crate) fn figures(&self, size: [f32; 2], theme: Theme) -> Vec<Figure> {
        let Self { session, view_state, comparison, .. } = self;
        let (queries, signals, comparison) = (self.queries(), &self.signals(), comparison.as_ref());
        let what = plots::DisplayContext { session, queries, signals, comparison, view_state };
        let times = match view_state.charts.range {
            None => [0.0, session.length()],
            chosen => plots::extent(session).shown(chosen),
        };
        plots::figures(&what, times, size, &palette(theme))
    }

    /// Simulates the run to its end, that of its motion or of the duration that the scenario states, whichever is later.
    /// Shows that instant; returns its time, s.
    pub fn run_to_end(&mut self) -> f64 {
        self.carry_out(SessionCommand::Seek(self.session.length()));
        let left = self.session.run().last_step().saturating_sub(self.session.frame().step);
        if left > 0 {
            self.carry_out(SessionCommand::Step(i64::try_from(left).unwrap_or(i64::MAX)));
        }
        self.session.frame().time
    }
}
