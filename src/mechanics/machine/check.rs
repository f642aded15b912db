//! Makes a [`Machine`] from a specification: checks it, looks up names, and resolves roots and loops.

use super::Chain;
use super::caps::{MAX_CHAIN_LINKS, check_counts};
use super::error::{KeyPath, KeyStep, MachineError};
use super::inertia::Inertia;
use super::model::{Machine, MachineData, RelativeAngle, ResolvedClosure, ResolvedLink};
use super::motors::Motors;
use super::numbers::check_numbers;
use super::parts::weigh;
use super::ranges::{LENGTH, PLACE, within};
use super::spec::{Angle, Attach, Closure, GROUND, Length, Link, LinkPoint, MachineSpec, PlaceOnLink, Rotor};
use crate::planar::MAX_DRIVES;
use stillbase_settings::number::ShortNumber;
use stillbase_settings::range::{quote_clipped, shortened};
use stillbase_settings::text::control_character;

/// Tolerance of the gap between the two points of a closure along each drive, m.
pub const CLOSURE_TOLERANCE: f64 = 1e-9;

impl Machine {
    /// Makes a machine from a specification.
    ///
    /// # Errors
    /// If the specification is not a valid machine; returns the first error.
    pub fn new(mut spec: MachineSpec) -> Result<Self, MachineError> {
        // A rotor with the default values has no inertia and is removed.
        for drive in &mut spec.drives {
            drive.rotor = drive.rotor.filter(|rotor| *rotor != Rotor::default());
        }
        let parts = check_counts(&spec).and_then(|()| weigh(&mut spec)).map_err(|error| error.named(&spec))?;
        let resolved = Resolved::of(&spec).map_err(|error| error.named(&spec))?;
        let Resolved { links, bodies, end_effector, end_link, angles, loops, motors } = resolved;
        let machine = Self::from(MachineData {
            spec,
            bodies,
            part_bodies: parts,
            parts: links,
            end_effector,
            end_link,
            angles,
            loops,
            motors,
        });
        machine.check_inertia()?;
        Ok(machine)
    }

    fn check_inertia(&self) -> Result<(), MachineError> {
        let inertia = Inertia::of(self);
        match (0..self.drives()).find(|&k| inertia.diagonal(k).partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater)) {
            Some(k) => Err(MachineError::Massless { drive: self.spec().drives[k].name.clone() }),
            None => Ok(()),
        }
    }
}

/// The resolved parts of a specification.
struct Resolved {
    links: Vec<ResolvedLink>,
    bodies: Vec<Link>,
    end_effector: Chain,
    end_link: usize,
    angles: Vec<RelativeAngle>,
    loops: Vec<ResolvedClosure>,
    motors: Motors,
}

impl Resolved {
    fn of(spec: &MachineSpec) -> Result<Self, MachineError> {
        let names = Names::of(spec)?;
        check_numbers(spec)?;
        let mut links = resolve(spec, &names)?;
        let closures = spec.closures.iter().enumerate();
        let loops = closures.map(|(i, c)| resolve_closure(spec, &names, &links, i, c)).collect::<Result<_, _>>()?;
        let end = spec.end_effector.as_ref().ok_or(MachineError::NoEndEffector)?;
        let (end_link, s) = locate(spec, &names, end, &|| KeyPath::new(&[&"end_effector"]))?;
        let end_effector = end_effector(spec, &links, end_link, s)?;
        let angles = resolve_angles(spec, &names)?;
        let motors = resolve_motors(spec, &names)?;
        add_pins(spec, &names, &mut links)?;
        let bodies = bodies(spec, &names)?;
        Ok(Self { links, bodies, end_effector, end_link, angles, loops, motors })
    }
}

pub(super) struct Names<'a> {
    drives: Vec<&'a str>,
    links: Vec<&'a str>,
}

