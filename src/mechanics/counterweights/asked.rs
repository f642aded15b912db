//! [`Weighing`]: what is asked of counterweights.

use std::f64::consts::PI;

use super::refusal::NoWeights;
use crate::mechanics::machine::{Machine, ranges};
use crate::settings::range::Range;

/// Where a link may carry a counterweight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sites {
    /// The link, counted from 0.
    pub link: usize,
    /// Furthest back: m from the root along the axis, towards the tip above 0.
    pub from: f64,
    /// Furthest towards the tip, m.
    pub to: f64,
    /// The most it may weigh, kg; infinite for no bound.
    pub most: f64,
}

impl Sites {
    /// Every link, from its length behind the root to the tip, at any mass.
    pub fn anywhere(machine: &Machine) -> Vec<Self> {
        let parts = machine.resolved_links().iter().enumerate();
        parts.map(|(link, part)| Self { link, from: -part.length, to: part.length, most: f64::INFINITY }).collect()
    }
}

/// What the counterweights are made of: discs of one plate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// ρ, kg/m³.
    pub density: f64,
    /// t, m.
    pub thickness: f64,
}

/// Densities of what discs are usually made of, kg/m³.
pub const MATERIALS: [(&str, f64); 5] =
    [("aluminium", 2700.0), ("steel", 7850.0), ("brass", 8500.0), ("lead", 11_340.0), ("tungsten", 19_300.0)];

/// What a plate may be: no gas, and no foil from which a gram would be as wide as a room.
pub const DENSITY: Range = Range::new(1.0, 1e5, "kg/m³");
/// The same of its thickness.
pub const THICKNESS: Range = Range::new(1e-4, 1.0, "m");

impl Disc {
    /// Steel, 30 mm thick.
    pub const STEEL: Self = Self { density: 7850.0, thickness: 0.03 };

    /// Radius of a disc of a mass, m.
    pub fn radius(&self, mass: f64) -> f64 {
        self.spread() * mass.sqrt()
    }

    /// Mass of a disc of a radius, kg.
    pub fn mass(&self, radius: f64) -> f64 {
        (radius / self.spread()).powi(2)
    }

    /// Its radius for the root of its mass, 1/√(π ρ t), m/√kg.
    pub(super) fn spread(&self) -> f64 {
        1.0 / (PI * self.density * self.thickness).sqrt()
    }

    /// Its inertia for its mass squared, 1/(2 π ρ t), m²/kg.
    pub(super) fn own(&self) -> f64 {
        0.5 * self.spread().powi(2)
    }
}

/// What is to be least: a sum of these.
#[derive(Clone, Debug, PartialEq)]
pub struct Objective {
    /// For each kilogram added.
    pub mass: f64,
    /// For each kg m² that the drives turn, Σ H_kk: but for gears and rotors the same as Σ D_k.
    pub inertia: f64,
    /// For each kg m² of Σ |D_k|: what turning drives give to the base. Rotors that turn the other way make it less.
    pub momentum: f64,
    /// For each N m of the greatest torque.
    pub torque: f64,
    /// Greatest |q̈_k| of the motion whose torque counts, rad/s².
    pub accelerations: Vec<f64>,
}

impl Objective {
    /// The least added mass.
    pub fn mass() -> Self {
        Self { mass: 1.0, inertia: 0.0, momentum: 0.0, torque: 0.0, accelerations: Vec::new() }
    }

    /// The least Σ D_k.
    pub fn inertia() -> Self {
        Self { inertia: 1.0, mass: 0.0, ..Self::mass() }
    }

    /// Whether more than mass counts.
    pub(super) fn turns(&self) -> bool {
        self.inertia > 0.0 || self.momentum > 0.0 || self.torque > 0.0
    }
}

/// What may be chosen of the rotor of a motor. The other of the two is as the machine has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Free {
    /// Its inertia, kg m², from one to the other.
    Inertia([f64; 2]),
    /// How often it turns for one turn of its drive, from one to the other; below 0 the other way round.
    Ratio([f64; 2]),
}

/// A rotor of which something may be chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeRotor {
    /// Of the motor of this drive, counted from 0.
    pub drive: usize,
    /// What.
    pub free: Free,
}

