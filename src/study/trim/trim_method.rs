//! [`TrimMethod`]: the numbers that may change in a correction.

use stillbase_mechanics::balance::{Body, BodyQuantity, Parameter, ParameterBounds, RebalanceRequest};
use stillbase_mechanics::counterweights::CounterweightSpec;
use stillbase_mechanics::machine::{Counterweight, Machine};
use stillbase_session::scenario::DesignBrief;

/// Numbers that may change in a correction.
#[derive(Clone, Debug, PartialEq)]
pub enum TrimMethod {
    /// Present numbers of the machine.
    Change(RebalanceRequest),
    /// New counterweights.
    Add(CounterweightSpec),
}

impl TrimMethod {
    /// Returns the numbers that a brief permits to change: counterweights that may move, and numbers that the brief
    /// frees. If there are none, returns new counterweights.
    pub fn of(brief: &DesignBrief, machine: &Machine) -> Self {
        let is_movable = |weight: &Counterweight| !weight.fixed && !brief.fixed.contains(&weight.link);
        let mut keep = RebalanceRequest::default();
        free_weights(&mut keep, machine, is_movable);
        for parameter in Parameter::all(machine) {
            if let Some(hold) = brief.hold.get(&parameter.key(machine)) {
                keep.set_bounds(machine, parameter, *hold);
            }
        }
        match keep.parameters.iter().all(|one| one.bounds == ParameterBounds::Fixed) {
            true => Self::Add(brief.lightest_problem(machine)),
            false => Self::Change(keep),
        }
    }
}

/// Frees the mass and position of those counterweights that `is_movable` accepts.
pub fn free_weights(keep: &mut RebalanceRequest, machine: &Machine, is_movable: impl Fn(&Counterweight) -> bool) {
    let movable = machine.spec().counterweights.iter().enumerate().filter(|(_, weight)| is_movable(weight));
    for (i, quantity) in movable.flat_map(|(i, _)| [(i, BodyQuantity::Mass), (i, BodyQuantity::Along)]) {
        keep.set_bounds(machine, Parameter::new(Body::Counterweight(i), quantity), ParameterBounds::Free);
    }
}
