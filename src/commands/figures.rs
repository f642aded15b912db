//! `stillbase figures`

use std::path::PathBuf;
use std::sync::Arc;

use clap::Args;
use stillbase::app::{AppState, Command, ComparisonCommand};
use stillbase::files::write_new;
use stillbase::picture::canvas::Canvas;
use stillbase::picture::render::offscreen::Picture;
use stillbase::picture::scene::options::ViewOptions;
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::Edit;
use stillbase::session::scenario::{Change, Value};

use super::exit::say;
use super::failure::Failure;

/// Draw the pictures of the documentation: the window in both themes, joint space and the tower, without a display
#[derive(Args)]
#[command(after_help = "Example:\n  stillbase figures -o assets/pictures --force")]
pub struct Figures {
    /// The folder to write to
    #[arg(short, long, value_name = "FOLDER", default_value = ".")]
    output: PathBuf,
    /// Replace pictures that exist
    #[arg(long)]
    force: bool,
}

/// The window: name, scenario, theme, view, instant in s.
const WINDOWS: [(&str, &str, Theme, ViewKind, f64); 5] = [
    ("spacecraft-dark.png", "spacecraft", Theme::Dark, ViewKind::Flat, 0.75),
    ("window-dark.png", "case-3", Theme::Dark, ViewKind::Flat, 0.62),
    ("window-light.png", "case-3", Theme::Light, ViewKind::Flat, 0.62),
    ("case-1-dark.png", "case-1", Theme::Dark, ViewKind::Flat, 0.25),
    ("space-dark.png", "case-3", Theme::Dark, ViewKind::Space, 0.62),
];

/// The scene alone.
const SCENES: [(&str, &str, Theme, ViewKind, f64); 4] = [
    ("tower-dark.png", "case-3", Theme::Dark, ViewKind::Tower, 0.62),
    ("tower-light.png", "case-3", Theme::Light, ViewKind::Tower, 0.62),
    ("joints-dark.png", "case-1", Theme::Dark, ViewKind::Joints, 0.5),
    ("joints-light.png", "case-1", Theme::Light, ViewKind::Joints, 0.5),
];

impl Figures {
    /// Draws them all.
    pub fn run(&self) -> Result<(), Failure> {
        for (name, scenario, theme, view, time) in WINDOWS {
            let mut app_state = opened(scenario, theme, view, time)?;
            self.window(name, &mut app_state)?;
        }
        let mut ways = opened("case-1", Theme::Dark, ViewKind::Flat, 0.62)?;
        let over = [0, 2].map(|row| Command::Comparison(ComparisonCommand::Show(row, true)));
        [Command::Compare(true), Command::Snapshots(true)].into_iter().chain(over).for_each(|c| ways.carry_out(c));
        self.window("compare-dark.png", &mut ways)?;
        let mut machines = opened("case-3", Theme::Dark, ViewKind::Flat, 0.62)?;
        machines.carry_out(Command::Edit(Edit::of("tolerance", Change::from_iter([limit()]))));
        machines.carry_out(Command::Study(true));
        self.window("tolerances-dark.png", &mut machines)?;
        for (name, scenario, theme, view, time) in SCENES {
            let app_state = opened(scenario, theme, view, time)?;
            let (options, camera) = (ViewOptions { theme, ..ViewOptions::default() }, app_state.views().camera(view));
            let scene = Arc::new(app_state.views().scene(view, app_state.session().frame(), &options, &camera));
            let mut canvas = Canvas::new([1200, 1000], 1.25).map_err(Failure::no_answer)?;
            self.write(name, canvas.scene(&scene, &camera).map_err(Failure::no_answer)?)?;
        }
        Ok(())
    }

    fn window(&self, name: &str, app_state: &mut AppState) -> Result<(), Failure> {
        let mut canvas = Canvas::new([1440, 900], 1.0).map_err(Failure::no_answer)?;
        self.write(name, canvas.draw(|ui| app_state.ui(ui)).map_err(Failure::no_answer)?)
    }

    fn write(&self, name: &str, picture: Picture) -> Result<(), Failure> {
        let file = self.output.join(name);
        write_new(&file, &picture.to_png().map_err(Failure::no_answer)?, self.force)?;
        say(format!("wrote {}", file.display()));
        Ok(())
    }
}

/// A limit on |n_B| of 10 mN m.
fn limit() -> (String, Value) {
    ("moment_limit".into(), 0.01.into())
}

/// A scenario run through once, shown at an instant.
fn opened(scenario: &str, theme: Theme, view: ViewKind, time: f64) -> Result<AppState, Failure> {
    let scenario = stillbase::files::scenario(scenario)?;
    let mut app_state = AppState::new(scenario, theme)?;
    let task_time = app_state.session().length();
    for command in [Command::Seek(task_time), Command::Seek(time), Command::View(view)] {
        app_state.carry_out(command);
    }
    Ok(app_state)
}
