//! Table I: the parameters of the links, and what they leave of Eqs (7) and (8).

use super::PrintedFigure;
use crate::charts::figure::{Axes, Figure, FigureItem, FigureText};
use crate::print::glyphs;
use crate::print::page::Page;
use crate::scene::palette::{Theme, palette};
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_settings::cell_table::{Cell, CellTable};
use stillbase_settings::number::fixed;
use stillbase_study::balance_constants::BalanceConstants;

/// A machine whose centres of mass and residuals are a column.
#[derive(Clone, Debug)]
pub struct TableColumn {
    /// What the column is of, in a word or two.
    pub name: String,
    /// The machine.
    pub machine: Machine,
}

/// Sizes, points.
const TYPE: f32 = 7.5;
const ROW: f32 = 10.5;
/// Least gap between columns, and distance from the sides of the page.
const GAP: f32 = 9.0;
const SIDE: f32 = 4.0;

/// A row of cells; a line is drawn above it if it begins a part.
struct Row {
    cells: Vec<String>,
    begins: bool,
    bold: bool,
}

/// Returns the parameters of the links of machines that differ in their centres of mass; `width` in points.
///
/// # Errors
/// If there is no machine, or their links differ in number.
pub fn parameters(
    theme: Theme,
    title: &str,
    made: &str,
    columns: &[TableColumn],
    width: f32,
) -> Result<PrintedFigure, String> {
    let Some(first) = columns.first() else { return Err("want a machine".into()) };
    let machine = &first.machine;
    if columns.iter().any(|column| column.machine.links().len() != machine.links().len()) {
        return Err("the machines differ in their links: want machines that differ in centres of mass only".into());
    }
    let heads = ["link", "l (m)", "m (kg)", "I (kg m²)"].map(String::from);
    let names = columns.iter().map(|column| match columns.len() {
        1 => "l_c (m)".into(),
        _ => format!("l_c (m)\n{}", column.name),
    });
    let head: Vec<String> = heads.into_iter().chain(names).collect();
    let exact = |j: usize| {
        let (link, part) = (&machine.links()[j], &machine.resolved_links()[j]);
        let numbers = [part.length, link.mass, link.inertia].into_iter();
        let com = columns.iter().map(|column| column.machine.links()[j].com);
        (link.name.clone(), numbers.chain(com).collect::<Vec<f64>>())
    };
    let links: Vec<(String, Vec<f64>)> = (0..machine.links().len()).map(exact).collect();
    let residuals = residuals(columns);
    let mut rows = Vec::new();
    for nth in 0..head.iter().map(|cell| cell.lines().count()).max().unwrap_or(1) {
        let cells = head.iter().map(|cell| cell.lines().nth(nth).unwrap_or_default().to_owned());
        rows.push(Row { cells: cells.collect(), begins: nth == 0, bold: true });
    }
    let head: Vec<String> = head.iter().map(|cell| cell.replace('\n', ", ")).collect();
    for (i, (name, numbers)) in links.iter().enumerate() {
        let decimals = |i: usize| [2, 2, 4].get(i).copied().unwrap_or(4);
        let numbers = numbers.iter().enumerate().map(|(i, x)| fixed(*x, decimals(i)).replace('-', "−"));
        rows.push(Row { cells: [name.clone()].into_iter().chain(numbers).collect(), begins: i == 0, bold: false });
    }
    for (i, (name, unit, values)) in residuals.iter().enumerate() {
        let values = values.iter().map(|x| if *x == 0.0 { "0".into() } else { format!("{x:.1e}").replace('-', "−") });
        let blank = [format!("{name} ({unit})"), String::new(), String::new(), String::new()];
        rows.push(Row { cells: blank.into_iter().chain(values).collect(), begins: i == 0, bold: false });
    }
    let figure = drawn(theme, &rows, width);
    let page = Page::stacked(title.into(), format!("Made by: {made}"), [figure]);
    let row = |name: String, blanks: usize, numbers: &[f64]| -> Vec<Cell> {
        let blanks = std::iter::repeat_n(Cell::Empty, blanks);
        [Cell::Words(name)].into_iter().chain(blanks).chain(numbers.iter().map(|x| Cell::Number(*x))).collect()
    };
    let links = links.into_iter().map(|(name, numbers)| row(name, 0, &numbers));
    let residuals = residuals.into_iter().map(|(name, unit, left)| row(format!("{name} {unit}"), 3, &left));
    let about = vec![page.title.clone(), page.made.clone()];
    let numbers = CellTable { row: "link", about, head, rows: links.chain(residuals).collect() };
    Ok(PrintedFigure { page, numbers })
}

