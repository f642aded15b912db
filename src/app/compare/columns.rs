//! Columns of the table of runs: their titles in two lines, and which of them have room.

use std::sync::Arc;

use egui::{Id, Ui};

use crate::fit::width_of;
use crate::theme::plain;
use stillbase_picture::notation::{NameOrder, Notation};
use stillbase_picture::numbers::signed;
use stillbase_query::ByIdentity;
use stillbase_study::comparison::{Comparison, ComparisonEntry, DESIGN_COLUMNS, SUMMARY_COLUMNS, SummaryColumn};

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

/// Keys of the columns that give way where space is short, in this order.
const GIVE_WAY: [&str; 24] = [
    "beta_force",
    "beta_torque",
    "mass_inertia_factor",
    "coupling_left",
    "force_left",
    "force_impulse",
    "rms_force",
    "saturated_at",
    "moment_impulse",
    "added_inertia",
    "rms_moment",
    "beta_moment",
    "wheel_rate",
    "peak_arm_moment",
    "time",
    "miss",
    "inertia",
    "added_mass",
    "base_tilt",
    "base_shift",
    "energy",
    "mass",
    "peak_torque",
    "peak_force",
];

/// A column as it is drawn.
#[derive(Debug)]
pub struct Head {
    /// Its index among all columns.
    pub at: usize,
    key: &'static str,
    head: &'static str,
    pub meaning: &'static str,
    pub unit: &'static str,
    /// Factor from SI values to displayed values.
    factor: f64,
    decimals: usize,
}

impl Head {
    fn of<T>(at: usize, column: &SummaryColumn<T>, notation: Notation) -> Self {
        let SummaryColumn { key, term, head, meaning, unit, decimals, .. } = *column;
        let head = if notation.names == NameOrder::Symbols { head } else { term };
        match notation.shown_unit(unit) {
            Some(shown) => {
                let decimals = shown.decimals(decimals);
                Self { at, key, head, meaning, unit: shown.name, factor: shown.factor, decimals }
            }
            None => Self { at, key, head, meaning, unit, factor: 1.0, decimals },
        }
    }

    /// Returns the title with its unit in the two lines that need least width.
    fn lines(&self, ui: &Ui) -> [String; 2] {
        let unit = if self.unit == "1" { "" } else { self.unit };
        let words: Vec<&str> = self.head.split(' ').collect();
        let divided = |first: usize| {
            let rest = words[first..].join(" ");
            let parts = [rest.as_str(), unit].into_iter().filter(|part| !part.is_empty());
            [words[..first].join(" "), parts.collect::<Vec<_>>().join(", ")]
        };
        let ways = (1..=words.len()).rev().map(divided);
        let width = |lines: &[String; 2]| lines.iter().map(|line| head_width(ui, line)).fold(0.0, f32::max);
        ways.min_by(|a, b| width(a).total_cmp(&width(b))).unwrap_or_default()
    }

    /// Returns the value of a row as it is written.
    pub fn written(&self, entry: &ComparisonEntry) -> String {
        entry.value(self.at).map_or_else(|| "–".into(), |x| signed(self.factor * x, self.decimals))
    }

    /// Returns its width, points.
    fn width(&self, ui: &Ui, comparison: &Comparison) -> f32 {
        let rows = comparison.entries().iter().filter(|entry| entry.outcome.is_ok());
        let values = rows.map(|entry| width_of(ui, &self.written(entry), &plain(VALUE_SIZE_PT)));
        let [first, second] = self.lines(ui);
        // The arrow of a sorted column has room in every column.
        let title = head_width(ui, &first).max(head_width(ui, &format!("{second} ↓")));
        values.fold(title, f32::max)
    }
}

fn head_width(ui: &Ui, text: &str) -> f32 {
    width_of(ui, text, &plain(HEAD_SIZE_PT))
}

