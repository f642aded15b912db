//! Machines of the family at random.

use std::fmt::Write;

use nalgebra::Vector3;
use stillbase::mechanics::assembly::{self, Assembly};
use stillbase::mechanics::balance::design;
use stillbase::mechanics::machine::{
    Attach, Counterweight, CounterweightShape, GROUND, Length, LinkPoint, Machine, MachineSpec, PlaceOnLink, parse,
    to_toml,
};
use stillbase::mechanics::planar::{PerDrive, Vector, unit};
use stillbase::planning::pose_space::{NoPoseSpace, PoseSpace};

use super::Noise;

fn one_of(noise: &mut Noise, count: usize) -> usize {
    (noise.between(0.0, count as f64) as usize).min(count - 1)
}

/// Drives with motors on the base or on another, and rotors of any gear and sense.
fn drives(noise: &mut Noise, n: usize) -> String {
    let mut text = String::new();
    for k in 0..n {
        writeln!(text, "[[drive]]\nname = \"{}\"", k + 1).unwrap();
        // Any order: a motor may sit on a later drive, but in no circle.
        if k + 1 < n && noise.between(0.0, 1.0) < 0.5 {
            let on = k + 1 + one_of(noise, n - k - 1);
            writeln!(text, "on = \"{}\"", on + 1).unwrap();
        }
        if noise.between(0.0, 1.0) < 0.6 {
            let (inertia, ratio) = (noise.between(1e-6, 1e-4), noise.sign() * noise.between(1.0, 60.0));
            writeln!(text, "rotor = {{ inertia = {inertia}, ratio = {ratio} }}").unwrap();
        }
    }
    text
}

fn link(noise: &mut Noise, name: &str, drive: usize, attach: &str, length: f64, direction: i32) -> String {
    let (mass, inertia) = (noise.between(0.1, 4.0), noise.between(1e-3, 0.1));
    let com = noise.between(-0.3, 0.3);
    let normal = if noise.between(0.0, 1.0) < 0.3 { noise.between(-0.1, 0.1) } else { 0.0 };
    format!(
        "[[link]]\nname = \"{name}\"\ndrive = \"{}\"\nattach = {attach}\ndirection = {direction}\nlength = {length}\n\
         mass = {mass}\ninertia = {inertia}\ncom = {com}\ncom_normal = {normal}\n",
        drive + 1
    )
}

/// A tree of bars and parallelograms on one to eight drives.
pub fn a_machine(noise: &mut Noise) -> Machine {
    let n = 1 + one_of(noise, 8);
    let mut text = String::from("name = \"random\"\ngravity = [1.2, -9.81]\n");
    let (mut links, mut closures, mut count) = (String::new(), String::new(), 0);
    let mut name = || {
        count += 1;
        format!("b{count}")
    };
    let mut places: Vec<String> = vec!["\"base\"".into()];
    for k in 0..n {
        let (own, length) = (name(), noise.between(0.1, 0.6));
        let at = places[one_of(noise, places.len())].clone();
        let direction = if noise.between(0.0, 1.0) < 0.3 { -1 } else { 1 };
        links += &link(noise, &own, k, &at, length, direction);
        places.push(format!("{{ link = \"{own}\", at = \"tip\" }}"));
        places.push(format!("{{ link = \"{own}\", at = {} }}", noise.between(-0.2, 0.4)));
    }
    let loops = if n > 1 { one_of(noise, 3) } else { 0 };
    for _ in 0..loops {
        // Two bars from one point, and each again from the tip of the other.
        let (k, l) = (one_of(noise, n), one_of(noise, n));
        if k == l {
            continue;
        }
        let [a, b, c, d] = [name(), name(), name(), name()];
        let (first, second) = (noise.between(0.1, 0.5), noise.between(0.1, 0.5));
        let at = places[one_of(noise, places.len())].clone();
        let tip = |of: &str| format!("{{ link = \"{of}\", at = \"tip\" }}");
        links += &link(noise, &a, k, &at, first, 1);
        links += &link(noise, &b, l, &at, second, -1);
        links += &link(noise, &c, l, &tip(&a), second, -1);
        links += &link(noise, &d, k, &tip(&b), first, 1);
        write!(closures, "[[closure]]\na = {}\nb = {}\n", tip(&c), tip(&d)).unwrap();
        places.push(tip(&c));
    }
    if noise.between(0.0, 1.0) < 0.3 {
        let (mass, inertia) = (noise.between(0.1, 1.0), noise.between(0.0, 0.01));
        writeln!(text, "payload = {{ mass = {mass}, inertia = {inertia}, offset = [0.05, -0.02] }}").unwrap();
    }
    let end = places[1 + one_of(noise, places.len() - 1)].clone();
    let inner = end.trim_start_matches('{').trim_end_matches('}').replace(", ", "\n");
    let text = text + &drives(noise, n) + &links + &closures + "[end_effector]\n" + inner.trim() + "\n";
    parse(&text, "random").unwrap_or_else(|why| panic!("{why}\n{text}"))
}

