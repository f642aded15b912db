//! Parts and lumps of bars: how they are set, follow pins, are weighed, and come from and go to a machine.

use super::drawing::{Bar, BarId, PinId, Place, Sketch};
use super::lengths::{Lengths, rounded};
use super::recount::{metres, place};
use super::refusal::SketchRefusal;
use crate::machine::{
    Attach, DerivedNumbers, Length, Link, Lump, MachineError, MachineSpec, Part, PartBody, PlaceOnLink, weigh,
};
use crate::planar::Vector;

use stillbase_settings::number::plain;

/// Distance along a bar below which a place is at a pin, m.
const AT_PIN: f64 = 1e-9;

fn place_plainly(place: &mut PlaceOnLink) {
    if let PlaceOnLink::Metres(x) = place {
        *x = plain(*x);
    }
}

impl Sketch {
    /// Returns whether a bar has parts or lumps, from which its numbers can follow.
    pub fn has_parts(&self, bar: &str) -> bool {
        self.parts.iter().any(|part| part.link == bar) || self.lumps.iter().any(|lump| lump.link == bar)
    }

    /// Returns the names of bars that parts, lumps and counterweights state.
    pub(super) fn links_mut(&mut self) -> impl Iterator<Item = &mut String> {
        let weights = self.counterweights.iter_mut().map(|weight| &mut weight.link);
        let parts = self.parts.iter_mut().map(|part| &mut part.link);
        weights.chain(parts).chain(self.lumps.iter_mut().map(|lump| &mut lump.link))
    }

    /// Returns every place of a part or a lump on a bar.
    fn places_mut(&mut self, bar: &str) -> impl Iterator<Item = &mut PlaceOnLink> {
        let parts = self.parts.iter_mut().filter(move |part| part.link == bar);
        let parts = parts.flat_map(|part| {
            [&mut part.from, &mut part.to].into_iter().chain(part.holes.iter_mut().map(|hole| &mut hole.at))
        });
        parts.chain(self.lumps.iter_mut().filter(move |lump| lump.link == bar).map(|lump| &mut lump.at))
    }

    /// Lets what lies at a pin follow the pin along its bar.
    pub(super) fn follow_pins(&mut self, before: &Self) {
        if self.parts.is_empty() && self.lumps.is_empty() {
            return;
        }
        for old in &before.bars {
            let Some(bar) = self.bar(old.id).filter(|bar| (bar.root, bar.tip) == (old.root, old.tip)) else { continue };
            let moved = |pin: PinId| (before.along(old, pin), self.along(bar, pin));
            let pins: Vec<(f64, f64)> = old.all_pins().filter(|pin| bar.has(*pin)).map(moved).collect();
            if pins.iter().all(|(was, is)| (was - is).abs() < AT_PIN) {
                continue;
            }
            let name = bar.name.clone();
            for place in self.places_mut(&name) {
                if let PlaceOnLink::Metres(x) = place
                    && let Some((was, is)) = pins.iter().find(|(was, _)| (was - *x).abs() < AT_PIN)
                    && (was - is).abs() >= AT_PIN
                {
                    *x = rounded(*is);
                }
            }
        }
    }

    /// Writes the numbers of parts and lumps as a person would: splitting and joining bars adds and subtracts lengths.
    pub(super) fn write_plainly(&mut self) {
        for part in &mut self.parts {
            let corners = part.polygon.iter_mut().flatten();
            let holes = part.holes.iter_mut().map(|hole| &mut hole.across);
            corners.chain(holes).chain([&mut part.across]).for_each(|x| *x = plain(*x));
            let places = part.holes.iter_mut().map(|hole| &mut hole.at).chain([&mut part.from, &mut part.to]);
            places.for_each(place_plainly);
        }
        for lump in &mut self.lumps {
            lump.across = plain(lump.across);
            place_plainly(&mut lump.at);
        }
    }

    /// Returns the drawing with other parts and lumps of a bar.
    pub(super) fn with_parts(&self, id: BarId, parts: &[Part], lumps: &[Lump]) -> Result<Self, SketchRefusal> {
        let name = self.known_bar(id)?.name.clone();
        let links = parts.iter().map(|part| &part.link).chain(lumps.iter().map(|lump| &lump.link));
        if let Some(other) = links.into_iter().find(|link| **link != name) {
            let what = format!("a part is on bar {other}");
            return Err(SketchRefusal::new(Place::Bar(id), what, format!("parts of bar {name}")));
        }
        let mut next = self.clone();
        let at = |is_own: &dyn Fn(usize) -> bool, count: usize| (0..count).find(|i| is_own(*i)).unwrap_or(count);
        let first = at(&|i| self.parts[i].link == name, self.parts.len());
        next.parts.retain(|part| part.link != name);
        let own = |part: &Part| if self.parts.contains(part) { part.clone() } else { part.clone().changed_by_hand() };
        next.parts.splice(first..first, parts.iter().map(own));
        let first = at(&|i| self.lumps[i].link == name, self.lumps.len());
        next.lumps.retain(|lump| lump.link != name);
        next.lumps.splice(first..first, lumps.iter().cloned());
        Ok(next)
    }

    /// Returns the lumps of a bar, in their order.
    pub fn lumps_of(&self, bar: &Bar) -> impl Iterator<Item = &Lump> {
        self.lumps.iter().filter(move |lump| lump.link == bar.name)
    }

    /// Returns where a lump of a bar is: along it, m from its root, and in the drawing, m.
    pub fn lump_at(&self, bar: &Bar, lump: &Lump) -> (f64, Vector) {
        let along = metres(&lump.at, self.length(bar));
        (along, self.at(bar.root) + self.direction(bar) * Vector::new(along, lump.across))
    }

