//! Figures of a run.

use std::path::Path;
use std::sync::Arc;

use clap::ValueEnum;
use stillbase_app::{AppState, PictureOrder, SessionCommand, Shot};
use stillbase_files::check_new;
use stillbase_picture::charts::charts;
use stillbase_picture::charts::figure::Figure;
use stillbase_picture::print::paper::{PrintPart, PrintedFigure, chart_plot, snapshots_plot, turn_areas, workspaces};
use stillbase_picture::print::scene_figure;
use stillbase_picture::scene::palette::Theme;
use stillbase_picture::scene::views::ViewKind;
use stillbase_settings::number::fixed;
use stillbase_settings::text::shell_word;
use stillbase_simulation::signals::{group_of, signals};
use stillbase_study::turn_map::{TurnMap, turn_limits};
use stillbase_study::workspace::WorkspaceReport;

use super::{FIGURE_ENDINGS, FiguresArguments, print, write};
use crate::failure::Failure;
use crate::input::{no_use, pose_space, scenario};
use crate::output::check_output;
use crate::progress::goes_on;

/// A part of the figures of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RunFigure {
    /// Torques of the drives
    Torque,
    /// Turning moment on the base
    Moment,
    /// Force on the base, from motion
    Force,
    /// Angles of the drives
    Angle,
    /// Pose constant b
    Pose,
    /// Motion of a base that moves
    Base,
    /// Friction, if the plant has any
    Friction,
    /// Forces on the pins
    Pin,
    /// Reactionless workspace of the b of the task
    Workspace,
    /// Areas that straight rays from A reach at zero momentum, and while the base turns by a few degrees
    TurnMap,
    /// Poses along the run, and the path of the end effector
    Snapshots,
    /// The machine at an instant, as the window shows it
    Linkage,
}

/// Heights of the axes as fractions of the width of the figure.
const PLOT_HEIGHT: f32 = 0.42;
const DRAWING_HEIGHT: f32 = 0.95;
/// Points of the window in a point of paper: so the type of labels is as large as that of plots.
const LINKAGE_SCALE: f32 = 1.6;

impl RunFigure {
    fn word(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }
}

/// Draws parts of a run into one file, with the numbers in another beside it.
pub fn draw(wanted: &FiguresArguments, file: &Path, standard: Option<&str>) -> Result<(), Failure> {
    if standard.is_none() {
        check_output(file, wanted.force, &FIGURE_ENDINGS)?;
    }
    let mut files = vec![file.to_owned()];
    let has_numbers = wanted.what.iter().any(|part| *part != RunFigure::Linkage);
    files.extend((has_numbers && standard.is_none()).then(|| file.with_extension(wanted.numbers_ending())));
    files.iter().try_for_each(|file| check_new(file, wanted.force))?;
    if wanted.at.is_some() && !wanted.what.contains(&RunFigure::Linkage) {
        return Err(no_use("--at", "--what linkage: the other parts show the whole run"));
    }
    let [name] = &wanted.names[..] else {
        return Err(Failure::wrong_input("several scenarios: want one with --what"));
    };
    let scenario = scenario(name, &wanted.settings)?;
    let mut app_state =
        AppState::new(scenario.clone(), Theme::Light).map_err(|why| Failure::refused(&scenario, why))?;
    let end = app_state.run_to_end();
    let at = wanted.at.unwrap_or(end);
    if !(0.0..=end + 5e-4).contains(&at) {
        let why = format!("--at {at}: want a time within the run, 0 to {} s", fixed(end, 3));
        return Err(Failure::wrong_input(why));
    }
    app_state.carry_out(SessionCommand::Seek(at.min(end)));
    let width = wanted.width_points();
    let mut parts: Vec<PrintPart> = Vec::new();
    for part in &wanted.what {
        parts.push(match part {
            RunFigure::Linkage => PrintPart::Drawing(linkage_figure(&mut app_state, width)),
            part => plot(*part, &app_state, width)?,
        });
    }
    let made = made(wanted, name, file);
    let title = match &scenario.title[..] {
        "" => scenario.name.clone(),
        title => format!("{}: {title}", scenario.name),
    };
    let figure = PrintedFigure::of(&title, &made, width, parts);
    match standard {
        Some(ending) => print(&figure, ending),
        None => write(&figure, &files, wanted.force),
    }
}

/// Returns the command that writes the file.
fn made(wanted: &FiguresArguments, name: &str, file: &Path) -> String {
    let what: Vec<String> = wanted.what.iter().map(|part| part.word()).collect();
    let at = wanted.at.map_or_else(String::new, |at| format!(" --at {at}"));
    let file = file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let (name, file, what) = (shell_word(name), shell_word(&file), what.join(","));
    format!("stillbase figures {name} --what {what}{at} -o {file}{}{}", wanted.typed_form(), wanted.settings.as_typed())
}

/// Returns a part with curves.
fn plot(part: RunFigure, app_state: &AppState, width: f32) -> Result<PrintPart, Failure> {
    let session = app_state.session();
    let (scenario, frames) = (session.scenario(), session.frames());
    match part {
        RunFigure::Workspace => {
            let space = pose_space(&scenario.machine)?;
            let b = scenario.task.b;
            let report = WorkspaceReport::of(&scenario.machine, &space, b, &[]);
            let report = report.ok_or_else(|| Failure::no_answer("the joint limits leave no pose: want wider ones"))?;
            Ok(PrintPart::Plot(workspaces(Theme::Light, &[(b, report)]), DRAWING_HEIGHT * width))
        }
        RunFigure::TurnMap => {
            let rays = session.run().rays();
            let rays = rays.map_err(|why| Failure::no_answer(format!("{}: {why}", scenario.name)))?;
            let map = TurnMap::of(&rays, turn_limits(scenario.base.floats()), &mut |_| goes_on());
            let map = map.ok_or_else(|| Failure::no_answer("there is no map"))?;
            Ok(PrintPart::Plot(turn_areas(Theme::Light, &map), DRAWING_HEIGHT * width))
        }
        RunFigure::Snapshots => {
            let linkage = app_state.views().stage().linkage();
            Ok(PrintPart::Plot(snapshots_plot(Theme::Light, session.run(), linkage, frames), DRAWING_HEIGHT * width))
        }
        part => {
            let (word, charts) = (part.word(), charts(scenario, false));
            let is_of = |path: &&str| group_of(path) == word;
            let chart = charts.iter().find(|chart| chart.signals.first().is_some_and(is_of));
            let chart = chart.ok_or_else(|| {
                Failure::no_answer(format!("{}: this run has no {word}: want another part", scenario.name))
            })?;
            Ok(PrintPart::Plot(
                chart_plot(Theme::Light, chart, &signals(&scenario.machine), frames),
                PLOT_HEIGHT * width,
            ))
        }
    }
}

/// Returns the machine as the flat view shows it, on a square that is this wide on paper, points.
fn linkage_figure(app_state: &mut AppState, width: f32) -> Figure {
    let side = (LINKAGE_SCALE * width).round() as u32;
    let order =
        PictureOrder { scale: 1.0, ..PictureOrder::new(Shot::View(ViewKind::Flat), Theme::Light, [side, side]) };
    let (scene, camera) = order.scene(app_state);
    scene_figure(&Arc::new(scene), &camera, [side as f32; 2])
}
