//! Layers against brute force: contacts against sampled poses, orders against all orders, heights against sampled
//! solids.

use std::collections::BTreeSet;

use stillbase::exchange::cut::Cut;
use stillbase::mechanics::joint_forces::AxialMoments;
use stillbase::mechanics::machine::{
    Attach, Link, LinkPoint, Lump, Machine, Part, PlaceOnLink, Shape, builtin, place_of,
};
use stillbase::mechanics::planar::{MAX_DRIVES, UnitVectors, Vector, unit};
use stillbase::study::layers::{
    Between, Clash, Contact, LayersReport, LayersRequest, NoLayers, find_contacts, find_layers,
};

use crate::support::Noise;
use crate::support::random::{a_chain, a_machine};

/// A solid of its own making: a point, a line or a polygon with a radius around it, the faces of its height, and its
/// link.
struct Body {
    name: String,
    link: Option<usize>,
    corners: Vec<Vector>,
    radius: f64,
    faces: [f64; 2],
    /// Links of a pin.
    joins: Vec<usize>,
}

fn units(q: &[f64]) -> UnitVectors {
    std::array::from_fn(|k| unit(q.get(k).copied().unwrap_or(0.0)))
}

/// All solids of a machine in a pose, from the file's data alone.
fn bodies(machine: &Machine, cut: &Cut, q: &[f64]) -> Vec<Body> {
    let e = units(q);
    let mut all = Vec::new();
    let mut pins: Vec<([f64; MAX_DRIVES], Vec<usize>)> = Vec::new();
    for (j, (link, part)) in machine.spec().links.iter().zip(machine.resolved_links()).enumerate() {
        let along = e[part.drive] * part.sign;
        let root = place_of(&part.root, &e);
        let weights: Vec<_> = machine.spec().counterweights.iter().filter(|w| w.link == link.name).collect();
        let stations = part.pins.iter().copied().chain([0.0, part.length]).chain(weights.iter().map(|w| w.at));
        let (from, to) = stations.fold((0.0_f64, 0.0_f64), |(a, b), s| (a.min(s), b.max(s)));
        let faces = |t: f64| [link.axial - 0.5 * t, link.axial + 0.5 * t];
        let body = |name: String, corners: &[Vector], radius: f64, t: f64| Body {
            name,
            link: Some(j),
            corners: corners.iter().map(|x| root + along * x).collect(),
            radius,
            faces: faces(t),
            joins: vec![],
        };
        let x = |s: f64| Vector::new(s, 0.0);
        let parts: Vec<_> = machine.spec().parts.iter().filter(|made| made.link == link.name).collect();
        if parts.is_empty() {
            let ends = [x(from), x(to)];
            all.push(body(format!("link {}", link.name), &ends, 0.5 * cut.bar_width, cut.plate_thickness));
        }
        for made in &parts {
            let thick = made.thickness.or(made.height).or(made.diameter).expect("a height");
            let of_link = format!("link {}", link.name);
            let half = 0.5 * made.width.or(made.diameter).unwrap_or(0.0);
            let end = part.length;
            match made.shape {
                Shape::Plate => {
                    let corners: Vec<Vector> = made.polygon.iter().map(|[x, y]| Vector::new(*x, *y)).collect();
                    all.push(body(format!("{} on {of_link}", made.name), &corners, 0.0, thick));
                }
                Shape::Flat => all.push(body(of_link, &[x(0.0), x(end)], half, thick)),
                _ => {
                    let corners = [[0.0, -half], [end, -half], [end, half], [0.0, half]];
                    all.push(body(of_link, &corners.map(|[x, y]| Vector::new(x, y)), 0.0, thick));
                }
            }
        }
        // Bodies without a shape are cylinders of steel: J = m r² / 2, or as high as wide.
        let cylinder = |mass: f64, inertia: f64| {
            let volume = mass / cut.density;
            let wide = (volume / (2.0 * std::f64::consts::PI)).cbrt();
            let radius = if inertia > 0.0 { (2.0 * inertia / mass).sqrt() } else { wide };
            (radius, volume / (std::f64::consts::PI * radius * radius))
        };
        for lump in machine.spec().lumps.iter().filter(|lump| lump.link == link.name) {
            let PlaceOnLink::Metres(at) = lump.at else { panic!("a place in m") };
            let (radius, high) = cylinder(lump.mass, lump.inertia);
            let name = format!("{} on link {}", lump.name, link.name);
            all.push(body(name, &[Vector::new(at, lump.across)], radius, high));
        }
        let payload = machine.spec().payload;
        if payload.mass > 0.0 && machine.end_link() == j {
            let (radius, high) = cylinder(payload.mass, payload.inertia);
            let end = (machine.end_effector()[part.drive] - part.root[part.drive]) * part.sign;
            let at = Vector::new(end + payload.offset[0], payload.offset[1]);
            let mut own = body(format!("payload on link {}", link.name), &[at], radius, high);
            own.faces = own.faces.map(|z| z - link.axial + payload.axial);
            all.push(own);
        }
        for (i, weight) in machine.spec().counterweights.iter().enumerate().filter(|(_, w)| w.link == link.name) {
            if weight.radius == 0.0 {
                continue;
            }
            let thick = weight.mass / (cut.density * std::f64::consts::PI * weight.radius.powi(2));
            let at = Vector::new(weight.at, weight.across);
            all.push(body(format!("counterweight {} on link {}", i + 1, link.name), &[at], weight.radius, thick));
            if weight.across.abs() > 0.5 * cut.bar_width {
                let name = format!("arm to counterweight {} on link {}", i + 1, link.name);
                all.push(body(name, &[x(weight.at), at], 0.5 * cut.bar_width, cut.plate_thickness));
            }
        }
        for s in &part.pins {
            let at = part.point(*s);
            match pins.iter_mut().find(|(p, _)| p.iter().zip(&at).all(|(a, b)| (a - b).abs() < 1e-9)) {
                Some((_, joined)) => joined.push(j),
                None => pins.push((at, vec![j])),
            }
        }
    }
    for (chain, joins) in pins {
        let on_base = chain.iter().all(|w| w.abs() < 1e-9);
        if !on_base && joins.len() < 2 {
            continue;
        }
        let height = |j: &usize| machine.spec().links[*j].axial;
        let low = joins.iter().map(height).fold(f64::INFINITY, f64::min) - 0.5 * cut.plate_thickness;
        let high = joins.iter().map(height).fold(f64::NEG_INFINITY, f64::max) + 0.5 * cut.plate_thickness;
        let faces = [if on_base { -1e9 } else { low }, high];
        let names: Vec<&str> = joins.iter().map(|j| machine.spec().links[*j].name.as_str()).collect();
        let name = match (on_base, names.split_last()) {
            (false, Some((last, first))) => format!("pin of links {} and {last}", first.join(", ")),
            _ => "axis of the base".into(),
        };
        // Spacers around it are wider.
        let radius = (0.75 * cut.pin_diameter).min(0.5 * cut.bar_width);
        all.push(Body { name, link: None, corners: vec![place_of(&chain, &e)], radius, faces, joins });
    }
    all
}

