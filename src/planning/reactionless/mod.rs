//! The geometry of reactionless planes: pose constants, workspaces, and everything that follows from (13)–(16).
//!
//! For three coaxial drives with two relative joint angles, everything about a plane b = const follows from a handful
//! of numbers, a [`PlaneMap`]: it knows no masses and no links.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | c_k | the end effector is p = Σ_k c_k e^{i q_k}, (14) | m |
//! | λ_k | b = Σ_k λ_k q_k, (13) | 1 |
//! | a_1, a_2 | relative joint angles q_to − q_from + offset | rad |
//! | b* | b/Σλ: turns the whole workspace, (15) | rad |
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
pub use boundary::{Boundary, BoundaryCurve, BoundaryLine, BoundaryLoop, ChangeCurve, Extent, Nearest, Vertex};
pub use change::PAIRS;
pub use decimal::{Decimal, between, metres, metres_apart};
pub use dexterity::Dexterity;
pub use plane::{AngleDefinition, AngleLimit, NotAPlaneMap, PlaneMap, PlanePoint, SLACK, WIDEST};
pub use poses::Poses;
pub use reach::NoReach;
