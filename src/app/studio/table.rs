//! The table of links: masses, centres of mass, and counterweights.

use egui::{Align, Layout, Response, RichText, Sense, Stroke, Ui, vec2};

use crate::notation;
use crate::theme::{bold, colour, plain};
use crate::widgets::{NumberRow, heading, name, send, tip_of, undoable_edit};
use crate::{Command, ViewState, fit, place};
use stillbase_mechanics::balance::ParameterBounds;
use stillbase_picture::scene::options::Handle;
use stillbase_picture::scene::palette::Palette;
use stillbase_session::design::{DesignBrief, length_edit};
use stillbase_session::scenario::{TaskChange, Value, to_value};
use stillbase_session::{Edit, Session};
use stillbase_settings::change::DEFAULT_WORD;

use super::{parts, sought};

/// Width of the column of names, width of a column of numbers, gap between columns, and height of a row, points.
const NAME_WIDTH_PT: f32 = 34.0;
pub(super) const NUMBER_WIDTH_PT: f32 = 58.0;
const GAP_PT: f32 = 4.0;
pub(super) const ROW_HEIGHT_PT: f32 = 24.0;

/// Draws the table.
pub fn show(ui: &mut Ui, session: &Session, view_state: &ViewState, commands: &mut Vec<Command>) {
    let p = &view_state.palette();
    heading(ui, p, "Links", "drag, type, right-click to bound; tick to fix");
    ui.spacing_mut().item_spacing = vec2(GAP_PT, 2.0);
    ui.spacing_mut().button_padding.x = 4.0;
    ui.horizontal(|ui| {
        cell(ui, NAME_WIDTH_PT, Align::Min, |ui| head(ui, p, "link"));
        for words in ["mass kg", "CM m", "weight kg", "at m"] {
            cell(ui, NUMBER_WIDTH_PT, Align::Max, |ui| head(ui, p, words));
        }
    });
    let (spec, brief) = (session.scenario().machine.spec(), &session.scenario().design);
    for (i, link) in spec.links.iter().enumerate() {
        let weight = spec.counterweights.iter().position(|weight| weight.link == link.name);
        place::place_of_thing(ui, Handle::Link(i), p, |ui| {
            ui.horizontal(|ui| {
                let drive = session.scenario().machine.resolved_links()[i].drive;
                cell(ui, NAME_WIDTH_PT, Align::Min, |ui| {
                    let (dot, _) = ui.allocate_exact_size(vec2(10.0, ROW_HEIGHT_PT), Sense::hover());
                    ui.painter().circle_filled(dot.center(), 4.0, colour(p.drive(drive)));
                    fit::label(ui, &link.name, bold(12.5), colour(p.ink));
                });
                let path = |key: &str| format!("link.{}.{key}", link.name);
                number(
                    ui,
                    NumberCell {
                        label: &format!("mass of link {}", link.name),
                        path: &path("mass"),
                        decimals: 3,
                        value: link.mass,
                    },
                    brief,
                    p,
                    commands,
                    |x| Edit::at(&["link", &link.name, "mass"], x),
                );
                let label = format!("centre of mass of link {}", link.name);
                number(
                    ui,
                    NumberCell { label: &label, path: &path("com"), decimals: 4, value: link.com },
                    brief,
                    p,
                    commands,
                    |x| Edit::at(&["link", &link.name, "com"], x),
                );
                let Some((n, weight)) = weight.map(|n| (n, &spec.counterweights[n])) else {
                    for _ in 0..2 {
                        cell(ui, NUMBER_WIDTH_PT, Align::Max, |ui| head(ui, p, "–"));
                    }
                    return fixed(ui, &link.name, brief, commands);
                };
                let place = (n + 1).to_string();
                let path = |key: &str| format!("counterweight.{place}.{key}");
                let label = format!("mass of the counterweight of link {}", link.name);
                number(
                    ui,
                    NumberCell { label: &label, path: &path("mass"), decimals: 3, value: weight.mass },
                    brief,
                    p,
                    commands,
                    |mass| {
                        let (key, size) = weight.with_mass(mass).free_size();
                        let both = TaskChange::from_iter([("mass".into(), mass.into()), (key.into(), size.into())]);
                        Edit::of("counterweight", TaskChange::from_iter([(place.clone(), Value::from(both))]))
                    },
                );
                let label = format!("place of the counterweight of link {}", link.name);
                number(
                    ui,
                    NumberCell { label: &label, path: &path("at"), decimals: 4, value: weight.at },
                    brief,
                    p,
                    commands,
                    |x| Edit::at(&["counterweight", &place, "at"], x),
                );
                fixed(ui, &link.name, brief, commands);
            });
        });
    }
    ui.add_space(4.0);
    details(ui, session, p, commands);
}

