//! The names of overlaid runs, with samples of their lines, above the axes of a picture.

use super::figure::{Axes, Figure, FigureItem, FigureText, dashes, run_colour};
use crate::scene::palette::Palette;
use stillbase_settings::range::shortened;
use stillbase_study::comparison::Comparison;

/// An overlaid run.
#[derive(Clone, Debug, PartialEq)]
pub struct RunName {
    /// Its index in the table of runs, from 0.
    pub run: usize,
    /// Its title.
    pub title: String,
}

/// Height of a line of names, least width of a name with its sample, and length of a sample, points.
const LINE_PT: f32 = 16.0;
const MIN_NAME_PT: f32 = 190.0;
const SAMPLE_PT: f32 = 24.0;
/// Size of the font, points, and usual width of a letter as a share of it.
const SIZE_PT: f32 = 11.5;
pub(super) const LETTER_SHARE: f32 = 0.56;
/// Name of the run of the session, which has no number.
const OWN_RUN: &str = "the run on display";

/// Returns the overlaid runs of a comparison.
pub fn run_names(comparison: Option<&Comparison>) -> Vec<RunName> {
    let Some(comparison) = comparison else { return Vec::new() };
    let name = |run: usize| RunName { run, title: comparison.entries()[run].shown_title().to_owned() };
    comparison.shown().map(|(run, _)| name(run)).collect()
}

/// Number of names that stand beside each other in a width, points.
fn columns(width: f32) -> usize {
    (width / MIN_NAME_PT).floor().max(1.0) as usize
}

/// Returns the height of all names in a width, points; 0 without any.
pub fn height(runs: &[RunName], width: f32) -> f32 {
    let lines = if runs.is_empty() { 0 } else { (runs.len() + 1).div_ceil(columns(width)) };
    lines as f32 * LINE_PT
}

/// Returns the names as items within a width, below and to the right of the corner `[left, top]`, points.
pub fn items(runs: &[RunName], [left, top]: [f32; 2], width: f32, p: &Palette) -> Vec<FigureItem> {
    if runs.is_empty() {
        return Vec::new();
    }
    let columns = columns(width);
    let share = width / columns as f32;
    let own = (OWN_RUN, None, p.ink, None);
    let others = runs.iter().map(|name| {
        let number =
            FigureText { text: format!("{}  ", name.run + 1), size: SIZE_PT, bold: true, colour: p.run(name.run) };
        (name.title.as_str(), Some(number), run_colour(name.run, p), dashes(name.run).0)
    });
    let mut items = Vec::new();
    for (i, (title, number, colour, dash)) in std::iter::once(own).chain(others).enumerate() {
        let at = [left + (i % columns) as f32 * share, top + (i / columns) as f32 * LINE_PT + 0.5 * LINE_PT];
        let points = vec![at, [at[0] + SAMPLE_PT, at[1]]];
        items.push(FigureItem::Line { points, width: 1.8, colour, dash, inside: false });
        let most = ((share - SAMPLE_PT - 36.0) / (LETTER_SHARE * SIZE_PT)).max(4.0) as usize - 1;
        let name = FigureText { text: shortened(title, most), size: SIZE_PT, bold: false, colour: p.ink };
        let words = number.into_iter().chain([name]).collect();
        items.push(FigureItem::Text { at: [at[0] + SAMPLE_PT + 6.0, at[1]], anchor: [0.0, 0.5], words });
    }
    items
}

/// Returns the names as a picture of its own, of a width in points; `None` without overlaid runs.
pub fn figure(runs: &[RunName], width: f32, p: &Palette) -> Option<Figure> {
    let size = [width, height(runs, width - 16.0) + 8.0];
    let axes = Axes { sides: [0.0, 0.0, size[0], size[1]], x: [0.0, 1.0], y: [0.0, 1.0] };
    let items = items(runs, [8.0, 4.0], width - 16.0, p);
    (!items.is_empty()).then_some(Figure { title: "Runs".into(), size, background: p.panel, axes, items })
}
