//! [`PinAngleSum`]: an angle between links as a sum of pin angles.

use stillbase_mechanics::machine::Machine;

/// A signed sum of pin angles. A link's root pin has the angle q of the link's drive, less that of its parent's drive.
/// On the base nothing is subtracted.
#[derive(Clone, Debug, PartialEq)]
pub struct PinAngleSum {
    /// For each pin, the index of the link at whose root it is, and its sign, 1 or −1.
    pub pins: Vec<(usize, f64)>,
}

impl PinAngleSum {
    /// Returns the angle from the drive of link `from` to that of link `to`; `None` is the x axis of the base.
    pub fn between(machine: &Machine, from: Option<usize>, to: usize) -> Self {
        let (down, up) = (pins(machine, Some(to)), pins(machine, from));
        // Pins that both chains share cancel.
        let shared = down.iter().rev().zip(up.iter().rev()).take_while(|(a, b)| a == b).count();
        let kept = |list: &[usize]| list[..list.len() - shared].to_vec();
        let down = kept(&down).into_iter().rev().map(|j| (j, 1.0));
        let up = kept(&up).into_iter().map(|j| (j, -1.0));
        Self { pins: down.chain(up).collect() }
    }

    /// Returns the angle q_to − q_from between two drives, or q_to if `from` is `None`; `None` if one
    /// of them has no link. A single pin between links of the two drives is preferred.
    pub fn of_drives(machine: &Machine, from: Option<usize>, to: usize) -> Option<Self> {
        let parts = machine.resolved_links();
        let first = |k: usize| parts.iter().position(|part| part.drive == k);
        let is_pair = |j: usize| parts[j].drive == to && parts[j].parent.and_then(|p| machine.drive_of_link(p)) == from;
        let there = (0..parts.len()).find(|j| is_pair(*j));
        let to = there.or_else(|| first(to))?;
        let from = match from {
            Some(k) => Some(there.and_then(|j| parts[j].parent).map_or_else(|| first(k), Some)?),
            None => None,
        };
        Some(Self::between(machine, from, to))
    }

    /// Returns the pin whose angle equals the sum, if the sum is a single pin with sign 1.
    pub fn pin(&self) -> Option<usize> {
        match self.pins[..] {
            [(pin, 1.0)] => Some(pin),
            _ => None,
        }
    }
}

/// Returns the pins from the root of a link down to the base, each as the index of the link at whose root it is.
fn pins(machine: &Machine, link: Option<usize>) -> Vec<usize> {
    std::iter::successors(link, |j| machine.resolved_links()[*j].parent).collect()
}
