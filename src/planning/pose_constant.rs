//! A machine's pose constant: whether there is a b, in words, and the queries that make its poses' coordinates once.

use std::sync::Arc;

use thiserror::Error;

use crate::mechanics::machine::{Inertia, Machine};
use crate::mechanics::planar::Vector;
use crate::planning::common::common;
use crate::planning::pose_space::{NoPoseSpace, PoseSpace, is_reactionless};
use crate::planning::reactionless::BSet;
use crate::query::{Quick, Same};

pub use crate::planning::unreachable::{Mend, NoCommon, ShownMend, Unreachable};

/// The pose space of a machine, or why its b cannot be held.
pub struct SpaceOf;

impl Quick for SpaceOf {
    type Input = Machine;
    type Answer = Result<Arc<PoseSpace>, NoPoseSpace>;

    fn answer(machine: &Machine) -> Self::Answer {
        PoseSpace::of(machine).map(Arc::new)
    }
}

/// The b that serve all of several points, m, and those of each; none where there are none.
pub struct BOfPoints;

/// What [`BOfPoints`] answers.
#[derive(Clone, Debug, PartialEq)]
pub struct Serving {
    /// Of each point.
    pub each: Vec<Option<BSet>>,
    /// Of all of them.
    pub all: Option<BSet>,
}

impl Quick for BOfPoints {
    /// A pose space, and the points.
    type Input = (Same<PoseSpace>, Vec<Vector>);
    type Answer = Serving;

    fn answer((Same(space), points): &Self::Input) -> Serving {
        Serving { each: points.iter().map(|p| space.reach(*p).ok()).collect(), all: common(space, points) }
    }
}

/// Whether a machine has a pose constant b = Σ λ_k q_k, asked here alone.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PoseConstant {
    /// Holding b keeps every moment from the base.
    #[error("b = Σ λ_k q_k")]
    Exact,
    /// λ depends on the pose so little that holding b keeps most of the moment from the base.
    #[error(
        "b = Σ λ_k q_k, but only nearly: couplings of up to {residual:.1e} kg m² remain, so holding b is not exactly \
         reactionless; `stillbase design` removes them"
    )]
    Nearly {
        /// Largest |C_kl|, kg m².
        residual: f64,
    },
    /// None, and none is needed.
    #[error("none is needed: every motion is reactionless, as no drive turns the base")]
    Unneeded,
    /// None.
    #[error("none: {0}")]
    None(NoPoseSpace),
}

impl PoseConstant {
    /// Of a machine.
    pub fn of(machine: &Machine) -> Self {
        match PoseSpace::general(machine) {
            Ok(_) if is_reactionless(machine) => Self::Exact,
            Ok(_) => Self::Nearly { residual: Inertia::of(machine).invariance_residual() },
            Err(NoPoseSpace::Free) => Self::Unneeded,
            Err(why) => Self::None(why),
        }
    }

    /// In a word, for a key of JSON.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Nearly { .. } => "nearly",
            Self::Unneeded => "unneeded",
            Self::None(_) => "none",
        }
    }
}
