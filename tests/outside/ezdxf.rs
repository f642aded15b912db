//! ezdxf opens the drawings that are written and finds closed outlines, holes and discs in their real size.

use std::f64::consts::PI;

use serde_json::Value;
use stillbase::exchange::cut::Cut;
use stillbase::exchange::drawing::{Sheet, dxf};
use stillbase::mechanics::machine::{Counterweight, Machine, builtins};

use super::python::answers;
use crate::Test;

pub const TESTS: &[Test] = tests![outlines_are_closed_and_discs_weigh_what_they_should];

const SCRIPT: &str = include_str!("ezdxf.py");

/// Discs of steel 30 mm thick on every link, one a kilogram heavier than the last.
fn with_discs(machine: &Machine) -> Machine {
    let mut spec = machine.spec().clone();
    spec.counterweights.clear();
    for (i, link) in spec.links.iter().enumerate() {
        let mass = 1.0 + i as f64;
        let radius = (mass / (7850.0 * 0.03 * PI)).sqrt();
        spec.counterweights.push(Counterweight {
            link: link.name.clone(),
            mass,
            at: -0.1,
            across: 0.0,
            radius,
            ..Default::default()
        });
    }
    Machine::new(spec).expect("a machine")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn list<'a>(found: &'a Value, what: &str) -> &'a Vec<Value> {
    found[what].as_array().unwrap_or_else(|| panic!("no {what}"))
}

fn outlines_are_closed_and_discs_weigh_what_they_should() {
    let machines: Vec<Machine> = builtins().iter().map(with_discs).collect();
    let cut = Cut { thickness: Some(0.03), ..Cut::default() };
    let drawn = |machine: &Machine| dxf(&Sheet::of(machine, &cut).expect("a sheet"));
    let lines: Vec<String> = machines.iter().map(|machine| serde_json::json!(drawn(machine)).to_string()).collect();
    let found = answers(SCRIPT, &lines);
    assert_eq!(found.len(), machines.len());
    for (machine, found) in machines.iter().zip(&found) {
        let name = machine.name();
        assert_eq!(found["version"], "AC1009", "{name}");
        assert_eq!(found["units"], 4, "{name}: millimetres");
        assert!(list(found, "errors").is_empty(), "{name}: {}", found["errors"]);
        for layer in ["COUNTERWEIGHT", "HOLES", "OUTLINE", "TEXT"] {
            assert!(list(found, "layers").iter().any(|own| own == layer), "{name}: {layer}");
        }
        assert_eq!(found["kinds"], serde_json::json!(["CIRCLE", "LINE", "POLYLINE", "TEXT"]), "{name}");
        let outlines = list(found, "outlines");
        assert_eq!(outlines.len(), machine.links().len(), "{name}");
        for (outline, part) in outlines.iter().zip(machine.resolved_links()) {
            assert_eq!((&outline["layer"], &outline["closed"]), (&"OUTLINE".into(), &true.into()), "{name}");
            // As far as the pins and the disc 100 mm behind the root; half a width more at either end.
            let first = part.pins.iter().fold(-0.1_f64, |least, at| least.min(*at));
            let last = part.pins.iter().fold(part.length, |most, at| most.max(*at));
            let length = 1e3 * (last - first);
            assert!((number(&outline["length"]) - length - 30.0).abs() < 1e-3, "{name}: {outline}");
            let area = 30.0 * length + PI * 15.0 * 15.0;
            assert!((number(&outline["area"]) - area).abs() < 1e-4 * area, "{name}: {outline}, want {area}");
        }
        let on = |layer: &str| {
            let circles = list(found, "circles").iter().filter(|circle| circle[0] == layer);
            circles.map(|circle| number(&circle[3])).collect::<Vec<_>>()
        };
        let (holes, discs) = (on("HOLES"), on("COUNTERWEIGHT"));
        let pins: usize = machine.resolved_links().iter().map(|part| part.pins.len()).sum();
        assert_eq!(holes.len(), pins, "{name}");
        assert!(holes.iter().all(|radius| (radius - 4.0).abs() < 1e-9), "{name}: {holes:?}");
        assert_eq!(discs.len(), machine.spec().counterweights.len(), "{name}");
        for (radius, weight) in discs.iter().zip(&machine.spec().counterweights) {
            let weighs = PI * (1e-3 * radius).powi(2) * 0.03 * 7850.0;
            assert!((weighs - weight.mass).abs() < 1e-6, "{name}: {weighs} kg, want {}", weight.mass);
        }
        let texts: Vec<&str> = list(found, "texts").iter().filter_map(Value::as_str).collect();
        for link in machine.links() {
            assert_eq!(texts.iter().filter(|text| **text == format!("link {}", link.name)).count(), 1, "{name}");
        }
        assert!(texts.iter().any(|text| text.contains("Ø")), "{name}: {texts:?}");
    }
}
