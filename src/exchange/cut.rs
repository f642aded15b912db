//! [`Cut`]: of what and how links are cut.

use crate::mechanics::machine::Machine;
use crate::settings::number::{Short, fixed};

/// Bars, holes and discs as they are cut, and what discs are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// Of a bar, across, m; its ends are round.
    pub bar_width: f64,
    /// Of a hole for a pin, m.
    pub pin_diameter: f64,
    /// Of the discs, kg/m³.
    pub density: f64,
    /// Of the discs, m; none: as thick as each has to be for its mass.
    pub thickness: Option<f64>,
}

/// Why parts cannot be cut so.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CutError {
    /// A measure that is none.
    #[error("{what} {} {unit}: want a number from {} to {}", Short(*value), Short(*MEASURES.start()), Short(*MEASURES.end()))]
    Measure {
        /// Which.
        what: &'static str,
        /// As given.
        value: f64,
        /// Of it.
        unit: &'static str,
    },
    /// The hole is as wide as the bar.
    #[error(
        "holes of {} mm in bars {} mm wide: want bars wider than their holes",
        fixed(1e3 * diameter, 3),
        fixed(1e3 * width, 3)
    )]
    Narrow {
        /// Of the bar, m.
        width: f64,
        /// Of the hole, m.
        diameter: f64,
    },
    /// Two holes run into one.
    #[error(
        "two holes of link {link:?} are {} mm apart, {} mm across: want pins thinner than that",
        fixed(1e3 * apart, 3),
        fixed(1e3 * diameter, 3)
    )]
    Holes {
        /// The link.
        link: String,
        /// From centre to centre, m.
        apart: f64,
        /// Of the holes, m.
        diameter: f64,
    },
}

impl Default for Cut {
    /// Bars of 30 mm, pins of 8 mm, discs of steel.
    fn default() -> Self {
        Self { bar_width: 0.030, pin_diameter: 0.008, density: 7850.0, thickness: None }
    }
}

impl Cut {
    /// Refuses discs that cannot be cut.
    ///
    /// # Errors
    /// Which measure is wrong.
    pub fn check_discs(&self) -> Result<(), CutError> {
        measure("material", Some(self.density), "kg/m³")?;
        measure("thickness", self.thickness, "m")
    }

    /// Refuses what cannot be cut.
    ///
    /// # Errors
    /// Which measure is wrong, or which holes run into one.
    pub fn check(&self, machine: &Machine) -> Result<(), CutError> {
        self.check_discs()?;
        measure("bar width", Some(self.bar_width), "m")?;
        measure("pin diameter", Some(self.pin_diameter), "m")?;
        let (width, diameter) = (self.bar_width, self.pin_diameter);
        if diameter >= width {
            return Err(CutError::Narrow { width, diameter });
        }
        for (link, part) in machine.links().iter().zip(machine.resolved_links()) {
            let apart = part.pins.windows(2).map(|pins| pins[1] - pins[0]);
            // Descriptions of one pin differ by rounding.
            if let Some(apart) = apart.filter(|apart| *apart > SAME).find(|apart| *apart <= diameter) {
                return Err(CutError::Holes { link: link.name.clone(), apart, diameter });
            }
        }
        Ok(())
    }

    /// How thick a disc is, m; none for a point.
    pub fn thickness_of(&self, mass: f64, radius: f64) -> Option<f64> {
        (radius > 0.0).then(|| self.thickness.unwrap_or(mass / (self.density * disc_area(radius))))
    }

    /// What a disc weighs: its area by its thickness by its density, kg.
    pub fn weighs(&self, radius: f64, thickness: f64) -> f64 {
        disc_area(radius) * thickness * self.density
    }
}

/// Where measures may lie, in SI units.
const MEASURES: std::ops::RangeInclusive<f64> = 1e-6..=1e6;
/// Pins nearer than this are one, m.
pub const SAME: f64 = 1e-9;

fn measure(what: &'static str, value: Option<f64>, unit: &'static str) -> Result<(), CutError> {
    match value {
        Some(value) if !(MEASURES.contains(&value)) => Err(CutError::Measure { what, value, unit }),
        _ => Ok(()),
    }
}

fn disc_area(radius: f64) -> f64 {
    std::f64::consts::PI * radius * radius
}

/// Where the holes of a link are, m from its root, in rising order.
pub fn holes(machine: &Machine, j: usize) -> Vec<f64> {
    let mut holes = machine.resolved_links()[j].pins.clone();
    holes.dedup_by(|b, a| *b - *a <= SAME);
    holes
}

/// From where to where a bar goes, m from its root: over its length, all its pins, and to the discs that it carries.
pub fn ends(machine: &Machine, j: usize) -> [f64; 2] {
    let (link, part) = (&machine.links()[j], &machine.resolved_links()[j]);
    let discs = machine.spec().counterweights.iter().filter(|weight| weight.link == link.name).map(|weight| weight.at);
    let all = part.pins.iter().copied().chain(discs);
    all.fold([0.0, part.length], |[from, to], at| [at.min(from), at.max(to)])
}
