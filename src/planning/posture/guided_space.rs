//! [`GuidedSpace`]: query for pose spaces in which a posture determines the redundant freedoms while dragging.

use std::sync::Arc;

use super::{Posture, PostureWeights};
use crate::pose_space::{GuidanceMode, PoseSpace};
use stillbase_mechanics::machine::Machine;
use stillbase_query::{ByIdentity, QuickQuery};

/// Query for a machine's pose space with the guidance mode of a posture. If requested, its paths avoid change points;
/// otherwise they may cross them.
pub struct GuidedSpace;

impl QuickQuery for GuidedSpace {
    type Input = (ByIdentity<PoseSpace>, Machine, Posture, bool);
    type Answer = Arc<PoseSpace>;

    fn answer((ByIdentity(space), machine, posture, keep_off): &Self::Input) -> Self::Answer {
        let space = with_posture_guidance(PoseSpace::clone(space), machine, *posture);
        Arc::new(space.keeping_off_change_points(*keep_off))
    }
}

/// Returns a pose space with the guidance mode of a posture; without redundant freedoms it is unchanged.
fn with_posture_guidance(space: PoseSpace, machine: &Machine, posture: Posture) -> PoseSpace {
    if !space.leaves_freedoms() {
        return space;
    }
    let lead = match posture {
        Posture::LeastRates => GuidanceMode::LeastEnergy,
        Posture::Orientation => GuidanceMode::Keep(machine.resolved_links()[machine.end_link()].drive),
        Posture::LeastTorque => PostureWeights::of(machine, &space)
            .least_torque()
            .map_or(GuidanceMode::LeastEnergy, |inverse| GuidanceMode::WeightedNorm(Box::new(inverse))),
        Posture::MidRange => GuidanceMode::Middle,
    };
    space.with_guidance(lead)
}
