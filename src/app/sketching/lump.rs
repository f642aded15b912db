//! The card of a lump, and the lumps in the card of its bar.

use egui::{RichText, Ui};

use super::card::{NumberField, renamed};
use super::section::overruled;
use super::{PenChange, SketchFacts, draw};
use crate::theme::{bold, colour, plain};
use crate::widgets::name;
use crate::{Command, ViewChange};
use stillbase_mechanics::machine::{Lump, PlaceOnLink};
use stillbase_mechanics::sketch::{Bar, SketchStep};
use stillbase_picture::numbers::signed;
use stillbase_picture::scene::palette::Palette;
use stillbase_picture::scene::sketching::SketchItem;
use stillbase_session::parts::new_lump;

/// Farthest place of a lump, m; greatest mass, kg, and inertia, kg m².
const FARTHEST_M: f64 = 100.0;
const LIGHTEST_KG: f64 = 1e-6;
const HEAVIEST_KG: f64 = 1e4;
const MOST_INERTIA: f64 = 1e4;

/// Returns how a lump of a bar is called.
pub fn lump_title(bar: &Bar, number: usize) -> String {
    format!("lump {number} of bar {}", bar.name)
}

/// Draws the card of a lump of a bar, counted from 1.
pub fn show(ui: &mut Ui, facts: &SketchFacts, (bar, number): (&Bar, usize), p: &Palette, commands: &mut Vec<Command>) {
    // While it is dragged, its place is that of the pointer.
    let shown = facts.shown().0;
    let Some(lump) = shown.lumps_of(bar).nth(number - 1) else { return };
    let title = lump_title(bar, number);
    ui.label(RichText::new(format!("Lump {number} of bar {}", bar.name)).font(bold(14.0)));
    let words = "a known mass, such as a motor or screws; no design takes it off";
    ui.label(RichText::new(words).font(plain(11.5)).color(colour(p.dim)));
    let mut set = |lump: Lump| {
        let step = SketchStep::Lump { bar: bar.id, number: Some(number), lump: Some(lump) };
        draw(&facts.sketch, step, commands);
    };
    renamed(ui, &format!("name of {title}"), &lump.name, p, |name| set(Lump { name, ..lump.clone() }));
    let mut field = |words: &str, unit: &str, decimals: usize, value: f64, [least, most]: [f64; 2]| {
        let label = format!("{words} of {title}");
        let speed = 10_f64.powi(-(decimals.min(3) as i32));
        NumberField { label: &label, words, unit, decimals, speed }.show(ui, p, value, least..=most)
    };
    if let Some(mass) = field("mass", "kg", 4, lump.mass, [LIGHTEST_KG, HEAVIEST_KG]) {
        set(Lump { mass, ..lump.clone() });
    }
    let (along, _) = shown.lump_at(bar, lump);
    if let Some(at) = field("along", "m", 4, along, [-FARTHEST_M, FARTHEST_M]) {
        set(Lump { at: facts.sketch.place_along(bar, at), ..lump.clone() });
    }
    if let Some(across) = field("across", "m", 4, lump.across, [-FARTHEST_M, FARTHEST_M]) {
        set(Lump { across, ..lump.clone() });
    }
    if let Some(inertia) = field("inertia", "kg m²", 7, lump.inertia, [0.0, MOST_INERTIA]) {
        set(Lump { inertia, ..lump.clone() });
    }
    overruled(ui, facts, bar, p, commands);
    ui.horizontal_wrapped(|ui| {
        let delete = ui.button("delete").on_hover_text("Take the lump away (Delete)");
        name(&delete, &format!("delete {title}"));
        if delete.clicked() {
            draw(&facts.sketch, SketchStep::Lump { bar: bar.id, number: Some(number), lump: None }, commands);
        }
        let back = ui.button(format!("bar {}", bar.name)).on_hover_text("The card of its bar");
        if back.clicked() {
            commands.push(ViewChange::Pen(PenChange::Choose(Some(SketchItem::Bar(bar.id)))).into());
        }
    });
}

/// Draws the lumps of a bar as buttons that show their cards, and a button that adds one at its tip.
pub fn of_bar(ui: &mut Ui, facts: &SketchFacts, bar: &Bar, p: &Palette, commands: &mut Vec<Command>) {
    let sketch = &facts.sketch;
    let choose = |number: usize| ViewChange::Pen(PenChange::Choose(Some(SketchItem::Lump(bar.id, number)))).into();
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new("lumps").font(plain(12.5)).color(colour(p.dim)));
        for (i, lump) in sketch.lumps_of(bar).enumerate() {
            let button = ui.small_button(format!("{} {} kg", lump.title(), signed(lump.mass, 3)));
            name(&button, &format!("show {}", lump_title(bar, i + 1)));
            if button.clicked() {
                commands.push(choose(i + 1));
            }
        }
        let add = ui.small_button("+ lump").on_hover_text("A known mass at its tip, to be dragged or typed elsewhere");
        name(&add, &format!("add a lump to bar {}", bar.name));
        if add.clicked() {
            let lump = Some(new_lump(&bar.name, PlaceOnLink::Named("tip".into()), 0.0));
            draw(sketch, SketchStep::Lump { bar: bar.id, number: None, lump }, commands);
            commands.push(choose(sketch.lumps_of(bar).count() + 1));
        }
    });
}
