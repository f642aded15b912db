//! [`Assembly`]: planar machines, each in a plane of its own in space, on one base.
//!
//! A *block* is a machine with a mount: a place, and the directions x and y of its plane. It sits on the base, or on the
//! *platform* of another block, which moves with that block's end effector and keeps its orientation. A machine by itself
//! is an assembly of one block, in the plane of the base.
//!
//! # Symbols
//! | letter | meaning | unit |
//! |---|---|---|
//! | x, y, z | directions of a block's plane, and of its axis z = x × y, from the base | |
//! | r_0 | mount of a block, from the origin of the base | m |
//! | M, G, S | mass of a block, Σ m r and Σ m h r over its bodies, r in the plane, h along z | kg, kg m, kg m² |
//! | g_k, s_k | the same for each drive: G = Σ g_k e(q_k), S = Σ s_k e(q_k) | complex |
//! | A_0 | acceleration of the mount | m/s² |
//! | f, n | force and moment on the base at its origin | N, N m |
//!
//! # Closed form
//! A body of mass m at R = r_0 + r + h z, with acceleration A = A_0 + r̈, and with inertia I about z, exerts −m A and
//! −R × m A − z I q̈. Their sums over a block need no body: f = −M A_0 − G̈, and about the mount
//! n = z n_B − i S̈ − (G + z Σ m h) × A_0, with n_B of the machine alone and i a quarter turn about z. A platform does not
//! turn, so that a carried block brings its carrier a force at the end effector and no torque.
//!
//! # Source
//! Papadopoulos and Abu-Abed, §6: machines of more degrees of freedom from reactionless ones as building blocks.

mod block;
mod catalog;
mod compliant_base;
mod condition;
mod exchange;
mod file;
mod free_base;
mod model;
mod motion;
mod moving_base;
mod stepping;
mod words;

pub use block::{Block, Mount};
pub use catalog::{builtin_assemblies, builtin_text};
pub use compliant_base::{BaseState, Compliance, ComplianceError};
pub use condition::{BlockConditions, CarriedOffset, LoadedBlock, Reacting};
pub use file::{AssemblySpec, BlockSpec, FindMachine, parse};
pub use free_base::{Attitude, BaseMotion, SpatialBase};
pub use model::{Assembly, AssemblyError, MAX_BLOCKS};
pub use motion::{BlockLoads, BlockState, Momentum, SpatialLoads, SpatialWrench};
pub use moving_base::MovingBase;
