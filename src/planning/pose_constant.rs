//! Existence of a machine's pose constant b, described in words; queries for its pose space and for the b that reach
//! points.

use std::fmt;
use std::sync::Arc;

use crate::common::common_b_set;
use crate::pose_space::{NoPoseSpace, PoseSpace, is_reactionless};
use crate::reactionless::BSet;
use stillbase_mechanics::machine::{Inertia, Machine};
use stillbase_mechanics::planar::Vector;
use stillbase_query::{ByIdentity, QuickQuery};

pub use crate::unreachable::{NoCommonB, PointCorrection, RoundedCorrection, Unreachable};

/// Query for the pose space of a machine, or the reason why it has none.
pub struct PoseSpaceQuery;

impl QuickQuery for PoseSpaceQuery {
    type Input = Machine;
    type Answer = Result<Arc<PoseSpace>, NoPoseSpace>;

    fn answer(machine: &Machine) -> Self::Answer {
        PoseSpace::of(machine).map(Arc::new)
    }
}

/// Query for the b at which several points, m, can be reached: all of them together, and each alone.
pub struct CommonB;

/// Answer of [`CommonB`].
#[derive(Clone, Debug, PartialEq)]
pub struct CommonBSets {
    /// The b of each point; `None` if it cannot be reached.
    pub each: Vec<Option<BSet>>,
    /// The b that all points share; `None` if there are none.
    pub all: Option<BSet>,
}

impl QuickQuery for CommonB {
    /// A pose space, and the points, m.
    type Input = (ByIdentity<PoseSpace>, Vec<Vector>);
    type Answer = CommonBSets;

    fn answer((ByIdentity(space), points): &Self::Input) -> CommonBSets {
        CommonBSets { each: points.iter().map(|p| space.reach(*p).ok()).collect(), all: common_b_set(space, points) }
    }
}

/// Existence of a machine's pose constant b = Σ λ_k q_k.
#[derive(Clone, Debug, PartialEq)]
pub enum PoseConstant {
    /// Holding b keeps the base free of moments.
    Exact,
    /// λ depends so little on the pose that holding b removes most of the base moment.
    Nearly {
        /// Largest |C_kl|, kg m².
        residual: f64,
    },
    /// No pose constant exists, and none is needed.
    Unneeded,
    /// No pose constant exists, for the given reason.
    None(NoPoseSpace),
}

impl fmt::Display for PoseConstant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exact => f.write_str("b = Σ λ_k q_k"),
            Self::Nearly { residual } => write!(
                f,
                "b = Σ λ_k q_k, but only nearly: couplings of up to {residual:.1e} kg m² remain, so holding b is not \
                 exactly reactionless; design removes them"
            ),
            Self::Unneeded => f.write_str("none is needed: every motion is reactionless, as no drive turns the base"),
            Self::None(why) => write!(f, "none: {why}"),
        }
    }
}

impl PoseConstant {
    /// Classifies a machine.
    pub fn of(machine: &Machine) -> Self {
        match PoseSpace::general(machine) {
            Ok(_) if is_reactionless(machine) => Self::Exact,
            Ok(_) => Self::Nearly { residual: Inertia::of(machine).invariance_residual() },
            Err(NoPoseSpace::Free) => Self::Unneeded,
            Err(why) => Self::None(why),
        }
    }

    /// Returns the word for this case in JSON output.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Nearly { .. } => "nearly",
            Self::Unneeded => "unneeded",
            Self::None(_) => "none",
        }
    }
}
