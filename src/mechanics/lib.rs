//! Mechanics of a machine: links and drives, kinematics, dynamics, balance, and the forces on its base.
//!
//! Others reach this crate as `stillbase::mechanics`; `stillbase` alone follows semantic versioning.

pub mod arm_on_base;
pub mod assembly;
pub mod balance;
pub mod counterweights;
pub mod dynamics;
pub mod joint_forces;
pub mod kinematics;
pub mod loads;
pub mod machine;
pub mod planar;
pub mod sketch;
