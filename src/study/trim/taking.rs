//! The edit with which a session takes what a measurement says.

use super::mend::{identified, trimmed};
use super::trimming::Trim;
use crate::mechanics::machine::Machine;
use crate::session::Edit;
use crate::session::design::becoming;
use crate::session::scenario::Scenario;

/// The edit with which the machine of a session becomes the one that was measured, as it stands or with what mends it; none
/// where it is that. `measured` is the machine as its file has it, of which the measurement was read.
///
/// # Errors
/// If the session has a machine with other links, or no such machine can be.
pub fn taken_by(scenario: &Scenario, measured: &Machine, found: &Trim, mends: bool) -> Result<Option<Edit>, String> {
    let names = |machine: &Machine| machine.links().iter().map(|link| link.name.clone()).collect::<Vec<_>>();
    if names(measured) != names(&scenario.machine) {
        return Err(format!("the measurement is of {}: open that machine, then the table again", measured.name()));
    }
    let (built, _) = identified(measured, &found.taken).map_err(|why| why.to_string())?;
    if !mends {
        return Ok(becoming(scenario, &built));
    }
    let mended = found.mended.as_ref().map_err(ToString::to_string)?;
    let machine = trimmed(&built, measured, mended).map_err(|why| why.to_string())?;
    Ok(becoming(scenario, &machine))
}
