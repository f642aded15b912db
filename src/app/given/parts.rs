//! Parts of the panel of a table: its content, its columns, and the buttons that apply results.

use egui::{Align, Button, Label, Layout, RichText, ScrollArea, Ui, vec2};

use super::assess::{OpenedTable, TableAction, TableAssessment, TableContent, TableOptions};
use crate::theme::{bold, colour, plain};
use crate::{Command, SessionCommand, WindowCommand, fit, focus};
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::Rgba;
use stillbase_picture::scene::palette::Palette;
use stillbase_planning::curves::Coordinates;
use stillbase_study::advice::{Advice, Remedy};
use stillbase_study::trim::MeasuredUnknown;

/// Minimum width of the column that describes the proposal, points.
pub(super) const PROPOSAL_WIDTH: f32 = 300.0;

/// Gap between columns, points.
pub(super) const COLUMN_GAP: f32 = 14.0;

/// Content of the panel: the table, its assessment, and whether the assessment belongs to the present session.
#[derive(Clone, Copy)]
pub(crate) struct TableView<'a> {
    pub table: &'a OpenedTable,
    pub answer: Option<&'a Result<TableAssessment, Advice>>,
    pub is_known: bool,
}

impl TableView<'_> {
    /// Returns the type of content; `None` while it is not known.
    pub fn content(&self) -> Option<TableContent> {
        match self.answer {
            Some(Ok(TableAssessment::Measured(_) | TableAssessment::Orbit(_))) => Some(TableContent::Measurement),
            Some(Ok(TableAssessment::Motion { motion, .. })) => match motion.coordinates {
                Coordinates::Drives => Some(TableContent::Drives),
                Coordinates::EndEffector => Some(TableContent::Tip),
            },
            _ => self.table.options.content,
        }
    }

    /// Returns b of the proposed motion, rad.
    pub fn proposed_b(&self) -> Option<f64> {
        let Some(Ok(TableAssessment::Motion { imported, .. })) = self.answer else { return None };
        imported.as_ref().as_ref().ok()?.proposal.as_ref().map(|proposal| proposal.b)
    }

    /// Requests an assessment with changed options.
    pub fn ask(&self, commands: &mut Vec<Command>, change: impl FnOnce(&mut TableOptions)) {
        let mut options = self.table.options.clone();
        change(&mut options);
        commands.push(WindowCommand::Ask(options).into());
    }
}

/// Draws one of the columns side by side; it scrolls if its content does not fit.
pub(super) fn column(ui: &mut Ui, id: &str, width: f32, add: impl FnOnce(&mut Ui)) {
    let height = ui.available_height();
    ui.allocate_ui_with_layout(vec2(width, height), Layout::top_down(Align::LEFT), |ui| {
        ui.set_width(width);
        ScrollArea::vertical().id_salt(id).auto_shrink([false, false]).show(ui, |ui| {
            // Leaves room for the scroll bar.
            ui.set_max_width(width - 10.0);
            add(ui);
            focus::keep_in_view(ui);
        });
    });
    ui.add_space(COLUMN_GAP);
}

/// Makes the rows of a table as high as their text.
pub(super) fn rows(ui: &mut Ui) {
    ui.spacing_mut().interact_size.y = 16.0;
}

fn right(ui: &mut Ui, text: RichText) {
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| ui.add(Label::new(text).extend()));
}

/// Draws the heads of a table of measured numbers, after an empty one for their names.
pub(super) fn heads(ui: &mut Ui, p: &Palette, heads: &[&str]) {
    ui.label("");
    for head in heads {
        right(ui, RichText::new(*head).font(plain(11.5)).color(colour(p.dim)));
    }
    ui.end_row();
}

/// Draws the name of a measured number, and whether it is off. Returns the colour of its value.
pub(super) fn name_cell(ui: &mut Ui, p: &Palette, MeasuredUnknown { name, off, .. }: &MeasuredUnknown) -> Rgba {
    let tone = if *off { p.reaction } else { p.ink };
    let words = if *off { format!("{name} is off") } else { name.clone() };
    ui.label(RichText::new(words).font(plain(12.5)).color(colour(tone)));
    tone
}

/// Draws a number of a table, or a dash.
pub(super) fn number_cell(ui: &mut Ui, x: Option<f64>, tone: Rgba) {
    let words = x.map_or_else(|| "–".to_owned(), |x| signed(x, 5));
    right(ui, RichText::new(words).font(plain(12.5)).color(colour(tone)));
}

/// Draws the unit at the end of a row of a table.
pub(super) fn unit_cell(ui: &mut Ui, p: &Palette, unit: &str) {
    ui.label(RichText::new(unit).font(plain(11.5)).color(colour(p.dim)));
    ui.end_row();
}

/// Draws a title within a column.
pub(super) fn title(ui: &mut Ui, p: &Palette, title: &str, rest: &str) {
    ui.horizontal(|ui| {
        ui.set_height(18.0);
        ui.label(RichText::new(title).font(bold(12.5)));
        fit::label(ui, rest, plain(11.5), colour(p.dim));
    });
}

/// Returns the text of a piece of advice, which names each remedy by its control in the window.
pub(super) fn worded(advice: &Advice) -> String {
    let control = |remedy| match remedy {
        Remedy::Gaps => "“bridge gaps”",
        Remedy::Smoothing | Remedy::CutOff => "smoothing (on the left)",
        Remedy::PoseConstant => "b (on the left)",
        Remedy::Workspace => "the workspace in the scene",
        Remedy::Design => "the design view (D)",
        Remedy::Check => "its panel on the right",
    };
    advice.worded(control).to_string()
}

/// Draws a button that applies a result. It is disabled while the result does not belong to the present session.
pub(super) fn take(
    ui: &mut Ui,
    words: &str,
    tip: &str,
    shown: &TableView<'_>,
    taking: TableAction,
    commands: &mut Vec<Command>,
) {
    let button = ui.add_enabled(shown.is_known, Button::new(words)).on_hover_text(tip);
    if button.on_disabled_hover_text("It is being found for the machine as it is now").clicked() {
        commands.extend([SessionCommand::TakeGiven(taking).into(), SessionCommand::EndGesture.into()]);
    }
}
