//! [`Page`]: figures at their places, with the line that says how they were made.

use std::collections::BTreeSet;

use super::glyphs;
use super::shape::Shape;
use crate::charts::figure::{Figure, FigureItem};
use stillbase_settings::text::plain;

/// Points of 1/72 inch, the unit of type and of PDF, in a millimetre.
pub const POINTS_PER_MM: f32 = 72.0 / 25.4;
/// Length of a pixel of pages of the web, mm.
pub const PIXEL_MM: f32 = 25.4 / 96.0;

/// Figures on a page.
#[derive(Clone, Debug, PartialEq)]
pub struct Page {
    /// Width and height, points of the figures.
    pub size: [f32; 2],
    /// Length of such a point on paper, mm.
    pub point_mm: f32,
    /// What it shows.
    pub title: String,
    /// The command that writes it; empty if there is none.
    pub made: String,
    /// Figures with their upper left corners, points.
    pub figures: Vec<([f32; 2], Figure)>,
}

impl Page {
    /// Returns a page of figures one below the other, with points of 1/72 inch.
    pub fn stacked(title: String, made: String, figures: impl IntoIterator<Item = Figure>) -> Self {
        let (mut size, mut placed) = ([0.0_f32; 2], Vec::new());
        for figure in figures {
            let [width, height] = figure.size;
            placed.push(([0.0, size[1]], figure));
            size = [size[0].max(width), size[1] + height];
        }
        Self { size, point_mm: 1.0 / POINTS_PER_MM, title, made, figures: placed }
    }

    /// Returns pages beside each other.
    pub fn beside(pages: Vec<Self>) -> Self {
        let mut all = Self::stacked(String::new(), String::new(), []);
        for page in pages {
            let [width, height] = page.size;
            let left = all.size[0];
            all.figures.extend(page.figures.into_iter().map(|([x, y], figure)| ([left + x, y], figure)));
            all.size = [left + width, all.size[1].max(height)];
        }
        all
    }

    /// Returns a page of the web with one figure, whose points are pixels.
    pub fn of_web(figure: Figure) -> Self {
        Self { point_mm: PIXEL_MM, ..Self::stacked(figure.title.clone(), String::new(), [figure]) }
    }

    /// Returns what to say of letters that the fonts lack, if there are any.
    pub fn note(&self) -> Option<String> {
        let letters: Vec<String> = self.missing_letters().into_iter().map(String::from).collect();
        let list = plain(&letters.join(" ")).into_owned();
        (!letters.is_empty()).then(|| format!("the font of pictures lacks {list}: boxes stand in their places"))
    }

    /// Returns the letters that the fonts lack, each once.
    fn missing_letters(&self) -> BTreeSet<char> {
        let items = self.figures.iter().flat_map(|(_, figure)| &figure.items);
        let words = items.flat_map(|item| match item {
            FigureItem::Text { words, .. } => &words[..],
            _ => &[],
        });
        words.flat_map(|own| glyphs::missing(&own.text, own.bold)).collect()
    }

    /// Returns the shapes in order of painting.
    pub fn shapes(&self) -> Vec<Shape> {
        let of = |([x, y], figure): &([f32; 2], Figure)| {
            let [left, top, right, bottom] = figure.axes.clip();
            let clip = [x + left, y + top, x + right, y + bottom];
            let behind = figure.behind().into_iter();
            behind.chain(figure.items.iter().cloned()).flat_map(|item| Shape::of(&item, [*x, *y], clip)).collect()
        };
        self.figures.iter().flat_map(|placed| -> Vec<Shape> { of(placed) }).collect()
    }
}
