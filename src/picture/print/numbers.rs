//! The numbers of a figure as a table, with the line that says how it was made.

use super::plot::PrintPlot;
use stillbase_settings::cell_table::{Cell, CellTable};

/// What a row of numbers of a plot is.
const POINT: &str = "point";

/// Returns the numbers of plots: a row for each point of each curve, with the units in the lines above.
pub fn curves_table(about: &[String], plots: &[PrintPlot]) -> CellTable {
    let axes = plots.iter().map(|plot| {
        let [x, y] = &plot.axes;
        format!("{}: x is {x}; y is {y}", plot.name)
    });
    let rows = plots.iter().flat_map(|plot| {
        plot.curves.iter().flat_map(move |curve| {
            let cells = move |[x, y]: &[f64; 2]| {
                vec![Cell::words(&plot.name), Cell::words(&curve.name), Cell::Number(*x), Cell::Number(*y)]
            };
            curve.points.iter().map(cells)
        })
    });
    CellTable {
        row: POINT,
        about: about.iter().cloned().chain(axes).collect(),
        head: ["plot", "curve", "x", "y"].map(String::from).to_vec(),
        rows: rows.collect(),
    }
}
