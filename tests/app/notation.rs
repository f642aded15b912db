//! Units and names as the user chose them, in every panel, view and layout.

use egui_kittest::kittest::Queryable as _;
use stillbase::app::{BottomPanel, Layout, SessionCommand, Switch, ViewChange};
use stillbase::picture::notation::{AngleUnit, LengthUnit, NameOrder, Notation};
use stillbase::picture::scene::palette::Theme;
use stillbase::picture::scene::views::ViewKind;
use stillbase::session::Edit;
use stillbase::session::scenario::Scenario;

use super::{Window, painted, session, type_into, window, window_of};
use crate::Test;

pub const TESTS: &[Test] =
    tests![every_text_is_in_the_chosen_units, numbers_are_typed_in_the_chosen_unit, symbols_come_first_if_chosen,];

const OTHER: Notation =
    Notation { angle: AngleUnit::Degrees, length: LengthUnit::Millimetres, names: NameOrder::Terms };

fn choose(h: &mut Window, notation: Notation) {
    h.state_mut().app_state_mut().carry_out(ViewChange::Notation(notation));
    h.run_steps(2);
}

/// Whether a text contains one of these units as a word of its own, not as a factor of another unit.
fn names_unit(text: &str, units: &[&str]) -> bool {
    let words: Vec<&str> =
        text.split([' ', ',', ';', ':', '(', ')', '·', '\n', '…']).filter(|w| !w.is_empty()).collect();
    words.iter().enumerate().any(|(i, word)| {
        let number = |w: &str| w.trim_start_matches(['−', '-', '+']).starts_with(|c: char| c.is_ascii_digit());
        let alone =
            i == 0 || number(words[i - 1]) || words[i - 1].chars().count() <= 2 && !["N", "kg"].contains(&words[i - 1]);
        units.contains(word) && (!["m", "m²"].contains(word) || alone)
    })
}

fn offenders(h: &Window, units: &[&str]) -> Vec<String> {
    painted(h).into_iter().filter(|text| names_unit(text, units)).collect()
}

/// In every view and panel, of fixed and moving bases, no angle is in radians while degrees are chosen, and no length
/// in metres while millimetres are; and none in degrees while radians are.
fn every_text_is_in_the_chosen_units() {
    let mut wrong = Vec::new();
    for name in ["case-3", "spacecraft", "bench-top", "two-drive", "four-drive", "scara"] {
        let scenario = Scenario::builtin(name).expect("built in");
        let mut h = window_of(scenario, Theme::Dark, 2400.0);
        h.run_steps(2);
        for section in ["Plant section", "Base section", "Control section", "Path section"] {
            if let Some(head) = h.query_by_label(section) {
                head.click();
                h.run_steps(2);
            }
        }
        let state = |h: &mut Window, change: ViewChange| {
            h.state_mut().app_state_mut().carry_out(change);
            h.run_steps(3);
        };
        for view in ViewKind::ALL {
            state(&mut h, ViewChange::Kind(view));
            choose(&mut h, OTHER);
            wrong.extend(
                offenders(&h, &["rad", "mrad", "rad/s", "m", "m/s", "m²"])
                    .into_iter()
                    .map(|text| (format!("{name} {view:?}"), text)),
            );
            choose(&mut h, Notation::default());
            let degrees: Vec<String> = painted(&h).into_iter().filter(|text| text.contains('°')).collect();
            // The key of the arc of the moment is a picture of an angle.
            let degrees: Vec<_> = degrees.into_iter().filter(|text| !text.contains("arc: ")).collect();
            wrong.extend(degrees.into_iter().map(|text| (format!("{name} {view:?}"), text)));
        }
        state(&mut h, ViewChange::Kind(ViewKind::Flat));
        choose(&mut h, OTHER);
        for layout in [Layout::Compare, Layout::Present, Layout::Explore] {
            state(&mut h, ViewChange::Layout(layout));
            wrong.extend(
                offenders(&h, &["rad", "mrad", "rad/s", "m", "m/s", "m²"])
                    .into_iter()
                    .map(|text| (format!("{name} {layout:?}"), text)),
            );
        }
        for switch in [Switch::Study, Switch::Pins, Switch::History, Switch::Help] {
            state(&mut h, ViewChange::Switch(switch, true));
            wrong.extend(
                offenders(&h, &["rad", "mrad", "rad/s", "m", "m/s", "m²"])
                    .into_iter()
                    .map(|text| (format!("{name} {switch:?}"), text)),
            );
        }
        // A refusal of the core is a sentence like any other.
        h.state_mut().app_state_mut().carry_out(SessionCommand::Edit(Edit::set("task.end", vec![5.0, 5.0])));
        h.run_steps(3);
        wrong.extend(offenders(&h, &["rad", "m", "m²"]).into_iter().map(|text| (name.to_string(), text)));
        assert_ne!(h.state().app_state().view_state().below, Some(BottomPanel::Table));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// A number is typed in the unit behind it, or with a unit of its own; the setting stays in SI units.
fn numbers_are_typed_in_the_chosen_unit() {
    let mut h = window("case-3", Theme::Dark);
    choose(&mut h, OTHER);
    type_into(&mut h, "b °", "140");
    assert!((session(&h).b_aim() - 140_f64.to_radians()).abs() < 1e-9, "{}", session(&h).b_aim());
    type_into(&mut h, "b °", "2.5 rad");
    assert!((session(&h).b_aim() - 2.5).abs() < 1e-9, "{}", session(&h).b_aim());
    // An untouched number keeps all its digits.
    let before = session(&h).scenario().clone();
    type_into(&mut h, "b °", "143.24");
    assert_eq!(session(&h).scenario().task, before.task);
    assert!((session(&h).b_aim() - 2.5).abs() < 1e-9, "{}", session(&h).b_aim());
}

fn symbols_come_first_if_chosen() {
    let mut h = window("case-3", Theme::Dark);
    h.run_steps(2);
    assert!(painted(&h).iter().any(|text| text == "Torque"));
    choose(&mut h, Notation { names: NameOrder::Symbols, ..Notation::default() });
    let said = painted(&h);
    assert!(said.iter().any(|text| text == "τ  Torque"), "{said:?}");
}
