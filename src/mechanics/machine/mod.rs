//! Machines: coaxial drives at B, links that each keep the orientation of one drive, pins that close parallelograms.
//!
//! A [`MachineSpec`] is what a file says; a [`Machine`] is one that has been checked, so every machine is valid:
//! finite, positive masses, no cycles, every loop closed in every pose. To change a machine, change its spec
//! ([`Machine::set`]) and it is checked again.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | q_k | absolute angle of drive k, e(q) = (cos q, sin q) | rad |
//! | r_j | a point of link j, Σ_k w_k e(q_k): its [`Chain`] w | m |
//! | l_cj | CM of link j along the link, from its root | m |

mod catalog;
mod error;
mod file;
mod inertia;
mod set;
mod spec;

use std::ops::RangeInclusive;

pub use catalog::{builtin, builtins, find};
pub use error::{MachineError, Place, Step};
pub use file::{FileError, parse, read, to_toml};
pub(crate) use file::{line_of, line_of_place};
pub use inertia::{BALANCED, Inertia};
pub use spec::{Angle, Attach, Closure, Drive, Length, Link, MachineSpec, Payload, Point, Station};

use crate::mechanics::planar::{MAX_DRIVES, Units, Vector};
use crate::settings::range::{Range, Short, Want, clipped, shortened};

/// A point as a sum of unit vectors: weight w_k, m, on e(q_k).
pub type Chain = [f64; MAX_DRIVES];

/// The largest number of a machine, in SI units: beyond it, products of them would not be finite.
const MOST: f64 = 1e6;
/// The least of those that nothing works without: below it, quotients would not be.
const LEAST: f64 = 1e-9;

const GRAVITY: Range = Range::either_way(MOST, "m/s²");
const LENGTH: Range = Range::new(1e-6, MOST, "m");
const PLACE: Range = Range::either_way(MOST, "m");
/// Links may be all but without mass.
const MASS: Range = Range::new(1e-15, MOST, "kg");
const LOAD: Range = Range::new(0.0, MOST, "kg");
const INERTIA: Range = Range::new(0.0, MOST, "kg m²");
const TORQUE_LIMIT: Range = Range::new(LEAST, MOST, "N m");
const SPEED_LIMIT: Range = Range::new(LEAST, MOST, "rad/s");
const ACCELERATION_LIMIT: Range = Range::new(LEAST, MOST, "rad/s²");
const JERK_LIMIT: Range = Range::new(LEAST, 1e9, "rad/s³");

/// The largest joint limit either way, rad: each further turn is one more winding of the same workspace.
pub const MAX_ANGLE: f64 = 25.2;
const ANGLE: Range = Range::either_way(MAX_ANGLE, "rad, four turns");

/// How far, m, the two points of a closure may lie apart.
pub const CLOSURE_TOLERANCE: f64 = 1e-9;

/// A valid machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Machine {
    spec: MachineSpec,
    parts: Vec<Part>,
    tip: Chain,
    tip_link: usize,
    angles: Vec<RelativeAngle>,
    loops: Vec<Loop>,
}

/// What is derived of a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The drive whose orientation it has, counted from 0.
    pub drive: usize,
    /// ±1: along or against e(q).
    pub sign: f64,
    /// Root to tip, m.
    pub length: f64,
    /// Its root.
    pub root: Chain,
    /// The link its root is pinned to; none: the base.
    pub parent: Option<usize>,
    /// How far from the root of that link, m; 0 on the base.
    pub at: f64,
    /// Where pins sit along it, m from the root, in rising order and without repetition.
    pub pins: Vec<f64>,
}

/// A relative joint angle, resolved: a = q_to − q_from + offset.
#[derive(Clone, Debug, PartialEq)]
pub struct RelativeAngle {
    /// Its name.
    pub name: String,
    /// Drive, counted from 0.
    pub to: usize,
    /// Drive, counted from 0.
    pub from: usize,
    /// rad.
    pub offset: f64,
    /// rad.
    pub limits: RangeInclusive<f64>,
}