/// What is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Weighing {
    /// Links that may carry a counterweight.
    pub sites: Vec<Sites>,
    /// What these are made of.
    pub disc: Disc,
    /// What is to be least.
    pub objective: Objective,
    /// The most that may be added, kg.
    pub most_mass: Option<f64>,
    /// The most that Σ D_k may be, kg m².
    pub most_inertia: Option<f64>,
    /// How far the edge of a disc stays from the middle of every pin of its link, m; none: discs may cover pins.
    pub clearance: Option<f64>,
    /// Rotors that may be chosen with them.
    pub rotors: Vec<FreeRotor>,
    /// The least and the greatest mass that the end effector holds, kg: the worst residual of (7) and (8) over all
    /// between comes before everything else; none: it holds what it holds.
    pub payload: Option<[f64; 2]>,
}

const CLEARANCE: Range = Range::new(0.0, 1e3, "m");

impl Weighing {
    /// The least of an objective, with no other bounds.
    pub fn least(objective: Objective, sites: Vec<Sites>, disc: Disc) -> Self {
        let (most_mass, most_inertia, clearance, payload) = (None, None, None, None);
        Self { sites, disc, objective, most_mass, most_inertia, clearance, rotors: Vec::new(), payload }
    }

    /// Whether it can be asked of a machine.
    pub(super) fn check(&self, machine: &Machine) -> Result<(), NoWeights> {
        let within = |what: &str, value: f64, range: Range| match range.contains(value) {
            true => Ok(()),
            false => Err(NoWeights::out(what, value, range)),
        };
        let positive = |what: &str, value: Option<f64>| match value {
            Some(value) if !(value.is_finite() && value > 0.0) => Err(NoWeights::out(what, value, "a number above 0")),
            _ => Ok(()),
        };
        within("density", self.disc.density, DENSITY)?;
        within("thickness", self.disc.thickness, THICKNESS)?;
        positive("the most Σ D_k may be, kg m²,", self.most_inertia)?;
        positive("the most that may be added, kg,", self.most_mass)?;
        if let Some(clearance) = self.clearance {
            within("clearance", clearance, CLEARANCE)?;
        }
        let Objective { mass, inertia, momentum, torque, .. } = self.objective;
        for (what, value) in [("mass", mass), ("inertia", inertia), ("momentum", momentum), ("torque", torque)] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(NoWeights::out(&format!("the weight of {what}"), value, "a number not below 0"));
            }
        }
        if let Some(ends) = self.payload {
            rising("a payload", ends, ranges::LOAD)?;
        }
        for (j, site) in self.sites.iter().enumerate() {
            let Some(link) = machine.links().get(site.link) else {
                let want = "one of the machine's links, counted from 0";
                return Err(NoWeights::out("link number", site.link as f64, want));
            };
            let bad = |what: &str, value, want: &str| {
                Err(NoWeights::out(&format!("link {}: {what}", link.name), value, want))
            };
            if let Some(end) = [site.from, site.to].into_iter().find(|x| !x.is_finite()) {
                return bad("a range that ends at", end, "finite places, m");
            }
            if site.from > site.to {
                return bad("a range up to", site.to, "an end not below its start");
            }
            if site.most.is_nan() || site.most <= 0.0 {
                return bad("at most, kg,", site.most, "a mass above 0");
            }
            if self.sites[..j].iter().any(|other| other.link == site.link) {
                return Err(NoWeights::Twice(link.name.clone()));
            }
        }
        self.check_rotors(machine)
    }

    fn check_rotors(&self, machine: &Machine) -> Result<(), NoWeights> {
        for (i, FreeRotor { drive, free }) in self.rotors.iter().enumerate() {
            let Some(of) = machine.spec().drives.get(*drive) else {
                let want = "one of the machine's drives, counted from 0";
                return Err(NoWeights::out("drive number", *drive as f64, want));
            };
            if self.rotors[..i].iter().any(|other| other.drive == *drive) {
                return Err(NoWeights::RotorTwice(of.name.clone()));
            }
            let what = format!("the rotor of drive {}:", of.name);
            match free {
                Free::Inertia(ends) => rising(&format!("{what} inertia"), *ends, ranges::INERTIA)?,
                Free::Ratio(ends) => rising(&format!("{what} ratio"), *ends, ranges::RATIO)?,
            }
            if matches!(free, Free::Ratio(_)) && of.rotor.is_none_or(|rotor| rotor.inertia == 0.0) {
                return Err(NoWeights::NoRotor(of.name.clone()));
            }
        }
        Ok(())
    }
}

/// Two ends in a range, the first not above the second.
fn rising(what: &str, [low, high]: [f64; 2], range: Range) -> Result<(), NoWeights> {
    if let Some(end) = [low, high].into_iter().find(|end| !range.contains(*end)) {
        return Err(NoWeights::out(what, end, range));
    }
    match low <= high {
        true => Ok(()),
        false => Err(NoWeights::out(&format!("{what} up to"), high, "an end not below its start")),
    }
}
