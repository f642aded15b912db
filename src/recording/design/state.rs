//! [`DesignState`]: the machine after a number of changes, with its balance and measures.

use crate::store::Instant;
use stillbase_mechanics::balance::Breakdown;
use stillbase_mechanics::machine::Machine;
use stillbase_picture::scene::linkage::LinkageModel;
use stillbase_planning::Motion;
use stillbase_session::DesignVersion;
use stillbase_study::measures::Measures;
use stillbase_study::workshop::cut_of;

/// A state of a design.
#[derive(Debug)]
pub struct DesignState {
    /// Instant on the time lines.
    pub at: Instant,
    /// The machine, and the change that led to it.
    pub of: DesignVersion,
    /// Body of the machine, with the dimensions of its design.
    pub linkage: LinkageModel,
    /// Contributions of the machine's parts to (7) and (8).
    pub breakdown: Breakdown,
    /// Cost of balance relative to a reference machine, with words that say which machine it is.
    pub measures: Option<(&'static str, Measures)>,
}

impl DesignState {
    /// Returns the state of a design; `first` is the machine at the start, `motion` the motion of the task.
    pub fn of(at: Instant, of: DesignVersion, first: &Machine, motion: &Motion) -> Self {
        let linkage = LinkageModel::cut(&of.machine, &cut_of(&of.brief, &of.machine));
        Self { at, linkage, breakdown: Breakdown::of(&of.machine), measures: measured(&of, first, motion), of }
    }
}

/// Returns the cost of balance relative to the machine without counterweights, as in the window. A machine without
/// counterweights is compared with the machine at the start.
fn measured(of: &DesignVersion, first: &Machine, motion: &Motion) -> Option<(&'static str, Measures)> {
    let motion = Some(motion);
    match bare(&of.machine) {
        Some(bare) => Some(("compared with it without counterweights", Measures::of(&bare, &of.machine, motion))),
        None if of.changes > 0 => Some(("compared with the start", Measures::of(first, &of.machine, motion))),
        None => None,
    }
}

/// Returns a machine without its counterweights that are not fixed, if it has any.
pub fn bare(machine: &Machine) -> Option<Machine> {
    machine.without_counterweights().ok().filter(|bare| bare != machine)
}