impl<'a> Names<'a> {
    pub fn of(spec: &'a MachineSpec) -> Result<Self, MachineError> {
        printable(&spec.name, || KeyPath::new(&[&"name"]))?;
        printable(&spec.summary, || KeyPath::new(&[&"summary"]))?;
        spec.lengths.keys().try_for_each(|name| printable(name, || KeyPath::new(&[&"lengths"])))?;
        let drives = unique("drive", spec.drives.iter().map(|d| d.name.as_str()))?;
        let links = unique("link", spec.links.iter().map(|l| l.name.as_str()))?;
        let named = |what: &'static str, names: Vec<&str>| {
            let mut all = names.into_iter().enumerate();
            all.try_for_each(|(i, name)| printable(name, || KeyPath::new(&[&what, &i, &"name"])))
        };
        named("material", spec.materials.iter().map(|material| material.name.as_str()).collect())?;
        named("part", spec.parts.iter().map(|part| part.name.as_str()).collect())?;
        named("lump", spec.lumps.iter().map(|lump| lump.name.as_str()).collect())?;
        unique("angle", spec.angles.iter().map(|a| a.name.as_str()))?;
        Ok(Self { drives, links })
    }

    /// Returns the drive whose orientation a link has, or the number of drives for one that keeps its orientation.
    fn link_drive(&self, name: &str, place: impl Fn() -> KeyPath) -> Result<usize, MachineError> {
        match name == GROUND && !self.drives.contains(&name) {
            true if self.drives.len() < MAX_DRIVES => Ok(self.drives.len()),
            true => {
                let want = format!("at most {} beside links with drive = \"{GROUND}\"", MAX_DRIVES - 1);
                Err(MachineError::Count { what: "drives", count: self.drives.len(), want })
            }
            false => self.drive(name, place),
        }
    }

    fn drive(&self, name: &str, place: impl Fn() -> KeyPath) -> Result<usize, MachineError> {
        look_up("drive", &self.drives, name, place)
    }

    pub fn link(&self, name: &str, place: impl Fn() -> KeyPath) -> Result<usize, MachineError> {
        look_up("link", &self.links, name, place)
    }
}

fn unique<'a>(what: &'static str, names: impl Iterator<Item = &'a str>) -> Result<Vec<&'a str>, MachineError> {
    let mut seen: Vec<&str> = Vec::new();
    for (i, name) in names.enumerate() {
        printable(name, || KeyPath::new(&[&what, &i, &"name"]))?;
        if seen.contains(&name) {
            return Err(MachineError::Duplicate { place: KeyPath::new(&[&what, &i, &"name"]), name: name.into() });
        }
        seen.push(name);
    }
    Ok(seen)
}

/// Checks that a text has no character that controls a terminal or reverses the order of letters.
fn printable(text: &str, place: impl Fn() -> KeyPath) -> Result<(), MachineError> {
    let refused = |character| Err(MachineError::Unprintable { place: place(), character });
    control_character(text).map_or(Ok(()), refused)
}

fn look_up(what: &'static str, names: &[&str], name: &str, place: impl Fn() -> KeyPath) -> Result<usize, MachineError> {
    names.iter().position(|n| *n == name).ok_or_else(|| MachineError::Unknown {
        place: place(),
        what,
        name: name.into(),
        known: names.iter().map(|name| (*name).into()).collect(),
        more: "".into(),
    })
}

/// Returns the length of link i, m.
fn length_of(spec: &MachineSpec, i: usize) -> Result<f64, MachineError> {
    let place = || KeyPath::new(&[&"link", &i, &"length"]);
    match &spec.links[i].length {
        Length::Metres(l) => within(LENGTH, *l, place).map(|()| *l),
        Length::Named(name) => named_length(spec, name, place, LENGTHS),
    }
}

fn named_length(
    spec: &MachineSpec,
    name: &str,
    place: impl Fn() -> KeyPath,
    more: &'static str,
) -> Result<f64, MachineError> {
    spec.lengths.get(name).copied().ok_or_else(|| MachineError::Unknown {
        place: place(),
        what: "length",
        name: name.into(),
        known: spec.lengths.keys().cloned().collect(),
        more: more.into(),
    })
}

/// What states a length, and what a place along a link, besides a named length.
const LENGTHS: &str = ", or a number in m";
const PLACES: &str = ", \"tip\", \"root\", or a number in m";

/// Resolves a point of a link: the index of the link, and the distance from its root, m.
fn locate(
    spec: &MachineSpec,
    names: &Names,
    point: &LinkPoint,
    place: &dyn Fn() -> KeyPath,
) -> Result<(usize, f64), MachineError> {
    let under = |key: &str| {
        let mut p = place();
        p.0.push(KeyStep::Key(key.into()));
        p
    };
    let link = names.link(&point.link, || under("link"))?;
    Ok((link, place_on_link(spec, link, &point.at, || under("at"))?))
}

