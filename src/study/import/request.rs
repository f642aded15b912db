//! [`Request`]: what is asked of a given motion.

use thiserror::Error;

use super::given::GivenMotion;
use crate::planning::pose_space::NoPoseSpace;
use crate::query::Shared;
use crate::session::scenario::Scenario;

/// What the proposal keeps of given drive angles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keep {
    /// The end effector's motion.
    Tip,
    /// The relative joint angles.
    Joints,
}

/// A given motion, and what is asked of the one that is proposed.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// The machine, its base and its control; its task and its edits are left out. Proposals take its name, and its title
    /// with what they keep.
    pub scenario: Shared<Scenario>,
    /// The motion.
    pub motion: Shared<GivenMotion>,
    /// Pose constant of the proposal, rad; by default the one that moves the drives least, or the middle of those that
    /// serve the end effector's path.
    pub b: Option<f64>,
    /// What the proposal keeps of given drive angles; by default the end effector's motion, where some plane reaches all
    /// of it.
    pub keep: Option<Keep>,
}

/// Why a motion cannot be imported.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ImportError {
    /// The joint angles of a motion of the end effector are to be kept.
    #[error("x and y give no joint angles to be kept")]
    NoJoints,
    /// No spline goes through the samples.
    #[error("want times further apart")]
    TooDense,
    /// The machine has no poses in which its end effector can be put somewhere.
    #[error(transparent)]
    NoPoses(#[from] NoPoseSpace),
}
