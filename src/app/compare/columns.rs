//! Columns of the table of runs: their titles in two lines, and which of them have room.

use egui::Ui;

use crate::fit::width_of;
use crate::theme::plain;
use stillbase_picture::columns::RunColumn;
use stillbase_picture::numbers::signed;
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

/// Returns the columns that fit into `width`, points, beside the titles of the rows, and the names of the others.
pub fn fitting(
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
