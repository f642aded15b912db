//! Tests of `src/mechanics`: machines, kinematics, dynamics, pin forces and balance.

pub mod arm_on_base;
mod assembly;
mod assembly_weights;
mod balance;
mod bodies;
mod breakdown;
mod counterweight_scale;
mod counterweight_shapes;
mod counterweights;
mod dynamics;
mod family;
mod faults;
mod ground;
pub mod inside;
mod joint_forces;
mod keep;
mod machine_file;
mod moving_base;
pub mod nine_body;
mod parts;
mod pin_friction;
mod sincos;
mod sketch;
mod sketch_parts;
mod sketch_steps;