/// Returns the distance of a place on a link, counted from 0, from the link's root, m.
pub(super) fn place_on_link(
    spec: &MachineSpec,
    link: usize,
    at: &PlaceOnLink,
    place: impl Fn() -> KeyPath,
) -> Result<f64, MachineError> {
    match at {
        PlaceOnLink::Metres(s) => within(PLACE, *s, place).map(|()| *s),
        PlaceOnLink::Named(name) => match name.as_str() {
            "tip" => length_of(spec, link),
            "root" => Ok(0.0),
            name => match name.strip_prefix('-') {
                Some(name) => Ok(-named_length(spec, name, place, PLACES)?),
                None => named_length(spec, name, place, PLACES),
            },
        },
    }
}

fn resolve(spec: &MachineSpec, names: &Names) -> Result<Vec<ResolvedLink>, MachineError> {
    let mut parents = Vec::with_capacity(spec.links.len());
    for (i, link) in spec.links.iter().enumerate() {
        let place = || KeyPath::new(&[&"link", &i, &"attach"]);
        parents.push(match &link.attach {
            Attach::Base(word) if word == "base" => None,
            Attach::Base(word) => {
                let (known, more) = (vec!["base".into()], ", or { link = \"…\", at = \"tip\" }");
                let name = word.clone();
                return Err(MachineError::Unknown {
                    place: place(),
                    what: "attachment",
                    name,
                    known,
                    more: more.into(),
                });
            }
            Attach::On(point) => Some(locate(spec, names, point, &place)?),
        });
    }
    let mut parts = Vec::with_capacity(spec.links.len());
    for (i, link) in spec.links.iter().enumerate() {
        // Walks from the link to the base; a walk longer than the number of links runs in a cycle.
        let (mut root, mut at, mut chain) = ([0.0; MAX_DRIVES], i, vec![spec.links[i].name.as_str()]);
        while let Some((parent, s)) = parents[at] {
            chain.push(&spec.links[parent].name);
            if chain.len() > spec.links.len() {
                return Err(MachineError::Cycle {
                    place: KeyPath::new(&[&"link", &i, &"attach"]),
                    link: quote_clipped(&link.name),
                    chain: shortened(&chain.join(" on "), 200),
                });
            }
            let on = &spec.links[parent];
            let drive = names.link_drive(&on.drive, || KeyPath::new(&[&"link", &parent, &"drive"]))?;
            root[drive] += f64::from(on.direction) * s;
            at = parent;
        }
        if chain.len() > MAX_CHAIN_LINKS {
            let (what, want) = ("links in a row, each on the one before", format!("at most {MAX_CHAIN_LINKS}"));
            return Err(MachineError::Count { what, count: chain.len(), want });
        }
        parts.push(ResolvedLink {
            drive: names.link_drive(&link.drive, || KeyPath::new(&[&"link", &i, &"drive"]))?,
            sign: f64::from(link.direction),
            length: length_of(spec, i)?,
            root,
            parent: parents[i].map(|(p, _)| p),
            at: parents[i].map_or(0.0, |(_, s)| s),
            pins: Vec::new(),
        });
    }
    Ok(parts)
}

/// Returns the end effector, which has to be a point that turns about B, on a link that follows a drive.
fn end_effector(spec: &MachineSpec, links: &[ResolvedLink], end: usize, s: f64) -> Result<Chain, MachineError> {
    let (mut at, ground, link) = (links[end].point(s), spec.drives.len(), quote_clipped(&spec.links[end].name));
    if ground < MAX_DRIVES {
        let why = match at[ground].abs() > CLOSURE_TOLERANCE {
            _ if links[end].drive == ground => format!(
                "link {link} keeps its orientation: want the point of the link that carries it; what else it holds is a \
                 part of its own mass"
            ),
            true => format!(
                "it is {} m along x beside where the links from the base pin alone would take it: want a point of links \
                 that are not carried by a link with drive = \"{GROUND}\"",
                ShortNumber(at[ground])
            ),
            false => String::new(),
        };
        if !why.is_empty() {
            return Err(MachineError::Part { place: KeyPath::new(&[&"end_effector"]), why });
        }
        at[ground] = 0.0;
    }
    Ok(at)
}

