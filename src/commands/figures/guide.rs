//! The pictures of the guide.

use std::path::Path;

use stillbase_app::{
    AppState, Command, ComparisonCommand, PenChange, PictureOrder, SessionCommand, Shot, Switch, ViewChange,
    WindowCommand,
};
use stillbase_exchange::cut::Cut;
use stillbase_files::write_new;
use stillbase_mechanics::machine;
use stillbase_mechanics::sketch::Sketch;
use stillbase_picture::canvas::Canvas;
use stillbase_picture::render::offscreen::Picture;
use stillbase_picture::scene::palette::Theme;
use stillbase_picture::scene::sketching::SketchItem;
use stillbase_picture::scene::views::ViewKind;
use stillbase_query::ByIdentity;
use stillbase_session::scenario::{Scenario, TaskChange, Value};
use stillbase_session::{Edit, Run, parts};
use stillbase_settings::range::quote_clipped;
use stillbase_study::layers::{LayersRequest, find_layers};

use super::paper::{PaperFigure, beside};
use crate::exit::print_message;
use crate::failure::Failure;

/// Content of a picture.
enum Shown {
    /// The window at an instant of a scenario, s, after these commands.
    Window(&'static str, f64, fn() -> Vec<Command>),
    /// A view alone at an instant of a scenario, s.
    Scene(&'static str, f64, ViewKind),
    /// Figures of the paper beside each other; pixels per point.
    Paper(&'static [PaperFigure], f32),
}

impl Shown {
    /// Draws the picture in both themes.
    fn draw(&self) -> Result<[Picture; 2], Failure> {
        let (scenario, time, commands) = match self {
            Self::Window(scenario, time, commands) => (scenario, time, commands()),
            Self::Scene(scenario, time, _) => (scenario, time, Vec::new()),
            Self::Paper(figures, scale) => {
                let drawn = |theme| paper_picture(figures, theme, *scale);
                return Ok([drawn(Theme::Dark)?, drawn(Theme::Light)?]);
            }
        };
        let mut app_state = opened(scenario, *time)?;
        commands.into_iter().for_each(|command| app_state.carry_out(command));
        let [dark, light] = [Theme::Dark, Theme::Light].map(|theme| self.order(theme));
        // Both themes share a canvas, so that its fonts are loaded once.
        let mut canvas = dark.canvas().map_err(Failure::no_answer)?;
        let mut drawn = |order: PictureOrder| order.draw(&mut canvas, &mut app_state).map_err(Failure::no_answer);
        Ok([drawn(dark)?, drawn(light)?])
    }

    fn order(&self, theme: Theme) -> PictureOrder {
        match self {
            Self::Scene(.., view) => {
                PictureOrder { scale: 1.25, ..PictureOrder::new(Shot::View(*view), theme, [1200, 1000]) }
            }
            _ => PictureOrder { scale: 1.0, ..PictureOrder::new(Shot::Window, theme, [1440, 900]) },
        }
    }
}

/// The pictures with their names.
const PICTURES: [(&str, Shown); 18] = [
    ("window", Shown::Window("case-3", 0.62, Vec::new)),
    ("spacecraft", Shown::Window("spacecraft", 0.75, Vec::new)),
    ("compare", Shown::Window("case-1", 0.62, side_by_side)),
    ("tolerances", Shown::Window("case-3", 0.62, study)),
    ("design", Shown::Window("nine-link-bare", 0.62, designed)),
    ("draw", Shown::Window("case-3", 0.62, drawn)),
    ("workshop", Shown::Window("case-3", 0.62, stacked)),
    ("tower", Shown::Scene("case-3", 0.62, ViewKind::Tower)),
    ("joints", Shown::Scene("case-1", 0.5, ViewKind::Joints)),
    ("assembly", Shown::Window("arm-against-arm", 1.4, Vec::new)),
    ("assembly-hand-over", Shown::Window("hand-over", 3.1, Vec::new)),
    ("assembly-wrist", Shown::Scene("wrist-across", 1.0, ViewKind::Space)),
    ("assembly-in-space", Shown::Scene("four-freedoms", 2.6, ViewKind::Space)),
    ("assembly-off-its-pin", Shown::Scene("off-its-pin", 0.5, ViewKind::Space)),
    ("paper-table-1", Shown::Paper(&[PaperFigure::Table1], 4.0)),
    ("paper-fig-3", Shown::Paper(&[PaperFigure::Fig3], 4.0)),
    ("paper-fig-4", Shown::Paper(&[PaperFigure::Fig4], 4.0)),
    ("paper-fig-5", Shown::Paper(&[PaperFigure::Fig5a, PaperFigure::Fig5b, PaperFigure::Fig5c], 2.0)),
];

/// Returns the names of the pictures.
pub fn names() -> Vec<&'static str> {
    PICTURES.iter().map(|(name, ..)| *name).collect()
}

/// Draws pictures of the guide into a folder: those of these names, or all if there is no name.
pub fn draw(names: &[String], folder: &Path, force: bool) -> Result<(), Failure> {
    if let Some(unknown) = names.iter().find(|name| !self::names().contains(&name.as_str())) {
        let (unknown, known) = (quote_clipped(unknown), self::names().join(", "));
        let why =
            format!("no picture of the guide is called {unknown:?}: want one of these [possible values: {known}]");
        return Err(Failure::wrong_input(format!("{why}, or --what for figures of a run")));
    }
    let is_chosen = |name: &str| names.is_empty() || names.iter().any(|picture| picture == name);
    for (name, shown) in PICTURES.iter().filter(|(name, _)| is_chosen(name)) {
        for (picture, word) in shown.draw()?.iter().zip(["dark", "light"]) {
            let file = folder.join(format!("{name}-{word}.png"));
            write_new(&file, &picture.to_png().map_err(Failure::no_answer)?, force)?;
            print_message(format!("wrote {}", file.display()));
        }
    }
    Ok(())
}

/// Draws figures of the paper beside each other.
fn paper_picture(figures: &[PaperFigure], theme: Theme, scale: f32) -> Result<Picture, Failure> {
    let page = beside(figures, theme)?;
    let size = page.size.map(|side| (scale * side).ceil() as u32);
    let mut canvas = Canvas::new(size, scale).map_err(Failure::no_answer)?;
    canvas.figures(&page.figures).map_err(Failure::no_answer)
}

/// Returns commands that open the comparison, show two alternatives in plots and scene, and draw snapshots.
fn side_by_side() -> Vec<Command> {
    let show = |row| Command::Window(WindowCommand::Comparison(ComparisonCommand::Show(row, true)));
    vec![
        Command::View(ViewChange::Switch(Switch::Compare, true)),
        Command::View(ViewChange::Switch(Switch::Snapshots, true)),
        show(0),
        show(2),
    ]
}

/// Returns commands that show the bare machine with counterweights from the Pareto front, at neither of its ends.
fn designed() -> Vec<Command> {
    vec![
        Command::View(ViewChange::Kind(ViewKind::Design)),
        Command::Session(SessionCommand::Take(16)),
        Command::Session(SessionCommand::EndGesture),
    ]
}

/// Returns commands that draw the machine, with the card of the bar that carries the forearm.
fn drawn() -> Vec<Command> {
    let machine = machine::builtin("nine-link");
    let bar = machine.and_then(|machine| Sketch::of(machine, None).bars.get(4).map(|bar| bar.id));
    vec![
        Command::View(ViewChange::Switch(Switch::Sketching, true)),
        Command::View(ViewChange::Pen(PenChange::Choose(bar.map(SketchItem::Bar)))),
    ]
}

/// Returns commands that stack the links of the nine-link machine so that none meets another along case 3, from the side.
fn stacked() -> Vec<Command> {
    let stack = || {
        let scenario = Scenario::builtin("case-3")?;
        let run = Run::new(&scenario).ok()?;
        let motion = Some(ByIdentity(run.plan().motion.clone()));
        let machine = scenario.machine.clone();
        let request = LayersRequest { machine, cut: Cut::default(), motion, along_task: true };
        let report = find_layers(&request).ok()?;
        Some(Command::Session(SessionCommand::Edit(parts::set_heights(&scenario.machine, &report.machine))))
    };
    let mut commands = vec![Command::View(ViewChange::Kind(ViewKind::Space))];
    commands.extend(stack());
    commands
}

/// Returns commands that show a study of tolerances with a limit on |n_B| of 10 mN m.
fn study() -> Vec<Command> {
    let limit: (String, Value) = ("moment_limit".into(), 0.01.into());
    vec![
        Command::Session(SessionCommand::Edit(Edit::of("tolerance", TaskChange::from_iter([limit])))),
        Command::View(ViewChange::Switch(Switch::Study, true)),
    ]
}

/// Opens a scenario, runs it to its end and shows it at `time`, s.
fn opened(scenario: &str, time: f64) -> Result<AppState, Failure> {
    let scenario = stillbase_files::any_scenario(scenario)?.scenario;
    let mut app_state = AppState::new(scenario, Theme::Dark)?;
    let task_time = app_state.session().length();
    [Command::Session(SessionCommand::Seek(task_time)), Command::Session(SessionCommand::Seek(time))]
        .into_iter()
        .for_each(|command| app_state.carry_out(command));
    Ok(app_state)
}
