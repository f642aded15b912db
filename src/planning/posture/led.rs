//! Pose spaces with the rule of a posture for dragging, and whether their paths avoid change points.

use std::sync::Arc;

use super::{Posture, Postures};
use crate::mechanics::machine::Machine;
use crate::planning::pose_space::{Lead, PoseSpace};
use crate::query::{Quick, Same};

/// Query for a pose space of a machine with the rule of a posture for dragging. Its paths avoid change points or cross
/// them.
pub struct Led;

impl Quick for Led {
    type Input = (Same<PoseSpace>, Machine, Posture, bool);
    type Answer = Arc<PoseSpace>;

    fn answer((Same(space), machine, posture, keep_off): &Self::Input) -> Self::Answer {
        let space = led(PoseSpace::clone(space), machine, *posture);
        Arc::new(space.keeping_off_change_points(*keep_off))
    }
}

/// Returns a pose space with the rule of a posture for dragging; without free degrees of freedom it is unchanged.
fn led(space: PoseSpace, machine: &Machine, posture: Posture) -> PoseSpace {
    if !space.leaves_freedoms() {
        return space;
    }
    let lead = match posture {
        Posture::LeastRates => Lead::LeastEnergy,
        Posture::Orientation => Lead::Keep(machine.resolved_links()[machine.end_link()].drive),
        Posture::LeastTorque => Postures::of(machine, &space)
            .least_torque()
            .map_or(Lead::LeastEnergy, |inverse| Lead::Weighed(Box::new(inverse))),
        Posture::MidRange => Lead::Middle,
    };
    space.led(lead)
}
