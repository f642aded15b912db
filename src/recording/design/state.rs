//! [`State`]: the machine after so many changes, and what is said of it.

use crate::mechanics::balance::Breakdown;
use crate::mechanics::machine::{Machine, MachineSpec};
use crate::planning::Motion;
use crate::recording::store::Instant;
use crate::session::Designed;
use crate::study::measures::Measures;

/// A state of a design.
#[derive(Debug)]
pub struct State {
    /// Where it stands on the time lines.
    pub at: Instant,
    /// The machine, and how it came about.
    pub of: Designed,
    /// What its parts bring to (7) and (8).
    pub breakdown: Breakdown,
    /// What balance has cost beside another machine, and which that is.
    pub measures: Option<(&'static str, Measures)>,
}

impl State {
    /// Of a design that began with a machine, and its task's motion.
    pub fn of(at: Instant, of: Designed, first: &Machine, motion: &Motion) -> Self {
        Self { at, breakdown: Breakdown::of(&of.machine), measures: measured(&of, first, motion), of }
    }
}

/// What balance has cost: beside the machine without its counterweights, as in the window, else beside that of the start.
fn measured(of: &Designed, first: &Machine, motion: &Motion) -> Option<(&'static str, Measures)> {
    let motion = Some(motion);
    match bare(&of.machine) {
        Some(bare) => Some(("beside it without discs", Measures::of(&bare, &of.machine, motion))),
        None if of.changes > 0 => Some(("beside the start", Measures::of(first, &of.machine, motion))),
        None => None,
    }
}

/// A machine without its counterweights, if it has some.
pub fn bare(machine: &Machine) -> Option<Machine> {
    if machine.spec().counterweights.is_empty() {
        return None;
    }
    Machine::new(MachineSpec { counterweights: Vec::new(), ..machine.spec().clone() }).ok()
}
