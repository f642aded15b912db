//! Inside the machine: what every pin and bearing carries, how near a change point is, and what tilts the base.
//!
//! The base wrench is a sum over all links, in which the forces between them cancel. Here they are computed one by one:
//! [`Joints`] knows where each link is pinned, and gives the force of each pin for a state of motion.
//!
//! # Symbols
//! | letter | meaning | shape, unit |
//! |---|---|---|
//! | i | pins: first where each link is attached, in the order of links, then the closures | |
//! | e_k | unit vector of drive k; e_j that of the drive whose orientation link j has | |
//! | ä_k | its second derivative, (i q̈_k − q̇_k²) e_k | rad/s² |
//! | F_i | force of pin i, base axes: what the first of its links exerts on the second | N |
//! | λ_c | force of closure c, the pin that is cut | N |
//! | w_jc | lever of λ_c about the root of link j: its moment there is w_jc e_j × λ_c | m |
//! | μ_j | moment about its root that link j, with what it carries, needs once closures are cut | N m |
//! | f_i | friction torque of pin i: −f_i on its second link, +f_i on its first | N m |
//! | τ_k | torque of drive k | N m |
//!
//! # Method
//! Cut every closure. What is left is a tree, in which each link's root carries the link and all that hangs on it. A
//! drive turns the links at B that follow it, or one in a joint; on the others acts no couple but the friction of their pins, which is
//! known, so their moments fix the closure forces: Σ_c w_jc e_j × λ_c = μ_j. The levers w are constants of the machine.
//! In the nine-link machine six links and three closures give six equations in six numbers, and they fall into three
//! pairs: each parallelogram has two links that no drive turns, of drives k and l, and
//! λ = (x_k e_l − x_l e_k) / sin(q_l − q_k) with x = μ/w. Loops whose equations do not fall into such pairs are solved
//! together. The torques of the drives follow from the same equations.
//!
//! # What is assumed
//! A motor sits on the base, or in a joint: on the link that what it turns hangs on, or else on the link that is turned
//! by the drive which carries it. A drive on the base without a link at B turns the one link that follows it by a belt,
//! so its couple acts between that link and the base. A rotor takes part of the couple to turn itself; its weight belongs
//! to the link that carries it. Where several links share an axle, each attachment and each closure is a
//! pin of its own, as the file has it. Each pin has its own friction, all alike; the torque that keeps the pins between
//! two drives stuck is shared equally among them. Friction in the bearing of a drive acts between the base and the link
//! that the drive turns: a couple in the pin between these two, which changes no force of any pin.
//!
//! # Near change points
//! Where sin(q_k − q_l) → 0 the parallelogram is flat and its forces grow like 1/|sin|, while τ stays finite. Below
//! [`FLAT`] they are undefined.

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
pub use forces::Forces;
pub use inside::{Inside, KEPT, PinLoads, PinPeak};
pub use joints::Joints;
pub use pins::{FLAT, MAX_PINS, Pin};
pub use tilt::{AxialMoments, Tilt};
pub use transmission::{ChangePointDistance, Parallelogram, ahead, nearest, pair_transmission};
