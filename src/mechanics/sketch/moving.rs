//! Moving a pin, and what hangs on it.
//!
//! The pin goes to its new place: the bar that carries it turns and grows. While all loops are closed, bars that must
//! stay parallel turn with it, lengths that must stay equal grow with it, and everything else moves along without
//! turning.
//!
//! Where a loop is open, a bar that hangs on a pin that moves, with its pin next to the base, moves along without
//! turning. A bar of which another pin moves turns about its pin next to the base; its other pins keep their distances
//! from that. A bar that would bend afterwards is straightened, and where this does not succeed the move is refused.

use std::collections::{BTreeMap, VecDeque};

use super::drawing::{Bar, BarId, MIN_DISTANCE, PinId, Place, Sketch, mm};
use super::graph::Graph;
use super::refusal::SketchRefusal;
use crate::planar::{Vector, cross, unit};

/// Largest distance of a pin from the axis of its bar, m.
pub(super) const STRAIGHT: f64 = 1e-9;
/// Rounds in which bars that would bend are straightened.
const ROUNDS: usize = 16;

impl Sketch {
    /// Returns for each bar its pin next to the base, in the order of bars. A bar that is not connected has its root.
    pub(super) fn inner_pins(&self) -> Vec<PinId> {
        let graph = Graph::of(self);
        let base = self.pins.iter().position(|pin| pin.id == self.base).unwrap_or_default();
        let (_, far) = graph.distances(base);
        let far: BTreeMap<PinId, usize> =
            self.pins.iter().zip(far).map(|(pin, far)| (pin.id, far.unwrap_or(usize::MAX))).collect();
        let inner = |bar: &Bar| bar.all_pins().min_by_key(|pin| far.get(pin).copied().unwrap_or(usize::MAX));
        self.bars.iter().map(|bar| inner(bar).unwrap_or(bar.root)).collect()
    }

    /// Returns the drawing with a pin moved, and what hangs on it.
    pub(super) fn moved(&self, pin: PinId, to: Vector) -> Result<Self, SketchRefusal> {
        self.moved_with(pin, to, None)
    }

    /// Does the same as [`moved`](Self::moved) by turning and lengthening a certain bar.
    fn moved_with(&self, pin: PinId, to: Vector, carrier: Option<BarId>) -> Result<Self, SketchRefusal> {
        if pin == self.base {
            let want = "a pin other than that on the base moved";
            return Err(SketchRefusal::new(Place::Pin(pin), "B is where the machine stands", want));
        }
        if let Some(posed) = self.posed(pin, to, carrier) {
            return posed;
        }
        let inner = self.inner_pins();
        let mut places: BTreeMap<PinId, Vector> = BTreeMap::from([(pin, to)]);
        let mut queue = VecDeque::from([pin]);
        let mut turned = vec![false; self.bars.len()];
        while let Some(moving) = queue.pop_front() {
            let Some(&there) = places.get(&moving) else { continue };
            for (i, bar) in self.bars.iter().enumerate().filter(|(_, bar)| bar.has(moving)) {
                if std::mem::replace(&mut turned[i], true) {
                    continue;
                }
                let shift = there - self.at(moving);
                let root = places.get(&inner[i]).copied().unwrap_or_else(|| self.at(inner[i]));
                let reach = self.at(moving) - self.at(inner[i]);
                let turn = (there - root).scale(1.0 / reach.norm().max(MIN_DISTANCE));
                let turn = turn.scale(1.0 / turn.norm().max(f64::MIN_POSITIVE));
                let was = reach.scale(1.0 / reach.norm().max(f64::MIN_POSITIVE));
                for other in bar.all_pins() {
                    if other == inner[i] || places.contains_key(&other) {
                        continue;
                    }
                    let at = match inner[i] == moving {
                        true => self.at(other) + shift,
                        // Along the axis, with its distance from the inner pin.
                        false => {
                            let away = self.at(other) - self.at(inner[i]);
                            root + turn * (away * was.conj()).re
                        }
                    };
                    places.insert(other, at);
                    queue.push_back(other);
                }
            }
        }
        let mut next = self.clone();
        places.into_iter().filter(|(id, _)| *id != self.base).for_each(|(id, at)| next.put(id, at));
        next.straighten(self)?;
        next.check_lengths()?;
        Ok(next)
    }

