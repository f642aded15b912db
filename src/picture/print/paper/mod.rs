//! The figures of the paper, of any machine.

mod motion;
mod table;
mod turns;

pub use motion::{chart_plot, snapshots_plot, torque_plot};
pub use table::{TableColumn, parameters};
pub use turns::turn_areas;

use super::numbers::curves_table;
use super::page::Page;
use super::plot::{PrintCurve, PrintPlot, PrintWords, pen};
use crate::charts::figure::Figure;
use crate::numbers::round_number;
use crate::scene::palette::{Theme, faded, mix, palette};
use stillbase_mechanics::planar::Vector;
use stillbase_settings::cell_table::CellTable;
use stillbase_study::pose_curves::PoseCurves;
use stillbase_study::workspace::WorkspaceReport;

/// A figure with its numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct PrintedFigure {
    /// The figure.
    pub page: Page,
    /// Its numbers.
    pub numbers: CellTable,
}

/// A part of a page.
#[derive(Clone, Debug, PartialEq)]
pub enum PrintPart {
    /// Curves, whose axes have this height, points.
    Plot(PrintPlot, f32),
    /// A drawing, which is scaled to the width of the page.
    Drawing(Figure),
}

impl PrintedFigure {
    /// Returns parts one below the other, of a width in points; `made` is the command that writes them.
    pub fn of(title: &str, made: &str, width: f32, parts: Vec<PrintPart>) -> Self {
        let (mut figures, mut plots) = (Vec::new(), Vec::new());
        for part in parts {
            match part {
                PrintPart::Plot(plot, height) => {
                    figures.push(plot.figure([width, height]));
                    plots.push(plot);
                }
                PrintPart::Drawing(figure) => {
                    let by = width / figure.size[0];
                    figures.push(figure.scaled(by));
                }
            }
        }
        let page = Page::stacked(title.into(), format!("Made by: {made}"), figures);
        let about = [page.title.clone(), page.made.clone()];
        Self { numbers: curves_table(&about, &plots), page }
    }
}

/// Returns Fig. 3: q_1 against the pose constants b of points, which have names, with the b of all of them shaded.
pub fn which_b(theme: Theme, points: &[(String, Vector)], curves: &PoseCurves) -> PrintPlot {
    let p = palette(theme);
    let mut all = Vec::new();
    for (i, ((name, at), branches)) in points.iter().zip(&curves.of_points).enumerate() {
        let (width, dash) = pen(i);
        let colour = [p.ink, p.drive(0), p.drive(1), p.drive(2)][i % 4];
        let name = format!("{name} ({}, {}) m", round_number(at.re), round_number(at.im));
        for (nth, points) in branches.iter().enumerate() {
            let (name, in_legend) = match nth {
                0 => (name.clone(), true),
                nth => (format!("{name}, branch {}", nth + 1), false),
            };
            all.push(PrintCurve { name, points: points.clone(), colour, width, dash, fill: None, in_legend });
        }
    }
    PrintPlot {
        theme,
        name: "poses".into(),
        head: String::new(),
        axes: ["pose constant b (rad)", "angle of drive 1, q₁ (rad)"].map(String::from),
        words: curves.common.iter().map(|band| named_band(*band, &all)).collect(),
        curves: all,
        bands: curves.common.clone(),
        is_equal: false,
        least_range: 0.0,
        covers: Vec::new(),
    }
}

/// Returns the words in a shaded interval of b, at its lower end.
fn named_band([from, to]: [f64; 2], curves: &[PrintCurve]) -> PrintWords {
    let lowest = curves.iter().flat_map(|curve| &curve.points).fold(f64::INFINITY, |low, [_, q]| low.min(*q));
    PrintWords { at: [0.5 * (from + to), lowest], text: "b of both".into(), dot: false }
}

/// Returns Fig. 4: the reactionless workspaces of several b, rad.
pub fn workspaces(theme: Theme, all: &[(f64, WorkspaceReport)]) -> PrintPlot {
    let p = palette(theme);
    let mut curves = Vec::new();
    let words = vec![PrintWords { at: [0.0; 2], text: "base".into(), dot: true }];
    for (i, (b, report)) in all.iter().enumerate() {
        let (width, dash) = pen(i);
        let colour = if i == 0 { p.ink } else { mix(p.ink, p.dim, 0.5) };
        let closed = |points: &Vec<[f64; 2]>| points.iter().chain(points.first()).copied().collect::<Vec<_>>();
        let loops = report.loops.iter().map(|line| (closed(line), Some(faded(p.dim, [0.30, 0.16][i.min(1)]))));
        let lines = report.curve.iter().filter(|curve| !curve.is_empty()).map(|curve| (curve.clone(), None));
        for (nth, (points, fill)) in loops.chain(lines).enumerate() {
            let name = format!("b = {} rad", round_number(*b));
            let (name, in_legend) = match nth {
                0 => (name, true),
                nth => (format!("{name}, line {}", nth + 1), false),
            };
            curves.push(PrintCurve { name, points, colour, width, dash, fill, in_legend });
        }
    }
    PrintPlot {
        theme,
        name: "workspaces".into(),
        head: String::new(),
        axes: ["x (m)", "y (m)"].map(String::from),
        curves,
        words,
        bands: Vec::new(),
        is_equal: true,
        least_range: 0.0,
        covers: Vec::new(),
    }
}
