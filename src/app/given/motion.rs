//! A given motion, and the nearest reactionless one.

use std::f64::consts::TAU;

use egui::{Align, Grid, Label, Layout, RichText, Ui};
use egui_plot::{Line, LineStyle, PlotPoints};

use super::assess::TableAction;
use super::parts::{COLUMN_GAP, PROPOSAL_WIDTH, TableView, column, rows, take, title, worded};
use crate::plots::{marks, small_axes, spaced};
use crate::study::bare;
use crate::theme::{colour, plain};
use crate::widgets::{name as named, note};
use crate::{Command, ComparisonCommand, Switch, ViewChange, WindowCommand};
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::palette::Palette;
use stillbase_planning::curves::Coordinates;
use stillbase_session::scenario::Scenario;
use stillbase_settings::number::{counted, fixed};
use stillbase_study::import::{GivenMotion, ImportedMotion, MotionImportError, Proposal};

/// Width of the table of numbers, points.
const NUMBERS_WIDTH_PT: f32 = 360.0;
/// Width of the plot of n_B over time, points.
const MOMENT_PLOT_WIDTH_PT: f32 = 300.0;
/// Maximum number of decimals.
const MAX_DECIMALS: usize = 6;

/// Returns a text with the number of samples, their subject and their duration.
pub(super) fn summary(motion: &GivenMotion) -> String {
    let of = if motion.coordinates == Coordinates::Drives { "the drives" } else { "the end effector" };
    let (samples, time) = (counted(motion.samples.count(), "sample"), fixed(motion.samples.duration(), 3));
    format!("{samples} of {of} over {time} s")
}

/// Draws the given motion beside the proposed one.
pub(super) fn show(
    ui: &mut Ui,
    p: &Palette,
    shown: &TableView<'_>,
    motion: &GivenMotion,
    unwrapped: &[usize],
    imported: &Result<ImportedMotion, MotionImportError>,
    commands: &mut Vec<Command>,
) {
    let imported = match imported {
        Ok(imported) => imported,
        Err(why) => {
            let rest = ui.available_width();
            let words = RichText::new(why.to_string()).font(plain(12.5)).color(colour(p.reaction));
            return column(ui, "refused", rest, |ui| drop(ui.add(Label::new(words).wrap())));
        }
    };
    column(ui, "numbers", NUMBERS_WIDTH_PT, |ui| numbers(ui, p, imported));
    let rest = ui.available_width().max(PROPOSAL_WIDTH);
    // The text has priority over the plot where there is no room for both.
    let plot = if rest > 2.0 * MOMENT_PLOT_WIDTH_PT { MOMENT_PLOT_WIDTH_PT } else { 0.0 };
    let rest = if plot > 0.0 { rest - plot - COLUMN_GAP } else { rest };
    column(ui, "proposal", rest, |ui| {
        proposal(ui, p, shown, imported, commands);
        let names = motion.names.iter();
        for (name, turns) in names.clone().zip(unwrapped).filter(|(_, turns)| **turns > 0) {
            let places = counted(*turns, "place");
            note(ui, p, &format!("{name} was wrapped: a whole turn was taken out in {places}"));
        }
        for (name, lift) in names.zip(&motion.lifted).filter(|(_, lift)| **lift != 0.0) {
            let turns = lift / TAU;
            let why = "so that the relative angles begin within their limits";
            note(ui, p, &format!("{name} was lifted by {turns:+.0} turns, {why}"));
        }
        for words in &imported.notes {
            note(ui, p, &worded(words));
        }
    });
    if plot > 0.0 {
        column(ui, "moments", plot, |ui| moments(ui, p, imported));
    }
}

/// Plots the base moment n_B, N m, over time, s, for both motions.
fn moments(ui: &mut Ui, p: &Palette, imported: &ImportedMotion) {
    title(ui, p, "Turning moment on the base n_B", "N m over s; dashed as given");
    let given = imported.given.as_ref().map(|given| &given.moment);
    let proposed = imported.proposal.as_ref().map(|proposal| &proposal.account.moment);
    small_axes(ui);
    let height = ui.available_height().max(60.0);
    let response = bare("moments", p, height)
        .show_axes([true, true])
        .include_y(0.0)
        .x_grid_spacer(move |_| marks(&spaced(0.0, imported.duration), imported.duration))
        .show(ui, |plot| {
            if let Some(points) = given {
                let line = Line::new("as given", PlotPoints::from(points.clone())).color(colour(p.reaction)).width(1.4);
                plot.line(line.style(LineStyle::dashed_dense()).allow_hover(false));
            }
            if let Some(points) = proposed {
                let line = Line::new("proposed", PlotPoints::from(points.clone())).color(colour(p.zero)).width(1.6);
                plot.line(line.allow_hover(false));
            }
        });
    named(&response.response, "Turning moment on the base over time as given and as proposed, N m");
}

