//! [`weigh`]: what every part brings, and the numbers of links that follow.

use super::super::check::{Names, place_on_link};
use super::super::error::{KeyPath, KeyStep, MachineError};
use super::super::keys::rows_of;
use super::super::model::Machine;
use super::super::ranges::{LENGTH, PLACE, within};
use super::super::spec::MachineSpec;
use super::body::PlaneBody;
use super::hole::{self, PlacedHole};
use super::part::{Hole, Lump, Part};
use super::section::Section;
use super::{derived, material};

/// A part or a lump as a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartBody {
    /// The link that it belongs to, counted from 0.
    pub link: usize,
    /// The part or the lump.
    pub source: PartSource,
    /// Its mass, centre of mass and inertia.
    pub body: PlaneBody,
    /// Where a bar begins and ends along the link, m from the root; the place of a lump twice.
    pub ends: [f64; 2],
}

/// A part or a lump of a machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartSource {
    /// A part, counted from 0.
    Part(usize),
    /// A lump, counted from 0.
    Lump(usize),
}

impl PartBody {
    /// Returns its name, or else what it is.
    pub fn title(&self, spec: &MachineSpec) -> String {
        match self.source {
            PartSource::Part(i) => spec.parts[i].title(),
            PartSource::Lump(i) => spec.lumps[i].title(),
        }
    }
}

/// Sets the numbers of links that follow from their parts; returns every part and lump as a body, parts first.
pub fn weigh(spec: &mut MachineSpec) -> Result<Vec<PartBody>, MachineError> {
    let bodies = if spec.parts.is_empty() && spec.lumps.is_empty() && spec.materials.is_empty() {
        Vec::new()
    } else {
        bodies(spec)?
    };
    let links = if bodies.is_empty() { 0 } else { spec.links.len() };
    let sums: Vec<Option<PlaneBody>> = (0..links).map(|link| sum_of(&bodies, link)).collect();
    derived::settle(spec, &sums)?;
    Ok(bodies)
}

impl Machine {
    /// Returns a lump, counted from 0, and what it brings; `None` for one that does not exist.
    pub fn lump_body(&self, lump: usize) -> Option<(&Lump, &PartBody)> {
        let body = self.part_bodies().iter().find(|body| body.source == PartSource::Lump(lump))?;
        Some((self.spec().lumps.get(lump)?, body))
    }

    /// Returns the centre of each hole of a part, m along the link from its root and to the left of the part's line,
    /// and its diameter, m.
    pub fn part_holes(&self, part: usize) -> Vec<([f64; 2], f64)> {
        let spec = self.spec();
        let Some(part) = spec.parts.get(part) else { return Vec::new() };
        let Some(link) = spec.link_index(&part.link) else { return Vec::new() };
        let place = |hole: &Hole| {
            let at = place_on_link(spec, link, &hole.at, KeyPath::default).ok()?;
            Some(([at, hole.across], hole.diameter))
        };
        part.holes.iter().filter_map(place).collect()
    }
}

/// Returns all parts of a link combined; `None` if it has none.
pub fn sum_of(bodies: &[PartBody], link: usize) -> Option<PlaneBody> {
    bodies.iter().filter(|part| part.link == link).map(|part| part.body).reduce(PlaneBody::and)
}

fn bodies(spec: &MachineSpec) -> Result<Vec<PartBody>, MachineError> {
    for (kind, count) in [("material", spec.materials.len()), ("part", spec.parts.len()), ("lump", spec.lumps.len())] {
        let rows = rows_of(kind);
        (0..count).try_for_each(|i| rows.iter().try_for_each(|row| row.check(spec, i)))?;
    }
    for (name, &value) in &spec.lengths {
        within(LENGTH, value, || KeyPath::new(&[&"lengths", name]))?;
    }
    material::check(spec)?;
    let names = Names::of(spec)?;
    let parts = spec.parts.iter().enumerate().map(|(i, part)| part_body(spec, &names, i, part));
    let lumps = spec.lumps.iter().enumerate().map(|(i, lump)| {
        let place = |key: &str| KeyPath::new(&[&"lump", &i, &key]);
        let link = names.link(&lump.link, || place("link"))?;
        let at = place_on_link(spec, link, &lump.at, || place("at"))?;
        let body = PlaneBody { mass: lump.mass, at, across: lump.across, inertia: lump.inertia };
        Ok(PartBody { link, source: PartSource::Lump(i), body, ends: [at; 2] })
    });
    parts.chain(lumps).collect()
}

fn part_body(spec: &MachineSpec, names: &Names, i: usize, part: &Part) -> Result<PartBody, MachineError> {
    let place = |key: &str| KeyPath::new(&[&"part", &i, &key]);
    let link = names.link(&part.link, || place("link"))?;
    let density = material::density(spec, &part.material, || place("material"))?;
    let [from, to] =
        [(&part.from, "from"), (&part.to, "to")].map(|(at, key)| place_on_link(spec, link, at, || place(key)));
    let ends = [from?, to?];
    let section = Section { part, from: ends[0], to: ends[1], place: &place };
    for (k, corner) in part.polygon.iter().enumerate() {
        corner.iter().try_for_each(|x| within(PLACE, *x, || KeyPath::new(&[&"part", &i, &"polygon", &k])))?;
    }
    let whole = section.body()?;
    let hole_place = |k: usize, key: Option<&str>| {
        let mut place = KeyPath::new(&[&"part", &i, &"holes", &k]);
        place.0.extend(key.map(|key| KeyStep::Key(key.into())));
        place
    };
    let mut holes = Vec::with_capacity(part.holes.len());
    for (k, hole) in part.holes.iter().enumerate() {
        within(LENGTH, hole.diameter, || hole_place(k, Some("diameter")))?;
        within(PLACE, hole.across, || hole_place(k, Some("across")))?;
        let at = place_on_link(spec, link, &hole.at, || hole_place(k, Some("at")))?;
        holes.push(PlacedHole { centre: [at, hole.across], diameter: hole.diameter });
    }
    hole::check(&section, &holes, &|k| hole_place(k, None))?;
    let thickness = part.thickness.unwrap_or_default();
    let body = holes.iter().fold(whole, |body, hole| body.without(hole.body(part.across).times(thickness)));
    Ok(PartBody { link, source: PartSource::Part(i), body: body.times(density), ends })
}
