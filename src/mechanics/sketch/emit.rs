//! Writes a complete drawing as the specification of a machine.

use std::collections::HashMap;

use super::classes::Classes;
use super::drawing::{MIN_DISTANCE, PinId, Sketch};
use super::graph::Graph;
use super::lengths::{Lengths, rounded};
use super::loops::Recognised;
use crate::machine::{Attach, Closure, DerivedNumbers, Drive, Link, LinkNumber, LinkPoint, MachineSpec};

/// The bar to which the roots of others are pinned at a pin, by index; `None` for the base.
pub(super) type Owners = HashMap<PinId, Option<usize>>;

impl Sketch {
    /// Returns the specification of the machine. Its lists keep the order of the drawing.
    pub(super) fn spec(&self) -> MachineSpec {
        let (own, owners) = self.rooted();
        let loops: Vec<Recognised> = own.recognised(&Graph::of(&own));
        let (classes, lengths) = (Classes::of(&own, &loops), Lengths::of(&own, &loops));
        let point =
            |bar: usize, pin: PinId| LinkPoint { link: own.bars[bar].name.clone(), at: lengths.place(&own, bar, pin) };
        let links = own.bars.iter().enumerate().map(|(i, bar)| {
            let drive = classes.drive(&own, i).unwrap_or_default();
            let stated = own.stated(bar);
            let mut link = Link {
                name: bar.name.clone(),
                drive: drive.into(),
                attach: match owners.get(&bar.root).copied().flatten() {
                    Some(parent) => Attach::On(point(parent, bar.root)),
                    None => Attach::Base("base".into()),
                },
                direction: if own.is_against(bar, drive) { -1 } else { 1 },
                length: lengths.length(&own, i),
                mass: 0.0,
                inertia: 0.0,
                inertia_along: stated.inertia_along,
                inertia_across: stated.inertia_across,
                com: 0.0,
                com_normal: 0.0,
                axial: stated.axial,
                derived: DerivedNumbers::default(),
            };
            LinkNumber::ALL.into_iter().for_each(|number| link.type_number(number, stated.number(number)));
            link
        });
        let index = |id| own.bars.iter().position(|bar| bar.id == id);
        let drives = own.motors.iter().map(|motor| {
            let on = motor.stator.and_then(index).and_then(|bar| classes.drive(&own, bar));
            Drive { on: on.map(Into::into), ..motor.drive.clone() }
        });
        let end = own.end_effector.and_then(|end| Some(point(index(end.bar)?, end.pin)));
        MachineSpec {
            name: own.name.clone(),
            summary: own.summary.clone(),
            gravity: own.gravity,
            pose: self.pose().map(|q| q.iter().map(|angle| rounded(*angle)).collect()),
            payload: own.payload,
            drives: drives.collect(),
            links: links.collect(),
            counterweights: own.counterweights.clone(),
            closures: own.closures(&owners, &point),
            end_effector: end,
            angles: own.angles.clone(),
            lengths: lengths.named.clone(),
            materials: own.materials.clone(),
            parts: own.named_parts(&lengths),
            lumps: own.named_lumps(&lengths),
        }
    }

    /// Returns the closures: at each pin, every bar that is neither pinned there by its root nor the bar on which
    /// those roots are.
    fn closures(&self, owners: &Owners, point: &dyn Fn(usize, PinId) -> LinkPoint) -> Vec<Closure> {
        let mut closures = Vec::new();
        for pin in self.pins.iter().map(|pin| pin.id) {
            let at_base = || self.bars.iter().position(|bar| bar.root == pin);
            let Some(first) = owners.get(&pin).copied().flatten().or_else(at_base) else { continue };
            let others = self.bars.iter().enumerate().filter(|(i, bar)| *i != first && bar.root != pin && bar.has(pin));
            closures.extend(others.map(|(other, _)| Closure { a: point(first, pin), b: point(other, pin) }));
        }
        closures
    }

    /// Returns the drawing with the root of each bar on a bar nearer to the base, and for each pin the bar that the
    /// others are attached to.
    pub(super) fn rooted(&self) -> (Self, Owners) {
        let mut own = self.clone();
        let mut owners: Owners = HashMap::from([(own.base, None)]);
        let mut placed = vec![false; own.bars.len()];
        loop {
            let is_next = |i: &usize| !placed[*i] && owners.contains_key(&own.bars[*i].root);
            let mut round: Vec<usize> = (0..own.bars.len()).filter(is_next).collect();
            if round.is_empty() {
                // A bar that was drawn the other way, or meets the others in its middle only.
                let reached = |i: usize| own.bars[i].all_pins().find(|pin| owners.contains_key(pin));
                let Some((i, pin)) = (0..own.bars.len()).filter(|i| !placed[*i]).find_map(|i| Some((i, reached(i)?)))
                else {
                    return (own, owners);
                };
                own.root_at(i, pin);
                round.push(i);
            }
            for i in round {
                placed[i] = true;
                for pin in own.bars[i].all_pins() {
                    owners.entry(pin).or_insert(Some(i));
                }
            }
        }
    }

    /// Makes a pin the root of a bar.
    fn root_at(&mut self, i: usize, pin: PinId) {
        let bar = self.bars[i].clone();
        let along = self.along(&bar, pin);
        let turned = pin == bar.tip || along > self.length(&bar) - MIN_DISTANCE;
        let tip = if turned { bar.root } else { bar.tip };
        self.measure_from(bar.id, pin, tip, along, turned);
    }
}
