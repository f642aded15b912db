//! [`Way`]: the numbers that may change in a correction.

use crate::mechanics::balance::{Body, Hold, Keep, Parameter, Quantity};
use crate::mechanics::counterweights::Weighing;
use crate::mechanics::machine::{Counterweight, Machine};
use crate::session::scenario::Brief;

/// Numbers that may change in a correction.
#[derive(Clone, Debug, PartialEq)]
pub enum Way {
    /// Numbers of the machine.
    Change(Keep),
    /// New counterweights.
    Add(Weighing),
}

impl Way {
    /// Returns the numbers that a brief permits to change: the machine's counterweights and the numbers that the brief
    /// frees; new counterweights if there are none.
    pub fn of(brief: &Brief, machine: &Machine) -> Self {
        let is_movable = |weight: &Counterweight| !weight.fixed && !brief.fixed.contains(&weight.link);
        let mut keep = Keep::default();
        free_weights(&mut keep, machine, is_movable);
        for parameter in Parameter::all(machine) {
            if let Some(hold) = brief.hold.get(&parameter.key(machine)) {
                keep.hold(machine, parameter, *hold);
            }
        }
        match keep.parameters.iter().all(|one| one.hold == Hold::Fixed) {
            true => Self::Add(brief.weighing(machine)),
            false => Self::Change(keep),
        }
    }
}

/// Frees the mass and position of those counterweights that `is_movable` accepts.
pub fn free_weights(keep: &mut Keep, machine: &Machine, is_movable: impl Fn(&Counterweight) -> bool) {
    let movable = machine.spec().counterweights.iter().enumerate().filter(|(_, weight)| is_movable(weight));
    for (i, quantity) in movable.flat_map(|(i, _)| [(i, Quantity::Mass), (i, Quantity::Along)]) {
        keep.hold(machine, Parameter::new(Body::Counterweight(i), quantity), Hold::Free);
    }
}
