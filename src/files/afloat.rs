//! Bases that float, in models of other programs and in scenarios.

use stillbase_exchange::base_body::BaseBody;
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::Vector;
use stillbase_session::gentle_motion_afloat;
use stillbase_session::scenario::{Scenario, ScenarioError};
use stillbase_simulation::plant::{Base, BaseKind};

/// Returns the base of a scenario as a rigid body, if it floats.
pub fn floating_base(base: &Base) -> Option<BaseBody> {
    let com = Vector::new(base.com[0], base.com[1]);
    (base.kind == BaseKind::Free).then_some(BaseBody { mass: base.mass, inertia: base.inertia, com })
}

/// Returns the built-in scenario of a machine's name, if its base floats.
pub fn scenario_on_free_base(machine: &Machine) -> Option<Scenario> {
    Scenario::builtin(machine.name()).filter(|scenario| scenario.base.kind == BaseKind::Free)
}

/// Returns what a model leaves out of the base of a scenario, if it floats.
pub fn left_out_of_base(base: &Base) -> Option<String> {
    base.wheel
        .filter(|_| base.kind == BaseKind::Free)
        .map(|_| "reaction wheel of the base: a model has none".to_owned())
}

/// Returns a scenario with a task for a machine on the base of its model, which floats.
///
/// # Errors
/// If no task can be stated for the machine, or if a value of the base is outside of the ranges of a scenario.
pub fn scenario_afloat(machine: &Machine, body: &BaseBody) -> Result<Scenario, ScenarioError> {
    // Parsed again, so that values outside of the ranges of a scenario are rejected.
    Scenario::parse(&gentle_motion_afloat(machine, base_of(body))?.to_toml(), "[base] of the file", None)
}

/// Returns a rigid body as the base of a scenario, which floats.
pub(crate) fn base_of(body: &BaseBody) -> Base {
    let BaseBody { mass, inertia, com } = *body;
    Base { kind: BaseKind::Free, mass, inertia, com: [com.re, com.im], ..Base::default() }
}