/// The distance of a point from a body without its radius; below 0 inside a polygon, around which the corners turn once.
fn distance(p: Vector, body: &Body) -> f64 {
    let next = body.corners.iter().cycle().skip(1);
    let to_side = |(a, b): (&Vector, &Vector)| {
        let along = b - a;
        let whole = along.norm_sqr();
        let t = if whole > 0.0 { ((p - a) * along.conj()).re / whole } else { 0.0 };
        (p - a - along * t.clamp(0.0, 1.0)).norm()
    };
    let least = body.corners.iter().zip(next.clone()).map(to_side).fold(f64::INFINITY, f64::min);
    let is_beyond = |of: fn(&Vector) -> f64| body.corners.iter().all(|corner| of(corner) < of(&p));
    let is_outside = body.corners.len() < 3
        || [|x: &Vector| x.re, |x: &Vector| x.im, |x: &Vector| -x.re, |x: &Vector| -x.im].into_iter().any(is_beyond);
    let turned = || body.corners.iter().zip(next).map(|(a, b)| ((b - p) / (a - p)).arg()).sum::<f64>();
    if !is_outside && turned().abs() > 3.0 { -least } else { least }
}

/// The distance of two outlines by points on one and nearest points of the other, at most `step` too large.
fn gap(a: &Body, b: &Body, count: usize) -> f64 {
    let next = a.corners.iter().cycle().skip(1);
    let sides = a.corners.iter().zip(next);
    let on = sides.flat_map(|(from, to)| (0..=count).map(move |i| from + (to - from) * (i as f64 / count as f64)));
    let least = on.map(|p| distance(p, b)).fold(f64::INFINITY, f64::min);
    least - a.radius - b.radius
}

