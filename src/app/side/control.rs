//! The section *Control* of the panel on the left: control law, gains and sampling.

use egui::Ui;

use super::fold::{NumberField, PanelSection, SliderScale, choose, fold};
use super::plant::PerDriveField;
use crate::Command;
use crate::widgets::{NumberRow, tip_of};
use stillbase_picture::scene::palette::Palette;
use stillbase_session::Session;
use stillbase_settings::word::Choice;
use stillbase_simulation::control::{Control, ControlLaw};

/// Selectable sample periods, as numbers of time steps: a period must be a whole number of steps.
const PERIODS: [u32; 11] = [1, 2, 4, 5, 8, 10, 20, 25, 40, 50, 100];

/// Selectable encoder resolutions, counts.
const COUNTS: [f64; 6] = [1024.0, 4096.0, 16384.0, 65536.0, 262_144.0, 1_048_576.0];

/// Draws this section.
pub fn show(ui: &mut Ui, session: &Session, p: &Palette, commands: &mut Vec<Command>) {
    let scenario = session.scenario();
    let (control, step, n) = (&scenario.control, scenario.step, scenario.machine.drives());
    let mut summary = match control.law {
        ControlLaw::ComputedTorque => "computed torque".to_owned(),
        ControlLaw::PayloadCompensation => "with the payload".to_owned(),
        ControlLaw::Pd => "PD".to_owned(),
    };
    if control.is_sampled() {
        summary += ", sampled";
    }
    let back = (*control != Control::default()).then(|| PanelSection::Control.all_back());
    fold(ui, p, "Control", &summary, back, commands, |ui, commands| {
        let laws: Vec<(ControlLaw, String)> =
            ControlLaw::ALL.iter().map(|law| (*law, law.words().screen.to_owned())).collect();
        choose(ui, "law", tip_of("control.law"), &laws, &control.law, commands, |law| {
            Some(PanelSection::Control.set(&["law"], law.words().file))
        });
        let kp = PerDriveField { label: "Kp", path: &["control", "kp"], decimals: 0, most: 2000.0, normal: 400.0 };
        kp.show(ui, &control.kp, n, p, commands);
        let kd = PerDriveField { label: "Kd", path: &["control", "kd"], most: 200.0, normal: 40.0, ..kp };
        kd.show(ui, &control.kd, n, p, commands);
        sampling(ui, control, step, p, commands);
        if scenario.base.moves() {
            let mut knows = control.knows_base;
            let tip = tip_of("control.knows_base");
            if ui.checkbox(&mut knows, "knows the base").on_hover_text(tip).changed() {
                crate::widgets::undoable_edit(commands, PanelSection::Control.set(&["knows_base"], knows));
            }
        }
    });
}

fn sampling(ui: &mut Ui, control: &Control, step: f64, p: &Palette, commands: &mut Vec<Command>) {
    let add_if_missing = |all: &mut Vec<(f64, String)>, now: f64, words: String| {
        if all.iter().all(|(x, _)| *x != now) {
            all.push((now, words));
        }
    };
    let hertz = |x: f64| format!("{} Hz", (x * 1e3).round() / 1e3);
    let mut rates = vec![(0.0, "all the time".to_owned())];
    rates.extend(PERIODS.map(|n| 1.0 / (f64::from(n) * step)).map(|x| (x, hertz(x))));
    add_if_missing(&mut rates, control.rate, hertz(control.rate));
    choose(ui, "rate", tip_of("control.rate"), &rates, &control.rate, commands, |x| {
        Some(PanelSection::Control.set(&["rate"], *x))
    });
    let delay = NumberRow::of("delay", "control.delay");
    let milliseconds = |seconds: &f64| 1e3 * seconds;
    let range = milliseconds(delay.range.start())..=milliseconds(delay.range.end());
    let row = NumberRow { unit: "ms", slide: range.clone(), range, ..delay.with(1, 1e3 * step) };
    NumberField::of(row, 1e3 * control.delay, 0.0).show(ui, p, SliderScale::No, commands, |x| {
        PanelSection::Control.set(&["delay"], (1e-3 * x / step).round() * step)
    });
    let words = |x: f64| format!("{x} counts");
    let mut counts = vec![(0.0, "exact".to_owned())];
    counts.extend(COUNTS.map(|x| (x, words(x))));
    add_if_missing(&mut counts, control.encoder, words(control.encoder));
    choose(ui, "encoder", tip_of("control.encoder"), &counts, &control.encoder, commands, |x| {
        Some(PanelSection::Control.set(&["encoder"], *x))
    });
}
