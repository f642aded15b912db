//! What a machine is cut from, weighed by another program, is what the machine says, and balanced; drawings come back.

use serde_json::{Value, json};
use stillbase::exchange::cut::Cut;
use stillbase::exchange::drawing::pieces_of;
use stillbase::exchange::form::{Exported, Form};
use stillbase::exchange::import::import;
use stillbase::exchange::mjcf::middle;
use stillbase::mechanics::counterweights::{
    CounterweightForm, CounterweightSite, CounterweightSpec, CounterweightStock, Objective,
};
use stillbase::mechanics::machine::{
    BarStock, Inertia, Link, LinkNumber, Lump, Machine, Part, PlaceOnLink, builtins, parse, to_toml,
};
use stillbase::study::workshop::{NoCut, balance_as_cut};

use super::drawings;
use super::python::answers;
use crate::noise::Noise;
use crate::{Test, count};

pub const TESTS: &[Test] =
    tests![what_is_cut_is_balanced, a_template_is_weighed_or_its_list_says_why_not, drawings_at_random_are_weighed,];

const SCRIPT: &str = include_str!("workshop.py");

/// A machine of the gallery without motors in its joints that is cut from random bars, with discs on or off the axes.
fn cut(machine: &Machine, noise: &mut Noise) -> Option<(Machine, CounterweightStock)> {
    let material = ["aluminium", "steel"][usize::from(noise.between(0.0, 1.0) > 0.7)];
    let stock = BarStock {
        width: noise.between(0.012, 0.04),
        thickness: noise.between(0.002, 0.01),
        material: material.into(),
        pin_diameter: noise.between(0.004, 0.01),
    };
    let form = match noise.between(0.0, 5.0) {
        x if x < 1.0 => CounterweightForm::Ring(noise.between(0.003, 0.02)),
        x if x < 2.0 => CounterweightForm::HalfRing(noise.between(0.003, 0.02)),
        x if x < 3.0 => CounterweightForm::Box(noise.between(0.02, 0.06)),
        _ => CounterweightForm::Disc,
    };
    let disc = CounterweightStock { form, ..CounterweightStock::discs(7850.0, noise.between(0.01, 0.04)) };
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
        Ok(cut) => Some((cut.placed.machine, disc)),
        Err(why @ (NoCut::Weights(_) | NoCut::Bounds { .. } | NoCut::Unsettled(_))) => {
            eprintln!("{}: {why}", machine.name());
            None
        }
        Err(why) => panic!("{}: {why}", machine.name()),
    }
}

fn question(machine: &Machine, disc: CounterweightStock) -> Value {
    let (name, cut) = (machine.name(), Cut::default());
    let exported = |ending: &str| {
        let form = Form::of(ending).expect("a form");
        form.written(&Exported { machine, base: None, pose: &middle(machine), cut: &cut })
            .unwrap_or_else(|why| panic!("{name}, {ending}: {why}"))
            .text()
    };
    let links = machine.resolved_links().iter().enumerate().map(|(j, link)| {
        let root: Vec<f64> = (0..machine.drives()).map(|k| link.root[k]).collect();
        let pieces = pieces_of(machine, j).into_iter().map(|piece| {
            let holes: Vec<[f64; 2]> = piece.holes.iter().map(|(at, _)| *at).collect();
            json!({"row": piece.part, "holes": holes})
        });
        let pieces: Vec<Value> = pieces.collect();
        let name = &machine.links()[j].name;
        json!({"name": name, "pieces": pieces, "root": root, "sign": link.sign, "drive": link.drive})
    });
    json!({
        "dxf": exported("dxf"),
        "csv": exported("csv"),
        "drives": machine.drives(),
        "densities": {"aluminium": 2700.0, "steel": 7850.0},
        "disc": {"thickness": disc.thickness, "density": disc.density},
        "links": links.collect::<Vec<_>>(),
    })
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
}

/// What is weighed from the files is what the machine says of each link, and of Eqs. (7) and (8).
fn are_weighed(machines: &[(Machine, CounterweightStock)]) {
    let lines: Vec<String> = machines.iter().map(|(machine, disc)| question(machine, *disc).to_string()).collect();
    let found = answers(SCRIPT, &lines);
    assert_eq!(found.len(), machines.len());
    for ((machine, _), found) in machines.iter().zip(&found) {
        let name = machine.name();
        for (j, (link, weighed)) in machine.links().iter().zip(found["masses"].as_array().expect("links")).enumerate() {
            let about_root = link.inertia + link.mass * link.com.hypot(link.com_normal).powi(2);
            let own = [link.mass, link.mass * link.com, link.mass * link.com_normal, about_root];
            let off = numbers(weighed).iter().zip(own).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            // The drawing gives lengths to a nanometre.
            assert!(off < 1e-7 * (1.0 + link.mass), "{name}, link {j}: {weighed} but {own:?}");
        }
        let inertia = Inertia::of(machine);
        let force = (0..machine.drives()).map(|k| inertia.first_moment(k).norm()).collect::<Vec<_>>();
        let coupling = Inertia::pairs(machine.drives()).map(|(k, l)| inertia.coupling(k, l).norm()).collect();
        for (what, own) in [("force", force), ("coupling", coupling)] {
            for (weighed, own) in numbers(&found[what]).into_iter().zip(own) {
                let rounding = 2e-8 * machine.mass();
                assert!((weighed - own).abs() < 1e-6 + rounding, "{name}: {what} {weighed}, {own}");
            }
        }
    }
}

