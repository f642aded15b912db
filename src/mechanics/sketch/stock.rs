//! Drawn bars: the part that a new bar has, which reaches over its pins and has a hole for each.

use super::drawing::{Bar, BarId, Sketch};
use super::recount::{metres, place};
use crate::machine::{Hole, Part, PlaceOnLink, Shape};
use crate::planar::Vector;

/// Distance below which two places are one, m.
const SAME: f64 = 1e-9;

impl Sketch {
    /// Lets drawn bars follow their pins since the drawing `before`: each reaches over all of its pins and has a hole
    /// for each. What reached farther, and holes elsewhere, stay. A hole that would cut into another is left out until
    /// its pin is farther away.
    pub(super) fn follow_with_bars(&mut self, before: &Self) {
        let others = before.holes_beside_pins();
        for i in 0..self.bars.len() {
            let bar = self.bars[i].clone();
            self.unite_drawn(&bar.name);
            let Some(part) = self.drawn(&bar) else { continue };
            let own = self.followed(&bar, &self.parts[part], before, &others);
            self.parts[part] = own;
        }
    }

    /// Returns a bar of a section over all pins of a bar of the drawing, with a hole for each where it can have some.
    pub fn drawn_over(&self, bar: &Bar, section: &Part) -> Part {
        let drawn = Part::drawn(&bar.name);
        let holes = if section.shape == Shape::Flat { drawn.holes } else { Vec::new() };
        let part =
            Part { link: drawn.link, name: drawn.name, from: drawn.from, to: drawn.to, holes, ..section.clone() };
        self.followed(bar, &part, &Self::blank(), &[])
    }

    /// Returns the drawn part of a bar, by its position in the list, if it has just one.
    fn drawn(&self, bar: &Bar) -> Option<usize> {
        let mut all = (0..self.parts.len()).filter(|i| self.parts[*i].link == bar.name && self.parts[*i].is_drawn());
        all.next().filter(|_| all.next().is_none())
    }

    /// Makes one of drawn parts of one section on a bar, as after joining two bars.
    fn unite_drawn(&mut self, bar: &str) {
        let all: Vec<usize> =
            (0..self.parts.len()).filter(|i| self.parts[*i].link == bar && self.parts[*i].is_drawn()).collect();
        let Some((first, others)) = all.split_first().filter(|(_, others)| !others.is_empty()) else { return };
        let alike = |part: &Part| Part {
            from: PlaceOnLink::default(),
            to: PlaceOnLink::default(),
            holes: Vec::new(),
            ..part.clone()
        };
        let section = alike(&self.parts[*first]);
        if others.iter().any(|i| alike(&self.parts[*i]) != section) {
            return;
        }
        let Some(length) = self.bars.iter().find(|own| own.name == bar).map(|own| self.length(own)) else { return };
        let ends = |part: &Part| [&part.from, &part.to].map(|end| metres(end, length));
        let all_ends = || all.iter().flat_map(|i| ends(&self.parts[*i]));
        let (low, high) = (all_ends().fold(f64::INFINITY, f64::min), all_ends().fold(f64::NEG_INFINITY, f64::max));
        let holes = all.iter().flat_map(|i| self.parts[*i].holes.clone()).collect();
        let one = &mut self.parts[*first];
        (one.from, one.to, one.holes) = (place(low, length), place(high, length), holes);
        others.iter().rev().for_each(|i| drop(self.parts.remove(*i)));
    }

    /// Returns the holes of drawn bars that are at no pin: by bar and place along it, m, and by place in the drawing.
    fn holes_beside_pins(&self) -> Vec<(BarId, f64, Vector)> {
        let mut all = Vec::new();
        for bar in &self.bars {
            let Some(part) = self.drawn(bar) else { continue };
            let length = self.length(bar);
            for hole in self.parts[part].holes.iter().filter(|hole| hole.across == 0.0) {
                let along = metres(&hole.at, length);
                if !bar.all_pins().any(|pin| (self.along(bar, pin) - along).abs() < SAME) {
                    all.push((bar.id, along, self.at(bar.root) + self.direction(bar) * along));
                }
            }
        }
        all
    }

    /// Returns a drawn part of a bar as its pins demand.
    fn followed(&self, bar: &Bar, part: &Part, before: &Self, others: &[(BarId, f64, Vector)]) -> Part {
        let (length, [low, high]) = (self.length(bar), self.extent(bar));
        let was = before.bar(bar.id).and_then(|own| Some((own, before.parts.get(before.drawn(own)?)?)));
        // An end at the outermost pin stays at the outermost pin; one that reached farther stays where it is.
        let is_at_pin = was.map_or([false; 2], |(own, part)| {
            let ends = [&part.from, &part.to].map(|end| metres(end, before.length(own)));
            let extent = before.extent(own);
            [(ends[0] - extent[0]).abs() < SAME, (ends[1] - extent[1]).abs() < SAME]
        });
        let [from, to] = [&part.from, &part.to].map(|end| metres(end, length));
        let from = if is_at_pin[0] { low } else { from.min(low) };
        let to = if is_at_pin[1] { high } else { to.max(high) };
        let mut next = part.clone();
        for (end, at) in [(&mut next.from, from), (&mut next.to, to)] {
            if (metres(end, length) - at).abs() >= SAME {
                *end = place(at, length);
            }
        }
        if part.shape == Shape::Flat {
            self.follow_with_holes(bar, &mut next, others);
        }
        next
    }

    fn follow_with_holes(&self, bar: &Bar, part: &mut Part, others: &[(BarId, f64, Vector)]) {
        let length = self.length(bar);
        let pins: Vec<f64> = bar.all_pins().map(|pin| self.along(bar, pin)).collect();
        let stays = |hole: &Hole| {
            let along = metres(&hole.at, length);
            let at = self.at(bar.root) + self.direction(bar) * along;
            let is_it = |(id, was, place): &(BarId, f64, Vector)| {
                (*id == bar.id && (was - along).abs() < SAME) || (*place - at).norm() < SAME
            };
            hole.across != 0.0 || others.iter().any(is_it)
        };
        let (mut holes, of_pins): (Vec<Hole>, Vec<Hole>) =
            std::mem::take(&mut part.holes).into_iter().partition(|hole| stays(hole));
        let Some(diameter) = of_pins.first().map(|hole| hole.diameter) else {
            part.holes = holes;
            return;
        };
        let fits = |holes: &[Hole], at: f64, diameter: f64| {
            let apart = |hole: &Hole| (metres(&hole.at, length) - at).hypot(hole.across);
            holes.iter().all(|hole| apart(hole) >= 0.5 * (hole.diameter + diameter))
        };
        let count = holes.len();
        for along in pins {
            let known = of_pins.iter().find(|hole| (metres(&hole.at, length) - along).abs() < SAME);
            let hole = known.cloned().unwrap_or_else(|| Hole { at: place(along, length), across: 0.0, diameter });
            if fits(&holes, along, hole.diameter) {
                holes.push(hole);
            }
        }
        holes.rotate_left(count);
        part.holes = holes;
    }
}