/// Pairs that may not overlap: solids of different links, and solids with pins of other links.
fn is_pair(a: &Body, b: &Body) -> bool {
    match (a.link, b.link) {
        (Some(i), Some(j)) => i != j,
        (Some(i), None) => !b.joins.contains(&i),
        (None, Some(j)) => !a.joins.contains(&j),
        (None, None) => false,
    }
}

fn pair_name(a: &str, b: &str) -> [String; 2] {
    let mut pair = [a.to_owned(), b.to_owned()];
    pair.sort();
    pair
}

/// A pose within the limits, by the angles in the order of the file, or anywhere where there are none.
fn a_pose(noise: &mut Noise, machine: &Machine) -> Vec<f64> {
    let mut q: Vec<f64> = (0..machine.drives()).map(|_| noise.between(-3.2, 3.2)).collect();
    for angle in machine.angles() {
        let (low, high) = (*angle.limits.start(), *angle.limits.end());
        if low.is_finite() && high.is_finite() {
            q[angle.to] = q[angle.from] + noise.between(low, high) - angle.offset;
        }
    }
    q
}

fn is_within(machine: &Machine, q: &[f64]) -> bool {
    machine.angles().iter().all(|angle| {
        let a = q[angle.to] - q[angle.from] + angle.offset;
        (angle.limits.start() - 1e-9..=angle.limits.end() + 1e-9).contains(&a)
    })
}

fn request(machine: &Machine, cut: Cut) -> LayersRequest {
    LayersRequest { machine: machine.clone(), cut, motion: None, along_task: false }
}

fn thin() -> Cut {
    Cut { bar_width: 0.02, pin_diameter: 0.004, ..Cut::default() }
}

/// A random chain with counterweights of steel on two links.
fn weighted(noise: &mut Noise, drives: usize) -> Machine {
    let machine = a_chain(noise, drives);
    let mut spec = machine.spec().clone();
    for link in machine.spec().links.iter().take(2) {
        spec.counterweights.push(stillbase::mechanics::machine::Counterweight {
            link: link.name.clone(),
            mass: noise.between(0.2, 3.0),
            at: noise.between(-0.2, 0.1),
            across: if noise.between(0.0, 1.0) < 0.3 { noise.between(-0.1, 0.1) } else { 0.0 },
            radius: noise.between(0.02, 0.06),
            ..Default::default()
        });
    }
    Machine::new(spec).expect("a machine")
}

