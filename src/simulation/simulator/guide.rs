//! The source of the reference, and the setup of a simulation.

use std::sync::Arc;

use crate::control::Control;
use crate::plant::{Base, PlantDifferences};
use stillbase_mechanics::machine::Machine;
use stillbase_mechanics::planar::Pose2;
use stillbase_planning::following::{Follower, MomentumFollower};
use stillbase_planning::{Motion, Reference};

/// Source of the reference.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant, reason = "each simulation has one, and reads it in every step")]
pub enum Guide {
    /// A planned motion.
    Motion {
        /// The plan; copies of a run share it.
        motion: Arc<Motion>,
        /// Time at which it began, s.
        start: f64,
        /// Where the base is at its end, if the plan accounts for how it moves; otherwise it takes the base to stand
        /// still.
        base_end: Option<Pose2>,
    },
    /// A follower of the pointer and of the slider b.
    Follow(Follower),
    /// A follower of the pointer at zero angular momentum, for machines without b.
    Lead(MomentumFollower),
}

impl Guide {
    /// Returns the reference at a time, s.
    pub(super) fn at(&self, time: f64) -> Reference {
        match self {
            Self::Motion { motion, start, .. } => motion.at(time - start),
            Self::Follow(follower) => follower.reference(0.0),
            Self::Lead(follower) => follower.reference(0.0),
        }
    }
}

/// Setup of a simulation.
#[derive(Clone, Copy, Debug)]
pub struct Setup<'a> {
    /// The machine as control models it.
    pub model: &'a Machine,
    /// Differences of the plant from the model.
    pub plant: &'a PlantDifferences,
    /// The base of the machine.
    pub base: &'a Base,
    /// Settings of control.
    pub control: &'a Control,
    /// Fixed step, s.
    pub step: f64,
}
