//! Counterweights of a drawing, and how far bars reach beyond their pins.

use super::drawing::{Bar, Sketch};
use super::recount::metres;
use crate::machine::{Counterweight, PlaneBody};
use crate::planar::Vector;

impl Sketch {
    /// Returns the counterweights of a bar, in their order.
    pub fn weights_of(&self, bar: &Bar) -> impl Iterator<Item = &Counterweight> {
        self.counterweights.iter().filter(move |weight| weight.link == bar.name)
    }

    /// Returns where a place on a bar is in the drawing, m. The place is along the bar from its root, and to the left of
    /// its axis, m.
    pub fn on_bar(&self, bar: &Bar, place: Vector) -> Vector {
        self.at(bar.root) + self.direction(bar) * place
    }

    /// Returns the interval of a bar between its outermost pins, and the one in which it has mass, m from its root: parts,
    /// lumps and counterweights, or without counterweights its centre of mass. `body` is what the bar weighs.
    pub fn reach_of(&self, bar: &Bar, body: &PlaneBody) -> [[f64; 2]; 2] {
        let pins = self.extent(bar);
        let length = self.length(bar);
        let parts = self.parts.iter().filter(|part| part.link == bar.name);
        let parts = parts.flat_map(|part| [&part.from, &part.to]).map(|place| metres(place, length));
        let lumps = self.lumps_of(bar).map(|lump| metres(&lump.at, length));
        let weights: Vec<f64> = self.weights_of(bar).map(|weight| weight.at).collect();
        let centre = weights.is_empty().then_some(body.at);
        let all = parts.chain(lumps).chain(weights).chain(centre);
        let mass = all.fold(pins, |[low, high], along| [low.min(along), high.max(along)]);
        [pins, mass]
    }
}