/// A random chain of bars, plates, tubes and profiles with lumps and a payload.
fn built(noise: &mut Noise, drives: usize) -> Machine {
    let mut spec = a_chain(noise, drives).spec().clone();
    for (j, link) in spec.links.iter().enumerate() {
        let (width, thickness) = (noise.between(0.01, 0.03), noise.between(0.003, 0.008));
        let flat = Part { name: "bar".into(), width: Some(width), ..Part::flat(&link.name, thickness) };
        let (reach, side) = (noise.between(0.03, 0.15), noise.sign());
        let polygon =
            vec![[0.02, 0.0], [0.02 + reach, 0.0], [0.02 + 0.5 * reach, 0.3 * side * reach], [0.0, side * reach]];
        match j % 4 {
            0 => spec.parts.push(flat),
            1 => spec.parts.push(Part {
                shape: Shape::Profile,
                height: Some(0.02),
                wall: Some(0.002),
                thickness: None,
                ..flat
            }),
            2 => spec.parts.push(Part {
                shape: Shape::Tube,
                width: None,
                thickness: None,
                diameter: Some(0.02),
                wall: Some(0.001),
                ..flat
            }),
            _ => {}
        }
        if noise.between(0.0, 1.0) < 0.6 && j % 4 != 3 {
            let name = "plate".into();
            spec.parts.push(Part { name, shape: Shape::Plate, polygon, ..Part::flat(&link.name, thickness) });
        }
        if noise.between(0.0, 1.0) < 0.7 {
            spec.lumps.push(Lump {
                link: link.name.clone(),
                name: format!("motor {j}"),
                mass: noise.between(0.05, 0.5),
                at: PlaceOnLink::Metres(noise.between(-0.1, 0.3)),
                across: if noise.between(0.0, 1.0) < 0.5 { noise.between(-0.05, 0.05) } else { 0.0 },
                inertia: if noise.between(0.0, 1.0) < 0.5 { noise.between(1e-5, 3e-4) } else { 0.0 },
            });
        }
    }
    spec.payload.mass = noise.between(0.1, 0.5);
    spec.payload.axial = 0.02 * noise.between(-1.0, 1.0).round();
    Machine::new(spec).expect("a machine")
}

fn machines(noise: &mut Noise) -> Vec<Machine> {
    let mut all: Vec<Machine> = (0..6).map(|_| a_machine(noise)).collect();
    all.extend((2..6).map(|n| a_chain(noise, n)));
    let with: Vec<Machine> = (2..5).map(|n| weighted(noise, n)).collect();
    all.extend(with);
    let with: Vec<Machine> = (2..6).map(|n| built(noise, n)).collect();
    all.extend(with);
    all.extend(["nine-link", "two-drive", "space-arm"].map(|name| builtin(name).expect("built in").clone()));
    all
}

#[test]
fn contacts_are_those_of_sampled_poses() {
    let noise = &mut Noise::of(31);
    let mut seen = 0;
    for machine in machines(noise) {
        let cut = thin();
        let Ok(contacts) = find_contacts(&request(&machine, cut)) else { continue };
        let known: BTreeSet<[String; 2]> = contacts.iter().map(|c| pair_name(&c.a, &c.b)).collect();
        for contact in contacts.iter().filter(|contact| contact.decided) {
            assert!(is_within(&machine, &contact.q), "{}: {contact:?}", machine.name());
            let all = bodies(&machine, &cut, &contact.q);
            let of = |name: &str| all.iter().find(|body| body.name == name).unwrap_or_else(|| panic!("no {name}"));
            let (a, b) = (of(&contact.a), of(&contact.b));
            let nearest = gap(a, b, 4000).min(gap(b, a, 4000));
            // Outlines without width that cross are seen no better than the step.
            assert!(nearest < 2e-4, "{}: {contact:?} {nearest}", machine.name());
            let at = Body {
                name: String::new(),
                link: None,
                corners: vec![Vector::new(contact.at[0], contact.at[1])],
                radius: 0.0,
                faces: [0.0; 2],
                joins: vec![],
            };
            assert!(gap(&at, a, 1) < 1e-9 && gap(&at, b, 1) < 1e-9, "{}: a point of both, {contact:?}", machine.name());
        }
        for _ in 0..400 {
            let q = a_pose(noise, &machine);
            let all = bodies(&machine, &cut, &q);
            for (i, a) in all.iter().enumerate() {
                for b in all[i + 1..].iter().filter(|b| is_pair(a, b)) {
                    if gap(a, b, 30).min(gap(b, a, 30)) < -1e-9 {
                        seen += 1;
                        assert!(
                            known.contains(&pair_name(&a.name, &b.name)),
                            "{}: {}, {}",
                            machine.name(),
                            a.name,
                            b.name
                        );
                    }
                }
            }
        }
    }
    assert!(seen > 1000, "{seen}");
}