fn numbers(ui: &mut Ui, p: &Palette, imported: &ImportedMotion) {
    let usual = if imported.content == "tip" { "minimum norm" } else { "as given" };
    let dim = |text: &str| RichText::new(text.to_owned()).font(plain(11.5)).color(colour(p.dim));
    let number = |ui: &mut Ui, x: Option<f64>, decimals: usize| {
        let text = x.map_or_else(String::new, |x| signed(x, decimals.min(MAX_DECIMALS)));
        let is_nought = text.chars().all(|c| matches!(c, '0' | '.' | '−'));
        let text = RichText::new(text).font(plain(12.5)).color(colour(if is_nought { p.dim } else { p.ink }));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| ui.add(Label::new(text).extend()));
    };
    rows(ui);
    Grid::new("motions").num_columns(4).spacing([14.0, 3.0]).min_col_width(0.0).show(ui, |ui| {
        ui.label("");
        for head in [usual, "proposed"] {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| ui.label(dim(head)));
        }
        ui.end_row();
        for line in imported.lines() {
            ui.label(RichText::new(with_subscripts(&line.name)).font(plain(12.5)));
            number(ui, line.given, line.decimals);
            number(ui, line.proposed, line.decimals);
            ui.label(dim(line.unit));
            ui.end_row();
        }
    });
}

/// Replaces the drive number in `τ_1` by a subscript, as in the plots.
fn with_subscripts(name: &str) -> String {
    let digits = ["₀", "₁", "₂", "₃", "₄", "₅", "₆", "₇", "₈", "₉"];
    let all = digits.iter().enumerate();
    all.fold(name.to_owned(), |name, (i, digit)| name.replace(&format!("τ_{i}"), &format!("τ{digit}")))
}

fn proposal(ui: &mut Ui, p: &Palette, shown: &TableView<'_>, imported: &ImportedMotion, commands: &mut Vec<Command>) {
    let ink = |ui: &mut Ui, words: &str, tone| {
        ui.add(Label::new(RichText::new(words).font(plain(12.5)).color(colour(tone))).wrap());
    };
    match (&imported.proposal, &imported.reason) {
        (Some(proposal), _) => {
            let Proposal { b, why, .. } = proposal;
            let b = if proposal.holds_b() { format!("b = {} rad", signed(*b, 3)) } else { String::new() };
            title(ui, p, &format!("Proposed: {}", proposal.effect()), &b);
            takes(ui, shown, imported, commands);
            ink(ui, &format!("{}: {why}.", proposal.keeps()), p.ink);
        }
        (None, reason) => {
            title(ui, p, "No proposal", "");
            takes(ui, shown, imported, commands);
            let why = reason.as_ref().map_or_else(|| "there is no motion near it without reactions".into(), worded);
            ink(ui, &why, p.reaction);
        }
    }
    ui.add_space(4.0);
}

/// Draws the buttons that apply or compare the motions.
fn takes(ui: &mut Ui, shown: &TableView<'_>, imported: &ImportedMotion, commands: &mut Vec<Command>) {
    let Some(as_given) = &imported.as_given else { return };
    ui.horizontal_wrapped(|ui| {
        if imported.scenarios.is_some() {
            let tip = "Makes it the task of the session: one step to undo";
            take(ui, "Take the proposal", tip, shown, TableAction::Proposal, commands);
        }
        let tip = "Makes the motion as it was given the task of the session, to see what it does to the base";
        take(ui, "Take as given", tip, shown, TableAction::AsGiven, commands);
        let tip = "Runs both, and adds them to the runs side by side";
        let proposal = imported.scenarios.as_ref().map(|[proposal, _]| proposal);
        if let Some(proposal) = proposal
            && ui.button("Compare both").on_hover_text(tip).clicked()
        {
            let add = |scenario: &Scenario| ComparisonCommand::Add(Box::new(scenario.clone()));
            commands.push(ViewChange::Switch(Switch::Compare, true).into());
            let both = [proposal, as_given];
            commands.extend(both.map(|it| Command::Window(WindowCommand::Comparison(add(it)))));
        }
    });
    ui.add_space(4.0);
}