/// A closure, resolved: a point of link `a` is pinned to a point of link `b`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loop {
    /// A link.
    pub a: usize,
    /// Where on it, m from its root.
    pub at_a: f64,
    /// Another link.
    pub b: usize,
    /// Where on that, m from its root.
    pub at_b: f64,
}

impl Part {
    /// The point `s` metres from the root.
    pub fn point(&self, s: f64) -> Chain {
        let mut c = self.root;
        c[self.drive] += self.sign * s;
        c
    }
}

impl Machine {
    /// Checks a description.
    ///
    /// # Errors
    /// The first thing that is wrong, and what would be right.
    pub fn new(spec: MachineSpec) -> Result<Self, MachineError> {
        let names = Names::of(&spec)?;
        check_numbers(&spec)?;
        let mut parts = resolve(&spec, &names)?;
        let closures = spec.closures.iter().enumerate();
        let loops = closures.map(|(i, c)| resolve_closure(&spec, &names, &parts, i, c)).collect::<Result<_, _>>()?;
        let end = spec.end_effector.as_ref().ok_or(MachineError::NoEndEffector)?;
        let (tip_link, s) = locate(&spec, &names, end, &|| Place::new(&[&"end_effector"]))?;
        let tip = parts[tip_link].point(s);
        let angles = resolve_angles(&spec, &names)?;
        add_pins(&spec, &names, &mut parts)?;
        let machine = Self { spec, parts, tip, tip_link, angles, loops };
        machine.check_inertia()?;
        Ok(machine)
    }

    /// What it was made of.
    pub fn spec(&self) -> &MachineSpec {
        &self.spec
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.spec.name
    }

    /// Number of drives n.
    pub fn drives(&self) -> usize {
        self.spec.drives.len()
    }

    /// Its links as described.
    pub fn links(&self) -> &[Link] {
        &self.spec.links
    }

    /// Its links as resolved, in the same order.
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// The end effector as a sum of unit vectors, (14).
    pub fn tip(&self) -> &Chain {
        &self.tip
    }

    /// The link that carries the end effector.
    pub fn tip_link(&self) -> usize {
        self.tip_link
    }

    /// Relative joint angles and their limits.
    pub fn angles(&self) -> &[RelativeAngle] {
        &self.angles
    }

    /// Its closures as resolved, in the order of the file.
    pub fn loops(&self) -> &[Loop] {
        &self.loops
    }

    /// Acceleration of gravity, m/s².
    pub fn gravity(&self) -> Vector {
        Vector::new(self.spec.gravity[0], self.spec.gravity[1])
    }

    /// Total mass with payload, kg.
    pub fn mass(&self) -> f64 {
        self.spec.links.iter().map(|l| l.mass).sum::<f64>() + self.spec.payload.mass
    }

    /// The CM of link j as Σ_k a_jk e(q_k), complex where the CM lies off the link's axis.
    pub fn com_chain(&self, j: usize) -> [Vector; MAX_DRIVES] {
        let (link, part) = (&self.spec.links[j], &self.parts[j]);
        let mut a = part.root.map(|w| Vector::new(w, 0.0));
        a[part.drive] += part.sign * Vector::new(link.com, link.com_normal);
        a
    }

    /// For every pin that closes a loop, how its one description differs from the other: a sum of unit vectors that is
    /// zero in every pose.
    pub fn closure_gaps(&self) -> Vec<Chain> {
        let gap = |l: &Loop| {
            let (a, b) = (self.parts[l.a].point(l.at_a), self.parts[l.b].point(l.at_b));
            std::array::from_fn(|k| a[k] - b[k])
        };
        self.loops.iter().map(gap).collect()
    }

