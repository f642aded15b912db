//! `stillbase render`

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use schemars::JsonSchema;
use serde::Serialize;
use stillbase_app::export::{FilmDone, FilmForm, FilmOrder, PictureForm, check_film, write_film, write_picture};
use stillbase_app::{AppState, PictureOrder, SessionCommand, Shot};
use stillbase_files::is_standard;
use stillbase_picture::scene::palette::Theme;
use stillbase_picture::scene::views::ViewKind;
use stillbase_settings::number::{counted, fixed};

use super::exit::print_message;
use super::failure::Failure;
use super::file_form::FileForm;
use super::input::{DEFAULT_SCENARIO, Settings, no_use, overlay_of_any};
use super::open::ThemeName;
use super::output::{Format, file_words};
use super::progress::{Progress, goes_on};
use super::size::size;

/// Draw a picture or a film of a run, without a display
///
/// A still picture shows the instant --at: as pixels in a .png or .webp, or the view from above, and no other, as
/// outlines in a .svg or .pdf. With --film the run is shown from one time to another. A .gif (slides and mail) or an animated .png or .webp
/// (all colours) repeats forever. A .mp4 is written by the program ffmpeg. A name without an ending gives a folder of
/// numbered pictures.
#[derive(Args)]
#[command(after_help = "\
Examples:
  stillbase render case-3 -o case-3.png --at 0.62
  stillbase render case-3 -o slide.png --view space --theme light --transparent
  stillbase render case-3 -o case-3.svg --theme light --plots
  stillbase render case-3 -o - --format svg > case-3.svg
  stillbase render case-1 -o shake.gif --film --view window
  stillbase render case-1 -o pictures --film 0,0.5 --size 1920x1080
  stillbase render spacecraft -o turning.png --film 0,1 --view space --fps 30 --slow 2")]
pub struct RenderArguments {
    /// A built-in scenario or machine, or a TOML file of either
    #[arg(default_value = DEFAULT_SCENARIO)]
    scenario: String,
    /// The picture (.png, .webp, .svg, .pdf) or film (.gif, .png, .webp, .mp4, or a folder) to write; `-` is standard
    /// output
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Instant of a still picture, s; default: the end of the run
    #[arg(long, value_name = "T", conflicts_with = "film")]
    at: Option<f64>,
    /// A film of the run; from one time to another, s, if they are given
    #[arg(long, value_name = "FROM,TO", num_args = 0..=1, default_missing_value = "", value_parser = range)]
    film: Option<FilmRange>,
    /// Pictures per second of the film
    #[arg(long, value_name = "N", default_value_t = 25.0, requires = "film", value_parser = rate)]
    fps: f64,
    /// Show the film this many times slower than the run
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, requires = "film", value_parser = factor)]
    slow: f64,
    /// The whole window, or one of its views
    #[arg(long, value_enum, default_value_t = ViewName::Flat)]
    view: ViewName,
    /// Colours
    #[arg(long, value_enum, default_value_t = ThemeName::Dark)]
    theme: ThemeName,
    /// Width and height, pixels
    #[arg(long, value_name = "WxH", default_value = "1280x800", value_parser = size)]
    size: [u32; 2],
    /// Draw nothing behind the scene, to lay it over a page or a slide; not in .mp4
    #[arg(long)]
    transparent: bool,
    /// Draw the plots of the window right of the view
    #[arg(long)]
    plots: bool,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    form: FileForm,
    #[command(flatten)]
    format: Format,
}

#[derive(JsonSchema, Serialize)]
pub struct Answer {
    file: String,
    pictures: u32,
    /// First and last instant, s.
    times: [f64; 2],
}

/// Time interval of a film, s; `None` for the whole run.
#[derive(Clone, Copy, Debug)]
struct FilmRange(Option<[f64; 2]>);

/// What is written.
enum Wanted {
    Picture(PictureForm),
    Film(FilmForm, FilmRange),
}

/// What is drawn.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum ViewName {
    /// The whole window
    Window,
    /// The machine from above
    Flat,
    /// The machine in perspective
    Space,
    /// Joint space with its planes
    Joints,
    /// All reactionless workspaces, b as height
    Tower,
}

impl From<ViewName> for Shot {
    fn from(name: ViewName) -> Self {
        match name {
            ViewName::Window => Self::Window,
            ViewName::Flat => Self::View(ViewKind::Flat),
            ViewName::Space => Self::View(ViewKind::Space),
            ViewName::Joints => Self::View(ViewKind::Joints),
            ViewName::Tower => Self::View(ViewKind::Tower),
        }
    }
}

fn range(text: &str) -> Result<FilmRange, String> {
    if text.is_empty() {
        return Ok(FilmRange(None));
    }
    let numbers: Option<Vec<f64>> = text.split(',').map(|x| x.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[from, to]) if from >= 0.0 && to > from && to.is_finite() => Ok(FilmRange(Some([from, to]))),
        _ => Err("want FROM,TO in s, the first less than the second, such as 0,0.5".into()),
    }
}

