//! Pose spaces with the rule of a posture for dragging, and whether their paths avoid change points.

use std::sync::Arc;

use super::{Posture, PostureWeights};
use crate::pose_space::{GuidanceMode, PoseSpace};
use stillbase_mechanics::machine::Machine;
use stillbase_query::{ByIdentity, QuickQuery};

/// Query for a pose space of a machine with the rule of a posture for dragging. Its paths avoid change points or cross
/// them.
pub struct GuidedSpace;

impl QuickQuery for GuidedSpace {
    type Input = (ByIdentity<PoseSpace>, Machine, Posture, bool);
    type Answer = Arc<PoseSpace>;

    fn answer((ByIdentity(space), machine, posture, keep_off): &Self::Input) -> Self::Answer {
        let space = with_posture_guidance(PoseSpace::clone(space), machine, *posture);
        Arc::new(space.keeping_off_change_points(*keep_off))
    }
}

/// Returns a pose space with the rule of a posture for dragging; without free degrees of freedom it is unchanged.
fn with_posture_guidance(space: PoseSpace, machine: &Machine, posture: Posture) -> PoseSpace {
    if !space.leaves_freedoms() {
        return space;
    }
    let lead = match posture {
        Posture::LeastRates => GuidanceMode::LeastEnergy,
        Posture::Orientation => GuidanceMode::Keep(machine.resolved_links()[machine.end_link()].drive),
        Posture::LeastTorque => PostureWeights::of(machine, &space)
            .least_torque()
            .map_or(GuidanceMode::LeastEnergy, |inverse| GuidanceMode::Weighed(Box::new(inverse))),
        Posture::MidRange => GuidanceMode::Middle,
    };
    space.with_guidance(lead)
}
