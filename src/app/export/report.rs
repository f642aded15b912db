//! The report on the run on display.

use std::path::Path;

use super::ExportError;
use crate::shot::{PictureOrder, Shot};
use crate::{AppState, SessionCommand};
use stillbase_picture::charts::legend::{self, run_names};
use stillbase_picture::render::offscreen::NoPicture;
use stillbase_picture::report::{Report, ReportPicture};
use stillbase_picture::scene::palette::{Theme, palette};
use stillbase_session::session_command;
use stillbase_session::verdict::{Statements, Verdict};
use stillbase_settings::number::fixed;

/// Size of a picture of the scene, pixels.
const PICTURE_SIZE_PX: [u32; 2] = [1040, 700];

/// Pixels per point in a picture: labels stay legible at half its width.
const PICTURE_SCALE: f32 = 1.6;

/// Width and height of a plot, points.
const PLOT_SIZE_PT: [f32; 2] = [420.0, 200.0];

/// A report that was made.
#[derive(Clone, Debug)]
pub struct ReportDone {
    /// Number of pictures, or why there are none.
    pub pictures: Result<usize, String>,
    /// Number of plots.
    pub plots: usize,
    /// Statements on machine, plan and run.
    pub statements: Statements,
    /// The audit that has failed, if one has.
    pub fault: Option<String>,
}

/// Simulates the run on display to its end and returns the report as a page. `command` repeats the run; without one,
/// the command is made from the settings of the session, if they suffice.
fn report(app_state: &mut AppState, command: Option<String>) -> (String, ReportDone) {
    let end = app_state.run_to_end();
    let pictures = pictures(app_state, [0.0, end]);
    app_state.carry_out(SessionCommand::Seek(end));
    let figures = app_state.figures(PLOT_SIZE_PT, Theme::Light);
    let runs = run_names(app_state.comparison());
    let legend = legend::figure(&runs, 2.0 * PLOT_SIZE_PT[0], &palette(Theme::Light));
    let session = app_state.session();
    let command = command.or_else(|| session_command(session, app_state.queries()));
    let how = "Save the session (Ctrl S); stillbase report FILE.toml -o report.html then writes this page.";
    let newest = session.frames().last().unwrap_or(session.frame());
    let report = Report {
        run: session.run(),
        frame: newest,
        pictures,
        figures: &figures,
        legend: legend.as_ref(),
        notation: app_state.view_state().arrangement.notation,
        comparison: app_state.comparison(),
        command: command.ok_or_else(|| how.to_owned()),
    };
    let done = ReportDone {
        pictures: report.pictures.as_ref().map(Vec::len).map_err(Clone::clone),
        plots: figures.len(),
        statements: Statements::of(session.run(), newest),
        fault: Verdict::of(session.scenario(), newest).fault.map(|fault| fault.to_string()),
    };
    (report.html(), done)
}

/// Draws the scene at two instants, s; fails with the reason if a picture cannot be drawn or encoded.
fn pictures(app_state: &mut AppState, times: [f64; 2]) -> Result<Vec<ReportPicture>, String> {
    let order = PictureOrder { scale: PICTURE_SCALE, ..PictureOrder::new(Shot::Scene, Theme::Light, PICTURE_SIZE_PX) };
    let mut canvas = order.canvas().map_err(|why| why.to_string())?;
    let mut pictures = Vec::new();
    for time in times {
        app_state.carry_out(SessionCommand::Seek(time));
        canvas.forget_labels();
        let picture = order.draw(&mut canvas, app_state).map_err(|why: NoPicture| why.to_string())?;
        let png = picture.to_png().map_err(|why| why.to_string())?;
        pictures.push(ReportPicture { caption: format!("The scene at {} s", fixed(time, 3)), png });
    }
    Ok(pictures)
}

/// Writes the report to a file, unless `goes_on` stops it before.
///
/// # Errors
/// If the file cannot be written, or `goes_on` returns false.
pub fn write_report(
    app_state: &mut AppState,
    command: Option<String>,
    file: &Path,
    force: bool,
    goes_on: &mut dyn FnMut(f64) -> bool,
) -> Result<ReportDone, ExportError> {
    stillbase_files::check_new(file, force)?;
    let (page, done) = report(app_state, command);
    if !goes_on(1.0) {
        return Err(ExportError::Stopped);
    }
    stillbase_files::write_new(file, page.as_bytes(), force)?;
    Ok(done)
}
