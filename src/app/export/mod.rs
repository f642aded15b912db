//! Results that leave the window as files: pictures, films, values of signals, and the report. The command line writes
//! the same through the same functions.

mod card;
mod error;
mod film;
mod film_form;
mod picture;
mod picture_form;
mod report;
mod size;
mod values;
mod values_card;
mod values_choice;

pub use card::show;
pub use error::ExportError;
pub use film::{FilmDone, FilmOrder, check_film, write_film};
pub use film_form::FilmForm;
pub use picture::write_picture;
pub use picture_form::PictureForm;
pub use report::{ReportDone, write_report};
pub use size::{DisplaySize, PictureSize};
pub use stillbase_files::row_file::RowForm;
pub use values::{ValuesOrder, values_text, write_values};
pub use values_choice::{SignalChoice, TimeChoice, ValuesChoice};

use super::Shot;
use super::shot::NO_OUTLINES;
use stillbase_picture::scene::palette::Theme;
use stillbase_picture::scene::views::ViewKind;

/// What is to be written, as the user has chosen it.
#[derive(Clone, Debug, PartialEq)]
pub enum Export {
    /// A picture of the instant on display.
    Picture(PictureChoice),
    /// A film of the run.
    Film(FilmChoice),
    /// Values of signals over time.
    Values(ValuesChoice),
    /// A report on machine, task and run.
    Report,
}

/// How pictures look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// What they show.
    pub shot: Shot,
    /// Their size.
    pub size: PictureSize,
    /// Their colours.
    pub theme: Theme,
    /// Whether nothing is drawn behind the scene.
    pub transparent: bool,
    /// Whether the plots stand right of the scene.
    pub plots: bool,
}

/// Choices for a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureChoice {
    /// How it looks.
    pub look: Look,
    /// Format that is suggested; the ending of the file's name decides.
    pub form: PictureForm,
}

impl PictureChoice {
    /// Returns why no such picture can be drawn while a view is shown; `None` if one can.
    pub fn refusal(&self, view: ViewKind) -> Option<&'static str> {
        let is_from_above = self.look.shot != Shot::Window && matches!(view, ViewKind::Flat | ViewKind::Design);
        (self.form.has_outlines() && !is_from_above).then_some(NO_OUTLINES)
    }
}

/// Choices for a film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmChoice {
    /// How its pictures look.
    pub look: Look,
    /// Format that is suggested; the ending of the file's name decides.
    pub form: FilmForm,
    /// Whether it shows the whole run, not only the time that plots show.
    pub whole: bool,
    /// Pictures per second.
    pub fps: f64,
    /// How many times slower than the run it plays.
    pub slow: f64,
}

impl Export {
    /// Returns a picture as the window would show it by default.
    pub fn picture(theme: Theme) -> Self {
        let look = Look { shot: Shot::Scene, size: PictureSize::Display, theme, transparent: false, plots: false };
        Self::Picture(PictureChoice { look, form: PictureForm::Png })
    }

    /// Returns a film with default choices.
    pub fn film(theme: Theme) -> Self {
        let look = Look { shot: Shot::Scene, size: PictureSize::FILM, theme, transparent: false, plots: false };
        Self::Film(FilmChoice { look, form: FilmForm::Gif, whole: true, fps: 25.0, slow: 1.0 })
    }

    /// Returns values of signals with default choices.
    pub fn values() -> Self {
        Self::Values(ValuesChoice { signals: SignalChoice::Plots, times: TimeChoice::Shown, form: RowForm::Csv })
    }

    /// Returns the title of the card with its choices, and of the dialog for its file.
    pub fn title(&self) -> &'static str {
        match self {
            Self::Picture(_) => "Save a picture",
            Self::Film(_) => "Save a film of the run",
            Self::Values(_) => "Save values of signals",
            Self::Report => "Save a report",
        }
    }

    /// Returns the name of such files, in the plural.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Picture(_) => "Pictures",
            Self::Film(_) => "Films",
            Self::Values(_) => "Tables",
            Self::Report => "Reports",
        }
    }

    /// Returns an example of a file name.
    pub fn example(&self) -> &'static str {
        match self {
            Self::Picture(PictureChoice { form, .. }) => match form {
                PictureForm::Png => "picture.png",
                PictureForm::Webp => "picture.webp",
                PictureForm::Svg => "picture.svg",
                PictureForm::Pdf => "picture.pdf",
            },
            Self::Film(FilmChoice { form, .. }) => match form {
                FilmForm::Gif => "film.gif",
                FilmForm::Png => "film.png",
                FilmForm::Webp => "film.webp",
                FilmForm::Mp4 => "film.mp4",
                FilmForm::Frames => "frames",
            },
            Self::Values(ValuesChoice { form: RowForm::Csv, .. }) => "values.csv",
            Self::Values(_) => "values.parquet",
            Self::Report => "report.html",
        }
    }

    /// Returns what follows the scenario in a suggested name, and the file name extensions, the suggested one first.
    /// A folder has no extension.
    pub fn naming(&self) -> (&'static str, Vec<&'static str>) {
        match self {
            Self::Picture(choice) => {
                let mut endings = PictureForm::ALL.map(PictureForm::ending);
                endings.sort_by_key(|ending| *ending != choice.form.ending());
                ("", endings.to_vec())
            }
            Self::Film(choice) => match choice.form.ending() {
                "" => (" frames", Vec::new()),
                ending => ("", vec![ending]),
            },
            Self::Values(choice) => {
                let mut endings = RowForm::ALL.map(RowForm::ending);
                endings.sort_by_key(|ending| *ending != choice.form.ending());
                (" values", endings.to_vec())
            }
            Self::Report => (" report", vec!["html"]),
        }
    }
}
