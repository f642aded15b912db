//! [`off_by`]: what counterweights leave of balance when they are made and fixed only so well.

use serde::Serialize;

use crate::mechanics::balance::Condition;
use crate::mechanics::machine::Machine;

/// How far a counterweight may be from what is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Its mass, of itself: 0.01 is one in a hundred.
    pub mass: f64,
    /// Its place, m.
    pub place: f64,
}

impl Tolerance {
    /// One in a hundred, and half a millimetre.
    pub const USUAL: Self = Self { mass: 0.01, place: 5e-4 };
}

/// The worst that is left of (7) and (8).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OffBy {
    /// The greatest |g_k|, kg m.
    pub force: f64,
    /// The greatest |C_kl|, kg m².
    pub coupling: f64,
}

/// What is left at worst of a balanced machine whose counterweights are all as far off as they may be, each the way that
/// adds up. To first order: products of what is off are left out.
pub fn off_by(machine: &Machine, tolerance: &Tolerance) -> OffBy {
    let mut worst = OffBy { force: 0.0, coupling: 0.0 };
    for condition in Condition::all(machine.drives()) {
        let each = machine.spec().counterweights.iter().filter_map(|weight| {
            let link = machine.links().iter().position(|link| link.name == weight.link)?;
            let part = &machine.resolved_links()[link];
            let (by_mass, by_moment) = (condition.by_mass(part), condition.by_moment(part));
            let of_mass = tolerance.mass * weight.mass * (by_mass + weight.at * by_moment).abs();
            Some(of_mass + tolerance.place * weight.mass * by_moment.abs())
        });
        let sum: f64 = each.sum();
        match condition {
            Condition::Force(_) => worst.force = worst.force.max(sum),
            Condition::Coupling(..) => worst.coupling = worst.coupling.max(sum),
        }
    }
    worst
}
