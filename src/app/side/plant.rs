//! The section *Plant* of the panel on the left: differences of the simulated machine from the model. These are
//! payload, friction, torque limits, links, lengths and a force.

use egui::Ui;

use super::fold::{NumberField, PanelSection, SliderScale, choose, fold, switch, switch_nonzero};
use crate::widgets::{CLICK_PAYLOAD, NumberRow, note, tip_of, undoable_edit, unit};
use crate::{Command, place};
use stillbase_mechanics::machine::{Link, Machine};
use stillbase_picture::scene::options::Handle;
use stillbase_picture::scene::palette::Palette;
use stillbase_session::scenario::Value;
use stillbase_session::{Edit, Session};
use stillbase_simulation::plant::{DriveValues, LinkDifference, PlantDifferences};

/// Returns the number of differences.
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
    let back = (*plant != PlantDifferences::default()).then(|| PanelSection::Plant.all_back());
    fold(ui, p, "Plant", &summary, back, commands, |ui, commands| {
        place::place_of_thing(ui, Handle::Payload, p, |ui| payload(ui, plant, p, commands));
        friction(ui, plant, model, p, commands);
        limits(ui, plant, model, p, commands);
        force(ui, plant, p, commands);
        link(ui, plant, model, p, commands);
        length(ui, plant, model, p, commands);
    });
}

fn payload(ui: &mut Ui, plant: &PlantDifferences, p: &Palette, commands: &mut Vec<Command>) {
    let load = &plant.payload;
    let on = switch_nonzero(ui, ("payload", tip_of("plant.payload.mass")), load.is_some(), commands, |on| match on {
        true => PanelSection::Plant.set(&["payload", "mass"], CLICK_PAYLOAD),
        false => PanelSection::Plant.back(&["payload"]),
    });
    if !on {
        return;
    }
    let of = |key: &'static str| move |x: f64| PanelSection::Plant.set(&["payload", key], x);
    let field = |label, key: &str, now| NumberField {
        called: Some(format!("payload {label}")),
        ..NumberField::of(NumberRow::of(label, &format!("plant.payload.{key}")).with(3, 0.002), now, 0.0)
    };
    ui.indent("payload", |ui| {
        let row = NumberRow::of("payload mass", "plant.payload.mass").sliding(0.01..=2.0);
        NumberField::of(row, load.mass, load.mass).show(ui, p, SliderScale::Linear, commands, of("mass"));
        let inertia = field("inertia", "inertia", load.inertia);
        NumberField { row: inertia.row.with(4, 0.0005), ..inertia }.show(
            ui,
            p,
            SliderScale::No,
            commands,
            of("inertia"),
        );
        for (i, label, tip) in [
            (0, "offset along", "Its centre of mass from the end effector, along the last link"),
            (1, "offset across", "Its centre of mass from the end effector, to the left of the last link"),
        ] {
            let field = field(label, "offset", load.offset[i]);
            NumberField { row: NumberRow { tip, ..field.row }, ..field }.show(ui, p, SliderScale::No, commands, |x| {
                let mut offset = load.offset;
                offset[i] = x;
                PanelSection::Plant.set(&["payload", "offset"], offset.to_vec())
            });
        }
        field("height", "axial", load.axial).show(ui, p, SliderScale::No, commands, of("axial"));
        let from = field("from", "from", load.from);
        NumberField { row: from.row.with(2, 0.01), ..from }.show(ui, p, SliderScale::No, commands, of("from"));
        let tip = tip_of("plant.payload.until");
        ui.horizontal(|ui| {
            let on = switch(ui, ("until", tip), load.until.is_some(), commands, |on| match on {
                true => PanelSection::Plant.set(&["payload", "until"], load.from + 0.5),
                false => PanelSection::Plant.back(&["payload", "until"]),
            });
            if on {
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    unit(ui, p, "s");
                    let mut until = load.until.unwrap_or_default();
                    let row = NumberRow::of("until", "plant.payload.until");
                    let response = row.number(ui, &mut until);
                    super::send(commands, &[response], || PanelSection::Plant.set(&["payload", "until"], until));
                });
            }
        });
    });
}

