//! What a bar weighs when it is cut in two, or becomes part of another: mass, centre of mass and inertia stay, for the
//! straight pose.

use super::body::Body;
use super::drawing::{Bar, MIN_DISTANCE, Sketch};
use super::recount::{Recount, metres};
use crate::machine::{Ends, Part, PlaceOnLink, PlaneBody, Shape};

/// Largest difference of two masses per metre that is a rounding error, as a fraction.
const ROUNDING: f64 = 1e-9;

/// Divides a body of a share `s` of the length before the cut, and of 1 − s behind it, as a slender bar divides: masses
/// s and 1 − s, inertias s³ and (1 − s)³. The distance of both centres is what the inertia about the common one needs.
fn halves(body: &PlaneBody, s: f64) -> [PlaneBody; 2] {
    let apart = (3.0 * body.inertia / body.mass).sqrt();
    let part = |share: f64, away: f64| PlaneBody {
        mass: share * body.mass,
        at: body.at + away,
        across: body.across,
        inertia: share.powi(3) * body.inertia,
    };
    [part(s, (s - 1.0) * apart), part(1.0 - s, s * apart)]
}

impl Sketch {
    /// Divides parts, lumps, counterweights and typed numbers of a bar, as it was in the drawing `was`, between it and
    /// the bar that is cut off `along` m from its root. A part that reaches over the cut becomes two, each with ends of
    /// its own; a plate goes to the side of its centre. Typed numbers are divided so that they add up, and so are all
    /// numbers where a bar would be left without parts.
    pub(super) fn divide(&mut self, was: &Self, bar: &Bar, second: &str, along: f64) {
        let (first, length) = (bar.name.as_str(), was.length(bar));
        let bodies = was.part_bodies().unwrap_or_default();
        let here = Recount { from: 0.0, sense: 1.0, was: length, length: along };
        let there = Recount { from: along, sense: 1.0, was: length, length: length - along };
        let mut parts = Vec::with_capacity(self.parts.len());
        for (i, mut part) in std::mem::take(&mut self.parts).into_iter().enumerate() {
            if part.link != first {
                parts.push(part);
                continue;
            }
            let ends = [&part.from, &part.to].map(|end| metres(end, length));
            let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
            let centre = bodies.get(i).map_or(low, |own| own.body.at);
            let is_plate = part.shape == Shape::Plate;
            let (before, behind) = match is_plate {
                true => (centre <= along, centre > along),
                false => (low < along - MIN_DISTANCE || high <= along, high > along + MIN_DISTANCE),
            };
            if before && behind {
                let mut other = part.clone();
                let is_round = part.shape == Shape::Flat && part.ends.unwrap_or_default() == Ends::Round;
                let side = |hole: &PlaceOnLink| metres(hole, length) - along;
                part.holes.retain(|hole| side(&hole.at) < if is_round { MIN_DISTANCE } else { 0.0 });
                other.holes.retain(|hole| side(&hole.at) > if is_round { -MIN_DISTANCE } else { 0.0 });
                let cut = PlaceOnLink::Metres(along);
                let far = |part: &mut Part, is_low: bool| {
                    let end = if (ends[0] <= ends[1]) == is_low { &mut part.from } else { &mut part.to };
                    *end = cut.clone();
                };
                far(&mut part, false);
                far(&mut other, true);
                here.part(&mut part);
                there.part(&mut other);
                second.clone_into(&mut other.link);
                parts.extend([part, other]);
                continue;
            }
            if behind {
                there.part(&mut part);
                second.clone_into(&mut part.link);
            } else {
                here.part(&mut part);
            }
            parts.push(part);
        }
        self.parts = parts;
        for lump in self.lumps.iter_mut().filter(|lump| lump.link == first) {
            let is_behind = metres(&lump.at, length) > along;
            lump.at = if is_behind { &there } else { &here }.place(&lump.at);
            if is_behind {
                second.clone_into(&mut lump.link);
            }
        }
        for weight in self.counterweights.iter_mut().filter(|weight| weight.link == first && weight.at > along) {
            (weight.link, weight.at) = (second.to_owned(), weight.at - along);
        }
        self.divide_numbers(was, bar, second, along);
    }

    fn divide_numbers(&mut self, was: &Self, bar: &Bar, second: &str, along: f64) {
        let stated = bar.body.unwrap_or_default();
        let is_slender = bar.body.is_none() && !was.has_parts(&bar.name);
        let whole = was.body(bar);
        let both = [bar.name.as_str(), second];
        let index = both.map(|name| self.bars.iter().position(|own| own.name == name));
        let [Some(i), Some(j)] = index else { return };
        let follows = stated.follows() && both.iter().all(|name| self.has_parts(name));
        let [low, high] = was.extent(bar);
        let [near, far] = halves(&whole, (along - low) / (high - low));
        let axial = stated.axial;
        for (at, half) in [(i, near), (j, far.moved(-along, 0.0))] {
            self.bars[at].body = match (is_slender, follows) {
                (true, _) => None,
                (_, true) => Some(Body { axial, ..Body::default() }).filter(|body| *body != Body::default()),
                _ => Some(Body::typed(&half, axial)),
            };
        }
    }

    /// Lets a bar have what another had that becomes part of it: parts, lumps, counterweights and mass. The other's
    /// root is `from` m from its own, and it runs in the same sense or, with −1, the other way. `self` still has both.
    pub(super) fn unite(&mut self, first: &Bar, second: &Bar, from: f64, sense: f64) {
        let moved = PlaneBody {
            at: from + sense * self.body(second).at,
            across: sense * self.body(second).across,
            ..self.body(second)
        };
        let own = self.body(first);
        let (of_first, of_second) = (self.has_parts(&first.name), self.has_parts(&second.name));
        let [a, b] = [first, second].map(|bar| bar.body.unwrap_or_default());
        let is_slender = |bar: &Bar, has: bool| bar.body.is_none() && !has;
        let both_slender = is_slender(first, of_first) && is_slender(second, of_second);
        let body = match (both_slender, of_first && of_second && a.follows() && b.follows() && a.axial == b.axial) {
            (true, _) if (first.per_metre - second.per_metre).abs() <= ROUNDING * first.per_metre => None,
            (_, true) => first.body,
            _ => {
                let axial = (own.mass * a.axial + moved.mass * b.axial) / (own.mass + moved.mass);
                Some(Body::typed(&own.and(moved), axial))
            }
        };
        let (was, length) = (self.length(second), self.length(first));
        self.recount(&second.name, &Recount { from: -sense * from, sense, was, length });
        self.links_mut().filter(|link| **link == second.name).for_each(|link| first.name.clone_into(link));
        if let Some(bar) = self.bar_mut(first.id) {
            bar.body = body;
        }
    }
}
