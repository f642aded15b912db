//! Columns of the table of runs: their titles in two lines, and which of them have room.

use std::sync::Arc;

use egui::{Id, Ui};

use crate::fit::width_of;
use crate::theme::plain;
use stillbase_picture::columns::RunColumn;
use stillbase_picture::notation::Notation;
use stillbase_picture::numbers::signed;
use stillbase_query::ByIdentity;
use stillbase_study::comparison::{Comparison, ComparisonEntry};

/// Horizontal distance of columns, points.
pub const COLUMN_GAP_PT: f32 = 12.0;
/// Size of the titles, points.
pub const HEAD_SIZE_PT: f32 = 11.5;
/// Size of the values, points.
const VALUE_SIZE_PT: f32 = 12.5;
/// Width of the checkbox with the line sample beside it, and of the number before a title, points.
const TICK_WIDTH_PT: f32 = 66.0;
const NUMBER_WIDTH_PT: f32 = 22.0;
/// Width of the button that removes a row, points.
const REMOVE_WIDTH_PT: f32 = 24.0;

/// Returns the title of a column with its unit in the two lines that need least width.
pub fn lines(ui: &Ui, column: &RunColumn) -> [String; 2] {
    let words: Vec<&str> = column.head.split(' ').collect();
    let divided = |first: usize| {
        let rest = words[first..].join(" ");
        let parts = [rest.as_str(), column.unit()].into_iter().filter(|part| !part.is_empty());
        [words[..first].join(" "), parts.collect::<Vec<_>>().join(", ")]
    };
    let ways = (1..=words.len()).rev().map(divided);
    let width = |lines: &[String; 2]| lines.iter().map(|line| head_width(ui, line)).fold(0.0, f32::max);
    ways.min_by(|a, b| width(a).total_cmp(&width(b))).unwrap_or_default()
}

/// Returns the value of a row as it is written.
pub fn written(column: &RunColumn, entry: &ComparisonEntry) -> String {
    column.value(entry).map_or_else(|| "–".into(), |x| signed(x, column.format.decimals))
}

/// Returns the width of a column, points.
fn width_of_column(ui: &Ui, column: &RunColumn, comparison: &Comparison) -> f32 {
    let rows = comparison.entries().iter().filter(|entry| entry.outcome.is_ok());
    let values = rows.map(|entry| width_of(ui, &written(column, entry), &plain(VALUE_SIZE_PT)));
    let [first, second] = lines(ui, column);
    // The arrow of a sorted column has room in every column.
    let title = head_width(ui, &first).max(head_width(ui, &format!("{second} ↓")));
    values.fold(title, f32::max)
}

fn head_width(ui: &Ui, text: &str) -> f32 {
    width_of(ui, text, &plain(HEAD_SIZE_PT))
}

/// Columns of a table of runs that have been measured for a width.
#[derive(Debug)]
pub struct ColumnLayout {
    key: LayoutKey,
    /// The columns that have room, each with its title in two lines.
    pub columns: Vec<(RunColumn, [String; 2])>,
    /// Names of the others.
    pub left_out: Vec<&'static str>,
}

/// All that a layout depends on: the table, the notation, the width, points, and the pixels per point.
#[derive(Clone, Debug, PartialEq)]
struct LayoutKey(ByIdentity<()>, Notation, f32, f32);

/// Returns the columns that fit into `width`, points. They are measured again only when the table, the notation, the
/// width or the pixels per point have changed.
pub fn laid_out(ui: &Ui, comparison: &Comparison, notation: Notation, width: f32) -> Arc<ColumnLayout> {
    let key = LayoutKey(comparison.version(), notation, width, ui.pixels_per_point());
    let id = Id::unique("columns of the table of runs");
    if let Some(known) = ui.data(|data| data.get_temp::<Arc<ColumnLayout>>(id)).filter(|known| known.key == key) {
        return known;
    }
    let (columns, left_out) = fitting(ui, RunColumn::all(comparison, notation), comparison, width);
    let with_lines = |column: RunColumn| {
        let lines = lines(ui, &column);
        (column, lines)
    };
    let columns = columns.into_iter().map(with_lines).collect();
    let layout = Arc::new(ColumnLayout { key, columns, left_out });
    ui.data_mut(|data| data.insert_temp(id, layout.clone()));
    layout
}

/// Returns the columns that fit into `width`, points, beside the titles of the rows, and the names of the others.
fn fitting(
    ui: &Ui,
    columns: Vec<RunColumn>,
    comparison: &Comparison,
    width: f32,
) -> (Vec<RunColumn>, Vec<&'static str>) {
    let titles = comparison.entries().iter().map(|entry| {
        let remove = if entry.added_by_user { REMOVE_WIDTH_PT } else { 0.0 };
        NUMBER_WIDTH_PT + width_of(ui, &entry.title, &plain(VALUE_SIZE_PT)) + remove
    });
    let mut room = width - TICK_WIDTH_PT - titles.fold(0.0, f32::max) - 2.0 * COLUMN_GAP_PT;
    let sorted = comparison.sorted().map(|(at, _)| at);
    // The column that the table is sorted by goes first.
    let important = |column: &RunColumn| (sorted == Some(column.at), column.priority);
    let mut order: Vec<usize> = (0..columns.len()).collect();
    order.sort_by_key(|i| std::cmp::Reverse(important(&columns[*i])));
    let mut has_room = vec![false; columns.len()];
    for i in order {
        let width = width_of_column(ui, &columns[i], comparison) + COLUMN_GAP_PT;
        if width <= room {
            room -= width;
            has_room[i] = true;
        }
    }
    let mut left_out = Vec::new();
    let mut kept = Vec::with_capacity(columns.len());
    for (column, has_room) in columns.into_iter().zip(has_room) {
        if has_room {
            kept.push(column);
        } else {
            left_out.push(column.head);
        }
    }
    (kept, left_out)
}
