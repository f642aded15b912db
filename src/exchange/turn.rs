//! [`Turn`]: an angle of a machine as a sum of the angles in its pins.

use crate::mechanics::machine::Machine;

/// Σ ± the angles in the pins that hold links. The angle in the pin at the root of a link is that from the drive of the
/// link it hangs on to its own; on the base, from its x axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Turn {
    /// Links by number, each with 1 or −1.
    pub pins: Vec<(usize, f64)>,
}

impl Turn {
    /// From the drive of one link to that of another; none: from the x axis of the base.
    pub fn between(machine: &Machine, from: Option<usize>, to: usize) -> Self {
        let (down, up) = (pins(machine, Some(to)), pins(machine, from));
        // What holds both turns neither against the other.
        let shared = down.iter().rev().zip(up.iter().rev()).take_while(|(a, b)| a == b).count();
        let kept = |list: &[usize]| list[..list.len() - shared].to_vec();
        let down = kept(&down).into_iter().rev().map(|j| (j, 1.0));
        let up = kept(&up).into_iter().map(|j| (j, -1.0));
        Self { pins: down.chain(up).collect() }
    }

    /// Of a drive against another, q_to − q_from; none: against the base, q_to. A link of the one on a link of the other is
    /// preferred.
    pub fn of_drives(machine: &Machine, from: Option<usize>, to: usize) -> Option<Self> {
        let parts = machine.resolved_links();
        let first = |k: usize| parts.iter().position(|part| part.drive == k);
        let is_pair = |j: usize| parts[j].drive == to && parts[j].parent.map(|p| parts[p].drive) == from;
        let there = (0..parts.len()).find(|j| is_pair(*j));
        let to = there.or_else(|| first(to))?;
        let from = match from {
            Some(k) => Some(there.and_then(|j| parts[j].parent).map_or_else(|| first(k), Some)?),
            None => None,
        };
        Some(Self::between(machine, from, to))
    }

    /// The one pin that turns by just this, if there is one.
    pub fn pin(&self) -> Option<usize> {
        match self.pins[..] {
            [(pin, 1.0)] => Some(pin),
            _ => None,
        }
    }
}

/// The pins that hold a link, from its own to that on the base.
fn pins(machine: &Machine, link: Option<usize>) -> Vec<usize> {
    std::iter::successors(link, |j| machine.resolved_links()[*j].parent).collect()
}