/// Whether all solids of a machine at its heights keep apart in sampled poses.
fn keeps_apart(noise: &mut Noise, machine: &Machine, cut: &Cut, poses: usize) -> Result<(), String> {
    for _ in 0..poses {
        let q = a_pose(noise, machine);
        let all = bodies(machine, cut, &q);
        for (i, a) in all.iter().enumerate() {
            for b in all[i + 1..].iter().filter(|b| is_pair(a, b)) {
                let apart = (a.faces[0] - b.faces[1]).max(b.faces[0] - a.faces[1]);
                if apart < 0.999 * cut.spacer && gap(a, b, 30).min(gap(b, a, 30)) < -1e-9 {
                    return Err(format!("{} and {}", a.name, b.name));
                }
            }
        }
    }
    Ok(())
}

#[test]
fn no_solid_meets_another_at_the_heights_found() {
    let noise = &mut Noise::of(5);
    let mut found = 0;
    for machine in machines(noise) {
        let cut = thin();
        match find_layers(&request(&machine, cut)) {
            Ok(report) => {
                found += 1;
                keeps_apart(noise, &report.machine, &cut, 300)
                    .unwrap_or_else(|why| panic!("{}: {why}", machine.name()));
                let lowest = bodies(&report.machine, &cut, &vec![0.0; machine.drives()]);
                let face = lowest.iter().filter(|b| b.link.is_some()).map(|b| b.faces[0]).fold(f64::INFINITY, f64::min);
                assert!(face > -0.5 * cut.plate_thickness - 1e-9, "{}: the base plate is free", machine.name());
            }
            Err(NoLayers::NoOrder(_)) => {}
            Err(why) => assert!(matches!(why, NoLayers::Cut(_)), "{}: {why}", machine.name()),
        }
    }
    assert!(found > 6, "{found}");
}

/// Whether layers keep all contacts apart, by heights.
fn is_order(machine: &Machine, cut: &Cut, contacts: &[Contact], layers: &[usize]) -> bool {
    let mut spec = machine.spec().clone();
    for (link, layer) in spec.links.iter_mut().zip(layers) {
        link.axial = *layer as f64 * (cut.plate_thickness + cut.spacer);
    }
    spec.payload.axial = spec.links[machine.end_link()].axial;
    let all = bodies(&Machine::new(spec).expect("a machine"), cut, &vec![0.0; machine.drives()]);
    let of = |name: &str| all.iter().find(|body| body.name == name).expect("a solid");
    let above_base = all.iter().filter(|b| b.link.is_some()).all(|b| b.faces[0] > -0.5 * cut.plate_thickness - 1e-9);
    above_base
        && contacts.iter().all(|contact| {
            let (a, b) = (of(&contact.a), of(&contact.b));
            (a.faces[0] - b.faces[1]).max(b.faces[0] - a.faces[1]) > cut.spacer - 1e-9
        })
}

fn tilt(machine: &Machine, cut: &Cut, layers: &[usize]) -> f64 {
    let mut spec = machine.spec().clone();
    let pitch = cut.plate_thickness + cut.spacer;
    for (link, layer) in spec.links.iter_mut().zip(layers) {
        link.axial = *layer as f64 * pitch;
    }
    spec.payload.axial = layers[machine.end_link()] as f64 * pitch;
    let axial = AxialMoments::of(&Machine::new(spec).expect("a machine"));
    axial.sum()
}

/// Calls `f` with all layers of `links` links below `count`.
fn every(links: usize, count: usize, mut f: impl FnMut(&[usize])) {
    let mut layers = vec![0; links];
    loop {
        f(&layers);
        let Some(i) = layers.iter().position(|layer| layer + 1 < count) else { return };
        layers[..i].fill(0);
        layers[i] += 1;
    }
}