fn rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|rate| (1.0..=50.0).contains(rate));
    rate.ok_or_else(|| "want pictures per second, 1 to 50".into())
}

fn factor(text: &str) -> Result<f64, String> {
    let factor = text.parse().ok().filter(|factor| (0.01..=1000.0).contains(factor));
    factor.ok_or_else(|| "want a factor, 0.01 to 1000".into())
}

impl RenderArguments {
    /// Draws, and writes the file.
    pub fn run(&self) -> Result<(), Failure> {
        let shot = Shot::from(self.view);
        let Self { transparent, plots, .. } = *self;
        let picture = PictureOrder { transparent, plots, ..PictureOrder::new(shot, self.theme.into(), self.size) };
        let file = &self.output;
        let wanted = self.wanted()?;
        if let Wanted::Film(form, _) = wanted {
            check_film((file, form), &picture, self.force)?;
        }
        if self.transparent && shot == Shot::Window {
            let why = "the window has no background to leave out: want a view, such as --view flat";
            return Err(Failure::wrong_input(why).with_context("--transparent"));
        }
        if self.plots && shot == Shot::Window {
            let why = "the window shows its own plots: want a view, such as --view flat";
            return Err(Failure::wrong_input(why).with_context("--plots"));
        }
        let scenario = overlay_of_any(&self.scenario, &self.settings)?;
        let mut app_state =
            AppState::new(scenario.clone(), Theme::Dark).map_err(|why| Failure::refused(&scenario, why))?;
        let end = app_state.run_to_end();
        let (film_form, range) = match wanted {
            Wanted::Film(form, FilmRange(range)) => (form, range),
            Wanted::Picture(form) => {
                let at = within(self.at.unwrap_or(end), end, "--at")?;
                app_state.carry_out(SessionCommand::Seek(at));
                let note = write_picture(&mut app_state, &picture, (file, form), self.force, &mut |_| goes_on())?;
                note.into_iter().for_each(|note| print_message(format!("note: {note}")));
                return self.print(FilmDone { pictures: 1, times: [at; 2] });
            }
        };
        let [from, to] = range.unwrap_or([0.0, end]);
        let times = [within(from, end, "--film")?, within(to, end, "--film")?];
        let order = FilmOrder { picture, times, fps: self.fps, slow: self.slow };
        let progress = Progress::of_length(u64::from(order.count()?));
        let bar = progress.bar();
        bar.set_message("pictures");
        let goes_on = &mut |done: f64| {
            bar.set_position((done * bar.length().unwrap_or(0) as f64).round() as u64);
            progress.goes_on()
        };
        let done = write_film(&mut app_state, &order, (file, film_form), self.force, goes_on);
        progress.finish();
        self.print(done?)
    }

    /// Returns what is to be written, by the ending of the file or, on standard output, by `--format`.
    fn wanted(&self) -> Result<Wanted, Failure> {
        let check = |endings: &[&'static str]| self.form.check(&self.format, Some(&self.output), self.force, endings);
        match self.film {
            None => {
                let ending = check(&PictureForm::ALL.map(PictureForm::ending))?;
                Ok(Wanted::Picture(PictureForm::of_ending(ending).unwrap_or(PictureForm::Png)))
            }
            Some(range) if is_standard(&self.output) => {
                let endings = FilmForm::ALL.map(FilmForm::ending);
                let files: Vec<&str> = endings.into_iter().filter(|ending| !ending.is_empty()).collect();
                Ok(Wanted::Film(FilmForm::of_ending(check(&files)?).unwrap_or(FilmForm::Gif), range))
            }
            Some(_) if self.form.is_given() => Err(no_use("--format", "-o -: the ending of a file's name chooses")),
            Some(range) => Ok(Wanted::Film(FilmForm::of(&self.output)?, range)),
        }
    }

    fn print(&self, FilmDone { pictures, times }: FilmDone) -> Result<(), Failure> {
        let answer = Answer { file: self.output.display().to_string(), pictures, times };
        let file = file_words(&self.output);
        self.format.print(&answer, |answer| {
            let Answer { pictures, times: [from, to], .. } = answer;
            let when = if from == to {
                format!("at {} s", fixed(*from, 3))
            } else {
                format!("{} to {} s", fixed(*from, 3), fixed(*to, 3))
            };
            format!("{file}: {}, {when}\n", counted(*pictures, "picture"))
        })
    }
}

/// Returns a time, s, if it is within the run.
fn within(time: f64, end: f64, option: &str) -> Result<f64, Failure> {
    // Messages print the end with three decimals; that rounded value must be accepted too.
    let is_within = (0.0..=end + 5e-4).contains(&time);
    is_within.then_some(time.min(end)).ok_or_else(|| {
        Failure::wrong_input(format!("{option} {time}: want a time within the run, 0 to {} s", fixed(end, 3)))
    })
}
