//! What leads a machine, and what a simulation of it is made of.

use std::sync::Arc;

use crate::mechanics::machine::Machine;
use crate::planning::following::Follower;
use crate::planning::{Motion, Reference};
use crate::simulation::control::Control;
use crate::simulation::plant::{Base, PlantDifferences};

/// What leads the machine.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant, reason = "each simulation has one, and reads it in every step")]
pub enum Guide {
    /// A planned motion that began at a time, s.
    Motion {
        /// The plan; copies of a run share it.
        motion: Arc<Motion>,
        /// s.
        start: f64,
    },
    /// The pointer and the slider.
    Follow(Follower),
}

impl Guide {
    /// The reference at a time, s.
    pub(super) fn at(&self, time: f64) -> Reference {
        match self {
            Self::Motion { motion, start } => motion.at(time - start),
            Self::Follow(follower) => follower.reference(0.0),
        }
    }
}

/// What a simulation is made of.
#[derive(Clone, Copy, Debug)]
pub struct Setup<'a> {
    /// The machine that control believes in.
    pub model: &'a Machine,
    /// What differs in the machine that moves.
    pub plant: &'a PlantDifferences,
    /// What it stands on.
    pub base: &'a Base,
    /// How the motors are controlled.
    pub control: &'a Control,
    /// Fixed step, s.
    pub step: f64,
}
