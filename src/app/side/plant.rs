//! The section *Plant* of the panel on the left, what differs in the machine that moves: payload, friction, torque
//! limits, links, lengths, a force.

use egui::Ui;

use super::fold::{NumberField, Section, Slide, choose, fold, once, switch, switch_nonzero};
use crate::app::Command;
use crate::app::widgets::{Row, note, unit};
use crate::mechanics::machine::{Link, Machine};
use crate::picture::scene::palette::Palette;
use crate::session::Session;
use crate::session::scenario::Value;
use crate::simulation::plant::{Each, LinkDifference, PlantDifferences};

/// How much differs.
fn count(plant: &PlantDifferences) -> usize {
    let PlantDifferences { torque_limits, force, payload, friction, length, link } = plant;
    let single = [*torque_limits, *force != [0.0; 2], payload.is_some(), *friction != Default::default()];
    single.into_iter().filter(|x| *x).count() + length.len() + link.len()
}

/// Draws this section.
pub fn show(ui: &mut Ui, session: &Session, p: &Palette, commands: &mut Vec<Command>) {
    let (plant, model) = (&session.scenario().plant, &session.scenario().machine);
    let summary = match count(plant) {
        0 => "as the model".into(),
        1 => "1 difference".into(),
        n => format!("{n} differences"),
    };
    let back = (*plant != PlantDifferences::default()).then(|| Section::Plant.all_back(plant));
    fold(ui, p, ("Plant", &summary), back, commands, |ui, commands| {
        payload(ui, plant, p, commands);
        friction(ui, plant, model, p, commands);
        limits(ui, plant, model, p, commands);
        force(ui, plant, p, commands);
        link(ui, plant, model, p, commands);
        length(ui, plant, model, p, commands);
    });
}

fn payload(ui: &mut Ui, plant: &PlantDifferences, p: &Palette, commands: &mut Vec<Command>) {
    const HELD: f64 = 0.3;
    let load = &plant.payload;
    let tip = "A mass at the end effector that control does not know of: it unbalances the machine";
    let on = switch_nonzero(ui, ("payload", tip), load.is_some(), commands, |on| match on {
        true => Section::Plant.set(&["payload", "mass"], HELD),
        false => Section::Plant.back(&["payload"]),
    });
    if !on {
        return;
    }
    let of = |key: &'static str| move |x: f64| Section::Plant.set(&["payload", key], x);
    let field = |label, unit, tip, decimals, speed, range, now| NumberField {
        called: Some(format!("payload {label}")),
        ..NumberField::of(Row { label, unit, tip, decimals, speed, range }, now, 0.0)
    };
    ui.indent("payload", |ui| {
        let tip = "Mass m_p of the payload";
        let mass = NumberField {
            normal: load.mass,
            called: None,
            ..field("payload mass", "kg", tip, 2, 0.01, 0.01..=2.0, load.mass)
        };
        mass.show(ui, p, Slide::Linear, commands, of("mass"));
        let tip = "Inertia I_p of the payload about its own centre of mass";
        field("inertia", "kg m²", tip, 4, 0.0005, 0.0..=1.0, load.inertia).show(
            ui,
            p,
            Slide::No,
            commands,
            of("inertia"),
        );
        for (i, label, tip) in [
            (0, "offset along", "Its centre of mass from the end effector, along the last link"),
            (1, "offset across", "Its centre of mass from the end effector, to the left of the last link"),
        ] {
            field(label, "m", tip, 3, 0.002, -1.0..=1.0, load.offset[i]).show(ui, p, Slide::No, commands, |x| {
                let mut offset = load.offset;
                offset[i] = x;
                Section::Plant.set(&["payload", "offset"], offset.to_vec())
            });
        }
        let tip = "When it is picked up, by a hand that moves with it";
        field("from", "s", tip, 2, 0.01, 0.0..=60.0, load.from).show(ui, p, Slide::No, commands, of("from"));
        let tip = "When it is let go; otherwise it is held to the end";
        ui.horizontal(|ui| {
            let on = switch(ui, ("until", tip), load.until.is_some(), commands, |on| match on {
                true => Section::Plant.set(&["payload", "until"], load.from + 0.5),
                false => Section::Plant.back(&["payload", "until"]),
            });
            if on {
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    unit(ui, p, "s");
                    let mut until = load.until.unwrap_or_default();
                    let row = Row {
                        label: "until",
                        unit: "s",
                        tip,
                        decimals: 2,
                        speed: 0.01,
                        range: load.from + 0.01..=load.from + 60.0,
                    };
                    let response = row.number(ui, &mut until);
                    super::send(commands, &[response], || Section::Plant.set(&["payload", "until"], until));
                });
            }
        });
    });
}

