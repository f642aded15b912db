//! [`BrokenBound`]: a bound of a request that a machine does not keep, such as one whose counterweights are rounded.

use std::fmt;

use super::cell::DiscPlace;
use super::pin_sector::worst_pin;
use super::spec::CounterweightSpec;
use crate::machine::{Counterweight, Inertia, Machine};
use stillbase_settings::number::at_most_digits;

/// Part of a machine's longest link, heaviest counterweight or Σ D_k by which a bound may be exceeded.
const ROUNDING: f64 = 1e-8;

/// A bound that is not kept.
#[derive(Clone, Debug, PartialEq)]
pub struct BrokenBound {
    /// What is bounded, with its link.
    pub what: String,
    /// Its value.
    pub value: f64,
    /// The bound.
    pub bound: f64,
    /// Unit of both.
    pub unit: &'static str,
}

impl fmt::Display for BrokenBound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, value, bound, unit } = self;
        let side = if value > bound { "more than" } else { "less than" };
        write!(f, "{what} is {} {unit}, {side} {} {unit}", at_most_digits(*value, 7), at_most_digits(*bound, 7))
    }
}

impl CounterweightSpec {
    /// Returns the bounds that the counterweights of a machine do not keep. Fixed ones are not asked.
    pub fn broken_by(&self, machine: &Machine) -> Vec<BrokenBound> {
        let mut broken = Vec::new();
        let mut most = |what: String, value: f64, bound: f64, size: f64, unit| {
            if value > bound + ROUNDING * size {
                broken.push(BrokenBound { what, value, bound, unit });
            }
        };
        let longest = machine.resolved_links().iter().map(|link| link.length.abs()).fold(0.0, f64::max);
        let mut added = 0.0;
        let mut least = Vec::new();
        for weight in machine.spec().counterweights.iter().filter(|weight| !weight.fixed) {
            added += weight.mass;
            let Some(link) = machine.links().iter().position(|link| link.name == weight.link) else { continue };
            let Some(site) = self.sites.iter().find(|site| site.link == link) else { continue };
            let of = |what: &str| format!("link {}: {what}", weight.link);
            least.push((of("the place"), weight.at, site.from, longest));
            most(of("the place"), weight.at, site.to, longest, "m");
            most(of("the distance from its axis"), weight.across.abs(), site.across, longest, "m");
            most(of("the mass"), weight.mass, site.most, weight.mass, "kg");
            if let Some((missed, clearance)) = self.missed(machine, link, weight).zip(self.clearance) {
                least.push((of("the clearance of a pin"), clearance - missed, clearance, longest));
            }
        }
        if let Some(bound) = self.max_added_mass {
            most("the added mass".into(), added, bound, added, "kg");
        }
        if let Some(bound) = self.max_inertia {
            let total = Inertia::of(machine).total_momentum();
            most("Σ D_k".into(), total, bound, total, "kg m²");
        }
        let below = least.into_iter().filter(|(_, value, bound, size)| *value < bound - ROUNDING * size);
        broken.extend(below.map(|(what, value, bound, _)| BrokenBound { what, value, bound, unit: "m" }));
        broken
    }

    /// Returns by how much a counterweight misses the clearance of a pin at most, m; `None` if none is asked for.
    fn missed(&self, machine: &Machine, link: usize, weight: &Counterweight) -> Option<f64> {
        let (clearance, on_axis) = (self.clearance?, weight.across == 0.0);
        let place = DiscPlace { mass: weight.mass, at: weight.at, across: weight.across };
        let pins = machine.resolved_links()[link].pins.iter().copied();
        worst_pin(pins, clearance, &self.stock, place, on_axis).map(|(_, missed)| missed)
    }
}