fn friction(ui: &mut Ui, plant: &PlantDifferences, model: &Machine, p: &Palette, commands: &mut Vec<Command>) {
    let f = &plant.friction;
    let tip = "Friction in the bearings of the drives and in the pins, unknown to control";
    let on = switch_nonzero(ui, ("friction", tip), *f != Default::default(), commands, |on| match on {
        true => PanelSection::Plant.set(&["friction", "viscous"], 0.02),
        false => PanelSection::Plant.back(&["friction"]),
    });
    if !on {
        return;
    }
    ui.indent("friction", |ui| {
        let path = &["plant", "friction", "viscous"];
        let viscous = PerDriveField { label: "viscous", path, decimals: 3, most: 0.5, normal: 0.0 };
        viscous.show(ui, &f.viscous, model.drives(), p, commands);
        let coulomb = PerDriveField { label: "Coulomb", path: &["plant", "friction", "coulomb"], ..viscous };
        coulomb.show(ui, &f.coulomb, model.drives(), p, commands);
        for (label, key, now) in
            [("pins viscous", "pin_viscous", f.pin_viscous), ("pins Coulomb", "pin_coulomb", f.pin_coulomb)]
        {
            let row = NumberRow::of(label, &format!("plant.friction.{key}")).with(4, 0.0005);
            NumberField::of(row, now, 0.0)
                .show(ui, p, SliderScale::No, commands, |x| PanelSection::Plant.set(&["friction", key], x));
        }
    });
}

/// A number common to all drives, or one for each.
#[derive(Clone, Copy)]
pub struct PerDriveField<'a> {
    pub label: &'a str,
    /// Path of its setting, in parts.
    pub path: &'a [&'a str],
    pub decimals: usize,
    /// Upper bound of the slider.
    pub most: f64,
    pub normal: f64,
}

impl PerDriveField<'_> {
    fn field<'a>(&'a self, label: &'a str, now: f64) -> NumberField<'a> {
        let row = NumberRow::of(label, &self.path.join(".")).with(self.decimals, self.most / 1000.0);
        NumberField::of(row.sliding(0.0..=self.most), now, self.normal)
    }

    pub fn show(&self, ui: &mut Ui, each: &DriveValues, n: usize, p: &Palette, commands: &mut Vec<Command>) {
        let values = each.of(n);
        match each {
            DriveValues::All(now) => {
                self.field(self.label, *now).show(ui, p, SliderScale::Linear, commands, |x| Edit::at(self.path, x));
            }
            DriveValues::Own(_) => {
                for k in 0..n {
                    let label = format!("{} {}", self.label, k + 1);
                    self.field(&label, values[k]).show(ui, p, SliderScale::No, commands, |x| {
                        let mut list = values.to_vec();
                        list[k] = x;
                        Edit::at(self.path, list)
                    });
                }
            }
        }
        let mut own = matches!(each, DriveValues::Own(_));
        let tip = format!("{}: one number for each drive", self.label);
        let tick = ui.checkbox(&mut own, "per drive").on_hover_text(&tip);
        super::name(&tick, &format!("{} per drive", self.label));
        if tick.changed() {
            let value = if own { values.to_vec().into() } else { Value::Float(values[0]) };
            undoable_edit(commands, Edit::at(self.path, value));
        }
    }
}

fn limits(ui: &mut Ui, plant: &PlantDifferences, model: &Machine, p: &Palette, commands: &mut Vec<Command>) {
    let on =
        switch(ui, ("torque limits", tip_of("plant.torque_limits")), plant.torque_limits, commands, |on| match on {
            true => PanelSection::Plant.set(&["torque_limits"], true),
            false => PanelSection::Plant.back(&["torque_limits"]),
        });
    if on {
        let limit = |d: &stillbase_mechanics::machine::Drive| d.torque_limit.map_or("none".into(), |t| format!("{t}"));
        let all: Vec<String> = model.spec().drives.iter().map(limit).collect();
        note(ui, p, &format!("|τ| at most {} N m", all.join(", ")));
    }
}