    /// The centre of mass of the payload as a sum of unit vectors, complex where it lies off the link's axis.
    pub fn payload_chain(&self) -> [Vector; MAX_DRIVES] {
        let (part, [along, left]) = (&self.parts[self.tip_link], self.spec.payload.offset);
        let mut a = self.tip.map(|w| Vector::new(w, 0.0));
        a[part.drive] += part.sign * Vector::new(along, left);
        a
    }

    fn check_inertia(&self) -> Result<(), MachineError> {
        let inertia = Inertia::of(self);
        match (0..self.drives()).find(|&k| inertia.diagonal(k).partial_cmp(&0.0) != Some(std::cmp::Ordering::Greater)) {
            Some(k) => Err(MachineError::Massless { drive: self.spec.drives[k].name.clone() }),
            None => Ok(()),
        }
    }
}

/// Where a chain of weights puts its point, m.
pub fn place_of(chain: &Chain, e: &Units) -> Vector {
    chain.iter().zip(e).map(|(w, e)| e * *w).sum()
}

struct Names<'a> {
    drives: Vec<&'a str>,
    links: Vec<&'a str>,
}

impl<'a> Names<'a> {
    fn of(spec: &'a MachineSpec) -> Result<Self, MachineError> {
        let n = spec.drives.len();
        if n == 0 || n > MAX_DRIVES {
            return Err(MachineError::Count { what: "drives", count: n, want: format!("1 to {MAX_DRIVES}") });
        }
        if spec.links.is_empty() {
            return Err(MachineError::Count { what: "links", count: 0, want: "at least one".into() });
        }
        let drives = unique("drive", spec.drives.iter().map(|d| d.name.as_str()))?;
        let links = unique("link", spec.links.iter().map(|l| l.name.as_str()))?;
        unique("angle", spec.angles.iter().map(|a| a.name.as_str()))?;
        Ok(Self { drives, links })
    }

    fn drive(&self, name: &str, place: impl Fn() -> Place) -> Result<usize, MachineError> {
        look_up("drive", &self.drives, name, place)
    }

    fn link(&self, name: &str, place: impl Fn() -> Place) -> Result<usize, MachineError> {
        look_up("link", &self.links, name, place)
    }
}

fn unique<'a>(what: &'static str, names: impl Iterator<Item = &'a str>) -> Result<Vec<&'a str>, MachineError> {
    let mut seen: Vec<&str> = Vec::new();
    for (i, name) in names.enumerate() {
        if seen.contains(&name) {
            return Err(MachineError::Duplicate { place: Place::new(&[&what, &i, &"name"]), name: name.into() });
        }
        seen.push(name);
    }
    Ok(seen)
}

fn look_up(what: &'static str, names: &[&str], name: &str, place: impl Fn() -> Place) -> Result<usize, MachineError> {
    names.iter().position(|n| *n == name).ok_or_else(|| MachineError::Unknown {
        place: place(),
        what,
        name: name.into(),
        known: quoted(names.iter().copied()),
    })
}

fn quoted<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let mut known: Vec<String> = names.take(21).map(|n| format!("{:?}", clipped(n))).collect();
    if known.len() > 20 {
        known[20] = "…".into();
    }
    known.join(", ")
}

