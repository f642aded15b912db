//! `stillbase figures`

mod guide;
mod paper;
mod run;

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use stillbase_files::row_file::{RowForm, table_bytes};
use stillbase_files::{NewFile, check_new, is_standard};
use stillbase_mechanics::planar::Vector;
use stillbase_picture::print::paper::PrintedFigure;
use stillbase_picture::print::{POINTS_PER_MM, pdf, svg};

use super::exit::print_message;
use super::failure::Failure;
use super::file_form::FileForm;
use super::input::{Settings, above_zero, no_use, point, pose_constant};
use super::output::{Format, say_written, write_file};
use paper::PaperFigure;
use run::RunFigure;

/// Draw figures fit for print, of the paper or of a run, or the pictures of the guide
///
/// --paper draws Table I, Fig. 3, Fig. 4 and Fig. 5 a to c, each as .svg, .pdf and .csv. --what draws a run into one
/// .svg or .pdf, with its numbers in a .csv beside it; --numbers parquet writes them as .parquet. Widths are in mm; type is drawn as outlines, so no font is
/// needed; lines differ in dashes, so grey is enough. The title of each file and the head of its numbers hold the
/// command that writes it again. Without these options, pictures of the guide are drawn: all, or those that are named.
#[derive(Args, Default)]
#[command(after_help = "\
Examples:
  stillbase figures --paper all -o figures
  stillbase figures --paper fig-3 --machine nine-link-geared --point 0.6,0.5 --point 0.4,0.8
  stillbase figures case-1 --what torque,moment -o case-1.pdf
  stillbase figures case-1 --what torque -o - | rsvg-convert -o torque.png
  stillbase figures spot --what turn-map -o turns.pdf --width 120
  stillbase figures case-3 --what linkage --at 0.5 -o linkage.svg --width 120
  stillbase figures window tower -o assets/pictures --force")]
pub struct FiguresArguments {
    /// With --what a scenario; otherwise the names of pictures of the guide, all of them by default
    #[arg(value_name = "SCENARIO")]
    names: Vec<String>,
    /// Draw this figure of the paper, or all
    #[arg(long, value_name = "FIGURE", value_enum, conflicts_with_all = ["what", "names"])]
    paper: Option<PaperFigure>,
    /// Draw these parts of a run, one below the other
    #[arg(long, value_name = "PART,…", value_enum, value_delimiter = ',', requires = "names", requires = "output")]
    what: Vec<RunFigure>,
    /// The folder to write to, by default this one; with --what the .svg or .pdf file. `-` is standard output, for one
    /// figure without its numbers
    #[arg(short, long, value_name = "FOLDER or FILE")]
    output: Option<PathBuf>,
    /// Machine of the figures; default: that of the paper
    #[arg(long, value_name = "MACHINE", requires = "paper")]
    machine: Option<String>,
    /// Point of the end effector, m, of Fig. 3 and Fig. 5; given twice, A and B; default: 0.5,0.5 and 0.55,0.9
    #[arg(long, value_name = "X,Y", requires = "paper", value_parser = point)]
    point: Vec<Vector>,
    /// Pose constant b, rad; may be repeated for Fig. 4, the first is that of Fig. 5 and near those of Fig. 3; default: 2.4
    /// and 5
    #[arg(long, value_name = "B", requires = "paper", value_parser = pose_constant)]
    b: Vec<f64>,
    /// Duration of the motions of Fig. 5, s; default: 1
    #[arg(long, value_name = "T", requires = "paper", value_parser = above_zero)]
    time: Option<f64>,
    /// Instant of the linkage, s; default: the end of the run
    #[arg(long, value_name = "T", requires = "what")]
    at: Option<f64>,
    /// Width of a figure, mm, 40 to 400; default: 85, a column of a journal
    #[arg(long, value_name = "MM", value_parser = width)]
    width: Option<f32>,
    /// Replace files that exist
    #[arg(long)]
    force: bool,
    /// Format of the numbers beside a figure
    #[arg(long, value_name = "FORMAT", value_enum)]
    numbers: Option<NumberForm>,
    #[command(flatten)]
    settings: Settings,
    #[command(flatten)]
    form: FileForm,
}

/// Format of the numbers of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum NumberForm {
    Csv,
    Parquet,
}

