//! [`Request`]: the request to import a given motion.

use thiserror::Error;

use super::given::GivenMotion;
use stillbase_planning::pose_space::NoPoseSpace;
use stillbase_query::Shared;
use stillbase_session::scenario::Scenario;

/// Property of given drive angles that the proposal keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PreservedPath {
    /// The end effector's motion.
    Tip,
    /// The relative joint angles.
    Joints,
}

/// A given motion, and requirements on the proposal.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// Machine, base and control; the task and the edits are ignored. The proposal's scenario has the name of this
    /// one, and the title of this one followed by the proposal's [`way`](super::Proposal::way).
    pub scenario: Shared<Scenario>,
    /// The given motion.
    pub motion: Shared<GivenMotion>,
    /// Pose constant of the proposal, rad. By default, the b that moves the drives least, or the middle of those that
    /// reach all points of the end effector's path.
    pub b: Option<f64>,
    /// Property of given drive angles that the proposal keeps. By default, the end effector's motion if some plane
    /// reaches all of it.
    pub keep: Option<PreservedPath>,
}

/// Reason that a motion cannot be imported.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MotionImportError {
    /// The request keeps the joint angles of a motion that is given by the end effector.
    #[error("x and y give no joint angles to be kept")]
    NoJoints,
    /// No spline goes through the samples.
    #[error("want times further apart")]
    TooDense,
    /// The machine has no pose space, so its end effector cannot be placed.
    #[error(transparent)]
    NoPoses(#[from] NoPoseSpace),
}
