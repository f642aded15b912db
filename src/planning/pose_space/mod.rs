//! Poses of machines with any number of drives at given pose constants b. Also the b at which a point can be reached,
//! the outline of the reactionless workspace, and dragging within it.
//!
//! With b held, n drives have n − 1 degrees of freedom. With two drives the workspace is a curve of the end effector;
//! with four or more, n − 3 freedoms remain at each of its points. For three drives with limits of both relative
//! angles, [`reactionless`](super::reactionless) has closed forms, and a [`PoseSpace`] uses them.
//! [`PoseSpace::general`] does not, so that tests can compare both methods.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | c_k | the end effector is p = Σ_k c_k e^{i q_k} | m |
//! | B | base pin, origin of p | |
//! | λ_k | b = Σ_k λ_k q_k, (13) | 1 |
//! | a_i | relative joint angles q_to − q_from + offset, n − 1 of them, that connect all drives | rad |
//! | L, Λ, δ | a *compound*: drives whose relative angles are at their limits turn as one, L = Σ c_k e^{iδ_k}, Λ = Σ λ_k | m, 1, rad |
//! | ν | multiplier of the condition that b is stationary at a fixed point | m |
//! | α | angle of a compound's arm from a direction common to all; |L| sin α = ν Λ where b is stationary | rad |
//!
//! # Method
//! The feasible b of a point form intervals. At each bound, b is stationary with respect to the joints that are not at
//! a limit. So each choice of active limits, and of the sign of every cos α, gives one scalar equation in ν: (Σ ±√(L² −
//! ν²Λ²))² + (ν ΣΛ)² = |p|². All such critical values of b are found by solving these equations. First and second
//! derivatives show whether b can rise or fall from each. Poses at a b are continued from the critical poses above and
//! below it.

mod b_coverage;
mod boxed;
mod continuation;
mod critical;
mod drag_step;
mod dragging;
mod facing;
mod gap_search;
mod in_reach;
mod joint;
mod loops;
mod nearest;
mod no_pose_space;
mod out_of_reach;
mod outline;
mod pattern;
mod planes;
mod poses;
mod reach;
mod rings;
mod space;

pub use in_reach::Reach;
pub use joint::RelativeJoint;
pub use no_pose_space::{NoPoseSpace, NotFollowable};
pub use no_pose_space::{constant_inertia, is_reactionless};
pub use outline::Outline;
pub use planes::{PlaneError, Planes, plane_area, plane_map};
pub use space::{GuidanceMode, PoseSpace};
