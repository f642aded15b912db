//! [`CounterweightSpec`]: a request for counterweights.

use super::refusal::CounterweightError;
use super::stock::CounterweightStock;
use super::subject::Subject;
use crate::machine::{Machine, ranges};
use stillbase_settings::range::Range;

/// Bounds of position and mass of a counterweight on a link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CounterweightSite {
    /// The link, counted from 0; of an assembly through the links of all blocks, in their order.
    pub link: usize,
    /// Lower bound of its position along the axis, m from the root, positive towards the tip.
    pub from: f64,
    /// Upper bound of its position, m.
    pub to: f64,
    /// Greatest distance of its centre from the link's axis, to either side, m; 0 if it must lie on the axis.
    pub across: f64,
    /// Upper bound of its mass, kg; infinite for no bound.
    pub most: f64,
}

impl CounterweightSite {
    /// Allows a counterweight of any mass on the axis of every link, from one link length behind the root to the tip.
    pub fn anywhere(machine: &Machine) -> Vec<Self> {
        let parts = machine.resolved_links().iter().enumerate();
        parts.map(|(link, part)| Self::on_axis(link, -part.length, part.length)).collect()
    }

    /// Allows a counterweight of any mass on the axis of a link, in a range of positions, m from the root.
    pub const fn on_axis(link: usize, from: f64, to: f64) -> Self {
        Self { link, from, to, across: 0.0, most: f64::INFINITY }
    }
}

/// The objective that is minimised: a weighted sum.
#[derive(Clone, Debug, PartialEq)]
pub struct Objective {
    /// Weight of the added mass, 1/kg.
    pub mass: f64,
    /// Weight of Σ H_kk, 1/(kg m²). Without gears and rotors, Σ H_kk is Σ D_k.
    pub inertia: f64,
    /// Weight of Σ |D_k|, 1/(kg m²), which measures the moment on the base. Rotors that turn against their drives
    /// reduce the moment.
    pub momentum: f64,
    /// Weight of the greatest torque, 1/(N m).
    pub torque: f64,
    /// Greatest |q̈_k| of each drive in the motion, rad/s², from which the torque is computed; of an assembly the drives of
    /// all blocks, in their order.
    pub accelerations: Vec<f64>,
}

impl Objective {
    /// Minimises the added mass.
    pub fn mass() -> Self {
        Self { mass: 1.0, inertia: 0.0, momentum: 0.0, torque: 0.0, accelerations: Vec::new() }
    }

    /// Minimises Σ H_kk.
    pub fn inertia() -> Self {
        Self { inertia: 1.0, mass: 0.0, ..Self::mass() }
    }

    /// Returns whether it depends on more than mass.
    pub(super) fn depends_on_inertia(&self) -> bool {
        self.inertia > 0.0 || self.momentum > 0.0 || self.torque > 0.0
    }
}

/// The free parameter of a motor's rotor. The other parameter keeps its value in the machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RotorFreedom {
    /// Inertia, kg m², with lower and upper bound.
    Inertia([f64; 2]),
    /// Gear ratio, with lower and upper bound: rotor turns for one turn of the drive, negative if the gear reverses.
    Ratio([f64; 2]),
}

/// A rotor with a free parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeRotor {
    /// The drive whose motor has the rotor, counted from 0; of an assembly through the drives of all blocks.
    pub drive: usize,
    /// The free parameter.
    pub parameter: RotorFreedom,
}

/// A request for counterweights.
#[derive(Clone, Debug, PartialEq)]
pub struct CounterweightSpec {
    /// Links that may carry a counterweight.
    pub sites: Vec<CounterweightSite>,
    /// Material of the counterweights.
    pub stock: CounterweightStock,
    /// The objective that is minimised.
    pub objective: Objective,
    /// Upper bound of the added mass, kg.
    pub max_added_mass: Option<f64>,
    /// Upper bound of Σ D_k, kg m².
    pub max_inertia: Option<f64>,
    /// Clearance between the edge of a counterweight and the centre of every pin of its link, m; `None`: it may cover
    /// pins. Half a ring and a box count as the rectangle around them. A pin may lie in the bore of a ring, and on the
    /// axis also in the bore of half a ring.
    pub clearance: Option<f64>,
    /// Rotors with a free parameter, which is optimised with the counterweights.
    pub rotors: Vec<FreeRotor>,
    /// Smallest and largest mass of the payload, kg. The largest residual of (7) and (8) over this range is minimised
    /// before the objective. `None`: the payload of the machine. An assembly has none.
    pub payload: Option<[f64; 2]>,
}

/// Range of the distance by which a counterweight may lie off its link's axis.
pub const ACROSS_RANGE: Range = Range::new(0.0, 1e3, "m");
const CLEARANCE: Range = Range::new(0.0, 1e3, "m");