/// A chain of n bars, one drive each, with angles between neighbours; all but the last can be given counterweights.
pub fn a_chain(noise: &mut Noise, n: usize) -> Machine {
    let mut text = String::from("name = \"chain\"\n") + &drives(noise, n);
    for k in 0..n {
        let at = if k == 0 { "\"base\"".to_owned() } else { format!("{{ link = \"{k}\", at = \"tip\" }}") };
        let (mass, inertia, length) = (noise.between(0.1, 4.0), noise.between(1e-3, 0.1), noise.between(0.1, 0.6));
        write!(
            text,
            "[[link]]\nname = \"{0}\"\ndrive = \"{0}\"\nattach = {at}\nlength = {length}\nmass = {mass}\n\
             inertia = {inertia}\ncom = {com}\n",
            k + 1,
            com = noise.between(-0.2, 0.2)
        )
        .unwrap();
    }
    writeln!(text, "[end_effector]\nlink = \"{n}\"").unwrap();
    for k in 1..n {
        let (low, width) = (noise.between(-3.0, 1.0), noise.between(0.5, 4.0));
        write!(
            text,
            "[[angle]]\nname = \"a{k}\"\nto = \"{}\"\nfrom = \"{k}\"\noffset = {}\nmin = {low}\nmax = {}\n",
            k + 1,
            noise.between(-1.0, 1.0),
            low + width
        )
        .unwrap();
    }
    parse(&text, "chain").unwrap_or_else(|why| panic!("{why}\n{text}"))
}

/// A balanced chain of n drives with motors and rotors anywhere, of which Σλ is above 0, and its poses by the way of any
/// number of drives.
pub fn a_space(noise: &mut Noise, n: usize) -> (Machine, PoseSpace) {
    loop {
        let machine = design(&a_chain(noise, n), &vec![1.0; n]).expect("a chain can be balanced");
        match PoseSpace::general(&machine) {
            Ok(space) => return (machine, space),
            Err(NoPoseSpace::Sum { .. }) => {}
            Err(why) => panic!("{why}"),
        }
    }
}

/// Relative angles within their limits.
pub fn a_pose(noise: &mut Noise, space: &PoseSpace) -> PerDrive {
    PerDrive::from_fn(space.joints().len(), |i| {
        let [low, high] = space.joints()[i].limits();
        noise.between(low, high)
    })
}

/// A machine, and a line between two points that it reaches at one b.
pub struct Case {
    pub machine: Machine,
    pub space: PoseSpace,
    pub b: f64,
    pub ends: [Vector; 2],
}

pub fn a_case(noise: &mut Noise, n: usize) -> Case {
    loop {
        let (machine, space) = a_space(noise, n);
        let b = noise.between(0.0, space.period());
        let from = space.end_effector(&space.lift(&a_pose(noise, &space), b));
        let far = noise.between(0.03, 0.4) * space.farthest();
        let to = from + far * unit(noise.between(-3.2, 3.2));
        if space.reaches(to, b) {
            return Case { machine, space, b, ends: [from, to] };
        }
    }
}

/// A machine of the family at random, with up to three counterweights.
pub fn with_counterweights(noise: &mut Noise) -> Machine {
    let machine = a_machine(noise);
    let mut spec = machine.spec().clone();
    for _ in 0..(noise.between(0.0, 4.0) as usize) {
        let j = noise.between(0.0, spec.links.len() as f64 - 1e-9) as usize;
        let (mass, at, radius) = (noise.between(0.1, 3.0), noise.between(-0.3, 0.3), noise.between(0.0, 0.1));
        spec.counterweights.push(Counterweight {
            link: spec.links[j].name.clone(),
            mass,
            at,
            across: noise.between(-0.1, 0.1),
            radius,
            ..Default::default()
        });
    }
    Machine::new(spec).expect("still a machine")
}

