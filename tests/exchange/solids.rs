//! Solids of stacked machines: closed, of the right volume, at their heights; layers in drawings and lists.

use std::collections::{BTreeSet, HashMap};
use std::f64::consts::PI;

use stillbase::exchange::cut::{Cut, bar_extent};
use stillbase::exchange::drawing::{Sheet, dxf};
use stillbase::exchange::form::{Exported, Form};
use stillbase::exchange::mjcf::middle;
use stillbase::exchange::parts::PartsList;
use stillbase::exchange::solids::{axles, link_solids};
use stillbase::exchange::stl::{SolidMesh, SolidsError, solids, stl};
use stillbase::mechanics::machine::{Counterweight, CounterweightShape, Machine, builtin};
use stillbase::mechanics::planar::Vector;
use stillbase::mechanics::sketch::Template;
use stillbase::study::layers::{LayersRequest, find_layers};

use crate::support::Noise;
use crate::support::random::a_chain;

fn stacked(machine: &Machine, cut: Cut) -> Machine {
    let request = LayersRequest { machine: machine.clone(), cut, motion: None, along_task: false };
    find_layers(&request).unwrap_or_else(|why| panic!("{}: {why}", machine.name())).machine
}

fn with_discs(machine: &Machine) -> Machine {
    let mut spec = machine.spec().clone();
    for (link, across) in [(0, 0.0), (1, 0.09)] {
        spec.counterweights.push(Counterweight {
            link: spec.links[link].name.clone(),
            mass: 1.5,
            at: -0.02,
            across,
            radius: 0.05,
            ..Default::default()
        });
    }
    Machine::new(spec).expect("a machine")
}

fn machines() -> Vec<Machine> {
    let noise = &mut Noise::of(8);
    let narrow = builtin("nine-link").expect("built in");
    let narrow = narrow.set_all([("limits.a1", "0.4,2.7"), ("limits.a2", "0.4,2.7")]).expect("limits");
    let mut all = vec![narrow, builtin("two-drive").expect("built in").clone()];
    all.extend((2..6).map(|n| a_chain(noise, n)));
    all.extend((2..5).map(|n| with_discs(&a_chain(noise, n))));
    all
}

/// Every edge of a closed surface belongs to two triangles, which run along it in opposite directions.
fn is_closed(solid: &SolidMesh) -> bool {
    let mut edges: HashMap<[[u64; 3]; 2], i32> = HashMap::new();
    let key = |p: [f64; 3]| p.map(|x| (x + 0.0).to_bits());
    for [a, b, c] in &solid.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry([key(*from), key(*to)]).or_default() += 1;
        }
    }
    edges.iter().all(|([from, to], count)| *count == 1 && edges.get(&[*to, *from]) == Some(&1))
}

#[test]
fn solids_are_closed_and_have_their_volume() {
    let cut = Cut { bar_width: 0.02, pin_diameter: 0.006, ..Cut::default() };
    let mut counted = 0;
    for machine in machines() {
        let machine = stacked(&machine, cut);
        let all = solids(&machine, &middle(&machine), &cut).expect("solids");
        for solid in &all {
            assert!(is_closed(solid), "{}: {}", machine.name(), solid.name);
            assert!(solid.volume() > 0.0, "{}: {}", machine.name(), solid.name);
        }
        for (j, link) in machine.spec().links.iter().enumerate() {
            let solid = all.iter().find(|solid| solid.name == format!("link {}", link.name)).expect("a bar");
            let ([from, to], round) = (bar_extent(&machine, j), |d: f64| 0.25 * PI * d * d);
            let drilled = machine.pin_places(j).len() as f64 * round(cut.pin_diameter);
            let wanted = ((to - from) * cut.bar_width + round(cut.bar_width) - drilled) * cut.plate_thickness;
            assert!((solid.volume() - wanted).abs() < 1e-9 * wanted, "{}: {}", machine.name(), solid.name);
            let z = solid.triangles.iter().flatten().map(|p| p[2]);
            let (low, high) = z.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
            assert!((low - link.axial + 0.003).abs() < 1e-12 && (high - link.axial - 0.003).abs() < 1e-12);
        }
        for (i, weight) in machine.spec().counterweights.iter().enumerate() {
            let name = format!("counterweight {} on link {}", i + 1, weight.link);
            let solid = all.iter().find(|solid| solid.name == name).expect("a disc");
            // Of its mass in steel, less the holes for pins within it.
            let drilled = weight.mass / cut.density - solid.volume();
            let hole = 0.25 * PI * cut.pin_diameter.powi(2) * cut.thickness_of(weight).expect("a disc");
            let count = drilled / hole;
            assert!(count > -1e-9 && (count - count.round()).abs() < 1e-6, "{}: {count} holes", machine.name());
            counted += 1;
        }
        assert!(all.iter().any(|solid| solid.name.starts_with("spacer 1 on the axis of the base")));
        assert!(all.iter().any(|solid| solid.name.starts_with("pin of links")), "{}", machine.name());
    }
    assert_eq!(counted, 6);
}