fn friction(ui: &mut Ui, plant: &PlantDifferences, model: &Machine, p: &Palette, commands: &mut Vec<Command>) {
    let f = &plant.friction;
    let tip = "Friction in the bearings of the drives and in the pins, unknown to control";
    let on = switch_nonzero(ui, ("friction", tip), *f != Default::default(), commands, |on| match on {
        true => Section::Plant.set(&["friction", "viscous"], 0.02),
        false => Section::Plant.back(&["friction"]),
    });
    if !on {
        return;
    }
    ui.indent("friction", |ui| {
        let viscous = Gain {
            label: "viscous",
            unit: "N m s",
            tip: "Torque c·v against the rate of a drive relative to the base",
            decimals: 3,
            most: 0.5,
            normal: 0.0,
        };
        viscous.show(ui, (Section::Plant, &["friction", "viscous"]), &f.viscous, model.drives(), p, commands);
        let coulomb = Gain {
            label: "Coulomb",
            unit: "N m",
            tip: "Torque τ_C against sliding; a drive at rest sticks until more than that pulls",
            ..viscous
        };
        coulomb.show(ui, (Section::Plant, &["friction", "coulomb"]), &f.coulomb, model.drives(), p, commands);
        for (label, key, in_unit, tip, now) in [
            (
                "pins viscous",
                "pin_viscous",
                "N m s",
                "In every pin, against the rate between its two links",
                f.pin_viscous,
            ),
            (
                "pins Coulomb",
                "pin_coulomb",
                "N m",
                "In every pin, against sliding; a pin at rest sticks",
                f.pin_coulomb,
            ),
        ] {
            let row = Row { label, unit: in_unit, tip, decimals: 4, speed: 0.0005, range: 0.0..=1.0 };
            NumberField::of(row, now, 0.0)
                .show(ui, p, Slide::No, commands, |x| Section::Plant.set(&["friction", key], x));
        }
    });
}

/// A number for all drives, or one for each.
#[derive(Clone, Copy)]
pub struct Gain<'a> {
    pub label: &'a str,
    pub unit: &'a str,
    pub tip: &'a str,
    pub decimals: usize,
    pub most: f64,
    pub normal: f64,
}

impl Gain<'_> {
    fn field<'a>(&'a self, label: &'a str, now: f64) -> NumberField<'a> {
        let Self { unit, tip, decimals, most, normal, .. } = *self;
        NumberField::of(Row { label, unit, tip, decimals, speed: most / 1000.0, range: 0.0..=most }, now, normal)
    }

    pub fn show(
        &self,
        ui: &mut Ui,
        (of, path): (Section, &[&str]),
        each: &Each,
        n: usize,
        p: &Palette,
        commands: &mut Vec<Command>,
    ) {
        let values = each.of(n);
        match each {
            Each::All(now) => {
                self.field(self.label, *now).show(ui, p, Slide::Linear, commands, |x| of.set(path, x));
            }
            Each::Own(_) => {
                for k in 0..n {
                    let label = format!("{} {}", self.label, k + 1);
                    self.field(&label, values[k]).show(ui, p, Slide::No, commands, |x| {
                        let mut list = values.to_vec();
                        list[k] = x;
                        of.set(path, list)
                    });
                }
            }
        }
        let mut own = matches!(each, Each::Own(_));
        let tip = format!("{}: one number for each drive", self.label);
        let tick = ui.checkbox(&mut own, "per drive").on_hover_text(&tip);
        super::name(&tick, &format!("{} per drive", self.label));
        if tick.changed() {
            let value = if own { values.to_vec().into() } else { Value::Float(values[0]) };
            once(commands, of.set(path, value));
        }
    }
}

fn limits(ui: &mut Ui, plant: &PlantDifferences, model: &Machine, p: &Palette, commands: &mut Vec<Command>) {
    let tip = "Motors give no more than the drives' torque limits, whatever control asks for";
    let on = switch(ui, ("torque limits", tip), plant.torque_limits, commands, |on| match on {
        true => Section::Plant.set(&["torque_limits"], true),
        false => Section::Plant.back(&["torque_limits"]),
    });
    if on {
        let limit = |d: &crate::mechanics::machine::Drive| d.torque_limit.map_or("none".into(), |t| format!("{t}"));
        let all: Vec<String> = model.spec().drives.iter().map(limit).collect();
        note(ui, p, &format!("|τ| at most {} N m", all.join(", ")));
    }
}

fn force(ui: &mut Ui, plant: &PlantDifferences, p: &Palette, commands: &mut Vec<Command>) {
    let tip = "A constant force F at the end effector; or push it by hand: Alt and drag, or U";
    let on = switch_nonzero(ui, ("force", tip), plant.force != [0.0; 2], commands, |on| match on {
        true => Section::Plant.set(&["force"], vec![2.0, 0.0]),
        false => Section::Plant.back(&["force"]),
    });
    if !on {
        return;
    }
    ui.indent("force", |ui| {
        for (i, label) in ["force x", "force y"].into_iter().enumerate() {
            let row = Row {
                label,
                unit: "N",
                tip: "F at the end effector, in the axes of the base at the start",
                decimals: 2,
                speed: 0.05,
                range: -50.0..=50.0,
            };
            let field = NumberField::of(row, plant.force[i], 0.0);
            field.show(ui, p, Slide::No, commands, |x| {
                let mut force = plant.force;
                force[i] = x;
                Section::Plant.set(&["force"], force.to_vec())
            });
        }
    });
}