fn what_is_cut_is_balanced() {
    let mut noise = Noise::of(4107);
    let mut machines = Vec::new();
    for machine in builtins().iter().filter(|machine| machine.spec().payload.mass == 0.0) {
        for _ in 0..4 {
            machines.extend(cut(machine, &mut noise));
        }
    }
    let off = machines.iter().filter(|(machine, ..)| machine.spec().parts.iter().any(Part::is_arm)).count();
    assert!(machines.len() >= 20 && off >= 3, "only {} machines, {off} with arms", machines.len());
    for (machine, _) in &machines {
        let inertia = Inertia::of(machine);
        let left = inertia.force_residual().max(inertia.invariance_residual());
        assert!(left < 1e-9, "{}: {left}", machine.name());
    }
    are_weighed(&machines);
}

/// Names of the links with numbers that do not follow from parts.
fn typed(machine: &Machine) -> Vec<&str> {
    let is_typed = |link: &&Link| LinkNumber::ALL.iter().any(|number| !link.follows(*number));
    machine.spec().links.iter().filter(is_typed).map(|link| link.name.as_str()).collect()
}

fn a_template_is_weighed_or_its_list_says_why_not() {
    let mut machines = Vec::new();
    for sketch in drawings::of_templates() {
        let machine = drawings::machine(&sketch);
        let left_out = Form::of("dxf").expect("a form").left_out(&machine);
        let typed = typed(&machine);
        if typed.is_empty() {
            assert_eq!(left_out, Vec::<String>::new(), "{}", machine.name());
            machines.push((machine, CounterweightStock::STEEL));
        } else {
            let names = |text: &&String| typed.iter().all(|name| text.contains(*name)) && text.contains("typed");
            assert!(left_out.iter().any(|text| names(&text)), "{}: {left_out:?}", machine.name());
        }
    }
    let mut noise = Noise::of(2906);
    for sketch in drawings::of_templates() {
        let made = drawings::machine(&drawings::made(&sketch, &mut noise));
        assert_eq!(typed(&made), Vec::<&str>::new(), "{}", made.name());
        machines.extend(cut(&made, &mut noise));
        machines.push((made, CounterweightStock::STEEL));
    }
    let cut = machines.iter().filter(|(machine, _)| !machine.spec().counterweights.is_empty()).count();
    assert!(machines.len() >= 10 && cut >= 3, "{} drawings, {cut} with counterweights", machines.len());
    are_weighed(&machines);
    machines.iter().for_each(|(machine, _)| come_back(machine));
}

fn drawings_at_random_are_weighed() {
    let mut noise = Noise::of(count("SEED", 31));
    let drawn = (0..count("DRAWINGS", 40)).map(|n| {
        let sketch = drawings::tree(&mut noise, 2 + n as usize % 4);
        (drawings::machine(&drawings::made(&sketch, &mut noise)), CounterweightStock::STEEL)
    });
    let drawn: Vec<(Machine, CounterweightStock)> = drawn.collect();
    are_weighed(&drawn);
    drawn.iter().for_each(|(machine, _)| come_back(machine));
}

/// A machine comes back from its own file as it was, and from models with the same constants of motion; what models
/// leave out is listed.
fn come_back(machine: &Machine) {
    let name = machine.name();
    assert_eq!(parse(&to_toml(machine), name).expect("its own file").spec(), machine.spec(), "{name}");
    let own = Inertia::of(machine);
    for ending in ["urdf", "xml"] {
        let form = Form::of(ending).expect("a form");
        let text = form
            .written(&Exported { machine, base: None, pose: &middle(machine), cut: &Cut::default() })
            .unwrap_or_else(|why| panic!("{name}: {why}"))
            .text();
        let back = import(&text).unwrap_or_else(|why| panic!("{name}, {ending}: {why}")).machine;
        let drive = |k: usize| {
            let of = &machine.spec().drives[k].name;
            back.spec().drives.iter().position(|drive| drive.name == *of).expect("a drive of that name")
        };
        let theirs = Inertia::of(&back);
        let off = |what: &str, a: f64, b: f64| assert!((a - b).abs() < 1e-6, "{name}, {ending}, {what}: {a}, {b}");
        off("mass", theirs.mass(), own.mass());
        for k in 0..machine.drives() {
            off("first moment", theirs.first_moment(drive(k)).norm(), own.first_moment(k).norm());
            off("inertia", theirs.diagonal(drive(k)), own.diagonal(k));
        }
        for (k, l) in Inertia::pairs(machine.drives()) {
            off("coupling", theirs.coupling(drive(k), drive(l)).norm(), own.coupling(k, l).norm());
        }
        let listed = form.left_out(machine);
        for (count, word) in
            [(machine.spec().parts.len(), "part"), (machine.spec().counterweights.len(), "counterweight")]
        {
            assert!(count == 0 || listed.iter().any(|text| text.contains(word)), "{name}, {ending}: {listed:?}");
        }
    }
}
