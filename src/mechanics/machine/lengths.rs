//! Access to lengths by key: named lengths, and lengths of links, which may share a named one.

use super::error::MachineError;
use super::model::Machine;
use super::spec::{Length, MachineSpec};
use stillbase_settings::range::{quote_clipped, shortened};

impl MachineSpec {
    /// Returns all lengths of a machine, m: named lengths by their names, and lengths of single links by the links'
    /// names.
    pub fn own_lengths(&self) -> impl Iterator<Item = (&str, f64)> {
        let named = self.lengths.iter().map(|(name, length)| (name.as_str(), *length));
        let alone = self.links.iter().filter_map(|link| match link.length {
            Length::Metres(length) => Some((link.name.as_str(), length)),
            Length::Named(_) => None,
        });
        named.chain(alone)
    }
}

/// Returns the i-th named length, m.
pub(super) fn length_at(machine: &Machine, i: usize) -> f64 {
    machine.spec().lengths.values().nth(i).copied().unwrap_or_default()
}

/// Sets the i-th named length, m, for all links that share it.
pub(super) fn set_length(spec: &mut MachineSpec, i: usize, metres: f64) -> Result<(), MachineError> {
    spec.lengths.values_mut().skip(i).take(1).for_each(|length| *length = metres);
    Ok(())
}

/// Returns the length of a link, m, shared or not.
pub(super) fn link_length(machine: &Machine, j: usize) -> f64 {
    machine.resolved_links()[j].length
}

/// Sets the length of a link, m.
///
/// # Errors
/// If other links share the length.
pub(super) fn set_link_length(spec: &mut MachineSpec, j: usize, metres: f64) -> Result<(), MachineError> {
    let name = match &mut spec.links[j].length {
        Length::Metres(l) => {
            *l = metres;
            return Ok(());
        }
        Length::Named(name) => name.clone(),
    };
    let others: Vec<&str> = spec
        .links
        .iter()
        .enumerate()
        .filter(|(i, l)| *i != j && l.length == Length::Named(name.clone()))
        .map(|(_, l)| l.name.as_str())
        .collect();
    if !others.is_empty() {
        let plural = if others.len() > 1 { "links" } else { "link" };
        return Err(MachineError::SharedLength {
            link: quote_clipped(&spec.links[j].name),
            length: quote_clipped(&name),
            sharers: format!("{plural} {}", shortened(&others.join(", "), 200)),
        });
    }
    spec.lengths.insert(name, metres);
    Ok(())
}