/// The link or length that a list shows: the one chosen last, or else the first that differs.
fn chosen(ui: &Ui, what: &str, first: Option<&String>, exists: impl Fn(&str) -> bool) -> String {
    let taken = ui.data(|d| d.get_temp::<String>(egui::Id::unique(("differs", what))));
    taken.filter(|name| name.is_empty() || exists(name)).or_else(|| first.cloned()).unwrap_or_default()
}

fn pick(
    ui: &mut Ui,
    (what, tip): (&str, &str),
    names: impl Iterator<Item = (String, bool)>,
    now: &str,
    commands: &mut Vec<Command>,
) {
    let mut choices = vec![(String::new(), "none".to_owned())];
    choices.extend(names.map(|(name, differs)| {
        let words = if differs { format!("{name} *") } else { name.clone() };
        (name, words)
    }));
    if let Some(name) = choose(ui, (what, tip), &choices, &now.to_owned(), commands, |_| None) {
        ui.data_mut(|d| d.insert_temp(egui::Id::unique(("differs", what)), name));
        ui.ctx().request_repaint();
    }
}

fn link(ui: &mut Ui, plant: &PlantDifferences, model: &Machine, p: &Palette, commands: &mut Vec<Command>) {
    const WHAT: &str = "a link differs";
    let known = |name: &str| model.links().iter().find(|link| link.name == name);
    let now = chosen(ui, WHAT, plant.link.keys().next(), |name| known(name).is_some());
    let names = model.links().iter().map(|link| (link.name.clone(), plant.link.contains_key(&link.name)));
    pick(ui, (WHAT, "A link that is not as the model has it; * marks those that differ"), names, &now, commands);
    let Some(link) = known(&now) else { return };
    let differs = plant.link.get(&now).copied().unwrap_or_default();
    ui.indent("link", |ui| link_rows(ui, link, &differs, p, commands));
}

fn link_rows(ui: &mut Ui, link: &Link, differs: &LinkDifference, p: &Palette, commands: &mut Vec<Command>) {
    let rows = [
        ("mass", "mass", "kg", "Mass m_j of the link", differs.mass, link.mass, 1e-3..=100.0),
        (
            "com",
            "CM along",
            "m",
            "l_c: centre of mass along the link, from its root",
            differs.com,
            link.com,
            -5.0..=5.0,
        ),
        (
            "com_normal",
            "CM off axis",
            "m",
            "Centre of mass to the left of the link's axis",
            differs.com_normal,
            link.com_normal,
            -5.0..=5.0,
        ),
        (
            "inertia",
            "inertia",
            "kg m²",
            "Inertia I_j about the link's own centre of mass",
            differs.inertia,
            link.inertia,
            0.0..=100.0,
        ),
    ];
    for (key, label, unit, tip, now, normal, range) in rows {
        let path = ["link", link.name.as_str(), key];
        let called = Some(format!("link {} {label}", link.name));
        let row = Row { label, unit, tip, decimals: 3, speed: 0.002, range };
        let field = NumberField {
            row,
            now: now.unwrap_or(normal),
            normal,
            beside: now.is_some(),
            back: Some(Section::Plant.back(&path)),
            called,
        };
        field.show(ui, p, Slide::No, commands, |x| Section::Plant.set(&path, x));
    }
}

fn length(ui: &mut Ui, plant: &PlantDifferences, model: &Machine, p: &Palette, commands: &mut Vec<Command>) {
    const WHAT: &str = "a length differs";
    let lengths = &model.spec().lengths;
    if lengths.is_empty() {
        return;
    }
    let now = chosen(ui, WHAT, plant.length.keys().next(), |name| lengths.contains_key(name));
    let names = lengths.keys().map(|name| (name.clone(), plant.length.contains_key(name)));
    let tip = "A length that is not as the model has it, in all bars that share it, so that parallelograms stay closed";
    pick(ui, (WHAT, tip), names, &now, commands);
    let Some(normal) = lengths.get(&now) else { return };
    let differs = plant.length.get(&now);
    let path = ["length", now.as_str()];
    ui.indent("length", |ui| {
        let called = Some(format!("length {now}"));
        let row = Row { label: &now, unit: "m", tip, decimals: 4, speed: 0.0005, range: 0.01..=10.0 };
        let value = differs.copied().unwrap_or(*normal);
        let back = Some(Section::Plant.back(&path));
        NumberField { row, now: value, normal: *normal, beside: differs.is_some(), back, called }.show(
            ui,
            p,
            Slide::No,
            commands,
            |x| Section::Plant.set(&path, x),
        );
    });
}