#[test]
fn the_order_is_the_best_of_all() {
    let noise = &mut Noise::of(77);
    let mut chains: Vec<Machine> = (2..6).flat_map(|n| [a_chain(noise, n), a_chain(noise, n)]).collect();
    let with: Vec<Machine> = [2, 3, 3].into_iter().map(|n| weighted(noise, n)).collect();
    chains.extend(with);
    let with = [2, 2, 3].into_iter().map(|n| built(noise, n).set("payload.axial", "0").expect("a height"));
    chains.extend(with.collect::<Vec<_>>());
    chains.extend(["two-drive", "counter-rotating", "scara"].map(|name| builtin(name).expect("built in").clone()));
    let (mut compared, mut undecided) = (0, 0);
    for machine in &chains {
        let cut = thin();
        let contacts = find_contacts(&request(machine, cut)).expect("bars that can be cut");
        let Ok(LayersReport { layers, count, minimal, least_tilt, tilt_coefficient, .. }) =
            find_layers(&request(machine, cut))
        else {
            every(machine.links().len(), machine.links().len(), |layers| {
                assert!(!is_order(machine, &cut, &contacts, layers), "{}: {layers:?}", machine.name());
            });
            continue;
        };
        let own: Vec<usize> = layers.iter().map(|layer| layer.layer).collect();
        assert!(is_order(machine, &cut, &contacts, &own), "{}: {own:?}", machine.name());
        let certain: Vec<Contact> = contacts.iter().filter(|contact| contact.decided).cloned().collect();
        if certain.len() < contacts.len() {
            // What is not decided counts as meeting, but it proves nothing.
            undecided += 1;
            assert!(!least_tilt, "{}: {own:?}", machine.name());
            if minimal && count > 1 {
                every(machine.links().len(), count - 1, |layers| {
                    assert!(!is_order(machine, &cut, &certain, layers), "{}: {layers:?} is lower", machine.name());
                });
            }
            continue;
        }
        assert!(minimal && least_tilt, "{}: {own:?}", machine.name());
        if count > 12 {
            continue;
        }
        compared += 1;
        let mut best = f64::INFINITY;
        every(machine.links().len(), count, |layers| {
            if is_order(machine, &cut, &contacts, layers) {
                assert!(layers.iter().max() == Some(&(count - 1)), "{}: {layers:?} is lower", machine.name());
                best = best.min(tilt(machine, &cut, layers));
            }
        });
        assert!((tilt_coefficient.after - best).abs() < 1e-12 * (1.0 + best), "{}: {best}", machine.name());
    }
    assert!(compared > 7 && undecided > 0, "{compared} compared, {undecided} undecided");
}

#[test]
fn the_machine_of_the_paper_has_no_order_within_its_limits() {
    let machine = builtin("nine-link").expect("built in");
    let Err(NoLayers::NoOrder(conflict)) = find_layers(&request(machine, Cut::default())) else {
        panic!("links 4 and 6 both pass over the base axis, and each over a pin of the other")
    };
    assert_eq!(conflict.links, ["2", "3", "4", "6"]);
    let pairs: Vec<[&str; 2]> = conflict.contacts.iter().map(|c| [c.a.as_str(), c.b.as_str()]).collect();
    let wanted = [
        ["link 4", "axis of the base"],
        ["link 4", "pin of links 3 and 6"],
        ["link 6", "axis of the base"],
        ["link 6", "pin of links 2 and 4"],
    ];
    assert_eq!(pairs, wanted);
    // Bars that stay on one side of their change points have one.
    let narrow = machine.set_all([("limits.a1", "0.4,2.7"), ("limits.a2", "0.4,2.7")]).expect("limits");
    let report = find_layers(&request(&narrow, Cut::default())).expect("an order");
    assert!(report.minimal && report.least_tilt && report.is_decided());
    assert_eq!(report.count, 5);
}

