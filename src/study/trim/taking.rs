//! The edits with which a session takes what a measurement says.

use toml::{Table, Value};

use super::mend::{Mended, NoMend, identified};
use super::taken::Taken;
use crate::mechanics::machine::Machine;
use crate::mechanics::planar::Vector;
use crate::session::Edit;
use crate::session::design::weights_of;
use crate::session::scenario::Scenario;
use crate::settings::change::{at, join};

impl Mended {
    /// The edit with which the machine of a session is mended; none where nothing changes.
    pub fn edit(&self, scenario: &Scenario) -> Option<Edit> {
        let links = links_of(&scenario.machine, &self.machine);
        let same = scenario.machine.spec().counterweights == self.machine.spec().counterweights;
        let change = match weights_of(scenario, &self.machine) {
            Edit::Set { change } if !same => join(links, &change),
            _ => links,
        };
        (!change.is_empty()).then_some(Edit::Set { change })
    }
}

/// The edit with which the machine of a session has what was measured of balance, before anything mends it, none where it
/// has; and what no such change makes of each line of (7) and (8).
///
/// # Errors
/// If no such machine can be.
pub fn as_measured(scenario: &Scenario, taken: &Taken) -> Result<(Option<Edit>, Vec<Vector>), NoMend> {
    let (machine, misses) = identified(&scenario.machine, taken)?;
    let change = links_of(&scenario.machine, &machine);
    Ok(((!change.is_empty()).then_some(Edit::Set { change }), misses))
}

/// What a machine's links differ in from those of another with the same links.
fn links_of(machine: &Machine, of: &Machine) -> Table {
    let both = machine.spec().links.iter().zip(&of.spec().links);
    let differences = both.flat_map(|(was, is)| {
        let numbers = [
            ("mass", was.mass, is.mass),
            ("com", was.com, is.com),
            ("com_normal", was.com_normal, is.com_normal),
            ("inertia", was.inertia, is.inertia),
        ];
        let changed = numbers.into_iter().filter(|(_, was, is)| was != is);
        changed.map(|(what, _, is)| at(&["link", &was.name, what], Value::from(is)))
    });
    differences.fold(Table::new(), |all, one| join(all, &one))
}
