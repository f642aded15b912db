//! The pins of a machine with their names. They are listed even if statics does not determine their forces.

use crate::machine::{Chain, Machine};

/// Maximum number of pins of a machine whose forces are computed.
pub const MAX_PINS: usize = 32;

/// Smallest |sin(q_k − q_l)| at which the forces of a parallelogram are defined. At this value, rounding alone causes
/// relative errors of 1e-7.
pub const FLAT_SINE: f64 = 1e-9;

/// A pin or bearing.
#[derive(Clone, Debug, PartialEq)]
pub struct Pin {
    /// Names of its two links: `B-1`, `1-5`, `6-7`.
    pub name: String,
    /// The link that exerts the force; `None` for the base.
    pub from: Option<usize>,
    /// The link that the force acts on.
    pub to: usize,
    /// Position of the pin, m, as weights of the drives' unit vectors.
    pub at: Chain,
    /// Whether it closes a loop; otherwise it attaches a link.
    pub closes: bool,
}

/// Returns the pins: the attachments of the links, in the order of links, then the closures.
pub(super) fn pins(machine: &Machine) -> Vec<Pin> {
    let name = |link: Option<usize>| link.map_or("B", |j| machine.links()[j].name.as_str());
    let mut pins: Vec<Pin> = Vec::with_capacity(machine.links().len() + machine.loops().len());
    let attached = machine.resolved_links().iter().enumerate().map(|(j, part)| (part.parent, j, part.root, false));
    let closed = machine.loops().iter().map(|c| (Some(c.a), c.b, machine.resolved_links()[c.a].point(c.at_a), true));
    for (from, to, at, closes) in attached.chain(closed) {
        let mut called = format!("{}-{}", name(from), name(Some(to)));
        // Two pins between the same links need two names.
        while pins.iter().any(|p| p.name == called) {
            called.push('\'');
        }
        pins.push(Pin { name: called, from, to, at, closes });
    }
    pins
}
