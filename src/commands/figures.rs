//! `stillbase figures`

use std::path::PathBuf;

use clap::Args;
use stillbase::files::write_new;
use stillbase::scenario::Scenario;
use stillbase::scene::palette::Theme;
use stillbase::scene::views::ViewKind;
use stillbase::ui::picture::Canvas;
use stillbase::ui::{Command, Desk};

use super::failure::Failure;
use super::output::say;

/// Draw the pictures of the documentation: the window in both themes and all views, without a display
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

/// Name, scenario, theme, view, instant in s.
const FIGURES: [(&str, &str, Theme, ViewKind, f64); 8] = [
    ("window-dark.png", "case-3", Theme::Dark, ViewKind::Flat, 0.62),
    ("window-light.png", "case-3", Theme::Light, ViewKind::Flat, 0.62),
    ("case-1-dark.png", "case-1", Theme::Dark, ViewKind::Flat, 0.25),
    ("space-dark.png", "case-3", Theme::Dark, ViewKind::Space, 0.62),
    ("tower-dark.png", "case-3", Theme::Dark, ViewKind::Tower, 0.62),
    ("tower-light.png", "case-3", Theme::Light, ViewKind::Tower, 0.62),
    ("joints-dark.png", "case-3", Theme::Dark, ViewKind::Joints, 0.62),
    ("joints-light.png", "case-3", Theme::Light, ViewKind::Joints, 0.62),
];

impl Figures {
    /// Draws them all.
    pub fn run(&self) -> Result<(), Failure> {
        for (name, scenario, theme, view, time) in FIGURES {
            let scenario = Scenario::find(scenario)?;
            let mut desk = Desk::new(scenario, theme)?;
            let task_time = desk.session().length();
            for command in [Command::Seek(task_time), Command::Seek(time), Command::View(view)] {
                desk.carry_out(command);
            }
            let mut canvas = Canvas::new([1440, 900], 1.0).map_err(Failure::no_answer)?;
            let picture = canvas.desk(&mut desk).map_err(Failure::no_answer)?;
            let png = picture.to_png().map_err(Failure::no_answer)?;
            let file = self.output.join(name);
            write_new(&file, &png, self.force)?;
            say(format!("wrote {}", file.display()));
        }
        Ok(())
    }
}