    /// Returns the place along a bar as a lump or a hole states it: at a pin, it follows the pin.
    pub fn place_along(&self, bar: &Bar, along: f64) -> PlaceOnLink {
        place(along, self.length(bar))
    }

    /// Returns the drawing with a lump of a bar, counted from 1, changed or taken away, or with one more.
    pub(super) fn with_lump(
        &self,
        id: BarId,
        number: Option<usize>,
        lump: Option<&Lump>,
    ) -> Result<Self, SketchRefusal> {
        let bar = self.known_bar(id)?;
        let mut lumps: Vec<Lump> = self.lumps_of(bar).cloned().collect();
        let refused = |what: String| Err(SketchRefusal::new(Place::Bar(id), what, "a lump that the bar has"));
        match (number, lump) {
            (None, Some(lump)) => lumps.push(lump.clone()),
            (None, None) => return refused("no lump is named that goes".into()),
            (Some(n), lump) => {
                let Some(i) = n.checked_sub(1).filter(|i| *i < lumps.len()) else {
                    return refused(format!("bar {} has {} lumps, and no number {n}", bar.name, lumps.len()));
                };
                lumps.splice(i..=i, lump.cloned());
            }
        }
        let parts: Vec<Part> = self.parts.iter().filter(|part| part.link == bar.name).cloned().collect();
        self.with_parts(id, &parts, &lumps)
    }

    /// Returns every part and lump as a body on its bar.
    pub(super) fn part_bodies(&self) -> Result<Vec<PartBody>, MachineError> {
        let link = |bar: &Bar| Link {
            name: bar.name.clone(),
            drive: String::new(),
            attach: Attach::Base("base".into()),
            direction: 1,
            length: Length::Metres(rounded(self.length(bar))),
            mass: 1.0,
            inertia: 1.0,
            inertia_along: 0.0,
            inertia_across: None,
            com: 0.0,
            com_normal: 0.0,
            axial: 0.0,
            derived: DerivedNumbers::default(),
        };
        weigh(&mut MachineSpec {
            name: self.name.clone(),
            summary: String::new(),
            gravity: [0.0; 2],
            pose: None,
            lengths: std::collections::BTreeMap::new(),
            payload: self.payload,
            drives: Vec::new(),
            links: self.bars.iter().map(link).collect(),
            materials: self.materials.clone(),
            parts: self.parts.clone(),
            lumps: self.lumps.clone(),
            counterweights: Vec::new(),
            closures: Vec::new(),
            end_effector: None,
            angles: Vec::new(),
        })
    }

    /// Checks that parts and lumps are on bars, and that their numbers fit.
    pub(super) fn check_parts(&self) -> Result<(), SketchRefusal> {
        if self.parts.is_empty() && self.lumps.is_empty() && self.materials.is_empty() {
            return Ok(());
        }
        let refused = |error: &MachineError| {
            let (what, want) = error.to_string().split_once(": want ").map_or_else(
                || (error.to_string(), "numbers that fit".to_owned()),
                |(what, want)| (what.to_owned(), want.to_owned()),
            );
            SketchRefusal::new(Place::Whole, what, want)
        };
        self.part_bodies().map(|_| ()).map_err(|error| refused(&error))
    }

    /// Takes materials, parts and lumps of a machine over, those on bars that the drawing has. Places at named lengths
    /// become metres: a drawing names its lengths itself.
    pub(super) fn take_parts(&mut self, spec: &MachineSpec) {
        let is_drawn = |link: &String| self.bars.iter().any(|bar| bar.name == *link);
        let parts = spec.parts.iter().filter(|part| is_drawn(&part.link)).cloned().collect();
        let lumps = spec.lumps.iter().filter(|lump| is_drawn(&lump.link)).cloned().collect();
        (self.materials, self.parts, self.lumps) = (spec.materials.clone(), parts, lumps);
        let names: Vec<String> = self.bars.iter().map(|bar| bar.name.clone()).collect();
        for name in names {
            for place in self.places_mut(&name) {
                let PlaceOnLink::Named(word) = place else { continue };
                let (length, sign) = word.strip_prefix('-').map_or((word.as_str(), 1.0), |word| (word, -1.0));
                if let Some(length) = spec.lengths.get(length).filter(|_| !["root", "tip"].contains(&word.as_str())) {
                    *place = PlaceOnLink::Metres(sign * length);
                }
            }
        }
    }

    /// Returns a place as a file states it: at a pin by the name of its length, if it has one.
    fn named(&self, lengths: &Lengths, bar: &str, place: &mut PlaceOnLink) {
        let Some(i) = self.bars.iter().position(|own| own.name == bar) else { return };
        let own = &self.bars[i];
        let PlaceOnLink::Metres(x) = *place else { return };
        let at = |pin: &PinId| (self.along(own, *pin) - x).abs() < AT_PIN;
        let name = own.pins.iter().find(|pin| at(pin)).map(|pin| lengths.place(self, i, *pin));
        if let Some(name @ PlaceOnLink::Named(_)) = name {
            *place = name;
        }
    }

    /// Returns the parts as a file states them.
    pub(super) fn named_parts(&self, lengths: &Lengths) -> Vec<Part> {
        let mut parts = self.parts.clone();
        for part in &mut parts {
            let holes = part.holes.iter_mut().map(|hole| &mut hole.at);
            for place in [&mut part.from, &mut part.to].into_iter().chain(holes) {
                self.named(lengths, &part.link, place);
            }
        }
        parts
    }

    /// Returns the lumps as a file states them.
    pub(super) fn named_lumps(&self, lengths: &Lengths) -> Vec<Lump> {
        let mut lumps = self.lumps.clone();
        lumps.iter_mut().for_each(|lump| self.named(lengths, &lump.link, &mut lump.at));
        lumps
    }
}
