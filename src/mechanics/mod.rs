//! What a machine is: its links and drives, how it moves, what that takes, and what its base feels.

pub mod balance;
pub mod counterweights;
pub mod dynamics;
pub mod joint_forces;
pub mod kinematics;
pub mod loads;
pub mod machine;
pub mod planar;
