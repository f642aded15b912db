//! The machine that is cut from the drawings, weighed by another program, is balanced.

use serde_json::{Value, json};
use stillbase::exchange::cut::Cut;
use stillbase::exchange::drawing::{Sheet, dxf};
use stillbase::mechanics::counterweights::{CounterweightSite, CounterweightSpec, CounterweightStock, Objective};
use stillbase::mechanics::machine::{BarStock, Lump, Machine, PartSource, PlaceOnLink, builtins};
use stillbase::study::workshop::{NoCut, balance_as_cut};

use super::python::answers;
use crate::Test;
use crate::noise::Noise;

pub const TESTS: &[Test] = tests![what_is_cut_is_balanced];

const SCRIPT: &str = include_str!("workshop.py");

/// A machine of the gallery without motors in its joints that is cut from random bars, with discs on or off the axes.
fn cut(machine: &Machine, noise: &mut Noise) -> Option<(Machine, BarStock, CounterweightStock)> {
    let material = ["aluminium", "steel"][usize::from(noise.between(0.0, 1.0) > 0.7)];
    let stock = BarStock {
        width: noise.between(0.012, 0.04),
        thickness: noise.between(0.002, 0.01),
        material: material.into(),
        pin_diameter: noise.between(0.004, 0.01),
    };
    let disc = CounterweightStock::discs(7850.0, noise.between(0.01, 0.04));
    let across = if noise.between(0.0, 1.0) < 0.5 { 0.0 } else { noise.between(0.02, 0.1) };
    let mut spec = machine.spec().clone();
    if across > 0.0 {
        // A motor beside the axis of a link asks for a disc on its other side.
        spec.lumps.push(Lump {
            link: spec.links[(noise.between(0.0, 1.0) * spec.links.len() as f64) as usize % spec.links.len()]
                .name
                .clone(),
            name: "motor".into(),
            mass: noise.between(0.02, 0.2),
            at: PlaceOnLink::Metres(noise.between(0.0, 0.2)),
            across: noise.between(0.01, 0.05),
            inertia: 0.0,
        });
    }
    let machine = Machine::new(spec).expect("a machine");
    let mut sites = CounterweightSite::anywhere(&machine);
    sites.iter_mut().for_each(|site| (site.across, site.from) = (across, -2.0));
    match balance_as_cut(&machine, &CounterweightSpec::least(Objective::mass(), sites, disc), &stock) {
        Ok(cut) => Some((cut.placed.machine, stock, disc)),
        Err(why @ (NoCut::Weights(_) | NoCut::Unsettled { .. })) => {
            eprintln!("{}: {why}", machine.name());
            None
        }
        Err(why) => panic!("{}: {why}", machine.name()),
    }
}

fn question(machine: &Machine, stock: &BarStock, disc: &CounterweightStock) -> Value {
    let density = if stock.material == "steel" { 7850.0 } else { 2700.0 };
    let links = machine.resolved_links().iter().enumerate().map(|(j, link)| {
        let root: Vec<f64> = (0..machine.drives()).map(|k| link.root[k]).collect();
        let lumps = machine.part_bodies().iter().filter(|body| body.link == j);
        let lumps = lumps.filter(|body| matches!(body.source, PartSource::Lump(_)));
        let lumps: Vec<[f64; 3]> = lumps.map(|body| [body.body.mass, body.body.at, body.body.across]).collect();
        json!({"pins": link.pins, "root": root, "sign": link.sign, "drive": link.drive, "lumps": lumps})
    });
    json!({
        "dxf": dxf(&Sheet::of(machine, &Cut::default()).expect("a sheet")),
        "drives": machine.drives(),
        "thickness": stock.thickness,
        "density": density,
        "disc_thickness": disc.thickness,
        "disc_density": disc.density,
        "links": links.collect::<Vec<_>>(),
    })
}

fn what_is_cut_is_balanced() {
    let mut noise = Noise::of(4107);
    let mut machines = Vec::new();
    for machine in builtins().iter().filter(|machine| machine.spec().payload.mass == 0.0) {
        for _ in 0..4 {
            machines.extend(cut(machine, &mut noise));
        }
    }
    let off = machines.iter().filter(|(machine, ..)| machine.spec().parts.iter().any(|part| part.is_arm())).count();
    assert!(machines.len() >= 20 && off >= 3, "only {} machines, {off} with arms", machines.len());
    let lines: Vec<String> = machines.iter().map(|(m, stock, disc)| question(m, stock, disc).to_string()).collect();
    let found = answers(SCRIPT, &lines);
    assert_eq!(found.len(), machines.len());
    for ((machine, ..), found) in machines.iter().zip(&found) {
        let name = machine.name();
        for (j, (link, weighed)) in machine.links().iter().zip(found["masses"].as_array().expect("links")).enumerate() {
            let [mass, sx, sy] = [0, 1, 2].map(|i| weighed[i].as_f64().expect("a number"));
            let own = [link.mass, link.mass * link.com, link.mass * link.com_normal];
            let off = [mass, sx, sy].iter().zip(own).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            // The drawing gives lengths to a nanometre.
            assert!(off < 1e-7 * (1.0 + link.mass), "{name}, link {j}: {weighed} but {own:?}");
        }
        for what in ["force", "coupling"] {
            let residual = found[what].as_f64().expect("a number");
            assert!(residual < 1e-6, "{name}: {what} {residual}");
        }
    }
}