/// Formats of a figure, by their endings.
const FIGURE_ENDINGS: [&str; 2] = ["svg", "pdf"];

/// Width of a column of a journal, mm.
const COLUMN_MM: f32 = 85.0;

fn width(text: &str) -> Result<f32, String> {
    let width = text.parse().ok().filter(|width| (40.0..=400.0).contains(width));
    width.ok_or_else(|| "want a width in mm, 40 to 400, such as 85".into())
}

impl FiguresArguments {
    /// Draws what is asked for.
    pub fn run(&self) -> Result<(), Failure> {
        let folder = self.output.as_deref().unwrap_or(Path::new("."));
        let standard = self.standard_ending()?;
        if self.numbers.is_some() && (standard.is_some() || (self.paper.is_none() && self.what.is_empty())) {
            return Err(no_use(
                "--numbers",
                "a file for --what, or a folder for --paper: the numbers lie beside a figure",
            ));
        }
        if let Some(figure) = self.paper {
            return paper::draw(self, figure, folder, standard);
        }
        if !self.what.is_empty() {
            return run::draw(self, folder, standard);
        }
        if self.width.is_some() || !self.settings.is_empty() {
            let why = "pictures of the guide have neither width nor settings: want --paper or --what as well";
            return Err(Failure::wrong_input(why));
        }
        guide::draw(&self.names, folder, self.force)
    }

    /// Returns the ending of the format of a figure on standard output, if one goes there.
    fn standard_ending(&self) -> Result<Option<&'static str>, Failure> {
        let file = self.output.as_deref().filter(|file| is_standard(file));
        if file.is_some() && (self.paper == Some(PaperFigure::All) || (self.paper.is_none() && self.what.is_empty())) {
            let why = "-o - is for one figure, and these are several files: want a folder, or one figure, as \
                       --paper fig-3 -o - or SCENARIO --what torque -o -";
            return Err(Failure::wrong_input(why));
        }
        self.form.check_wanted(&Format { json: false }, file, self.force, &FIGURE_ENDINGS)
    }

    /// Ending of the file of numbers.
    fn numbers_ending(&self) -> &'static str {
        match self.numbers {
            Some(NumberForm::Parquet) => RowForm::Parquet.ending(),
            Some(NumberForm::Csv) | None => RowForm::Csv.ending(),
        }
    }

    /// Width of a figure, points.
    fn width_points(&self) -> f32 {
        self.width.unwrap_or(COLUMN_MM) * POINTS_PER_MM
    }

    /// Returns the options of the width and of the numbers as a shell takes them, each with a space in front.
    fn typed_form(&self) -> String {
        let width = self.width.map_or_else(String::new, |width| format!(" --width {width}"));
        let numbers = self.numbers.map_or_else(String::new, |_| format!(" --numbers {}", self.numbers_ending()));
        width + &numbers
    }
}

/// Writes a figure and its numbers to files, by their endings: all or none.
fn write(figure: &PrintedFigure, files: &[PathBuf], force: bool) -> Result<(), Failure> {
    for file in files {
        check_new(file, force)?;
    }
    let mut begun = Vec::with_capacity(files.len());
    for file in files {
        let ending = file.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        let content = match RowForm::of_ending(ending) {
            Some(form) => table_bytes(&figure.numbers, form, file)?,
            None => drawn(figure, ending),
        };
        begun.push(stillbase_files::write_temporary(file, &content, force)?);
    }
    begun.into_iter().try_for_each(NewFile::finish)?;
    say_note(figure);
    files.iter().for_each(|file| say_written(file));
    Ok(())
}

/// Writes a figure to standard output in the format of an ending.
fn print(figure: &PrintedFigure, ending: &str) -> Result<(), Failure> {
    write_file(Path::new("-"), &drawn(figure, ending), false)?;
    say_note(figure);
    Ok(())
}

fn drawn(figure: &PrintedFigure, ending: &str) -> Vec<u8> {
    if ending.eq_ignore_ascii_case("pdf") { pdf(&figure.page) } else { svg(&figure.page).into_bytes() }
}

/// Says which letters the font lacks.
fn say_note(figure: &PrintedFigure) {
    figure.page.note().into_iter().for_each(|note| print_message(format!("note: {note}")));
}