fn force(ui: &mut Ui, plant: &PlantDifferences, p: &Palette, commands: &mut Vec<Command>) {
    let tip = "A constant force F at the end effector; or push it by hand: Alt and drag, or U";
    let on = switch_nonzero(ui, ("force", tip), plant.force != [0.0; 2], commands, |on| match on {
        true => PanelSection::Plant.set(&["force"], vec![2.0, 0.0]),
        false => PanelSection::Plant.back(&["force"]),
    });
    if !on {
        return;
    }
    ui.indent("force", |ui| {
        for (i, label) in ["force x", "force y"].into_iter().enumerate() {
            let row = NumberRow::of(label, "plant.force").with(2, 0.05);
            let field = NumberField::of(row, plant.force[i], 0.0);
            field.show(ui, p, SliderScale::No, commands, |x| {
                let mut force = plant.force;
                force[i] = x;
                PanelSection::Plant.set(&["force"], force.to_vec())
            });
        }
    });
}

/// Returns the link or length on display in a list: the one chosen last, or else the first that differs; empty if
/// none does.
fn chosen(ui: &Ui, what: &str, first: Option<&String>, exists: impl Fn(&str) -> bool) -> String {
    let taken = ui.data(|d| d.get_temp::<String>(place::chosen_id(what)));
    taken.filter(|name| name.is_empty() || exists(name)).or_else(|| first.cloned()).unwrap_or_default()
}

fn pick(
    ui: &mut Ui,
    what: &str,
    tip: &str,
    names: impl Iterator<Item = (String, bool)>,
    now: &str,
    commands: &mut Vec<Command>,
) {
    let mut choices = vec![(String::new(), "none".to_owned())];
    choices.extend(names.map(|(name, differs)| {
        let words = if differs { format!("{name} *") } else { name.clone() };
        (name, words)
    }));
    if let Some(name) = choose(ui, what, tip, &choices, &now.to_owned(), commands, |_| None) {
        ui.data_mut(|d| d.insert_temp(place::chosen_id(what), name));
        ui.ctx().request_repaint();
    }
}

fn link(ui: &mut Ui, plant: &PlantDifferences, model: &Machine, p: &Palette, commands: &mut Vec<Command>) {
    const WHAT: &str = place::LINK_LIST;
    let known = |name: &str| model.links().iter().find(|link| link.name == name);
    let now = chosen(ui, WHAT, plant.link.keys().next(), |name| known(name).is_some());
    let names = model.links().iter().map(|link| (link.name.clone(), plant.link.contains_key(&link.name)));
    pick(ui, WHAT, "A link that is not as the model has it; * marks those that differ", names, &now, commands);
    let Some(link) = known(&now) else { return };
    let differs = plant.link.get(&now).copied().unwrap_or_default();
    let number = model.spec().link_index(&link.name).unwrap_or_default();
    place::place_of_thing(ui, Handle::Link(number), p, |ui| {
        ui.indent("link", |ui| link_rows(ui, link, &differs, p, commands));
    });
}

fn link_rows(ui: &mut Ui, link: &Link, differs: &LinkDifference, p: &Palette, commands: &mut Vec<Command>) {
    for (key, label, now, normal) in [
        ("mass", "mass", differs.mass, link.mass),
        ("com", "CM along", differs.com, link.com),
        ("com_normal", "CM off axis", differs.com_normal, link.com_normal),
        ("inertia", "inertia", differs.inertia, link.inertia),
    ] {
        let path = ["link", link.name.as_str(), key];
        let called = Some(format!("link {} {label}", link.name));
        let row = NumberRow::of(label, &format!("plant.link.*.{key}")).with(3, 0.002);
        let field = NumberField {
            row,
            now: now.unwrap_or(normal),
            normal,
            shows_default: now.is_some(),
            back: Some(PanelSection::Plant.back(&path)),
            called,
        };
        field.show(ui, p, SliderScale::No, commands, |x| PanelSection::Plant.set(&path, x));
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
    pick(ui, WHAT, tip, names, &now, commands);
    let Some(normal) = lengths.get(&now) else { return };
    let differs = plant.length.get(&now);
    let path = ["length", now.as_str()];
    ui.indent("length", |ui| {
        let called = Some(format!("length {now}"));
        let row = NumberRow { tip, ..NumberRow::of(&now, "plant.length.*").with(4, 0.0005) };
        let value = differs.copied().unwrap_or(*normal);
        let back = Some(PanelSection::Plant.back(&path));
        NumberField { row, now: value, normal: *normal, shows_default: differs.is_some(), back, called }.show(
            ui,
            p,
            SliderScale::No,
            commands,
            |x| PanelSection::Plant.set(&path, x),
        );
    });
}
