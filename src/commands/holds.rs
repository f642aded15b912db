//! `--fix`, `--free` and `--bound`: parameters that may change to achieve balance, and their bounds.

use stillbase_mechanics::balance::{Parameter, ParameterBounds, RebalanceRequest};
use stillbase_mechanics::machine::Machine;

use super::ends::named;
use super::failure::Failure;

/// Parses KEY=LO,HI, m or kg.
pub fn bound(text: &str) -> Result<(String, [f64; 2]), String> {
    named(text).ok_or_else(|| "want KEY=LO,HI in m or kg, as 2.com=-0.3,0.1".to_owned())
}

/// Sets in the request `request` which parameters are fixed, free or bounded.
///
/// # Errors
/// If a key names no parameter, or a parameter is named twice.
pub fn apply_bounds(
    request: &mut RebalanceRequest,
    machine: &Machine,
    fix: &[String],
    free: &[String],
    bound: &[(String, [f64; 2])],
) -> Result<(), Failure> {
    let (fixed, free) =
        (fix.iter().map(|key| (key, ParameterBounds::Fixed)), free.iter().map(|key| (key, ParameterBounds::Free)));
    let bounds = bound.iter().map(|(key, ends)| (key, ParameterBounds::Within(*ends)));
    let mut seen = Vec::new();
    for (key, hold) in fixed.chain(free).chain(bounds) {
        let parameter = find(machine, key)?;
        if seen.contains(&parameter) {
            return Err(Failure::wrong_input(format!("{key} is held in two ways: want one of --fix, --free, --bound")));
        }
        seen.push(parameter);
        request.set_bounds(machine, parameter, hold);
    }
    Ok(())
}

fn find(machine: &Machine, key: &str) -> Result<Parameter, Failure> {
    let (key, link) = (key.trim(), format!("link.{}", key.trim()));
    let mut all = Parameter::all(machine).into_iter();
    let found = all.find(|parameter| [key, link.as_str()].contains(&parameter.key(machine).as_str()));
    found.ok_or_else(|| {
        let why = match machine.spec().counterweights.is_empty() {
            true => "want mass, com or com_normal of a link, as 3.com; this machine has no [[counterweight]]",
            false => {
                "want mass, com or com_normal of a link, as 3.com, or mass or at of a counterweight, as \
                 counterweight.1.at"
            }
        };
        Failure::wrong_input(format!("no parameter {key:?} of this machine affects its balance: {why}"))
    })
}