fn check_numbers(spec: &MachineSpec) -> Result<(), MachineError> {
    for (i, &value) in spec.gravity.iter().enumerate() {
        within(GRAVITY, value, || Place::new(&[&"gravity", &i]))?;
    }
    for (name, &value) in &spec.lengths {
        within(LENGTH, value, || Place::new(&[&"lengths", name]))?;
    }
    let Payload { mass, inertia, offset, axial } = spec.payload;
    within(LOAD, mass, || Place::new(&[&"payload", &"mass"]))?;
    within(INERTIA, inertia, || Place::new(&[&"payload", &"inertia"]))?;
    within(PLACE, axial, || Place::new(&[&"payload", &"axial"]))?;
    for (i, &value) in offset.iter().enumerate() {
        within(PLACE, value, || Place::new(&[&"payload", &"offset", &i]))?;
    }
    for (i, drive) in spec.drives.iter().enumerate() {
        for (key, value, range) in [
            ("torque_limit", drive.torque_limit, TORQUE_LIMIT),
            ("speed_limit", drive.speed_limit, SPEED_LIMIT),
            ("acceleration_limit", drive.acceleration_limit, ACCELERATION_LIMIT),
            ("jerk_limit", drive.jerk_limit, JERK_LIMIT),
        ] {
            value.map_or(Ok(()), |value| within(range, value, || Place::new(&[&"drive", &i, &key])))?;
        }
    }
    for (i, link) in spec.links.iter().enumerate() {
        for (key, value, range) in [
            ("mass", link.mass, MASS),
            ("inertia", link.inertia, INERTIA),
            ("com", link.com, PLACE),
            ("com_normal", link.com_normal, PLACE),
            ("axial", link.axial, PLACE),
        ] {
            within(range, value, || Place::new(&[&"link", &i, &key]))?;
        }
        if !matches!(link.direction, -1 | 1) {
            let place = Place::new(&[&"link", &i, &"direction"]);
            return Err(MachineError::OutOfRange { place, value: link.direction.into(), want: Want::Words("1 or -1") });
        }
    }
    for (i, angle) in spec.angles.iter().enumerate() {
        for (key, value) in [("offset", angle.offset), ("min", angle.min), ("max", angle.max)] {
            within(ANGLE, value, || Place::new(&[&"angle", &i, &key]))?;
        }
        if angle.min > angle.max {
            let place = Place::new(&[&"angle", &i, &"max"]);
            return Err(MachineError::OutOfRange {
                place,
                value: angle.max,
                want: Want::Words("a limit not below min"),
            });
        }
    }
    Ok(())
}

/// Refuses a number that is none, or out of the range of its key.
fn within(range: Range, value: f64, place: impl Fn() -> Place) -> Result<(), MachineError> {
    match value.is_finite() {
        true if range.contains(value) => Ok(()),
        true => Err(MachineError::OutOfRange { place: place(), value, want: Want::Within(range) }),
        false => Err(MachineError::NotFinite { place: place(), value, unit: range.unit() }),
    }
}

/// Length of a link, m.
fn length_of(spec: &MachineSpec, i: usize) -> Result<f64, MachineError> {
    let place = || Place::new(&[&"link", &i, &"length"]);
    match &spec.links[i].length {
        Length::Metres(l) => within(LENGTH, *l, place).map(|()| *l),
        Length::Named(name) => named_length(spec, name, place),
    }
}

fn named_length(spec: &MachineSpec, name: &str, place: impl Fn() -> Place) -> Result<f64, MachineError> {
    spec.lengths.get(name).copied().ok_or_else(|| MachineError::Unknown {
        place: place(),
        what: "length",
        name: name.into(),
        known: quoted(spec.lengths.keys().map(String::as_str)),
    })
}

/// A point of a link: which link, and how far from its root, m.
fn locate(
    spec: &MachineSpec,
    names: &Names,
    point: &Point,
    place: &dyn Fn() -> Place,
) -> Result<(usize, f64), MachineError> {
    let under = |key: &str| {
        let mut p = place();
        p.0.push(Step::Key(key.into()));
        p
    };
    let link = names.link(&point.link, || under("link"))?;
    let s = match &point.at {
        Station::Metres(s) => within(PLACE, *s, || under("at")).map(|()| *s)?,
        Station::Named(name) => match name.as_str() {
            "tip" => length_of(spec, link)?,
            "root" => 0.0,
            name => match name.strip_prefix('-') {
                Some(name) => -named_length(spec, name, || under("at"))?,
                None => named_length(spec, name, || under("at"))?,
            },
        },
    };
    Ok((link, s))
}

