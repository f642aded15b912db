//! The section *Base* of the panel on the left: the base of the machine.

use egui::Ui;

use super::fold::{NumberField, PanelSection, SliderScale, fold, segments, switch};
use crate::widgets::NumberRow;
use crate::{Command, Switch, ViewChange, ViewState, place};
use stillbase_picture::scene::options::Handle;
use stillbase_picture::scene::palette::Palette;
use stillbase_session::{Edit, Session};
use stillbase_settings::word::Choice;
use stillbase_simulation::plant::{Base, BaseKind, Wheel};

/// Draws this section.
pub fn show(ui: &mut Ui, session: &Session, view_state: &ViewState, commands: &mut Vec<Command>) {
    let (base, p) = (&session.scenario().base, &view_state.palette());
    let word = base.kind.words().file;
    let summary = if base.wheel.is_some() { format!("{word}, with a wheel") } else { word.to_owned() };
    let back = (*base != Base::default()).then(|| PanelSection::Base.all_back());
    place::place_of_thing(ui, Handle::Base, p, |ui| section(ui, session, view_state, &summary, back, commands));
}

fn section(
    ui: &mut Ui,
    session: &Session,
    view_state: &ViewState,
    summary: &str,
    back: Option<Edit>,
    commands: &mut Vec<Command>,
) {
    let (base, p) = (&session.scenario().base, &view_state.palette());
    fold(ui, p, "Base", summary, back, commands, |ui, commands| {
        let kinds: Vec<_> =
            BaseKind::ALL.iter().map(|kind| (*kind, kind.words().screen, kind.words().meaning)).collect();
        segments(ui, p, &kinds, base.kind, commands, |kind| PanelSection::Base.set(&["kind"], kind.words().file));
        if base.moves() {
            body(ui, base, p, commands);
            let mut seen = view_state.exaggerates_base;
            let tip = "Show the motion of the base enlarged, so that it can be seen (X)";
            if ui.checkbox(&mut seen, "exaggerate its motion").on_hover_text(tip).changed() {
                commands.push(ViewChange::Switch(Switch::Exaggeration, seen).into());
            }
        }
        wheel(ui, base, p, commands);
    });
}

fn body(ui: &mut Ui, base: &Base, p: &Palette, commands: &mut Vec<Command>) {
    let normal = Base::default();
    for (label, key, decimals, now, normal) in
        [("base mass", "mass", 1, base.mass, normal.mass), ("base inertia", "inertia", 2, base.inertia, normal.inertia)]
    {
        let row = NumberRow::of(label, &format!("base.{key}")).with(decimals, 2.0 * 0.1_f64.powi(decimals as i32));
        let slide = 0.1_f64.powi(decimals as i32)..=1000.0;
        NumberField::of(row.sliding(slide), now, normal)
            .show(ui, p, SliderScale::Logarithmic, commands, |x| PanelSection::Base.set(&[key], x));
    }
    for (i, label) in ["CM x", "CM y"].into_iter().enumerate() {
        let row = NumberRow::of(label, "base.com").with(3, 0.002);
        NumberField::of(row, base.com[i], 0.0).show(ui, p, SliderScale::No, commands, |x| {
            let mut com = base.com;
            com[i] = x;
            PanelSection::Base.set(&["com"], com.to_vec())
        });
    }
    if base.kind != BaseKind::Compliant {
        return;
    }
    let triples = [
        ("stiffness", "stiffness", "Spring", ["N/m", "N/m", "N m/rad"], base.stiffness, normal.stiffness, 1e6),
        ("damping", "damping", "Damper", ["N s/m", "N s/m", "N m s"], base.damping, normal.damping, 1e4),
    ];
    for (key, word, what, units, now, normal, most) in triples {
        for (i, axis) in ["x", "y", "θ"].into_iter().enumerate() {
            let label = format!("{word} {axis}");
            let tip = match i {
                2 => format!("{what} against the angle θ of the base"),
                _ => format!("{what} along {axis}"),
            };
            let row = NumberRow::of(&label, &format!("base.{key}")).with(0, most / 1e4);
            let row = NumberRow { unit: units[i], tip: &tip, ..row };
            NumberField::of(row, now[i], normal[i]).show(ui, p, SliderScale::No, commands, |x| {
                let mut all = now;
                all[i] = x;
                PanelSection::Base.set(&[key], all.to_vec())
            });
        }
    }
}

fn wheel(ui: &mut Ui, base: &Base, p: &Palette, commands: &mut Vec<Command>) {
    let normal = Wheel::default();
    let tip = "A wheel in the base that takes up the moment of the machine while it can";
    switch(ui, ("reaction wheel", tip), base.wheel.is_some(), commands, |on| match on {
        true => PanelSection::Base.set(&["wheel", "inertia"], normal.inertia),
        false => PanelSection::Base.back(&["wheel"]),
    });
    let Some(wheel) = &base.wheel else { return };
    ui.indent("wheel", |ui| {
        let row = NumberRow::of("rotor", "base.wheel.inertia").with(4, 0.0001);
        NumberField::of(row, wheel.inertia, normal.inertia)
            .show(ui, p, SliderScale::No, commands, |x| PanelSection::Base.set(&["wheel", "inertia"], x));
        for (key, label, unit, tip, now, usual) in [
            (
                "torque_limit",
                "max torque",
                "N m",
                "Greatest |τ_w|; past it the base feels the rest",
                wheel.torque_limit,
                0.5,
            ),
            (
                "speed_limit",
                "max speed",
                "rad/s",
                "Greatest |Ω|; at it the wheel takes up no more",
                wheel.speed_limit,
                200.0,
            ),
        ] {
            ui.horizontal(|ui| {
                let on = switch(ui, (label, tip), now.is_some(), commands, |on| match on {
                    true => PanelSection::Base.set(&["wheel", key], usual),
                    false => PanelSection::Base.back(&["wheel", key]),
                });
                if on {
                    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                        super::unit(ui, p, unit);
                        let mut value = now.unwrap_or(usual);
                        let row = NumberRow::of(label, &format!("base.wheel.{key}")).with(2, usual / 200.0);
                        let row = NumberRow { tip, ..row };
                        let response = row.number(ui, &mut value);
                        super::send(commands, &[response], || PanelSection::Base.set(&["wheel", key], value));
                    });
                }
            });
        }
        if base.kind != BaseKind::Free {
            return;
        }
        for (key, label, decimals, step, now, usual) in [
            ("kp", "attitude gain", 2, 0.02, wheel.kp, normal.kp),
            ("kd", "rate gain", 2, 0.02, wheel.kd, normal.kd),
            ("dead_band", "dead band", 4, 0.0002, wheel.dead_band, normal.dead_band),
            ("rate", "sampling", 1, 0.5, wheel.rate, normal.rate),
        ] {
            let row = NumberRow::of(label, &format!("base.wheel.{key}")).with(decimals, step);
            NumberField::of(row, now, usual)
                .show(ui, p, SliderScale::No, commands, |x| PanelSection::Base.set(&["wheel", key], x));
        }
    });
}
