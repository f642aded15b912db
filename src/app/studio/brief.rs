//! The design brief: whether the balance is kept, and bounds on counterweights, payloads and rotor ratios.

use egui::{Align, Layout, RichText, Ui};

use crate::theme::{bold, colour, plain};
use crate::widgets::{NumberRow, heading, name, send, tip_of, undoable_edit, unit};
use crate::{Command, SessionCommand};
use stillbase_mechanics::counterweights::{CounterweightKind, MATERIALS};
use stillbase_mechanics::machine::{Drive, ranges};
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::palette::Palette;
use stillbase_session::Edit;
use stillbase_session::design::DesignBrief;
use stillbase_session::scenario::{Scenario, Value};
use stillbase_settings::change::DEFAULT_WORD;
use stillbase_settings::word::{Choice, ChoiceWords};

/// Draws the brief.
pub fn show(ui: &mut Ui, scenario: &Scenario, is_balanced: bool, p: &Palette, commands: &mut Vec<Command>) {
    let (spec, brief) = (scenario.machine.spec(), &scenario.design);
    let has_weights = !spec.counterweights.is_empty();
    ui.add_space(10.0);
    keeping(ui, p, brief.keep_balanced, has_weights, is_balanced, commands);
    if !has_weights && spec.links.len() == 9 {
        // The penalties for moving the centres of mass, as in the paper.
        words(ui, ("penalties p", "penalties on centres of mass"), "design.penalties", brief.penalties, commands);
    }
    ui.add_space(8.0);
    heading(ui, p, "Counterweights", "");
    words(ui, ("shape", "shape of the counterweights"), "design.shape", brief.shape, commands);
    ui.horizontal(|ui| {
        ui.label("material").on_hover_text(tip_of("design.density"));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let none = std::iter::empty();
            materials(ui, "material of the counterweights", "design.density", brief.density, none, commands);
        });
    });
    let millimetres = |label, path, range: std::ops::RangeInclusive<f64>| NumberRow {
        unit: "mm",
        decimals: 1,
        speed: 0.1,
        slide: range.clone(),
        range,
        ..NumberRow::of(label, path)
    };
    let mut thickness = 1e3 * brief.thickness;
    let row = millimetres("thickness", "design.thickness", 0.5..=1000.0);
    let response = row.show(ui, p, &mut thickness);
    send(commands, &[response], || Edit::set("design.thickness", 1e-3 * thickness));
    let size = match brief.shape {
        CounterweightKind::Disc => None,
        CounterweightKind::Ring | CounterweightKind::HalfRing => {
            Some(("inner radius", "design.inner_radius", brief.inner_radius, 0.0..=10_000.0))
        }
        CounterweightKind::Box => Some(("width", "design.box_width", brief.box_width, 0.1..=10_000.0)),
    };
    if let Some((label, path, metres, range)) = size {
        let mut size = 1e3 * metres;
        let response = millimetres(label, path, range).show(ui, p, &mut size);
        send(commands, &[response], || Edit::set(path, 1e-3 * size));
    }
    let row = NumberRow::of("behind the root", "design.behind_root").with(3, 0.002);
    draw_bound(
        ui,
        p,
        &BoundRow { number: row, path: "design.behind_root", scale: 1.0 },
        brief.behind_root,
        0.3,
        commands,
    );
    let mut across = 1e3 * brief.across;
    let row = millimetres("off the axis", "design.across", 0.0..=1000.0);
    let response = row.show(ui, p, &mut across);
    send(commands, &[response], || Edit::set("design.across", 1e-3 * across));
    let row = NumberRow::of("heaviest", "design.heaviest").with(2, 0.02);
    draw_bound(ui, p, &BoundRow { number: row, path: "design.heaviest", scale: 1.0 }, brief.heaviest, 5.0, commands);
    let row = millimetres("clear of pins", "design.clearance", 0.0..=1000.0);
    draw_bound(ui, p, &BoundRow { number: row, path: "design.clearance", scale: 1e-3 }, brief.clearance, 5.0, commands);
    payloads(ui, p, brief.payload, spec.payload.mass, commands);
    rotors(ui, p, &spec.drives, brief, commands);
}

