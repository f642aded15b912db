//! How a hand leads a machine of a posture, and whether its ways keep off change points.

use std::sync::Arc;

use super::{Posture, Postures};
use crate::mechanics::machine::Machine;
use crate::planning::pose_space::{Lead, PoseSpace};
use crate::query::{Quick, Same};

/// A pose space of a machine, led as a posture has it, with ways that keep off change points or lead across them.
pub struct Led;

impl Quick for Led {
    type Input = (Same<PoseSpace>, Machine, Posture, bool);
    type Answer = Arc<PoseSpace>;

    fn answer((Same(space), machine, posture, keep_off): &Self::Input) -> Self::Answer {
        let space = led(PoseSpace::clone(space), machine, *posture);
        Arc::new(space.keeping_off_change_points(*keep_off))
    }
}

/// The same space, led as a posture has it where a point leaves freedoms.
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