fn resolve(spec: &MachineSpec, names: &Names) -> Result<Vec<Part>, MachineError> {
    let mut parents = Vec::with_capacity(spec.links.len());
    for (i, link) in spec.links.iter().enumerate() {
        let place = || Place::new(&[&"link", &i, &"attach"]);
        parents.push(match &link.attach {
            Attach::Base(word) if word == "base" => None,
            Attach::Base(word) => {
                let known = "\"base\", or { link = \"…\", at = \"tip\" }".into();
                return Err(MachineError::Unknown { place: place(), what: "attachment", name: word.clone(), known });
            }
            Attach::On(point) => Some(locate(spec, names, point, &place)?),
        });
    }
    let mut parts = Vec::with_capacity(spec.links.len());
    for (i, link) in spec.links.iter().enumerate() {
        // Walk from the link to the base; a walk longer than the number of links runs in a circle.
        let (mut root, mut at, mut chain) = ([0.0; MAX_DRIVES], i, vec![spec.links[i].name.as_str()]);
        while let Some((parent, s)) = parents[at] {
            chain.push(&spec.links[parent].name);
            if chain.len() > spec.links.len() {
                return Err(MachineError::Cycle {
                    place: Place::new(&[&"link", &i, &"attach"]),
                    link: clipped(&link.name),
                    chain: shortened(&chain.join(" on "), 200),
                });
            }
            let on = &spec.links[parent];
            let drive = names.drive(&on.drive, || Place::new(&[&"link", &parent, &"drive"]))?;
            root[drive] += f64::from(on.direction) * s;
            at = parent;
        }
        parts.push(Part {
            drive: names.drive(&link.drive, || Place::new(&[&"link", &i, &"drive"]))?,
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

fn resolve_closure(
    spec: &MachineSpec,
    names: &Names,
    parts: &[Part],
    i: usize,
    closure: &Closure,
) -> Result<Loop, MachineError> {
    let (a, s) = locate(spec, names, &closure.a, &|| Place::new(&[&"closure", &i, &"a"]))?;
    let (b, t) = locate(spec, names, &closure.b, &|| Place::new(&[&"closure", &i, &"b"]))?;
    let (p, r) = (parts[a].point(s), parts[b].point(t));
    let gap: Vec<String> = (0..spec.drives.len())
        .filter(|&k| (p[k] - r[k]).abs() > CLOSURE_TOLERANCE)
        .map(|k| format!("{:.6} m along drive {}", p[k] - r[k], clipped(&spec.drives[k].name)))
        .collect();
    if gap.is_empty() {
        return Ok(Loop { a, at_a: s, b, at_b: t });
    }
    let say = |point: &Point| match &point.at {
        Station::Metres(s) => format!("{} m of link {}", Short(*s), clipped(&point.link)),
        Station::Named(name) => format!("{} of link {}", clipped(name), clipped(&point.link)),
    };
    Err(MachineError::OpenLoop {
        place: Place::new(&[&"closure", &i]),
        a: say(&closure.a),
        b: say(&closure.b),
        gap: gap.join(" and "),
    })
}

fn resolve_angles(spec: &MachineSpec, names: &Names) -> Result<Vec<RelativeAngle>, MachineError> {
    let angle = |(i, a): (usize, &Angle)| {
        Ok(RelativeAngle {
            name: a.name.clone(),
            to: names.drive(&a.to, || Place::new(&[&"angle", &i, &"to"]))?,
            from: names.drive(&a.from, || Place::new(&[&"angle", &i, &"from"]))?,
            offset: a.offset,
            limits: a.min..=a.max,
        })
    };
    spec.angles.iter().enumerate().map(angle).collect()
}

/// Collects where other links are pinned to each link, so that it can be drawn as long as it must be.
fn add_pins(spec: &MachineSpec, names: &Names, parts: &mut [Part]) -> Result<(), MachineError> {
    let nowhere = || Place::default();
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