/// Draws the list of materials, from which a density, kg/m³, is chosen; `own` are those that the machine adds.
pub(super) fn materials<'a>(
    ui: &mut Ui,
    label: &str,
    path: &str,
    density: f64,
    own: impl Iterator<Item = (&'a str, f64)>,
    commands: &mut Vec<Command>,
) {
    let words = |name: &str, density: f64| format!("{name}, {density} kg/m³");
    let all: Vec<(&str, f64)> = MATERIALS.into_iter().chain(own).collect();
    let known = all.iter().find(|(_, known)| *known == density);
    let shown = known.map_or_else(|| "another".to_owned(), |(name, density)| words(name, *density));
    let list = egui::ComboBox::from_id_salt(label).selected_text(shown).width(172.0).show_ui(ui, |ui| {
        for (name, known) in all {
            if ui.selectable_label(known == density, words(name, known)).clicked() {
                undoable_edit(commands, Edit::set(path, known));
            }
        }
    });
    name(&list.response, label);
}

/// Draws the intervals for gear ratios of rotors: a rotor that turns in reverse can compensate a drive's momentum.
fn rotors(ui: &mut Ui, p: &Palette, drives: &[Drive], brief: &DesignBrief, commands: &mut Vec<Command>) {
    let geared = drives.iter().filter_map(|drive| Some((drive, drive.rotor.filter(|rotor| rotor.inertia > 0.0)?)));
    let mut any = false;
    for (drive, rotor) in geared {
        any = true;
        let path = ["design", "ratio", &drive.name];
        let ends = brief.ratio.get(&drive.name).copied();
        ui.horizontal(|ui| {
            let tip = tip_of("design.ratio.*");
            let words = format!("ratio of drive {}", drive.name);
            let usual = || vec![(-4.0 * rotor.ratio.abs().max(1.0)).max(ranges::RATIO.low()), -1.0].into();
            optional(ui, (&words, tip), ends.is_some(), |value| Edit::at(&path, value), usual, commands);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                unit(ui, p, "");
                let Some([mut low, mut high]) = ends else {
                    ui.label(RichText::new(signed(rotor.ratio, 1)).font(plain(12.0)).color(colour(p.dim)));
                    return;
                };
                let mut end = |what: &str, range: std::ops::RangeInclusive<f64>, value: &mut f64| {
                    let label = format!("{what} ratio of drive {}", drive.name);
                    let (slide, decimals, speed) = (range.clone(), 1, 0.5);
                    NumberRow { label: &label, unit: "", tip, decimals, speed, slide, range }.number(ui, value)
                };
                let both = [
                    end("greatest", low..=ranges::RATIO.high(), &mut high),
                    end("least", ranges::RATIO.low()..=high, &mut low),
                ];
                send(commands, &both, || Edit::at(&path, vec![low, high]));
            });
        });
    }
    if any {
        let tip = "Take the counterweights, and the ratios that may be chosen, with which Σ |D| is least: a drive whose D \
                   is 0 moves without a moment on the base";
        if ui.button(RichText::new("least momentum").font(plain(12.0))).on_hover_text(tip).clicked() {
            commands
                .extend([Command::Session(SessionCommand::TakeStillest), Command::Session(SessionCommand::EndGesture)]);
        }
    }
}

/// Draws the interval of payloads that the balance must cover; `present` is the present payload, kg.
fn payloads(ui: &mut Ui, p: &Palette, ends: Option<[f64; 2]>, present: f64, commands: &mut Vec<Command>) {
    let path = "design.payload";
    ui.horizontal(|ui| {
        let usual = || vec![0.0, if present > 0.0 { 2.0 * present } else { 0.2 }].into();
        let words = ("payload from, to", tip_of(path));
        optional(ui, words, ends.is_some(), |value| Edit::set(path, value), usual, commands);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            unit(ui, p, "kg");
            let Some([mut low, mut high]) = ends else {
                ui.label(RichText::new("as it is").font(plain(12.0)).color(colour(p.dim)));
                return;
            };
            let row = |label, range: std::ops::RangeInclusive<f64>| {
                let row = NumberRow::of(label, path).with(3, 0.005);
                NumberRow { slide: range.clone(), range, ..row }
            };
            let both = [
                row("greatest payload", low..=ranges::LOAD.high()).number(ui, &mut high),
                row("least payload", 0.0..=high).number(ui, &mut low),
            ];
            send(commands, &both, || Edit::set(path, vec![low, high]));
        });
    });
}

