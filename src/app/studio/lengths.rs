//! The search for link lengths and their counterweights: bounds, required reach and workspace, and the result.

use egui::{Align, CollapsingHeader, Layout, RichText, Ui};

use super::brief::{BoundRow, draw_bound, optional};
use crate::notation;
use crate::theme::{bold, colour, plain};
use crate::widgets::{NumberRow, note, reason, send, tip_of, unit};
use crate::{Command, SessionCommand, WindowCommand};
use stillbase_mechanics::counterweights::Objective;
use stillbase_mechanics::machine::ranges;
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::palette::Palette;
use stillbase_query::{QueryResult, QueryStatus};
use stillbase_session::Edit;
use stillbase_session::scenario::Scenario;
use stillbase_settings::number::counted;
use stillbase_study::lengths::{FoundLengths, NoLengths};

/// A search for link lengths, and its result.
pub type LengthsResult = QueryResult<Result<FoundLengths, NoLengths>>;

/// Draws the search.
pub fn show(
    ui: &mut Ui,
    scenario: &Scenario,
    sought: Option<&LengthsResult>,
    p: &Palette,
    commands: &mut Vec<Command>,
) {
    let title = RichText::new("Lengths").font(bold(13.5)).color(colour(p.ink));
    ui.add_space(4.0);
    let is_open = !scenario.design.length.is_empty();
    CollapsingHeader::new(title).id_salt("lengths").default_open(is_open).show_unindented(ui, |ui| {
        for (name, metres) in scenario.machine.spec().own_lengths() {
            ends(ui, p, name, metres, scenario.design.length.get(name).copied(), commands);
        }
        let brief = &scenario.design;
        if brief.length.is_empty() {
            return note(ui, p, "Tick those that may change: they are sought with the counterweights.");
        }
        let row = NumberRow::of("reach at least", "design.reach").with(3, 0.005);
        draw_bound(
            ui,
            p,
            &BoundRow { number: row, path: "design.reach", scale: 1.0 },
            brief.reach,
            scenario.machine.reach(),
            commands,
        );
        let row = NumberRow::of("workspace at least", "design.workspace").with(3, 0.005);
        draw_bound(
            ui,
            p,
            &BoundRow { number: row, path: "design.workspace", scale: 1.0 },
            brief.workspace,
            0.5,
            commands,
        );
        ui.horizontal(|ui| {
            ui.label(RichText::new("seek").font(plain(12.5)));
            let tip =
                "Several searches over these lengths; the best of what they come across is shown, and nothing changes";
            for (words, objective) in [("least mass", Objective::mass()), ("least inertia", Objective::inertia())] {
                let button = ui.button(RichText::new(words).font(plain(12.0))).on_hover_text(tip);
                crate::widgets::name(&button, &format!("Seek lengths with {words}"));
                if button.clicked() {
                    commands.push(WindowCommand::Seek(objective).into());
                }
            }
        });
        if let Some(sought) = sought {
            found(ui, p, brief.length.keys(), sought, commands);
        }
    });
}

/// Draws the check box that lets a length change, and the bounds of the length, m.
fn ends(ui: &mut Ui, p: &Palette, name: &str, metres: f64, ends: Option<[f64; 2]>, commands: &mut Vec<Command>) {
    let (path, tip) = (["design", "length", name], tip_of("design.length.*"));
    ui.horizontal(|ui| {
        let usual = || vec![0.6 * metres, 1.4 * metres].into();
        optional(ui, (name, tip), ends.is_some(), |value| Edit::at(&path, value), usual, commands);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            unit(ui, p, "m");
            let Some([mut low, mut high]) = ends else {
                ui.label(RichText::new(signed(metres, 3)).font(plain(12.0)).color(colour(p.dim)));
                return;
            };
            let row = |words: &str, range: std::ops::RangeInclusive<f64>, value: &mut f64, ui: &mut Ui| {
                let (label, slide) = (format!("{words} length {name}"), range.clone());
                NumberRow { label: &label, unit: "m", tip, decimals: 3, speed: 0.002, slide, range }.number(ui, value)
            };
            let both = [
                row("greatest", low..=ranges::LENGTH.high(), &mut high, ui),
                row("least", ranges::LENGTH.low()..=high, &mut low, ui),
            ];
            send(commands, &both, || Edit::at(&path, vec![low, high]));
        });
    });
}

/// Draws the result of a search.
fn found<'a>(
    ui: &mut Ui,
    p: &Palette,
    names: impl Iterator<Item = &'a String>,
    sought: &LengthsResult,
    commands: &mut Vec<Command>,
) {
    let Some(outcome) = sought.known() else {
        return note(ui, p, if sought.state == QueryStatus::Stopped { "cancelled" } else { "seeking …" });
    };
    let found = match &**outcome {
        Ok(found) => found,
        Err(why) => {
            reason(ui, p, &why.to_string());
            return;
        }
    };
    let notation = notation::of(ui.ctx());
    let lengths: Vec<String> =
        names.zip(&found.lengths).map(|(name, metres)| format!("{name} {}", notation.write(*metres, 3, "m"))).collect();
    let added = signed(found.placed.added_mass, 2);
    ui.label(RichText::new(format!("{}: {added} kg added", lengths.join(", "))).font(plain(12.5)));
    let [starts, alike] = found.starts;
    let proof = format!(
        "The best of {}; {alike} of {} ended there. Its counterweights are proved the least; its lengths are the best found.",
        counted(found.machines, "machine"),
        counted(starts, "start")
    );
    note(ui, p, &proof);
    let tip = "Gives the machine these lengths and the counterweights that go with them: one step to undo";
    if ui.button(RichText::new("take these lengths").font(plain(12.0))).on_hover_text(tip).clicked() {
        commands.push(SessionCommand::TakeLengths.into());
        commands.push(SessionCommand::EndGesture.into());
    }
}