/// Draws the choice of one link, with its inertia and length.
fn details(ui: &mut Ui, session: &Session, p: &Palette, commands: &mut Vec<Command>) {
    let links = &session.scenario().machine.spec().links;
    let id = ui.scope_id().with("link in detail");
    let at = ui.data(|data| data.get_temp::<usize>(id)).unwrap_or_default();
    let mut at = sought::link(ui, session.scenario().machine.spec()).unwrap_or(at).min(links.len() - 1);
    ui.horizontal(|ui| {
        let words = |i: usize| format!("link {}", links[i].name);
        let list = egui::ComboBox::from_id_salt("detail").selected_text(words(at)).width(62.0).show_ui(ui, |ui| {
            for i in 0..links.len() {
                ui.selectable_value(&mut at, i, words(i));
            }
        });
        name(&list.response, "link in detail");
        let link = &links[at];
        let of = |what: &str| format!("{what} of link {}", link.name);
        head(ui, p, "length");
        let mut length = session.scenario().machine.resolved_links()[at].length;
        let label = of("length");
        let response = NumberRow::of(&label, "length.any").with(3, 1e-3).number(ui, &mut length);
        send(commands, &[response], || length_edit(link, length));
        head(ui, p, "m");
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            head(ui, p, "kg m²");
            let mut inertia = link.inertia;
            let label = of("inertia");
            let path = format!("link.{}.inertia", link.name);
            let response = NumberRow::of(&label, &path).with(5, 1e-4).number(ui, &mut inertia);
            sought::found(ui, &response, &path);
            send(commands, &[response], || Edit::at(&["link", &link.name, "inertia"], inertia));
            head(ui, p, "inertia");
        });
    });
    ui.data_mut(|data| data.insert_temp(id, at));
    off_axis(ui, session, at, p, commands);
    sought::give_up(ui);
    parts::show(ui, &session.scenario().machine, at, p, commands);
}

/// Draws how far off its axis a link, counted from 0, and its counterweights have their centres.
fn off_axis(ui: &mut Ui, session: &Session, at: usize, p: &Palette, commands: &mut Vec<Command>) {
    let spec = session.scenario().machine.spec();
    let (link, brief) = (&spec.links[at], &session.scenario().design);
    let weights = spec.counterweights.iter().enumerate().filter(|(_, weight)| weight.link == link.name);
    ui.horizontal_wrapped(|ui| {
        head(ui, p, "off the axis: CM m");
        let label = format!("centre of mass off the axis of link {}", link.name);
        let path = format!("link.{}.com_normal", link.name);
        let shown = NumberCell { label: &label, path: &path, decimals: 4, value: link.com_normal };
        number(ui, shown, brief, p, commands, |x| Edit::at(&["link", &link.name, "com_normal"], x));
        for (n, weight) in weights {
            head(ui, p, "at m");
            let place = (n + 1).to_string();
            let label = format!("counterweight {place} off the axis of link {}", link.name);
            let path = format!("counterweight.{place}.across");
            let shown = NumberCell { label: &label, path: &path, decimals: 4, value: weight.across };
            number(ui, shown, brief, p, commands, |x| Edit::at(&["counterweight", &place, "across"], x));
        }
    });
}

/// Draws the checkbox that keeps a link unchanged, both when the balance is kept and when counterweights are placed.
fn fixed(ui: &mut Ui, link: &str, brief: &DesignBrief, commands: &mut Vec<Command>) {
    let mut is_fixed = brief.fixed.contains(link);
    let ticked = ui.add(egui::Checkbox::without_text(&mut is_fixed)).on_hover_text(tip_of("design.fixed.*"));
    name(&ticked, &format!("link {link} stays"));
    if ticked.changed() {
        let value = if is_fixed { true.into() } else { Value::from(DEFAULT_WORD) };
        undoable_edit(commands, Edit::at(&["design", "fixed", link], value));
    }
}

