//! The geometry of reactionless planes: pose constants, workspaces, and all that follows from (13)–(16).
//!
//! For three coaxial drives with two relative joint angles, the geometry of a plane b = const follows from the few
//! numbers of a [`PlaneMap`], without masses and links.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | c_k | the end effector is p = Σ_k c_k e^{i q_k}, (14) | m |
//! | λ_k | b = Σ_k λ_k q_k, (13) | 1 |
//! | a_1, a_2 | relative joint angles q_to − q_from + offset | rad |
//! | b* | b/Σλ, the angle by which b turns the workspace, (15) | rad |
//! | u_k, v_k | q_k = b* + u_k · a + v_k | 1, rad |

mod b_set;
mod boundary;
mod change;
mod decimal;
mod dexterity;
mod plane;
mod poses;
mod quadrilateral;
mod reach;
mod turned;

pub use b_set::BSet;
pub use boundary::{
    Boundary, BoundaryCurve, BoundaryLine, BoundaryLoop, BoundaryVertex, BoundingBox, ChangeCurve, Nearest,
};
pub use change::DRIVE_PAIRS;
pub use decimal::{Decimal, describe_interval, metres, metres_apart};
pub use dexterity::Dexterity;
pub use plane::{AngleDefinition, AngleLimit, LIMIT_SLACK, MAX_LIMIT_RANGE, NotAPlaneMap, PlaneMap, PlanePoint};
pub use poses::Poses;
pub use reach::NoReach;
