//! Machines: drives at B or in joints, links that each keep the orientation of one drive, pins that close
//! parallelograms.
//!
//! A [`MachineSpec`] is the content of a file; a [`Machine`] is a specification that has been checked. So every machine
//! is valid: finite numbers, positive masses, no cycles, every loop closed in every pose. [`Machine::set`] changes the
//! specification and checks it again.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | q_k | absolute angle of drive k, e(q) = (cos q, sin q) | rad |
//! | r_j | a point of link j, Σ_k w_k e(q_k); the weights w are its [`Chain`] | m |
//! | l_cj | CM of link j along the link, from its root | m |

mod caps;
mod catalog;
mod chain;
mod check;
mod counterweight;
mod error;
mod faults;
mod file;
mod inertia;
mod keys;
mod lengths;
mod model;
mod motors;
mod numbers;
mod parts;
pub mod ranges;
mod set;
mod spec;
mod transverse;
mod words;

pub use caps::{MAX_CHAIN_LINKS, MAX_COUNTERWEIGHTS, MAX_LINKS, MAX_PARTS, MAX_PER_PART};
pub use catalog::{builtin, builtins, named, unknown};
pub use chain::{Chain, place_of};
pub use check::CLOSURE_TOLERANCE;
pub(crate) use counterweight::behind_half_ring;
pub use counterweight::{Counterweight, CounterweightShape};
pub use error::{KeyPath, KeyStep, MachineError};
pub use faults::{FirstProblem, read as read_stated};
pub use file::{FileError, parse, parse_with, to_toml};
pub use inertia::RotorCoupling;
pub use inertia::{BALANCE_TOLERANCE, Inertia};
pub use keys::KEYS;
pub use model::{Machine, RelativeAngle, ResolvedClosure, ResolvedLink};
pub use motors::Motors;
pub use parts::{
    BarStock, Cylinder, DerivedNumbers, Ends, Hole, LinkNumber, Lump, MATERIALS, Material, Part, PartBody, PartSource,
    PlaneBody, Shape,
};
pub(crate) use parts::{sum_of, weigh};
pub use ranges::{ANGLE, MAX_ANGLE};
pub use set::{MACHINE_TABLES, is_of_machine};
pub use spec::{
    Angle, Attach, Closure, Drive, GROUND, Length, Link, LinkPoint, MachineSpec, Payload, PlaceOnLink, Rotor,
};
pub use transverse::TransverseInertia;
pub use words::{MachineWords, SMALLEST, pattern_of};