    /// Puts pins between and beyond the ends of bars back on their axes, at their distances from the roots in `was`.
    fn straighten(&mut self, was: &Self) -> Result<(), SketchRefusal> {
        for _ in 0..ROUNDS {
            let bent: Vec<Bar> = self.bars.iter().filter(|bar| self.bend(bar) > STRAIGHT).cloned().collect();
            if bent.is_empty() {
                return Ok(());
            }
            for bar in &bent {
                let (base, root, along) = (self.base, self.at(bar.root), self.direction(bar));
                for pin in bar.pins.iter().filter(|pin| **pin != base) {
                    self.put(*pin, root + along * was.along(bar, *pin));
                }
            }
        }
        match self.bars.iter().find(|bar| self.bend(bar) > STRAIGHT) {
            None => Ok(()),
            Some(bar) => Err(SketchRefusal::new(
                Place::Bar(bar.id),
                format!("bar {} would bend by {}", bar.name, mm(self.bend(bar))),
                "a bar that stays straight: move a pin farther from the base, or take a bar away first",
            )),
        }
    }

    /// Returns the largest distance of a pin from the axis of its bar, m.
    pub(super) fn bend(&self, bar: &Bar) -> f64 {
        let (root, along) = (self.at(bar.root), self.direction(bar));
        bar.pins.iter().map(|pin| cross(along, self.at(*pin) - root).abs()).fold(0.0, f64::max)
    }

    /// Checks that no two pins of a bar are at one place.
    pub(super) fn check_lengths(&self) -> Result<(), SketchRefusal> {
        for bar in &self.bars {
            let pins: Vec<PinId> = bar.all_pins().collect();
            for (i, a) in pins.iter().enumerate() {
                if pins[..i].iter().any(|b| (self.at(*a) - self.at(*b)).norm() < MIN_DISTANCE) {
                    let what = format!("two pins of bar {} would be at one place", bar.name);
                    let want = format!("at least {} between them", mm(MIN_DISTANCE));
                    return Err(SketchRefusal::new(Place::Pin(*a), what, want));
                }
            }
        }
        Ok(())
    }

    /// Returns the drawing with a bar of another length, m.
    pub(super) fn with_length(&self, id: BarId, metres: f64) -> Result<Self, SketchRefusal> {
        let (bar, inner) = self.bar_and_inner(id)?;
        if !(metres >= MIN_DISTANCE && metres.is_finite()) {
            let what = format!("bar {} would be {} long", bar.name, mm(metres));
            return Err(SketchRefusal::new(Place::Bar(id), what, format!("at least {}", mm(MIN_DISTANCE))));
        }
        let along = self.direction(bar).scale(metres);
        match inner == bar.tip {
            true => self.moved_with(bar.root, self.at(bar.tip) - along, Some(id)),
            false => self.moved_with(bar.tip, self.at(bar.root) + along, Some(id)),
        }
    }

    /// Returns the drawing with a bar turned to a direction, rad.
    pub(super) fn with_angle(&self, id: BarId, radians: f64) -> Result<Self, SketchRefusal> {
        let (bar, inner) = self.bar_and_inner(id)?;
        self.turned(bar, inner, unit(radians))
    }

    /// Returns the drawing with a bar turned to a direction about its pin next to the base.
    pub(super) fn turned(&self, bar: &Bar, inner: PinId, along: Vector) -> Result<Self, SketchRefusal> {
        let outer = if inner == bar.tip { bar.root } else { bar.tip };
        let far = self.along(bar, outer) - self.along(bar, inner);
        self.moved_with(outer, self.at(inner) + along.scale(far), Some(bar.id))
    }

    fn bar_and_inner(&self, id: BarId) -> Result<(&Bar, PinId), SketchRefusal> {
        let inner = self.inner_pins();
        let found = self.bars.iter().zip(inner).find(|(bar, _)| bar.id == id);
        found.ok_or_else(|| self.no_bar(id))
    }
}