pub(super) fn cell<R>(ui: &mut Ui, width: f32, align: Align, add: impl FnOnce(&mut Ui) -> R) -> R {
    let layout = match align {
        Align::Max => Layout::right_to_left(Align::Center),
        _ => Layout::left_to_right(Align::Center),
    };
    ui.allocate_ui_with_layout(vec2(width, ROW_HEIGHT_PT), layout, |ui| {
        ui.set_min_width(width);
        add(ui)
    })
    .inner
}

/// Draws a name, a unit, or a name followed by a unit; an SI unit is shown as the user's unit.
pub(super) fn head(ui: &mut Ui, p: &Palette, words: &str) {
    let (what, unit) = words.rsplit_once(' ').map_or(("", words), |(what, unit)| (what, unit));
    let unit = notation::of(ui.ctx()).unit_name(unit);
    ui.label(RichText::new(format!("{what} {unit}").trim_start()).font(plain(11.0)).color(colour(p.dim)));
}

/// A number of the machine in a cell of the table.
#[derive(Clone, Copy)]
struct NumberCell<'a> {
    label: &'a str,
    /// Key of the setting.
    path: &'a str,
    /// Number of decimals shown.
    decimals: usize,
    /// Present value.
    value: f64,
}

fn number(
    ui: &mut Ui,
    shown: NumberCell<'_>,
    brief: &DesignBrief,
    p: &Palette,
    commands: &mut Vec<Command>,
    edit: impl Fn(f64) -> Edit,
) {
    cell(ui, NUMBER_WIDTH_PT, Align::Max, |ui| {
        let mut value = shown.value;
        let row = NumberRow::of(shown.label, shown.path).with(shown.decimals, 0.002);
        let response = row.number(ui, &mut value);
        sought::found(ui, &response, shown.path);
        holding(ui, &response, shown, brief.hold.get(shown.path).copied(), p, commands);
        send(commands, &[response], || edit(value));
    });
}

/// Draws a line under a number, which shows its state while the balance is kept. A menu sets this state: fixed, free,
/// or free within bounds.
fn holding(
    ui: &Ui,
    response: &Response,
    shown: NumberCell<'_>,
    hold: Option<ParameterBounds>,
    p: &Palette,
    commands: &mut Vec<Command>,
) {
    let NumberCell { label, path, decimals, value: now } = shown;
    let tone = match hold {
        None => None,
        Some(ParameterBounds::Fixed) => Some(p.ink),
        Some(ParameterBounds::Free) => Some(p.zero),
        Some(ParameterBounds::Within(_)) => Some(p.amber),
    };
    if let Some(tone) = tone {
        let (rect, y) = (response.rect, response.rect.bottom() - 2.0);
        ui.painter().hline(rect.x_range().shrink(3.0), y, Stroke::new(1.5, colour(tone)));
    }
    let key: Vec<&str> = ["design", "hold"].into_iter().chain(path.split('.')).collect();
    let held = |hold: Option<ParameterBounds>| Edit::at(&key, hold.map_or_else(|| DEFAULT_WORD.into(), to_value));
    response.context_menu(|ui| {
        ui.set_min_width(190.0);
        ui.label(RichText::new(format!("{label}, while the balance is kept")).font(plain(11.0)).color(colour(p.dim)));
        let path = key.join(".");
        let away = 0.1 * now.abs().max(0.1);
        let (least, greatest) = NumberRow::of(label, &path).range.into_inner();
        let around = [(now - away).max(least), (now + away).min(greatest)];
        let ends = if let Some(ParameterBounds::Within(ends)) = hold { Some(ends) } else { None };
        for (words, one, is) in [
            ("as set for all numbers of its kind", None, hold.is_none()),
            ("stays", Some(ParameterBounds::Fixed), hold == Some(ParameterBounds::Fixed)),
            ("may change", Some(ParameterBounds::Free), hold == Some(ParameterBounds::Free)),
            ("may change within", Some(ParameterBounds::Within(ends.unwrap_or(around))), ends.is_some()),
        ] {
            if ui.radio(is, words).clicked() && hold != one {
                undoable_edit(commands, held(one));
            }
        }
        if let Some([mut low, mut high]) = ends {
            ui.horizontal(|ui| {
                let end = |label: &str, ui: &mut Ui, value: &mut f64| {
                    NumberRow::of(label, &path).with(decimals, 0.002).number(ui, value)
                };
                let one = end(&format!("least {label}"), ui, &mut low);
                ui.label("to");
                let other = end(&format!("greatest {label}"), ui, &mut high);
                send(commands, &[one, other], || held(Some(ParameterBounds::Within([low, high]))));
            });
        }
    });
}
