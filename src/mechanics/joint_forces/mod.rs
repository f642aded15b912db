//! Forces of pins and bearings inside the machine, the distance to change points, and the moment that tilts the
//! base.
//!
//! The base wrench is a sum over all links, in which the forces between links cancel. This module computes these forces
//! one by one: [`Joints`] holds the pins of all links, and returns the force of each pin for a state of motion.
//!
//! # Symbols
//! | letter | meaning | shape, unit |
//! |---|---|---|
//! | i | index of a pin: first the attachments of the links, in the order of links, then the closures | |
//! | e_k | unit vector of drive k; e_j is that of the drive that link j follows | |
//! | ä_k | second derivative of e_k, (i q̈_k − q̇_k²) e_k | rad/s² |
//! | F_i | force that the first link of pin i exerts on its second, in base axes | N |
//! | λ_c | force of closure c, a pin that is cut open | N |
//! | w_jc | lever of λ_c about the root of link j: its moment there is w_jc e_j × λ_c | m |
//! | μ_j | moment about the root of link j that this link and its descendants need, with all closures cut | N m |
//! | f_i | friction torque of pin i: −f_i on its second link, +f_i on its first | N m |
//! | τ_k | torque of drive k | N m |
//!
//! # Method
//! Cutting every closure leaves a tree, in which the root of each link carries the link and its descendants. A drive
//! with links at B turns those links; any other turns one link. On all other, undriven links, the only couple is the
//! friction of their pins, which is known. So the moments of the undriven links determine the closure forces: Σ_c w_jc
//! e_j × λ_c = μ_j. The levers w are constants of the machine. In the nine-link machine six links and three closures
//! give six equations in six unknowns, which fall into three pairs. Each parallelogram has two undriven links, which
//! follow drives k and l: λ = (x_k e_l − x_l e_k) / sin(q_l − q_k) with x = μ/w. Loops whose equations do not fall into
//! such pairs are solved together. The torques of the drives follow from the same equations.
//!
//! # Assumptions
//! A motor sits on the base or in a joint. A motor in a joint is carried by another drive. Its stator is on the parent
//! of the link that the motor turns, if that parent follows the carrying drive. Otherwise it is on the link that the
//! carrying drive turns. A drive on the base without a link at B turns its only link by a belt. The couple of the motor
//! then acts between that link and the base. Part of the couple accelerates the rotor. The rotor's weight belongs to
//! the link that carries the motor. Where several links share an axle, each attachment and each closure in the file is
//! a separate pin. All pins have the same friction; static friction between two drives is shared equally among the pins
//! between them. Friction in the bearing of a drive acts between the base and the link that the drive turns. This
//! friction is a couple and changes no pin force.
//!
//! # Near change points
//! Where sin(q_k − q_l) → 0 the parallelogram is flat and its forces grow like 1/|sin|, while τ stays finite. Where
//! |sin(q_k − q_l)| is below [`FLAT_SINE`], the forces are undefined.

mod block;
mod error;
mod forces;
mod inside;
mod joints;
mod pins;
mod structure;
mod tilt;
mod transmission;
mod tree;

pub use error::JointsError;
pub use forces::PinForces;
pub use inside::{InternalLoads, MAX_FRAME_PINS, PinLoads, PinPeak};
pub use joints::Joints;
pub use pins::{FLAT_SINE, MAX_PINS, Pin};
pub use tilt::{AxialMoments, TiltMoment};
pub use transmission::{
    ChangePointDistance, Parallelogram, nearest_change_point, next_change_point, pair_transmission,
};
