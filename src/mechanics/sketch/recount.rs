//! [`Recount`]: places of parts, lumps and counterweights when a bar is measured from another root.

use super::drawing::{Bar, Sketch};
use super::lengths::rounded;
use crate::machine::{Part, PlaceOnLink, Shape};

/// Distance along a bar below which two places are one, m.
const SAME: f64 = 1e-12;

/// A bar measured from another root, or towards another tip.
pub(super) struct Recount {
    /// Where the new root is, m from the old one.
    pub from: f64,
    /// −1 if the bar is measured the other way, else 1.
    pub sense: f64,
    /// Length from root to tip so far, m.
    pub was: f64,
    /// Length from root to tip now, m.
    pub length: f64,
}

impl Recount {
    fn along(&self, x: f64) -> f64 {
        self.sense * (x - self.from)
    }

    /// Returns a place as it is counted now: the root, the tip, or metres from the root.
    pub fn place(&self, at: &PlaceOnLink) -> PlaceOnLink {
        place(self.along(metres(at, self.was)), self.length)
    }

    /// Counts the places of a part anew. It keeps the order of its ends along the bar.
    pub fn part(&self, part: &mut Part) {
        if part.shape != Shape::Plate {
            (part.from, part.to) = (self.place(&part.from), self.place(&part.to));
            if self.sense < 0.0 {
                std::mem::swap(&mut part.from, &mut part.to);
            }
        }
        part.across *= self.sense;
        for [x, y] in &mut part.polygon {
            (*x, *y) = (self.along(*x), self.sense * *y);
        }
        for hole in &mut part.holes {
            (hole.at, hole.across) = (self.place(&hole.at), self.sense * hole.across);
        }
    }
}

/// Returns a place on a bar of a length, m: the root, the tip, or metres from the root.
pub(super) fn place(at: f64, length: f64) -> PlaceOnLink {
    let named = |word: &str| PlaceOnLink::Named(word.into());
    match at {
        _ if at.abs() < SAME => named("root"),
        _ if (at - length).abs() < SAME => named("tip"),
        _ => PlaceOnLink::Metres(rounded(at)),
    }
}

/// Returns a place on a bar of a length, m from its root. A drawing names no other lengths than this one.
pub(super) fn metres(place: &PlaceOnLink, length: f64) -> f64 {
    match place {
        PlaceOnLink::Metres(x) => *x,
        PlaceOnLink::Named(word) if word == "tip" => length,
        PlaceOnLink::Named(_) => 0.0,
    }
}

impl Sketch {
    /// Counts the places of what is on a bar anew.
    pub(super) fn recount(&mut self, bar: &str, by: &Recount) {
        self.parts.iter_mut().filter(|part| part.link == bar).for_each(|part| by.part(part));
        for lump in self.lumps.iter_mut().filter(|lump| lump.link == bar) {
            (lump.at, lump.across) = (by.place(&lump.at), by.sense * lump.across);
        }
        for weight in self.counterweights.iter_mut().filter(|weight| weight.link == bar) {
            let outward = by.sense * weight.outward();
            (weight.at, weight.across) = (by.along(weight.at), by.sense * weight.across);
            // Half a ring keeps its round side where it is.
            weight.turned ^= weight.half && weight.outward() != outward;
        }
    }

    /// Returns the positions in the list of those parts of a bar that reach from its root to its tip.
    pub(super) fn spanning(&self, bar: &Bar) -> Vec<usize> {
        let spans = |part: &Part| part.link == bar.name && part.shape != Shape::Plate && part.has_usual_places();
        (0..self.parts.len()).filter(|i| spans(&self.parts[*i])).collect()
    }

    /// Lets parts reach from root to tip.
    pub(super) fn span_again(&mut self, parts: &[usize]) {
        for i in parts {
            let part = &mut self.parts[*i];
            (part.from, part.to) = (PlaceOnLink::Named("root".into()), PlaceOnLink::default());
        }
    }
}
