//! Bars from which links are cut, and the machine that is balanced with their tails, arms and holes.

use egui::{Align, CollapsingHeader, Layout, RichText, Ui};

use super::brief::materials;
use super::facts::{DesignFacts, FrontMachine};
use crate::theme::{bold, colour, plain};
use crate::widgets::{NumberRow, name, note, reason, send, tip_of, undoable_edit};
use crate::{Command, SessionCommand, lamp};

use stillbase_picture::numbers::signed;
use stillbase_picture::scene::palette::Palette;
use stillbase_session::design::relaxations;
use stillbase_session::{Edit, Session};
use stillbase_study::workshop::{BarsReport, CutMachine, NoCut};

/// Draws the bars, and the result.
pub fn show(ui: &mut Ui, session: &Session, facts: &DesignFacts, p: &Palette, commands: &mut Vec<Command>) {
    let brief = &session.scenario().design;
    let title = RichText::new("As it is cut").font(bold(13.5)).color(colour(p.ink));
    ui.add_space(4.0);
    CollapsingHeader::new(title).id_salt("cut").default_open(brief.as_cut).show_unindented(ui, |ui| {
        let mut weighed = brief.as_cut;
        let tick = ui.checkbox(&mut weighed, "links are flat bars").on_hover_text(tip_of("design.as_cut"));
        if tick.changed() {
            undoable_edit(commands, Edit::set("design.as_cut", weighed));
        }
        if !brief.as_cut {
            return note(ui, p, "Tick it to weigh the tails, arms and holes that a drawing adds.");
        }
        ui.horizontal(|ui| {
            ui.label("material").on_hover_text(tip_of("design.bar_density"));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let own = session.scenario().machine.spec().materials.iter();
                let own = own.map(|material| (material.name.as_str(), material.density));
                materials(ui, "material of the bars", "design.bar_density", brief.bar_density, own, commands);
            });
        });
        for (label, path, metres) in [
            ("bar width", "design.bar_width", brief.bar_width),
            ("bar thickness", "design.bar_thickness", brief.bar_thickness),
            ("holes for pins", "design.pin_diameter", brief.pin_diameter),
        ] {
            let range = 0.1..=1000.0;
            let (unit, slide) = ("mm", range.clone());
            let row = NumberRow { unit, decimals: 1, speed: 0.1, slide, range, ..NumberRow::of(label, path) };
            let mut millimetres = 1e3 * metres;
            let response = row.show(ui, p, &mut millimetres);
            send(commands, &[response], || Edit::set(path, 1e-3 * millimetres));
        }
        match facts.cut.as_ref().and_then(|cut| cut.known()).map(|found| &**found) {
            None => note(ui, p, "weighing …"),
            Some(Ok(found)) => result(ui, session, (facts, found), p, commands),
            Some(Err(why)) => {
                reason(ui, p, &why.to_string());
                if let NoCut::Weights(why) | NoCut::Bounds { why, .. } = why {
                    relaxations(why).iter().for_each(|relaxed| lamp::proposal(ui, relaxed, None, commands));
                }
            }
        }
    });
}

/// Draws the masses and what is left of the balance, with the button that makes the machine so.
fn result(
    ui: &mut Ui,
    session: &Session,
    (facts, found): (&DesignFacts, &CutMachine),
    p: &Palette,
    commands: &mut Vec<Command>,
) {
    let report = BarsReport::of(found);
    let BarsReport { mass, tail, tried, force_residual, coupling_residual, .. } = report;
    let added = signed(found.placed.added_mass, 3);
    let text =
        format!("bars {} kg, counterweights {added} kg, longest tail {} mm", signed(mass, 3), signed(1e3 * tail, 1));
    ui.label(RichText::new(text).font(plain(12.5)));
    let proof = format!(
        "What is cut is balanced to {force_residual:.0e} kg m, {coupling_residual:.0e} kg m². \
         Lengths of bars: the best of {tried} tried; the counterweights on them are the lightest."
    );
    note(ui, p, &proof);
    if let Some(sentence) = report.replaced() {
        ui.label(RichText::new(sentence).font(plain(12.0)));
    }
    let [is, of] = [&session.scenario().machine, &found.placed.machine].map(|machine| machine.spec());
    if (&is.parts, &is.counterweights) == (&of.parts, &of.counterweights) {
        return note(ui, p, "The machine is cut like this.");
    }
    let of_front = |point: &FrontMachine| {
        let of = point.placed.machine.spec();
        (&is.parts, &is.counterweights) == (&of.parts, &of.counterweights)
    };
    let is_taken = facts.front().is_ok_and(|points| points.iter().any(of_front));
    let words = match is_taken {
        true => {
            note(ui, p, "The machine is cut, with counterweights that were taken from the curve on the right.");
            "take the lightest"
        }
        false => "make it so",
    };
    let tip = "Makes the links of these bars, with these counterweights: one step to undo";
    let button = ui.button(RichText::new(words).font(plain(12.0))).on_hover_text(tip);
    name(&button, "Make the links of these bars");
    if button.clicked() {
        commands.push(SessionCommand::TakeCut.into());
        commands.push(SessionCommand::EndGesture.into());
    }
}