#[test]
fn dimensions_that_cannot_be_are_refused() {
    let machine = builtin("two-drive").expect("built in");
    for cut in [
        Cut { plate_thickness: 0.0, ..Cut::default() },
        Cut { spacer: f64::NAN, ..Cut::default() },
        Cut { bar_width: 0.004, ..Cut::default() },
    ] {
        assert!(matches!(find_layers(&request(machine, cut)), Err(NoLayers::Cut(_))), "{cut:?}");
    }
    let without_task = LayersRequest { along_task: true, ..request(machine, Cut::default()) };
    assert!(matches!(find_layers(&without_task), Err(NoLayers::Motion(2))));
}

/// Sixty bars with a plate and a motor each, of which hundreds of pairs meet.
#[test]
fn the_work_for_a_machine_of_many_solids_is_bounded() {
    let mut spec = builtin("serial-3r").expect("built in").spec().clone();
    let (drives, links) = (spec.drives.len(), spec.links.clone());
    for n in links.len()..60 {
        let (name, at) = (format!("n{n}"), PlaceOnLink::Metres(0.004 * n as f64));
        let attach = Attach::On(LinkPoint { link: links[n % drives].name.clone(), at });
        spec.links.push(Link {
            name: name.clone(),
            attach,
            drive: format!("{}", 1 + (n + 1) % drives),
            ..links[0].clone()
        });
        let polygon: Vec<[f64; 2]> =
            (0..40).map(|i| f64::from(i) * 0.157).map(|a| [0.1 * a.cos(), 0.06 * a.sin()]).collect();
        spec.parts.push(Part { name: "plate".into(), shape: Shape::Plate, polygon, ..Part::flat(&name, 0.006) });
        spec.lumps.push(Lump {
            link: name,
            name: format!("motor {n}"),
            mass: 0.2,
            at: PlaceOnLink::Metres(0.1),
            across: 0.03,
            inertia: 0.0,
        });
    }
    let machine = Machine::new(spec).expect("a machine of sixty links");
    let begun = std::time::Instant::now();
    let contacts = find_contacts(&request(&machine, thin())).expect("contacts");
    assert!(contacts.len() > 500, "{}", contacts.len());
    assert!(begun.elapsed().as_secs() < 20, "{:?}", begun.elapsed());
    assert!(matches!(find_layers(&request(&machine, thin())), Err(NoLayers::NoOrder(_) | NoLayers::NotFound)));
    assert!(begun.elapsed().as_secs() < 60, "{:?}", begun.elapsed());
}

/// At the heights that are found nothing meets; two links that meet are named once they are put at one height.
#[test]
fn heights_that_do_not_fit_are_told() {
    let (noise, cut) = (&mut Noise::of(77), thin());
    let mut told = 0;
    for machine in machines(noise) {
        let Ok(report) = find_layers(&request(&machine, cut)) else { continue };
        let contacts = |machine: &Machine| find_contacts(&request(machine, cut)).expect("they can be cut");
        let fits = Clash::all(&report.machine, &contacts(&report.machine));
        assert!(fits.is_empty(), "{}: {fits:?}", machine.name());
        let of_links = |contact: &&Contact| matches!(contact.between, Between::Links(..));
        let Some(met) = report.meetings.iter().find(of_links) else { continue };
        let Between::Links(a, b) = met.between else { continue };
        let mut spec = report.machine.spec().clone();
        spec.links[a].axial = spec.links[b].axial;
        let changed = Machine::new(spec).expect("a machine");
        if changed.spec().links.windows(2).all(|pair| pair[0].axial == pair[1].axial) {
            continue;
        }
        let clashes = Clash::all(&changed, &contacts(&changed));
        let names = |clash: &&Clash| clash.a == met.a && clash.b == met.b;
        let clash = clashes.iter().find(names).unwrap_or_else(|| panic!("{}: {} {}", machine.name(), met.a, met.b));
        assert!(clash.heights[1] > clash.heights[0]);
        told += 1;
    }
    assert!(told > 3, "{told}");
}
