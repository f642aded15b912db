//! [`Way`]: what may change where a measurement is mended.

use crate::mechanics::balance::{Body, Hold, Keep, Parameter, Quantity};
use crate::mechanics::counterweights::Weighing;
use crate::mechanics::machine::{Counterweight, Machine};
use crate::session::scenario::Brief;

/// What may change.
#[derive(Clone, Debug, PartialEq)]
pub enum Way {
    /// Numbers that the machine has.
    Change(Keep),
    /// New counterweights.
    Add(Weighing),
}

impl Way {
    /// What a brief lets change: counterweights that the machine has, and numbers that it frees; where there are none,
    /// new counterweights.
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

/// Lets mass and place of those counterweights change.
pub fn free_weights(keep: &mut Keep, machine: &Machine, is_movable: impl Fn(&Counterweight) -> bool) {
    let movable = machine.spec().counterweights.iter().enumerate().filter(|(_, weight)| is_movable(weight));
    for (i, quantity) in movable.flat_map(|(i, _)| [(i, Quantity::Mass), (i, Quantity::Along)]) {
        keep.hold(machine, Parameter::new(Body::Counterweight(i), quantity), Hold::Free);
    }
}
