//! The figures of the paper.

mod option;
mod subject;

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use stillbase_files::check_new;
use stillbase_files::new_folder::{check_new_folder, make_folder};
use stillbase_picture::print::Page;
use stillbase_picture::scene::palette::Theme;
use stillbase_settings::number::counted;

use super::{FiguresArguments, print, write};
use crate::exit::print_message;
use crate::failure::Failure;
use option::check_options;
use subject::Subject;

/// A figure of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PaperFigure {
    /// Every one of them
    All,
    /// Table I: parameters of the links, with what they leave of Eqs (7) and (8)
    #[value(name = "table-1")]
    Table1,
    /// Fig. 3: the angle of drive 1 against the pose constants b of two points
    #[value(name = "fig-3")]
    Fig3,
    /// Fig. 4: the reactionless workspaces of two b
    #[value(name = "fig-4")]
    Fig4,
    /// Fig. 5 (a): along a straight line
    #[value(name = "fig-5a")]
    Fig5a,
    /// Fig. 5 (b): to another pose at the end
    #[value(name = "fig-5b")]
    Fig5b,
    /// Fig. 5 (c): on one plane of joint space, without reactions
    #[value(name = "fig-5c")]
    Fig5c,
}

impl PaperFigure {
    /// All figures.
    const EACH: [Self; 6] = [Self::Table1, Self::Fig3, Self::Fig4, Self::Fig5a, Self::Fig5b, Self::Fig5c];

    fn word(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// Returns the files of the figure.
    fn files(self, folder: &Path, numbers: &str) -> [PathBuf; 3] {
        ["svg", "pdf", numbers].map(|ending| folder.join(format!("{}.{ending}", self.word())))
    }
}

/// Draws figures of the paper into a folder, or one to standard output in the format of the ending `standard`.
pub fn draw(
    wanted: &FiguresArguments,
    figure: PaperFigure,
    folder: &Path,
    standard: Option<&str>,
) -> Result<(), Failure> {
    if !(wanted.point.is_empty() || wanted.point.len() == 2) {
        let count = counted(wanted.point.len(), "point");
        return Err(Failure::wrong_input(format!("{count}: want A and B, each with --point X,Y")));
    }
    let all: &[PaperFigure] = if figure == PaperFigure::All { &PaperFigure::EACH } else { &[figure] };
    check_options(wanted, all)?;
    if let Some(ending) = standard {
        let drawn = Subject::of(wanted, Theme::Light)?.figure(figure).map_err(|why| why.with_context(figure.word()))?;
        return print(&drawn, ending);
    }
    let files = |figure: &PaperFigure| figure.files(folder, wanted.numbers_ending());
    // All files are checked first, so that none is written if one cannot be.
    if folder.is_dir() {
        let mut files = all.iter().flat_map(files);
        files.try_for_each(|file| check_new(&file, wanted.force))?;
    } else {
        check_new_folder(folder, false)?;
    }
    let subject = Subject::of(wanted, Theme::Light)?;
    // A machine may lack what one figure shows; the others are drawn.
    let mut refused: Vec<(String, Failure)> = Vec::new();
    for figure in all {
        let word = figure.word();
        match subject.figure(*figure) {
            Ok(drawn) => {
                make_folder(folder)?;
                write(&drawn, &files(figure), wanted.force)?;
            }
            Err(why) => refused.push((word, why)),
        }
    }
    if refused.len() > 1 {
        let words: Vec<&str> = refused.iter().map(|(word, _)| word.as_str()).collect();
        print_message(format!("not drawn: {}; the first because", words.join(", ")));
    }
    refused.into_iter().next().map_or(Ok(()), |(word, why)| Err(why.with_context(word)))
}

/// Returns figures of the paper beside each other, for the guide.
pub fn beside(figures: &[PaperFigure], theme: Theme) -> Result<Page, Failure> {
    let wanted = FiguresArguments::default();
    let subject = Subject::of(&wanted, theme)?;
    let pages: Result<Vec<Page>, Failure> = figures.iter().map(|figure| Ok(subject.figure(*figure)?.page)).collect();
    Ok(Page::beside(pages?))
}