/// Returns what each equation of (7) and (8) leaves, with its unit, for each machine.
fn residuals(columns: &[TableColumn]) -> Vec<(String, &'static str, Vec<f64>)> {
    let constants: Vec<BalanceConstants> =
        columns.iter().map(|column| BalanceConstants::of(&Inertia::of(&column.machine))).collect();
    let Some(column) = columns.first() else { return Vec::new() };
    let drives = &column.machine.spec().drives;
    let all = |of: &dyn Fn(&BalanceConstants) -> Option<f64>| constants.iter().filter_map(of).collect::<Vec<f64>>();
    let force = drives.iter().enumerate().map(|(k, drive)| {
        (
            format!("Eq. (7), drive {}", drive.name),
            "kg m",
            all(&|c: &BalanceConstants| c.gamma_coefficients.get(k).copied()),
        )
    });
    let moment = Inertia::pairs(drives.len()).enumerate().map(|(i, (k, l))| {
        let name = format!("Eq. (8), drives {}, {}", drives[k].name, drives[l].name);
        (name, "kg m²", all(&|c: &BalanceConstants| c.coupling_coefficients.get(i).copied()))
    });
    force.chain(moment).collect()
}

fn drawn(theme: Theme, rows: &[Row], width: f32) -> Figure {
    let columns = rows.iter().map(|row| row.cells.len()).max().unwrap_or(1);
    let wide = |row: &Row, c: usize| row.cells.get(c).map_or(0.0, |cell| glyphs::width(cell, TYPE, row.bold));
    // The first cell of a row may reach over empty ones.
    let is_short = |row: &Row, c: usize| c > 0 || row.cells.get(1).is_some_and(|next| !next.is_empty());
    let widest =
        |c: usize| rows.iter().filter(|row| is_short(row, c)).fold(0.0_f32, |most, row| most.max(wide(row, c)));
    let widths: Vec<f32> = (0..columns).map(widest).collect();
    let long = rows.iter().map(|row| {
        let empty = row.cells.iter().skip(1).take_while(|cell| cell.is_empty()).count();
        let after: f32 = widths[(1 + empty).min(columns)..].iter().sum();
        let gaps = columns - 1 - empty.min(columns - 1);
        wide(row, 0) + after + GAP * gaps as f32
    });
    let least = widths.iter().sum::<f32>() + GAP * (columns - 1) as f32;
    let own = long.fold(least, f32::max) + 2.0 * SIDE;
    // Where the page is too narrow, the type is smaller.
    let figure = drawn_at(theme, rows, &widths, own.max(width));
    if own > width { figure.scaled(width / own) } else { figure }
}

/// Draws the rows in columns that are at least this wide, with equal gaps.
fn drawn_at(theme: Theme, rows: &[Row], widths: &[f32], width: f32) -> Figure {
    let p = palette(theme);
    let (left, right) = (SIDE, width - SIDE);
    let gap = (right - left - widths.iter().sum::<f32>()) / (widths.len().max(2) - 1) as f32;
    let end = |c: usize| left + widths[..=c].iter().sum::<f32>() + gap * c as f32;
    let rule = |y: f32, width: f32| FigureItem::Line {
        points: vec![[left, y], [right, y]],
        width,
        colour: p.ink,
        dash: None,
        inside: false,
    };
    let (mut items, mut y) = (Vec::new(), 5.0);
    for (i, row) in rows.iter().enumerate() {
        if row.begins {
            items.push(rule(y, if i == 0 { 0.8 } else { 0.4 }));
            y += 2.0;
        }
        for (c, cell) in row.cells.iter().enumerate().filter(|(_, cell)| !cell.is_empty()) {
            let (at, anchor) = if c == 0 { ([left, y], [0.0, 0.0]) } else { ([end(c), y], [1.0, 0.0]) };
            let words = vec![FigureText { text: cell.clone(), size: TYPE, bold: row.bold, colour: p.ink }];
            items.push(FigureItem::Text { at, anchor, words });
        }
        y += ROW;
    }
    y += 2.0;
    items.push(rule(y, 0.8));
    let axes = Axes { sides: [0.0, 0.0, width, y + 5.0], x: [0.0, 1.0], y: [0.0, 1.0] };
    Figure { title: "parameters".into(), size: [width, y + 5.0], background: p.background, axes, items }
}
