//! The edits with which a session takes what a measurement says.

use super::mend::{Mended, NoMend, identified};
use super::taken::Taken;
use crate::mechanics::planar::Vector;
use crate::session::Edit;
use crate::session::design::becoming;
use crate::session::scenario::Scenario;

impl Mended {
    /// The edit with which the machine of a session is mended; none where nothing changes.
    pub fn edit(&self, scenario: &Scenario) -> Option<Edit> {
        becoming(scenario, &self.machine)
    }
}

/// The edit with which the machine of a session has what was measured of balance, before anything mends it, none where it
/// has; and what no such change makes of each line of (7) and (8).
///
/// # Errors
/// If no such machine can be.
pub fn as_measured(scenario: &Scenario, taken: &Taken) -> Result<(Option<Edit>, Vec<Vector>), NoMend> {
    let (machine, misses) = identified(&scenario.machine, taken)?;
    Ok((becoming(scenario, &machine), misses))
}
