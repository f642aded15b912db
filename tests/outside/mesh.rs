//! The solids of a machine, integrated over their triangles by another program, weigh what its links weigh.

use std::f64::consts::PI;

use serde_json::{Value, json};
use stillbase::exchange::cut::Cut;
use stillbase::exchange::form::{Exported, Form};
use stillbase::exchange::mjcf::middle;
use stillbase::exchange::solids::{LinkSolid, SolidKind, link_solids};
use stillbase::mechanics::machine::{Counterweight, CounterweightShape, Machine, Part, Shape, place_of};
use stillbase::mechanics::planar::{DriveAngles, PerDrive, Vector};

use super::drawings;
use super::python::answers;
use crate::Test;
use crate::noise::Noise;

pub const TESTS: &[Test] = tests![solids_weigh_what_links_weigh];

const SCRIPT: &str = include_str!("mesh.py");

/// Density of counterweights, lumps and payloads, kg/m³.
const STEEL: f64 = 7850.0;

/// A drawing, made of parts, with tubes and profiles, counterweights and a payload, its links at heights of their own.
fn stacked(machine: &Machine, noise: &mut Noise) -> Machine {
    let mut spec = machine.spec().clone();
    for (j, link) in spec.links.iter_mut().enumerate() {
        link.axial = 0.08 * j as f64;
        let pipe = Part {
            name: "pipe".into(),
            across: 0.05,
            wall: Some(0.002),
            thickness: None,
            ..Part::flat(&link.name, 0.0)
        };
        spec.parts.push(match j % 2 {
            0 => Part { shape: Shape::Tube, diameter: Some(0.02), ..pipe },
            _ => Part { shape: Shape::Profile, width: Some(0.03), height: Some(0.02), ..pipe },
        });
        let (mass, at) = (noise.between(0.3, 2.0), noise.between(-0.2, 0.1));
        let shape = match j % 4 {
            0 => CounterweightShape::Ring { radius: 0.04, inner_radius: 0.01 },
            1 => CounterweightShape::HalfRing { radius: 0.05, inner_radius: 0.015 },
            2 => CounterweightShape::Box { length: 0.08, width: 0.05 },
            _ => CounterweightShape::Disc { radius: 0.04 },
        };
        spec.counterweights.push(Counterweight::new(link.name.clone(), mass, [at, 0.0], shape));
    }
    (spec.payload.mass, spec.payload.inertia, spec.payload.offset) = (0.4, 2e-4, [0.02, 0.01]);
    Machine::new(spec).expect("a machine")
}

fn density(machine: &Machine, solid: &LinkSolid) -> f64 {
    let material = solid.part.map(|i| machine.spec().parts[i].material.as_str());
    match material {
        Some("aluminium") => 2700.0,
        Some("steel") | None => STEEL,
        Some(other) => panic!("{other}"),
    }
}

/// Mass, centre and inertia about it.
#[derive(Clone, Copy, Debug, Default)]
struct Weighed(f64, Vector, f64);

impl Weighed {
    fn and(self, other: Self) -> Self {
        let mass = self.0 + other.0;
        let centre = (self.1 * self.0 + other.1 * other.0) / mass;
        let apart = (self.1 - other.1).norm_sqr() * self.0 * other.0 / mass;
        Self(mass, centre, self.2 + other.2 + apart)
    }
}

fn solids_weigh_what_links_weigh() {
    let mut noise = Noise::of(77);
    let drawn = drawings::of_templates().into_iter().map(|sketch| {
        let made = drawings::machine(&drawings::made(&sketch, &mut noise));
        stacked(&made, &mut noise)
    });
    let machines: Vec<Machine> = drawn.collect();
    let form = Form::of("stl").expect("a form");
    let written = |machine: &Machine| {
        json!(
            form.written(&Exported { machine, base: None, pose: &middle(machine), cut: &Cut::default() })
                .expect("solids")
                .text()
        )
        .to_string()
    };
    let lines: Vec<String> = machines.iter().map(written).collect();
    let (mut greatest, mut drilled) = ([0.0_f64; 3], 0);
    for (machine, found) in machines.iter().zip(answers(SCRIPT, &lines)) {
        let name = machine.name();
        let q = PerDrive::from_slice(&middle(machine)).expect("a pose");
        let e = DriveAngles(q).units();
        let solids = link_solids(machine, &Cut::default());
        let found: Vec<&Vec<Value>> =
            found.as_array().expect("solids").iter().map(|x| x.as_array().expect("numbers")).collect();
        for (j, link) in machine.links().iter().enumerate() {
            let mut weighed = Weighed::default();
            for (solid, found) in solids.iter().zip(&found).filter(|(solid, _)| solid.link == j) {
                assert_eq!(
                    found[0].as_str(),
                    Some(solid.name(machine).replace(|c: char| !c.is_ascii_graphic(), "_").as_str())
                );
                if solid.kind == SolidKind::Payload {
                    continue;
                }
                let x = |i: usize| found[i].as_f64().expect("a number");
                let (dense, centre) = (density(machine, solid), Vector::new(1e-3 * x(2), 1e-3 * x(3)));
                let mut own = Weighed(1e-9 * x(1) * dense, centre, 1e-15 * x(5) * dense);
                // A point has no inertia, its cylinder has.
                if let SolidKind::Lump(i) = solid.kind
                    && machine.spec().lumps[i].inertia == 0.0
                {
                    own.2 = 0.0;
                }
                // Holes for pins are drilled through discs, whose masses do not count them.
                if let SolidKind::Disc(i) = solid.kind {
                    let weight = &machine.spec().counterweights[i];
                    let part = &machine.resolved_links()[j];
                    // The bore of a ring is not a hole for a pin.
                    let bore = 2.0 * weight.inner_radius;
                    for (at, diameter) in solid.holes.iter().filter(|(_, diameter)| *diameter != bore) {
                        drilled += 1;
                        let hole = 0.25 * PI * diameter * diameter * solid.thickness * STEEL;
                        let centre = place_of(&part.root, &e) + e[part.drive] * part.sign * at;
                        own = own.and(Weighed(hole, centre, hole * diameter * diameter / 8.0));
                    }
                    assert!((own.0 - weight.mass).abs() < 1e-6, "{name}: {} of {}", own.0, weight.mass);
                }
                weighed = if weighed.0 == 0.0 { own } else { weighed.and(own) };
            }
            let com: Vector = machine.com_chain(j).iter().zip(&e).map(|(a, e)| a * *e).sum();
            let off =
                [(weighed.0 - link.mass).abs(), link.mass * (weighed.1 - com).norm(), (weighed.2 - link.inertia).abs()];
            assert!(off.iter().all(|off| *off < 1e-6), "{name}, link {j}: {weighed:?}, {off:?}");
            greatest = [0, 1, 2].map(|i| greatest[i].max(off[i]));
        }
    }
    assert!(drilled > 0);
    eprintln!("solids: off by {greatest:?} kg, kg m, kg m² at most");
}
