//! [`ScenarioSettings`]: the keys of a scenario that belong to no part.

use super::bounds::{DURATION_RANGE, POSE_ACCELERATION, STEP_RANGE};
use super::task::POSE_CONSTANT_RANGE;
use stillbase_settings::key::{Effect, Key};
use stillbase_settings::keyed::keyed;

keyed! {
    /// Keys of a scenario that belong to no part.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct ScenarioSettings {
        /// Fixed step of the simulation.
        step: f64 = "0.001", range: STEP_RANGE, reaching: Effect::Plan, saved: always;
        /// Time that a recording or the run of a command covers; a saved session is replayed up to it.
        duration: Option<f64> = Key::NONE, range: DURATION_RANGE, instead: "that of the planned motion",
            reaching: Effect::NoFrame;
        /// Bound on |b̈| while b is slid by hand.
        pose_acceleration: f64 = "2", range: POSE_ACCELERATION, saved: always;
        /// Pose constant of a second workspace to compare with.
        compare_b: Option<f64> = Key::NONE, range: POSE_CONSTANT_RANGE, instead: "there is no second one",
            reaching: Effect::Picture;
    }
}