fn resolve_closure(
    spec: &MachineSpec,
    names: &Names,
    parts: &[ResolvedLink],
    i: usize,
    closure: &Closure,
) -> Result<ResolvedClosure, MachineError> {
    let (a, s) = locate(spec, names, &closure.a, &|| KeyPath::new(&[&"closure", &i, &"a"]))?;
    let (b, t) = locate(spec, names, &closure.b, &|| KeyPath::new(&[&"closure", &i, &"b"]))?;
    let (p, r) = (parts[a].point(s), parts[b].point(t));
    let along = |k: usize| match spec.drives.get(k) {
        Some(drive) => format!("along drive {}", quote_clipped(&drive.name)),
        None => "along x of the base".to_owned(),
    };
    let gap: Vec<String> = (0..MAX_DRIVES)
        .filter(|&k| (p[k] - r[k]).abs() > CLOSURE_TOLERANCE)
        .map(|k| format!("{:.6} m {}", p[k] - r[k], along(k)))
        .collect();
    if gap.is_empty() {
        return Ok(ResolvedClosure { a, at_a: s, b, at_b: t });
    }
    let say = |point: &LinkPoint| match &point.at {
        PlaceOnLink::Metres(s) => format!("{} m of link {}", ShortNumber(*s), quote_clipped(&point.link)),
        PlaceOnLink::Named(name) => format!("{} of link {}", quote_clipped(name), quote_clipped(&point.link)),
    };
    Err(MachineError::OpenLoop {
        place: KeyPath::new(&[&"closure", &i]),
        a: say(&closure.a),
        b: say(&closure.b),
        gap: gap.join(" and "),
    })
}

fn resolve_angles(spec: &MachineSpec, names: &Names) -> Result<Vec<RelativeAngle>, MachineError> {
    let angle = |(i, a): (usize, &Angle)| {
        Ok(RelativeAngle {
            name: a.name.clone(),
            to: names.drive(&a.to, || KeyPath::new(&[&"angle", &i, &"to"]))?,
            from: names.drive(&a.from, || KeyPath::new(&[&"angle", &i, &"from"]))?,
            offset: a.offset,
            limits: a.min.unwrap_or(f64::NEG_INFINITY)..=a.max.unwrap_or(f64::INFINITY),
        })
    };
    spec.angles.iter().enumerate().map(angle).collect()
}

/// Returns each link combined with the counterweights that it carries.
fn bodies(spec: &MachineSpec, names: &Names) -> Result<Vec<Link>, MachineError> {
    let mut bodies = spec.links.clone();
    for (i, weight) in spec.counterweights.iter().enumerate() {
        let j = names.link(&weight.link, || KeyPath::new(&[&"counterweight", &i, &"link"]))?;
        bodies[j] = bodies[j].with(weight);
    }
    Ok(bodies)
}

/// Looks up the drive that carries each motor. A cycle, in which a walk towards the base meets a drive again, is an
/// error.
fn resolve_motors(spec: &MachineSpec, names: &Names) -> Result<Motors, MachineError> {
    let mut on = Vec::with_capacity(spec.drives.len());
    for (i, drive) in spec.drives.iter().enumerate() {
        let place = || KeyPath::new(&[&"drive", &i, &"on"]);
        on.push(drive.on.as_ref().map(|name| names.drive(name, place)).transpose()?);
    }
    for (i, drive) in spec.drives.iter().enumerate() {
        let (mut at, mut chain) = (i, vec![drive.name.as_str()]);
        while let Some(next) = on[at] {
            let met = chain.contains(&spec.drives[next].name.as_str());
            chain.push(&spec.drives[next].name);
            if met {
                return Err(MachineError::StatorCycle {
                    place: KeyPath::new(&[&"drive", &i, &"on"]),
                    drive: quote_clipped(&drive.name),
                    chain: shortened(&chain.join(" on "), 200),
                });
            }
            at = next;
        }
    }
    Ok(Motors::new(&on))
}

/// Collects the positions of the pins along each link, in ascending order.
fn add_pins(spec: &MachineSpec, names: &Names, parts: &mut [ResolvedLink]) -> Result<(), MachineError> {
    let nowhere = || KeyPath::default();
    for part in parts.iter_mut() {
        part.pins.push(0.0);
    }
    for link in &spec.links {
        if let Attach::On(point) = &link.attach {
            let (j, s) = locate(spec, names, point, &nowhere)?;
            parts[j].pins.push(s);
        }
    }
    for point in spec.closures.iter().flat_map(|c| [&c.a, &c.b]) {
        let (j, s) = locate(spec, names, point, &nowhere)?;
        parts[j].pins.push(s);
    }
    for part in parts.iter_mut() {
        part.pins.sort_by(f64::total_cmp);
        part.pins.dedup();
    }
    Ok(())
}
