//! [`Joints`]: the pose-independent part of the pin force computation.

use super::error::JointsError;
use super::pins::{MAX_PINS, Pin, pins};
use super::structure;
use super::transmission::{self, Parallelogram};
use super::tree::{CutClosure, SolveStep, Stator, TreeLink};
use crate::machine::Machine;

/// The pins of a machine, with all constants of the machine that their forces depend on.
#[derive(Clone, Debug)]
pub struct Joints {
    pub(super) drives: usize,
    pub(super) pins: Vec<Pin>,
    pub(super) links: Vec<TreeLink>,
    pub(super) closures: Vec<CutClosure>,
    /// The two links of each pin that has friction; these links follow different drives.
    pub(super) rubbing: Vec<(usize, usize)>,
    pub(super) steps: Vec<SolveStep>,
    pub(super) parallelograms: Vec<Parallelogram>,
    /// Motors with rotors or in joints, each before the motor of the drive that carries it.
    pub(super) stators: Vec<Stator>,
}

impl Joints {
    /// Reads the structure of a machine.
    ///
    /// # Errors
    /// If there are more than [`MAX_PINS`] pins, if a motor joins two loops, or if statics does not determine the
    /// forces: too many or too few closures, or a drive that could turn any of several links.
    pub fn of(machine: &Machine) -> Result<Self, JointsError> {
        let pins = pins(machine);
        if pins.len() > MAX_PINS {
            return Err(JointsError::TooMany { count: pins.len() });
        }
        let links = structure::links(machine)?;
        let mut closures = structure::closures(machine, &links);
        let steps = structure::steps(machine, &links, &closures)?;
        structure::mark_dependent_pins(&links, &mut closures, &steps);
        let stators = structure::stators(machine, &links, &closures)?;
        let parallelograms = transmission::parallelograms(&pins[machine.links().len()..], &links, &closures);
        let place = |link: usize| links.iter().position(|l| l.link == link);
        let sides = pins.iter().filter_map(|pin| Some((place(pin.from?)?, place(pin.to)?)));
        let rubbing = sides.filter(|(a, b)| links[*a].drive != links[*b].drive).collect();
        Ok(Self { drives: machine.drives(), pins, links, closures, rubbing, steps, parallelograms, stators })
    }

    /// Returns the pins: the attachments of the links, in the order of links, then the closures.
    pub fn pins(&self) -> &[Pin] {
        &self.pins
    }

    /// Returns the closures that are parallelograms of two drives.
    pub fn parallelograms(&self) -> &[Parallelogram] {
        &self.parallelograms
    }
}
