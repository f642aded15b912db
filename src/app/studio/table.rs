//! The table of links: what they weigh, where their centres of mass are, and their counterweights.

use egui::{Align, Layout, RichText, Sense, Ui, vec2};

use crate::app::command::DesignCommand;
use crate::app::theme::{bold, colour, plain};
use crate::app::widgets::{Row, heading, name, send};
use crate::app::{Command, ViewState, place};
use crate::picture::scene::options::Handle;
use crate::picture::scene::palette::Palette;
use crate::session::scenario::{Change, Value};
use crate::session::{Edit, Session};

/// Widths of the columns, points: the link's name, and each number.
const NAME: f32 = 34.0;
const NUMBER: f32 = 58.0;
const GAP: f32 = 4.0;
const HEIGHT: f32 = 24.0;

/// Draws it.
pub fn show(ui: &mut Ui, session: &Session, view_state: &ViewState, commands: &mut Vec<Command>) {
    let p = &view_state.palette();
    heading(ui, p, "Links", "drag a number, or type it; tick a link to fix it");
    ui.spacing_mut().item_spacing = vec2(GAP, 2.0);
    ui.spacing_mut().button_padding.x = 4.0;
    ui.horizontal(|ui| {
        cell(ui, NAME, Align::Min, |ui| head(ui, p, "link"));
        for words in ["mass kg", "CM m", "disc kg", "at m"] {
            cell(ui, NUMBER, Align::Max, |ui| head(ui, p, words));
        }
    });
    let spec = session.scenario().machine.spec();
    for (i, link) in spec.links.iter().enumerate() {
        let weight = spec.counterweights.iter().position(|weight| weight.link == link.name);
        place::of(ui, Handle::Link(i), p, |ui| {
            ui.horizontal(|ui| {
                let drive = session.scenario().machine.resolved_links()[i].drive;
                cell(ui, NAME, Align::Min, |ui| {
                    let (dot, _) = ui.allocate_exact_size(vec2(10.0, HEIGHT), Sense::hover());
                    ui.painter().circle_filled(dot.center(), 4.0, colour(p.drive(drive)));
                    ui.add(egui::Label::new(RichText::new(&link.name).font(bold(12.5))).truncate());
                });
                let path = |key: &str| format!("link.{}.{key}", link.name);
                number(ui, (&format!("mass of link {}", link.name), &path("mass"), 3), link.mass, commands, |x| {
                    Edit::at(&["link", &link.name, "mass"], x)
                });
                let label = format!("centre of mass of link {}", link.name);
                number(ui, (&label, &path("com"), 4), link.com, commands, |x| {
                    Edit::at(&["link", &link.name, "com"], x)
                });
                let Some((n, weight)) = weight.map(|n| (n, &spec.counterweights[n])) else {
                    for _ in 0..2 {
                        cell(ui, NUMBER, Align::Max, |ui| head(ui, p, "–"));
                    }
                    return fixed(ui, &link.name, view_state, commands);
                };
                let place = (n + 1).to_string();
                let path = |key: &str| format!("counterweight.{place}.{key}");
                let label = format!("mass of the counterweight of link {}", link.name);
                number(ui, (&label, &path("mass"), 3), weight.mass, commands, |mass| {
                    // A disc of the same plate.
                    let radius = weight.radius * (mass / weight.mass).max(0.0).sqrt();
                    let both = Change::from_iter([("mass".into(), mass.into()), ("radius".into(), radius.into())]);
                    Edit::of("counterweight", Change::from_iter([(place.clone(), Value::from(both))]))
                });
                let label = format!("place of the counterweight of link {}", link.name);
                number(ui, (&label, &path("at"), 4), weight.at, commands, |x| {
                    Edit::at(&["counterweight", &place, "at"], x)
                });
                fixed(ui, &link.name, view_state, commands);
            });
        });
    }
}

/// Whether a link stays as it is while the balance is kept.
fn fixed(ui: &mut Ui, link: &str, view_state: &ViewState, commands: &mut Vec<Command>) {
    let mut is_fixed = view_state.brief.fixed.contains(link);
    let tip = "Stays as it is: neither what keeps the balance nor new counterweights change it";
    let ticked = ui.add(egui::Checkbox::without_text(&mut is_fixed)).on_hover_text(tip);
    name(&ticked, &format!("link {link} stays"));
    if ticked.changed() {
        let mut brief = view_state.brief.clone();
        match is_fixed {
            true => brief.fixed.insert(link.to_owned()),
            false => brief.fixed.remove(link),
        };
        commands.push(Command::Design(DesignCommand::Brief(Box::new(brief))));
    }
}

fn cell<R>(ui: &mut Ui, width: f32, align: Align, add: impl FnOnce(&mut Ui) -> R) {
    let layout = match align {
        Align::Max => Layout::right_to_left(Align::Center),
        _ => Layout::left_to_right(Align::Center),
    };
    ui.allocate_ui_with_layout(vec2(width, HEIGHT), layout, |ui| {
        ui.set_min_width(width);
        add(ui)
    });
}

fn head(ui: &mut Ui, p: &Palette, words: &str) {
    ui.label(RichText::new(words).font(plain(11.0)).color(colour(p.dim)));
}

fn number(
    ui: &mut Ui,
    (label, path, decimals): (&str, &str, usize),
    now: f64,
    commands: &mut Vec<Command>,
    edit: impl Fn(f64) -> Edit,
) {
    cell(ui, NUMBER, Align::Max, |ui| {
        let mut value = now;
        let row = Row::of(label, path).with(decimals, 0.002);
        let response = row.number(ui, &mut value);
        send(commands, &[response], || edit(value));
    });
}
