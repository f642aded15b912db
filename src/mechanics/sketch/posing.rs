//! Moving a pin of a drawing whose loops are closed: bars turn and grow together, as their loops need it.

use std::collections::{BTreeMap, HashSet};

use super::classes::Classes;
use super::drawing::{BarId, PinId, Sketch};
use super::graph::Graph;
use super::lengths::{Distance, shared};
use super::loops::LoopShape;
use super::refusal::SketchRefusal;
use crate::planar::{Vector, cross};

/// Largest sine of the angle between bars of one drive that turn together.
const PARALLEL: f64 = 1e-7;

impl Sketch {
    /// Returns the drawing with a pin moved by turning and lengthening the bar that carries it: by default that which
    /// reaches it first from the base. Bars that must stay parallel turn with it, and lengths that must stay equal grow
    /// with it. `None` where a loop is open, or the bar does not hang on the base.
    pub(super) fn posed(&self, pin: PinId, to: Vector, carrier: Option<BarId>) -> Option<Result<Self, SketchRefusal>> {
        let loops = self.recognised(&Graph::of(self));
        if loops.iter().any(|found| found.state.shape != LoopShape::Closed) {
            return None;
        }
        let (own, owners) = self.rooted();
        let loops = if own == *self { loops } else { own.recognised(&Graph::of(&own)) };
        let index = |id: BarId| own.bars.iter().position(|bar| bar.id == id);
        let carrier = carrier.and_then(index).or_else(|| owners.get(&pin).copied().flatten())?;
        let bar = &own.bars[carrier];
        if bar.root == pin || !bar.has(pin) || !owners.contains_key(&bar.root) {
            return None;
        }
        let (way, was) = (to - own.at(bar.root), own.at(pin) - own.at(bar.root));
        if way.norm() <= 0.0 || was.norm() <= 0.0 {
            return None;
        }
        let (grown, turn) = (way.norm(), way / was * (was.norm() / way.norm()));
        let classes = Classes::of(&own, &loops);
        let turns = |i: usize| {
            let is_alike = |drive: &str| classes.drive(&own, i) == Some(drive);
            let along = cross(own.direction(&own.bars[i]), own.direction(bar)).abs();
            classes.class(i) == classes.class(carrier)
                || (classes.drive(&own, carrier).is_some_and(is_alike) && along < PARALLEL)
        };
        let alike = shared(&own, &loops).into_iter().find(|all| all.contains(&(carrier, pin)));
        let alike: HashSet<Distance> = alike.unwrap_or_else(|| vec![(carrier, pin)]).into_iter().collect();
        let mut places: BTreeMap<PinId, Vector> = BTreeMap::from([(own.base, own.at(own.base))]);
        let mut placed = vec![false; own.bars.len()];
        while let Some(i) = (0..own.bars.len()).find(|i| !placed[*i] && places.contains_key(&own.bars[*i].root)) {
            placed[i] = true;
            let bar = &own.bars[i];
            let root = places.get(&bar.root).copied().unwrap_or_default();
            for other in bar.all_pins() {
                let mut away = own.at(other) - own.at(bar.root);
                if alike.contains(&(i, other)) {
                    away = away.scale(grown / away.norm().max(f64::MIN_POSITIVE));
                }
                places.entry(other).or_insert(root + if turns(i) { away * turn } else { away });
            }
        }
        places.insert(pin, to);
        let mut next = self.clone();
        places.into_iter().for_each(|(id, at)| next.put(id, at));
        Some(next.check_lengths().map(|()| next))
    }
}