/// Draws the switch that keeps the machine balanced.
fn keeping(ui: &mut Ui, p: &Palette, keeps: bool, has_weights: bool, is_balanced: bool, commands: &mut Vec<Command>) {
    let (what, tone) = match (keeps, is_balanced) {
        (false, _) => ("off", p.dim),
        // The machine is out of balance, for example after an undo.
        (true, false) => ("from the next change on", p.reaction),
        (true, true) if has_weights => ("the counterweights follow", p.zero),
        (true, true) => ("the centres of mass follow", p.zero),
    };
    let path = "design.keep_balanced";
    ui.horizontal(|ui| {
        let mut keeps = keeps;
        let words = RichText::new("Keep balanced").font(bold(13.5)).color(colour(p.ink));
        let ticked = ui.checkbox(&mut keeps, words).on_hover_text(tip_of(path));
        name(&ticked, "Keep balanced");
        if ticked.changed() {
            undoable_edit(commands, Edit::set(path, keeps));
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.label(RichText::new(what).font(plain(11.5)).color(colour(tone)));
        });
    });
}

/// Draws a choice among the words of a setting; `read` is its name for a screen reader.
fn words<T: Choice>(ui: &mut Ui, (label, read): (&str, &str), path: &str, now: T, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        ui.label(label).on_hover_text(tip_of(path));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let shown = now.words().screen;
            let list = egui::ComboBox::from_id_salt(path).selected_text(shown).width(172.0).show_ui(ui, |ui| {
                for one in T::ALL {
                    let ChoiceWords { file, screen, meaning } = one.words();
                    if ui.selectable_label(*one == now, screen).on_hover_text(meaning).clicked() {
                        undoable_edit(commands, Edit::set(path, file));
                    }
                }
            });
            name(&list.response, read);
        });
    });
}

/// The row of an optional bound.
pub(super) struct BoundRow<'a> {
    pub number: NumberRow<'a>,
    /// Path of the setting.
    pub path: &'a str,
    /// Factor from the value shown to the value of the setting.
    pub scale: f64,
}

/// Draws an optional bound; ticking it sets the value shown to `initial`.
pub(super) fn draw_bound(
    ui: &mut Ui,
    p: &Palette,
    bound_row: &BoundRow<'_>,
    bound: Option<f64>,
    initial: f64,
    commands: &mut Vec<Command>,
) {
    let BoundRow { number: row, path, scale } = bound_row;
    ui.horizontal(|ui| {
        let words = (row.label, row.tip);
        optional(ui, words, bound.is_some(), |value| Edit::set(path, value), || (scale * initial).into(), commands);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            unit(ui, p, row.unit);
            match bound {
                Some(bound) => {
                    let mut shown = bound / scale;
                    let response = row.number(ui, &mut shown);
                    send(commands, &[response], || Edit::set(path, scale * shown));
                }
                None => {
                    ui.label(RichText::new("any").font(plain(12.0)).color(colour(p.dim)));
                }
            }
        });
    });
}

/// Draws the check box of an optional setting, which sets it to the initial value `usual` or removes it.
pub(super) fn optional(
    ui: &mut Ui,
    (label, tip): (&str, &str),
    is_set: bool,
    edit: impl FnOnce(Value) -> Edit,
    usual: impl FnOnce() -> Value,
    commands: &mut Vec<Command>,
) {
    let mut is_set = is_set;
    if ui.checkbox(&mut is_set, label).on_hover_text(tip).changed() {
        undoable_edit(commands, edit(if is_set { usual() } else { DEFAULT_WORD.into() }));
    }
}
