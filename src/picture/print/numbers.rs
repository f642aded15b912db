//! [`NumberTable`]: the numbers of a figure as a table, with the line that says how it was made.

use std::fmt::Write as _;

use super::plot::PrintPlot;
use stillbase_settings::text::sheet_cell;

/// Numbers of a figure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NumberTable {
    /// Lines about them, without line breaks.
    pub about: Vec<String>,
    /// Names of the columns, with units.
    pub head: Vec<String>,
    /// Cells, row by row.
    pub rows: Vec<Vec<String>>,
}

impl NumberTable {
    /// Returns the table as CSV below its lines, each of which begins with `#`.
    pub fn csv(&self) -> String {
        let mut text = String::new();
        for line in &self.about {
            let _ = writeln!(text, "# {}", line.replace(['\n', '\r'], " "));
        }
        for row in [&self.head].into_iter().chain(&self.rows) {
            let cells: Vec<String> = row.iter().map(|cell| quoted(cell)).collect();
            text += &(cells.join(",") + "\n");
        }
        text
    }
}

/// Quotes a cell if it contains what separates cells. A number begins with its sign; of words, none begins a formula.
fn quoted(cell: &str) -> String {
    let cell = if cell.parse::<f64>().is_ok() { cell.into() } else { sheet_cell(cell) };
    if cell.contains([',', '"', '\n']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.into_owned() }
}

/// Returns the numbers of plots: a row for each point of each curve, with the units in the lines above.
pub fn curves_table(about: &[String], plots: &[PrintPlot]) -> NumberTable {
    let axes = plots.iter().map(|plot| {
        let [x, y] = &plot.axes;
        format!("{}: x is {x}; y is {y}", plot.name)
    });
    let rows = plots.iter().flat_map(|plot| {
        plot.curves.iter().flat_map(move |curve| {
            let cells = move |[x, y]: &[f64; 2]| {
                vec![plot.name.clone(), curve.name.clone(), (x + 0.0).to_string(), (y + 0.0).to_string()]
            };
            curve.points.iter().map(cells)
        })
    });
    NumberTable {
        about: about.iter().cloned().chain(axes).collect(),
        head: ["plot", "curve", "x", "y"].map(String::from).to_vec(),
        rows: rows.collect(),
    }
}
