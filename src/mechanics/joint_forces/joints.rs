//! [`Joints`]: what of the pins does not change with the pose.

use super::error::JointsError;
use super::pins::{MAX_PINS, Pin, pins};
use super::structure;
use super::transmission::{self, Parallelogram};
use super::tree::{CutClosure, SolveStep, Stator, TreeLink};
use crate::mechanics::machine::Machine;

/// The pins of a machine, and all of it that their forces depend on.
#[derive(Clone, Debug)]
pub struct Joints {
    pub(super) drives: usize,
    pub(super) pins: Vec<Pin>,
    pub(super) links: Vec<TreeLink>,
    pub(super) closures: Vec<CutClosure>,
    /// Links on both sides of each pin whose links follow different drives.
    pub(super) rubbing: Vec<(usize, usize)>,
    pub(super) steps: Vec<SolveStep>,
    pub(super) parallelograms: Vec<Parallelogram>,
    /// Motors with rotors or in joints, those before the drives that carry them.
    pub(super) stators: Vec<Stator>,
}

impl Joints {
    /// Reads the structure of a machine.
    ///
    /// # Errors
    /// If statics does not determine the forces: closures too many or too few, or a drive of which the file does not
    /// tell what link it turns.
    pub fn of(machine: &Machine) -> Result<Self, JointsError> {
        let pins = pins(machine);
        if pins.len() > MAX_PINS {
            return Err(JointsError::TooMany { count: pins.len() });
        }
        let links = structure::links(machine)?;
        let mut closures = structure::closures(machine, &links);
        let steps = structure::steps(machine, &links, &closures)?;
        structure::spread(&links, &mut closures, &steps);
        let stators = structure::stators(machine, &links, &closures)?;
        let parallelograms = transmission::parallelograms(&pins[machine.links().len()..], &links, &closures);
        let place = |link: usize| links.iter().position(|l| l.link == link);
        let sides = pins.iter().filter_map(|pin| Some((place(pin.from?)?, place(pin.to)?)));
        let rubbing = sides.filter(|(a, b)| links[*a].drive != links[*b].drive).collect();
        Ok(Self { drives: machine.drives(), pins, links, closures, rubbing, steps, parallelograms, stators })
    }

    /// The pins: where each link is attached, in the order of links, then the closures.
    pub fn pins(&self) -> &[Pin] {
        &self.pins
    }

    /// The closures that are parallelograms of two drives.
    pub fn parallelograms(&self) -> &[Parallelogram] {
        &self.parallelograms
    }
}