#[test]
fn a_file_has_each_solid_once_in_millimetres() {
    let cut = Cut::default();
    let machine = stacked(builtin("two-drive").expect("built in"), cut);
    let text = stl(&machine, &middle(&machine), &cut).expect("solids");
    let all = solids(&machine, &middle(&machine), &cut).expect("solids");
    let count = |word: &str| text.lines().filter(|line| line.starts_with(word)).count();
    assert_eq!((count("solid "), count("endsolid ")), (all.len(), all.len()));
    let triangles: usize = all.iter().map(|solid| solid.triangles.len()).sum();
    assert_eq!((count("facet "), count("vertex ")), (triangles, 3 * triangles));
    let first = text.lines().find_map(|line| line.strip_prefix("vertex ")).expect("a vertex");
    let read: Vec<f64> = first.split(' ').map(|word| word.parse().expect("a number")).collect();
    let own = all[0].triangles[0][0];
    assert!(read.iter().zip(own).all(|(mm, m)| (mm - 1e3 * m).abs() < 1e-5), "{first}");
    assert!(text.is_ascii());
}

#[test]
fn links_of_one_height_make_no_solids() {
    let (machine, cut) = (builtin("two-drive").expect("built in"), Cut::default());
    let why = solids(machine, &middle(machine), &cut).expect_err("all lie at one height");
    assert!(matches!(&why, SolidsError::Height { a, b } if a == "1" && b == "2"), "{why}");
    assert!(why.to_string().contains("stillbase layers"), "{why}");
    let stacked = stacked(machine, cut);
    assert_eq!(solids(&stacked, &[0.0], &cut), Err(SolidsError::Pose { given: 1, wanted: 2 }));
    assert!(
        Form::of("STL")
            .expect("a form")
            .written(&Exported { machine: &stacked, base: None, pose: &[0.0, f64::NAN], cut: &cut })
            .is_err()
    );
}

/// Every layer on which something lies is declared, for machines with and without parts.
#[test]
fn drawings_declare_their_layers() {
    let templates = Template::ALL.into_iter().filter_map(|template| template.sketch().machine());
    for flat in templates.chain(["two-drive", "nine-link"].map(|name| builtin(name).expect("built in").clone())) {
        let cut = Cut::default().fitting(&flat);
        let mut spec = flat.spec().clone();
        for (i, link) in spec.links.iter_mut().enumerate() {
            link.axial = i as f64 * cut.layer_pitch();
        }
        let text = dxf(&Sheet::of(&Machine::new(spec).expect("valid"), &cut).expect("a sheet"));
        let (tables, entities) = text.split_once("ENTITIES").expect("two sections");
        let lines: Vec<&str> = entities.lines().collect();
        let used: BTreeSet<&str> = lines.windows(2).filter(|pair| pair[0] == "8").map(|pair| pair[1]).collect();
        assert!(used.len() > 2 * flat.links().len(), "{used:?}");
        for layer in used {
            assert!(tables.contains(&format!("LAYER\n2\n{layer}\n")), "{}: {layer}", flat.name());
        }
    }
}

/// A spacer ends at what lies under it, also at a counterweight whose edge does not reach the pin.
#[test]
fn spacers_run_through_nothing_of_their_links() {
    let cut = Cut::default();
    let mut seen = 0;
    for gap in [-0.02, 0.001, 0.0045, 0.0055, 0.0065] {
        let mut spec = builtin("two-drive").expect("built in").spec().clone();
        for link in &mut spec.links {
            link.axial = 0.0;
        }
        let link = spec.links[1].name.clone();
        let shape = CounterweightShape::Disc { radius: 0.03 };
        spec.counterweights = vec![Counterweight::new(link, 0.6, [-0.03 - gap, 0.0], shape)];
        let machine = stacked(&Machine::new(spec).expect("valid"), cut);
        let solids = link_solids(&machine, &cut);
        for axle in axles(&machine) {
            for spacer in axle.spacers(&machine, &cut, &solids) {
                for solid in &solids {
                    let Some((_, along)) = axle.links.iter().find(|(link, _)| *link == solid.link) else { continue };
                    let is_under = solid.plan.distance(Vector::new(*along, 0.0)) < cut.spacer_radius() - 1e-9;
                    let [low, high] = solid.faces(&machine);
                    let meets = spacer.faces[0] < high - 1e-9 && spacer.faces[1] > low + 1e-9;
                    assert!(!(is_under && meets), "{gap}: {} meets spacer {}", solid.name(&machine), spacer.number);
                    seen += usize::from(is_under);
                }
            }
        }
    }
    assert!(seen > 20, "{seen}");
}

#[test]
fn drawings_and_lists_say_the_layer() {
    let (flat, cut) = (builtin("two-drive").expect("built in"), Cut::default());
    let machine = stacked(flat, cut);
    assert_eq!((cut.layers_of(flat), cut.layers_of(&machine)), (None, Some(vec![0, 1, 2, 1])));
    let drawn = |machine: &Machine| dxf(&Sheet::of(machine, &cut).expect("a sheet"));
    let on = |text: &str, layer: &str| text.contains(&format!("POLYLINE\n8\n{layer}\n"));
    assert!(on(&drawn(flat), "OUTLINE") && !drawn(flat).contains("OUTLINE_"));
    let text = drawn(&machine);
    for layer in ["OUTLINE_0", "OUTLINE_1", "OUTLINE_2"] {
        assert!(on(&text, layer) && text.contains(&format!("LAYER\n2\n{layer}\n")), "{layer}");
    }
    assert!(text.contains("layer 2, 14.0 mm high") && !on(&text, "OUTLINE"));
    let list = |machine: &Machine| PartsList::of(machine, &cut).expect("parts").cells().csv();
    assert!(list(&machine).lines().next().is_some_and(|head| head.contains("layer,height m")));
    assert!(!list(flat).contains("height m") && !list(flat).contains("pin length m"));
    let row = list(&machine).lines().find(|line| line.starts_with("link,3,")).map(str::to_owned);
    assert!(row.is_some_and(|row| row.contains(",2,0.014")), "{}", list(&machine));
}