/// Adds links that keep their orientation, on the base or on others, and links that they carry.
pub fn add_ground(noise: &mut Noise, spec: &mut MachineSpec) {
    for i in 0..1 + one_of(noise, 2) {
        let places = spec.links.len() + 1;
        let attach = match one_of(noise, places) {
            0 => Attach::Base("base".into()),
            j => Attach::On(LinkPoint { link: spec.links[j - 1].name.clone(), at: PlaceOnLink::default() }),
        };
        let kept = format!("g{i}");
        let on = |link: &str| Attach::On(LinkPoint { link: link.into(), at: PlaceOnLink::default() });
        let drive = spec.drives[one_of(noise, spec.drives.len())].name.clone();
        for (name, drive, attach) in [
            (kept.clone(), GROUND.to_owned(), attach),
            (format!("h{i}"), drive, on(&kept)),
            (format!("k{i}"), GROUND.to_owned(), on(&format!("h{i}"))),
        ] {
            let mut link = spec.links[0].clone();
            (link.name, link.drive, link.attach) = (name, drive, attach);
            link.direction = if noise.between(0.0, 1.0) < 0.5 { -1 } else { 1 };
            link.length = Length::Metres(noise.between(0.05, 0.4));
            link.mass = noise.between(0.1, 2.0);
            (link.inertia, link.inertia_along, link.inertia_across) = (noise.between(1e-3, 0.05), 0.0, None);
            link.com = noise.between(-0.2, 0.2);
            link.com_normal = noise.between(-0.1, 0.1);
            link.axial = noise.between(-0.1, 0.1);
            spec.links.push(link);
        }
    }
}

/// A random direction frame.
fn frame(noise: &mut Noise) -> [[f64; 3]; 2] {
    let mut any = || Vector3::from_fn(|_, _| noise.between(-1.0, 1.0));
    let x = any().normalize();
    let y = any();
    let y = (y - x * x.dot(&y)).normalize();
    [x.into(), y.into()]
}

/// Moments of inertia about two axes in the plane of a body with a moment about the third.
fn in_plane(noise: &mut Noise, inertia: f64) -> (f64, Option<f64>) {
    let (share, thickness) = (noise.between(0.0, 1.0), noise.between(0.0, 0.5) * inertia);
    (share * inertia + thickness, Some((1.0 - share) * inertia + thickness))
}

/// A counterweight of any shape, or none.
fn a_counterweight(noise: &mut Noise, link: &str) -> Option<Counterweight> {
    let at = [noise.between(-0.2, 0.2), noise.between(-0.1, 0.1)];
    let (radius, inner_radius) = (noise.between(0.05, 0.1), noise.between(0.01, 0.04));
    let shape = match one_of(noise, 9) {
        0 => CounterweightShape::Point,
        1 => CounterweightShape::Disc { radius },
        2 => CounterweightShape::Ring { radius, inner_radius },
        3 => CounterweightShape::HalfRing { radius, inner_radius },
        4 => CounterweightShape::Box { length: radius, width: inner_radius },
        _ => return None,
    };
    Some(Counterweight::new(link, noise.between(0.1, 2.0), at, shape))
}

/// Two to four random machines with heights, on the base or on each other.
pub fn an_assembly(noise: &mut Noise) -> Assembly {
    let count = 2 + (noise.between(0.0, 2.999)) as usize;
    let gravity: [f64; 3] = [noise.between(-3.0, 3.0), noise.between(-3.0, 3.0), noise.between(-9.0, 0.0)];
    let mut text = format!("kind = \"assembly\"\nname = \"random\"\ngravity = {gravity:?}\n");
    for i in 0..count {
        let mut spec = loop {
            let machine = a_machine(noise);
            if machine.drives() < 8 {
                break machine.spec().clone();
            }
        };
        spec.gravity = [0.0; 2];
        spec.links.iter_mut().for_each(|link| link.axial = noise.between(-0.2, 0.2));
        spec.payload.axial = noise.between(-0.1, 0.1);
        spec.links.iter_mut().for_each(|link| {
            if noise.between(0.0, 1.0) < 0.6 {
                (link.inertia_along, link.inertia_across) = in_plane(noise, link.inertia);
            }
        });
        if noise.between(0.0, 1.0) < 0.5 {
            (spec.payload.inertia_along, spec.payload.inertia_across) = in_plane(noise, spec.payload.inertia);
        }
        spec.counterweights = spec.links.iter().filter_map(|link| a_counterweight(noise, &link.name)).collect();
        if noise.between(0.0, 1.0) < 0.4 {
            add_ground(noise, &mut spec);
        }
        let machine = to_toml(&Machine::new(spec).expect("a machine"));
        let on = if i > 0 && noise.between(0.0, 1.0) < 0.6 { format!("b{}", i - 1) } else { "base".into() };
        let at: [f64; 3] = std::array::from_fn(|_| noise.between(-0.5, 0.5));
        let [x, y] = frame(noise);
        text += &format!(
            "[[block]]\nname = \"b{i}\"\non = {on:?}\nat = {at:?}\nx = {x:?}\ny = {y:?}\nmachine = '''\n{machine}'''\n"
        );
    }
    assembly::parse(&text, "random", &|text| parse(text, "random")).expect("an assembly")
}