/// Returns the columns that have a value in any row. Columns of base motion need a base that moves; columns of
/// designs need different machines.
fn all(comparison: &Comparison, notation: Notation) -> Vec<Head> {
    let runs = || comparison.entries().iter().filter_map(|e| e.outcome.as_ref().ok());
    let moves = runs().any(|r| r.summary.base_shift > 0.0 || r.summary.base_tilt > 0.0);
    let has_value = |c: &SummaryColumn| runs().any(|r| (c.value)(&r.summary).is_some());
    let all = SUMMARY_COLUMNS.iter().enumerate();
    let of_runs = all.filter(|(_, c)| has_value(c) && (moves || !matches!(c.key, "base_shift" | "base_tilt")));
    let designs = if comparison.has_designs() { &DESIGN_COLUMNS[..] } else { &[] };
    let of_designs = designs.iter().enumerate().map(|(i, c)| Head::of(SUMMARY_COLUMNS.len() + i, c, notation));
    of_runs.map(|(i, c)| Head::of(i, c, notation)).chain(of_designs).collect()
}

/// Columns of a table of runs that have been measured for a width.
#[derive(Debug)]
pub struct ColumnLayout {
    key: LayoutKey,
    /// The columns that have room, each with its title in two lines.
    pub columns: Vec<(Head, [String; 2])>,
    /// Names of the others.
    pub left_out: Vec<&'static str>,
}

/// All that a layout depends on: the table, the notation, the width, points, and the pixels per point.
#[derive(Clone, Debug, PartialEq)]
struct LayoutKey(ByIdentity<()>, Notation, f32, f32);

/// Returns the columns that fit into `width`, points. They are measured again only when the table, the notation or the
/// display has changed.
pub fn laid_out(ui: &Ui, comparison: &Comparison, notation: Notation, width: f32) -> Arc<ColumnLayout> {
    let key = LayoutKey(comparison.version(), notation, width, ui.pixels_per_point());
    let id = Id::unique("columns of the table of runs");
    if let Some(known) = ui.data(|data| data.get_temp::<Arc<ColumnLayout>>(id)).filter(|known| known.key == key) {
        return known;
    }
    let (columns, left_out) = fitting(ui, all(comparison, notation), comparison, width);
    let with_lines = |head: Head| {
        let lines = head.lines(ui);
        (head, lines)
    };
    let columns = columns.into_iter().map(with_lines).collect();
    let layout = Arc::new(ColumnLayout { key, columns, left_out });
    ui.data_mut(|data| data.insert_temp(id, layout.clone()));
    layout
}

/// Returns the columns that fit into `width`, points, beside the titles of the rows, and the names of the others.
fn fitting(ui: &Ui, columns: Vec<Head>, comparison: &Comparison, width: f32) -> (Vec<Head>, Vec<&'static str>) {
    let titles = comparison.entries().iter().map(|entry| {
        let remove = if entry.added_by_user { REMOVE_WIDTH_PT } else { 0.0 };
        NUMBER_WIDTH_PT + width_of(ui, &entry.title, &plain(VALUE_SIZE_PT)) + remove
    });
    let mut room = width - TICK_WIDTH_PT - titles.fold(0.0, f32::max) - 2.0 * COLUMN_GAP_PT;
    let sorted = comparison.sorted().map(|(at, _)| at);
    let important = |head: &Head| match GIVE_WAY.iter().position(|key| *key == head.key) {
        _ if sorted == Some(head.at) => GIVE_WAY.len() + 1,
        Some(place) => place,
        None => GIVE_WAY.len(),
    };
    let mut order: Vec<usize> = (0..columns.len()).collect();
    order.sort_by_key(|i| std::cmp::Reverse(important(&columns[*i])));
    let mut has_room = vec![false; columns.len()];
    for i in order {
        let width = columns[i].width(ui, comparison) + COLUMN_GAP_PT;
        if width <= room {
            room -= width;
            has_room[i] = true;
        }
    }
    let mut left_out = Vec::new();
    let mut kept = Vec::with_capacity(columns.len());
    for (head, has_room) in columns.into_iter().zip(has_room) {
        if has_room {
            kept.push(head);
        } else {
            left_out.push(head.head);
        }
    }
    (kept, left_out)
}
