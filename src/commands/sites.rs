//! `--range`: links that may carry a counterweight, and the bounds of its place.

use stillbase_mechanics::counterweights::CounterweightSite;
use stillbase_mechanics::machine::Machine;

use super::ends::named;
use super::failure::Failure;

/// Parses NAME=LO,HI, such as places on a link, m.
pub fn range(text: &str) -> Result<(String, [f64; 2]), String> {
    named(text).ok_or_else(|| "want NAME=LO,HI, as 1=-0.3,0.5".to_owned())
}

/// Returns the index of a link by its name.
///
/// # Errors
/// If there is no such link.
pub fn link(machine: &Machine, name: &str) -> Result<usize, Failure> {
    machine.spec().link_index(name).ok_or_else(|| {
        let known: Vec<_> = machine.links().iter().map(|link| link.name.as_str()).collect();
        Failure::wrong_input(format!("no link {name}: want one of {}", known.join(", ")))
    })
}

/// Returns the sites on the named links, up to `across`, m, off their axes. By default, these are all links, each from
/// one link length behind its root to its tip.
///
/// # Errors
/// If there is no such link.
pub fn sites(machine: &Machine, ranges: &[(String, [f64; 2])], across: f64) -> Result<Vec<CounterweightSite>, Failure> {
    if ranges.is_empty() {
        let anywhere = CounterweightSite::anywhere(machine).into_iter();
        return Ok(anywhere.map(|site| CounterweightSite { across, ..site }).collect());
    }
    let site = |(name, [from, to]): &(String, [f64; 2])| {
        Ok(CounterweightSite { across, ..CounterweightSite::on_axis(link(machine, name)?, *from, *to) })
    };
    ranges.iter().map(site).collect()
}