impl CounterweightSpec {
    /// Makes a request that minimises an objective, without bounds other than those of the sites.
    pub fn least(objective: Objective, sites: Vec<CounterweightSite>, stock: CounterweightStock) -> Self {
        let (max_added_mass, max_inertia, clearance, payload) = (None, None, None, None);
        Self { sites, stock, objective, max_added_mass, max_inertia, clearance, rotors: Vec::new(), payload }
    }

    /// Checks that the request is valid for a machine, or for an assembly.
    pub(super) fn check(&self, subject: &Subject) -> Result<(), CounterweightError> {
        let within = |what: &str, value: f64, range: Range| match range.contains(value) {
            true => Ok(()),
            false => Err(CounterweightError::out(what, value, range)),
        };
        let positive = |what: &str, value: Option<f64>| match value {
            Some(value) if !(value.is_finite() && value > 0.0) => {
                Err(CounterweightError::out(what, value, "a number above 0"))
            }
            _ => Ok(()),
        };
        self.stock.check()?;
        positive("the most Σ D_k may be, kg m²,", self.max_inertia)?;
        positive("the most that may be added, kg,", self.max_added_mass)?;
        if let Some(clearance) = self.clearance {
            within("clearance", clearance, CLEARANCE)?;
        }
        let Objective { mass, inertia, momentum, torque, .. } = self.objective;
        for (what, value) in [("mass", mass), ("inertia", inertia), ("momentum", momentum), ("torque", torque)] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(CounterweightError::out(&format!("the weight of {what}"), value, "a number not below 0"));
            }
        }
        if let Some(ends) = self.payload {
            rising("a payload", ends, ranges::LOAD)?;
            if subject.goals.is_some() {
                return Err(CounterweightError::PayloadOfAssembly);
            }
        }
        for (j, site) in self.sites.iter().enumerate() {
            if subject.whole.link_at(site.link).is_none() {
                let want = "one of the links, counted from 0";
                return Err(CounterweightError::out("link number", site.link as f64, want));
            }
            let link = subject.link_name(site.link);
            let bad = |what: &str, value, want: &str| {
                Err(CounterweightError::out(&format!("link {link}: {what}"), value, want))
            };
            if let Some(end) = [site.from, site.to].into_iter().find(|x| !x.is_finite()) {
                return bad("a range that ends at", end, "finite places, m");
            }
            if !ACROSS_RANGE.contains(site.across) {
                return bad("off the axis by up to, m,", site.across, &ACROSS_RANGE.to_string());
            }
            if site.from > site.to {
                return bad("a range up to", site.to, "an end not below its start");
            }
            if site.most.is_nan() || site.most <= 0.0 {
                return bad("at most, kg,", site.most, "a mass above 0");
            }
            if self.sites[..j].iter().any(|other| other.link == site.link) {
                return Err(CounterweightError::Twice(link));
            }
        }
        self.check_rotors(subject)
    }

    fn check_rotors(&self, subject: &Subject) -> Result<(), CounterweightError> {
        let blocks = subject.whole.blocks().iter().enumerate();
        let drives: Vec<_> =
            blocks.flat_map(|(i, block)| block.machine.spec().drives.iter().map(move |drive| (i, drive))).collect();
        for (i, FreeRotor { drive, parameter }) in self.rotors.iter().enumerate() {
            let Some((block, of)) = drives.get(*drive).copied() else {
                let want = "one of the drives, counted from 0";
                return Err(CounterweightError::out("drive number", *drive as f64, want));
            };
            let name = subject.name(block, &of.name);
            if self.rotors[..i].iter().any(|other| other.drive == *drive) {
                return Err(CounterweightError::RotorTwice(name));
            }
            let what = format!("the rotor of drive {name}:");
            match parameter {
                RotorFreedom::Inertia(ends) => rising(&format!("{what} inertia"), *ends, ranges::INERTIA)?,
                RotorFreedom::Ratio(ends) => rising(&format!("{what} ratio"), *ends, ranges::RATIO)?,
            }
            if matches!(parameter, RotorFreedom::Ratio(_)) && of.rotor.is_none_or(|rotor| rotor.inertia == 0.0) {
                return Err(CounterweightError::NoRotor(name));
            }
        }
        Ok(())
    }
}

/// Checks that two bounds are in a range, the first not above the second.
fn rising(what: &str, [low, high]: [f64; 2], range: Range) -> Result<(), CounterweightError> {
    if let Some(end) = [low, high].into_iter().find(|end| !range.contains(*end)) {
        return Err(CounterweightError::out(what, end, range));
    }
    match low <= high {
        true => Ok(()),
        false => Err(CounterweightError::out(&format!("{what} up to"), high, "an end not below its start")),
    }
}
