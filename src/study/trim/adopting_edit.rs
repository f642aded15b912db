//! The edit by which a session adopts the result of a measurement.

use super::machine_correction::{corrected_as_built, identified_machine};
use super::trimming::TrimResult;
use stillbase_mechanics::machine::Machine;
use stillbase_session::Edit;
use stillbase_session::design::machine_edit;
use stillbase_session::scenario::Scenario;

/// Returns the edit that replaces the session's machine by the identified one: as built, or with its correction if
/// `mends` is set. `None` if the session has that machine already. `measured` is the machine with which the
/// measurement was evaluated.
///
/// # Errors
/// Fails if the session's machine has other links, there is no correction to adopt, or the new machine is not valid.
pub fn adopting_edit(
    scenario: &Scenario,
    measured: &Machine,
    found: &TrimResult,
    mends: bool,
) -> Result<Option<Edit>, String> {
    let names = |machine: &Machine| machine.links().iter().map(|link| link.name.clone()).collect::<Vec<_>>();
    if names(measured) != names(&scenario.machine) {
        return Err(format!("the measurement is of {}: open that machine, then the table again", measured.name()));
    }
    let (built, _) = identified_machine(measured, &found.adopted).map_err(|why| why.to_string())?;
    if !mends {
        return Ok(machine_edit(scenario, &built));
    }
    let mended = found.correction.as_ref().map_err(ToString::to_string)?;
    let machine = corrected_as_built(&built, measured, mended).map_err(|why| why.to_string())?;
    Ok(machine_edit(scenario, &machine))
}
